/* How the form of two motions changes with the numbers of each stretch. */
#include "energy/sensitivity.h"

#include "chain/elements.h"

#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

bool rd_sensitivity_prepare(const struct rd_chain *chain, const struct rd_fields *fields,
                            struct rd_sensitivity *sensitivity, struct rd_workspace *workspace)
{
    sensitivity->chain = chain;
    sensitivity->fields = fields;
    sensitivity->waves = chain->kind == RD_CONTINUOUS || chain->sag;
    sensitivity->moved =
        rd_take_aligned(workspace, fields->loads, sizeof *sensitivity->moved, sizeof(lanes));
    return sensitivity->moved != NULL;
}

void rd_sensitivity_begin(struct rd_sensitivity *sensitivity, const struct rd_lines *lines)
{
    sensitivity->lines = lines;
    if (sensitivity->waves)
        sensitivity->of.span.element = sensitivity->chain->distinct;
}

/* a continuous element is kept from one stretch to the next: it costs a few joints in every lane */
static enum rd_status prepare(struct rd_sensitivity *sensitivity, size_t k)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t e = (size_t)chain->element[k];
    if (!sensitivity->waves)
        return rd_massless_of(chain, k, sensitivity->lines, &sensitivity->of.massless);
    if (e == sensitivity->of.span.element)
        return RD_OK;
    return rd_wave_slopes_of(chain, e, sensitivity->lines, sensitivity->fields->forces,
                             &sensitivity->of.span);
}

/* the motion of the ends of element i, apart from their nodes where the load slips */
static RD_CLONES void read(const struct rd_sensitivity *sensitivity, size_t load, size_t i,
                           struct rd_moved *moved)
{
    const struct rd_fields *fields = sensitivity->fields;
    const size_t w = sensitivity->chain->width;
    const int32_t *slip = fields->slip ? fields->slip + 3 * load : NULL;
    const size_t rows = rd_field_rows(fields, w), at = i * rows;
    for (size_t k = 0; k < w; k++) {
        moved->u[k] = rd_field_at(fields, sensitivity->lines, load, at + k);
        moved->u[w + k] = rd_field_at(fields, sensitivity->lines, load, at + rows + k);
        moved->opens[k] = c_zero();
        if (fields->forces)
            moved->right[k] = rd_field_at(fields, sensitivity->lines, load, at + rows + w + k);
    }
    if (slip && slip[0] >= 0 && (size_t)slip[0] == i) {
        cv *u = moved->u + (size_t)slip[1] * w + (size_t)slip[2];
        *u = c_add(*u, c_real(slip[1] ? -1 : 1));
    }
}

static void move(const struct rd_sensitivity *sensitivity, const double *hinge, size_t i)
{
    const cv spring = sensitivity->lines->spring;
    for (size_t load = 0; load < sensitivity->fields->loads; load++) {
        struct rd_moved *moved = sensitivity->moved + load;
        read(sensitivity, load, i, moved);
        if (sensitivity->waves && sensitivity->fields->forces) {
            rd_wave_slopes_scatter(&sensitivity->of.span, hinge, spring, moved);
        } else if (sensitivity->waves) {
            rd_wave_slopes_open(&sensitivity->of.span, hinge, spring, moved);
            rd_wave_slopes_move(&sensitivity->of.span, moved);
        } else {
            rd_massless_open(&sensitivity->of.massless, spring, moved);
            rd_massless_move(&sensitivity->of.massless, moved);
        }
    }
}

static void add_wave(const struct rd_sensitivity *sensitivity, const struct rd_moved *a,
                     const struct rd_moved *b, cv *slope)
{
    const struct rd_wave_slopes *span = &sensitivity->of.span;
    rd_wave_slopes_add(span, a, b, slope);
    if (span->chain->kind != RD_RIGID)
        return;
    const struct rd_element element = rd_chain_element(span->chain, span->element);
    if (rd_element_find(&element, RD_BETA) < element.width)
        rd_string_slope(&element, sensitivity->lines->tension, a, b, slope);
}

