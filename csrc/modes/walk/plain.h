/* Pieces of plain spans (span/span.h) in closed form, at several real lambda side by side; W is the
   width. */
#ifndef RD_WALK_PLAIN_H
#define RD_WALK_PLAIN_H

#include "base/complex_step.h"
#include "modes/walk/walk.h"
#include "modes/walk/width.h"
#include "span/plain.h"
#include "span/span.h"

/* D, G, Q; a real one and its d/dlambda are real and imaginary part */
struct plain_piece {
    cv D[W][W], G[W][W], Q[W][W];
};

RD_INLINE _Bool leg_is_continuous(const struct rd_walk *walk, const struct rd_leg *leg)
{
    return walk->chain->inertia && (size_t)leg->element < walk->chain->distinct;
}

/* of one coordinate, or of z and beta */
RD_INLINE _Bool leg_is_plain(const struct rd_walk *walk, const struct rd_leg *leg)
{
    const int32_t *coordinate = walk->chain->coordinate;
    const _Bool bends = W == 2 && coordinate[0] == RD_Z && coordinate[W - 1] == RD_BETA;
    return leg_is_continuous(walk, leg) && (W == 1 || bends) &&
           rd_span_is_plain(walk->chain, (size_t)leg->element);
}

RD_INLINE void plain_rate(const struct rd_walk *walk, const struct rd_leg *leg, lanes lambda,
                          struct rate_matrix *rate)
{
    const cv inertia = c_make(-lambda, l_fill(-RD_COMPLEX_STEP));
    rd_rate_fill(walk->chain, (size_t)leg->element, c_real(1), c_real(1), inertia, c_zero(), rate);
}

/* (k^2 + a^2) l^2 below which a leg is walked by doubled pieces: its shape is what is left of stiffnesses
   beside which its inertia is small, and nodes closer together would lose the more digits of it */
static const double PLAIN_LEAST = 1.0;

/* Whether a leg is plain and not short, and its waves, were they ever so fast to grow, have real k^2
   and a^2, without which a complex step tells no slope. */
RD_INLINE _Bool leg_is_plain_at(const struct rd_walk *walk, const struct rd_leg *leg, lanes lambda)
{
    enum { B = W - 1 };
    struct rate_matrix rate;
    if (!leg_is_plain(walk, leg))
        return 0;
    plain_rate(walk, leg, lambda, &rate);
    const lanes soft = rate.S[B][B].re, theta = soft * rate.q[B].re, kappa = -soft * rate.q[0].re;
    if (W == 1)
        return 1;
    const double length = (double)leg->count * walk->chain->length[leg->element];
    const double least = 0.25 * (PLAIN_LEAST * PLAIN_LEAST) / (length * length * length * length);
    return !some(0.25 * theta * theta + kappa < least);
}

RD_INLINE void plain_piece_of(const struct rate_matrix *rate, lanes length,
                              struct plain_piece *piece)
{
    enum { B = W - 1 };
    const cv soft = rate->S[B][B];
    if (W == 1) {
        struct rod_triple t;
        rd_rod_triple(&soft, rate->q, &length, &t);
        piece->D[0][0] = t.D;
        piece->G[0][0] = t.G;
        piece->Q[0][0] = t.Q;
        return;
    }
    const cv load[2] = {rate->q[0], rate->q[B]};
    struct bent_triple t;
    rd_bent_triple(&soft, load, &rate->lever, &length, &t);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            piece->D[i * B][j * B] = t.D[2 * i + j];
            piece->G[i * B][j * B] = t.G[i + j];
            piece->Q[i * B][j * B] = t.Q[i + j];
        }
}

enum { PLAIN_STEPS = 3 };

/* Lengths of the first piece of a plain leg and of the two others: m pi + r/3, r/3 and r/3 radians of
   its k l = m pi + r, 0 <= r <= pi, so that none is near a resonance as a cantilever, which is near
   pi/2 beyond m pi. */
RD_INLINE void plain_lengths(const struct rate_matrix *rate, double length, lanes *first,
                             lanes *other)
{
    static const double PI = 3.14159265358979323846;
    enum { B = W - 1 };
    const cv load[2] = {rate->q[0], rate->q[B]};
    const cv soft = rate->S[B][B];
    const lanes k = W == 1 ? c_root(c_neg(c_mul(soft, load[0]))).re
                           : bent_wavenumbers(soft, load, rate->lever).k.re;
    const lanes shift = l_fill(0x1.8p52);
    const lanes m = not_negative(((k * (length / PI) - 0.5) + shift) - shift);
    const lane_mask many = m > 0.0;
    const lanes whole = l_select(many, m * PI / l_select(many, k, l_fill(1)), l_fill(0));
    /* none of no length */
    *other = l_most((length - whole) / 3.0, length * 0x1p-8 / (m + 1.0));
    *first = length - 2.0 * *other;
}

#endif
