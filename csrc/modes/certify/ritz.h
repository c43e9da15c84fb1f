/* Rayleigh-Ritz in the space of a few vectors. */
#ifndef RD_RITZ_H
#define RD_RITZ_H

#include "base/real_lanes.h"

#include <stddef.h>

enum { RD_RITZ_MOST = 64 * RD_LANES };

/* A c = theta M c of the vectors whose inner products are A and M (n, n), n <= RD_RITZ_MOST:
   theta (n) increasing and C (n, n) with column j belonging to theta_j, C^T M C = I, for as many
   as are independent; returns how many. A, M and work (2, n, n) are destroyed. */
size_t rd_ritz(size_t n, double *A, double *M, double *theta, double *C, double *work);

/* A combination of `from` vectors: of x the lane i of RD_LANES, those behind it `apart` lanes on, and
   so forth. Vector j < to of x (count) <- sum over i of vector i times C_ij, C (from, row). */
void rd_ritz_combine(size_t from, size_t to, const double *C, size_t row, size_t count,
                     size_t apart, lanes *x);

/* A (n, n) symmetric <- its eigenvalues on the diagonal, V (n, n) <- V times its eigenvectors */
void rd_ritz_rotate(size_t n, double *A, double *V);

#endif
