/* Shape functions of a tensed cantilever at one complex theta = T S_bb l^2. */
#ifndef RD_CANTILEVER_H
#define RD_CANTILEVER_H

#include "base/complex.h"
#include "element/coordinate.h"

/* tau and P0, P1, P2 as in element/triple.h */
struct rd_cantilever {
    double _Complex tau, P[3];
};

struct rd_cantilever rd_cantilever_at(enum rd_kind kind, double _Complex theta);

/* d/dtheta of a tensed one's */
struct rd_cantilever rd_cantilever_slope(double _Complex theta);

#endif
