/* Which frequencies go side by side. */
#ifndef RD_SWEEP_ORDER_H
#define RD_SWEEP_ORDER_H

#include "chain/runs.h"
#include "sweep/scale.h"

/* order (count): the frequencies by |inertia|, so that neighbours need like pieces */
void rd_sweep_order(const struct rd_factors *factors, size_t *order);

/* Fills index (RD_LANES) from order[first] on with frequencies that need pieces of the same
   lengths in every run, the last one repeated, extent (RD_LANES) with their sizes, and returns how
   many there are: what is computed for a frequency never depends on its neighbours. 0: the first one
   needs more pieces than are walked (span/span.h). */
size_t rd_sweep_block_from(const struct rd_chain *chain, const struct rd_runs *runs,
                           const struct rd_factors *factors, const size_t *order, size_t first,
                           size_t *index, struct sweep_extent *extent);

#endif
