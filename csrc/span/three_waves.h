/* A uniform span of three coordinates in closed form, by what its halves do (span/halves.h): z and beta with
   a coordinate that follows the moment, such as the twist of a laid rope, or with the stretch of a
   rope that hangs.

   About its middle e, which is z and the forces of the others, is even in symmetric motions and o, of
   each the other one, is odd (span/parity.h). Both consist of three waves e'' = r e at the half h,

       symmetric  e c, o s,   antisymmetric  e r s, o c,   c = cosh h sqrt r, s = sinh(h sqrt r)/sqrt r

   With S', q of the rate matrix, t = S_oo q_o, theta = S_bb q_b, kappa = -Phi^2 S_bb q_z = k^2 a^2 and
   p = S_ob^2/(S_oo S_bb) the twist has

       (r - t)(r^2 - theta r - kappa) = p t (theta r + kappa):

   a^2 > 0 by Newton's steps from that without twist, the others < 0 from what is left. A rope that hangs
   has the waves of one that does not, and r = 0 of a tension that is the same everywhere.

   Where two waves are hardly different, the span is short or it is compressed the lane is not found. */
#ifndef RD_THREE_WAVES_H
#define RD_THREE_WAVES_H

#include "span/halves.h"
#include "span/plain_triple.h"

/* the numbers of a step of the sweep (span/whole.h), A and C by their upper rows, B by rows */
struct three_span {
    cv A[6], B[9], C[6];
    lanes radians;
    lane_mask found;
};

/* amplitudes of e and o, in the order of the coordinates, and the root of -r */
struct three_wave {
    cv r, way, e[3], o[3];
};

struct three_numbers {
    int z, other, beta;
    cv t, theta, kappa, share, less; /* share: p, less: 1 - p */
    struct wavenumbers bare;         /* without the third coordinate */
};

RD_INLINE struct three_numbers three_numbers_of(const struct rate_matrix *s)
{
    struct three_numbers n = {.z = s->z, .other = s->z == 0, .beta = 2};
    const cv soft = s->S[2][2], own = s->S[n.other][n.other];
    const cv both = s->elastic[n.other][2] ? s->S[n.other][2] : c_zero();
    const cv square = c_mul(both, both), product = c_mul(own, soft), per = c_inverse(product);
    n.t = c_mul(own, s->q[n.other]);
    n.theta = c_mul(soft, s->q[2]);
    n.kappa = c_neg(c_mul(soft, c_scale_lanes(s->q[n.z], s->lever * s->lever)));
    n.share = c_mul(square, per);
    n.less = c_mul(c_sub(product, square), per);
    n.bare = wavenumbers_of(n.theta, n.kappa);
    return n;
}

/* nearer to the positive axis than to any other */
RD_INLINE lane_mask is_forward(cv a)
{
    return l_above(a.re, 2.0 * l_abs(a.im));
}

/* two squares of wavenumbers that differ by less of their sum are too near: digits are lost as it */
#define THREE_NEAR 0.1

/* of Newton's, at most */
enum { THREE_STEPS = 6 };

RD_INLINE lane_mask is_apart(cv a, cv b)
{
    return l_above(c_size(c_sub(a, b)), THREE_NEAR * (c_size(a) + c_size(b)));
}

/* r of the three waves: the evanescent one, that of z and that of the third coordinate */
RD_INLINE lane_mask three_roots(const struct three_numbers *n, cv *r)
{
    const cv a2 = n->bare.a2, k2 = n->bare.k2, shared = c_mul(n->share, n->t);
    cv x = a2;
    lane_mask found = {0};
    for (int i = 0; i < THREE_STEPS; i++) {
        const cv d0 = c_sub(x, n->t), d1 = c_sub(x, a2), d2 = c_add(x, k2);
        const cv d02 = c_mul(d0, d2), d12 = c_mul(d1, d2), d01 = c_mul(d0, d1);
        const cv p = c_sub(c_mul(d0, d12), c_mul(shared, c_add(c_mul(n->theta, x), n->kappa)));
        const cv slope = c_sub(c_add(d02, c_add(d12, d01)), c_mul(shared, n->theta));
        const cv step = c_mul(p, c_inverse(slope));
        x = c_where(found, x, c_sub(x, step));
        found |= l_above(1e-9 * c_size(x), c_size(step));
        if (!some(~found))
            break;
    }
    /* product and sum of the others, in which nothing cancels */
    const cv per = c_inverse(x), less = c_mul(n->t, n->less);
    const cv product = c_neg(c_mul(c_mul(less, n->kappa), per));
    const cv sum = c_mul(c_sub(c_sub(c_mul(less, n->theta), n->kappa), product), per);
    cv root = c_root(c_sub(c_mul(sum, sum), c_scale(product, 4.0)));
    root = c_where(l_above(sum.re * root.re + sum.im * root.im, (lanes){0}), c_neg(root), root);
    const cv large = c_scale(c_sub(sum, root), 0.5), small = c_mul(product, c_inverse(large));
    const lane_mask turns = l_above(c_size(n->t), c_size(k2));
    r[0] = x;
    r[1] = c_where(turns, small, large);
    r[2] = c_where(turns, large, small);
    return found & is_apart(large, small) & is_apart(r[1], n->t) & is_apart(r[2], c_neg(k2));
}

