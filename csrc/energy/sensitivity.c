/* How the form of two motions changes with the numbers of each stretch. */
#include "energy/sensitivity.h"

#include "chain/attached.h"
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
    sensitivity->kink =
        rd_take_aligned(workspace, fields->loads, sizeof *sensitivity->kink, sizeof(lanes));
    return sensitivity->moved != NULL && sensitivity->kink != NULL;
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
    if (slip && slip[0] >= 0 && (size_t)slip[0] == i && slip[1] != RD_PUSHED) {
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

/* what the node where stretch k begins resists its motion u by, structures and all, and its size */
static void resist(const struct rd_sensitivity *sensitivity, size_t k, size_t load, const cv *u,
                   cv *force, lanes *size)
{
    const struct rd_chain *chain = sensitivity->chain;
    const struct rd_lines *lines = sensitivity->lines;
    const size_t w = chain->width, term = (size_t)chain->term[k] * w * w;
    for (size_t i = 0; i < w; i++) {
        force[i] = c_zero();
        size[i] = (lanes){0};
        for (size_t j = 0; j < w; j++) {
            const size_t at = term + i * w + j;
            cv N = c_scale(lines->spring, chain->stiffness[at]);
            N = c_add(N, c_scale(lines->inertia, chain->mass[at]));
            if (chain->damping)
                N = c_add(N, c_scale(lines->dashpot, chain->damping[at]));
            force[i] = c_add(force[i], c_mul(N, u[j]));
            size[i] += (c_size(c_scale(lines->spring, chain->stiffness[at])) +
                        c_size(c_scale(lines->inertia, chain->mass[at]))) *
                       c_size(u[j]);
        }
    }
    for (size_t s = rd_attached_first(chain, (size_t)chain->term[k]);
         rd_attached_is_of(chain, s, chain->term[k]); s++)
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            const size_t own = lane < lines->count ? lane : lines->count - 1;
            const double *motion = sensitivity->fields->motion;
            const double _Complex y =
                motion ? motion[(lines->first + own) * chain->attached + s] : 0;
            double _Complex moved[RD_WIDTH_MAX], pull[RD_WIDTH_MAX] = {0};
            for (size_t i = 0; i < w; i++)
                moved[i] = CMPLX(u[i].re[lane], u[i].im[lane]);
            rd_attached_pull(chain, s, CMPLX(lines->inertia.re[lane], lines->inertia.im[lane]),
                             CMPLX(lines->dashpot.re[lane], lines->dashpot.im[lane]), moved,
                             motion ? &y : NULL, pull);
            for (size_t i = 0; i < w; i++) {
                force[i].re[lane] += creal(pull[i]);
                force[i].im[lane] += cimag(pull[i]);
                size[i][lane] += cabs(pull[i]);
            }
        }
    const int32_t *slip = sensitivity->fields->slip;
    slip = slip ? slip + 3 * load : NULL;
    if (slip && slip[1] == RD_PUSHED && slip[0] == chain->first[k])
        force[slip[2]] = c_sub(force[slip[2]], c_real(1));
}

/* y on the right end of the element that was asked last */
static void leave(const struct rd_sensitivity *sensitivity, const struct rd_moved *moved,
                  struct rd_kink *kink)
{
    const size_t w = sensitivity->chain->width;
    for (size_t i = 0; i < w; i++) {
        kink->mean[i] = moved->u[w + i];
        kink->of_mean[i] = c_size(moved->u[w + i]);
        kink->mean[w + i] = moved->right[i];
        kink->of_mean[w + i] = moved->from_right[i];
        kink->jump[i] = kink->jump[w + i] = c_zero();
        kink->of_jump[i] = kink->of_jump[w + i] = (lanes){0};
    }
}

/* What is held is pushed by what the elements beside it say; what can move by its own resistance,
   which keeps its digits where it is small beside them. */
