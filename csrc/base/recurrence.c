/* The change is added to the state, not the state multiplied: so a short step rounds what it adds,
   and frequencies are as exact after a million of them. */
#include "base/recurrence.h"

#include <assert.h>
#include <string.h>

RD_INLINE lanes load(const double *from)
{
    lanes x;
    memcpy(&x, from, sizeof x);
    return x;
}

RD_INLINE void advance(size_t modes, const double *c, const double *push, const double *before,
                       double *after)
{
    for (size_t k = 0; k < modes; k += RD_LANES) {
        const lanes q = load(before + k), v = load(before + modes + k);
        const lanes dq = (load(c + k) * q + load(c + modes + k) * v) + load(push + k);
        const lanes dv =
            (load(c + 2 * modes + k) * q + load(c + 3 * modes + k) * v) + load(push + modes + k);
        const lanes next = q + dq, faster = v + dv;
        memcpy(after + k, &next, sizeof next);
        memcpy(after + modes + k, &faster, sizeof faster);
    }
}

RD_CLONES static void walk(const struct rd_recurrence *recurrence, size_t steps,
                           const int32_t *length, const double *push, double *states)
{
    const size_t modes = recurrence->modes, size = 2 * modes;
    assert(modes % RD_LANES == 0);
    for (size_t n = 0; n < steps; n++) {
        const double *change = recurrence->change + (size_t)length[n] * RD_CHANGE * modes;
        advance(modes, change, push + n * size, states + n * size, states + (n + 1) * size);
    }
}

/* copies of a function per instruction set must be static, or the extension exports them */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t steps, const int32_t *length,
                        const double *push, double *states)
{
    walk(recurrence, steps, length, push, states);
}
