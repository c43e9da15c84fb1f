/* A continuous element whose tension grows along it: blocks in which it changes so little that the
   triples of short pieces are known everywhere from those at a few nodes of a polynomial. */
#ifndef RD_BLOCKS_H
#define RD_BLOCKS_H

#include "chain/chain.h"

#include <stdbool.h>

enum { RD_NODES_MOST = 24, RD_BLOCKS_MOST = 64 };

/* sizes of the factors on sections, tension, inertia and drag */
struct rd_sizes {
    double section, tension, inertia, dashpot;
};

/* Pieces of a block are 2^-halvings of it at first. Doubled as often as they stay below their first
   resonance as a cantilever they are `pieces`, which a walk takes one after another. */
struct rd_block {
    double length;  /* [m] */
    double tension; /* at its near end [N] */
    double slope;   /* [N/m] */
    int nodes;      /* of the polynomials */
    int halvings, doublings;
    int terms; /* of the series of a first piece of up to one radian */
    size_t pieces;
    bool vanishes; /* string of no tension at one end: a piece by its own series */
};

/* whether the tension of distinct element e grows along it */
static inline bool rd_is_graded(const struct rd_chain *chain, size_t e)
{
    return chain->rise != NULL && e < chain->distinct && chain->rise[e] != 0;
}

/* the least tension of distinct element e [N] */
static inline double rd_blocks_least(const struct rd_chain *chain, size_t e)
{
    if (!rd_is_graded(chain, e))
        return chain->tension[e];
    const double rise = chain->rise[e];
    return chain->tension[e] - (rise < 0 ? -rise : rise) / 2;
}

/* The blocks (RD_BLOCKS_MOST) of a graded element of a string or a beam from its left end or,
   backward, from its right end. Returns how many, 0 where they have more pieces than are walked. */
size_t rd_blocks_of(const struct rd_chain *chain, size_t e, const struct rd_sizes *sizes,
                    bool backward, struct rd_block *block);

#endif
