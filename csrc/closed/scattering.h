/* Parts of a chain that bends, by what comes back of the waves that are sent into them.

   u and f over their scales at the face of a part, f the force on it; b = u + i f goes in and
   a = u - i f = G b comes back, G symmetric and unitary, det G = e^{i theta}. theta grows with omega
   and stays continuous, so that it counts: of a part whose face is free each of its two eigenphases
   passes 2 pi times a whole number at an eigenvalue.

       free     G = 1, theta = 0
       station  coordinate j with n = (stiffness - omega^2 inertia) s_j^2 and scales s_j r before:
                q = (1 + G_jj) (1 + i n) + r^2 (1 - G_jj)
                G_kk <- G_kk - (1 - r^2 + i n) G_jk^2/q,  G_jk <- 2 r G_jk/q
                G_jj <- 2 (1 + G_jj)/q - 1,  theta -= 2 arg q;  n = n1/n2, q times n2
       hinge    G <- diag(G_zz + G_zb^2/(1 - G_bb), 1),  theta += pi - 2 arg(1 - G_bb)
       span     beta reversed, Y = (G - det G adj P)/D, D = det(1 - P G): G <- P + N Y N
                theta += 2 kl - 2 arg D - 2 lag

   arg D + lag is within 0.54 pi, for P has one singular value below 1 and one below 0.21. */
#ifndef RD_SCATTERING_H
#define RD_SCATTERING_H

#include "closed/half_spans.h"

struct part {
    struct pair G;
    lanes K; /* theta/2 = K - less */
    struct turned less;
};

/* of one coordinate: b_j = own b'_j - other b'_k gives back what went in before */
struct passed {
    cv own, other;
};

/* a station, or a hinge, that was passed */
struct station {
    struct passed z, beta;
    lanes load_z, load_beta; /* |stiffness| + omega^2 inertia over the scales */
    cv hinge;                /* b_beta = hinge b_z, where there is one */
    struct pair G;           /* with what stands at the station, before the hinge */
};

/* what stands at a station, and scales of what is on both of its sides */
struct standing {
    lanes mass, turning, spring_z, spring_beta;
};

struct scales {
    lanes z, beta; /* s^-2 */
};

RD_INLINE struct part free_part(void)
{
    const cv one = c_real(1), none = c_zero();
    return (struct part){{one, none, one}, l_fill(0), {l_fill(0), l_fill(0)}};
}

RD_INLINE void lag(struct part *part, cv by)
{
    part->less = t_add(part->less, l_angle(by.im, by.re));
}

/* beta reversed */
RD_INLINE struct pair mirrored(struct pair G)
{
    G.b = c_neg(G.b);
    return G;
}

RD_INLINE struct duo mirrored_duo(struct duo x)
{
    x.beta = c_neg(x.beta);
    return x;
}

/* of coordinate j beside k */
RD_INLINE struct passed pass_coordinate(cv *jj, cv *jk, cv *kk, lanes n, lanes ratio, cv *turn)
{
    lanes n1, n2;
    projected(n, &n1, &n2);
    const cv up = c_add(c_real(1), *jj), down = c_scale_lanes(c_sub(c_real(1), *jj), n2 * ratio);
    const cv q = c_add(c_mul(up, c_make(n2, n1)), down), per = c_invert(q);
    const cv x = c_mul(*jk, per), other = c_mul(c_make(n2 * (1.0 - ratio), n1), x);
    const lanes through = 2.0 * n2 * l_root(ratio);
    *kk = c_sub(*kk, c_mul(other, *jk));
    *jk = c_scale_lanes(x, through);
    *jj = c_sub(c_scale_lanes(c_mul(up, per), 2.0 * n2), c_real(1));
    *turn = q;
    return (struct passed){c_scale_lanes(per, through), other};
}

RD_INLINE struct station pass_station(struct part *part, const struct standing *here, lanes omega,
                                      struct scales before, struct scales after)
{
    const lanes square = omega * omega;
    const lanes per_z = 1.0 / after.z, per_beta = 1.0 / after.beta;
    const lanes inert_z = square * here->mass * per_z;
    const lanes inert_beta = square * here->turning * per_beta;
    const lanes stiff_z = here->spring_z * per_z, stiff_beta = here->spring_beta * per_beta;
    struct station station;
    struct pair *G = &part->G;
    cv turn_z, turn_beta;
    station.z = pass_coordinate(&G->a, &G->b, &G->c, stiff_z - inert_z, before.z * per_z, &turn_z);
    station.beta = pass_coordinate(&G->c, &G->b, &G->a, stiff_beta - inert_beta,
                                   before.beta * per_beta, &turn_beta);
    lag(part, turn_z);
    lag(part, turn_beta);
    station.load_z = l_abs(stiff_z) + l_abs(inert_z);
    station.load_beta = l_abs(stiff_beta) + l_abs(inert_beta);
    station.G = *G;
    return station;
}

RD_INLINE void pass_hinge(struct part *part, struct station *station)
{
    const cv open = c_sub(c_real(1), part->G.c);
    /* what turns on the node alone, without inertia, is free before and after */
    const lane_mask apart = (open.re == 0.0) & (open.im == 0.0);
    const cv per = c_invert(open);
    station->hinge = c_mul(part->G.b, per);
    part->G.a = c_add(part->G.a, c_mul(station->hinge, part->G.b));
    part->G.b = c_zero();
    part->G.c = c_real(1);
    lag(part, (cv){l_select(apart, l_fill(0), open.re), l_select(apart, l_fill(1), open.im)});
    part->less.eighths -= 2.0;
}

