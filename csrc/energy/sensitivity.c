/* How the form of a mode changes with the numbers of each stretch. */
#include "energy/sensitivity.h"

#include "chain/elements.h"

#include <string.h>

enum { W = RD_WIDTH_MAX };

void rd_sensitivity_begin(const struct rd_chain *chain, double lambda,
                          struct rd_sensitivity *sensitivity)
{
    sensitivity->chain = chain;
    sensitivity->lambda = lambda;
    sensitivity->waves = chain->kind == RD_CONTINUOUS || chain->sag;
    if (sensitivity->waves)
        sensitivity->of.span.element = chain->distinct;
}

static void add_massless(const struct rd_massless *massless, const double *u, double *slope,
                         double *jump)
{
    double moved[2 * W];
    memcpy(moved, u, 2 * massless->element.width * sizeof *u);
    if (massless->element.hinge)
        rd_massless_open(massless, moved, jump);
    rd_massless_slope(massless, moved, slope);
}

static void add_wave(const struct rd_wave_slopes *slopes, const double *hinge, const double *u,
                     double *slope, double *jump)
{
    double moved[2 * W];
    memcpy(moved, u, 2 * slopes->chain->width * sizeof *u);
    rd_wave_slopes_open(slopes, hinge, moved, jump);
    rd_wave_slopes_add(slopes, moved, slope);
    if (slopes->chain->kind == RD_RIGID) {
        const struct rd_element element = rd_chain_element(slopes->chain, slopes->element);
        if (rd_element_find(&element, RD_BETA) < element.width)
            rd_string_slope(&element, moved, slope);
    }
}

/* a continuous element is kept from one stretch to the next: it costs a few joints in every lane */
static enum rd_status prepare(struct rd_sensitivity *sensitivity, size_t k)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t e = (size_t)chain->element[k];
    if (!sensitivity->waves)
        return rd_massless_of(chain, k, &sensitivity->of.massless);
    if (e == sensitivity->of.span.element)
        return RD_OK;
    return rd_wave_slopes_of(chain, e, sensitivity->lambda, &sensitivity->of.span);
}

enum rd_status rd_sensitivity_stretch(struct rd_sensitivity *sensitivity, size_t stretch,
                                      const double *shape, double *slope, double *jump)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t w = chain->width;
    const double *hinge = chain->hinge ? chain->hinge + (size_t)chain->term[stretch] * w : NULL;
    memset(slope, 0, RD_PROPERTIES * sizeof *slope);
    memset(jump, 0, w * sizeof *jump);
    const enum rd_status status = prepare(sensitivity, stretch);
    if (status != RD_OK)
        return status;
    for (size_t i = (size_t)chain->first[stretch]; i < (size_t)chain->first[stretch + 1]; i++)
        if (sensitivity->waves)
            add_wave(&sensitivity->of.span, hinge, shape + i * w, slope, jump);
        else
            add_massless(&sensitivity->of.massless, shape + i * w, slope, jump);
    return RD_OK;
}

void rd_sensitivity_nodes(const struct rd_chain *chain, size_t stretch, const double *shape,
                          double *dyad)
{
    const size_t w = chain->width, first = (size_t)chain->first[stretch];
    memset(dyad, 0, w * w * sizeof *dyad);
    for (size_t i = first; i < first + rd_stretch_nodes(chain, stretch); i++)
        for (size_t a = 0; a < w; a++)
            for (size_t b = 0; b < w; b++)
                dyad[a * w + b] += shape[i * w + a] * shape[i * w + b];
}
