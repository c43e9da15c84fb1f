/* The channels of an element that are constant along it: axial force and torque. */
#ifndef RD_RODS_H
#define RD_RODS_H

#include "base/status.h"
#include "element/element.h"

/* With S_cb the flexibility they share with bending, r = S_cb/S_bb and S^ = S_cc - S_cb S_bc/S_bb,

       force = S^^-1 e/l,   e = (u_b - u_a)_c - r (beta_b - beta_a) */
struct rd_rods {
    size_t count;      /* 0 to 2 */
    size_t at[2];      /* (count)         index of the coordinate */
    int channel[2];    /* (count)         enum rd_channel */
    double r[2];       /* (count)         0 without bending */
    double inverse[4]; /* (count, count)  S^^-1 */
};

/* RD_NOT_POSITIVE_DEFINITE where they would create energy */
enum rd_status rd_rods_of(const struct rd_element *element, struct rd_rods *rods);

#endif
