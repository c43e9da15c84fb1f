/* How motion and force change along a continuous span, at several lambda side by side. */
#include "span/rate_matrix.h"

#include <stdbool.h>

#pragma GCC diagnostic ignored "-Wpsabi"

void rd_rate_fill(const struct rd_chain *chain, size_t e, cv section, cv tension, cv inertia,
                  cv dashpot, struct rate_matrix *rate)
{
    const size_t w = chain->width;
    const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
    const bool bends = chain->coordinate[w - 1] == RD_BETA;
    const cv soft = c_inverse(section);
    *rate = (struct rate_matrix){.z = -1, .lever = l_fill(1), .hangs = chain->sag != NULL};
    rate->sag = c_real(rate->hangs ? chain->sag[e] : 0);
    for (size_t i = 0; i < w; i++) {
        const size_t c = (size_t)rd_channel_of(chain->coordinate[i]);
        const bool is_z = chain->coordinate[i] == RD_Z;
        rate->q[i] = chain->inertia ? c_scale(inertia, chain->inertia[e * w + i]) : c_zero();
        if (chain->drag)
            rate->q[i] = c_add(rate->q[i], c_scale(dashpot, chain->drag[e * w + i]));
        rate->z = is_z && bends ? (int)i : rate->z;
        for (size_t j = 0; j < w; j++) {
            const size_t d = (size_t)rd_channel_of(chain->coordinate[j]);
            if (is_z || chain->coordinate[j] == RD_Z)
                continue;
            rate->S[i][j] = c_scale(soft, S[c * RD_CHANNELS + d]);
            rate->elastic[i][j] = S[c * RD_CHANNELS + d] != 0;
        }
        if (is_z && !bends) {
            rate->S[i][i] = c_scale(c_inverse(tension), 1 / chain->tension[e]);
            rate->elastic[i][i] = 1;
        }
    }
    if (bends)
        rate->q[w - 1] = c_add(rate->q[w - 1], c_scale(tension, chain->tension[e]));
}
