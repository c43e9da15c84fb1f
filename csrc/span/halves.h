/* A uniform span whose coordinates are not coupled, in closed form: by what its halves do.

   About its middle a motion is symmetric (z even, beta odd) or antisymmetric. In units of the rate
   matrix (span/rate_matrix.h), with b = 1/S', r = Phi_z,beta and the wavenumbers

       a^2 - k^2 = S' q_beta,  a^2 k^2 = -S' q_z r^2

   two motions of each kind at the end of the half h, as columns (z, beta, F, M); C = cos kh,
   s = sin(kh)/k, c = cosh ah, g = sinh(ah)/a, q = k^2 a^2:

       symmetric      (C, -k^2 s/r, -q s b/r^2, -k^2 C b/r),  (c, a^2 g/r, -q g b/r^2, a^2 c b/r)
       antisymmetric  (s, C/r, a^2 C b/r^2, -k^2 s b/r),      (g, c/r, -k^2 c b/r^2, a^2 g b/r)

   With u, f the matrices of motion and force, P = u (u - i f)^-1 is the part behind a walk that the
   half would be (sweep/sweep.h): no frequency is without it, and it consists of 2 x 2 minors, in each
   of which the closeness of both waves is a factor that cancels. Of both kinds

       Sigma = P_s + P_a,  Delta = P_s - P_a = i N_a^-T J N_s^-1,  N = u - i f,  J = u_a^T f_s - f_a^T u_s

   are all that a span gives. J is diagonal and the same everywhere: by it what decays along the span
   has its own digits, where the difference would not. */
#ifndef RD_HALVES_H
#define RD_HALVES_H

#include "closed/lane_trig.h"
#include "span/rate_matrix.h"

/* what the propagating wave does on its way along the half */
struct half_way {
    cv phase;             /* e^{i Re(k h)} */
    lanes quarters, rest; /* Re(k h) = quarters pi/2 + rest */
    cv det[2];            /* 1/det N_s and 1/det N_a times numbers > 0 */
};

/* Sigma and Delta: zz, z beta, beta beta */
struct bent_halves {
    cv sum[3], apart[3];
    struct half_way way;
};

struct plain_halves {
    cv sum, apart, both; /* both: P_s P_a */
    struct half_way way;
};

/* radians of the whole span */
RD_INLINE lanes way_radians(const struct half_way *way)
{
    return 2.0 * l_abs(way->quarters * 0x1.921fb54442d18p+0 + way->rest);
}

RD_INLINE struct half_way way_of(const struct c_circle *f)
{
    return (struct half_way){
        .phase = f->phase,
        .quarters = f->quarters,
        .rest = f->rest,
    };
}

RD_INLINE cv c_where(lane_mask m, cv a, cv b)
{
    return (cv){l_select(m, a.re, b.re), l_select(m, a.im, b.im)};
}

/* sin(z)/z as c_circle_of has sin z: where z is small by its series, in whose terms nothing cancels when
   z is stepped */
RD_INLINE cv c_over(const struct c_circle *f, cv z)
{
    const lane_mask small = l_above(l_fill(0.5), c_size(z));
    const cv over = c_mul(f->sin, c_inverse(z));
    if (!some(small))
        return over;
    const cv x = c_mul(z, z);
    cv sum = c_real(1);
    for (int n = 8; n > 0; n--) {
        sum = c_scale(c_mul(sum, x), -1.0 / (double)(2 * n * (2 * n + 1)));
        sum.re += 1.0;
    }
    return c_where(small, c_scale_lanes(sum, l_root(f->decay)), over);
}

/* u' = S' f, f' = q u: u = cos kx and sin(kx)/k, k^2 = -S' q */
RD_INLINE struct plain_halves plain_halves_of(cv soft, cv load, lanes length)
{
    const lanes h = 0.5 * length;
    const cv k = c_root(c_neg(c_mul(soft, load)));
    const cv kh = c_scale_lanes(k, h);
    const struct c_circle f = c_circle_of(kh);
    const cv s = c_scale_lanes(c_over(&f, kh), h), fs = c_mul(load, s),
             fa = c_mul(f.cos, c_inverse(soft));
    /* u - i f */
    const cv inverse_s = c_inverse(c_add(f.cos, (cv){fs.im, -fs.re}));
    const cv inverse_a = c_inverse(c_add(s, (cv){fa.im, -fa.re}));
    const cv Ps = c_mul(f.cos, inverse_s), Pa = c_mul(s, inverse_a);
    const cv J = c_scale_lanes(c_inverse(soft), -f.decay);
    struct plain_halves halves = {
        .sum = c_add(Ps, Pa),
        .both = c_mul(Ps, Pa),
        .apart = c_times_i(c_mul(J, c_mul(inverse_s, inverse_a))),
        .way = way_of(&f),
    };
    halves.way.det[0] = inverse_s;
    halves.way.det[1] = inverse_a;
    return halves;
}

