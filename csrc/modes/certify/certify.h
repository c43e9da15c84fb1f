/* The lowest modes of a chain, certified by counts. */
#ifndef RD_CERTIFY_H
#define RD_CERTIFY_H

#include "modes/certify/certified.h"
#include "modes/refine/refine.h"

#include <stdbool.h>

/* RD_NO_MEMORY: refine holds too few steps or pieces, or blocks, then less than modes->blocks;
   RD_UNSTABLE_MASSLESS: no K - lambda M is positive definite; RD_CLUSTER: RD_RITZ_MOST modes or more
   within a relative 1e-8; RD_NO_CONVERGENCE: upper is NaN or block steps do not span a cluster;
   RD_SHORT_WAVES: as rd_count. */
enum rd_status rd_certify(struct rd_refine *refine, struct rd_certified *modes);

/* Steps and pieces that rd_certify needs for `wanted` modes of as many half waves; with modes of
   more it answers RD_NO_MEMORY. True where they are the most there can be. */
bool rd_certify_size(const struct rd_walk *walk, size_t wanted, size_t *steps, size_t *pieces);

#endif
