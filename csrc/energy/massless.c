/* How the form of massless elements changes with their numbers. */
#include "energy/massless.h"

#include "chain/elements.h"
#include "element/cantilever.h"
#include "element/stiffness.h"

#include <math.h>
#include <stdbool.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, BB = RD_BENDING * (RD_CHANNELS + 1), OF_BB = RD_OF_SECTION + RD_BENDING };

static bool bends(const struct rd_element *element)
{
    return rd_element_find(element, RD_BETA) < element->width;
}

static void set_lane(cv *x, int lane, double _Complex value)
{
    x->re[lane] = creal(value);
    x->im[lane] = cimag(value);
}

static double _Complex lane_of(cv x, int lane)
{
    return CMPLX(x.re[lane], x.im[lane]);
}

static bool fill_half(struct rd_massless *massless, int lane)
{
    const double _Complex theta = lane_of(massless->theta, lane);
    const struct rd_cantilever half = rd_cantilever_at(RD_TENSED, theta);
    const struct rd_cantilever slope = rd_cantilever_slope(theta);
    const double _Complex sway = half.tau / half.P[2];
    const double _Complex bow_slope = -slope.tau / (half.tau * half.tau);
    const double _Complex sway_slope = (slope.tau - sway * slope.P[2]) / half.P[2];
    set_lane(&massless->bow, lane, 1 / half.tau);
    set_lane(&massless->bow_slope, lane, bow_slope);
    set_lane(&massless->sway, lane, sway);
    set_lane(&massless->sway_slope, lane, sway_slope);
    return isfinite(cabs(bow_slope)) && isfinite(cabs(sway_slope));
}

/* The two halves of an element that bends are cantilevers of theta/4; those of the other kinds know
   nothing of the tension. */
static enum rd_status set_halves(struct rd_massless *massless)
{
    const struct rd_element *element = &massless->element;
    massless->bow = c_real(1);
    massless->sway = c_real(3);
    massless->theta = massless->bow_slope = massless->sway_slope = c_zero();
    if (element->kind != RD_TENSED || !bends(element))
        return RD_OK;
    const double l = element->length;
    massless->theta = c_scale(c_mul(massless->tension, c_inverse(massless->section)),
                              element->tension * element->flexibility[BB] * l * l / 4);
    for (int lane = 0; lane < RD_LANES; lane++)
        if (!fill_half(massless, lane))
            return RD_CRITICAL_ELEMENT;
    return RD_OK;
}

/* the left rows of the stiffness without the hinge */
static enum rd_status set_stiffness(struct rd_massless *massless)
{
    struct rd_element closed = massless->element;
    const size_t w = closed.width;
    closed.hinge = NULL;
    for (int lane = 0; lane < RD_LANES; lane++) {
        double _Complex K[4 * W * W];
        const enum rd_status status = rd_element_matrix(&closed, lane_of(massless->section, lane),
                                                        lane_of(massless->tension, lane), 1, K);
        if (status != RD_OK)
            return status;
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++) {
                set_lane(massless->near + i * w + j, lane, K[i * 2 * w + j]);
                set_lane(massless->far + i * w + j, lane, K[i * 2 * w + w + j]);
            }
    }
    return RD_OK;
}

enum rd_status rd_massless_of(const struct rd_chain *chain, size_t stretch,
                              const struct rd_lines *lines, struct rd_massless *massless)
{
    massless->element = rd_chain_span(chain, stretch);
    massless->section = lines->section;
    massless->tension = lines->tension;
    if (bends(&massless->element) && !(massless->element.flexibility[BB] > 0))
        return RD_NOT_POSITIVE_DEFINITE;
    enum rd_status status = rd_rods_of(&massless->element, &massless->rods);
    if (status == RD_OK)
        status = set_halves(massless);
    return status == RD_OK && massless->element.hinge ? set_stiffness(massless) : status;
}

