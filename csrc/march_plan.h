/* A march laid out in the caller's memory: factors that stay and arrays that a stage fills. */
#ifndef RD_MARCH_PLAN_H
#define RD_MARCH_PLAN_H

#include "march.h"

#include <stdbool.h>

/* What stands at the nodes of a stretch and on their right, scaled, each block (width, width). */
enum rd_joint_block {
    RD_JOINT_A, /* with the string and the node term */
    RD_JOINT_B,
    RD_JOINT_W,
    RD_JOINT_A0, /* A, B - I, W without string */
    RD_JOINT_B0,
    RD_JOINT_W0,
    RD_JOINT_D, /* F - I, G, Q of the element, undamped, its hinge folded in */
    RD_JOINT_G,
    RD_JOINT_Q,
    RD_JOINT_MASS,   /* M/theta^2 */
    RD_JOINT_DRAG,   /* C/theta */
    RD_JOINT_SPRING, /* K */
    RD_JOINT_REST,   /* K + Q */
    RD_JOINT_BLOCKS
};

/* numbers of a joint, behind its blocks */
enum rd_joint_number {
    RD_JOINT_REACH,  /* z_z^2/l: a string's stiffness per tension */
    RD_JOINT_STRING, /* its own tension [N] */
    RD_JOINT_DAMPED, /* drag/theta [N] */
    RD_JOINT_STIFF,  /* of the stage: all tension times reach */
    RD_JOINT_RATE,   /* gamma/theta */
    RD_JOINT_TURNED, /* 1: 1 + k A_zz is negative beside the string */
    RD_JOINT_OPEN,   /* 1: a free hinge of an element that nothing turns back */
    RD_JOINT_NUMBERS
};

/* per node: E, E W, U, H, J */
enum rd_map_block { RD_MAP_E, RD_MAP_EW, RD_MAP_U, RD_MAP_H, RD_MAP_J, RD_MAP_BLOCKS };

/* of a whole march */
struct rd_march_numbers {
    double theta; /* [s] */
    double base;  /* tension added to every string at rest, whose energy is strain [N] */
    double extra; /* that of the factors at hand [N] */
    double made;  /* tension that the motion made in the last stage [N] */
    double rise;  /* from the stage before it to that one [N] */
    double slope; /* d(what is made - what was taken)/d(what was taken) as last met, < 0 */
    double z[RD_WIDTH_MAX];
};

/* motion in the scales of the march, velocity times theta */
struct rd_scaled {
    double *u, *v; /* (nodes, width) */
    double *f;     /* (nodes - 1, width) */
    double *y, *w; /* (attached) */
};

struct rd_march {
    const struct rd_chain *chain;
    const struct rd_beside *beside;
    const struct rd_laws *laws;
    size_t iz; /* z among the coordinates, or width */
    struct rd_march_numbers *number;
    double *joint;               /* (stretches, joint_size) */
    double *map;                 /* (nodes, RD_MAP_BLOCKS, width, width) */
    int32_t *carrier;            /* (attached) node that carries a resonator, -1: none */
    struct rd_scaled start;      /* of the step */
    struct rd_scaled first;      /* changes of the first stage */
    struct rd_scaled later;      /* that the second stage sets out from */
    struct rd_scaled second;     /* changes of the second stage */
    struct rd_scaled star;       /* of the stage at hand: start or later */
    struct rd_scaled lean;       /* of the stage at hand: first or second */
    double *load;                /* (nodes, width) from outside; zero between stages */
    double *p;                   /* (nodes, width) */
    double *shift;               /* (nodes, width) of held coordinates that move */
    double *kick;                /* (nodes, width) in c, with them */
    double *c;                   /* (nodes, width) */
    double *s;                   /* (nodes, width) */
    struct rd_scaled correction; /* of lean */
    bool refined;   /* whether each stage is solved twice, the second time what the first left */
    double *column; /* (laws, 2 nodes - 1, width) u and f per force of each law */
    double *compliance; /* (laws, laws) */
    double *alone;      /* (laws) increment of each law's point without the laws */
    double *force;      /* (laws) */
    double *law_work;   /* (laws, laws + 4) */
};

static inline size_t rd_joint_size(const struct rd_march *march)
{
    const size_t w = march->chain->width;
    return RD_JOINT_BLOCKS * w * w + RD_JOINT_NUMBERS;
}

static inline double *rd_joint_of(const struct rd_march *march, size_t stretch)
{
    return march->joint + stretch * rd_joint_size(march);
}

static inline const double *rd_joint_number(const struct rd_march *march, size_t stretch)
{
    const size_t w = march->chain->width;
    return rd_joint_of(march, stretch) + RD_JOINT_BLOCKS * w * w;
}

/* Takes the arrays of a march and finds its resonators; RD_SPREAD_INERTIA where a broken wire is
   carried. What rd_march_factor put there stays. */