/* both wavenumbers, the smaller one from their product */
struct wavenumbers {
    cv k2, a2, q, E, k, a; /* q = k^2 a^2, E = k^2 + a^2 */
};

RD_INLINE struct wavenumbers wavenumbers_of(cv theta, cv kappa)
{
    const cv half = c_scale(theta, 0.5);
    const cv R = c_root(c_add(c_mul(half, half), kappa));
    const lane_mask tensed = l_not_below(half.re * R.re + half.im * R.im, (lanes){0});
    const cv large = c_where(tensed, c_add(R, half), c_sub(R, half));
    const cv small = c_mul(kappa, c_inverse(large));
    struct wavenumbers w = {.q = kappa, .E = c_scale(R, 2)};
    w.k2 = c_where(tensed, small, large);
    w.a2 = c_where(tensed, large, small);
    w.k = c_root(w.k2);
    w.a = c_root(w.a2);
    return w;
}

/* cos kh, sin(kh)/k, cosh ah, sinh(ah)/a, times the roots of what the first and the last two decay by
   along the span */
struct half_waves {
    cv C, s, c, g;
    lanes decay[2];
    struct half_way way;
};

RD_INLINE struct half_waves half_waves_of(const struct wavenumbers *w, lanes length)
{
    const lanes h = 0.5 * length;
    /* cosh z = cos iz, sinh(z)/z = sin(iz)/(iz) */
    const cv kh = c_scale_lanes(w->k, h), iah = c_times_i(c_scale_lanes(w->a, h));
    const struct c_circle k = c_circle_of(kh), a = c_circle_of(iah);
    return (struct half_waves){
        .C = k.cos,
        .s = c_scale_lanes(c_over(&k, kh), h),
        .c = a.cos,
        .g = c_scale_lanes(c_over(&a, iah), h),
        .decay = {k.decay, a.decay},
        .way = way_of(&k),
    };
}

/* minors of (z, beta, F, M), all times the lever r */
struct minors {
    cv zb, zM, Fb, zF, FM;
};

/* P = u (u - i f)^-1 and 1/det(u - i f) */
RD_INLINE cv minors_part(const struct minors *m, cv *P)
{
    const cv d = c_sub(m->zb, m->FM), e = c_add(m->zM, m->Fb);
    const cv inverse = c_inverse((cv){d.re + e.im, d.im - e.re});
    P[0] = c_mul((cv){m->zb.re + m->zM.im, m->zb.im - m->zM.re}, inverse);
    P[1] = c_mul(c_times_i(m->zF), inverse);
    P[2] = c_mul((cv){m->zb.re + m->Fb.im, m->zb.im - m->Fb.re}, inverse);
    return inverse;
}

/* x - i y */
RD_INLINE cv less_i(cv x, cv y)
{
    return (cv){x.re + y.im, x.im - y.re};
}

/* x + i y */
RD_INLINE cv more_i(cv x, cv y)
{
    return (cv){x.re - y.im, x.im + y.re};
}

/* Delta: the rows of adj(u - i f) of each wave, antisymmetric times symmetric */
RD_INLINE void bent_apart(const struct wavenumbers *w, const struct half_waves *x, cv b, lanes back,
                          cv scale, cv *apart)
{
    const cv bb = c_scale_lanes(b, back * back), bq = c_mul(bb, w->q);
    const cv k2 = w->k2, a2 = w->a2, a2b = c_mul(a2, bb), k2b = c_mul(k2, bb);
    const cv s[2][2] = {
        {c_scale_lanes(c_mul(a2, less_i(x->g, c_mul(b, x->c))), back),
         c_neg(more_i(x->c, c_mul(bq, x->g)))},
        {c_scale_lanes(c_mul(k2, less_i(x->s, c_mul(b, x->C))), back),
         more_i(x->C, c_mul(bq, x->s))},
    };
    const cv a[2][2] = {
        {c_scale_lanes(less_i(x->c, c_mul(c_mul(b, a2), x->g)), back),
         c_neg(more_i(x->g, c_mul(k2b, x->c)))},
        {c_scale_lanes(c_neg(more_i(x->C, c_mul(c_mul(b, k2), x->s))), back),
         less_i(x->s, c_mul(a2b, x->C))},
    };
    for (int i = 0, p = 0; i < 2; i++)
        for (int j = i; j < 2; j++, p++) {
            const cv propagating = c_scale_lanes(c_mul(a[0][i], s[0][j]), -x->decay[0]);
            const cv evanescent = c_scale_lanes(c_mul(a[1][i], s[1][j]), x->decay[1]);
            apart[p] = c_mul(scale, c_add(propagating, evanescent));
        }
}

