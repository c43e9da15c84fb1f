/* Across the chain: runs by pieces, the rest element by element. */
#ifndef RD_SWEEP_CROSS_H
#define RD_SWEEP_CROSS_H

#include "sweep/plan.h"

/* at a free end, with nothing behind the walk */
void rd_sweep_begin(struct sweep *s);

/* From node a to a later node b; *run is the first run that ends behind a. */
void rd_sweep_forward(struct sweep *s, size_t a, size_t b, size_t *run);

/* From node b back to an earlier node a; *run - 1 is the last run that begins before b. */
void rd_sweep_backward(struct sweep *s, size_t b, size_t a, size_t *run);

/* Takes the node ahead into the part behind the walk, if it is not in it already. */
void rd_sweep_absorb(struct sweep *s, int way, size_t node);

#endif
