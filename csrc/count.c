/* How many eigenvalues of K - lambda M lie below zero. */
#include "count.h"

#include "real_lanes.h"

void rd_count(const struct rd_walk *walk, size_t count, const double *lambda, double *counts)
{
    void (*const of_width[RD_WIDTH_MAX])(const struct rd_walk *, const double *, double *) = {
        rd_count_1, rd_count_2, rd_count_3, rd_count_4};
    for (size_t i = 0; i < count; i += RD_LANES) {
        double in[RD_LANES], out[RD_LANES];
        for (size_t k = 0; k < RD_LANES; k++)
            in[k] = lambda[i + k < count ? i + k : count - 1];
        of_width[walk->chain->width - 1](walk, in, out);
        for (size_t k = 0; k < RD_LANES && i + k < count; k++)
            counts[i + k] = out[k];
    }
}
