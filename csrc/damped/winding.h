/* How many roots a circle surrounds, by the argument principle. */
#ifndef RD_WINDING_H
#define RD_WINDING_H

#include "damped/function.h"

/* what a walk around the circle |s - middle| = radius tells */
struct rd_winding {
    double middle;           /* real: mirror images lie in it as they do in the plane [rad/s] */
    double radius;           /* [rad/s] */
    size_t count;            /* roots inside */
    enum rd_mirror mirror;   /* where there is one the walk is around half the circle */
    size_t begin;            /* arcs that the walk begins with */
    size_t most, arcs;       /* arcs that there is room for, and that it ended with */
    double *end;             /* (most, 2) angles of their ends */
    double _Complex *change; /* (most) of the function's logarithm along each */
    struct rd_arc *arc;      /* (begin + ..) those that are open */
};

/* Lays out a walk by a function taken for that circle, measured or not.
   RD_SHORT_WAVES: more arcs than can be walked; RD_NO_MEMORY */
enum rd_status rd_winding_take(const struct rd_function *f, double middle, double radius,
                               struct rd_workspace *workspace, struct rd_winding *w);

/* Counts the roots inside; *known is false where the function cannot be told from its
   rounding on the circle. RD_SHORT_WAVES, RD_INTERRUPTED */
enum rd_status rd_winding_walk(struct rd_function *f, struct rd_winding *w, bool *known);

/* moment (number) <- sums of powers 1 .. number of (root - middle)/radius over all but `count` known roots, to
   some per cent */
void rd_winding_moments(const struct rd_winding *w, size_t count, const double _Complex *known,
                        size_t number, double _Complex *moment);

#endif
