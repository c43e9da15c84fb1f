/* A whole plain span (span/halves.h) walked at once, of at most two coordinates; W is the width.

   In waves G = 2 U - I the span scatters by S22 = D Sigma D - I, S12 = Delta D, and turns the angle Psi
   of modes/walk/wave.h by

       k l - alpha_s - alpha_a + w pi/2 - arg det(I - S22 G)

   where alpha = arg(det(u + i f) e^{ikh}) is in -pi/2 .. pi for symmetric motions, for antisymmetric
   ones pi/2 more, and the two eigenvalues of I - S22 G turn by less than pi/2 each. Below lambda = 0 a
   tensed span has no propagating wave, k is imaginary, and alpha in 0 .. pi. */
#ifndef RD_COUNT_WHOLE_H
#define RD_COUNT_WHOLE_H

#include "modes/walk/piece.h"
#include "modes/walk/wave.h"
#include "span/plain.h"

/* Delta and Sigma of all coordinates, f = -i Y s, and the ways of those waves that propagate */
struct whole {
    cv sum[W][W], apart[W][W];
    struct half_way way[W];
    int ways;
    _Bool bends;
};

/* scales that fit the rope itself: those of waves of wavenumbers |k| and a, no longer than the span */
RD_INLINE lanes fitting(lanes stiffness, lanes k, lanes square)
{
    return 1.0 / l_root(stiffness * k * square);
}

RD_INLINE lanes longest(lanes k, double length)
{
    return l_most(k, l_fill(1 / length));
}

RD_INLINE cv conjugate(cv a)
{
    return (cv){a.re, -a.im};
}

/* false where the waves of a lane are too long for halves, or both propagate */
RD_INLINE _Bool whole_bent(const struct rate_matrix *rate, double length, lanes *z,
                           struct whole *whole)
{
    enum { B = W - 1 };
    const cv soft = rate->S[B][B], stiff = c_inverse(soft);
    const cv load[2] = {rate->q[0], rate->q[B]};
    const struct wavenumbers w = bent_wavenumbers(soft, load, rate->lever);
    if (some(is_brief(&w, l_fill(length)) | (w.E.im != 0.0) | (w.a2.re < 0.0)))
        return 0;
    const lanes k = longest(c_size(w.k), length), a = longest(w.a.re, length);
    z[0] = fitting(stiff.re, k, k * k + a * a);
    z[B] = fitting(stiff.re, a, l_fill(1));
    const lanes r = z[B] / z[0];
    const cv fitted = c_scale_lanes(stiff, z[B] * z[B]);
    const lanes all = l_fill(length);
    struct bent_halves x;
    rd_bent_halves(&w, &fitted, &r, &all, &x);
    whole->bends = 1;
    whole->ways = 1;
    whole->way[0] = x.way;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            whole->sum[i * B][j * B] = conjugate(x.sum[i + j]);
            whole->apart[i * B][j * B] = conjugate(j ? c_neg(x.apart[i + j]) : x.apart[i + j]);
        }
    return 1;
}

RD_INLINE _Bool whole_plain(const struct rate_matrix *rate, double length, int i, lanes *z,
                            struct whole *whole)
{
    const cv soft = rate->S[i][i];
    if (some(soft.re <= 0.0))
        return 0;
    const lanes stiffness = 1.0 / soft.re;
    const lanes k = longest(l_root(l_abs(soft.re * rate->q[i].re)), length);
    z[i] = fitting(stiffness, k, l_fill(1));
    const lanes square = z[i] * z[i];
    const cv fitted = c_scale_lanes(soft, 1.0 / square), load = c_scale_lanes(rate->q[i], square);
    const lanes all = l_fill(length);
    struct plain_halves x;
    rd_rod_halves(&fitted, &load, &all, &x);
    whole->way[whole->ways++] = x.way;
    whole->sum[i][i] = conjugate(x.sum);
    whole->apart[i][i] = conjugate(x.apart);
    return 1;
}

RD_INLINE void turn_left(struct wave *wave, cv p)
{
    turn(wave, p, p.im >= 0);
}

/* by a quarter of a turn, to the right, in some lanes */
RD_INLINE void turn_quarter(struct wave *wave, lane_mask where)
{
    const lanes one = l_fill(1), none = l_fill(0);
    turn(wave, c_make(l_select(where, none, one), l_select(where, -one, none)), (lane_mask){0});
}

