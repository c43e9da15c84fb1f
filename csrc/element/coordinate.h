/* What an element can be: its coordinates, its channels and its kind. */
#ifndef RD_COORDINATE_H
#define RD_COORDINATE_H

#include <stddef.h>
#include <stdint.h>

/* coordinates of a node in their fixed order; a chain has any subset of them */
enum rd_coordinate { RD_X, RD_Z, RD_ALPHA, RD_BETA };

/* channels of a section: axial strain, twist rate, curvature */
enum rd_channel { RD_AXIAL, RD_TORSION, RD_BENDING };

/* the first three are massless with inertia lumped at the nodes; a continuous one carries its own */
enum rd_kind { RD_DIFFERENCE, RD_RIGID, RD_TENSED, RD_CONTINUOUS };

enum { RD_WIDTH_MAX = 4, RD_CHANNELS = 3 };

/* index of a coordinate among those of a node, or width where absent */
static inline size_t rd_coordinate_find(size_t width, const int32_t *coordinate,
                                        enum rd_coordinate sought)
{
    size_t i = 0;
    while (i < width && coordinate[i] != (int32_t)sought)
        i++;
    return i;
}

/* the channel that a coordinate's end force loads, z by its moment */
static inline int rd_channel_of(int32_t coordinate)
{
    static const int channel[RD_WIDTH_MAX] = {RD_AXIAL, RD_BENDING, RD_TORSION, RD_BENDING};
    return channel[coordinate];
}

#endif