/* Without a jump the moment on the left end would be m = -(K u)_e; each radian takes K_ee of it away,
   so that the hinge opens by C m/(1 + C K_ee), m/K_ee where it is free. */
void rd_massless_open(const struct rd_massless *massless, const cv spring, struct rd_moved *moved)
{
    const size_t w = massless->element.width;
    const double *hinge = massless->element.hinge;
    for (size_t e = 0; hinge && e < w; e++) {
        if (hinge[e] == 0)
            continue;
        cv m = c_zero();
        for (size_t j = 0; j < w; j++) {
            m = c_sub(m, c_mul(massless->near[e * w + j], moved->u[j]));
            m = c_sub(m, c_mul(massless->far[e * w + j], moved->u[w + j]));
        }
        const cv k = massless->near[e * (w + 1)];
        const cv stiff = isinf(hinge[e]) ? k : c_add(c_scale(spring, 1 / hinge[e]), k);
        moved->opens[e] = c_mul(m, c_inverse(stiff));
        moved->u[e] = c_add(moved->u[e], moved->opens[e]);
    }
}

/* e_c = (u_b - u_a)_c - r_c delta, delta = beta_b - beta_a, the forces g = S^^-1 e/l, and the
   integral m = delta/S_bb - l r^T g of the bending moment that goes with them */
static RD_CLONES void move(const struct rd_massless *massless, struct rd_moved *moved)
{
    const struct rd_element *element = &massless->element;
    const struct rd_rods *rods = &massless->rods;
    const size_t w = element->width, n = rods->count, z = rd_element_find(element, RD_Z);
    const double l = element->length;
    const cv *u = moved->u;
    const bool bent = bends(element);
    cv turned = c_zero();
    moved->delta = bent ? c_sub(u[2 * w - 1], u[w - 1]) : c_zero();
    for (size_t i = 0; i < n; i++)
        moved->e[i] =
            c_sub(c_sub(u[w + rods->at[i]], u[rods->at[i]]), c_scale(moved->delta, rods->r[i]));
    for (size_t i = 0; i < n; i++) {
        moved->g[i] = c_zero();
        for (size_t j = 0; j < n; j++)
            moved->g[i] = c_add(moved->g[i], c_scale(moved->e[j], rods->inverse[i * n + j] / l));
        moved->g[i] = c_mul(moved->g[i], massless->section);
        turned = c_add(turned, c_scale(moved->g[i], rods->r[i]));
    }
    moved->rise = z < w ? c_scale(c_sub(u[w + z], u[z]), 2 / l) : c_zero();
    if (!bent)
        return;
    const cv stiff = c_scale(massless->section, 1 / element->flexibility[BB]);
    moved->moment = c_sub(c_mul(moved->delta, stiff), c_scale(turned, l));
    const cv with = element->kind == RD_DIFFERENCE ? moved->delta : c_add(u[2 * w - 1], u[w - 1]);
    moved->sway = c_sub(moved->rise, with);
}

void rd_massless_move(const struct rd_massless *massless, struct rd_moved *moved)
{
    move(massless, moved);
}

/* a x b + b x a over 2, for products of different parts */
RD_INLINE cv mixed(cv a_first, cv b_second, cv b_first, cv a_second)
{
    return c_scale(c_add(c_mul(a_first, b_second), c_mul(b_first, a_second)), 0.5);
}

/* Pi = e^T g: dPi/dS_cd = -l g_c g_d where the rope does not bend, dPi/dS_cb = -2 g_c m */
RD_INLINE void add_rods(const struct rd_massless *massless, const struct rd_moved *a,
                        const struct rd_moved *b, cv *slope)
{
    const struct rd_rods *rods = &massless->rods;
    const size_t n = rods->count;
    const double l = massless->element.length;
    for (size_t i = 0; i < n; i++) {
        slope[RD_OF_LENGTH] = c_sub(slope[RD_OF_LENGTH], c_scale(c_mul(a->g[i], b->e[i]), 1 / l));
        for (size_t j = 0; j < n; j++) {
            cv *of = slope + rd_property_of(rods->channel[i], rods->channel[j]);
            *of = c_sub(*of, c_scale(c_mul(a->g[i], b->g[j]), l));
        }
        if (!bends(&massless->element))
            continue;
        cv *of = slope + rd_property_of(rods->channel[i], RD_BENDING);
        *of = c_sub(*of, c_scale(mixed(a->g[i], b->moment, b->g[i], a->moment), 2));
    }
}

