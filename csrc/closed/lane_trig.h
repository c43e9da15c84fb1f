/* Sines, cosines and roots of lanes, real and complex: the same bits in every lane and instruction set,
   no libm. */
#ifndef RD_LANE_TRIG_H
#define RD_LANE_TRIG_H

#include "closed/lane_math.h"

/* The angle n pi/2 + rest, |rest| <= pi/4, and its sine and cosine. */
struct l_circle {
    lanes quarters, rest, sin, cos;
};

/* pi/2 in parts of 27, 27 and 53 bits, so that n times the first two is exact up to n = 2^26, and the
   Taylor series on |rest| <= pi/4, whose next terms are below 1e-18 */
RD_INLINE struct l_circle l_circle_of(lanes x)
{
    static const double P[] = {-0x1.5555555555555p-3,  0x1.1111111111111p-7,
                               -0x1.a01a01a01a01ap-13, 0x1.71de3a556c734p-19,
                               -0x1.ae64567f544e4p-26, 0x1.6124613a86d09p-33,
                               -0x1.ae7f3e733b81fp-41, 0x1.952c77030ad4ap-49};
    static const double Q[] = {0x1.5555555555555p-5,  -0x1.6c16c16c16c17p-10,
                               0x1.a01a01a01a01ap-16, -0x1.27e4fb7789f5cp-22,
                               0x1.1eed8eff8d898p-29, -0x1.93974a8c07c9dp-37,
                               0x1.ae7f3e733b81fp-45, -0x1.6827863b97d97p-53};
    const lanes shift = l_fill(0x1.8p52), bits = x * 0x1.45f306dc9c883p-1 + shift;
    const lanes n = bits - shift;
    const lanes r = ((x - n * 0x1.921fb54p0) - n * 0x1.10b461p-30) - n * 0x1.a62633145c06ep-58;
    const lanes u = r * r, half = 0.5 * u, one = 1.0 - half;
    const lanes s = r + r * u * l_series(P, 8, u);
    const lanes c = one + (((1.0 - one) - half) + u * u * l_series(Q, 8, u));
    const lane_mask odd = ((lane_mask)bits & 1) != 0;
    const lane_mask below = ((lane_mask)bits & 2) != 0;
    return (struct l_circle){
        .quarters = n,
        .rest = r,
        .sin = l_negative_where(below, l_select(odd, c, s)),
        .cos = l_negative_where(below ^ odd, l_select(odd, s, c)),
    };
}

/* whether any lane is set, by halves */
RD_INLINE _Bool some(lane_mask mask)
{
    typedef long long half __attribute__((vector_size(4 * RD_LANES)));
    typedef long long quarter __attribute__((vector_size(2 * RD_LANES)));
    half low, high;
    quarter q[2];
    __builtin_memcpy(&low, &mask, sizeof low);
    __builtin_memcpy(&high, (char *)&mask + sizeof low, sizeof high);
    low |= high;
    __builtin_memcpy(q, &low, sizeof low);
    q[0] |= q[1];
    return (q[0][0] | q[0][1]) != 0;
}

/* whether any lane is not zero */
RD_INLINE _Bool some_number(lanes a)
{
    return some((lane_mask)a << 1);
}

/* The root in the right half plane. Of real numbers alone the rest would come to the same bits. */
RD_INLINE cv c_root(cv z)
{
    const lane_mask right = l_not_below(z.re, (lanes){0});
    const lanes across = l_abs(z.re);
    if (!some_number(z.im)) {
        const lanes root = l_root(across), none = l_fill(0);
        return (cv){l_select(right, root, none), l_select(right, none, root)};
    }
    const lanes size = l_root(z.re * z.re + z.im * z.im);
    const lanes long_side = l_root(0.5 * (across + size));
    const lane_mask is_zero = long_side == 0.0;
    const lanes short_side = l_abs(0.5 * z.im / l_select(is_zero, l_fill(1), long_side));
    const lane_mask down = l_above((lanes){0}, z.im);
    return (cv){l_select(right, long_side, short_side),
                l_negative_where(down, l_select(right, short_side, long_side))};
}

/* cos z and sin z, both times e^-|Im z|, and e^-2|Im z| */
struct c_circle {
    cv cos, sin;
    lanes decay;
    cv phase;             /* e^{i Re z} */
    lanes quarters, rest; /* of Re z */
};

/* where all are real, or all imaginary, what that leaves has the same bits */
RD_INLINE struct c_circle c_circle_of(cv z)
{
    struct l_circle u = {.sin = l_fill(0), .cos = l_fill(1)};
    struct c_circle f = {.decay = l_fill(1)};
    lanes less = l_fill(0);
    if (some_number(z.re))
        u = l_circle_of(z.re);
    if (some_number(z.im))
        less = l_expm1_of_minus(2.0 * l_abs(z.im), &f.decay);
    const lanes ch = 0.5 * (1.0 + f.decay),
                sh = l_negative_where(l_above((lanes){0}, z.im), -0.5 * less);
    f.cos = (cv){u.cos * ch, -(u.sin * sh)};
    f.sin = (cv){u.sin * ch, u.cos * sh};
    f.phase = (cv){u.cos, u.sin};
    f.quarters = u.quarters;
    f.rest = u.rest;
    return f;
}

#endif
