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
    lanes K; /* theta/2 = K - 2 pi turns - arg turn */
    lanes turns;
    cv turn;
};

/* of one coordinate: b_j = own b'_j - other b'_k gives back what went in before */
struct passed {
    cv own, other;
};

/* a station, or a hinge, that was passed */
struct station {
    struct passed z, beta;
    cv hinge;      /* b_beta = hinge b_z, where there is one */
    struct pair G; /* with what stands at the station, before the hinge */
};

/* what stands at a station, and scales of what is on both of its sides */
struct standing {
    lanes mass, turning, spring_z, spring_beta;
};

struct scales {
    lanes z, beta; /* s^-2 */
};

/* to[..] = from[..] where m */
RD_INLINE void put_where(lane_mask m, void *to, const void *from, size_t bytes)
{
    lanes *x = to;
    const lanes *y = from;
    for (size_t i = 0; i < bytes / sizeof(lanes); i++)
        x[i] = l_select(m, y[i], x[i]);
}

RD_INLINE struct part free_part(void)
{
    const cv one = c_real(1), none = c_zero();
    return (struct part){{one, none, one}, l_fill(0), l_fill(0), one};
}

/* the angle grows by that of q, both within pi: half turns show in the signs */
RD_INLINE void lag(struct part *part, cv q)
{
    const cv turn = c_mul(part->turn, q);
    const lane_mask left = part->turn.im >= 0.0, up = q.im >= 0.0, above = turn.im >= 0.0;
    part->turns += l_select(left & up & ~above, l_fill(1), l_fill(0));
    part->turns -= l_select(~left & ~up & above, l_fill(1), l_fill(0));
    part->turn = c_scale_lanes(turn, 1.0 / c_size(turn));
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

/* Of coordinate j beside k. Where its part is as good as held and n is not small the angle of q is
   lost, and all that follows is not a number. */
RD_INLINE struct passed pass_coordinate(struct part *part, cv *jj, cv *jk, cv *kk, lanes n,
                                        lanes ratio)
{
    const cv one = c_real(1);
    const lane_mask same = ratio == 1.0, still = same & (n == 0.0), held = n == (double)INFINITY;
    if (every(still))
        return (struct passed){one, c_zero()};
    const lanes n1 = l_select(held, l_fill(1), n), n2 = l_select(held, l_fill(0), l_fill(1));
    const lanes root = every(same) ? ratio : l_root(ratio), through = 2.0 * n2 * root;
    const cv up = c_add(one, *jj), down = c_scale_lanes(c_sub(one, *jj), n2 * ratio);
    const cv sum = c_add(c_mul(up, c_make(n2, n1)), down);
    const lanes size = c_square(sum);
    const lanes lost = l_select(size > 1e-26 * (n1 * n1 + n2), l_fill(0), l_fill((double)NAN));
    const cv q = {l_select(still, l_fill(2), sum.re + lost), l_select(still, l_fill(0), sum.im)};
    const lanes s = 1.0 / l_select(still, l_fill(4), size);
    const cv per = {q.re * s, -q.im * s}, x = c_mul(*jk, per);
    const cv other = c_mul(c_make(n2 * (1.0 - ratio), n1), x);
    *kk = c_sub(*kk, c_mul(other, *jk));
    put_where(~still, jk, &(cv){x.re * through, x.im * through}, sizeof(cv));
    const cv moved = c_sub(c_scale_lanes(c_mul(up, per), 2.0 * n2), one);
    put_where(~still, jj, &moved, sizeof(cv));
    const cv turn = part->turn;
    lag(part, q);
    put_where(still, &part->turn, &turn, sizeof turn);
    return (struct passed){c_scale_lanes(per, through), other};
}

RD_INLINE struct station pass_station(struct part *part, const struct standing *here, lanes omega,
                                      struct scales before, struct scales after)
{
    const lanes square = omega * omega, per_z = 1.0 / after.z, per_beta = 1.0 / after.beta;
    const lanes n_z = (here->spring_z - square * here->mass) * per_z;
    const lanes n_beta = (here->spring_beta - square * here->turning) * per_beta;
    struct station station = {.hinge = c_zero()};
    struct pair *G = &part->G;
    station.z = pass_coordinate(part, &G->a, &G->b, &G->c, n_z, before.z * per_z);
    station.beta = pass_coordinate(part, &G->c, &G->b, &G->a, n_beta, before.beta * per_beta);
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
    /* arg(1 - G_bb) less pi/2, which is 0 there */
    lag(part, (cv){l_select(apart, l_fill(1), open.im), l_select(apart, l_fill(0), -open.re)});
}

/* Y of the span is kept; `near` is 1/|D|^2 */
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
    *near = c_square(per);
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
    struct meeting m = {
        .K = first->K + second->K, .first = first->G, .second = mirrored(second->G)};
    const struct pair *A = &m.first, *B = &m.second;
    struct part both = {first->G, m.K, first->turns + second->turns, first->turn};
    lag(&both, second->turn);
    m.less = l_angle(both.turn.im, both.turn.re);
    m.less.eighths += 8.0 * both.turns;
    const struct l_circle at = l_circle_of(l_less_angle(m.K, m.less));
    const cv turn = {at.cos, -at.sin};
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
