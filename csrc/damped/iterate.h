/* Simultaneous approximation of all roots within a circle. */
#ifndef RD_ITERATE_H
#define RD_ITERATE_H

#include "damped/winding.h"

struct rd_iterate {
    size_t count, most;     /* roots found, and those that there is room for */
    double spacing;         /* mean distance of roots [rad/s] */
    double _Complex *z;     /* (most) the roots, some outside the circle too [rad/s] */
    double _Complex *next;  /* (most) where they begin, and where they go */
    double _Complex *at;    /* (2 most) where the function is asked */
    double _Complex *value; /* (2 most) and what it is */
    double *magnitude;      /* (2 most) */
    size_t *active;         /* (most) roots that still move */
    size_t *twin;           /* (most) which is kept the mirror image of one, or itself */
    double *step;           /* (most) how far it went the last time, or would have */
};

/* room for a circle with so many roots; false: the workspace measures or is too small */
bool rd_iterate_take(size_t roots, struct rd_workspace *workspace, struct rd_iterate *it);

/* Finds as many roots as the winding tells, from guesses (guesses), which have their mirror images
   beside them, and points all over the circle. There are fewer where the iteration does not find
   them. RD_SHORT_WAVES, RD_INTERRUPTED */
enum rd_status rd_iterate_find(struct rd_iterate *it, struct rd_function *f,
                               const struct rd_winding *within, size_t guesses,
                               const double _Complex *guess);

#endif