/* Pi = (delta^2 a + s^2 b)/(S_bb l) with s = 2 sigma/l, a = 1/tau and b = tau/P2 of theta, see
   element/element.h; m has the part of delta^2 that no tension adds to:

       dPi/dS_bb = -m^2/l + delta^2/(S_bb^2 l) - .. */
RD_INLINE void add_bending(const struct rd_massless *massless, const struct rd_moved *a,
                           const struct rd_moved *b, cv *slope)
{
    const struct rd_element *element = &massless->element;
    const double l = element->length, Sbb = element->flexibility[BB];
    const cv stiff = c_scale(massless->section, 1 / Sbb), unit = c_scale(stiff, 1 / l);
    const cv turn = c_mul(a->delta, b->delta), shear = c_mul(a->sway, b->sway);
    const cv bow = c_mul(turn, massless->bow), sway = c_mul(shear, massless->sway);
    const cv by_theta =
        c_mul(c_add(c_mul(turn, massless->bow_slope), c_mul(shear, massless->sway_slope)), unit);
    const cv moment = c_scale(c_mul(a->moment, b->moment), 1 / l);
    const cv stored = c_add(c_sub(bow, turn), sway);
    const cv tensed = c_mul(c_mul(by_theta, massless->theta), stiff);
    const cv less = c_add(moment, c_mul(c_mul(stored, unit), stiff));
    slope[OF_BB] = c_add(slope[OF_BB], c_sub(tensed, less));
    slope[RD_OF_TENSION] =
        c_add(slope[RD_OF_TENSION], c_mul(by_theta, c_scale(c_inverse(stiff), l * l / 4)));
    const cv risen = c_mul(mixed(a->sway, b->rise, b->sway, a->rise), massless->sway);
    const cv shorter = c_mul(c_add(c_add(bow, sway), c_scale(risen, 2)), unit);
    const cv longer = c_scale(c_mul(by_theta, massless->theta), 2);
    slope[RD_OF_LENGTH] = c_add(slope[RD_OF_LENGTH], c_scale(c_sub(longer, shorter), 1 / l));
}

RD_INLINE void add_string(const struct rd_element *element, cv tension, const struct rd_moved *a,
                          const struct rd_moved *b, cv *slope)
{
    if (rd_element_find(element, RD_Z) == element->width)
        return;
    const cv turn = c_scale(c_mul(a->rise, b->rise), 0.25);
    slope[RD_OF_TENSION] = c_add(slope[RD_OF_TENSION], c_scale(turn, element->length));
    slope[RD_OF_LENGTH] =
        c_sub(slope[RD_OF_LENGTH], c_mul(c_scale(tension, element->tension), turn));
}

void rd_string_slope(const struct rd_element *element, cv tension, const struct rd_moved *a,
                     const struct rd_moved *b, cv *slope)
{
    add_string(element, tension, a, b, slope);
}

static RD_CLONES void add_all(const struct rd_massless *massless, const struct rd_moved *a,
                              const struct rd_moved *b, cv *slope)
{
    add_rods(massless, a, b, slope);
    if (bends(&massless->element))
        add_bending(massless, a, b, slope);
    add_string(&massless->element, massless->tension, a, b, slope);
}

void rd_massless_slope(const struct rd_massless *massless, const struct rd_moved *a,
                       const struct rd_moved *b, cv *slope)
{
    add_all(massless, a, b, slope);
}
