/* The change is added to the state, not the state multiplied: so a short step rounds what it adds,
   and frequencies are as exact after a million of them. */
#include "base/recurrence.h"

#include <string.h>

enum { PART = 256 }; /* samples whose sums over modes are kept at a time */

RD_INLINE half_lanes load(const double *from)
{
    half_lanes x;
    memcpy(&x, from, sizeof x);
    return x;
}

/* what pushes blocks, size + 1 numbers each */
RD_INLINE void fill_pushes(size_t size, size_t blocks, const double *sample, double *push)
{
    for (size_t b = 0; b < blocks; b++, sample += size) {
        *push++ = sample[0];
        *push++ = sample[1] - sample[0];
        for (size_t i = 2; i <= size; i++)
            *push++ = (sample[i] - sample[i - 1]) - (sample[i - 1] - sample[i - 2]);
    }
}

/* what one group does in all responses over blocks, added to the sums */
RD_INLINE void follow(const struct rd_recurrence *r, size_t group, size_t blocks,
                      const int32_t *kind, const double *push, double *state, half_lanes *sum)
{
    const size_t size = r->size, pushes = size + 1;
    const double *read = r->read + group * size * r->responses * 2 * RD_QUAD;
    half_lanes q = load(state), v = load(state + RD_QUAD);
    for (size_t b = 0; b < blocks; b++, sum += size) {
        const double *see = read;
        for (size_t m = 0; m < size; m++)
            for (size_t p = 0; p < r->responses; p++, see += 2 * RD_QUAD)
                sum[p * PART + m] += load(see) * q + load(see + RD_QUAD) * v;
        const size_t own = group * r->kinds + (size_t)kind[b];
        const double *c = r->change + own * RD_CHANGE * RD_QUAD;
        const double *gain = r->gain + own * pushes * 2 * RD_QUAD;
        half_lanes push_q = {0}, push_v = {0};
        for (size_t i = 0; i < pushes; i++, gain += 2 * RD_QUAD) {
            const double by = *push++;
            push_q += load(gain) * by;
            push_v += load(gain + RD_QUAD) * by;
        }
        const half_lanes dq = (load(c) * q + load(c + RD_QUAD) * v) + push_q;
        const half_lanes dv = (load(c + 2 * RD_QUAD) * q + load(c + 3 * RD_QUAD) * v) + push_v;
        q += dq;
        v += dv;
    }
    memcpy(state, &q, sizeof q);
    memcpy(state + RD_QUAD, &v, sizeof v);
}

/* the sums over modes, and what pushes within a block */
RD_INLINE void tell(const struct rd_recurrence *r, size_t blocks, const double *push,
                    const half_lanes *sum, double *value, size_t stride)
{
    const size_t size = r->size;
    for (size_t p = 0; p < r->responses; p++)
        for (size_t b = 0; b < blocks; b++)
            for (size_t m = 0; m < size; m++) {
                const double *local = r->local + (m * r->responses + p) * size;
                double total = 0;
                for (size_t k = 0; k < RD_QUAD; k++)
                    total += sum[p * PART + b * size + m][k];
                for (size_t i = 0; i <= m; i++)
                    total += local[i] * push[b * (size + 1) + i];
                value[p * stride + b * size + m] = total;
            }
}

RD_CLONES static void walk(const struct rd_recurrence *r, size_t blocks, const int32_t *kind,
                           const double *sample, double *state, half_lanes *work, double *value)
{
    const size_t most = PART / r->size, stride = blocks * r->size;
    double push[2 * PART];
    for (size_t first = 0; first < blocks; first += most) {
        const size_t some = blocks - first < most ? blocks - first : most;
        fill_pushes(r->size, some, sample + first * r->size, push);
        memset(work, 0, r->responses * PART * sizeof *work);
        for (size_t group = 0; group < r->groups; group++)
            follow(r, group, some, kind + first, push, state + group * 2 * RD_QUAD, work);
        tell(r, some, push, work, value + first * r->size, stride);
    }
}

size_t rd_recurrence_work(size_t responses)
{
    return responses * PART;
}

/* copies of a function per instruction set must be static, or the extension exports them */
void rd_recurrence_walk(const struct rd_recurrence *recurrence, size_t blocks, const int32_t *kind,
                        const double *sample, double *state, half_lanes *work, double *value)
{
    walk(recurrence, blocks, kind, sample, state, work, value);
}
