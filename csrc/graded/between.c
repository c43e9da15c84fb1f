/* Triples of graded elements at a few frequencies, and between them. */
#include "graded/between.h"

#include "span/rate_matrix.h"

#include <assert.h>

#pragma GCC diagnostic ignored "-Wpsabi"

/* whether a family ends as pieces one after another (graded/width.h) */
static bool ends_apart(const struct rd_block *block)
{
    const size_t nodes = (size_t)block->nodes;
    const size_t before = block->doublings > 0 ? 2 * block->pieces : block->pieces;
    return block->vanishes || before <= nodes;
}

static size_t triples_of(const struct rd_block *block)
{
    return ends_apart(block) ? block->pieces : (size_t)block->nodes;
}

static size_t entries_of(size_t width)
{
    return width * width + width * (width + 1);
}

size_t rd_between_layout(const struct rd_chain *chain, const struct rd_sizes *most, size_t *first)
{
    struct rd_block block[RD_BLOCKS_MOST];
    size_t places = 0;
    for (size_t e = 0; e < chain->distinct; e++)
        for (size_t way = 0; way < 2; way++) {
            if (first)
                first[2 * e + way] = places;
            if (!rd_is_graded(chain, e))
                continue;
            const size_t blocks = rd_blocks_of(chain, e, most, way, block);
            if (blocks == 0)
                return RD_BETWEEN_NONE;
            for (size_t k = 0; k < blocks; k++)
                places += triples_of(block + k) * entries_of(chain->width);
        }
    return places;
}

static cv load(const double *from, size_t batch)
{
    cv all;
    for (size_t lane = 0; lane < RD_LANES; lane++) {
        all.re[lane] = from[2 * (batch * RD_LANES + lane)];
        all.im[lane] = from[2 * (batch * RD_LANES + lane) + 1];
    }
    return all;
}

/* the entries that a motion of z alone makes: the first column of D, the first row of Q */
RD_INLINE void times_load(size_t width, cv load, cv *triple)
{
    cv *const Q = triple + width * width + width * (width + 1) / 2;
    for (size_t i = 0; i < width; i++) {
        triple[i * width] = c_mul(triple[i * width], load);
        Q[i] = c_mul(Q[i], load);
    }
}

cv rd_between_load(const struct rd_chain *chain, size_t e, cv inertia, cv dashpot)
{
    const size_t at = e * chain->width;
    const double drag = chain->drag ? chain->drag[at] : 0;
    return c_add(c_scale(inertia, chain->inertia[at]), c_scale(dashpot, drag));
}

static void store(const struct rd_family *family, size_t nodes, size_t batch, double *to)
{
    const size_t entries = entries_of(family->width), triples = triples_of(family->block);
    assert(family->apart == ends_apart(family->block));
    for (size_t i = 0; i < triples * entries; i++) {
        const cv x = family->at[i / entries][i % entries];
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            to[2 * i * nodes + batch * RD_LANES + lane] = x.re[lane];
            to[(2 * i + 1) * nodes + batch * RD_LANES + lane] = x.im[lane];
        }
    }
}

/* element e at the nodes of a batch, seen backward or not */
static void element_fill(const struct rd_chain *chain, const struct rd_between *between, size_t e,
                         bool way, const struct rd_between_factors *factors, size_t batch,
                         double *to)
{
    struct rd_block block[RD_BLOCKS_MOST];
    struct rd_family family;
    struct rate_matrix rate;
    const cv tension = load(factors->tension, batch), inertia = load(factors->inertia, batch);
    const cv dashpot = load(factors->dashpot, batch);
    const cv per_load = c_inverse(rd_between_load(chain, e, inertia, dashpot));
    const struct rd_field field = {
        .width = chain->width,
        .rate = &rate,
        .tension = chain->tension[e],
        .pull = tension,
    };
    rd_rate_fill(chain, e, load(factors->section, batch), tension, inertia, dashpot, &rate);
    const size_t blocks = rd_blocks_of(chain, e, &between->most, way, block);
    for (size_t k = 0; k < blocks; k++) {
        rd_family_fill(&field, block + k, &family);
        for (size_t i = 0; i < triples_of(block + k); i++)
            times_load(chain->width, per_load, family.at[i]);
        store(&family, between->nodes, batch, to);
        to += 2 * between->nodes * triples_of(block + k) * entries_of(chain->width);
    }
}

void rd_between_fill(const struct rd_chain *chain, const struct rd_between *between,
                     const struct rd_between_factors *factors, double *values)
{
    for (size_t e = 0; e < chain->distinct; e++)
        for (size_t way = 0; rd_is_graded(chain, e) && way < 2; way++)
            for (size_t batch = 0; batch < between->nodes / RD_LANES; batch++)
                element_fill(chain, between, e, way, factors, batch,
                             values + 2 * between->nodes * between->first[2 * e + way]);
}

void rd_between_weigh(const struct rd_between *between, const size_t *index, lanes *weight)
{
    for (size_t n = 0; n < between->nodes; n++)
        for (size_t lane = 0; lane < RD_LANES; lane++)
            weight[n][lane] = between->weight[index[lane] * between->nodes + n];
}

/* sum of weight and value of the nodes, which are even in number: two sums, of which neither waits */
RD_INLINE lanes weighed(size_t nodes, const lanes *weight, const double *values)
{
    lanes even = {0}, odd = {0};
    for (size_t n = 0; n < nodes; n += 2) {
        even += weight[n] * values[n];
        odd += weight[n + 1] * values[n + 1];
    }
    return even + odd;
}

static RD_CLONES void interpolate(const struct rd_between *between, const lanes *weight,
                                  const double *values, size_t entries, cv *to)
{
    const size_t nodes = between->nodes;
    for (size_t i = 0; i < entries; i++, values += 2 * nodes) {
        to[i].re = weighed(nodes, weight, values);
        to[i].im = between->real ? (lanes){0} : weighed(nodes, weight, values + nodes);
    }
}

/* u = z u^ and f = f^/z: F_ij z_j/z_i, G_ij/(z_i z_j), Q_ij z_i z_j */
static RD_CLONES void scale(size_t width, const lanes *z, cv *triple)
{
    const size_t full = width * width, sym = width * (width + 1) / 2;
    for (size_t i = 0, p = full; i < width; i++)
        for (size_t j = 0; j < width; j++) {
            triple[i * width + j] = c_scale_lanes(triple[i * width + j], z[j] / z[i]);
            if (j < i)
                continue;
            triple[p] = c_scale_lanes(triple[p], 1.0 / (z[i] * z[j]));
            triple[p + sym] = c_scale_lanes(triple[p + sym], z[i] * z[j]);
            p++;
        }
}

const double *rd_between_family(const struct rd_between *between,
                                const struct rd_between_lines *lines, const double *values,
                                size_t width, const struct rd_block *block,
                                struct rd_family *family)
{
    const size_t triples = triples_of(block), entries = entries_of(width);
    family->block = block;
    family->width = width;
    family->apart = ends_apart(block);
    for (size_t i = 0; i < triples; i++, values += 2 * between->nodes * entries) {
        interpolate(between, lines->weight, values, entries, family->at[i]);
        times_load(width, lines->load, family->at[i]);
        scale(width, lines->z, family->at[i]);
    }
    return values;
}
