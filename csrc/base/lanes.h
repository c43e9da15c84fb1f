/* Complex numbers of many frequencies side by side, real and imaginary parts apart. */
#ifndef RD_LANES_H
#define RD_LANES_H

#include "base/fast.h"

enum { RD_LANES = 8 };

typedef double lanes __attribute__((vector_size(8 * RD_LANES)));
typedef long long lane_mask __attribute__((vector_size(8 * RD_LANES)));

struct clanes {
    lanes re, im;
};

typedef struct clanes cv;

/* s in every lane: by halves, because gcc fills the whole vector number by number and a wide load
   after narrow stores waits for the cache */
RD_INLINE lanes l_fill(double s)
{
    typedef double half __attribute__((vector_size(4 * RD_LANES)));
    const half h = {s, s, s, s};
    lanes all;
    __builtin_memcpy(&all, &h, sizeof h);
    __builtin_memcpy((char *)&all + sizeof h, &h, sizeof h);
    return all;
}

RD_INLINE cv c_zero(void)
{
    return (cv){(lanes){0}, (lanes){0}};
}
RD_INLINE cv c_real(double a)
{
    return (cv){l_fill(a), (lanes){0}};
}
RD_INLINE cv c_imag(double a)
{
    return (cv){(lanes){0}, l_fill(a)};
}
RD_INLINE cv c_add(cv a, cv b)
{
    return (cv){a.re + b.re, a.im + b.im};
}
RD_INLINE cv c_sub(cv a, cv b)
{
    return (cv){a.re - b.re, a.im - b.im};
}
RD_INLINE cv c_neg(cv a)
{
    return (cv){-a.re, -a.im};
}
RD_INLINE cv c_scale_lanes(cv a, lanes s)
{
    return (cv){a.re * s, a.im * s};
}
RD_INLINE cv c_scale(cv a, double s)
{
    return c_scale_lanes(a, l_fill(s));
}
RD_INLINE cv c_times_i(cv a)
{
    return (cv){-a.im, a.re};
}

RD_INLINE cv c_mul(cv a, cv b)
{
    return (cv){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

RD_INLINE cv c_inverse(cv a)
{
    const lanes s = 1.0 / (a.re * a.re + a.im * a.im);
    return (cv){a.re * s, -(a.im * s)};
}

RD_INLINE lanes l_abs(lanes a)
{
    const lane_mask sign = (lane_mask){0} + (-0x7fffffffffffffffLL - 1);
    return (lanes)((lane_mask)a & ~sign);
}

/* |re| + |im|: within a factor sqrt(2) of the modulus */
RD_INLINE lanes c_size(cv a)
{
    return l_abs(a.re) + l_abs(a.im);
}

RD_INLINE lanes l_select(lane_mask m, lanes a, lanes b)
{
    return (lanes)(((lane_mask)a & m) | ((lane_mask)b & ~m));
}

/* as many as most machines have registers for */
typedef double half_lanes __attribute__((vector_size(4 * RD_LANES)));

/* a > b and a >= b by halves: vectors longer than a register gcc 12 compares number by number */
RD_INLINE lane_mask l_above(lanes a, lanes b)
{
    half_lanes x[2], y[2];
    lane_mask mask;
    __builtin_memcpy(x, &a, sizeof a);
    __builtin_memcpy(y, &b, sizeof b);
    for (int i = 0; i < 2; i++) {
        const __typeof__(x[i] > y[i]) half = x[i] > y[i];
        __builtin_memcpy((char *)&mask + i * (int)sizeof half, &half, sizeof half);
    }
    return mask;
}

RD_INLINE lane_mask l_not_below(lanes a, lanes b)
{
    half_lanes x[2], y[2];
    lane_mask mask;
    __builtin_memcpy(x, &a, sizeof a);
    __builtin_memcpy(y, &b, sizeof b);
    for (int i = 0; i < 2; i++) {
        const __typeof__(x[i] >= y[i]) half = x[i] >= y[i];
        __builtin_memcpy((char *)&mask + i * (int)sizeof half, &half, sizeof half);
    }
    return mask;
}

/* whether a bit is set in any lane */
RD_INLINE int l_any(lane_mask m)
{
    typedef long long half_mask __attribute__((vector_size(4 * RD_LANES)));
    half_mask half[2];
    __builtin_memcpy(half, &m, sizeof m);
    half[0] |= half[1];
    return (half[0][0] | half[0][1] | half[0][2] | half[0][3]) != 0;
}

RD_INLINE int c_is_zero(cv a)
{
    return !l_any(((lane_mask)a.re | (lane_mask)a.im) << 1);
}

#endif
