/* The mixed form of a chain: forces of elements beside displacements of nodes, as one band. */
#include "mixed/mixed.h"

#include "chain/attached.h"
#include "chain/elements.h"
#include "element/element.h"
#include "element/triple.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX };

/* roundings of one entry of the band, a product of a few numbers, and of the refined solution */
static const double ROUNDINGS = 2;

/* static receptances of a rope of the mean section and tension; z of a beam that is under tension
   too from both in parallel */
static void find_scale(const struct rd_chain *chain, double *scale)
{
    double length = 0, pull = 0, soft[RD_CHANNELS] = {0};
    for (size_t i = 0; i + 1 < chain->nodes; i++) {
        const size_t e = (size_t)chain->element_of[i];
        const double *S = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS;
        length += chain->length[e];
        pull += chain->length[e] * fabs(chain->tension[e]);
        for (size_t c = 0; c < RD_CHANNELS; c++)
            soft[c] += chain->length[e] * S[c * (RD_CHANNELS + 1)];
    }
    const bool bends = chain->coordinate[chain->width - 1] == RD_BETA;
    for (size_t i = 0; i < chain->width; i++) {
        const double own = soft[rd_channel_of(chain->coordinate[i])];
        const double beam = bends ? 1 / (own * length * length) : 0;
        const bool lateral = chain->coordinate[i] == RD_Z;
        scale[i] = sqrt(lateral ? 1 / (beam + pull / (length * length)) : own);
    }
}

enum rd_status rd_mixed_prepare(const struct rd_chain *chain, struct rd_mixed *mixed,
                                struct rd_workspace *workspace)
{
    size_t blocks = 2 * chain->nodes - 1;
    for (size_t i = 0; i + 1 < chain->nodes; i++)
        blocks += rd_chain_is_hinged(chain, chain->term_of[i]) ? 2 : 0;
    mixed->chain = chain;
    mixed->size = blocks * chain->width;
    mixed->reach = 2 * chain->width - 1;
    mixed->block = rd_take(workspace, chain->nodes, sizeof *mixed->block);
    mixed->band = rd_take(workspace, mixed->size * (2 * mixed->reach + 1), sizeof *mixed->band);
    mixed->rest = rd_take(workspace, mixed->size, sizeof *mixed->rest);
    const size_t all = mixed->size * (3 * mixed->reach + 1);
    mixed->lu = (struct rd_lu){
        .size = mixed->size,
        .reach = mixed->reach,
        .factor = rd_take(workspace, all, sizeof *mixed->lu.factor),
        .pivot = rd_take(workspace, mixed->size, sizeof *mixed->lu.pivot),
    };
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    find_scale(chain, mixed->z);
    for (size_t i = 0, block = 0; i < chain->nodes; i++) {
        mixed->block[i] = block;
        block += rd_chain_is_hinged(chain, chain->term_of[i]) ? 4 : 2;
    }
    return RD_OK;
}

/* entry (a, b) of the blocks (p, q) and its mirror image grow by value */
static void add(struct rd_mixed *mixed, size_t p, size_t a, size_t q, size_t b,
                double _Complex value)
{
    const size_t w = mixed->chain->width, i = p * w + a, j = q * w + b;
    const size_t column = 2 * mixed->reach + 1;
    mixed->band[j * column + mixed->reach + i - j] += value;
    if (p != q)
        mixed->band[i * column + mixed->reach + j - i] += value;
}

/* the element between the blocks p and next, its force in next - 1 */
static void add_element(struct rd_mixed *mixed, size_t p, size_t next, const double _Complex *F,
                        const double _Complex *G, const double _Complex *Q)
{
    const size_t w = mixed->chain->width;
    const double *z = mixed->z;
    for (size_t a = 0; a < w; a++) {
        add(mixed, next, a, next - 1, a, 1);
        for (size_t b = 0; b < w; b++) {
            add(mixed, p, a, p, b, Q[a * w + b] * z[a] * z[b]);
            add(mixed, next - 1, a, p, b, -F[a * w + b] * z[b] / z[a]);
            add(mixed, next - 1, a, next - 1, b, -G[a * w + b] / (z[a] * z[b]));
        }
    }
}

