/* The elements of a chain. */
#ifndef RD_ELEMENTS_H
#define RD_ELEMENTS_H

#include "chain/chain.h"
#include "element/element.h"

#include <stdbool.h>

/* the distinct element i of a chain, without a hinge */
struct rd_element rd_chain_element(const struct rd_chain *chain, size_t i);

/* the element on the right of each node of a stretch, with the hinge between them */
struct rd_element rd_chain_span(const struct rd_chain *chain, size_t stretch);

/* whether nodes with this term have one */
bool rd_chain_is_hinged(const struct rd_chain *chain, int32_t term);

#endif