/* waves of z and beta, which the third coordinate follows */
RD_INLINE void three_bent(const struct rate_matrix *s, const struct three_numbers *n, cv r,
                          struct three_wave *wave)
{
    const int z = n->z, o = n->other;
    const cv both = s->elastic[o][2] ? s->S[o][2] : c_zero(), d = c_inverse(c_sub(r, n->t));
    const cv b = c_mul(s->S[2][2], c_mul(c_sub(r, c_mul(n->t, n->less)), d));
    const cv follows = c_mul(r, c_mul(both, d));
    wave->r = r;
    wave->e[z] = c_scale_lanes(b, s->lever);
    wave->e[o] = c_mul(s->q[o], follows);
    wave->e[2] = r;
    wave->o[z] = c_mul(s->q[z], wave->e[z]);
    wave->o[o] = c_mul(r, follows);
    wave->o[2] = c_mul(r, b);
}

/* the wave of the third coordinate */
RD_INLINE void three_other(const struct rate_matrix *s, const struct three_numbers *n, cv r,
                           struct three_wave *wave)
{
    const int z = n->z, o = n->other;
    const cv both = s->elastic[o][2] ? s->S[o][2] : c_zero();
    const cv d = c_mul(both, c_inverse(c_mul(c_sub(r, n->bare.a2), c_add(r, n->bare.k2))));
    const cv load = c_sub(c_mul(s->q[2], r), c_scale_lanes(s->q[z], s->lever * s->lever));
    wave->r = r;
    wave->e[z] = c_scale_lanes(c_mul(r, d), s->lever);
    wave->e[o] = c_real(1.0);
    wave->e[2] = c_mul(load, d);
    wave->o[z] = c_mul(s->q[z], wave->e[z]);
    wave->o[o] = c_mul(r, c_inverse(s->q[o]));
    wave->o[2] = c_mul(c_mul(r, r), d);
}

RD_INLINE lane_mask three_coupled(const struct rate_matrix *s, const struct three_numbers *n,
                                  struct three_wave *wave)
{
    cv r[3];
    const lane_mask found = three_roots(n, r) & is_forward(c_neg(n->t));
    three_bent(s, n, r[0], wave);
    three_bent(s, n, r[1], wave + 1);
    three_other(s, n, r[2], wave + 2);
    return found;
}

/* (k l)^2 below which a rope that hangs moves along z as it does under a tension that is the same
   everywhere, but for their small difference */
#define THREE_LONGEST 1.0

/* Of a rope that hangs; x is the first coordinate and has no inertia. */
RD_INLINE lane_mask three_hanging(const struct rate_matrix *s, const struct three_numbers *n,
                                  lanes length, struct three_wave *wave)
{
    const cv r[2] = {n->bare.a2, c_neg(n->bare.k2)}, along = c_mul(s->sag, c_inverse(s->q[1]));
    const lanes back = 1.0 / s->lever;
    for (int j = 0; j < 2; j++)
        wave[j] = (struct three_wave){
            .r = r[j],
            .e = {c_zero(), c_real(1.0), c_scale_lanes(c_mul(r[j], c_inverse(s->S[2][2])), back)},
            .o = {s->sag, s->q[1], c_scale_lanes(r[j], back)},
        };
    wave[2] = (struct three_wave){
        .r = c_zero(),
        .e = {c_real(1.0), along, c_zero()},
        .o = {c_add(s->S[0][0], c_mul(s->sag, along)), c_zero(), c_zero()},
    };
    const lanes rest = c_size(s->q[0]) + c_size(n->share);
    return ~l_above(rest, (lanes){0}) &
           l_above(c_size(n->bare.k2) * (length * length), l_fill(THREE_LONGEST));
}

