/* Structures in the iteration: into the left part, and out of it again. */
#ifndef RD_REFINE_FOOT_H
#define RD_REFINE_FOOT_H

#include "modes/refine/left.h"
#include "modes/refine/load.h"

/* the first structure of a node, or of a later one */
RD_INLINE size_t foot_first(const struct rd_refine *r, int32_t term)
{
    const struct rd_chain *chain = r->walk->chain;
    return chain->attached == 0 || term == RD_NO_TERM ? chain->attached
                                                      : rd_attached_first(chain, (size_t)term);
}

RD_INLINE void foot_make(const struct rd_refine *r, size_t k, lanes lambda, struct foot *foot)
{
    lanes z[W];
    for (int i = 0; i < W; i++)
        z[i] = l_fill(r->z[i]);
    foot_load(r->walk->chain, k, lambda, foot);
    foot_scale(foot, z);
}

/* Its load in the next iteration over w: what remains of -A' x where e y = v^T u. */
RD_INLINE lanes foot_pull(const struct rd_refine *r, size_t k, const struct foot *foot,
                          const lanes *u, unsigned begin)
{
    enum { FAR = 1 << 30 }; /* loads beyond those of nodes */
    lanes load = l_fill(0);
    if (begin != RD_ALL_LANES)
        load = foot_dot(foot->dv, u) - foot->de * r->y[k];
    return begin ? l_select(lanes_of(begin), fixed_load(r->block, FAR + k, 0), load) : load;
}

/* x = U v and 1/(e - i w v^T x) */
RD_INLINE cv foot_reach(const struct left *left, const struct foot *foot, cv *x)
{
    const cv h = along(left->U, foot->v, x);
    return invert_any(c_make(foot->e + foot->w * h.im, -foot->w * h.re));
}

RD_INLINE cv foot_along(const struct foot *foot, const cv *g)
{
    cv sum = c_scale_lanes(g[0], foot->v[0]);
    for (int i = 1; i < W; i++)
        sum = c_add(sum, c_scale_lanes(g[i], foot->v[i]));
    return sum;
}

RD_INLINE void foot_take(struct left *left, const struct foot *foot, lanes load)
{
    cv x[W];
    const cv d = c_turn(foot_reach(left, foot, x), foot->w);
    cv t = foot_along(foot, left->g);
    t.re += load;
    t = c_mul(t, d);
    for (int i = 0; i < W; i++) {
        const cv xd = c_mul(x[i], d);
        left->g[i] = c_add(left->g[i], c_mul(x[i], t));
        for (int j = 0; j <= i; j++)
            left->U[i][j] = left->U[j][i] = c_add(left->U[i][j], c_mul(xd, x[j]));
    }
}

/* the structures of a node into the left part, u the motion that loads them; those before `end` */
RD_INLINE void feet_take(const struct rd_refine *r, int32_t term, size_t end, lanes lambda,
                         const lanes *u, unsigned begin, struct left *left)
{
    for (size_t k = foot_first(r, term); k < end && rd_attached_is_of(r->walk->chain, k, term);
         k++) {
        struct foot foot;
        foot_make(r, k, lambda, &foot);
        foot_take(left, &foot, foot_pull(r, k, &foot, u, begin));
    }
}

/* y of each, last first, and s before them; left is the part before, u the motion that loaded them */
RD_INLINE void feet_leave(struct rd_refine *r, int32_t term, lanes lambda, const lanes *u,
                          unsigned begin, const struct left *left, cv *s)
{
    const size_t first = foot_first(r, term);
    size_t end = first;
    while (rd_attached_is_of(r->walk->chain, end, term))
        end++;
    for (size_t k = end; k-- > first;) {
        struct left before = *left;
        struct foot foot;
        cv x[W];
        feet_take(r, term, k, lambda, u, begin, &before);
        foot_make(r, k, lambda, &foot);
        const cv inverse = foot_reach(&before, &foot, x);
        cv y = foot_along(&foot, before.g);
        y.re += foot_pull(r, k, &foot, u, begin);
        for (int i = 0; i < W; i++)
            y = c_add(y, c_mul(x[i], s[i]));
        y = c_mul(y, inverse);
        for (int i = 0; i < W; i++)
            s[i] = c_add(s[i], c_turn(y, foot.w * foot.v[i]));
        r->next[k] = y.re;
    }
}

/* Residual of structure k at x, and M x = -A' x; what it adds to those of its node. With y fixed, A'
   would know lambda = 0 as an eigenvalue too, where w = 0: fixed is sqrt(w) y, which makes of

       w e y^2 - 2 w y v^T u  by lambda:  w e' y^2 - w' y v^T u - 2 w y v'^T u */
RD_INLINE lanes foot_residual(const struct rd_refine *r, size_t k, const struct foot *foot,
                              const lanes *u, lanes *node, lanes *mass_node, lanes *mass)
{
    const lanes y = r->y[k], along = foot_dot(foot->v, u), change = foot_dot(foot->dv, u);
    for (int i = 0; i < W; i++) {
        node[i] -= foot->w * foot->v[i] * y;
        mass_node[i] += (0.5 * foot->dw * foot->v[i] + foot->w * foot->dv[i]) * y;
    }
    *mass = 0.5 * foot->dw * along + foot->w * (change - foot->de * y);
    return foot->w * (foot->e * y - along);
}

#endif
