/* The channels of an element that are constant along it: axial force and torque. */
#include "element/rods.h"

#include "base/dense.h"

enum rd_status rd_rods_of(const struct rd_element *element, struct rd_rods *rods)
{
    const size_t w = element->width;
    const double *S = element->flexibility;
    const double Sbb = S[RD_BENDING * (RD_CHANNELS + 1)];
    const bool bends = rd_element_find(element, RD_BETA) < w;
    rods->count = 0;
    for (size_t i = 0; i < w; i++) {
        const int c = rd_channel_of(element->coordinate[i]);
        if (c == RD_BENDING)
            continue;
        rods->channel[rods->count] = c;
        rods->at[rods->count++] = i;
    }
    for (size_t i = 0; i < rods->count; i++) {
        const double *row = S + rods->channel[i] * RD_CHANNELS;
        rods->r[i] = bends ? row[RD_BENDING] / Sbb : 0;
        for (size_t j = 0; j < rods->count; j++) {
            const int d = rods->channel[j];
            rods->inverse[i * rods->count + j] =
                row[d] - rods->r[i] * S[d * RD_CHANNELS + RD_BENDING];
        }
    }
    return rd_dense_invert(rods->count, rods->inverse) ? RD_OK : RD_NOT_POSITIVE_DEFINITE;
}
