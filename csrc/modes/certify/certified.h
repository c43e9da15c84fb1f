/* Modes that counts confirm. */
#ifndef RD_CERTIFIED_H
#define RD_CERTIFIED_H

#include <stddef.h>

/* The arrays are the caller's. Modes have x^T M x > 0; eigenvalues of a mass matrix that is not
   positive, which belong to the chain's numerics, are below all of them and are not modes. */
struct rd_certified {
    size_t wanted;     /* in: modes at most */
    double upper;      /* in: only lambda below this, INFINITY for no limit [rad^2/s^2] */
    size_t found;      /* modes returned, 0 where the status is not RD_OK */
    size_t existing;   /* modes below upper */
    size_t rigid;      /* rigid motions, lambda = 0 exactly */
    size_t counts;     /* lambda counted */
    size_t iterations; /* inverse iterations, of RD_LANES modes together */
    size_t redone;     /* modes that counts did not confirm at first */
    size_t blocks;     /* of vectors, that the widest cluster needs where there are fewer */
    double *lambda;    /* (wanted) increasing */
    double *error;     /* (wanted) bound of its rounding error [rad^2/s^2] */
    double *certified; /* (wanted) 1: the mode is between the counts of its bracket */
    double *bracket;   /* (4, wanted) out: low, high and the counts there; wider than the error,
                          by what counts can tell apart */
    double *shape;     /* (wanted, nodes, width) or NULL; elastic modes of largest scaled value 1,
                          rigid motions M-orthonormal; clusters are M-orthogonal */
    double *motion;    /* (wanted, attached) y of chain/attached.h [m], with shape */
};

#endif
