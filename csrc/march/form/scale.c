/* Scales of the coordinates for a march. */
#include "march/form/scale.h"

#include <math.h>

/* means over elements and nodes */
struct means {
    double length, tension, bend, count;
    double soft[RD_WIDTH_MAX];  /* flexibility of an element, of each coordinate alone */
    double heavy[RD_WIDTH_MAX]; /* N_ii of a node: its geometric mean where it is not 0 */
};

static void add_elements(const struct rd_march *march, struct means *means)
{
    const struct rd_chain *chain = march->chain;
    const struct rd_march_numbers *number = march->number;
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const size_t e = (size_t)chain->element[k];
        const double n = (double)rd_stretch_nodes(chain, k), l = chain->length[e];
        const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
        const double damped = 1 + march->beside->rate[e] / number->theta;
        const double T = chain->tension[e] * damped + march->beside->string[e] + number->extra +
                         march->beside->drag[e] / number->theta;
        means->count += n;
        means->length += n * l;
        means->tension += n * fmax(T, 0);
        means->bend += n * l * S[RD_BENDING * (RD_CHANNELS + 1)] / damped;
        for (size_t i = 0; i < chain->width; i++) {
            const int c = rd_channel_of(chain->coordinate[i]);
            means->soft[i] += i == march->iz ? n * l / fmax(T, 1e-300)
                                             : n * l * S[c * (RD_CHANNELS + 1)] / damped;
        }
    }
}

static void add_nodes(const struct rd_march *march, struct means *means)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width;
    const double theta = march->number->theta;
    for (size_t i = 0; i < w; i++) {
        double sum = 0, count = 0;
        for (size_t k = 0; k < chain->stretches; k++) {
            const size_t at = (size_t)chain->term[k] * w * w + i * (w + 1);
            const double C = chain->damping ? chain->damping[at] : 0;
            const double N = chain->mass[at] / (theta * theta) + C / theta;
            const double n = (double)rd_stretch_nodes(chain, k);
            if (!(N > 0))
                continue;
            sum += n * log(N);
            count += n;
        }
        means->heavy[i] = count > 0 ? exp(sum / count) : 0;
    }
}

/* Receptance of a long rope on what its inertia is at 1/theta, of the whole at rest at most:
   1/sqrt(N/G) of a rod or a string; of a bent one with h = T/2B, r^2 = h^2 + N/(B l),
   a^2 = r + h, k^2 = N/(B l (r + h)): 1/(B k (k^2 + a^2)) of z, 1/(B a) of beta. */
void rd_march_scale(const struct rd_march *march, double *z)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, ib = rd_coordinate_find(w, chain->coordinate, RD_BETA);
    struct means mean = {0};
    add_elements(march, &mean);
    add_nodes(march, &mean);
    for (size_t i = 0; i < w; i++) {
        const double G = mean.soft[i] / mean.count;
        const double N = fmax(mean.heavy[i], 1 / (G * mean.count * mean.count));
        z[i] = sqrt(G / N);
    }
    if (ib < w && march->iz < w) {
        const double L = mean.length, B = L / mean.bend, T = mean.tension / mean.count;
        const double least = B / (L * L * L * L) + T / (L * L);
        const double foot = fmax(mean.heavy[march->iz] * mean.count / L, least);
        const double h = T / (2 * B), r = hypot(h, sqrt(foot / B));
        const double a = sqrt(r + h), k = sqrt(foot / B) / a;
        z[march->iz] = 1 / (B * k * 2 * r);
        z[ib] = 1 / (B * a);
    }
    for (size_t i = 0; i < w; i++) {
        const double exact = sqrt(z[i]);
        z[i] = isfinite(exact) && exact > 0 ? ldexp(1, ilogb(exact)) : 1;
    }
}
