/* The phases of one tensed span that bends: Phi_n(y) = n pi at its nth mode.

   p = T L^2/B, K^2 = y^2 + max(-p, 0), A^2 = y^2 + max(p, 0). The two ends are joined by propagating
   waves, e^{-iK} each way, and by the evanescent wave, e = e^{-A}:

       Delta = 1 - e^2 rL rR,  g = 2 A K e/Delta
       M12 = g hL hR,  M11 = g e hL^2 rR,  M22 = g e hR^2 rL,  det M = -Delta M12^2
       Phi_n = K - etaL - etaR - atan2(M11 + M22, 1 - det M)
                 + (-1)^n atan2(2 M12, sqrt((1 + det M)^2 + (M11 - M22)^2))

   are K and the eigenphases of a lossless two-port, so that #{n >= 1: Phi_n >= n pi} is the number of
   eigenvalues below, negative ones among them, at every y where Delta > 0: from there Delta stays
   positive on the way to a long span, where e = 0 and the phases are those of two ends apart. */
#ifndef RD_SPAN_PHASE_H
#define RD_SPAN_PHASE_H

#include "closed/span_end.h"

struct span_ends {
    lanes p;
    struct end_springs end[2];
};

struct span_phase {
    struct turned mean, split; /* Phi_n = K - mean + (-1)^n split */
    lanes K, A, delta;
    lanes of_K, of_A, of_k[2], of_s[2]; /* slopes of Phi_n */
    lanes noise;                        /* of Phi_n, in units of eps */
};

/* Phi_n - n pi */
RD_INLINE lanes phase_beyond(const struct span_phase *phase, lane_mask odd, lanes n)
{
    const struct turned split = {l_negative_where(~odd, phase->split.eighths),
                                 l_negative_where(~odd, phase->split.rest)};
    struct turned all = t_add(phase->mean, split);
    all.eighths += 4.0 * n;
    return l_less_angle(phase->K, all);
}

/* at y > 0; with `sloped` also slopes and noise of Phi_n for n odd or even */
RD_INLINE struct span_phase span_phase(const struct span_ends *ends, lanes y, lane_mask odd,
                                       _Bool sloped)
{
    const lanes p = ends->p, y2 = y * y;
    const lane_mask tensed = p >= 0.0;
    const lanes other = l_root(y2 + l_abs(p));
    struct span_phase f;
    f.K = l_select(tensed, y, other);
    f.A = l_select(tensed, other, y);
    const struct wave_powers w = powers_of(f.K, f.A);
    const struct end_waves L = end_waves(ends->end, &w), R = end_waves(ends->end + 1, &w);

    lanes e;
    /* products of a smaller one are no normal numbers, which are slow, and change nothing */
    const lanes decays = l_least(f.A, l_fill(100));
    const lanes near = -l_expm1_of_minus(decays, &e) * (1.0 + e), e2 = e * e;
    const lanes unlike = l_select(L.r + R.r > 0.0, L.less + L.r * R.less, L.more - L.r * R.more);
    f.delta = near + e2 * unlike;
    const lanes per = 1.0 / f.delta, g = 2.0 * f.A * f.K * e * per;
    const lanes gL = g * L.h, gR = g * R.h, geL = gL * e, geR = gR * e;
    const lanes M12 = gL * R.h, M11 = geL * L.h * R.r, M22 = geR * R.h * L.r;
    const lanes bound = f.delta * M12 * M12; /* -det M */
    const lanes X = M11 + M22, Y = 1.0 + bound, q = 1.0 - bound, D = M11 - M22;
    const lanes Q = l_root(q * q + D * D);
    f.mean = t_add(t_add(L.eta, R.eta), l_angle(X, Y));
    f.split = l_angle(2.0 * M12, Q);
    if (!sloped)
        return f;

    /* d Phi by dM11, dM22, dM12, dDelta; the squared radii of both angles are the same */
    const lanes round = 1.0 / (X * X + Y * Y);
    const lanes t = l_negative_where(odd, 2.0 * M12 / Q);
    const lanes of_Y = (X + t * q) * round;
    const lanes of_11 = -(Y + t * D) * round, of_22 = -(Y - t * D) * round;
    const lanes of_12 = l_negative_where(odd, 2.0 * Q * round) + 2.0 * of_Y * f.delta * M12;
    const lanes both = of_11 * M11 + of_22 * M22, of_g = both + of_12 * M12;
    const lanes of_delta = of_Y * M12 * M12 - of_g * per;
    const lanes hL = 2.0 * of_11 * geL * R.r + of_12 * gR;
    const lanes hR = 2.0 * of_22 * geR * L.r + of_12 * gL;
    const lanes rL = of_22 * geR * R.h - of_delta * e2 * R.r;
    const lanes rR = of_11 * geL * L.h - of_delta * e2 * L.r;
    const struct end_slopes l = end_slopes(ends->end, &w, &L, hL, rL);
    const struct end_slopes r = end_slopes(ends->end + 1, &w, &R, hR, rR);
    f.of_K = 1.0 + of_g / f.K + l.K + r.K;
    f.of_A = of_g / f.A - (of_g + both - 2.0 * e2 * L.r * R.r * of_delta) + l.A + r.A;
    f.of_k[0] = l.k;
    f.of_k[1] = r.k;
    f.of_s[0] = l.s;
    f.of_s[1] = r.s;
    const lanes size = near + e2 * (l_abs(L.less) + l_abs(L.more) + l_abs(R.less) + l_abs(R.more));
    f.noise = 4.0 + l_select(tensed, l_abs(f.of_A) * f.A, l_abs(f.of_K) * f.K) +
              8.0 * (l_abs(of_11 * M11) + l_abs(of_22 * M22) + l_abs(of_12 * M12)) +
              4.0 * l_abs(of_delta) * size + l.noise + r.noise;
    return f;
}

#endif
