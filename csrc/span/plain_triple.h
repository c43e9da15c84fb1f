/* A piece of a plain span (span/span.h) as a form: u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a, F = I + D.

   With the waves of span/halves.h over all of the piece, C, s, c, g at l, theta = a^2 - k^2 and b = 1/S':

       d = 2 q + (a^4 + k^4) C c + q theta s g
       F = E/d | a^2 c + k^2 C   (a^2 g + k^2 s) r |
               | q (g - s)/r     k^2 c + a^2 C     |
       G b d = r^2 E (s c - C g),  r (theta (C c - 1) + 2 q s g),  E (a^2 C g + k^2 s c)
       Q d/b = -q E (a^2 s c + k^2 C g)/r^2,  q (theta (C c - 1) - (a^4 + k^4) s g)/r,
               E (a^4 C g - k^4 s c)

   for zz, z beta and beta beta. d is 0 at the resonances of the piece as a cantilever. */
#ifndef RD_PLAIN_TRIPLE_H
#define RD_PLAIN_TRIPLE_H

#include "span/beam_slice.h"
#include "span/halves.h"

/* of one coordinate: F = 1/C, G = S' s/C, Q = q s/C */
struct rod_triple {
    cv D, G, Q;
};

RD_INLINE struct rod_triple rod_triple_of(cv soft, cv load, lanes length)
{
    const cv k = c_root(c_neg(c_mul(soft, load)));
    const cv kl = c_scale_lanes(k, length);
    const struct c_circle f = c_circle_of(kl);
    const cv per = c_inverse(f.cos), over = c_mul(c_scale_lanes(c_over(&f, kl), length), per);
    const cv one = {l_root(f.decay), l_fill(0)};
    return (struct rod_triple){
        .D = c_mul(c_sub(one, f.cos), per),
        .G = c_mul(soft, over),
        .Q = c_mul(load, over),
    };
}

/* (k l)^2 + (a l)^2 below which the series is the better one, and its terms for it: of 2^n/(2n + 2)! */
enum { BENT_BRIEF = 2, BENT_TERMS = 10 };

RD_INLINE struct wavenumbers bent_wavenumbers(cv soft, const cv *load, lanes r)
{
    return wavenumbers_of(c_mul(soft, load[1]), c_neg(c_mul(soft, c_scale_lanes(load[0], r * r))));
}

RD_INLINE lane_mask is_brief(const struct wavenumbers *w, lanes length)
{
    return ~l_above(c_size(w->E) * (length * length), l_fill((double)BENT_BRIEF));
}

/* The flexibility, transfer and stiffness of a piece of a plain span in units of the rate matrix: with z = r l phi,
   F = f/(r^2 S' l^3) and so on. D, G, Q as A, B and C of struct bent_span. */
struct bent_triple {
    cv D[4], G[3], Q[3];
};

RD_INLINE void bent_triple_scale(const struct beam_slice *b, cv soft, lanes r,
                                 struct bent_triple *t)
{
    const lanes back = 1.0 / r;
    const cv stiff = c_inverse(soft);
    t->D[0] = b->Dzz;
    t->D[1] = c_scale_lanes(b->Dzb, r);
    t->D[2] = c_scale_lanes(b->Dbz, back);
    t->D[3] = b->Dbb;
    t->G[0] = c_mul(soft, c_scale_lanes(b->Gzz, r * r));
    t->G[1] = c_mul(soft, c_scale_lanes(b->Gzb, r));
    t->G[2] = c_mul(soft, b->Gbb);
    t->Q[0] = c_mul(stiff, c_scale_lanes(b->Qzz, back * back));
    t->Q[1] = c_mul(stiff, c_scale_lanes(b->Qzb, back));
    t->Q[2] = c_mul(stiff, b->Qbb);
}

/* by power series */
RD_INLINE void bent_triple_brief(cv soft, const cv *load, lanes r, lanes length,
                                 struct bent_triple *t)
{
    const lanes square = length * length;
    const cv theta = c_scale_lanes(c_mul(soft, load[1]), square);
    const cv kappa =
        c_neg(c_scale_lanes(c_mul(soft, c_scale_lanes(load[0], r * r)), square * square));
    struct beam_slice b;
    beam_slice_fill(theta, kappa, BENT_TERMS, &b);
    bent_triple_scale(&b, c_scale_lanes(soft, length), r * length, t);
}