static void enter(const struct rd_sensitivity *sensitivity, size_t k, size_t load)
{
    const struct rd_chain *chain = sensitivity->chain;
    const struct rd_fields *fields = sensitivity->fields;
    const struct rd_moved *moved = sensitivity->moved + load;
    const size_t w = chain->width, node = (size_t)chain->first[k];
    struct rd_kink *kink = sensitivity->kink + load;
    const int32_t *slip = fields->slip ? fields->slip + 3 * load : NULL;
    cv own[RD_WIDTH_MAX], force[RD_WIDTH_MAX];
    lanes size[RD_WIDTH_MAX];
    for (size_t i = 0; i < w; i++)
        own[i] = rd_field_at(fields, sensitivity->lines, load, node * rd_field_rows(fields, w) + i);
    resist(sensitivity, k, load, own, force, size);
    for (size_t i = 0; i < w; i++) {
        const bool held = chain->held[(size_t)chain->term[k] * w + i];
        const lanes both = kink->of_mean[w + i] + moved->from_left[i];
        kink->jump[i] = moved->opens[i];
        kink->of_jump[i] = c_size(moved->opens[i]);
        kink->jump[w + i] = held ? c_sub(moved->left[i], kink->mean[w + i]) : force[i];
        kink->of_jump[w + i] = held ? both : size[i];
        kink->mean[w + i] = c_scale(c_add(kink->mean[w + i], moved->left[i]), 0.5);
        kink->of_mean[w + i] = both * 0.5;
    }
    /* it parts an element from the node by 1, in the same direction on either side */
    if (slip && slip[0] >= 0 && slip[1] != RD_PUSHED && (size_t)(slip[0] + slip[1]) == node)
        kink->jump[slip[2]] = c_add(kink->jump[slip[2]], c_real(1));
    for (size_t i = 0; i < w; i++) {
        const cv half = c_scale(kink->jump[i], 0.5);
        kink->mean[i] = c_add(kink->mean[i], half);
        kink->of_mean[i] += c_size(half);
    }
}

static void place_between(const struct rd_sensitivity *sensitivity, const struct rd_pairs *pairs,
                          struct rd_place *place)
{
    for (size_t p = 0; p < pairs->count; p++)
        place[p] = rd_place_between(&sensitivity->left, &sensitivity->of.span.rate,
                                    sensitivity->chain->width, sensitivity->kink + pairs->of[2 * p],
                                    sensitivity->kink + pairs->of[2 * p + 1]);
}

/* -y^T H y is the same in all elements of the stretch, and their mean the least rounded */
void rd_sensitivity_last(const struct rd_sensitivity *sensitivity, const struct rd_pairs *pairs,
                         const cv *slope, struct rd_place *place)
{
    const struct rd_chain *chain = sensitivity->chain;
    memset(place, 0, pairs->count * sizeof *place);
    if (chain->kind != RD_CONTINUOUS)
        return;
    const double each = 1 / (double)rd_stretch_nodes(chain, chain->stretches - 2);
    for (size_t load = 0; load < sensitivity->fields->loads; load++)
        leave(sensitivity, sensitivity->moved + load, sensitivity->kink + load);
    for (size_t p = 0; p < pairs->count; p++) {
        place[p].slope = c_scale(slope[p * RD_PROPERTIES + RD_OF_LENGTH], each);
        place[p].size = rd_place_size(&sensitivity->of.span.rate, chain->width,
                                      sensitivity->kink + pairs->of[2 * p],
                                      sensitivity->kink + pairs->of[2 * p + 1]);
    }
}

/* what the last stretch says of the node where this one begins; whether it is asked for */
static bool begin_place(struct rd_sensitivity *sensitivity, size_t stretch,
                        const struct rd_pairs *pairs, struct rd_place *place)
{
    if (!place)
        return false;
    memset(place, 0, pairs->count * sizeof *place);
    if (stretch == 0 || sensitivity->chain->kind != RD_CONTINUOUS)
        return false;
    sensitivity->left = sensitivity->of.span.rate;
    for (size_t load = 0; load < sensitivity->fields->loads; load++)
        leave(sensitivity, sensitivity->moved + load, sensitivity->kink + load);
    return true;
}

enum rd_status rd_sensitivity_stretch(struct rd_sensitivity *sensitivity, size_t stretch,
                                      const struct rd_pairs *pairs, cv *slope, cv *jump,
                                      struct rd_place *place)
{
    const struct rd_chain *chain = sensitivity->chain;
    const size_t w = chain->width, first = (size_t)chain->first[stretch];
    const double *hinge = chain->hinge ? chain->hinge + (size_t)chain->term[stretch] * w : NULL;
    memset(slope, 0, pairs->count * RD_PROPERTIES * sizeof *slope);
    memset(jump, 0, pairs->count * w * sizeof *jump);
    const bool placed = begin_place(sensitivity, stretch, pairs, place);
    const enum rd_status status = prepare(sensitivity, stretch);
    if (status != RD_OK)
        return status;
    if (sensitivity->waves && sensitivity->fields->forces)
        rd_wave_slopes_hinge(&sensitivity->of.span, hinge, sensitivity->lines->spring);
    for (size_t i = first; i < (size_t)chain->first[stretch + 1]; i++) {
        move(sensitivity, hinge, i);
        for (size_t load = 0; placed && i == first && load < sensitivity->fields->loads; load++)
            enter(sensitivity, stretch, load);
        for (size_t p = 0; p < pairs->count; p++)
            add(sensitivity, pairs->of + 2 * p, slope + p * RD_PROPERTIES, jump + p * w);
    }
    if (placed)
        place_between(sensitivity, pairs, place);
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
