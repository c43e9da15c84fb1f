/* The numbers of an element that its form depends on. */
#ifndef RD_PROPERTY_H
#define RD_PROPERTY_H

#include "chain/chain.h"

/* RD_OF_INERTIA + i stands for coordinate i of the element: dPi/d(inertia p) = -dPi/d(lambda p) with
   p its inertia per length, the integral of its square, which only continuous elements have. Of an
   entry of S that couples two channels both places change. */
enum rd_property {
    RD_OF_SECTION, /* S: aa, tt, bb, then at, ab, tb [1/N, 1/(N m^2), 1/(N m)] */
    RD_OF_TENSION = 6,
    RD_OF_LENGTH, /* of each element of the stretch */
    RD_OF_SAG,    /* [1/m]; of an element whose tension grows by the slope of that [N/m] */
    RD_OF_INERTIA,
    RD_PROPERTIES = RD_OF_INERTIA + RD_WIDTH_MAX
};

/* the entry of S of two channels */
static inline size_t rd_property_of(int c, int d)
{
    return (size_t)(RD_OF_SECTION + (c == d ? c : c + d + 2));
}

#endif
