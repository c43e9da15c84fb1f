/* Energy of shapes by what stores it, and what drags on them. */
#include "energy/energy.h"

#include "energy/sensitivity.h"

#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX };

/* What S stores is released where it grows, Pi being of the first degree in 1/S and T together:
   -S dPi/dS, T dPi/dT. */
static void add_elements(const struct rd_chain *chain, size_t k, const double *slope,
                         double *strain, double *kinetic, double *dragged)
{
    static const enum rd_strain of[RD_CHANNELS] = {RD_STRAIN_STRETCH, RD_STRAIN_TWIST,
                                                   RD_STRAIN_BENDING};
    const size_t e = (size_t)chain->element[k], w = chain->width;
    const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
    for (int c = 0; c < RD_CHANNELS; c++)
        for (int d = 0; d <= c; d++)
            strain[c == d ? of[c] : RD_STRAIN_LAY] -=
                S[c * RD_CHANNELS + d] * slope[rd_property_of(c, d)];
    strain[RD_STRAIN_TENSION] += chain->tension[e] * slope[RD_OF_TENSION];
    for (size_t i = 0; chain->inertia && i < w; i++)
        kinetic[i] += chain->inertia[e * w + i] * slope[RD_OF_INERTIA + i];
    for (size_t i = 0; chain->drag && i < w; i++)
        *dragged += chain->drag[e * w + i] * slope[RD_OF_INERTIA + i];
}

/* a free hinge has no spring */
static void add_hinges(const struct rd_chain *chain, size_t k, const double *jump, double *strain)
{
    const size_t w = chain->width;
    for (size_t i = 0; chain->hinge && i < w; i++) {
        const double compliance = chain->hinge[(size_t)chain->term[k] * w + i];
        if (compliance > 0)
            strain[RD_STRAIN_SPRING] += jump[i] / compliance;
    }
}

static void add_nodes(const struct rd_chain *chain, size_t k, const double *dyad, double *strain,
                      double *kinetic, double *dragged)
{
    const size_t w = chain->width, at = (size_t)chain->term[k] * w * w;
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++) {
            strain[RD_STRAIN_SPRING] += chain->stiffness[at + a * w + b] * dyad[a * w + b];
            kinetic[a < b ? a : b] += chain->mass[at + a * w + b] * dyad[a * w + b];
            if (chain->damping)
                *dragged += chain->damping[at + a * w + b] * dyad[a * w + b];
        }
}

enum rd_status rd_energy(const struct rd_chain *chain, double lambda, const double *shape,
                         double *strain, double *kinetic, double *dragged)
{
    struct rd_sensitivity sensitivity;
    double slope[RD_PROPERTIES], jump[W], dyad[W * W];
    memset(strain, 0, RD_STRAINS * sizeof *strain);
    memset(kinetic, 0, chain->width * sizeof *kinetic);
    *dragged = 0;
    rd_sensitivity_begin(chain, lambda, &sensitivity);
    for (size_t k = 0; k < chain->stretches; k++) {
        rd_sensitivity_nodes(chain, k, shape, dyad);
        add_nodes(chain, k, dyad, strain, kinetic, dragged);
        if (k + 1 == chain->stretches)
            break;
        const enum rd_status status = rd_sensitivity_stretch(&sensitivity, k, shape, slope, jump);
        if (status != RD_OK)
            return status;
        add_elements(chain, k, slope, strain, kinetic, dragged);
        add_hinges(chain, k, jump, strain);
    }
    return RD_OK;
}
