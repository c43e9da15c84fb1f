/* Which frequencies go side by side. */
#include "sweep_order.h"

#include <stdbool.h>

/* |inertia|^2 */
static double key(const struct rd_factors *factors, size_t i)
{
    const double *x = factors->inertia + 2 * i;
    return x[0] * x[0] + x[1] * x[1];
}

/* Shell's sort: no memory, one pass where the frequencies are in order already */
void rd_sweep_order(const struct rd_factors *factors, size_t *order)
{
    const size_t count = factors->count;
    for (size_t i = 0; i < count; i++)
        order[i] = i;
    size_t gap = 1;
    while (gap < count / 3)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (size_t i = gap; i < count; i++) {
            const size_t moved = order[i];
            const double size = key(factors, moved);
            size_t j = i;
            for (; j >= gap && key(factors, order[j - gap]) > size; j -= gap)
                order[j] = order[j - gap];
            order[j] = moved;
        }
}

static bool same_levels(const struct rd_chain *chain, const struct rd_runs *runs,
                        const struct sweep_extent *x, const struct sweep_extent *y)
{
    for (size_t r = 0; r < runs->count; r++) {
        const struct rd_run *run = runs->run + r;
        const size_t n = run->last - run->first;
        const struct sweep_pieces a = rd_sweep_pieces(chain, run, n, x);
        const struct sweep_pieces b = rd_sweep_pieces(chain, run, n, y);
        if (a.level != b.level || a.halvings != b.halvings)
            return false;
    }
    return true;
}

size_t rd_sweep_block_from(const struct rd_chain *chain, const struct rd_runs *runs,
                           const struct rd_factors *factors, const size_t *order, size_t first,
                           size_t *index)
{
    const struct sweep_extent own = rd_sweep_extent(factors, order[first]);
    size_t used = 1;
    while (used < RD_LANES && first + used < factors->count) {
        const struct sweep_extent next = rd_sweep_extent(factors, order[first + used]);
        if (!same_levels(chain, runs, &own, &next))
            break;
        used++;
    }
    for (size_t lane = 0; lane < RD_LANES; lane++)
        index[lane] = order[first + (lane < used ? lane : used - 1)];
    return used;
}
