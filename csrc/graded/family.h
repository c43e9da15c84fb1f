/* Triples of pieces of a block (graded/blocks.h), at several lambda side by side. */
#ifndef RD_FAMILY_H
#define RD_FAMILY_H

#include "base/lanes.h"
#include "graded/blocks.h"
#include "span/rate_matrix.h"

enum { RD_GRADED_WIDTH = 2, RD_GRADED_TRIPLE = 10 };

/* Packed by rows: D = F - I (width, width), and the upper triangles of G and Q. Those of the block's
   pieces as they are, where they are few; else at the nodes of a polynomial. */
struct rd_family {
    const struct rd_block *block;
    size_t width;
    bool apart; /* the pieces as they are */
    cv at[RD_NODES_MOST][RD_GRADED_TRIPLE];
};

/* An element: its rate matrix at the middle, where the tension is `tension`, of which the q_beta of a
   beam grows by `pull` for each unit. The imaginary parts that its tension and the slope of it have
   are 0 but for derivatives. */
struct rd_field {
    size_t width;
    const struct rate_matrix *rate;
    double tension; /* [N] */
    cv pull;
    double more, steeper; /* [N, N/m] */
};

/* of a block of the element */
void rd_family_fill(const struct rd_field *field, const struct rd_block *block,
                    struct rd_family *family);

/* the whole element, which is shorter than its first resonance as a cantilever, and its blocks */
void rd_family_whole(const struct rd_field *field, size_t blocks, const struct rd_block *block,
                     cv *triple);

/* triple of piece i, from the near end on */
void rd_family_piece(const struct rd_family *family, size_t i, cv *triple);

/* two pieces joined: triple (RD_GRADED_TRIPLE) <- this one and `next` behind it */
void rd_family_join(size_t width, const cv *next, cv *triple);

#endif