/* minors of both kinds */
RD_INLINE void minors_of(const struct wavenumbers *w, const struct half_waves *x, cv b, lanes back,
                         struct minors *symmetric, struct minors *antisymmetric)
{
    const cv k2 = w->k2, a2 = w->a2, q = w->q;
    const cv Cc = c_mul(x->C, x->c), sg = c_mul(x->s, x->g);
    const cv Cg = c_mul(x->C, x->g), sc = c_mul(x->s, x->c);
    const cv near = c_sub(sc, Cg), sum = c_add(c_mul(a2, Cg), c_mul(k2, sc));
    const cv bE = c_mul(b, w->E), bEr = c_scale_lanes(bE, back * back);
    const cv br = c_scale_lanes(b, back), bq = c_mul(br, q), bbr = c_mul(br, br);
    const cv a4Cg = c_mul(c_mul(a2, a2), Cg), k4sc = c_mul(c_mul(k2, k2), sc);
    *symmetric = (struct minors){
        .zb = sum,
        .zM = c_mul(bE, Cc),
        .Fb = c_neg(c_mul(bEr, c_mul(q, sg))),
        .zF = c_mul(bq, near),
        .FM = c_neg(c_mul(bq, c_mul(br, c_add(c_mul(a2, sc), c_mul(k2, Cg))))),
    };
    *antisymmetric = (struct minors){
        .zb = near,
        .zM = c_mul(bE, sg),
        .Fb = c_mul(bEr, Cc),
        .zF = c_neg(c_mul(br, sum)),
        .FM = c_mul(bbr, c_sub(a4Cg, k4sc)),
    };
}

/* the same of real numbers: their products alone */
RD_INLINE void minors_of_real(const struct wavenumbers *w, const struct half_waves *x, cv b,
                              lanes back, struct minors *symmetric, struct minors *antisymmetric)
{
    const lanes k2 = w->k2.re, a2 = w->a2.re, q = w->q.re;
    const lanes Cc = x->C.re * x->c.re, sg = x->s.re * x->g.re;
    const lanes Cg = x->C.re * x->g.re, sc = x->s.re * x->c.re;
    const lanes near = sc - Cg, sum = a2 * Cg + k2 * sc;
    const lanes bE = b.re * w->E.re, bEr = bE * (back * back);
    const lanes br = b.re * back, bq = br * q, bbr = br * br;
    const lanes a4Cg = a2 * a2 * Cg, k4sc = k2 * k2 * sc;
    *symmetric = (struct minors){
        .zb.re = sum,
        .zM.re = bE * Cc,
        .Fb.re = -(bEr * (q * sg)),
        .zF.re = bq * near,
        .FM.re = -(bq * (br * (a2 * sc + k2 * Cg))),
    };
    *antisymmetric = (struct minors){
        .zb.re = near,
        .zM.re = bE * sg,
        .Fb.re = bEr * Cc,
        .zF.re = -(br * sum),
        .FM.re = bbr * (a4Cg - k4sc),
    };
}

RD_INLINE _Bool is_real(const struct wavenumbers *w, cv b)
{
    return !some((w->k.im != 0.0) | (w->a.im != 0.0) | (b.im != 0.0));
}

RD_INLINE struct bent_halves bent_halves_of(const struct wavenumbers *w, cv b, lanes r,
                                            lanes length)
{
    const struct half_waves x = half_waves_of(w, length);
    const lanes back = 1.0 / r;
    struct minors symmetric, antisymmetric;
    if (is_real(w, b))
        minors_of_real(w, &x, b, back, &symmetric, &antisymmetric);
    else
        minors_of(w, &x, b, back, &symmetric, &antisymmetric);
    cv Ps[3], Pa[3];
    struct bent_halves f = {.way = x.way};
    f.way.det[0] = minors_part(&symmetric, Ps);
    f.way.det[1] = minors_part(&antisymmetric, Pa);
    for (int i = 0; i < 3; i++) {
        f.sum[i] = c_add(Ps[i], Pa[i]);
        f.apart[i] = c_sub(Ps[i], Pa[i]);
    }
    const lane_mask faint = x.decay[0] < 0.5;
    if (some(faint)) {
        const cv per = c_mul(f.way.det[0], f.way.det[1]);
        cv apart[3];
        bent_apart(w, &x, b, back, c_times_i(c_mul(c_mul(b, w->E), per)), apart);
        for (int i = 0; i < 3; i++)
            f.apart[i] = c_where(faint, apart[i], f.apart[i]);
    }
    return f;
}

#endif
