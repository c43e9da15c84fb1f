/* Elements: massless pieces of rope between two nodes. */
#ifndef RD_ELEMENT_H
#define RD_ELEMENT_H

#include "element/coordinate.h"

/* One element of a chain: its kind, its coordinates and the numbers of its piece of rope. */
struct rd_element {
    enum rd_kind kind;
    size_t width;
    const int32_t *coordinate; /* (width) */
    double length;             /* [m] */
    double tension;            /* [N] */
    double sag;                /* w/T [1/m] of rope that hangs, else 0; x and z come first */
    const double *flexibility; /* (3, 3) S */
    const double *hinge; /* (width) compliance between the left node and the element, or NULL */
};

/* index of a coordinate in the element, or its width where absent */
static inline size_t rd_element_find(const struct rd_element *element, enum rd_coordinate sought)
{
    return rd_coordinate_find(element->width, element->coordinate, sought);
}

#endif
