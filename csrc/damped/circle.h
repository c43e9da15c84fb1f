/* The roots within a small circle, and how far rounding moves them. */
#ifndef RD_CIRCLE_H
#define RD_CIRCLE_H

#include "damped/function.h"
#include "damped/powers.h"

enum { RD_CIRCLE_SAMPLES = 16 }; /* points of a circle for each root in it */

/* arrays for the largest cluster, of RD_POWERS_MOST roots */
struct rd_circle {
    double _Complex *turn, *s, *value, *series, *slope; /* (samples) */
    double *magnitude;                                  /* (samples) */
    double _Complex moment[RD_POWERS_MOST], offset[RD_POWERS_MOST];
};

/* false: the workspace measures or is too small */
bool rd_circle_take(size_t roots, struct rd_workspace *workspace, struct rd_circle *circle);

/* member (count) <- the roots of a cluster, `gap` away from all others and from what is not known,
   and error (count) [rad/s]. *settled is false where no circle surrounds as many.
   RD_SHORT_WAVES, RD_INTERRUPTED */
enum rd_status rd_circle_settle(struct rd_circle *circle, struct rd_function *f, size_t count,
                                double gap, double _Complex *member, double *error, bool *settled);

#endif
