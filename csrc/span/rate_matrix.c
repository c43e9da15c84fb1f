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
    *rate = (struct rate_matrix){.z = -1, .across = -1, .lever = l_fill(1)};
    rate->hangs = chain->sag != NULL;
    rate->sag = c_real(rate->hangs ? chain->sag[e] : 0);
    for (size_t i = 0; i < w; i++) {
        const size_t c = (size_t)rd_channel_of(chain->coordinate[i]);
        const bool is_z = chain->coordinate[i] == RD_Z;
        rate->q[i] = chain->inertia ? c_scale(inertia, chain->inertia[e * w + i]) : c_zero();
        if (chain->drag)
            rate->q[i] = c_add(rate->q[i], c_scale(dashpot, chain->drag[e * w + i]));
        rate->z = is_z && bends ? (int)i : rate->z;
        rate->across = is_z ? (int)i : rate->across;
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

cv rd_rate_form(const struct rate_matrix *rate, size_t w, const cv *a, const cv *b)
{
    cv sum = c_zero();
    if (rate->z >= 0) {
        const size_t z = w + (size_t)rate->z;
        const cv both = c_add(c_mul(a[z], b[w - 1]), c_mul(b[z], a[w - 1]));
        sum = c_add(sum, c_scale_lanes(both, rate->lever));
    }
    if (rate->hangs) {
        const cv both = c_add(c_mul(a[w], b[1]), c_mul(b[w], a[1]));
        sum = c_add(sum, c_mul(both, rate->sag));
    }
    for (size_t i = 0; i < w; i++) {
        sum = c_sub(sum, c_mul(rate->q[i], c_mul(a[i], b[i])));
        for (size_t j = 0; j < w; j++)
            if (rate->elastic[i][j])
                sum = c_add(sum, c_mul(rate->S[i][j], c_mul(a[w + i], b[w + j])));
    }
    return sum;
}

lanes rd_rate_size(const struct rate_matrix *rate, size_t w, const lanes *a, const lanes *b)
{
    lanes sum = {0};
    if (rate->z >= 0) {
        const size_t z = w + (size_t)rate->z;
        sum += l_abs(rate->lever) * (a[z] * b[w - 1] + b[z] * a[w - 1]);
    }
    if (rate->hangs)
        sum += c_size(rate->sag) * (a[w] * b[1] + b[w] * a[1]);
    for (size_t i = 0; i < w; i++) {
        sum += c_size(rate->q[i]) * a[i] * b[i];
        for (size_t j = 0; j < w; j++)
            if (rate->elastic[i][j])
                sum += c_size(rate->S[i][j]) * a[w + i] * b[w + j];
    }
    return sum;
}
