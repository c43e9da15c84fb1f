/* Parts of a piece at several lines side by side, doubled at once: included by what defines NUM, numbers of
   RD_LANES lines, as kernel.h says. */
#define SIZE lanes
#define EITHER lane_mask

/* NAN where one is */
RD_INLINE lanes larger_size(lanes a, lanes b)
{
    return l_select(l_above(a, b) | ~l_not_below(a, a), a, b);
}
RD_INLINE lanes lesser_size(lanes a, lanes b)
{
    return l_select(l_above(a, b), b, a);
}
RD_INLINE int any(lane_mask m)
{
    return l_any(m);
}

#include "space/kernel.h"

static RD_CLONES void family_fill(const struct rd_space_run *run, const NUM *E, struct rates *rates,
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
        if (l_any(~l_not_below(l_fill(gentle), join(&one, &two, NULL, longer + i).away)))
            return 0;
    }
    advance(f, count, longer);
    return 1;
}

/* as often as is gentle, so often at most; returns how often */
static int family_double(struct family *f, int doublings, double gentle, struct triple *longer)
{
    int times = 0;
    while (times < doublings && doubled(f, gentle, longer))
        times++;
    return times;
}
