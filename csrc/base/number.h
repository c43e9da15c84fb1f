/* The kind of number that what is included after this works with: complex or, where nothing is damped,
   real, which is as much as the same with imaginary parts of 0, to the bit. Included with RD_REAL 0
   and 1. */
#undef n_
#undef num
#if RD_REAL
#define n_(verb) r_##verb
#define num lanes
#else
#define n_(verb) c_##verb
#define num cv
#endif

#ifndef RD_NUMBER_H
#define RD_NUMBER_H

#include "base/lanes.h"

RD_INLINE cv c_of(cv a)
{
    return a;
}
RD_INLINE cv c_as_complex(cv a)
{
    return a;
}
RD_INLINE cv c_plus(cv a, double b)
{
    return (cv){a.re + b, a.im};
}

RD_INLINE lanes c_lanes(cv a)
{
    return a.re;
}

RD_INLINE lanes r_lanes(lanes a)
{
    return a;
}
RD_INLINE lanes r_of(cv a)
{
    return a.re;
}
RD_INLINE cv r_as_complex(lanes a)
{
    return (cv){a, (lanes){0}};
}
RD_INLINE lanes r_real(double a)
{
    return l_fill(a);
}
RD_INLINE lanes r_zero(void)
{
    return (lanes){0};
}
RD_INLINE lanes r_plus(lanes a, double b)
{
    return a + b;
}
RD_INLINE lanes r_add(lanes a, lanes b)
{
    return a + b;
}
RD_INLINE lanes r_sub(lanes a, lanes b)
{
    return a - b;
}
RD_INLINE lanes r_neg(lanes a)
{
    return -a;
}
RD_INLINE lanes r_mul(lanes a, lanes b)
{
    return a * b;
}
RD_INLINE lanes r_scale(lanes a, double s)
{
    return a * s;
}
RD_INLINE lanes r_scale_lanes(lanes a, lanes s)
{
    return a * s;
}
RD_INLINE lanes r_inverse(lanes a)
{
    return a * (1.0 / (a * a));
}
RD_INLINE lanes r_size(lanes a)
{
    return l_abs(a);
}

#endif
