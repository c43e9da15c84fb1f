/* Scales of the coordinates for a march. */
#ifndef RD_MARCH_SCALE_H
#define RD_MARCH_SCALE_H

#include "march/form/state.h"

/* z (width) from theta and what acts beside the chain */
void rd_march_scale(const struct rd_march *march, double *z);

#endif