RD_INLINE void three_invert(cv m[3][3], cv x[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            x[i][j] = c_sub(c_mul(m[r][c], m[s][d]), c_mul(m[r][d], m[s][c]));
        }
    const cv det =
        c_add(c_mul(m[0][0], x[0][0]), c_add(c_mul(m[0][1], x[1][0]), c_mul(m[0][2], x[2][0])));
    const cv per = c_inverse(det);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            x[i][j] = c_mul(x[i][j], per);
}

/* (i, j) of A B */
RD_INLINE cv three_product(cv A[3][3], cv B[3][3], int i, int j)
{
    return c_add(c_mul(A[i][0], B[0][j]), c_add(c_mul(A[i][1], B[1][j]), c_mul(A[i][2], B[2][j])));
}

/* motions u and N = u - i f of both kinds, and J of each wave between them */
struct three_halves {
    cv us[3][3], Ns[3][3], ua[3][3], Na[3][3], J[3];
    lanes radians;
};

RD_INLINE void three_halves_of(const struct three_wave *wave, int z, lanes length,
                               struct three_halves *x)
{
    const lanes h = 0.5 * length;
    x->radians = l_fill(0.0);
    for (int j = 0; j < 3; j++) {
        const struct three_wave *w = wave + j;
        const cv way = c_scale_lanes(w->way, h);
        const struct c_circle f = c_circle_of(way);
        const cv c = f.cos, s = c_scale_lanes(c_over(&f, way), h), rs = c_mul(w->r, s);
        x->radians = l_most(x->radians, 2.0 * l_abs(way.re));
        cv sum = c_zero();
        for (int i = 0; i < 3; i++) {
            const cv es = c_mul(w->e[i], c), os = c_mul(w->o[i], s);
            const cv ea = c_mul(w->e[i], rs), oa = c_mul(w->o[i], c), eo = c_mul(w->e[i], w->o[i]);
            x->us[i][j] = i == z ? es : os;
            x->Ns[i][j] = i == z ? less_i(es, os) : less_i(os, es);
            x->ua[i][j] = i == z ? ea : oa;
            x->Na[i][j] = i == z ? less_i(ea, oa) : less_i(oa, ea);
            sum = i == z ? c_sub(sum, eo) : c_add(sum, eo);
        }
        x->J[j] = c_times_i(c_scale_lanes(sum, f.decay));
    }
}

RD_INLINE void three_span_of_halves(struct three_halves *x, int z, struct three_span *span)
{
    cv s[3][3], a[3][3], sum[3][3], apart[3][3], Ja[3][3], inverse[3][3], Y[3][3];
    three_invert(x->Ns, s);
    three_invert(x->Na, a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            Ja[i][j] = c_mul(a[j][i], x->J[j]);
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            sum[i][j] = sum[j][i] =
                c_add(three_product(x->us, s, i, j), three_product(x->ua, a, i, j));
            apart[i][j] = apart[j][i] = three_product(Ja, s, i, j);
        }
    three_invert(sum, inverse);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            Y[i][j] = three_product(apart, inverse, i, j);
            const cv B = c_times_i(Y[i][j]);
            span->B[3 * i + j] = j == z ? B : c_neg(B);
        }
    for (int i = 0, p = 0; i < 3; i++)
        for (int j = i; j < 3; j++, p++) {
            span->A[p] = c_scale(c_sub(sum[i][j], three_product(Y, apart, i, j)), 0.5);
            const cv C = c_times_i(c_scale(inverse[i][j], 2.0));
            span->C[p] = (i == z) == (j == z) ? C : c_neg(C);
            span->C[p].im -= i == j ? 2.0 : 0.0;
        }
}

/* of three coordinates, z with beta and another */
RD_INLINE void three_span_of(const struct rate_matrix *s, lanes length, struct three_span *span)
{
    struct three_wave wave[3];
    struct three_halves x;
    const struct three_numbers n = three_numbers_of(s);
    span->found = s->hangs ? three_hanging(s, &n, length, wave) : three_coupled(s, &n, wave);
    span->found &= is_forward(n.bare.k2) & is_forward(n.bare.a2) &
                   l_not_below(n.theta.re, (lanes){0}) & ~is_brief(&n.bare, length);
    wave[0].way = c_times_i(c_root(wave[0].r));
    wave[1].way = c_root(c_neg(wave[1].r));
    wave[2].way = c_root(c_neg(wave[2].r));
    three_halves_of(wave, n.z, length, &x);
    three_span_of_halves(&x, n.z, span);
    span->radians = x.radians;
}

/* compiled once */
void rd_three_span(const struct rate_matrix *rate, const lanes *length, struct three_span *span);

#endif
