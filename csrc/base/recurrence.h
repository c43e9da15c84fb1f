/* Modes under straight lines between samples, block by block, without error of the step. */
#ifndef RD_RECURRENCE_H
#define RD_RECURRENCE_H

#include <stddef.h>
#include <stdint.h>

#include "base/lanes.h"

/* modes side by side, half_lanes: of twice as many not all would stay in registers */
enum { RD_QUAD = RD_LANES / 2 };

/* A mode's q and its velocity v change over a block by

       q: c_0 q + c_1 v + what pushes it,    v: c_2 q + c_3 v + what pushes that

   A block is pushed by size + 1 numbers: the force when it begins, its rise to the next sample, and
   how much the rise changes at each sample after that. Modes stand in groups of RD_QUAD; those
   too many are 0 throughout. */
enum { RD_CHANGE = 4, RD_BLOCK_MOST = 64 };

struct rd_recurrence {
    size_t groups, kinds, size, responses; /* size: 1 to RD_BLOCK_MOST samples of a block */
    const double *change; /* (groups, kinds, RD_CHANGE, RD_QUAD)                          */
    const double *gain;   /* (groups, kinds, size + 1, 2, RD_QUAD) of q and v by each push */
    const double *read;   /* (groups, size, responses, 2, RD_QUAD) of q and v at the beginning,
                             in a response at each sample of a block                        */
    const double *local;  /* (size, responses, size) and of each push but the last           */
};

/* half_lanes that a walk works with */
size_t rd_recurrence_work(size_t responses);

/* kind (blocks) of each block; sample (blocks size + 1); state (groups, 2, RD_QUAD) q and v, before
   and after; value (responses, blocks size) at each sample but the last. */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t blocks, const int32_t *kind,
                        const double *sample, double *state, half_lanes *work, double *value);

#endif
