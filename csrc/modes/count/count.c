/* How many eigenvalues of K - lambda M lie below zero. */
#include "modes/count/count.h"

#include "base/real_lanes.h"

#include <math.h>

/* Beyond all eigenvalues counts stay as they are; the numbers would not: [rad^2/s^2] from where on
   to look, and how far beyond the bound of diagonal inertia. */
static const double LARGE = 1e18, MARGIN = 1e6;

void rd_count(const struct rd_walk *walk, size_t count, const double *lambda, double *counts)
{
    void (*const of_width[RD_WIDTH_MAX])(const struct rd_walk *, const double *, double *) = {
        rd_count_1, rd_count_2, rd_count_3, rd_count_4};
    double most = INFINITY;
    for (size_t i = 0; i < count && most == INFINITY; i++)
        if (fabs(lambda[i]) > LARGE)
            most = fmax(LARGE, MARGIN * rd_walk_ceiling(walk));
    for (size_t i = 0; i < count; i += RD_LANES) {
        double in[RD_LANES], out[RD_LANES];
        for (size_t k = 0; k < RD_LANES; k++)
            in[k] = fmax(-most, fmin(lambda[i + k < count ? i + k : count - 1], most));
        of_width[walk->chain->width - 1](walk, in, out);
        for (size_t k = 0; k < RD_LANES && i + k < count; k++)
            counts[i + k] = out[k];
    }
}
