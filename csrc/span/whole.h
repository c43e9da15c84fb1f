/* A whole uniform span whose coordinates are not coupled, as a step of the sweep takes it: motion u_b
   and force f_a from what comes from the right, s_b = u_b - i f_b, and u_a,

       u_b = A s_b - i B u_a,  f_a = B^T s_b - (C + i I) u_a

   Sigma and Delta of span/halves.h say all of it, D = diag(1, -1) of z and beta:

       A = (Sigma - Delta Sigma^-1 Delta)/2,  B = i Delta Sigma^-1 D,  C = 2 i (D Sigma^-1 D - I) */
#ifndef RD_WHOLE_H
#define RD_WHOLE_H

#include "span/halves.h"
#include "span/plain_triple.h"

struct plain_span {
    cv A, B, C;
    lanes radians;
};

/* zz, z beta, beta beta; B by rows */
struct bent_span {
    cv A[3], B[4], C[3];
    lanes radians;
};

RD_INLINE struct plain_span plain_span_of(cv soft, cv load, lanes length)
{
    const struct plain_halves x = plain_halves_of(soft, load, length);
    const cv inverse = c_inverse(x.sum);
    struct plain_span span = {.radians = way_radians(&x.way)};
    span.A = c_scale(c_mul(x.both, inverse), 2);
    span.B = c_times_i(c_mul(x.apart, inverse));
    span.C = c_times_i(c_scale(inverse, 2));
    span.C.im -= 2.0;
    return span;
}

RD_INLINE void bent_span_of_halves(const struct bent_halves *x, struct bent_span *span)
{
    const cv *S = x->sum, *D = x->apart;
    const cv det = c_sub(c_mul(S[0], S[2]), c_mul(S[1], S[1])), d = c_inverse(det);
    const cv zz = c_mul(S[2], d), zb = c_neg(c_mul(S[1], d)), bb = c_mul(S[0], d);
    /* Delta Sigma^-1 */
    const cv Y[4] = {
        c_add(c_mul(D[0], zz), c_mul(D[1], zb)), c_add(c_mul(D[0], zb), c_mul(D[1], bb)),
        c_add(c_mul(D[1], zz), c_mul(D[2], zb)), c_add(c_mul(D[1], zb), c_mul(D[2], bb))};
    span->A[0] = c_sub(S[0], c_add(c_mul(Y[0], D[0]), c_mul(Y[1], D[1])));
    span->A[1] = c_sub(S[1], c_add(c_mul(Y[0], D[1]), c_mul(Y[1], D[2])));
    span->A[2] = c_sub(S[2], c_add(c_mul(Y[2], D[1]), c_mul(Y[3], D[2])));
    span->C[0] = zz;
    span->C[1] = c_neg(zb);
    span->C[2] = bb;
    for (int p = 0; p < 3; p++) {
        span->A[p] = c_scale(span->A[p], 0.5);
        span->C[p] = c_times_i(c_scale(span->C[p], 2));
        span->C[p].im -= p == 1 ? 0.0 : 2.0;
    }
    for (int p = 0; p < 4; p++)
        span->B[p] = p % 2 ? c_neg(c_times_i(Y[p])) : c_times_i(Y[p]);
}

/* K = (G - i I)^-1,  A = K G,  B = K F,  C = -i I + Q + F^T B */
RD_INLINE void bent_span_of_triple(const struct bent_triple *t, struct bent_span *span)
{
    const cv *D = t->D, *G = t->G;
    const cv g0 = {G[0].re, G[0].im - 1.0}, g2 = {G[2].re, G[2].im - 1.0};
    const cv d = c_inverse(c_sub(c_mul(g0, g2), c_mul(G[1], G[1])));
    const cv K[3] = {c_mul(g2, d), c_neg(c_mul(G[1], d)), c_mul(g0, d)};
    cv F[4] = {D[0], D[1], D[2], D[3]};
    F[0].re += 1.0;
    F[3].re += 1.0;
    cv *A = span->A, *B = span->B, *C = span->C;
    A[0] = c_add(c_mul(K[0], G[0]), c_mul(K[1], G[1]));
    A[1] = c_add(c_mul(K[0], G[1]), c_mul(K[1], G[2]));
    A[2] = c_add(c_mul(K[1], G[1]), c_mul(K[2], G[2]));
    for (int j = 0; j < 2; j++) {
        B[j] = c_add(c_mul(K[0], F[j]), c_mul(K[1], F[2 + j]));
        B[2 + j] = c_add(c_mul(K[1], F[j]), c_mul(K[2], F[2 + j]));
    }
    for (int i = 0, p = 0; i < 2; i++)
        for (int j = i; j < 2; j++, p++) {
            const cv rest = c_add(c_mul(D[i], B[j]), c_mul(D[2 + i], B[2 + j]));
            C[p] = c_add(t->Q[p], c_add(B[2 * i + j], rest));
            C[p].im -= (double)(i == j);
        }
}

RD_INLINE void bent_span_where(lane_mask m, const struct bent_span *a, struct bent_span *b)
{
    for (int p = 0; p < 3; p++) {
        b->A[p] = c_where(m, a->A[p], b->A[p]);
        b->C[p] = c_where(m, a->C[p], b->C[p]);
    }
    for (int p = 0; p < 4; p++)
        b->B[p] = c_where(m, a->B[p], b->B[p]);
}

/* soft = S', of loads q_z and q_beta */
RD_INLINE struct bent_span bent_span_of(cv soft, const cv *load, lanes r, lanes length)
{
    const struct wavenumbers w = bent_wavenumbers(soft, load, r);
    const lane_mask near = is_brief(&w, length);
    const struct bent_halves x = bent_halves_of(&w, c_inverse(soft), r, length);
    struct bent_span span, brief;
    bent_span_of_halves(&x, &span);
    span.radians = way_radians(&x.way);
    if (!some(near))
        return span;
    struct bent_triple t;
    bent_triple_brief(soft, load, r, length, &t);
    bent_span_of_triple(&t, &brief);
    bent_span_where(near, &brief, &span);
    span.radians = l_select(near, l_fill(BENT_BRIEF), span.radians);
    return span;
}

#endif
