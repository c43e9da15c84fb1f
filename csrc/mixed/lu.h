/* LU of a complex band whose rows change places, column by column. */
#ifndef RD_MIXED_LU_H
#define RD_MIXED_LU_H

#include "base/complex.h"
#include "base/status.h"
#include "base/stop.h"

#include <stdint.h>

/* The numbers of a band as LAPACK's zgbtrf has them, which does not stop. */
struct rd_lu {
    size_t size;             /* rows and columns */
    size_t reach;            /* the largest distance of two that meet */
    double _Complex *factor; /* (size, 3 reach + 1) entry i, j at [j][2 reach + i - j] */
    int32_t *pivot;          /* (size) how far below a column its pivot was */
    struct rd_stop stop;     /* asked now and then */
};

/* Whether what walks along the band ends at column or node j: `stop` is asked at some of them. */
bool rd_lu_stops(const struct rd_lu *lu, size_t j);

/* Factorises the band in `factor`, whose upper `reach` rows are 0.
   RD_SINGULAR where a pivot is 0 or no number, RD_INTERRUPTED */
enum rd_status rd_lu_factorise(struct rd_lu *lu);

/* x (columns, size) <- the solution for it; without meaning where `stop` was asked and said yes */
void rd_lu_solve(const struct rd_lu *lu, size_t columns, double _Complex *x);

#endif
