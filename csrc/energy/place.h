/* How the form of two motions changes where a node between continuous elements moves. */
#ifndef RD_PLACE_H
#define RD_PLACE_H

#include "base/lanes.h"
#include "element/coordinate.h"
#include "span/rate_matrix.h"

/* The form of an element changes with its length by -y^T H y (span/rate_matrix.h), so that with the
   place x of a node

       dPi/dx = y_r^T H_r y_r - y_l^T H_l y_l

   of its right and its left side. Where little stands at the node these are alike, and their
   difference is not taken of them: with the mean m and the jump d of y, of two motions a, b,

       m_a^T (H_r - H_l) m_b + d_a^T (H_r - H_l) d_b/4 + m_a^T H d_b + d_a^T H m_b,  H their mean,

   d being what the node resists by and what hinges open by. */

/* One load at the node: mean and jump of y (2 width), and the sizes of what they are sums of. */
struct rd_kink {
    cv mean[2 * RD_WIDTH_MAX], jump[2 * RD_WIDTH_MAX];
    lanes of_mean[2 * RD_WIDTH_MAX], of_jump[2 * RD_WIDTH_MAX];
};

/* an element's change at a node, and the sizes of the terms of that change */
struct rd_place {
    cv slope;
    lanes size;
};

struct rd_place rd_place_between(const struct rate_matrix *left, const struct rate_matrix *right,
                                 size_t w, const struct rd_kink *a, const struct rd_kink *b);

/* the sizes of the terms of y^T H y of the element on the left, whose y is the mean */
lanes rd_place_size(const struct rate_matrix *left, size_t w, const struct rd_kink *a,
                    const struct rd_kink *b);

#endif
