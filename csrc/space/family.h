/* Parts of a piece of WIDE coordinates and real numbers, several lines side by side: included by one source
   file each. */
#include "space/width.h"

#pragma GCC diagnostic ignored "-Wpsabi"

#define NUM lanes

RD_INLINE lanes number(double a)
{
    return l_fill(a);
}
RD_INLINE lanes add(lanes a, lanes b)
{
    return a + b;
}
RD_INLINE lanes subtract(lanes a, lanes b)
{
    return a - b;
}
RD_INLINE lanes times(lanes a, lanes b)
{
    return a * b;
}
RD_INLINE lanes scaled(lanes a, double s)
{
    return a * l_fill(s);
}
RD_INLINE lanes over(lanes a)
{
    return a * (1.0 / (a * a)); /* as of a complex number */
}
RD_INLINE lanes size(lanes a)
{
    return l_abs(a);
}
RD_INLINE lanes sizes(lanes a)
{
    return l_abs(a);
}
RD_INLINE int is_zero(lanes a)
{
    return !l_any((lane_mask)a << 1);
}
RD_INLINE int exceeds(lanes a, lanes b, double share)
{
    return l_any(l_above(l_abs(a), l_abs(scaled(b, share))));
}
RD_INLINE lane_mask larger(lanes a, lanes b)
{
    return l_above(l_abs(a), l_abs(b));
}
RD_INLINE void exchange(lanes *a, lanes *b, lane_mask m)
{
    const lanes x = *a;
    *a = l_select(m, *b, x);
    *b = l_select(m, x, *b);
}

#include "space/doubling.h"

int RD_SPACE_(family)(const struct rd_space_run *run, const lanes *E, int doublings, double gentle,
                      double *at, lanes *work)
{
    struct triple *own = (struct triple *)work;
    struct family f;
    struct rates summed;
    family_begin(run, own, &f);
    family_fill(run, E, &summed, &f);
    const int times = family_double(&f, doublings, gentle, own + RD_SPACE_NODES);
    for (size_t k = 0; k < (size_t)f.count; k++) {
        const lanes *from = &own[k].D[0][0];
        for (size_t i = 0; i < TRIPLE; i++)
            for (size_t lane = 0; lane < RD_LANES; lane++)
                at[(lane * RD_SPACE_NODES + k) * TRIPLE + i] = from[i][lane];
    }
    return times;
}
