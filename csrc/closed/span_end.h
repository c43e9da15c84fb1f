/* One end of a tensed span that bends, on springs of either sign across it and against its turning.

   Waves e^{-ikx}, e^{-ax} over the length 1: K = k L, A = a L. Springs kappa = kappa_beta L/B and
   sigma = sigma_z L^3/B are projective, kappa = k1/k2 and sigma = s1/s2, held (1 : 0), free (0 : 1).
   With E = A^2 + K^2, C^2 + S^2 = N^2, a propagating wave comes back with the phase 2 eta, an
   evanescent one as r of itself, and h takes one to the other:

       C = s1 (k2 E + A k1) - s2 k2 A K^4        S = K [k1 s1 - s2 k1 A E - s2 k2 A^4]
       eta = atan2(S, C)                         h = (s1 k1 + s2 k2 A^2 K^2)/N
       1 - r = 2 [C s1 k2 E + S K (k1 s1 - s2 k2 A^4)]/N^2
       1 + r = 2 [C A (s1 k1 - s2 k2 K^4) - S K A E s2 k1]/N^2

   eta is continuous from -pi to pi; where kappa or sigma is negative it is from -2 pi to 0. */
#ifndef RD_SPAN_END_H
#define RD_SPAN_END_H

#include "closed/lane_math.h"

struct end_springs {
    lanes k1, k2, s1, s2;
    lane_mask stiff_k, stiff_s; /* |kappa| > 1: k2 follows from it, else k1; sigma likewise */
    lane_mask negative;
};

struct end_waves {
    lanes C, S, H, a, b; /* a and b: what C and S are multiplied with in 1 - r */
    lanes per, h;        /* 1/N^2 */
    lanes r, less, more; /* 1 - r, 1 + r */
    struct turned eta;
};

struct wave_powers {
    lanes K, K2, K3, K4, A, A2, A3, A4, E;
};

/* of a function f, by the inputs of an end and by how its rounding moves it */
struct end_slopes {
    lanes K, A, k, s, noise;
};

RD_INLINE struct wave_powers powers_of(lanes K, lanes A)
{
    const lanes K2 = K * K, A2 = A * A;
    return (struct wave_powers){K, K2, K2 * K, K2 * K2, A, A2, A2 * A, A2 * A2, K2 + A2};
}

RD_INLINE struct end_springs end_of_springs(lanes kappa, lanes sigma)
{
    struct end_springs end;
    end.stiff_k = projected(kappa, &end.k1, &end.k2);
    end.stiff_s = projected(sigma, &end.s1, &end.s2);
    end.negative = (kappa < 0.0) | (sigma < 0.0);
    return end;
}

RD_INLINE struct end_waves end_waves(const struct end_springs *end, const struct wave_powers *w)
{
    const lanes k1 = end->k1, k2 = end->k2, s1 = end->s1, s2 = end->s2;
    const lanes kk = s2 * k2, ks = k1 * s1, ak = s2 * k1 * w->A * w->E;
    struct end_waves x;
    x.a = s1 * k2 * w->E;
    x.b = w->K * (ks - kk * w->A4);
    x.C = x.a + w->A * ks - kk * w->A * w->K4;
    x.S = x.b - w->K * ak;
    x.H = ks + kk * w->A2 * w->K2;
    x.per = 1.0 / (x.C * x.C + x.S * x.S);
    x.h = x.H * l_root(x.per);
    x.less = 2.0 * (x.C * x.a + x.S * x.b) * x.per;
    x.more = 2.0 * (x.C * w->A * (ks - kk * w->K4) - x.S * w->K * ak) * x.per;
    x.r = 0.5 * (x.more - x.less);
    x.eta = l_angle(x.S, x.C);
    const lane_mask above = (x.S > 0.0) | ((x.S == 0.0) & (x.C < 0.0));
    const lanes turn = l_select(end->negative & above, l_fill(8), l_fill(0));
    x.eta.eighths -= turn;
    return x;
}

/* of f with df = -d eta + wh dh + wr dr; noise in units of eps */
RD_INLINE struct end_slopes end_slopes(const struct end_springs *end, const struct wave_powers *w,
                                       const struct end_waves *x, lanes wh, lanes wr)
{
    const lanes k1 = end->k1, k2 = end->k2, s1 = end->s1, s2 = end->s2;
    const lanes K = w->K, A = w->A, E = w->E, A2 = w->A2, A3 = w->A3, A4 = w->A4;
    const lanes K2 = w->K2, K3 = w->K3, K4 = w->K4;
    /* by what the end is made of */
    const lanes C = x->per * (x->S - wh * x->h * x->C - 2.0 * wr * (x->a - x->less * x->C));
    const lanes S = x->per * (-x->C - wh * x->h * x->S - 2.0 * wr * (x->b - x->less * x->S));
    const lanes H = wh * l_root(x->per);
    const lanes a = -2.0 * wr * x->C * x->per, b = -2.0 * wr * x->S * x->per;
    const lanes kk = s2 * k2, sk = s1 * k2, ks = k1 * s1, ss = s2 * k1;
    const lanes q = ks - kk * A4;
    struct end_slopes d;
    d.K = C * (2.0 * sk * K - 4.0 * kk * A * K3) + S * (q - ss * A * (E + 2.0 * K2)) +
          2.0 * H * kk * A2 * K + 2.0 * a * sk * K + b * q;
    d.A = C * (2.0 * sk * A + ks - kk * K4) - S * K * (ss * (E + 2.0 * A2) + 4.0 * kk * A3) +
          2.0 * H * kk * A * K2 + 2.0 * a * sk * A - 4.0 * b * K * kk * A3;
    const lanes k_soft = C * s1 * A + S * K * (s1 - s2 * A * E) + H * s1 + b * K * s1;
    const lanes k_stiff = C * (s1 * E - s2 * A * K4) - S * K * s2 * A4 + H * s2 * A2 * K2 +
                          a * s1 * E - b * K * s2 * A4;
    const lanes s_soft = C * (k2 * E + A * k1) + S * K * k1 + H * k1 + a * k2 * E + b * K * k1;
    const lanes s_stiff =
        -C * k2 * A * K4 - S * K * (k1 * A * E + k2 * A4) + H * k2 * A2 * K2 - b * K * k2 * A4;
    d.k = l_select(end->stiff_k, k_stiff, k_soft);
    d.s = l_select(end->stiff_s, s_stiff, s_soft);
    /* each product within 8 eps of its size */
    const lanes size_b = K * (l_abs(ks) + l_abs(kk) * A4);
    const lanes size_C = l_abs(x->a) + l_abs(ks) * A + l_abs(kk) * A * K4;
    const lanes size_S = size_b + K * l_abs(ss) * A * E;
    d.noise = 8.0 * (l_abs(C) * size_C + l_abs(S) * size_S + l_abs(b) * size_b +
                     l_abs(H) * (l_abs(ks) + l_abs(kk) * A2 * K2) + l_abs(a * x->a));
    return d;
}

#endif
