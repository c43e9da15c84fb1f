/* What the iteration needs of a step: its form, how fast that changes, its kernel. */
#ifndef RD_REFINE_RATE_H
#define RD_REFINE_RATE_H

#include "modes/refine/refine.h"
#include "modes/walk/piece.h"
#include "modes/walk/wave.h"

/* a step in scaled coordinates with its change d/dlambda; V = Q + N */
struct rate {
    lanes D[W][W], G[W][W], V[W][W], dD[W][W], dG[W][W], dV[W][W];
};

RD_INLINE void rate_node(const struct rd_refine *r, int32_t term, int32_t before, lanes lambda,
                         struct rate *rate)
{
    const double *mass = rd_walk_mass(r->walk, term);
    lanes N[W][W], rest[W][W], dN[W][W];
    term_load(r->walk, term, before, lambda, N);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            dN[i][j] = rest[i][j] = l_fill(0);
    foot_rest(r->walk->chain, term, lambda, rest, dN);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            const double zz = r->z[i] * r->z[j];
            rate->V[i][j] = N[i][j] * zz;
            rate->dV[i][j] = (dN[i][j] - mass[i * W + j]) * zz;
        }
}

RD_INLINE void rate_load(const struct rd_refine *r, const struct rd_step *step, lanes lambda,
                         struct rate *rate)
{
    struct piece piece;
    const struct piece *value = &piece, *change = NULL;
    if (step->piece >= 0) {
        value = (const struct piece *)(r->piece + (size_t)step->piece * 6 * W * W);
        change = value + 1;
    } else
        piece_load(r->walk, step->element, &piece);
    rate_node(r, step->term, step->before, lambda, rate);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            const double zz = r->z[i] * r->z[j];
            const double ratio = r->z[j] / r->z[i];
            rate->D[i][j] = value->D[i][j] * ratio;
            rate->G[i][j] = value->G[i][j] / zz;
            rate->V[i][j] += value->Q[i][j] * zz;
            rate->dD[i][j] = change ? change->D[i][j] * ratio : l_fill(0);
            rate->dG[i][j] = change ? change->G[i][j] / zz : l_fill(0);
            rate->dV[i][j] += change ? change->Q[i][j] * zz : l_fill(0);
        }
}

/* whether a step has the rates of another */
RD_INLINE _Bool is_alike(const struct rd_step *made, const struct rd_step *step)
{
    return made && made->piece == step->piece && made->element == step->element &&
           made->term == step->term && made->before == step->before;
}

/* K = (G + i I)^-1, B = K F, Wt = i I + V + F^T B */
struct kernel {
    cv K[W][W], B[W][W], Wt[W][W];
};

RD_INLINE void kernel_fill(const struct rate *rate, struct kernel *k)
{
    cv Z[W][W];
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            k->K[i][j] = c_make(l_fill(i == j), l_fill(0));
            Z[i][j] = c_make(rate->G[i][j], l_fill(i == j));
        }
    divide(k->K, Z);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            k->B[i][j] = k->K[i][j];
            for (int m = 0; m < W; m++)
                k->B[i][j] = c_add(k->B[i][j], c_scale_lanes(k->K[i][m], rate->D[m][j]));
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            cv sum = k->B[i][j];
            for (int m = 0; m < W; m++)
                sum = c_add(sum, c_scale_lanes(k->B[m][j], rate->D[m][i]));
            k->Wt[i][j] = c_make(sum.re + rate->V[i][j], sum.im + l_fill(i == j));
        }
}

#endif
