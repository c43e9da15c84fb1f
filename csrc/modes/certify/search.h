/* Brackets of the lowest modes, from counts. */
#ifndef RD_SEARCH_H
#define RD_SEARCH_H

#include "base/real_lanes.h"
#include "modes/walk/walk.h"

#include <stdbool.h>

/* mode i is between low and high: count(low) <= i < count(high) */
struct rd_search {
    const struct rd_walk *walk;
    size_t wanted;
    size_t counts; /* lambda counted so far */
    bool lost;     /* waves of some lambda were too short to be counted */
    double size;   /* [rad^2/s^2] of the order of the first mode, a lower guess */
    double *low;   /* (wanted) [rad^2/s^2] */
    double *high;  /* (wanted) */
    double *below; /* (wanted) count at low */
    double *above; /* (wanted) count at high */
};

/* Brackets from -infinity to infinity, in an array (4, wanted). */
void rd_search_begin(const struct rd_walk *walk, size_t wanted, double *bracket,
                     struct rd_search *search);

/* Tightens the brackets by the count at one lambda; NaN says nothing. */
void rd_search_learn(struct rd_search *search, double lambda, double count);

/* Finds a lambda <= -nearest with nothing below: K - lambda M is positive definite there, so that every mode above
   has x^T M x > 0. RD_UNSTABLE_MASSLESS: there is none, RD_SHORT_WAVES: there was what could
   not be counted. */
enum rd_status rd_search_bottom(struct rd_search *search, double nearest);

/* Raises high until all that are wanted are below it or upper; *below is how many are. RD_SHORT_WAVES:
   what is to be counted has more pieces than are walked. */
enum rd_status rd_search_top(struct rd_search *search, double upper, size_t *below);

/* Cuts the brackets of the modes index (n), all lanes at work. */
void rd_search_cut(struct rd_search *search, size_t n, const size_t *index);

/* Cuts until each bracket has a single mode or is relatively narrower than `narrow`. */
void rd_search_isolate(struct rd_search *search, double narrow);

static inline bool rd_search_is_single(const struct rd_search *search, size_t i)
{
    return search->above[i] - search->below[i] == 1;
}

static inline bool rd_search_is_inside(const struct rd_search *search, size_t i, double lambda)
{
    return lambda >= search->low[i] && lambda <= search->high[i];
}

#endif
