/* Structures that nodes carry, at the frequencies of a block. */
#ifndef RD_SWEEP_FOOT_H
#define RD_SWEEP_FOOT_H

#include "sweep/kernel/kernel.h"

/* foot (attached) at the block's factors of inertia and dashpots */
void rd_sweep_feet(const struct rd_chain *chain, const struct sweep_block *block,
                   struct sweep_foot *foot);

/* What those of a node term add to the stiffness of coordinate i, term by term [N/m, N m]. */
lanes rd_sweep_foot_size(const struct rd_chain *chain, const struct sweep_foot *foot, size_t term,
                         size_t i);

#endif
