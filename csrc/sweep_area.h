/* The area under a tensed cantilever, at the theta of several frequencies side by side. */
#ifndef RD_SWEEP_AREA_H
#define RD_SWEEP_AREA_H

#include "chain.h"
#include "lanes.h"

/* as in area.h */
struct sweep_area {
    cv lean, P[3];
};

struct sweep_area rd_sweep_area(enum rd_kind kind, cv theta);

#endif
