/* What moves in closed form while no law changes, as functions of time. */
#ifndef RD_COURSE_H
#define RD_COURSE_H

#include "base/workspace.h"

/*     y(t) = Re sum_j (c_j + d_j t) e^(rate_j t) + sum_m a_m t^m

   Sums over the rates fill lanes: those too many are 0, and so is what they multiply. */
struct rd_course {
    size_t outputs, rates, growing, powers;
    double *rate; /* (2, room of rates) [1/s], real and imaginary parts apart */
    double *c;    /* (outputs, 2, room of rates)                              */
    double *d;    /* (outputs, 2, room of growing) of the first rates         */
    double *a;    /* (outputs, powers), one at least                          */
};

/* rates and those too many */
size_t rd_course_room(size_t rates);

/* c, d and a as large as those of another, or counted while the workspace measures, rates shared */
void rd_course_take(struct rd_workspace *workspace, const struct rd_course *like,
                    struct rd_course *course);

/* c and d, each (count, n), from where numbers are pairs */
void rd_course_parts(size_t count, size_t n, const double *pairs, double *parts);

/* dy/dt; `to` may be the course itself */
void rd_course_derive(const struct rd_course *course, struct rd_course *to);

/* e^(rate t), (2, room of rates) */
void rd_course_waves(const struct rd_course *course, double t, double *waves);

/* waves a time later, by the waves of that time */
void rd_course_later(const struct rd_course *course, const double *step, double *waves);

/* one of the outputs where e^(rate t) is known */
double rd_course_value(const struct rd_course *course, size_t output, const double *waves,
                       double t);

/* bounds the outputs between two times, (outputs,); growth (rates,) is work */
void rd_course_size(const struct rd_course *course, double first, double last, double *growth,
                    double *size);

#endif