/* by waves; what has none of a wave is times what that decays by */
RD_INLINE void bent_triple_long(const struct wavenumbers *w, cv soft, lanes r, lanes length,
                                struct bent_triple *t)
{
    const struct half_waves x = half_waves_of(w, 2.0 * length);
    const lanes k_less = l_root(x.decay[0]), a_less = l_root(x.decay[1]), back = 1.0 / r;
    const cv k2 = w->k2, a2 = w->a2, q = w->q, E = w->E;
    const cv C = c_scale_lanes(x.C, a_less), s = c_scale_lanes(x.s, a_less);
    const cv c = c_scale_lanes(x.c, k_less), g = c_scale_lanes(x.g, k_less);
    const cv Cc = c_mul(x.C, x.c), sg = c_mul(x.s, x.g), Cg = c_mul(x.C, x.g), sc = c_mul(x.s, x.c);
    const cv a4 = c_mul(a2, a2), k4 = c_mul(k2, k2), both = c_add(a4, k4), theta = c_sub(a2, k2);
    const cv none = {k_less * a_less, l_fill(0)}, qsg = c_mul(q, sg);
    const cv d = c_add(c_scale_lanes(q, 2.0 * none.re), c_add(c_mul(both, Cc), c_mul(theta, qsg)));
    const cv per = c_inverse(d), Ed = c_mul(E, per);
    const cv swing = c_mul(theta, c_sub(Cc, none));
    t->D[0] = c_mul(Ed, c_add(c_mul(a2, c), c_mul(k2, C)));
    t->D[1] = c_scale_lanes(c_mul(Ed, c_add(c_mul(a2, g), c_mul(k2, s))), r);
    t->D[2] = c_scale_lanes(c_mul(c_mul(Ed, q), c_sub(g, s)), back);
    t->D[3] = c_mul(Ed, c_add(c_mul(k2, c), c_mul(a2, C)));
    t->D[0].re -= 1.0;
    t->D[3].re -= 1.0;
    const cv Gd = c_mul(soft, per), Qd = c_mul(c_inverse(soft), per);
    t->G[0] = c_scale_lanes(c_mul(c_mul(Gd, E), c_sub(sc, Cg)), r * r);
    t->G[1] = c_scale_lanes(c_mul(Gd, c_add(swing, c_add(qsg, qsg))), r);
    t->G[2] = c_mul(c_mul(Gd, E), c_add(c_mul(a2, Cg), c_mul(k2, sc)));
    t->Q[0] = c_scale_lanes(
        c_neg(c_mul(c_mul(c_mul(Qd, E), q), c_add(c_mul(a2, sc), c_mul(k2, Cg)))), back * back);
    t->Q[1] = c_scale_lanes(c_mul(c_mul(Qd, q), c_sub(swing, c_mul(both, sg))), back);
    t->Q[2] = c_mul(c_mul(Qd, E), c_sub(c_mul(a4, Cg), c_mul(k4, sc)));
}

RD_INLINE void bent_triple_where(lane_mask m, const struct bent_triple *a, struct bent_triple *b)
{
    for (int p = 0; p < 4; p++)
        b->D[p] = c_where(m, a->D[p], b->D[p]);
    for (int p = 0; p < 3; p++) {
        b->G[p] = c_where(m, a->G[p], b->G[p]);
        b->Q[p] = c_where(m, a->Q[p], b->Q[p]);
    }
}

RD_INLINE struct bent_triple bent_triple_of(cv soft, const cv *load, lanes r, lanes length)
{
    const struct wavenumbers w = bent_wavenumbers(soft, load, r);
    const lane_mask near = is_brief(&w, length);
    struct bent_triple t, brief;
    bent_triple_long(&w, soft, r, length, &t);
    if (!some(near))
        return t;
    bent_triple_brief(soft, load, r, length, &brief);
    bent_triple_where(near, &brief, &t);
    return t;
}

#endif