static void add_node(struct rd_mixed *mixed, size_t node, const double _Complex *factor)
{
    const struct rd_chain *chain = mixed->chain;
    const size_t w = chain->width, term = (size_t)chain->term_of[node] * w * w;
    const size_t p = mixed->block[node];
    double _Complex D[W * W] = {0};
    rd_attached_add(chain, (size_t)chain->term_of[node], factor[RD_MASS], factor[RD_DASHPOTS], D);
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++) {
            const double _Complex N =
                factor[RD_SPRINGS] * chain->stiffness[term + a * w + b] +
                factor[RD_MASS] * chain->mass[term + a * w + b] +
                (chain->damping ? factor[RD_DASHPOTS] * chain->damping[term + a * w + b] : 0) +
                D[a * w + b];
            add(mixed, p, a, p, b, N * mixed->z[a] * mixed->z[b]);
        }
}

/* the hinge between block p and its right side p + 2; a compliance is that of a spring */
static void add_hinge(struct rd_mixed *mixed, size_t node, double _Complex spring)
{
    const size_t w = mixed->chain->width, p = mixed->block[node];
    const double *hinge = mixed->chain->hinge + (size_t)mixed->chain->term_of[node] * w;
    for (size_t a = 0; a < w; a++) {
        const double _Complex C = hinge[a] / (spring * mixed->z[a] * mixed->z[a]);
        const bool open = isinf(hinge[a]);
        const double s = open ? 0 : sqrt(1 / (1 + cabs(C)));
        add(mixed, p + 1, a, p, a, -s);
        add(mixed, p + 1, a, p + 2, a, s);
        add(mixed, p + 1, a, p + 1, a, open ? -1 : -C * s * s);
    }
}

/* row and column i <- those of the unit matrix */
static void hold(struct rd_mixed *mixed, size_t i)
{
    const size_t reach = mixed->reach, column = 2 * reach + 1;
    const size_t first = i > reach ? i - reach : 0;
    for (size_t j = first; j <= i + reach && j < mixed->size; j++) {
        mixed->band[j * column + reach + i - j] = i == j;
        mixed->band[i * column + reach + j - i] = i == j;
    }
}

static enum rd_status fill(struct rd_mixed *mixed, const double _Complex *factor)
{
    const struct rd_chain *chain = mixed->chain;
    const size_t w = chain->width;
    double _Complex F[W * W], G[W * W], Q[W * W];
    const size_t column = 2 * mixed->reach + 1;
    int32_t last = -1;
    for (size_t j = 0; j < mixed->size; j++) {
        if (rd_lu_stops(&mixed->lu, j))
            return RD_INTERRUPTED;
        memset(mixed->band + j * column, 0, column * sizeof *mixed->band);
    }
    for (size_t i = 0; i < chain->nodes; i++) {
        if (rd_lu_stops(&mixed->lu, i))
            return RD_INTERRUPTED;
        add_node(mixed, i, factor);
    }
    for (size_t i = 0; i + 1 < chain->nodes; i++) {
        if (rd_lu_stops(&mixed->lu, i))
            return RD_INTERRUPTED;
        if (chain->element_of[i] != last) {
            last = chain->element_of[i];
            const struct rd_element element = rd_chain_element(chain, (size_t)last);
            const enum rd_status status =
                rd_triple(&element, factor[RD_ELASTIC], factor[RD_STRING], F, G, Q);
            if (status != RD_OK)
                return status;
        }
        const bool hinged = rd_chain_is_hinged(chain, chain->term_of[i]);
        if (hinged)
            add_hinge(mixed, i, factor[RD_SPRINGS]);
        add_element(mixed, mixed->block[i] + (hinged ? 2 : 0), mixed->block[i + 1], F, G, Q);
    }
    for (size_t i = 0; i < chain->nodes; i++)
        for (size_t a = 0; a < w; a++)
            if (chain->held[(size_t)chain->term_of[i] * w + a])
                hold(mixed, mixed->block[i] * w + a);
    return RD_OK;
}

enum rd_status rd_mixed_factorise(struct rd_mixed *mixed, const double _Complex *factor)
{
    const enum rd_status status = fill(mixed, factor);
    if (status != RD_OK)
        return status;
    const size_t reach = mixed->reach, from = 2 * reach + 1, to = 3 * reach + 1;
    for (size_t j = 0; j < mixed->size; j++) {
        if (rd_lu_stops(&mixed->lu, j))
            return RD_INTERRUPTED;
        double _Complex *const column = mixed->lu.factor + j * to;
        memset(column, 0, reach * sizeof *column);
        memcpy(column + reach, mixed->band + j * from, from * sizeof *column);
    }
    return rd_lu_factorise(&mixed->lu);
}

/* first and last row of column j */
static void rows_of(const struct rd_mixed *mixed, size_t j, size_t *first, size_t *last)
{
    *first = j > mixed->reach ? j - mixed->reach : 0;
    *last = j + mixed->reach < mixed->size ? j + mixed->reach : mixed->size - 1;
}

