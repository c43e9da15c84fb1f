/* Left and right parts and where they meet. */
#ifndef RD_SWEEP_PARTS_H
#define RD_SWEEP_PARTS_H

#include "sweep/plan.h"

/* the left parts at the nodes where parts will meet, with the rows carried so far */
void rd_sweep_left(struct sweep *s);

/* The right parts, which meet the left ones. count: frequencies, all: meeting ports */
void rd_sweep_right(struct sweep *s, size_t count, size_t all, double *value, double *error);

#endif
