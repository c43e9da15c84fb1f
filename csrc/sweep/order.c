/* Which frequencies go side by side. */
#include "sweep/order.h"

#include "span/span.h"

#include <stdbool.h>
#include <string.h>

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

/* whether the waves of two continuous runs are the same */
static bool is_same_rope(const struct rd_chain *chain, int32_t a, int32_t b)
{
    const size_t w = chain->width, i = (size_t)a, j = (size_t)b;
    const double *S = chain->flexibility, *p = chain->inertia, *drag = chain->drag;
    return chain->tension[i] == chain->tension[j] &&
           memcmp(S + 9 * i, S + 9 * j, 9 * sizeof *S) == 0 &&
           memcmp(p + w * i, p + w * j, w * sizeof *p) == 0 &&
           (!drag || memcmp(drag + w * i, drag + w * j, w * sizeof *drag) == 0) &&
           (!chain->sag || chain->sag[i] == chain->sag[j]);
}

/* whether inertia alone grows from frequency to frequency, so that waves become shorter */
static bool is_growing(const struct sweep_extent *x, size_t count)
{
    bool growing = true;
    for (size_t i = 1; i < count; i++)
        growing = growing && x[i].section == x->section && x[i].tension == x->tension &&
                  x[i].spring == x->spring && x[i].inertia >= x[i - 1].inertia &&
                  x[i].dashpot >= x[i - 1].dashpot;
    return growing;
}

/* waves of the frequencies of a block on one run, found when they are asked for */
struct run_waves {
    struct sweep_waves of[RD_LANES];
    unsigned known; /* bits */
};

static struct sweep_pieces pieces_at(const struct rd_chain *chain, const struct rd_run *run,
                                     const struct sweep_extent *extent, size_t lane,
                                     struct run_waves *waves)
{
    if (!(waves->known >> lane & 1))
        waves->of[lane] = rd_sweep_waves(chain, run, extent + lane);
    waves->known |= 1u << lane;
    return rd_sweep_pieces(chain, run, run->last - run->first, waves->of[lane]);
}

/* how many of the frequencies cross a run by as many pieces as the first does, 0 where those are more
   than are walked */
static size_t alike(const struct rd_chain *chain, const struct rd_run *run,
                    const struct sweep_extent *extent, size_t count, bool growing,
                    struct run_waves *waves)
{
    const struct sweep_pieces first = pieces_at(chain, run, extent, 0, waves);
    if (chain->inertia && first.count >> first.level > RD_PIECES_MOST)
        return 0;
    /* between two frequencies that cross it alike all do */
    size_t i = growing && count > 1 ? count - 1 : 1;
    for (; i < count; i++) {
        const struct sweep_pieces own = pieces_at(chain, run, extent, i, waves);
        if (own.level == first.level && own.halvings == first.halvings)
            continue;
        if (!growing)
            return i;
        growing = false;
        i = 0;
    }
    return count;
}

/* the same of an element whose tension grows along it: by the same pieces of the same blocks */
static size_t alike_graded(const struct rd_chain *chain, size_t e,
                           const struct sweep_extent *extent, size_t count)
{
    struct rd_block first[RD_BLOCKS_MOST], own[RD_BLOCKS_MOST];
    struct rd_sizes sizes = rd_sweep_sizes(extent);
    const size_t blocks = rd_blocks_of(chain, e, &sizes, false, first);
    if (blocks == 0)
        return 0;
    for (size_t i = 1; i < count; i++) {
        sizes = rd_sweep_sizes(extent + i);
        if (rd_blocks_of(chain, e, &sizes, false, own) != blocks)
            return i;
        for (size_t k = 0; k < blocks; k++)
            if (own[k].length != first[k].length || own[k].halvings != first[k].halvings ||
                own[k].pieces != first[k].pieces)
                return i;
    }
    return count;
}

size_t rd_sweep_block_from(const struct rd_chain *chain, const struct rd_runs *runs,
                           const struct rd_factors *factors, const size_t *order, size_t first,
                           size_t *index, struct sweep_extent *extent)
{
    size_t used = factors->count - first < RD_LANES ? factors->count - first : RD_LANES;
    for (size_t lane = 0; lane < used; lane++)
        extent[lane] = rd_sweep_extent(factors, order[first + lane]);
    struct run_waves waves = {.known = 0};
    const bool growing = is_growing(extent, used);
    for (size_t r = 0; r < runs->count && used > 0; r++) {
        const struct rd_run *run = runs->run + r;
        if (rd_span_is_plain(chain, (size_t)run->element))
            continue;
        if (rd_is_graded(chain, (size_t)run->element)) {
            if (factors->between)
                continue;
            used = alike_graded(chain, (size_t)run->element, extent, used);
            continue;
        }
        if (r == 0 || !chain->inertia || !is_same_rope(chain, run[-1].element, run->element))
            waves.known = 0;
        used = alike(chain, run, extent, used, growing, &waves);
    }
    if (used == 0)
        return 0;
    for (size_t lane = 0; lane < RD_LANES; lane++)
        index[lane] = order[first + (lane < used ? lane : used - 1)];
    for (size_t lane = used; lane < RD_LANES; lane++)
        extent[lane] = extent[used - 1];
    return used;
}
