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

RD_INLINE void advance(const struct rd_recurrence *recurrence, const double *change, double f,
                       double d, double *q, double *v)
{
    const size_t modes = recurrence->modes;
    const lanes now = l_fill(f), more = l_fill(d);
    for (size_t k = 0; k < modes; k += RD_LANES) {
        const double *c = change + k;
        const lanes x = load(q + k), y = load(v + k);
        const lanes dx = (load(c) * x + load(c + modes) * y) +
                         (load(c + 2 * modes) * now + load(c + 3 * modes) * more);
        const lanes dy = (load(c + 4 * modes) * x + load(c + 5 * modes) * y) +
                         (load(c + 6 * modes) * now + load(c + 7 * modes) * more);
        const lanes next = x + dx, faster = y + dy;
        memcpy(q + k, &next, sizeof next);
        memcpy(v + k, &faster, sizeof faster);
    }
}

RD_INLINE double look(const double *seen, const double *state, size_t count)
{
    lanes sum = {0};
    for (size_t k = 0; k < count; k += RD_LANES)
        sum += load(seen + k) * load(state + k);
    double all = 0;
    for (int i = 0; i < RD_LANES; i++)
        all += sum[i];
    return all;
}

RD_CLONES static void walk(const struct rd_recurrence *recurrence, size_t steps,
                           const int32_t *length, const double *force, double *state, double *value)
{
    const size_t modes = recurrence->modes;
    assert(modes % RD_LANES == 0);
    for (size_t n = 0; n < steps; n++) {
        const double *change = recurrence->change + (size_t)length[n] * RD_CHANGE * modes;
        advance(recurrence, change, force[n], force[n + 1] - force[n], state, state + modes);
        for (size_t r = 0; r < recurrence->responses; r++)
            value[r * steps + n] = look(recurrence->seen + 2 * r * modes, state, 2 * modes);
    }
}

/* copies of a function per instruction set must be static, or the extension exports them */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t steps, const int32_t *length,
                        const double *force, double *state, double *value)
{
    walk(recurrence, steps, length, force, state, value);
}
