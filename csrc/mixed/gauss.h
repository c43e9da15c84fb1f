/* Gauss with row exchanges, in the widest numbers there are: x86-64's have 64 digits of 2, others 113. */
#ifndef RD_GAUSS_H
#define RD_GAUSS_H

#include "base/complex.h"

#include <stddef.h>

/* A (rows, columns): makes its first `own` columns triangular, rows exchanged on the way. Where it is
   singular, infinite or no numbers follow. */
void rd_gauss_eliminate(long double *A, size_t rows, size_t columns, size_t own);
void rd_gauss_eliminate_complex(long double _Complex *A, size_t rows, size_t columns, size_t own);

/* x (own, loads) <- U^-1 x, U the triangle of A */
void rd_gauss_substitute(const long double *A, size_t columns, size_t own, size_t loads,
                         long double *x);
void rd_gauss_substitute_complex(const long double _Complex *A, size_t columns, size_t own,
                                 size_t loads, long double _Complex *x);

#endif
