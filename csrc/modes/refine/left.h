/* The left part of the iteration at a node, and how it goes over a step. */
#ifndef RD_REFINE_LEFT_H
#define RD_REFINE_LEFT_H

#include "modes/refine/rate.h"

/* the left part at a node */
struct left {
    cv U[W][W], g[W];
};

enum { LEFT = W * (W + 3) };

RD_INLINE void left_store(const struct left *left, lanes *at)
{
    for (int i = 0; i < W; i++) {
        for (int j = 0; j <= i; j++) {
            *at++ = left->U[i][j].re;
            *at++ = left->U[i][j].im;
        }
        *at++ = left->g[i].re;
        *at++ = left->g[i].im;
    }
}

RD_INLINE void left_load(const lanes *at, struct left *left)
{
    for (int i = 0; i < W; i++) {
        for (int j = 0; j <= i; j++, at += 2)
            left->U[i][j] = left->U[j][i] = c_make(at[0], at[1]);
        left->g[i] = c_make(at[0], at[1]);
        at += 2;
    }
}

/* U -= U_j U_j^T/U_jj, g -= U_j g_j/U_jj */
RD_INLINE void left_hold(struct left *left, int j)
{
    cv y[W];
    const cv inverse = c_invert(left->U[j][j]);
    const cv gj = c_mul(left->g[j], inverse);
    for (int i = 0; i < W; i++)
        y[i] = left->U[i][j];
    for (int i = 0; i < W; i++) {
        const cv yi = c_mul(y[i], inverse);
        for (int k = 0; k < W; k++)
            left->U[i][k] = i == j || k == j ? c_make(l_fill(0), l_fill(0))
                                             : c_sub(left->U[i][k], c_mul(yi, y[k]));
        left->g[i] = i == j ? c_make(l_fill(0), l_fill(0)) : c_sub(left->g[i], c_mul(y[i], gj));
    }
}

/* E B^T and E h */
RD_INLINE void solve(const struct kernel *k, const struct left *left, const lanes *p,
                     const lanes *d, cv EBt[W][W], cv *Eh)
{
    cv Z[W][W], X[W][W], h[W];
    for (int i = 0; i < W; i++) {
        h[i] = c_make(p[i], l_fill(0));
        for (int j = 0; j < W; j++) {
            h[i] = c_sub(h[i], c_scale_lanes(k->B[j][i], d[j]));
            h[i] = c_sub(h[i], c_mul(k->Wt[i][j], left->g[j]));
            Z[i][j] = c_make(l_fill(0), l_fill(-(i == j)));
            for (int m = 0; m < W; m++)
                Z[i][j] = c_add(Z[i][j], c_mul(k->Wt[i][m], left->U[m][j]));
            X[i][j] = c_make(l_fill(i == j), l_fill(0));
        }
    }
    divide(X, Z);
    for (int i = 0; i < W; i++) {
        Eh[i] = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++) {
            Eh[i] = c_add(Eh[i], c_mul(X[i][j], h[j]));
            EBt[i][j] = c_make(l_fill(0), l_fill(0));
            for (int m = 0; m < W; m++)
                EBt[i][j] = c_add(EBt[i][j], c_mul(X[i][m], k->B[j][m]));
        }
    }
}

RD_INLINE void left_advance(struct left *left, const struct rate *rate, const struct kernel *k,
                            const lanes *p, const lanes *d)
{
    cv EBt[W][W], Eh[W], UE[W][W], t[W];
    solve(k, left, p, d, EBt, Eh);
    for (int i = 0; i < W; i++) {
        t[i] = left->g[i];
        for (int j = 0; j < W; j++) {
            t[i] = c_add(t[i], c_mul(left->U[i][j], Eh[j]));
            UE[i][j] = c_make(l_fill(0), l_fill(0));
            for (int m = 0; m < W; m++)
                UE[i][j] = c_add(UE[i][j], c_mul(left->U[i][m], EBt[m][j]));
        }
    }
    for (int i = 0; i < W; i++) {
        cv g = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++) {
            g = c_add(g, c_mul(k->B[i][j], t[j]));
            g = c_add(g, c_scale_lanes(k->K[i][j], d[j]));
        }
        left->g[i] = c_turn(g, l_fill(1));
        for (int j = 0; j <= i; j++) {
            cv A = c_make(l_fill(0), l_fill(0)), BU = A;
            for (int m = 0; m < W; m++) {
                A = c_add(A, c_scale_lanes(k->K[i][m], rate->G[m][j]));
                BU = c_add(BU, c_mul(k->B[i][m], UE[m][j]));
            }
            left->U[i][j] = left->U[j][i] = c_add(A, c_turn(BU, l_fill(1)));
        }
    }
}

/* u = Re (U s + g), f = Re (-i Y s + i g) = Re -i (s - u) */
RD_INLINE void state(const struct left *left, const cv *s, lanes *u, lanes *f)
{
    for (int i = 0; i < W; i++) {
        cv x = left->g[i];
        for (int j = 0; j < W; j++)
            x = c_add(x, c_mul(left->U[i][j], s[j]));
        u[i] = x.re;
        if (f)
            f[i] = s[i].im - x.im;
    }
}

#endif
