/* Natural frequencies and shapes of the assembled system by LAPACK's dense symmetric solver. */
#ifndef RD_MODES_H
#define RD_MODES_H

#include "assembled/system.h"

/* K x = lambda M x is solved the other way round. With a shift s >= 0 that makes it positive
   definite, K + s M = L L^T (band Cholesky) and

       L^-1 M L^-T y = mu y,   x = L^-T y,   lambda = 1/mu - s.

   The lowest frequencies are then the largest mu, which the dense solver gets to the last digits
   of its matrix: at 64 clamped elements this keeps 2e-11 of f1 where solving K x = lambda M x,
   dense or banded, keeps 1e-10. M may be singular or indefinite: mu = 0 is the infinite frequency
   of a coordinate without mass. */
struct rd_modes {
    struct rd_system system;
    size_t finite;     /* modes there are, rd_inertia_positive */
    double shift;      /* s in use [rad^2/s^2] */
    double *band;      /* (free, reach + 1) K + s M, then L */
    double *matrix;    /* (free, free) M, then L^-1 M L^-T */
    double *value;     /* (free) mu, ascending */
    double *vector;    /* (columns, free) */
    double *size;      /* (free) */
    double *work;      /* (128 free) */
    int32_t *integers; /* (10 free) */
    int32_t *support;  /* (2 free) */
    size_t columns;    /* the most modes that fit in `vector` */
    size_t computed;   /* how many are there */
};

/* Takes the arrays for at most `columns` modes and counts the finite ones. */
enum rd_status rd_modes_prepare(const struct rd_chain *chain, size_t columns,
                                struct rd_modes *modes, struct rd_workspace *workspace);

/* Fills `matrix` with M and factorises K + s M, s = 0 where K is safely positive definite and else the first of scale,
   4 scale, 16 scale ... that does; scale [rad^2/s^2] > 0 is best of the order of the first elastic
   eigenvalue. RD_UNSTABLE_MASSLESS where none does: K is not positive on what has no mass. */
enum rd_status rd_modes_factorise(struct rd_modes *modes, double scale);

/* Columns start to stop of L^-1 (matrix): call over all columns, rd_modes_transpose, and again
   over all columns. In slices so that the caller can look up in between. */
void rd_modes_reduce(struct rd_modes *modes, size_t start, size_t stop);
void rd_modes_transpose(struct rd_modes *modes);

/* The `wanted` lowest modes as far as there are so many, or with wanted = 0 all below `below` [rad^2/s^2], for
   which `columns` must have been SIZE_MAX: found <- how many. RD_NO_CONVERGENCE where LAPACK gives
   up. */
enum rd_status rd_modes_solve(struct rd_modes *modes, size_t wanted, double below, size_t *found);

/* Mode k of those found, lowest first, once each: eigenvalue and the estimated error of it that
   rounding in the assembled matrices causes [rad^2/s^2], INFINITY where no digit is left; shape (nodes, width), zero where held. */
void rd_modes_read(struct rd_modes *modes, size_t k, double *eigenvalue, double *rounding,
                   double *shape);

#endif