/* Y of the span is kept; `near` is 1/|D| */
RD_INLINE struct pair pass_span(struct part *part, const struct span_waves *w, lanes *near)
{
    const struct pair G = mirrored(part->G), *P = &w->P, *N = &w->N;
    const cv det_G = c_sub(c_mul(G.a, G.c), c_mul(G.b, G.b));
    const cv det_P = c_sub(c_mul(P->a, P->c), c_mul(P->b, P->b));
    const cv trace = c_add(c_add(c_mul(P->a, G.a), c_mul(P->c, G.c)), c_scale(c_mul(P->b, G.b), 2));
    const cv D = c_add(c_sub(c_real(1), trace), c_mul(det_P, det_G)), per = c_invert(D);
    const struct pair Y = {c_mul(c_sub(G.a, c_mul(det_G, P->c)), per),
                           c_mul(c_add(G.b, c_mul(det_G, P->b)), per),
                           c_mul(c_sub(G.c, c_mul(det_G, P->a)), per)};
    /* N Y N */
    const struct duo z = pair_times(&Y, (struct duo){N->a, N->b});
    const struct duo beta = pair_times(&Y, (struct duo){N->b, N->c});
    const struct duo left = pair_times(N, z);
    part->G.a = c_add(P->a, left.z);
    part->G.b = c_add(P->b, left.beta);
    part->G.c = c_add(P->c, pair_times(N, beta).beta);
    part->K += w->kl;
    lag(part, c_mul(D, w->lag));
    *near = l_root(c_square(per));
    return Y;
}

/* what goes into the far side of a span, mirrored, where b goes into this one: the wave that comes
   out there, and what it comes back as */
RD_INLINE struct duo through_span(const struct span_waves *w, const struct pair *Y, struct duo b,
                                  struct duo *back)
{
    const struct duo N = pair_times(&w->N, b);
    *back = pair_times(Y, N);
    const struct duo P = pair_times(&w->P, *back);
    return (struct duo){c_add(N.z, P.z), c_add(N.beta, P.beta)};
}

/* what goes into a part before its station, where b goes in after it */
RD_INLINE struct duo through_station(const struct station *station, struct duo b)
{
    const struct passed *z = &station->z, *beta = &station->beta;
    b.beta = c_sub(c_mul(beta->own, b.beta), c_mul(beta->other, b.z));
    b.z = c_sub(c_mul(z->own, b.z), c_mul(z->other, b.beta));
    return b;
}

/* The eigenphases of two parts that meet, the second mirrored: Theta/2 -+ d, those of M = G_1 G_2. */
struct meeting {
    lanes K;
    struct turned less, split; /* Theta/2 = K - less, d = split */
    /* M e^{-i Theta/2} = cos d + i (x, y, z).sigma; size = sin d */
    lanes x, y, z, size;
    struct pair first, second;
};

RD_INLINE struct meeting meet(const struct part *first, const struct part *second)
{
    struct meeting m = {.K = first->K + second->K,
                        .less = t_add(first->less, second->less),
                        .first = first->G,
                        .second = mirrored(second->G)};
    const struct pair *A = &m.first, *B = &m.second;
    lanes c, s;
    l_sine_cosine(l_less_angle(m.K, m.less), &s, &c);
    const cv turn = {c, -s};
    const cv zz = c_mul(turn, c_add(c_mul(A->a, B->a), c_mul(A->b, B->b)));
    const cv bb = c_mul(turn, c_add(c_mul(A->b, B->b), c_mul(A->c, B->c)));
    const cv zb = c_mul(turn, c_add(c_mul(A->a, B->b), c_mul(A->b, B->c)));
    const cv bz = c_mul(turn, c_add(c_mul(A->b, B->a), c_mul(A->c, B->b)));
    /* det M is what the angles add up to, but for rounding, which G has less of */
    const cv det = c_sub(c_mul(zz, bb), c_mul(zb, bz));
    m.less.rest -= 0.5 * det.im / det.re;
    m.z = 0.5 * (zz.im - bb.im);
    m.x = 0.5 * (zb.im + bz.im);
    m.y = 0.5 * (zb.re - bz.re);
    m.size = l_root(m.x * m.x + m.y * m.y + m.z * m.z);
    m.split = l_angle(m.size, 0.5 * (zz.re + bb.re));
    return m;
}

/* Theta/2 - (-1)^n d - 2 pi floor((n - 1)/2), which passes 0 at mode n */
RD_INLINE lanes meeting_beyond(const struct meeting *m, lane_mask odd, lanes turns)
{
    struct turned all = {l_negative_where(odd, m->split.eighths),
                         l_negative_where(odd, m->split.rest)};
    all = t_add(m->less, all);
    all.eighths += 8.0 * turns;
    return l_less_angle(m->K, all);
}

/* the eigenvector of the phase: what goes into the second part */
RD_INLINE struct duo meeting_wave(const struct meeting *m, lane_mask odd)
{
    /* (x, y, z).sigma v = +-size v, + for odd modes */
    const lanes z = l_negative_where(~odd, m->z), x = l_negative_where(~odd, m->x);
    const lanes y = l_negative_where(~odd, m->y);
    const lane_mask up = z > 0.0;
    const struct duo v = {{l_select(up, m->size + z, x), l_select(up, l_fill(0), -y)},
                          {l_select(up, x, m->size - z), l_select(up, y, l_fill(0))}};
    const lanes per = 1.0 / l_root(duo_square(v) + 1e-300);
    return (struct duo){c_scale_lanes(v.z, per), c_scale_lanes(v.beta, per)};
}

#endif
