/* When a law changes: the first time at which one of several functions falls below zero. */
#ifndef RD_CROSSING_H
#define RD_CROSSING_H

#include <stdbool.h>

#include "base/status.h"
#include "base/stop.h"
#include "law/course.h"

struct rd_crossing {
    bool found;
    double time;
    size_t which;
};

/* The first time in 0 ... end at which a guard falls below zero, and none before it but what rounding
   hides. scale (outputs) is the size of the numbers that each is a difference of. The workspace
   measures where its base is NULL. RD_OVERFLOW: the numbers are not finite. */
enum rd_status rd_crossing_first(const struct rd_course *guards, const double *scale, double end,
                                 const struct rd_stop *stop, struct rd_workspace *workspace,
                                 struct rd_crossing *crossing);

#endif
