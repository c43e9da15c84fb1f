/* Rayleigh-Ritz in the space of a few vectors. */
#ifndef RD_RITZ_H
#define RD_RITZ_H

#include "base/real_lanes.h"

#include <stddef.h>

/* A c = theta M c of the vectors whose inner products are A and M (n, n), n <= RD_LANES:
   theta (n) increasing and C (n, n) with column j belonging to theta_j, C^T M C = I, for as many
   as are independent; returns how many. A and M are destroyed. */
size_t rd_ritz(size_t n, double *A, double *M, double *theta, double *C);

/* x (count): lane j < n <- sum over i of lane i times C_ij, C (RD_LANES, n) */
void rd_ritz_combine(size_t n, const double *C, size_t count, lanes *x);

/* A (n, n) symmetric <- its eigenvalues on the diagonal, V (n, n) <- V times its eigenvectors */
void rd_ritz_rotate(size_t n, double *A, double *V);

#endif
