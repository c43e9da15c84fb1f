/* Energy of shapes by what stores it, and what drags on them. */
#include "energy/energy.h"

#include "graded/blocks.h"

#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX };

/* What S stores is released where it grows, Pi being of the first degree in 1/S and T together:
   -S dPi/dS, T dPi/dT. */
static void add_elements(const struct rd_chain *chain, size_t k, const cv *slope,
                         struct rd_energy *energy)
{
    static const enum rd_strain of[RD_CHANNELS] = {RD_STRAIN_STRETCH, RD_STRAIN_TWIST,
                                                   RD_STRAIN_BENDING};
    const size_t e = (size_t)chain->element[k], w = chain->width;
    const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
    for (int c = 0; c < RD_CHANNELS; c++)
        for (int d = 0; d <= c; d++)
            energy->strain[c == d ? of[c] : RD_STRAIN_LAY] -=
                S[c * RD_CHANNELS + d] * slope[rd_property_of(c, d)].re;
    energy->strain[RD_STRAIN_TENSION] += chain->tension[e] * slope[RD_OF_TENSION].re;
    if (rd_is_graded(chain, e))
        energy->strain[RD_STRAIN_TENSION] +=
            chain->rise[e] / chain->length[e] * slope[RD_OF_SAG].re;
    for (size_t i = 0; chain->inertia && i < w; i++)
        energy->kinetic[i] += chain->inertia[e * w + i] * slope[RD_OF_INERTIA + i].re;
    for (size_t i = 0; chain->drag && i < w; i++)
        energy->dragged += chain->drag[e * w + i] * slope[RD_OF_INERTIA + i].re;
}

/* a free hinge has no spring */
static void add_hinges(const struct rd_chain *chain, size_t k, const cv *jump,
                       struct rd_energy *energy)
{
    const size_t w = chain->width;
    for (size_t i = 0; chain->hinge && i < w; i++) {
        const double compliance = chain->hinge[(size_t)chain->term[k] * w + i];
        if (compliance > 0)
            energy->strain[RD_STRAIN_SPRING] += jump[i].re / compliance;
    }
}

static void add_nodes(const struct rd_chain *chain, size_t k, const cv *dyad,
                      struct rd_energy *energy)
{
    const size_t w = chain->width, at = (size_t)chain->term[k] * w * w;
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++) {
            const lanes product = dyad[a * w + b].re;
            energy->strain[RD_STRAIN_SPRING] += chain->stiffness[at + a * w + b] * product;
            energy->kinetic[a < b ? a : b] += chain->mass[at + a * w + b] * product;
            if (chain->damping)
                energy->dragged += chain->damping[at + a * w + b] * product;
        }
}

enum rd_status rd_energy_fill(struct rd_sensitivity *sensitivity, struct rd_energy *energy)
{
    static const int32_t own[2] = {0, 0};
    const struct rd_pairs pair = {.count = 1, .of = own};
    const struct rd_chain *chain = sensitivity->chain;
    cv slope[RD_PROPERTIES], jump[W], dyad[W * W];
    memset(energy, 0, sizeof *energy);
    for (size_t k = 0; k < chain->stretches; k++) {
        rd_sensitivity_nodes(sensitivity, k, &pair, dyad);
        add_nodes(chain, k, dyad, energy);
        if (k + 1 == chain->stretches)
            break;
        const enum rd_status status =
            rd_sensitivity_stretch(sensitivity, k, &pair, slope, jump, NULL);
        if (status != RD_OK)
            return status;
        add_elements(chain, k, slope, energy);
        add_hinges(chain, k, jump, energy);
    }
    return RD_OK;
}
