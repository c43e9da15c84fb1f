/* The lowest modes of a chain, certified by counts. */
#ifndef RD_CERTIFY_H
#define RD_CERTIFY_H

#include "refine.h"

#include <math.h>
#include <stdbool.h>

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
    double *lambda;    /* (wanted) increasing */
    double *error;     /* (wanted) bound of its rounding error [rad^2/s^2] */
    double *certified; /* (wanted) 1: the mode is between the counts of its bracket */
    double *bracket;   /* (4, wanted) out: low, high and the counts there; wider than the error,
                          by what counts can tell apart */
    double *shape;     /* (wanted, nodes, width) or NULL; elastic modes of largest scaled value 1,
                          rigid motions M-orthonormal; clusters are M-orthogonal */
    double *motion;    /* (wanted, attached) y of attached.h [m], with shape */
};

/* RD_NO_MEMORY: refine holds too few steps or pieces; RD_UNSTABLE_MASSLESS: no K - lambda M is
   positive definite; RD_CLUSTER: RD_LANES modes or more within a relative 1e-8; RD_NO_CONVERGENCE:
   upper is NaN or block steps do not span a cluster; RD_SHORT_WAVES: as rd_count. */
enum rd_status rd_certify(struct rd_refine *refine, struct rd_certified *modes);

/* Steps and pieces that rd_certify needs for `wanted` modes of as many half waves; with modes of
   more it answers RD_NO_MEMORY. True where they are the most there can be. */
bool rd_certify_size(const struct rd_walk *walk, size_t wanted, size_t *steps, size_t *pieces);

#endif
