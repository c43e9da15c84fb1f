/* Loads of the iteration: those of the last one, and those that begin it. */
#ifndef RD_REFINE_LOAD_H
#define RD_REFINE_LOAD_H

#include "modes/refine/rate.h"

#include <stdint.h>

/* A load that no mode is free of, the same for every run: the hash of splitmix64 (Steele, Lea, Flood
   2014), since what repeats from lane to lane or block to block could not tell a cluster's modes
   apart. */
RD_INLINE lanes fixed_load(size_t block, size_t m, int i)
{
    lanes p = {0};
    for (int k = 0; k < RD_LANES; k++) {
        uint64_t x = ((uint64_t)m * W + (uint64_t)i) * RD_LANES + (uint64_t)k + 1;
        x += (uint64_t)block << 48;
        x *= 0x9E3779B97F4A7C15u;
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        x ^= x >> 31;
        p[k] = (double)(x >> 11) * 0x1p-52 - 1;
    }
    return p;
}

RD_INLINE lane_mask lanes_of(unsigned bits)
{
    lane_mask mask = {0};
    for (int k = 0; k < RD_LANES; k++)
        mask[k] = -(long long)(bits >> k & 1);
    return mask;
}

/* the loads of the next iteration, b = -A' x: p = -(dV u_a - dF^T f_b), d = dF u_a + dG f_b */
RD_INLINE void load(const struct rd_refine *r, size_t m, const struct rate *rate, unsigned begin,
                    lanes *p, lanes *d)
{
    const lanes *u = r->u + m * W, *f = r->f + m * W;
    for (int i = 0; i < W; i++) {
        p[i] = d[i] = l_fill(0);
        for (int j = 0; begin != RD_ALL_LANES && j < W; j++) {
            p[i] -= rate->dV[i][j] * u[j] - rate->dD[j][i] * f[j];
            d[i] += rate->dD[i][j] * u[j] + rate->dG[i][j] * f[j];
        }
        if (begin) {
            p[i] = l_select(lanes_of(begin), fixed_load(r->block, m, i), p[i]);
            d[i] = l_select(lanes_of(begin), l_fill(0), d[i]);
        }
    }
}

#endif
