/* Frequency response by one sweep from each end, in scattering form. */
#include "sweep/sweep.h"

#include "closed/lane_trig.h"
#include "span/span.h"
#include "sweep/foot.h"
#include "sweep/order.h"
#include "sweep/parts.h"
#include "sweep/plan.h"

#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

/* By minors a third coordinate is seen beside its share r of the rotation, and after the element
   without: that costs (r z_beta/z)^2 of its last digits, which is much only where the rope can turn
   as a body and not twist. */
static int is_planar(const struct sweep *s, size_t lane)
{
    static const double SHEAR_MOST = 10.0;
    const double ratio = s->block.ratio[s->block.arm[0] ? 1 : 0][lane];
    return s->minors && s->shear * ratio * ratio <= SHEAR_MOST;
}

/* the frequencies order[first] .. that fit together; RD_SHORT_WAVES */
static enum rd_status begin_block(struct sweep *s, const struct rd_factors *factors, size_t first)
{
    s->used =
        rd_sweep_block_from(s->chain, &s->runs, factors, s->order, first, s->index, s->extent);
    if (s->used == 0)
        return RD_SHORT_WAVES;
    rd_sweep_scale(s->chain, &s->runs, factors, s->index, s->extent, &s->block, s->way);
    rd_sweep_feet(s->chain, &s->block, s->foot);
    s->planar = is_planar(s, 0);
    s->undamped = s->block.undamped[0] != 0;
    s->waves = s->block.waves[0] != 0;
    for (size_t lane = 1; lane < s->used; lane++)
        if (is_planar(s, lane) != s->planar || (s->block.undamped[lane] != 0) != s->undamped ||
            (s->block.waves[lane] != 0) != s->waves)
            s->used = lane;
    s->most = rd_sweep_most(s->extent, s->used);
    s->tabled.levels = 0;
    s->whole.count = s->compound.count = s->coupled.count = 0;
    s->made = (struct sweep_made){0};
    s->steps = l_fill(1.0);
    s->radians = l_fill(0.0);
    return RD_OK;
}

/* overflow counts as a resonance too */
static void find_infinite(const double *x, size_t rows, size_t count, size_t width, size_t *failed)
{
    for (size_t r = 0; r < rows; r++)
        for (size_t i = 0; i < *failed * width; i++)
            if (!isfinite(x[r * count * width + i]))
                *failed = i / width;
}

enum rd_status rd_frf_sweep(const struct rd_chain *chain, const struct rd_factors *factors,
                            const struct rd_ports *drives, const struct rd_ports *responses,
                            struct rd_workspace *workspace, double *value, double *error,
                            size_t *failed)
{
    struct sweep *s = rd_sweep_plan(chain, factors, drives, responses, workspace);
    if (!s)
        return RD_NO_MEMORY;
    const size_t count = factors->count, rows = drives->count * responses->count;
    const size_t all = s->swapped ? responses->count : drives->count;
    memset(value, 0, 2 * rows * count * sizeof *value);
    memset(error, 0, rows * count * sizeof *error);
    rd_sweep_order(factors, s->order);
    for (size_t first = 0; first < count; first += s->used) {
        const enum rd_status status = begin_block(s, factors, first);
        if (status != RD_OK)
            return status;
        rd_sweep_left(s);
        rd_sweep_right(s, count, all, value, error);
        if (some(s->radians > (double)RD_PIECES_MOST))
            return RD_SHORT_WAVES;
    }
    find_infinite(value, rows, count, 2, &s->failed);
    find_infinite(error, rows, count, 1, &s->failed);
    if (s->failed == count)
        return RD_OK;
    *failed = s->failed;
    return RD_SINGULAR;
}
