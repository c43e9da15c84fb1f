/* The numbers and arrays of a march. */
#ifndef RD_MARCH_STATE_H
#define RD_MARCH_STATE_H

#include "march/form/march.h"

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

#endif
