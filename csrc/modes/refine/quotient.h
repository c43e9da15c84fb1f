/* The quotient of what the iteration found: u^T A u and u^T M u, alone and mutual. */
#ifndef RD_REFINE_QUOTIENT_H
#define RD_REFINE_QUOTIENT_H

#include "modes/refine/foot.h"

#include <math.h>
#include <string.h>

/* residuals of a step at x: node a (W) and piece (W), and M x of both */
RD_INLINE void residual(const struct rd_refine *r, size_t m, const struct rate *rate, lanes *node,
                        lanes *piece, lanes *mass_node, lanes *mass_piece)
{
    const _Bool end = m == r->steps;
    const lanes *u = r->u + m * W, *f = r->f + m * W;
    for (int i = 0; i < W; i++) {
        node[i] = m > 0 ? f[i - W] : l_fill(0);
        node[i] -= end ? l_fill(0) : f[i];
        piece[i] = end ? l_fill(0) : u[W + i] - u[i];
        mass_node[i] = mass_piece[i] = l_fill(0);
        for (int j = 0; j < W; j++) {
            node[i] += rate->V[i][j] * u[j];
            mass_node[i] -= rate->dV[i][j] * u[j];
            if (end)
                continue;
            node[i] -= rate->D[j][i] * f[j];
            piece[i] -= rate->D[i][j] * u[j] + rate->G[i][j] * f[j];
            mass_node[i] += rate->dD[j][i] * f[j];
            mass_piece[i] += rate->dD[i][j] * u[j] + rate->dG[i][j] * f[j];
        }
    }
}

/* node term at the first node of step m, or at the last node */
RD_INLINE int32_t term_at(const struct rd_refine *r, size_t m)
{
    return m < r->steps ? r->step[m].term : r->walk->last;
}

RD_INLINE void rate_at(const struct rd_refine *r, size_t m, lanes lambda, struct rate *rate)
{
    if (m < r->steps)
        rate_load(r, r->step + m, lambda, rate);
    else {
        memset(rate, 0, sizeof *rate);
        rate_node(r, r->walk->last, r->walk->behind, lambda, rate);
    }
}

static RD_CLONES void quotient_lanes(struct rd_refine *r, const double *lambdas,
                                     struct rd_quotient *quotient)
{
    const lanes lambda = lanes_load(lambdas);
    lanes xAx = l_fill(0), xMx = l_fill(0), noise = l_fill(0), energy = l_fill(0);
    struct rate rate;
    for (size_t m = 0; m <= r->steps; m++) {
        lanes node[W], piece[W], mn[W], mp[W];
        const lanes *u = r->u + m * W, *f = r->f + m * W;
        const int32_t level = m < r->steps ? r->step[m].level : 0;
        rate_at(r, m, lambda, &rate);
        residual(r, m, &rate, node, piece, mn, mp);
        const int32_t term = term_at(r, m);
        for (size_t k = foot_first(r, term); rd_attached_is_of(r->walk->chain, k, term); k++) {
            struct foot foot;
            lanes mass;
            foot_make(r, k, lambda, &foot);
            xAx += r->y[k] * foot_residual(r, k, &foot, u, node, mn, &mass);
            xMx += r->y[k] * mass;
            const lanes work = l_abs(foot.w * foot.e * r->y[k] * r->y[k]) +
                               2 * l_abs(foot.w * r->y[k] * foot_dot(foot.v, u));
            noise += work * work;
            energy += work;
        }
        for (int i = 0; i < W; i++) {
            lanes size = l_fill(0), work = l_fill(0);
            xAx += u[i] * node[i];
            xMx += u[i] * mn[i];
            for (int j = 0; j < W; j++)
                work += l_abs(u[i] * rate.V[i][j] * u[j]);
            if (m < r->steps) {
                xAx += f[i] * piece[i];
                xMx += f[i] * mp[i];
                size = l_abs(f[i]) * (l_abs(u[i]) + l_abs(u[W + i]));
                for (int j = 0; j < W; j++)
                    work +=
                        l_abs(f[i] * rate.G[i][j] * f[j]) + 2 * l_abs(f[i] * rate.D[i][j] * u[j]);
            }
            noise += size * size + work * work;
            energy += work * (1 + level);
        }
    }
    for (int k = 0; k < RD_LANES; k++) {
        const double eps = 16 * 2.3e-16;
        quotient->residual[k] = xAx[k] / xMx[k];
        quotient->lambda[k] = lambdas[k] + quotient->residual[k];
        quotient->error[k] =
            eps * ((sqrt(noise[k]) + energy[k]) / fabs(xMx[k]) + fabs(quotient->lambda[k]));
    }
}

void WIDTH(quotient)(struct rd_refine *r, const double *lambdas, struct rd_quotient *quotient)
{
    quotient_lanes(r, lambdas, quotient);
}

/* A_kj += x_k y_j, rows n apart */
RD_INLINE void gram_add(lanes x, lanes y, size_t n, double *A)
{
    for (size_t k = 0; k < RD_LANES; k++)
        for (size_t j = 0; j < RD_LANES; j++)
            A[k * n + j] += x[k] * y[j];
}

/* what step m, its residuals and M x those of the block at work, adds to the products with a block */
RD_INLINE void gram_step(const struct rd_refine *r, size_t m, lanes lambda, const struct rate *rate,
                         const lanes *u, size_t n, double *A, double *M)
{
    const lanes *f = u + (r->capacity + 1) * W, *y = f + r->capacity * W;
    lanes node[W], piece[W], mn[W], mp[W];
    residual(r, m, rate, node, piece, mn, mp);
    const int32_t term = term_at(r, m);
    for (size_t k = foot_first(r, term); rd_attached_is_of(r->walk->chain, k, term); k++) {
        struct foot foot;
        lanes mass;
        foot_make(r, k, lambda, &foot);
        const lanes rest = foot_residual(r, k, &foot, r->u + m * W, node, mn, &mass);
        gram_add(y[k], rest, n, A);
        gram_add(y[k], mass, n, M);
    }
    for (size_t i = 0; i < W; i++) {
        gram_add(u[m * W + i], node[i], n, A);
        gram_add(u[m * W + i], mn[i], n, M);
        if (m == r->steps)
            continue;
        gram_add(f[m * W + i], piece[i], n, A);
        gram_add(f[m * W + i], mp[i], n, M);
    }
}

void WIDTH(gram)(struct rd_refine *r, const double *lambdas, size_t blocks, double *A, double *M)
{
    const lanes lambda = lanes_load(lambdas);
    const size_t n = blocks * RD_LANES, apart = rd_refine_apart(r);
    struct rate rate;
    memset(A, 0, n * n * sizeof *A);
    memset(M, 0, n * n * sizeof *M);
    for (size_t m = 0; m <= r->steps; m++) {
        rate_at(r, m, lambda, &rate);
        for (size_t b = 0; b < blocks; b++) {
            rd_refine_choose(r, b);
            for (size_t a = 0; a < blocks; a++) {
                const size_t at = a * RD_LANES * n + b * RD_LANES;
                gram_step(r, m, lambda, &rate, r->vectors + a * apart, n, A + at, M + at);
            }
        }
    }
    rd_refine_choose(r, 0);
}

#endif
