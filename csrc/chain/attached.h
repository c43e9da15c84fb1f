/* Structures that nodes carry, condensed to their foot. */
#ifndef RD_ATTACHED_H
#define RD_ATTACHED_H

#include "base/complex.h"
#include "chain/chain.h"

/* A structure as its foot feels it, u = (displacement, rotation) of the foot, at one lambda:

       D = -(w/e) v v^T + diag(rest)

   where e, 1 at lambda = 0 and entire, passes zero at the eigenvalues that the structure has with its foot held.
   There D is infinite and w, v, rest are not: with the unknown y, e y = v^T u, the structure is

       w e y^2 - 2 w y v^T u + u^T diag(rest) u

   which is stationary in y and has no pole at all. Its tip moves by t^T u/e. Analytic in s where Im s
   is not 0, what half plane a hysteretic loss belongs to goes on in the other. */
struct rd_foot {
    double _Complex weight;   /* w [N/m] */
    double _Complex gap;      /* e; never exactly 0 */
    double _Complex growth;   /* logarithm of the factor that w, e and t have all lost */
    double _Complex lever[2]; /* v [1, m] */
    double _Complex rest[2];  /* [N/m, N m] */
    double _Complex tip[2];   /* t [1, m] */
    double held;              /* eigenvalues below lambda with the foot held; for real lambda */
};

/* two motions of a foot (displacement, rotation), each with its y */
struct rd_foot_pair {
    double _Complex moved[2][2], y[2];
};

/* Derivatives of the form of two motions, w e y y' - w (y v^T u' + y' v^T u) + u^T diag(rest) u', at
   fixed u and y: by the factor of inertia, by the logarithm of the stiffness k, by the damping
   ratio, and by that of the mass m as far as its damping ratio ties the dashpot to it. By ln m it is
   inertia times the first and the last. */
enum rd_carried_number {
    RD_CARRIED_OF_MASS,
    RD_CARRIED_OF_STIFFNESS,
    RD_CARRIED_OF_DAMPING,
    RD_CARRIED_OF_MASS_DAMPED,
    RD_CARRIED_NUMBERS
};

/* what a kind of structure is */
struct rd_attached {
    /* the foot at inertia = -lambda = s^2 and dashpot = s */
    void (*fill)(const double *value, double _Complex inertia, double _Complex dashpot,
                 struct rd_foot *foot);
    /* the largest eigenvalue with the foot held, INFINITY where there is none [rad^2/s^2] */
    double (*highest)(const double *value);
    /* number (RD_CARRIED_NUMBERS) of the form of two motions */
    void (*slopes)(const double *value, double _Complex inertia, double _Complex dashpot,
                   const struct rd_foot_pair *pair, double _Complex *number);
};

/* (RD_ATTACHED_KINDS) */
extern const struct rd_attached rd_attached_of[];

/* Structure k of the chain. */
void rd_attached_fill(const struct rd_chain *chain, size_t k, double _Complex inertia,
                      double _Complex dashpot, struct rd_foot *foot);

/* row (width): displacement of the foot times x[0] and its rotation times x[1], per motion of the
   node */
void rd_attached_row(const struct rd_chain *chain, size_t k, const double _Complex *x,
                     double _Complex *row);

/* The largest eigenvalue that any structure has with its foot held, 0 where there are none. */
double rd_attached_highest(const struct rd_chain *chain);

/* D (width, width) <- D + what the structures of a node term add to its dynamic stiffness */
void rd_attached_add(const struct rd_chain *chain, size_t term, double _Complex inertia,
                     double _Complex dashpot, double _Complex *D);

/* Twice the strain energy [J]; what the kinetic energy adds to shape^T M shape [kg m^2]; and
   shape^T Im D shape by the structures' own damping, to first order [J]. */
enum rd_carried { RD_CARRIED_STRAIN, RD_CARRIED_KINETIC, RD_CARRIED_LOST, RD_CARRIED };

/* energy (RD_CARRIED) of all structures in the mode lambda, shape (nodes, width) with y (attached) */
void rd_attached_energy(const struct rd_chain *chain, double lambda, const double *shape,
                        const double *y, double *energy);

/* The slopes of structure k with two motions a, b (width) of its node: number (RD_CARRIED_NUMBERS),
   and row (2, width) of each entry of attached_row. y (2), or NULL: what the motions make of it. A
   length l of the structure with m and k kept is a factor on the rotation of its foot. */
void rd_attached_slopes(const struct rd_chain *chain, size_t k, double _Complex inertia,
                        double _Complex dashpot, const double _Complex *a, const double _Complex *b,
                        const double _Complex *y, double _Complex *number, double _Complex *row);

/* adds to force (width) how structure k resists the motion u (width) of its node; y as above */
void rd_attached_pull(const struct rd_chain *chain, size_t k, double _Complex inertia,
                      double _Complex dashpot, const double _Complex *u, const double _Complex *y,
                      double _Complex *force);

/* the node that carries structure k, or the number of nodes where none does */
size_t rd_attached_node(const struct rd_chain *chain, size_t k);

/* tip (3, 2): motion of the tip of structure k per displacement and per rotation of its foot, t/e; of
   a wire, how that changes with the logarithm of its stiffness, and by as much less with that of its
   mass; and with its damping ratio */
void rd_attached_tip(const struct rd_chain *chain, size_t k, double _Complex inertia,
                     double _Complex dashpot, double _Complex *tip);

/* The inertia (width, width) that they have where all moves together, -dD/dlambda at 0; added. */
void rd_attached_inertia(const struct rd_chain *chain, size_t term, double *M);

#endif
