/* A uniform span that bends, by its two halves: what comes back of waves that come in.

   Half a span, h = l/2, moves symmetrically or antisymmetrically about its middle, with
   k^2 a^2 = mu omega^2/B, a^2 - k^2 = T/B, R^2 = k^2 + a^2. At its end u = (z, beta), the force is
   f = (T w' - B w''', B w''), both over their scales, u/s and f s with

       s_z = (B k a R)^-1/2,  s_beta = (B R)^-1/2

   so that with kappa = k/R, alpha = a/R, gamma^2 = kappa alpha, c = cos kh, s = sin kh, t = tanh ah
   the columns (u, f) of its motions cos kx, cosh ax/cosh ah and sin kx, sinh ax/cosh ah are

       (gamma c, -kappa s, -alpha gamma s, -kappa^2 c),  (gamma, alpha t, -kappa gamma t, alpha^2)
       (gamma s, kappa c, alpha gamma c, -kappa^2 s),    (gamma t, alpha, -kappa gamma, alpha^2 t)

   and G = (u - i f)(u + i f)^-1 = [[n, i g], [i g, n*]]/d, unitary, |d| from 1 to 1.56:

       d = ct (alpha + kappa^3) + s (kappa + alpha^3) + i (c - s t)                  symmetric
       n = ct (alpha - kappa^3) + s (kappa - alpha^3) + i (c + s t),  g = 2 gamma (kappa ct - alpha s)
       d = s (alpha + kappa^3) - ct (kappa + alpha^3) + i (c + s t)                  antisymmetric
       n = s (alpha - kappa^3) + ct (alpha^3 - kappa) - i (c - s t),  g = 2 gamma (alpha ct + kappa s)

   A wave b into both ends of the span, beta reversed at the left one, is (right +- left)/sqrt(2) into
   the halves; P = (G_s + G_a)/2 comes back and N = (G_s - G_a)/2 goes through. */
#ifndef RD_HALF_SPANS_H
#define RD_HALF_SPANS_H

#include "closed/lane_trig.h"

/* symmetric: (11, 12, 22) */
struct pair {
    cv a, b, c;
};

/* two waves */
struct duo {
    cv z, beta;
};

struct half {
    cv n, per; /* per = 1/d */
    lanes g;
    struct pair G;
};

struct span_waves {
    lanes kl, ah, kappa, alpha, gamma, c, s, t, fade; /* fade = 1 - t^2 */
    lanes E, ka;                                      /* R^2, k a */
    lanes of_z, of_beta;                              /* B k a R, B R */
    struct half sym, anti;
    struct pair P, N;
    cv lag; /* angle: what the phases of the halves lag behind kl; |angle| < 0.04 pi */
};

/* slopes of a phase by ln length, ln mu, T/B and ln B, scales fixed */
struct span_slopes {
    lanes length, inertia, tension, stiffness;
    lanes noise;
};

RD_INLINE cv c_conj(cv a)
{
    return (cv){a.re, -a.im};
}

RD_INLINE cv c_half_sum(cv a, cv b)
{
    return c_scale(c_add(a, b), 0.5);
}

RD_INLINE cv c_half_difference(cv a, cv b)
{
    return c_scale(c_sub(a, b), 0.5);
}

RD_INLINE struct duo pair_times(const struct pair *m, struct duo x)
{
    return (struct duo){c_add(c_mul(m->a, x.z), c_mul(m->b, x.beta)),
                        c_add(c_mul(m->b, x.z), c_mul(m->c, x.beta))};
}

RD_INLINE lanes c_square(cv a)
{
    return a.re * a.re + a.im * a.im;
}

RD_INLINE lanes duo_square(struct duo x)
{
    return c_square(x.z) + c_square(x.beta);
}

RD_INLINE struct half half_span(cv n, cv d, lanes g, lanes scale)
{
    const cv per = {d.re * scale, -d.im * scale};
    return (struct half){
        n, per, g, {c_mul(n, per), (cv){-g * per.im, g * per.re}, c_mul(c_conj(n), per)}};
}

/* of a span with sqrt(mu/B) and T/2B */
RD_INLINE struct span_waves span_waves(lanes length, lanes root_load, lanes pull, lanes B,
                                       lanes omega)
{
    struct span_waves w;
    const lanes ka = omega * root_load, spread = l_root(pull * pull + ka * ka);
    const lanes large = l_root(l_abs(pull) + spread), small = ka / large;
    const lane_mask tensed = pull >= 0.0;
    const lanes k = l_select(tensed, small, large), a = l_select(tensed, large, small);
    const lanes R = l_root(2.0 * spread), per = 1.0 / R;
    const lanes kappa = k * per, alpha = a * per, gamma = l_root(kappa * alpha);
    const lanes k3 = kappa * kappa * kappa, a3 = alpha * alpha * alpha;
    w.kl = k * length;
    w.ah = 0.5 * a * length;
    w.E = 2.0 * spread;
    w.ka = ka;
    w.of_beta = B * R;
    w.of_z = w.of_beta * ka;
    const struct l_circle at = l_circle_of(0.5 * w.kl);
    const lanes c = at.cos, s = at.sin;
    lanes e;
    const lanes lost = -l_expm1_of_minus(a * length, &e), whole = 1.0 / (1.0 + e), t = lost * whole;
    const lanes ct = c * t, st = s * t, more = c + st, less = c - st;
    const lanes p = alpha + k3, q = kappa + a3, x = alpha - k3, y = kappa - a3;
    const cv d = {ct * p + s * q, less}, D = {s * p - ct * q, more};
    const lanes ds = c_square(d), da = c_square(D), both = 1.0 / (ds * da), twice = 2.0 * gamma;
    w.sym = half_span((cv){ct * x + s * y, more}, d, twice * (kappa * ct - alpha * s), da * both);
    w.anti = half_span((cv){s * x - ct * y, -less}, D, twice * (alpha * ct + kappa * s), ds * both);
    const struct pair *S = &w.sym.G, *A = &w.anti.G;
    w.P = (struct pair){c_half_sum(S->a, A->a), c_half_sum(S->b, A->b), c_half_sum(S->c, A->c)};
    w.N = (struct pair){c_half_difference(S->a, A->a), c_half_difference(S->b, A->b),
                        c_half_difference(S->c, A->c)};
    w.lag = c_neg(c_mul(c_mul(d, D), (cv){c * c - s * s, 2.0 * c * s}));
    w.kappa = kappa;
    w.alpha = alpha;
    w.gamma = gamma;
    w.c = c;
    w.s = s;
    w.t = t;
    w.fade = 4.0 * e * whole * whole;
    return w;
}

