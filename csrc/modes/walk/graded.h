/* Pieces of legs whose tension grows along them (graded/blocks.h), at several real lambda side by side;
   W is the width. */
#ifndef RD_WALK_GRADED_H
#define RD_WALK_GRADED_H

#include "graded/family.h"
#include "modes/walk/piece.h"

RD_INLINE _Bool leg_is_graded(const struct rd_walk *walk, const struct rd_leg *leg)
{
    return W <= RD_GRADED_WIDTH && rd_is_graded(walk->chain, (size_t)leg->element);
}

/* the blocks (RD_BLOCKS_MOST) of one element of a leg; 0 where it has too many pieces */
static size_t graded_blocks(const struct rd_walk *walk, const struct rd_leg *leg,
                            const lanes *lambda, struct rd_block *block)
{
    const struct rd_sizes sizes = {1, 1, largest(*lambda), 0};
    return rd_blocks_of(walk->chain, (size_t)leg->element, &sizes, 0, block);
}

/* a block's triples, with d/dlambda as their imaginary parts */
static void graded_fill(const struct rd_walk *walk, const struct rd_leg *leg, const lanes *lambda,
                        const struct rd_block *block, struct rd_family *family)
{
    const cv inertia = c_make(-*lambda, l_fill(-RD_COMPLEX_STEP));
    struct rate_matrix rate;
    const struct rd_field field = {
        .width = W,
        .rate = &rate,
        .tension = walk->chain->tension[leg->element],
        .pull = c_real(1),
    };
    rd_rate_fill(walk->chain, (size_t)leg->element, c_real(1), c_real(1), inertia, c_zero(), &rate);
    rd_family_fill(&field, block, family);
}

RD_INLINE void graded_set(cv x, lanes *piece, lanes *change)
{
    *piece = x.re;
    if (change)
        *change = x.im / RD_COMPLEX_STEP;
}

/* piece i of a block and, where change is not NULL, its d/dlambda */
static void graded_load(const struct rd_family *family, size_t i, struct piece *piece,
                        struct piece *change)
{
    cv triple[RD_GRADED_TRIPLE];
    rd_family_piece(family, i, triple);
    for (int a = 0, p = W * W; a < W; a++)
        for (int b = 0; b < W; b++) {
            graded_set(triple[a * W + b], &piece->D[a][b], change ? &change->D[a][b] : NULL);
            if (b < a)
                continue;
            const cv Q = triple[p + W * (W + 1) / 2];
            graded_set(triple[p], &piece->G[a][b], change ? &change->G[a][b] : NULL);
            graded_set(triple[p++], &piece->G[b][a], change ? &change->G[b][a] : NULL);
            graded_set(Q, &piece->Q[a][b], change ? &change->Q[a][b] : NULL);
            graded_set(Q, &piece->Q[b][a], change ? &change->Q[b][a] : NULL);
        }
}

#endif
