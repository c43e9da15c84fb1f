/* Modes under a force of straight lines, from time to time without error of the step. */
#ifndef RD_RECURRENCE_H
#define RD_RECURRENCE_H

#include <stddef.h>
#include <stdint.h>

#include "base/lanes.h"

/* With q and its velocity v of each mode at the beginning of a step, force f there and f + d at its
   end, they change by

       q: c_0 q + c_1 v + c_2 f + c_3 d,    v: c_4 q + c_5 v + c_6 f + c_7 d */
enum { RD_CHANGE = 8 };

struct rd_recurrence {
    size_t modes;         /* a multiple of RD_LANES; those too many are 0 throughout */
    size_t responses;     /*                                                         */
    const double *change; /* (lengths, RD_CHANGE, modes), of each length of a step   */
    const double *seen;   /* (responses, 2, modes): a response is their sum with q, v */
};

/* length (steps) of each step, an index; force (steps + 1) [N]; state (2, modes) q and v, before and
   after; value (responses, steps) at the end of each step */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t steps, const int32_t *length,
                        const double *force, double *state, double *value);

#endif
