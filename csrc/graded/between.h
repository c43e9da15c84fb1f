/* Triples of the blocks of graded elements at a few frequencies, between which all others of a band are
   interpolated: what a block is made of ends far below its own resonances, and is an analytic function
   of the frequency up to there. What only the inertia of z makes, that is what a motion of z alone
   leaves of D and Q, is kept per unit of it: it vanishes with the frequency, and keeps its digits so. */
#ifndef RD_BETWEEN_H
#define RD_BETWEEN_H

#include "graded/family.h"

enum { RD_BETWEEN_MOST = 64 };

struct rd_between {
    struct rd_sizes most; /* of the factors in the band: by these blocks are chosen */
    bool real;            /* nothing is damped: imaginary parts are 0 */
    size_t nodes;         /* frequencies: a multiple of RD_LANES, RD_BETWEEN_MOST at most */
    const size_t
        *first; /* (distinct, 2) places where the entries of an element begin, and those of it
                              seen backward */
    const double *values; /* (places, 2, nodes) real and imaginary parts, not scaled, of D and Q the
                              entries of a motion of z per unit of its load q */
    const double *weight; /* (frequencies, nodes) what the nodes count for */
};

/* complex factors of the nodes, each (nodes, 2) */
struct rd_between_factors {
    const double *section, *tension, *inertia, *dashpot;
};

/* Fills first where it is not NULL. Returns how many places there are, RD_BETWEEN_NONE where an element
   has too many pieces. */
#define RD_BETWEEN_NONE ((size_t)-1)
size_t rd_between_layout(const struct rd_chain *chain, const struct rd_sizes *most, size_t *first);

/* Fills the values (places, 2, nodes) of what has all but these and the weights. */
void rd_between_fill(const struct rd_chain *chain, const struct rd_between *between,
                     const struct rd_between_factors *factors, double *values);

/* weight (nodes): of frequencies side by side */
void rd_between_weigh(const struct rd_between *between, const size_t *index, lanes *weight);

/* q of z of element e, the inertia and drag of a unit length */
cv rd_between_load(const struct rd_chain *chain, size_t e, cv inertia, cv dashpot);

/* what turns entries of the nodes into those of frequencies side by side */
struct rd_between_lines {
    lanes weight[RD_BETWEEN_MOST];
    lanes z[RD_GRADED_WIDTH]; /* scales: u = z u^, f = f^/z */
    cv load;
};

/* A block's triples, from those that begin at `values`; returns where those of the next block do. */
const double *rd_between_family(const struct rd_between *between,
                                const struct rd_between_lines *lines, const double *values,
                                size_t width, const struct rd_block *block,
                                struct rd_family *family);

#endif
