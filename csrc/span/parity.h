/* The first piece of a continuous span of three coordinates and more, by what is even and what is odd about
   its middle. Included by span/slice.h, once per kind of number.

   Half a turn about z leaves z and the forces of the others as they are, e, and turns the rest, o: of
   each coordinate one is u and one f. With the form H of span/rate_matrix.h, which ties e to e and o
   to o, and s = 1 for z, -1 for the others,

       e' = s H_o o,  o' = -s H_e e

   so that of the square A = -l^2 s H_o s H_e alone are the series C = sum A^m/(2 m)!, S = sum A^m/(2 m + 1)!

       e_b = C e_a + l S s H_o o_a,  o_b = -l s H_e S e_a + s C^T s o_a */
#include "base/number.h"

#undef EACH
#if RD_REAL
#define EACH RD_UNROLL(1)
#else
#define EACH RD_UNROLL(1)
#endif

/* X <- A^-1 by Gauss and Jordan, A destroyed: near a unit triangle nothing is to be exchanged */
RD_INLINE void n_(slice_invert)(num A[W][W], num X[W][W])
{
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            X[i][j] = n_(real)(i == j);
    for (int k = 0; k < W; k++) {
        const num pivot = n_(inverse)(A[k][k]);
        for (int j = 0; j < W; j++) {
            A[k][j] = n_(mul)(A[k][j], pivot);
            X[k][j] = n_(mul)(X[k][j], pivot);
        }
        for (int i = 0; i < W; i++) {
            if (i == k)
                continue;
            const num a = A[i][k];
            for (int j = 0; j < W; j++) {
                A[i][j] = n_(sub)(A[i][j], n_(mul)(a, A[k][j]));
                X[i][j] = n_(sub)(X[i][j], n_(mul)(a, X[k][j]));
            }
        }
    }
}

/* (i, j) of A B */
RD_INLINE num n_(slice_product)(const num A[W][W], const num B[W][W], int i, int j)
{
    num sum = n_(mul)(A[i][0], B[0][j]);
    EACH for (int k = 1; k < W; k++) sum = n_(add)(sum, n_(mul)(A[i][k], B[k][j]));
    return sum;
}

/* l s H_o and -l s H_e */
RD_INLINE void n_(parity_rate)(const struct rate_matrix *s, double l, num odd[W][W], num even[W][W])
{
    const int z = s->across;
    const lanes whole = l_fill(l);
    EACH for (int i = 0; i < W; i++)
    {
        const lanes up = i == z ? whole : -whole;
        const num q = n_(scale_lanes)(n_(of)(s->q[i]), -up);
        EACH for (int j = 0; j < W; j++)
        {
            const num S = s->elastic[i][j] ? n_(scale_lanes)(n_(of)(s->S[i][j]), up) : n_(zero)();
            odd[i][j] = i == z ? S : n_(zero)();
            even[i][j] = i == z ? n_(zero)() : n_(neg)(S);
        }
        if (i == z)
            even[i][i] = n_(neg)(q);
        else
            odd[i][i] = q;
    }
    if (s->z >= 0) {
        const num lever = n_(scale_lanes)(n_(real)(l), s->lever);
        odd[z][W - 1] = lever;
        odd[W - 1][z] = n_(neg)(lever);
    }
    if (s->hangs) {
        const num sag = n_(scale_lanes)(n_(of)(s->sag), whole);
        even[0][W > 1] = sag;
        even[W > 1][0] = n_(neg)(sag);
    }
}

/* C - 1 and S to the power m of A */
RD_INLINE void n_(parity_series)(const num A[W][W], int m, num C[W][W], num S[W][W])
{
    num power[W][W], next[W][W];
    const lanes half = l_fill(0.5), sixth = l_fill(1.0 / 6.0);
    EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++)
    {
        power[i][j] = C[i][j] = n_(scale_lanes)(A[i][j], half);
        S[i][j] = n_(add)(n_(real)(i == j), n_(scale_lanes)(A[i][j], sixth));
    }
    for (int k = 2; k <= m; k++) {
        const lanes whole = l_fill(1.0 / (double)(2 * k * (2 * k - 1)));
        const lanes more = l_fill(1.0 / (double)(2 * k + 1));
        EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++) next[i][j] =
            n_(scale_lanes)(n_(slice_product)(A, power, i, j), whole);
        EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++)
        {
            power[i][j] = next[i][j];
            C[i][j] = n_(add)(C[i][j], next[i][j]);
            S[i][j] = n_(add)(S[i][j], n_(scale_lanes)(next[i][j], more));
        }
    }
}

/* D = F - I, G, Q, from what the force and the motion on the right owe to the force on the left, E22
   and E12, and the force on the right to the motion on the left, E21 */
RD_INLINE void n_(slice_fill)(const struct rate_matrix *s, double l, int terms, num D[W][W],
                              num G[W][W], num Q[W][W])
{
    const int z = s->across;
    num odd[W][W], even[W][W], A[W][W], C[W][W], S[W][W];
    num change[W][W], E22[W][W], E12[W][W], E21[W][W], inverse[W][W];
    n_(parity_rate)(s, l, odd, even);
    EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++) A[i][j] =
        n_(slice_product)(odd, even, i, j);
    n_(parity_series)(A, (terms + (s->hangs ? SLICE_HANGING : 0) + 1) / 2, C, S);
    EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++)
    {
        /* e from o, o from e, and C of both */
        const num X = n_(slice_product)(S, odd, i, j), Y = n_(slice_product)(even, S, i, j);
        const num one = n_(real)(i == j), e = C[i][j];
        const num o = (i == z) == (j == z) ? C[j][i] : n_(neg)(C[j][i]);
        const num eC = n_(add)(one, e), oC = n_(add)(one, o);
        const _Bool row = i == z, column = j == z;
        change[i][j] = row ? (column ? o : Y) : (column ? X : e);
        E22[i][j] = i == j ? n_(add)(one, change[i][j]) : change[i][j];
        E12[i][j] = row ? (column ? X : eC) : (column ? oC : Y);
        E21[i][j] = row ? (column ? Y : oC) : (column ? eC : X);
    }
    n_(slice_invert)(E22, inverse);
    EACH for (int i = 0; i < W; i++) EACH for (int j = 0; j < W; j++)
    {
        D[j][i] = n_(neg)(n_(slice_product)(inverse, change, i, j));
        if (j > i)
            continue;
        G[i][j] = G[j][i] = n_(slice_product)(E12, inverse, i, j);
        Q[i][j] = Q[j][i] = n_(slice_product)(inverse, E21, i, j);
    }
}