/* Psi += k l - alpha_s - alpha_a, the latter but for pi/2; NaN beyond the phases that are known */
RD_INLINE void turn_way(struct wave *wave, const struct half_way *way)
{
    const lanes shift = l_fill(0x1.8p52), turns = (0.5 * way->quarters - 0.25 + shift) - shift;
    const lane_mask odd = 2.0 * turns != way->quarters;
    const cv back = conjugate(c_mul(way->phase, way->phase));
    const cv rest = c_make(l_negative_where(odd, back.re), l_negative_where(odd, back.im));
    const cv s = c_mul(way->det[0], way->phase), a = c_mul(way->det[1], way->phase);
    turn(wave, rest, rest.im > 0);
    turn_quarter(wave, odd);
    turn_quarter(wave, odd);
    turn_left(wave, s);
    turn_left(wave, c_make(a.im, -a.re));
    const lane_mask known = way_radians(way) <= (double)RD_PIECES_MOST;
    wave->turns -= l_select(known, turns, l_fill(NAN));
}

/* U <- (Sigma + Delta D G (I - S22 G)^-1 D Delta)/2 */
RD_INLINE void whole_scatter(struct wave *wave, const struct whole *whole)
{
    cv G[W][W], M[W][W], X[W][W], T[W][W];
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            G[i][j] = X[i][j] = c_sub(wave->U[i][j], wave->Y[i][j]);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            M[i][j] = c_make(l_fill(i == j), l_fill(0));
            for (int k = 0; k < W; k++) {
                cv S = whole->bends && i != k ? c_neg(whole->sum[i][k]) : whole->sum[i][k];
                S.re -= l_fill(i == k);
                M[i][j] = c_sub(M[i][j], c_mul(S, G[k][j]));
            }
        }
    turn_left(wave, divide(X, M));
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            T[i][j] = c_mul(whole->apart[i][0], X[0][j]);
            for (int k = 1; k < W; k++)
                T[i][j] = c_add(T[i][j], c_mul(whole->apart[i][k], X[k][j]));
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            cv sum = whole->sum[i][j];
            for (int k = 0; k < W; k++)
                sum = c_add(sum, c_mul(T[i][k], whole->apart[j][k]));
            wave->U[i][j] = wave->U[j][i] = c_scale(sum, 0.5);
            wave->Y[i][j] = wave->Y[j][i] = c_make(l_fill(i == j) - 0.5 * sum.re, -0.5 * sum.im);
        }
}

/* from the scales z to others, or back */
RD_INLINE void rescale(struct wave *wave, const lanes *from, const lanes *to)
{
    for (int i = 0; i < W; i++)
        stretch(wave, i, from[i] / to[i] - 1.0);
}

/* Across a plain leg, where it has such waves; its first node is behind the walk. */
RD_INLINE _Bool whole_walk(struct wave *wave, const struct rd_walk *walk, const struct rd_leg *leg,
                           lanes lambda, const lanes *z)
{
    const struct rd_chain *chain = walk->chain;
    const size_t e = (size_t)leg->element;
    const double length = (double)leg->count * chain->length[e];
    struct rate_matrix rate;
    struct whole whole = {.ways = 0};
    lanes own[W];
    rd_rate_fill(chain, e, c_real(1), c_real(1), c_make(-lambda, l_fill(0)), c_zero(), &rate);
    if (W == 2 && rate.z >= 0) {
        if (!whole_bent(&rate, length, own, &whole))
            return 0;
    } else
        for (int i = 0; i < W; i++)
            if (!whole_plain(&rate, length, i, own, &whole))
                return 0;
    rescale(wave, z, own);
    whole_scatter(wave, &whole);
    for (int i = 0; i < whole.ways; i++)
        turn_way(wave, whole.way + i);
    if (whole.bends)
        turn_quarter(wave, (lane_mask){0} - 1);
    normalise(wave);
    rescale(wave, own, z);
    return 1;
}

/* whether a leg may be walked at once */
RD_INLINE _Bool is_whole(const struct rd_walk *walk, const struct rd_leg *leg)
{
    return W <= 2 && leg_is_continuous(walk, leg) &&
           rd_span_is_plain(walk->chain, (size_t)leg->element);
}

#endif
