/* All rates of damped motion of a chain within a circle, certified by count. */
#ifndef RD_SEARCH_H
#define RD_SEARCH_H

#include "damped/function.h"

struct rd_search {
    const struct rd_chain *chain; /* one component, between nodes that nothing moves */
    struct rd_damping damping;
    struct rd_stop stop;
    double middle; /* of the circle asked for, real and 0 or more [rad/s] */
    double radius; /* of it [rad/s] */
    double edge,
        horizon;    /* middle + radius grows to `edge` at most; the function is asked for |s| below
                                    the middle between it and `horizon` [rad/s] */
    size_t guesses; /* places to begin with, which have their mirror images beside them */
    const double _Complex *guess; /* (guesses) [rad/s] */
    size_t room;                  /* roots inside the circle, at most */

    double wide;            /* radius of the circle that was searched [rad/s] */
    size_t count;           /* roots inside it */
    size_t found;           /* those that are given: of mirror images the one with Im s > 0 */
    double _Complex *value; /* (room) [rad/s] */
    double *error;          /* (room) estimated absolute error [rad/s] */
    enum rd_mirror mirror;
    bool certified; /* circles around them surround as many as the whole circle does */
    size_t sweeps;  /* how often the function was asked */
};

/* Searches, on wider and wider circles until one has no root on it.

   RD_OK: all are found where `certified`; nothing is known where it is not, because motion that
   decays so fast cannot be told from rounding. RD_NO_MEMORY: the workspace measures, is too small, or
   count > room. RD_SHORT_WAVES, RD_INTERRUPTED */
enum rd_status rd_search(struct rd_search *search, struct rd_workspace *workspace);

#endif
