/* How many eigenvalues of K - lambda M lie below zero. */
#ifndef RD_COUNT_H
#define RD_COUNT_H

#include "modes/walk/walk.h"

/* counts[i]: negative eigenvalues of K - lambda[i] M; where M is not negative and K positive that is
   the number of squared angular frequencies below lambda [rad^2/s^2]. For any real lambda; NaN where
   a span has more pieces shorter than its waves than are walked (span/span.h), or numbers overflow.
   lambda, counts (count). */
void rd_count(const struct rd_walk *walk, size_t count, const double *lambda, double *counts);

/* the same for one width, RD_LANES at a time */
void rd_count_1(const struct rd_walk *walk, const double *lambda, double *counts);
void rd_count_2(const struct rd_walk *walk, const double *lambda, double *counts);
void rd_count_3(const struct rd_walk *walk, const double *lambda, double *counts);
void rd_count_4(const struct rd_walk *walk, const double *lambda, double *counts);

#endif
