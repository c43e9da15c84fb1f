/* A chain as a rigid body: how its nodes resist its motion as a whole. */
#include "chain/body.h"

#include <math.h>
#include <stdbool.h>

/* Equal nodes side by side. */
struct row {
    double count, x, apart; /* the first stands at x [m] */
};

/* A row of weights n more: all terms are positive, so that a heavy node costs no digit (Welford;
   Chan, Golub, LeVeque 1983). */
static void add_weight(double n, const struct row *row, double *weight, double *centre,
                       double *moment)
{
    if (n == 0.0)
        return;
    const double added = n * row->count;
    const double away = row->x + row->apart * (row->count - 1.0) / 2.0 - *centre;
    const double total = *weight + added;
    *moment += away * away * added * (*weight / total);
    *moment += added * row->apart * row->apart * (row->count * row->count - 1.0) / 12.0;
    *centre += away * (added / total);
    *weight = total;
}

static void add_row(const struct rd_chain *chain, size_t t, const struct row *row,
                    struct rd_body *body)
{
    const size_t w = chain->width;
    for (size_t i = 0; i < w; i++) {
        const size_t at = (t * w + i) * w + i;
        const double n[2] = {fabs(chain->mass[at]), fabs(chain->stiffness[at])};
        const int held = chain->held[t * w + i];
        body->sum[i][0] += n[0] * row->count;
        body->sum[i][1] += held ? INFINITY : n[1] * row->count;
        if (chain->coordinate[i] != RD_Z)
            continue;
        for (int k = 0; k < 2 && !held; k++)
            add_weight(n[k], row, body->weight + k, body->centre + k, body->moment + k);
        body->pins += held ? row->count : 0.0;
        body->pin = held ? row->x + row->apart * (row->count - 1.0) : body->pin;
    }
}

/* the inertia of continuous elements, a bar of so many that begins at x */
static void add_bar(const struct rd_chain *chain, size_t e, double count, double x,
                    struct rd_body *body)
{
    const size_t w = chain->width;
    const double l = count * chain->length[e];
    for (size_t i = 0; i < w; i++) {
        const double m = l * chain->inertia[e * w + i];
        const struct row bar = {.count = 1.0, .x = x + 0.5 * l};
        body->sum[i][0] += m;
        if (chain->coordinate[i] != RD_Z)
            continue;
        add_weight(m, &bar, body->weight, body->centre, body->moment);
        body->moment[0] += m * l * l / 12.0;
    }
}

void rd_body_find(const struct rd_chain *chain, struct rd_body *body)
{
    *body = (struct rd_body){.length = 0.0};
    for (size_t k = 0; k < chain->stretches; k++) {
        const bool last = k + 1 == chain->stretches;
        const struct row row = {
            .count = last ? 1.0 : (double)(chain->first[k + 1] - chain->first[k]),
            .x = body->length,
            .apart = last ? 0.0 : chain->length[chain->element[k]],
        };
        add_row(chain, (size_t)chain->term[k], &row, body);
        if (chain->inertia && !last)
            add_bar(chain, (size_t)chain->element[k], row.count, row.x, body);
        body->length += last ? 0.0 : row.count * row.apart;
    }
}

/* spring = 0 on something held is still held */
static double total(const double *pair, double lambda, double spring)
{
    return lambda * pair[0] + (pair[1] > 0.0 ? spring * pair[1] : 0.0);
}

static double inverse_of(double resistance)
{
    return resistance > 0.0 ? 1.0 / resistance : 0.0;
}

/* about the pin, or about the common centre of masses m and springs k:
       J_m + J_k + m k/(m + k) (x_m - x_k)^2 */
static double moment_of(const struct rd_body *body, double lambda, double spring)
{
    const double m = lambda * body->weight[0], k = spring * body->weight[1];
    const double own = lambda * body->moment[0] + spring * body->moment[1];
    if (body->pins > 1.0)
        return INFINITY;
    if (body->pins == 1.0) {
        const double a = body->centre[0] - body->pin, b = body->centre[1] - body->pin;
        return own + m * a * a + k * b * b;
    }
    const double apart = body->centre[0] - body->centre[1];
    return own + m * inverse_of(m + k) * k * apart * apart;
}

double rd_body_receptance(const struct rd_body *body, const struct rd_chain *chain, size_t i,
                          double lambda, double spring, double tension)
{
    const size_t last = chain->width - 1;
    const double L = body->length, alone = inverse_of(total(body->sum[i], lambda, spring));
    const int32_t c = chain->coordinate[i];
    const int turns = chain->coordinate[last] == RD_BETA && chain->kind != RD_DIFFERENCE;
    if (!turns || (c != RD_Z && c != RD_BETA))
        return alone;
    const double turned = inverse_of(total(body->sum[last], lambda, spring) +
                                     moment_of(body, lambda, spring) + fabs(tension) * L);
    /* the ends of a body that turns about its middle */
    return c == RD_BETA ? turned : alone + 0.25 * L * L * turned;
}
