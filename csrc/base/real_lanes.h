/* What walks at real lambda need beside base/lanes.h. */
#ifndef RD_REAL_LANES_H
#define RD_REAL_LANES_H

#include "base/lanes.h"

RD_INLINE cv c_make(lanes re, lanes im)
{
    return (cv){re, im};
}

/* i x a */
RD_INLINE cv c_turn(cv a, lanes x)
{
    return (cv){-a.im * x, a.re * x};
}

/* 1/a; an exact zero is taken as 1e-150 */
RD_INLINE cv c_invert(cv a)
{
    const lanes s = 1.0 / (a.re * a.re + a.im * a.im + 1e-300);
    return (cv){a.re * s, -a.im * s};
}

RD_INLINE lanes lanes_load(const double *x)
{
    lanes y;
    for (int k = 0; k < RD_LANES; k++)
        y[k] = x[k];
    return y;
}

RD_INLINE lanes not_negative(lanes x)
{
    return l_select(x > 0.0, x, l_fill(0.0));
}

RD_INLINE _Bool every(lane_mask mask)
{
    long long sum = -1;
    for (int i = 0; i < RD_LANES; i++)
        sum &= mask[i];
    return sum != 0;
}

#endif
