/* How many modes a chain has. */
#ifndef RD_INERTIA_H
#define RD_INERTIA_H

#include "chain/chain.h"

#include <stdbool.h>

/* whether elements have inertia of their own: there are infinitely many modes */
bool rd_inertia_is_endless(const struct rd_chain *chain);

/* positive eigenvalues of M over the free coordinates: with K + s M positive definite there are as
   many modes (Sylvester). Units and ratios of inertia hide none; what is within rounding of zero
   counts as zero. One more for each structure that a node carries; SIZE_MAX where elements or
   structures have infinitely many. */
size_t rd_inertia_positive(const struct rd_chain *chain);

#endif