enum rd_status rd_march_prepare(const struct rd_chain *chain, const struct rd_beside *beside,
                                const struct rd_laws *laws, struct rd_march *march,
                                struct rd_workspace *workspace);

/* Everything that depends on theta [s] and on the tension `extra` [N]. RD_CRITICAL_ELEMENT,
   RD_NOT_POSITIVE_DEFINITE of an element, RD_SINGULAR, RD_FAST_GROWTH: compression makes motion
   grow by more than 1/theta. */
enum rd_status rd_march_factor(struct rd_march *march, double theta, double extra);

/* the same at another tension */
enum rd_status rd_march_tighten(struct rd_march *march, double extra);

/* Motion into the scales of the march, and back. */
void rd_march_load(struct rd_march *march, const struct rd_motion *motion);
void rd_march_unload(const struct rd_march *march, const struct rd_motion *motion);

/* star and lean are those of stage 0 or 1 */
void rd_march_choose(struct rd_march *march, int stage);

/* Where a stage begins; the loads on it are then there until rd_march_take. */
void rd_march_begin(struct rd_march *march, double g, int stage, const struct rd_push *push);

/* lean and alone at the tension of the factors */
void rd_march_lean(struct rd_march *march, const struct rd_push *push);

/* What the forces of the laws are found from: increments of their points alone, per force, and
   where they set out, as in rd_laws_solve. */
void rd_march_points(const struct rd_march *march, double *alone, double *compliance,
                     double *start);

/* lean with the forces of the laws */
void rd_march_add_laws(struct rd_march *march);

/* the changes of velocity; after stage 1 start is the end of the step */
void rd_march_take(struct rd_march *march, double g, int stage);

/* takes the loads away */
void rd_march_clear(struct rd_march *march, const struct rd_push *push);

/* The stage as it is, in lean: with the forces of the laws, and where motion stretches the rope
   with the tension that this makes, beside `extra` [N] from outside. RD_NO_CONVERGENCE with the
   relative residual that is left. */
enum rd_status rd_march_settle(struct rd_march *march, const struct rd_push *push, double extra,
                               double *residual);

/* energy (RD_ENERGIES) += input and dissipation of a stage that rd_march_take is to take next;
   taken (laws) likewise. extra [N]: tension from outside, whose work is input. */
void rd_march_account(const struct rd_march *march, double g, const struct rd_push *push,
                      double extra, double *energy, double *taken);

/* kinetic and strain energy at the start of a step [J] */
void rd_march_energy(const struct rd_march *march, double *energy);

/* load (nodes, width) += a force at a port */
void rd_march_push(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                   double force, double *load);

/* z (width) from theta and what acts beside the chain */
void rd_march_scale(const struct rd_march *march, double *z);

/* displacement of a port from the scaled u (nodes, width) */
double rd_march_read(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                     const double *u);

/* half the sum of (z_b - z_a)^2/l over the elements [m], of the product of u and v */
double rd_march_lengthening(const struct rd_march *march, const double *u, const double *v);

/* joint of a stretch at theta; then with its string at a tension */
enum rd_status rd_joint_fill(const struct rd_march *march, size_t stretch);
enum rd_status rd_joint_tighten(const struct rd_march *march, size_t stretch);

/* A resonator's mass on its spring: what it adds to the node term, and at a stage to the load; its
   own change when the node's is known. */
void rd_resonator_add(const struct rd_march *march, size_t k, double *N);
void rd_resonator_load(struct rd_march *march, size_t k);
void rd_resonator_follow(struct rd_march *march, size_t k);

/* p += its force on the foot at the stage in lean */
void rd_resonator_pull(struct rd_march *march, size_t k);

/* its numbers at the stage, and how far its foot is moved by u (nodes, width) [m] */
struct rd_resonator {
    double m, k, c;           /* m/theta^2, k, c/theta [N/m] */
    double drag;              /* alpha m/theta [N/m] */
    double row[RD_WIDTH_MAX]; /* foot per scaled motion of the node [m] */
};
struct rd_resonator rd_resonator_of(const struct rd_march *march, size_t k);
double rd_resonator_force(const struct rd_march *march, const struct rd_resonator *one, size_t k);
double rd_resonator_foot(const struct rd_march *march, const struct rd_resonator *resonator,
                         size_t k, const double *u);

/* the kernels, by width */
struct rd_march_kernel {
    enum rd_status (*factor)(struct rd_march *march);
    void (*rest)(struct rd_march *march);
    void (*solve)(struct rd_march *march, const double *p, bool moved, double *u, double *f);
    void (*residual)(struct rd_march *march);
    void (*energy)(const struct rd_march *march, double *energy);
    double (*dissipate)(const struct rd_march *march);
};

extern const struct rd_march_kernel rd_march_kernel_1, rd_march_kernel_2, rd_march_kernel_3,
    rd_march_kernel_4;

const struct rd_march_kernel *rd_march_kernel_of(const struct rd_march *march);

#endif