/* what a change of (d, n, g) does to the phase of a wave into a half: -i v* dG b, v = G b */
struct half_weights {
    lanes d_re, d_im, n_re, n_im, g;
    lanes work_z, work_beta; /* u f */
};

RD_INLINE struct half_weights half_weights(const struct half *half, struct duo b)
{
    const struct duo v = pair_times(&half->G, b);
    const cv z = c_mul(c_conj(v.z), b.z), beta = c_mul(c_conj(v.beta), b.beta);
    const cv across = c_add(c_mul(c_conj(v.z), b.beta), c_mul(c_conj(v.beta), b.z));
    const cv sum = c_mul(half->per, c_add(z, beta)), split = c_mul(half->per, c_sub(z, beta));
    const lanes all = duo_square(b);
    return (struct half_weights){
        -all * half->per.im,         -all * half->per.re, sum.im,       split.re,
        c_mul(half->per, across).re, 0.5 * z.im,          0.5 * beta.im};
}

/* of waves into the right end and, mirrored, the left one: slopes of the phase, and its noise in eps */
RD_INLINE struct span_slopes span_slopes(const struct span_waves *w, lanes pull, struct duo right,
                                         struct duo left)
{
    const double half = 0.70710678118654752440;
    const struct duo both = {c_scale(c_add(right.z, left.z), half),
                             c_scale(c_add(right.beta, left.beta), half)};
    const struct duo across = {c_scale(c_sub(right.z, left.z), half),
                               c_scale(c_sub(right.beta, left.beta), half)};
    const struct half_weights S = half_weights(&w->sym, both), A = half_weights(&w->anti, across);
    const lanes k = w->kappa, a = w->alpha, c = w->c, s = w->s, g = w->gamma;
    const lanes k2 = k * k, a2 = a * a, k3 = k2 * k, a3 = a2 * a;
    const lanes p = a + k3, q = k + a3, x = a - k3, y = k - a3;
    const lanes ct = c * w->t, st = s * w->t, cf = c * w->fade, sf = s * w->fade;
    /* by kh, by ah, and as kappa turns towards alpha */
    const lanes by_kh = S.d_re * (c * q - st * p) - S.d_im * (s + ct) + S.n_re * (c * y - st * x) +
                        S.n_im * (ct - s) - 2.0 * g * S.g * (k * st + a * c) +
                        A.d_re * (c * p + st * q) + A.d_im * (ct - s) + A.n_re * (c * x + st * y) +
                        A.n_im * (s + ct) + 2.0 * g * A.g * (k * c - a * st);
    const lanes by_ah = cf * (S.d_re * p + S.n_re * x + 2.0 * g * k * S.g) +
                        sf * (S.n_im - S.d_im) - cf * (A.d_re * q + A.n_re * y) +
                        sf * (A.d_im + A.n_im) + 2.0 * g * a * cf * A.g;
    const lanes dk = k * a2, da = -a * k2, dk3 = 3.0 * k3 * a2, da3 = -3.0 * a3 * k2;
    const lanes dp = da + dk3, dq = dk + da3, dx = da - dk3, dy = dk - da3, dg = 0.5 * (a2 - k2);
    const lanes turn = S.d_re * (ct * dp + s * dq) + S.n_re * (ct * dx + s * dy) +
                       S.g * (dg * w->sym.g + 2.0 * g * (dk * ct - da * s)) +
                       A.d_re * (s * dp - ct * dq) + A.n_re * (s * dx - ct * dy) +
                       A.g * (dg * w->anti.g + 2.0 * g * (da * ct + dk * s));
    /* scales fixed: they go with k, a and B */
    const lanes work_z = S.work_z + A.work_z, work_beta = S.work_beta + A.work_beta;
    const lanes kh = 0.5 * w->kl * by_kh, ah = w->ah * by_ah;
    const lanes of_k = kh + turn - 2.0 * (work_z * (1.0 + k2) + work_beta * k2);
    const lanes of_a = ah - turn - 2.0 * (work_z * (1.0 + a2) + work_beta * a2);
    const lanes of_load = 0.5 * (a2 * of_k + k2 * of_a), of_pull = 0.5 * (of_a - of_k) / w->E;
    struct span_slopes of;
    of.length = kh + ah;
    of.inertia = of_load;
    of.tension = of_pull;
    of.stiffness = -of_load - 2.0 * pull * of_pull - 2.0 * (work_z + work_beta);
    of.noise = 12.0 * (duo_square(right) + duo_square(left)) + 4.0 * (l_abs(kh) + l_abs(ah)) +
               4.0 * (l_abs(turn) + l_abs(work_z) + l_abs(work_beta));
    return of;
}

#endif