static void add(const struct rd_sensitivity *sensitivity, const int32_t *pair, cv *slope, cv *jump)
{
    const struct rd_moved *a = sensitivity->moved + pair[0], *b = sensitivity->moved + pair[1];
    for (size_t k = 0; k < sensitivity->chain->width; k++)
        jump[k] = c_add(jump[k], c_mul(a->opens[k], b->opens[k]));
    if (sensitivity->waves)
        add_wave(sensitivity, a, b, slope);
    else
        rd_massless_slope(&sensitivity->of.massless, a, b, slope);
}

/* slopes by S and T of those by S/section and T tension */
static void scale(const struct rd_lines *lines, cv *slope)
{
    const cv soft = c_inverse(lines->section);
    for (size_t p = RD_OF_SECTION; p < RD_OF_TENSION; p++)
        slope[p] = c_mul(slope[p], soft);
    slope[RD_OF_TENSION] = c_mul(slope[RD_OF_TENSION], lines->tension);
}

enum rd_status rd_sensitivity_stretch(struct rd_sensitivity *sensitivity, size_t stretch,
                                      const struct rd_pairs *pairs, cv *slope, cv *jump)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t w = chain->width;
    const double *hinge = chain->hinge ? chain->hinge + (size_t)chain->term[stretch] * w : NULL;
    memset(slope, 0, pairs->count * RD_PROPERTIES * sizeof *slope);
    memset(jump, 0, pairs->count * w * sizeof *jump);
    const enum rd_status status = prepare(sensitivity, stretch);
    if (status != RD_OK)
        return status;
    if (sensitivity->waves && sensitivity->fields->forces)
        rd_wave_slopes_hinge(&sensitivity->of.span, hinge, sensitivity->lines->spring);
    for (size_t i = (size_t)chain->first[stretch]; i < (size_t)chain->first[stretch + 1]; i++) {
        move(sensitivity, hinge, i);
        for (size_t p = 0; p < pairs->count; p++)
            add(sensitivity, pairs->of + 2 * p, slope + p * RD_PROPERTIES, jump + p * w);
    }
    for (size_t p = 0; p < pairs->count; p++)
        scale(sensitivity->lines, slope + p * RD_PROPERTIES);
    for (size_t k = 0; k < pairs->count * w; k++)
        jump[k] = c_mul(jump[k], sensitivity->lines->spring);
    return RD_OK;
}

static RD_CLONES void add_nodes(const struct rd_sensitivity *sensitivity, size_t stretch,
                                const struct rd_pairs *pairs, cv *dyad)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t w = chain->width, first = (size_t)chain->first[stretch];
    const size_t rows = rd_field_rows(sensitivity->fields, w);
    for (size_t i = first; i < first + rd_stretch_nodes(chain, stretch); i++)
        for (size_t p = 0; p < pairs->count; p++) {
            const size_t a = (size_t)pairs->of[2 * p], b = (size_t)pairs->of[2 * p + 1];
            cv u[RD_WIDTH_MAX], v[RD_WIDTH_MAX];
            for (size_t k = 0; k < w; k++) {
                u[k] = rd_field_at(sensitivity->fields, sensitivity->lines, a, i * rows + k);
                v[k] = a == b
                           ? u[k]
                           : rd_field_at(sensitivity->fields, sensitivity->lines, b, i * rows + k);
            }
            for (size_t k = 0; k < w * w; k++) {
                cv *sum = dyad + p * w * w + k;
                *sum = c_add(*sum, c_mul(u[k / w], v[k % w]));
            }
        }
}

void rd_sensitivity_nodes(const struct rd_sensitivity *sensitivity, size_t stretch,
                          const struct rd_pairs *pairs, cv *dyad)
{
    const struct rd_chain *chain = sensitivity->chain;
    memset(dyad, 0, pairs->count * chain->width * chain->width * sizeof *dyad);
    if (chain->kind != RD_CONTINUOUS || rd_stretch_nodes(chain, stretch) == 1)
        add_nodes(sensitivity, stretch, pairs, dyad);
}
