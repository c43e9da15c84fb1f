/* Structures that nodes carry, at several real lambda side by side; W is the width. */
#ifndef RD_FOOT_H
#define RD_FOOT_H

#include "base/complex_step.h"
#include "base/real_lanes.h"
#include "chain/attached.h"
#include "modes/walk/walk.h"
#include "modes/walk/width.h"

/* rd_foot (chain/attached.h), v by the motion of the node, and d/dlambda of each */
struct foot {
    lanes w, e, v[W], rest[2];
    lanes dw, de, dv[W], drest[2];
    lanes held;
};

RD_INLINE void foot_set(double _Complex value, int lane, lanes *x, lanes *dx)
{
    (*x)[lane] = creal(value);
    (*dx)[lane] = cimag(value) / RD_COMPLEX_STEP;
}

RD_INLINE void foot_load(const struct rd_chain *chain, size_t k, lanes lambda, struct foot *foot)
{
    for (int lane = 0; lane < RD_LANES; lane++) {
        struct rd_foot one;
        double _Complex v[RD_WIDTH_MAX];
        rd_attached_fill(chain, k, CMPLX(-lambda[lane], -RD_COMPLEX_STEP), 0, &one);
        rd_attached_row(chain, k, one.lever, v);
        foot_set(one.weight, lane, &foot->w, &foot->dw);
        foot_set(one.gap, lane, &foot->e, &foot->de);
        for (int i = 0; i < W; i++)
            foot_set(v[i], lane, foot->v + i, foot->dv + i);
        for (int i = 0; i < 2; i++)
            foot_set(one.rest[i], lane, foot->rest + i, foot->drest + i);
        foot->held[lane] = one.held;
    }
}

/* u = z u^ */
RD_INLINE void foot_scale(struct foot *foot, const lanes *z)
{
    for (int i = 0; i < W; i++) {
        foot->v[i] *= z[i];
        foot->dv[i] *= z[i];
    }
}

RD_INLINE lanes foot_dot(const lanes *v, const lanes *u)
{
    lanes sum = v[0] * u[0];
    for (int i = 1; i < W; i++)
        sum += v[i] * u[i];
    return sum;
}

/* what is regular of the structures of a node term, and of their d/dlambda where dN is not NULL,
   added */
RD_INLINE void foot_rest(const struct rd_chain *chain, int32_t term, lanes lambda, lanes N[W][W],
                         lanes dN[W][W])
{
    if (chain->attached == 0 || term == RD_NO_TERM)
        return;
    for (size_t k = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, k, term);
         k++) {
        struct foot foot;
        foot_load(chain, k, lambda, &foot);
        for (int part = 0; part < 2; part++) {
            const double *row = chain->attached_row + (2 * k + (size_t)part) * W;
            for (int i = 0; i < W; i++)
                for (int j = 0; j < W; j++) {
                    N[i][j] += foot.rest[part] * (row[i] * row[j]);
                    if (dN)
                        dN[i][j] += foot.drest[part] * (row[i] * row[j]);
                }
        }
    }
}

#endif
