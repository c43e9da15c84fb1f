/* The triples of a whole continuous element, at several lambda or sections side by side. */
#ifndef RD_TRANSFER_H
#define RD_TRANSFER_H

#include "base/complex.h"
#include "chain/chain.h"
#include "span/rate_matrix.h"

/* An element's u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a, each (RD_LANES, width, width). */
struct rd_transfer {
    double _Complex F[RD_LANES][RD_WIDTH_MAX * RD_WIDTH_MAX];
    double _Complex G[RD_LANES][RD_WIDTH_MAX * RD_WIDTH_MAX];
    double _Complex Q[RD_LANES][RD_WIDTH_MAX * RD_WIDTH_MAX];
};

/* At the factors part (RD_PARTS). Joined from halves; the element must be shorter than its first resonance as a cantilever, which
   the joints would meet. */
void rd_transfer_fill(const struct rd_chain *chain, size_t e, const cv *part,
                      struct rd_transfer *transfer);

/* A bound of the radians that waves, evanescent ones included, have along a whole element. */
double rd_transfer_radians(const struct rd_chain *chain, size_t e, const struct rate_matrix *rate);

/* D = F - I, G and Q, each (width, width), of a piece of length l by so many terms of its series
   (span/span.h) */
void rd_transfer_slice(size_t width, const struct rate_matrix *rate, double l, int terms, cv *D,
                       cv *G, cv *Q);

#endif
