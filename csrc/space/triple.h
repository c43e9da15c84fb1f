/* Triples of pieces in space, of WIDE coordinates and complex numbers, several lines side by side:
   included by one source file each. */
#include "base/lanes.h"
#include "space/width.h"

#include <assert.h>

#pragma GCC diagnostic ignored "-Wpsabi"

#define NUM cv

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
RD_INLINE int is_zero(cv a)
{
    return c_is_zero(a);
}
RD_INLINE cv sizes(cv a)
{
    return (cv){l_abs(a.re), l_abs(a.im)};
}
RD_INLINE int exceeds(cv a, cv b, double share)
{
    const cv most = c_scale(b, share);
    return l_any(l_above(l_abs(a.re), l_abs(most.re)) | l_above(l_abs(a.im), l_abs(most.im)));
}
RD_INLINE lane_mask larger(cv a, cv b)
{
    return l_above(c_size(a), c_size(b));
}
RD_INLINE void exchange(cv *a, cv *b, lane_mask m)
{
    const cv x = *a;
    *a = (cv){l_select(m, b->re, x.re), l_select(m, b->im, x.im)};
    *b = (cv){l_select(m, x.re, b->re), l_select(m, x.im, b->im)};
}

#include "space/doubling.h"

/* the parts that are kept of lines, (lines, nodes, 3, WIDE, WIDE) */
static void family_write(const struct family *f, size_t nodes, size_t lines, double _Complex *to)
{
    for (size_t k = 0; k < (size_t)f->count; k++) {
        const cv *from = &f->at[k].D[0][0];
        for (size_t i = 0; i < TRIPLE; i++)
            for (size_t line = 0; line < lines; line++)
                to[(line * nodes + k) * TRIPLE + i] = CMPLX(from[i].re[line], from[i].im[line]);
    }
}

/* lines beyond the last are that once more; whether all are real */
static int lines_load(const double _Complex *from, size_t size, size_t lines, cv *to)
{
    int real = 1;
    for (size_t i = 0; i < size; i++)
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            const double _Complex x = from[(lane < lines ? lane : lines - 1) * size + i];
            to[i].re[lane] = creal(x);
            to[i].im[lane] = cimag(x);
            real &= cimag(x) == 0;
        }
    return real;
}

struct parts {
    size_t own; /* numbers of a line */
    cv *E;
    struct rates *rates;
    struct triple *at; /* (2, RD_SPACE_NODES) */
    lanes *real;       /* E of real lines, their parts and the room of these */
};

/* of up to RD_LANES lines, to (lines, nodes, 3, WIDE, WIDE); returns how often they are doubled */
static int parts_fill(const struct parts *p, const struct rd_space_run *run, size_t lines,
                      const double _Complex *rates, int doublings, double gentle,
                      double _Complex *to)
{
    const size_t nodes = (size_t)run->nodes, all = RD_SPACE_NODES * TRIPLE;
    struct family f;
    if (!lines_load(rates, p->own, lines, p->E)) {
        family_begin(run, p->at, &f);
        family_fill(run, p->E, p->rates, &f);
        const int times = family_double(&f, doublings, gentle, p->at + RD_SPACE_NODES);
        family_write(&f, nodes, lines, to);
        return times;
    }
    lanes *own = p->real, *room = own + p->own;
    double *at = (double *)(room + rd_space_family_room(WIDE));
    for (size_t i = 0; i < p->own; i++)
        own[i] = p->E[i].re;
    const int times = RD_SPACE_(family)(run, own, doublings, gentle, at, room);
    for (size_t line = 0; line < lines; line++)
        for (size_t i = 0; i < nodes * TRIPLE; i++)
            to[line * nodes * TRIPLE + i] = at[line * all + i];
    return times;
}

enum rd_status RD_SPACE_(triples)(const struct rd_space_run *run, size_t lines,
                                  const double _Complex *rates, int doublings, double gentle,
                                  double _Complex *triple, int *reached, int *whole,
                                  struct rd_workspace *workspace)
{
    const size_t own = run->fields * TRIPLE, nodes = (size_t)run->nodes;
    const size_t room = own + rd_space_family_room(WIDE) + RD_SPACE_NODES * TRIPLE;
    struct parts parts = {.own = own};
    parts.E = rd_take_aligned(workspace, own, sizeof *parts.E, sizeof(lanes));
    parts.rates = rd_take_aligned(workspace, 1, sizeof *parts.rates, sizeof(lanes));
    parts.at = rd_take_aligned(workspace, 2 * RD_SPACE_NODES, sizeof *parts.at, sizeof(lanes));
    parts.real = rd_take_aligned(workspace, room, sizeof *parts.real, sizeof(lanes));
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    *reached = doublings;
    *whole = 1;
    /* from the last line on, which is mostly that of the shortest waves: what it reaches all do */
    for (size_t batch = (lines + RD_LANES - 1) / RD_LANES; workspace->base && batch-- > 0;) {
        const size_t k = batch * RD_LANES;
        const size_t here = lines - k < RD_LANES ? lines - k : RD_LANES;
        const int times = parts_fill(&parts, run, here, rates + k * own, *reached, gentle,
                                     triple + k * nodes * TRIPLE);
        *whole &= times == *reached || k + here == lines;
        *reached = times;
    }
    return RD_OK;
}
