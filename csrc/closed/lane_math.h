/* Roots, arcs and exponentials of lanes: the same bits in every lane and instruction set, no libm. */
#ifndef RD_LANE_MATH_H
#define RD_LANE_MATH_H

#include <math.h>

#include "base/real_lanes.h"

/* an angle of `eighths` pi/4 + rest, |rest| <= pi/8, so that sums of angles cancel exactly */
struct turned {
    lanes eighths, rest;
};

RD_INLINE lanes l_root(lanes x)
{
    double y[RD_LANES];
    __builtin_memcpy(y, &x, sizeof y);
    for (int i = 0; i < RD_LANES; i++)
        y[i] = sqrt(y[i]);
    __builtin_memcpy(&x, y, sizeof y);
    return x;
}

RD_INLINE lanes l_least(lanes a, lanes b)
{
    return l_select(l_above(b, a), a, b);
}

RD_INLINE lanes l_most(lanes a, lanes b)
{
    return l_select(l_above(a, b), a, b);
}

RD_INLINE lanes l_negative_where(lane_mask m, lanes a)
{
    const lane_mask sign = (lane_mask){0} + (-0x7fffffffffffffffLL - 1);
    return (lanes)((lane_mask)a ^ (m & sign));
}

RD_INLINE _Bool any(lane_mask mask)
{
    long long sum = 0;
    for (int i = 0; i < RD_LANES; i++)
        sum |= mask[i];
    return sum != 0;
}

/* sum of c[k] x^k */
RD_INLINE lanes l_series(const double *c, int count, lanes x)
{
    lanes sum = l_fill(c[count - 1]);
#pragma GCC unroll 16
    for (int k = count - 2; k >= 0; k--)
        sum = sum * x + c[k];
    return sum;
}

/* The angle of (x, y) in -pi ... pi. |y/x| is turned by 0, pi/4 or pi/2 to |t| <= tan(pi/8), exactly
   up to one division; atan t = t + t^3 P(t^2), P the Chebyshev fit to 1e-18. */
RD_INLINE struct turned l_angle(lanes y, lanes x)
{
    static const double P[] = {-0x1.5555555555555p-2, 0x1.9999999999953p-3,  -0x1.249249248d7eep-3,
                               0x1.c71c71c304b64p-4,  -0x1.745d165df3ee7p-4, 0x1.3b1392d9e64b0p-4,
                               -0x1.110e880a643d8p-4, 0x1.e19a13b800ab6p-5,  -0x1.ac7a937cce153p-5,
                               0x1.74ddd3c6187b4p-5,  -0x1.1b33b8784aa69p-5, 0x1.0ad368c98424cp-6};
    const double tangent = 0x1.a827999fcef32p-2; /* of pi/8 */
    const lanes up = l_abs(y), across = l_abs(x);
    const lane_mask low = up <= tangent * across, high = across <= tangent * up;
    const lanes over = l_select(low, up, l_select(high, -across, up - across));
    const lanes under = l_select(low, across, l_select(high, up, up + across));
    const lanes t = over / under, u = t * t;
    lanes rest = t + t * u * l_series(P, 12, u);
    lanes eighths = l_select(low, l_fill(0), l_select(high, l_fill(2), l_fill(1)));
    const lane_mask back = x < 0.0, down = y < 0.0;
    eighths = l_select(back, 4.0 - eighths, eighths);
    rest = l_negative_where(back ^ down, rest);
    return (struct turned){l_negative_where(down, eighths), rest};
}

RD_INLINE struct turned t_add(struct turned a, struct turned b)
{
    return (struct turned){a.eighths + b.eighths, a.rest + b.rest};
}

RD_INLINE struct turned t_sub(struct turned a, struct turned b)
{
    return (struct turned){a.eighths - b.eighths, a.rest - b.rest};
}

/* K less an angle: m pi/4 in two parts, the first of 33 bits, so that small m times it is exact */
RD_INLINE lanes l_less_angle(lanes K, struct turned a)
{
    return ((K - 0x1.921fb544p-1 * a.eighths) - 0x1.0b4611a626331p-35 * a.eighths) - a.rest;
}

/* (x : 1) or (+-1 : 1/|x|) */
RD_INLINE lane_mask projected(lanes x, lanes *x1, lanes *x2)
{
    const lanes size = l_abs(x), one = l_fill(1);
    const lane_mask stiff = size > 1.0;
    *x1 = l_select(stiff, l_negative_where(x < 0.0, one), x);
    *x2 = l_select(stiff, 1.0 / size, one);
    return stiff;
}

/* e^-x - 1 for x >= 0, and e^-x beside it; x = k ln 2 - r, |r| <= ln(2)/2, e^r - 1 by its series.
   Beyond x = 700 it stays what it is there. */
RD_INLINE lanes l_expm1_of_minus(lanes x, lanes *e)
{
    static const double Q[] = {0x1.0000000000000p-1,  0x1.5555555555555p-3,  0x1.5555555555555p-5,
                               0x1.1111111111111p-7,  0x1.6c16c16c16c17p-10, 0x1.a01a01a01a01ap-13,
                               0x1.a01a01a01a01ap-16, 0x1.71de3a556c734p-19, 0x1.27e4fb7789f5cp-22,
                               0x1.ae64567f544e4p-26, 0x1.1eed8eff8d898p-29, 0x1.6124613a86d09p-33};
    const lanes y = -l_least(x, l_fill(700));
    const lanes shift = l_fill(0x1.8p52), bits = y * 0x1.71547652b82fep+0 + shift;
    const lanes k = bits - shift;
    const lanes r = (y - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
    const lanes q = r + r * r * l_series(Q, 12, r);
    typedef unsigned long long bits_of __attribute__((vector_size(8 * RD_LANES)));
    const lanes s = (lanes)(((bits_of)bits << 52) + (bits_of)l_fill(1));
    *e = s + s * q;
    return s * q + (s - 1.0);
}

#endif