void rd_mixed_solve(struct rd_mixed *mixed, size_t columns, const double _Complex *b,
                    double _Complex *x)
{
    const size_t n = mixed->size, column = 2 * mixed->reach + 1;
    memcpy(x, b, columns * n * sizeof *x);
    rd_lu_solve(&mixed->lu, columns, x);
    for (size_t c = 0; c < columns; c++) {
        memcpy(mixed->rest, b + c * n, n * sizeof *mixed->rest);
        for (size_t j = 0; j < n; j++) {
            size_t first, last;
            if (rd_lu_stops(&mixed->lu, j))
                return;
            rows_of(mixed, j, &first, &last);
            for (size_t i = first; i <= last; i++)
                mixed->rest[i] -= mixed->band[j * column + mixed->reach + i - j] * x[c * n + j];
        }
        rd_lu_solve(&mixed->lu, 1, mixed->rest);
        for (size_t i = 0; i < n; i++)
            x[c * n + i] += mixed->rest[i];
    }
}

void rd_mixed_spread(const struct rd_mixed *mixed, const double _Complex *x, double *spread)
{
    const size_t n = mixed->size, column = 2 * mixed->reach + 1;
    memset(spread, 0, n * sizeof *spread);
    for (size_t j = 0; j < n; j++) {
        const double own = cabs(x[j]);
        size_t first, last;
        if (rd_lu_stops(&mixed->lu, j))
            return;
        rows_of(mixed, j, &first, &last);
        for (size_t i = first; i <= last; i++) {
            const double _Complex entry = mixed->band[j * column + mixed->reach + i - j];
            spread[i] += (fabs(creal(entry)) + fabs(cimag(entry))) * own;
        }
    }
}

double rd_mixed_error(const struct rd_mixed *mixed, const double _Complex *y, const double *spread)
{
    double sum = 0;
    for (size_t i = 0; i < mixed->size; i++)
        sum += cabs(y[i]) * spread[i];
    return ROUNDINGS * DBL_EPSILON * sum;
}

bool rd_mixed_is_lost(struct rd_mixed *mixed, const double _Complex *x, const double *spread,
                      double _Complex *scratch)
{
    const size_t n = mixed->size;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        scratch[i] = conj(x[i]);
        sum += creal(x[i] * conj(x[i]));
    }
    rd_mixed_solve(mixed, 1, scratch, scratch + n);
    return sum > 0 && rd_mixed_error(mixed, scratch + n, spread) >= sum;
}

/* unknown a of the port's first (half 0) or second node, or SIZE_MAX where that is held */
static size_t place_of(const struct rd_mixed *mixed, size_t node, size_t a)
{
    const size_t w = mixed->chain->width;
    const bool held = mixed->chain->held[(size_t)mixed->chain->term_of[node] * w + a];
    return held ? SIZE_MAX : mixed->block[node] * w + a;
}

void rd_mixed_load(const struct rd_mixed *mixed, const struct rd_ports *ports, size_t p,
                   double _Complex *load)
{
    const size_t w = mixed->chain->width, node = (size_t)ports->node[p];
    assert(p < ports->count && node + 1 < mixed->chain->nodes);
    memset(load, 0, mixed->size * sizeof *load);
    for (size_t k = 0; k < 2 * w; k++) {
        const size_t at = place_of(mixed, node + k / w, k % w);
        if (at != SIZE_MAX)
            load[at] = ports->row[p * 2 * w + k] * mixed->z[k % w];
    }
    const size_t force = (mixed->block[node + 1] - 1) * w;
    for (size_t a = 0; ports->force && a < w; a++)
        load[force + a] = ports->force[p * w + a] / mixed->z[a];
}

double _Complex rd_mixed_read(const struct rd_mixed *mixed, const struct rd_ports *ports, size_t p,
                              const double _Complex *x)
{
    const size_t w = mixed->chain->width, node = (size_t)ports->node[p];
    assert(p < ports->count && node + 1 < mixed->chain->nodes);
    double _Complex sum = 0;
    for (size_t k = 0; k < 2 * w; k++) {
        const size_t at = place_of(mixed, node + k / w, k % w);
        if (at != SIZE_MAX)
            sum += ports->row[p * 2 * w + k] * mixed->z[k % w] * x[at];
    }
    const size_t force = (mixed->block[node + 1] - 1) * w;
    for (size_t a = 0; ports->force && a < w; a++)
        sum += ports->force[p * w + a] / mixed->z[a] * x[force + a];
    return sum;
}
