/* The first piece of a continuous span, by the series of the matrix exponential, at several lambda
   side by side. W is the number of coordinates.

   Of exp(l E) = [[E11, E12], [E21, E22]], E of span/rate_matrix.h, the triple is F^T = E22^-1,
   G = E12 E22^-1, Q = E22^-1 E21. Pieces are so short (span/span.h) that nothing cancels. */
#ifndef RD_SLICE_H
#define RD_SLICE_H

#include "closed/lane_trig.h"
#include "span/beam_slice.h"
#include "span/rate_matrix.h"
#include "span/span.h"

/* terms more of a rope that hangs: z follows from F_z by three integrals, x from h by two more */
enum { SLICE_HANGING = 2 };

#undef RD_REAL
#define RD_REAL 1
#include "span/parity.h"
#undef RD_REAL
#define RD_REAL 0
#include "span/parity.h"

/* whether nothing is damped */
RD_INLINE _Bool slice_is_real(const struct rate_matrix *s)
{
    lanes im = s->hangs ? l_abs(s->sag.im) : (lanes){0};
    for (int i = 0; i < W; i++) {
        im += l_abs(s->q[i].im);
        for (int j = 0; j < W; j++)
            if (s->elastic[i][j])
                im += l_abs(s->S[i][j].im);
    }
    return !some(im != 0.0);
}

/* (u, f) <- (Phi u + S' f, q u - Phi^T f) h */
RD_INLINE void slice_differentiate(const struct rate_matrix *s, double h, cv *u, cv *f)
{
    cv du[W], df[W];
    for (int i = 0; i < W; i++) {
        du[i] = c_zero();
        for (int j = 0; j < W; j++)
            if (s->elastic[i][j])
                du[i] = c_add(du[i], c_mul(s->S[i][j], f[j]));
        df[i] = c_mul(s->q[i], u[i]);
    }
    if (s->z >= 0) {
        du[s->z] = c_add(du[s->z], c_scale_lanes(u[W - 1], s->lever));
        df[W - 1] = c_sub(df[W - 1], c_scale_lanes(f[s->z], s->lever));
    }
    if (W > 1 && s->hangs) {
        du[0] = c_add(du[0], c_mul(u[W > 1], s->sag));
        df[W > 1] = c_sub(df[W > 1], c_mul(f[0], s->sag));
    }
    for (int i = 0; i < W; i++) {
        u[i] = c_scale(du[i], h);
        f[i] = c_scale(df[i], h);
    }
}

/* column c of exp(l E) - I for a unit displacement (0) or a unit force (1) at the left end */
RD_INLINE void slice_column(const struct rate_matrix *s, double l, int terms, int c, _Bool force,
                            cv *u, cv *f)
{
    cv du[W], df[W];
    for (int i = 0; i < W; i++) {
        du[i] = c_real(i == c && !force);
        df[i] = c_real(i == c && force);
        u[i] = f[i] = c_zero();
    }
    for (int m = 1; m <= terms; m++) {
        slice_differentiate(s, l / m, du, df);
        for (int i = 0; i < W; i++) {
            u[i] = c_add(u[i], du[i]);
            f[i] = c_add(f[i], df[i]);
        }
    }
}

/* bending alone, from span/beam_slice.h: with lever r of z' = r beta, S' and q as they are scaled,
   z = r l phi, F = f/(r^2 S' l^3) and so on */
RD_INLINE void slice_bend(const struct rate_matrix *s, double l, int terms, cv D[W][W], cv G[W][W],
                          cv Q[W][W])
{
    enum { B = W - 1 };
    const lanes r = s->lever * l, back = 1.0 / r;
    const cv soft = c_scale(s->S[B][B], l), stiff = c_inverse(soft);
    const cv theta = c_mul(soft, c_scale(s->q[B], l));
    const cv kappa = c_neg(c_mul(soft, c_scale_lanes(s->q[0], r * r * l)));
    struct beam_slice b;
    beam_slice_fill(theta, kappa, terms, &b);
    D[0][0] = b.Dzz;
    D[0][B] = c_scale_lanes(b.Dzb, r);
    D[B][0] = c_scale_lanes(b.Dbz, back);
    D[B][B] = b.Dbb;
    G[0][0] = c_mul(soft, c_scale_lanes(b.Gzz, r * r));
    G[0][B] = c_mul(soft, c_scale_lanes(b.Gzb, r));
    G[B][0] = G[0][B];
    G[B][B] = c_mul(soft, b.Gbb);
    Q[0][0] = c_mul(stiff, c_scale_lanes(b.Qzz, back * back));
    Q[0][B] = c_mul(stiff, c_scale_lanes(b.Qzb, back));
    Q[B][0] = Q[0][B];
    Q[B][B] = c_mul(stiff, b.Qbb);
}

/* D = F - I, G, Q of a piece of length l, any couplings */
RD_INLINE void slice_sum(const struct rate_matrix *s, double l, int terms, cv D[W][W], cv G[W][W],
                         cv Q[W][W])
{
    terms += s->hangs ? SLICE_HANGING : 0;
    cv change[W][W], A[W][W], B[W][W], C[W][W], inverse[W][W], u[W], f[W];
    for (int c = 0; c < W; c++) {
        slice_column(s, l, terms, c, 1, u, f);
        for (int i = 0; i < W; i++) {
            B[i][c] = u[i];
            change[i][c] = A[i][c] = f[i];
            A[i][c].re += (double)(i == c);
        }
        slice_column(s, l, terms, c, 0, u, f);
        for (int i = 0; i < W; i++)
            C[i][c] = f[i];
    }
    c_slice_invert(A, inverse);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            D[j][i] = c_neg(c_slice_product(inverse, change, i, j));
            if (j > i)
                continue;
            G[i][j] = G[j][i] = c_slice_product(B, inverse, i, j);
            Q[i][j] = Q[j][i] = c_slice_product(inverse, C, i, j);
        }
}

RD_INLINE void slice_fill(const struct rate_matrix *s, double l, int terms, cv D[W][W], cv G[W][W],
                          cv Q[W][W])
{
    if (W > 2)
        c_slice_fill(s, l, terms, D, G, Q);
    else if (W == 2 && s->z >= 0)
        slice_bend(s, l, terms / 2 - 1, D, G, Q);
    else
        slice_sum(s, l, terms, D, G, Q);
}

#endif
