/* An element as a load moves it. */
#ifndef RD_MOVED_H
#define RD_MOVED_H

#include "base/lanes.h"
#include "element/coordinate.h"

/* What the slopes of an element's form are products of; all is linear in the motion of its ends. */
struct rd_moved {
    cv u[2 * RD_WIDTH_MAX]; /* (2, width) of its ends, apart from the nodes where hinges open */
    cv opens[RD_WIDTH_MAX]; /* (width) hinges on its left */
    cv left[RD_WIDTH_MAX];  /* force on its ends, of a stepped one */
    cv right[RD_WIDTH_MAX];
    lanes from_left[RD_WIDTH_MAX]; /* sizes of what these forces are differences of */
    lanes from_right[RD_WIDTH_MAX];
    cv state[2 * RD_WIDTH_MAX]; /* of a stepped one: what the forms are of */
    cv e[2], g[2];              /* of its rods, of a massless one: stretch, force */
    cv moment;                  /* integral of the moment that goes with the turn of its ends */
    cv delta, rise, sway;       /* beta_b - beta_a, 2 (z_b - z_a)/l, rise less beta_a + beta_b */
};

#endif
