/* Small dense matrices, row by row. */
#ifndef RD_DENSE_H
#define RD_DENSE_H

#include <stdbool.h>
#include <stddef.h>

/* A (n, n) symmetric positive definite <- its inverse. A coordinate whose row is zero is
   absent and stays zero. False where A is not positive definite; A is then destroyed. */
bool rd_dense_invert(size_t n, double *A);

/* C (n, m) = A (n, k) B (k, m) */
void rd_dense_multiply(size_t n, size_t k, size_t m, const double *A, const double *B, double *C);

/* B (m, n) = A^T, A (n, m) */
void rd_dense_transpose(size_t n, size_t m, const double *A, double *B);

/* a^T b, of eight sums side by side */
double rd_dense_inner(size_t n, const double *a, const double *b);

#endif
