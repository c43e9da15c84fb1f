/* Structures that nodes carry, at the frequencies of a block. */
#include "sweep/foot.h"

#include <math.h>

#pragma GCC diagnostic ignored "-Wpsabi"

static void set(cv *x, int lane, double _Complex value)
{
    x->re[lane] = creal(value);
    x->im[lane] = cimag(value);
}

static void load(const struct rd_chain *chain, const struct sweep_block *block, size_t k, int lane,
                 struct sweep_foot *into)
{
    struct rd_foot foot;
    double _Complex lever[RD_WIDTH_MAX];
    rd_attached_fill(chain, k, CMPLX(block->inertia.re[lane], block->inertia.im[lane]),
                     CMPLX(block->dashpot.re[lane], block->dashpot.im[lane]), &foot);
    rd_attached_row(chain, k, foot.lever, lever);
    /* their quotient counts: squares of both are numbers */
    const double size = fmax(cabs(foot.gap), 1);
    set(&into->weight, lane, foot.weight / size);
    set(&into->gap, lane, foot.gap / size);
    set(&into->phase, lane, cexp(CMPLX(0, cimag(foot.growth))));
    into->growth[lane] = creal(foot.growth) + log(size);
    for (int part = 0; part < 2; part++) {
        set(into->rest + part, lane, foot.rest[part]);
        into->rests[part] |= foot.rest[part] != 0;
    }
    for (size_t i = 0; i < chain->width; i++) {
        set(into->lever + i, lane, lever[i]);
        into->moves[i] |= lever[i] != 0;
    }
}

void rd_sweep_feet(const struct rd_chain *chain, const struct sweep_block *block,
                   struct sweep_foot *foot)
{
    for (size_t k = 0; k < chain->attached; k++) {
        foot[k] = (struct sweep_foot){.rests = {0}};
        for (int lane = 0; lane < RD_LANES; lane++)
            load(chain, block, k, lane, foot + k);
    }
}

lanes rd_sweep_foot_size(const struct rd_chain *chain, const struct sweep_foot *foot, size_t term,
                         size_t i)
{
    lanes sum = {0};
    for (size_t k = rd_attached_first(chain, term); rd_attached_is_of(chain, k, (int32_t)term);
         k++) {
        const double *row = chain->attached_row + 2 * k * chain->width + i;
        const lanes lever = c_size(foot[k].lever[i]);
        for (size_t part = 0; part < 2; part++)
            sum +=
                c_size(foot[k].rest[part]) * (row[part * chain->width] * row[part * chain->width]);
        sum += c_size(foot[k].weight) * c_size(c_inverse(foot[k].gap)) * lever * lever;
    }
    return sum;
}
