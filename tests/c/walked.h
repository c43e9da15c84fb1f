/* A chain prepared for walking in memory of exactly its size, and what its dense matrices say. */
#ifndef WALKED_H
#define WALKED_H

#include "chains.h"
#include "modes/walk/walk.h"

struct walked {
    struct rd_walk walk;
    struct rd_workspace workspace;
};

/* prepares a chain, which must succeed */
struct walked walked_make(const struct rd_chain *chain);
void walked_free(struct walked *walked);

/* Negative eigenvalues of K - lambda M over the free coordinates, by LAPACK. The matrix is scaled to
   |K_ii| + |lambda M_ii| = 1; *nearest is the least |eigenvalue| of that, which rounding must not
   reach. */
size_t dense_count(const struct rd_chain *chain, double lambda, double *nearest);

/* The n eigenvalues of K x = lambda M x over the free coordinates, increasing, for M diagonal and
   positive there; the caller's to free. Each is right to a few n EPS of the largest. */
double *dense_modes(const struct rd_chain *chain, size_t *n);

#endif
