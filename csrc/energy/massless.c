/* How the form of massless elements changes with their numbers. */
#include "energy/massless.h"

#include "chain/elements.h"
#include "element/cantilever.h"
#include "element/stiffness.h"

#include <math.h>

enum { W = RD_WIDTH_MAX, BB = RD_BENDING * (RD_CHANNELS + 1), OF_BB = RD_OF_SECTION + RD_BENDING };

static bool bends(const struct rd_element *element)
{
    return rd_element_find(element, RD_BETA) < element->width;
}

/* The two halves of an element that bends are cantilevers of theta/4; those of the other kinds know
   nothing of the tension. */
static enum rd_status set_halves(struct rd_massless *massless)
{
    const struct rd_element *element = &massless->element;
    massless->bow = 1;
    massless->sway = 3;
    massless->bow_slope = massless->sway_slope = 0;
    if (element->kind != RD_TENSED || !bends(element))
        return RD_OK;
    const double theta =
        element->tension * element->flexibility[BB] * element->length * element->length / 4;
    const struct rd_cantilever half = rd_cantilever_at(RD_TENSED, theta);
    const struct rd_cantilever slope = rd_cantilever_slope(theta);
    const double tau = creal(half.tau), P2 = creal(half.P[2]), d = creal(slope.tau);
    massless->bow = 1 / tau;
    massless->bow_slope = -d / (tau * tau);
    massless->sway = tau / P2;
    massless->sway_slope = (d - massless->sway * creal(slope.P[2])) / P2;
    return isfinite(massless->bow_slope) && isfinite(massless->sway_slope) ? RD_OK
                                                                           : RD_CRITICAL_ELEMENT;
}

enum rd_status rd_massless_of(const struct rd_chain *chain, size_t stretch,
                              struct rd_massless *massless)
{
    massless->element = rd_chain_span(chain, stretch);
    enum rd_status status = rd_element_jump(&massless->element, massless->jump);
    if (status == RD_OK)
        status = rd_rods_of(&massless->element, &massless->rods);
    return status == RD_OK ? set_halves(massless) : status;
}

void rd_massless_open(const struct rd_massless *massless, double *u, double *jump)
{
    const size_t w = massless->element.width;
    double opens[W];
    for (size_t i = 0; i < w; i++) {
        opens[i] = 0;
        for (size_t j = 0; j < 2 * w; j++)
            opens[i] += massless->jump[i * 2 * w + j] * u[j];
    }
    for (size_t i = 0; i < w; i++) {
        u[i] += opens[i];
        jump[i] += opens[i] * opens[i];
    }
}

/* Pi = e^T S^^-1 e/l with e_c = (u_b - u_a)_c - r_c delta, delta = beta_b - beta_a, and the forces
   g = S^^-1 e/l: dPi/dS_cd = -l g_c g_d where the rope does not bend. The bending moment that goes
   with them has the integral m = delta/S_bb - l r^T g along the element:

       dPi/dS_cb = -2 g_c m,   dPi/dS_bb = -m^2/l + delta^2/(S_bb^2 l)

   Returns m. */
static double add_rods(const struct rd_massless *massless, const double *u, double *slope)
{
    const struct rd_element *element = &massless->element;
    const struct rd_rods *rods = &massless->rods;
    const size_t w = element->width, n = rods->count;
    const double l = element->length;
    const bool bent = bends(element);
    const double delta = bent ? u[2 * w - 1] - u[w - 1] : 0;
    double e[2], g[2], turned = 0;
    for (size_t i = 0; i < n; i++)
        e[i] = u[w + rods->at[i]] - u[rods->at[i]] - rods->r[i] * delta;
    for (size_t i = 0; i < n; i++) {
        g[i] = 0;
        for (size_t j = 0; j < n; j++)
            g[i] += rods->inverse[i * n + j] * e[j] / l;
        turned += rods->r[i] * g[i];
        slope[RD_OF_LENGTH] -= g[i] * e[i] / l;
    }
    const double moment = bent ? delta / element->flexibility[BB] - l * turned : 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++)
            slope[rd_property_of(rods->channel[i], rods->channel[j])] -= l * g[i] * g[j];
        slope[rd_property_of(rods->channel[i], RD_BENDING)] -= 2 * g[i] * moment;
    }
    return moment;
}

/* Pi = (delta^2 a + s^2 b)/(S_bb l) with s = 2 sigma/l, a = 1/tau and b = tau/P2 of theta, see
   element/element.h; m has the part of delta^2 that no tension adds to. */
static void add_bending(const struct rd_massless *massless, const double *u, double moment,
                        double *slope)
{
    const struct rd_element *element = &massless->element;
    const size_t w = element->width, z = rd_element_find(element, RD_Z), beta = w - 1;
    const double l = element->length, Sbb = element->flexibility[BB];
    const double unit = 1 / (Sbb * l), theta = element->tension * Sbb * l * l / 4;
    const double delta = u[w + beta] - u[beta];
    const double rise = 2 * (u[w + z] - u[z]) / l;
    const double s = rise - (element->kind == RD_DIFFERENCE ? delta : u[w + beta] + u[beta]);
    const double bow = delta * delta * massless->bow, sway = s * s * massless->sway;
    const double by_theta =
        (delta * delta * massless->bow_slope + s * s * massless->sway_slope) * unit;
    slope[OF_BB] -= moment * moment / l + (bow - delta * delta + sway) * unit / Sbb;
    slope[OF_BB] += by_theta * theta / Sbb;
    slope[RD_OF_TENSION] += by_theta * Sbb * l * l / 4;
    slope[RD_OF_LENGTH] -= (bow + sway + 2 * s * rise * massless->sway) * unit / l;
    slope[RD_OF_LENGTH] += 2 * by_theta * theta / l;
}

void rd_string_slope(const struct rd_element *element, const double *u, double *slope)
{
    const size_t w = element->width, z = rd_element_find(element, RD_Z);
    if (z == w)
        return;
    const double turn = (u[w + z] - u[z]) / element->length;
    slope[RD_OF_TENSION] += turn * turn * element->length;
    slope[RD_OF_LENGTH] -= element->tension * turn * turn;
}

void rd_massless_slope(const struct rd_massless *massless, const double *u, double *slope)
{
    const double moment = add_rods(massless, u, slope);
    if (bends(&massless->element))
        add_bending(massless, u, moment, slope);
    rd_string_slope(&massless->element, u, slope);
}
