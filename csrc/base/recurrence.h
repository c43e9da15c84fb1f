/* Modes from step to step, without error of the step. */
#ifndef RD_RECURRENCE_H
#define RD_RECURRENCE_H

#include <stddef.h>
#include <stdint.h>

#include "base/lanes.h"

/* A mode's q and its velocity v change in a step by

       q: c_0 q + c_1 v + what pushes it,    v: c_2 q + c_3 v + what pushes that */
enum { RD_CHANGE = 4 };

struct rd_recurrence {
    size_t modes;         /* a multiple of RD_LANES; those too many are 0 throughout */
    const double *change; /* (lengths, RD_CHANGE, modes), of each length of a step   */
};

/* length (steps) of each step, an index; push (steps, 2, modes); states (steps + 1, 2, modes) q and v
   before each step, of which the first is given, and after the last */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t steps, const int32_t *length,
                        const double *push, double *states);

#endif
