/* Triples of pieces in space, of WIDE coordinates and complex numbers, several lines side by side:
   included by one source file each. */
#include "base/lanes.h"
#include "space/width.h"

#include <assert.h>

#pragma GCC diagnostic ignored "-Wpsabi"

#define NUM cv
#define SIZE lanes
#define EITHER lane_mask

RD_INLINE cv number(double a)
{
    return c_real(a);
}
RD_INLINE cv add(cv a, cv b)
{
    return c_add(a, b);
}
RD_INLINE cv subtract(cv a, cv b)
{
    return c_sub(a, b);
}
RD_INLINE cv times(cv a, cv b)
{
    return c_mul(a, b);
}
RD_INLINE cv scaled(cv a, double s)
{
    return c_scale(a, s);
}
RD_INLINE cv over(cv a)
{
    return c_inverse(a);
}
RD_INLINE lanes size(cv a)
{
    return c_size(a);
}
/* NAN where one is */
RD_INLINE lanes larger_size(lanes a, lanes b)
{
    return l_select((a > b) | (a != a), a, b);
}
RD_INLINE lanes lesser_size(lanes a, lanes b)
{
    return l_select(a > b, b, a);
}
RD_INLINE int any(lane_mask m)
{
    long long either = 0;
    for (int i = 0; i < RD_LANES; i++)
        either |= m[i];
    return either != 0;
}
RD_INLINE int is_zero(cv a)
{
    return !any((lane_mask)((a.re != 0.0) | (a.im != 0.0)));
}
RD_INLINE lane_mask larger(cv a, cv b)
{
    return (lane_mask)(c_size(a) > c_size(b));
}
RD_INLINE void exchange(cv *a, cv *b, lane_mask m)
{
    const cv x = *a;
    *a = (cv){l_select(m, b->re, x.re), l_select(m, b->im, x.im)};
    *b = (cv){l_select(m, x.re, b->re), l_select(m, x.im, b->im)};
}

#include "space/kernel.h"

static RD_CLONES void family_fill(const struct rd_space_run *run, const cv *E, struct rates *rates,
                                  struct family *f)
{
    for (int i = 0; i < f->count; i++) {
        const double *series = run->series + (size_t)i * run->fields * RD_SPACE_ORDERS;
        rates_fill(run->fields, E, series, run->length * share_of(f), rates);
        first(rates, f->at + i);
    }
}

/* one doubling of all parts, unless one of their joints is farther from none than is gentle */
static RD_CLONES int doubled(struct family *f, double gentle, struct triple *longer)
{
    const int count = next_count(f);
    for (int i = 0; i < count; i++) {
        struct triple one, two;
        pair(f, i, &one, &two);
        if (any((lane_mask) ~(join(&one, &two, NULL, longer + i).away <= gentle)))
            return 0;
    }
    advance(f, count, longer);
    return 1;
}

static RD_CLONES void parts_write(const struct family *f, size_t parts, size_t lines,
                                  double _Complex *to)
{
    struct triple t;
    for (size_t k = 0; k < parts; k++) {
        part_of(f, (int)k, &t);
        const cv *from = &t.D[0][0];
        for (size_t i = 0; i < TRIPLE; i++)
            for (size_t line = 0; line < lines; line++)
                to[(line * parts + k) * TRIPLE + i] = CMPLX(from[i].re[line], from[i].im[line]);
    }
}

/* lines beyond the last are that once more */
static void lines_load(const double _Complex *from, size_t size, size_t lines, cv *to)
{
    for (size_t i = 0; i < size; i++)
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            const double _Complex x = from[(lane < lines ? lane : lines - 1) * size + i];
            to[i].re[lane] = creal(x);
            to[i].im[lane] = cimag(x);
        }
}

enum rd_status RD_SPACE_(triples)(const struct rd_space_run *run, size_t lines,
                                  const double _Complex *rates, int doublings, double gentle,
                                  double _Complex *triple, int *reached, int *whole,
                                  struct rd_workspace *workspace)
{
    const size_t own = run->fields * TRIPLE;
    cv *E = rd_take_aligned(workspace, own, sizeof *E, sizeof(lanes));
    struct rates *summed = rd_take_aligned(workspace, 1, sizeof *summed, sizeof(lanes));
    struct triple *at = rd_take_aligned(workspace, 2 * RD_SPACE_NODES, sizeof *at, sizeof(lanes));
    struct family f;
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    *reached = doublings;
    *whole = 1;
    const size_t parts = run->nodes == 1 ? 1 : (size_t)run->equal << (run->halvings - doublings);
    /* from the last line on, which is mostly that of the shortest waves: what it reaches all do */
    for (size_t batch = (lines + RD_LANES - 1) / RD_LANES; workspace->base && batch-- > 0;) {
        const size_t k = batch * RD_LANES;
        const size_t here = lines - k < RD_LANES ? lines - k : RD_LANES;
        int times = 0;
        lines_load(rates + k * own, own, here, E);
        family_begin(run, at, &f);
        family_fill(run, E, summed, &f);
        while (times < *reached && doubled(&f, gentle, at + RD_SPACE_NODES))
            times++;
        *whole &= times == *reached || k + here == lines;
        *reached = times;
        *whole &= run->nodes == 1 || times == doublings;
        if (run->nodes == 1 || times == doublings)
            parts_write(&f, parts, here, triple + k * parts * TRIPLE);
    }
    return RD_OK;
}
