/* Polynomials through Chebyshev's nodes of the first kind. */
#ifndef RD_POLYNOMIAL_H
#define RD_POLYNOMIAL_H

#include "graded/blocks.h"

/* cos((2 j + 1) pi/2n), j = 0 .. n - 1, decreasing */
void rd_nodes(int n, double *node);

/* what the values at the nodes count for at x (barycentric formula, Berrut and Trefethen 2004) */
void rd_nodes_weigh(int n, const double *node, double x, double *weight);

#endif
