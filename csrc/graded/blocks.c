/* The blocks of a continuous element whose tension grows along it. */
#include "graded/blocks.h"

#include "span/span.h"

#include <assert.h>
#include <math.h>

/* Interpolation between so many nodes leaves NEGLIGIBLE of a function whose nearest singularity is
   where the tension vanishes: less than rounding, so that counts and quotients of the same waves agree
   whatever blocks they go by. Nearer than AIRY (B/|T'|)^1/3 a beam knows of no singularity: so long
   are its boundary layers and waves there. */
static const double NEGLIGIBLE = 1e-16, RATIO = 2, AIRY = 2;

/* a first piece of a string: its tension changes by so much, for its series */
static const double STEEP = 0.125;

/* radians of a piece, below the first resonance of a cantilever, of pi/2 */
static const double RADIANS = 1.2;

/* |lambda| mu l/T' of the piece at whose end the tension of a string vanishes */
static const double SLACK = 0.125;

/* what the blocks of an element share */
struct field {
    struct rd_span span;
    bool bends;
    double slope; /* [N/m] from the near end on */
    double airy;  /* [m] */
    double slack; /* length of the piece at whose end the tension vanishes [m] */
};

static struct field field_of(const struct rd_chain *chain, size_t e, const struct rd_sizes *x,
                             bool backward)
{
    const double along = chain->rise[e] / chain->length[e];
    struct field field = {
        .span = rd_span_of(chain, e, x->section, x->tension, x->inertia, x->dashpot),
        .bends = chain->coordinate[chain->width - 1] == RD_BETA,
        .slack = chain->length[e] / 2,
        .slope = backward ? -along : along,
    };
    const double S = field.span.flexibility[RD_BENDING * (RD_CHANNELS + 1)];
    if (field.bends)
        field.airy = AIRY / cbrt(fabs(along) * S);
    while (!field.bends && field.slack > 0 &&
           field.slack * field.span.load[0] > SLACK * x->tension * fabs(along))
        field.slack /= 2;
    return field;
}

/* largest wavenumber that propagates under tensions of a least T */
static double propagating(const struct field *field, double T, const struct rd_sizes *x)
{
    const struct rd_span *span = &field->span;
    if (!field->bends)
        return sqrt(span->load[0] / (T * x->tension));
    const double S = span->flexibility[RD_BENDING * (RD_CHANNELS + 1)] / span->section;
    const double h = 0.5 * S * (T * x->tension - span->load[1]), load = S * span->load[0];
    const double r = sqrt(h * h + load);
    const double waves = h >= 0 ? sqrt(load / fmax(r + h, 1e-300)) : sqrt(r - h);
    return fmax(waves, RADIANS * sqrt(fmax(-2 * h, 0)));
}

/* nodes for a block of such tensions: the error falls by x + sqrt(x^2 - 1) with each of them, x the
   distance of the singularity from its middle, in halves of it */
static int nodes_of(const struct field *field, double near, double far, double length)
{
    const double middle = fmax(fabs(near + far) / (2 * fabs(field->slope)), field->airy);
    const double x = fmax(2 * middle / length, 1.5);
    const double nodes = ceil(-log(NEGLIGIBLE) / log(x + sqrt(x * x - 1)));
    return (int)fmax(4, fmin(nodes, RD_NODES_MOST));
}

static struct rd_block block_of(const struct field *field, double tension, double length,
                                const struct rd_sizes *x)
{
    const double far = tension + field->slope * length;
    struct rd_block block = {.length = length, .tension = tension, .slope = field->slope};
    block.pieces = 1;
    block.vanishes = !field->bends && (tension <= 0 || far <= 0);
    if (block.vanishes)
        return block;
    struct rd_span span = field->span;
    span.tension =
        x->tension * (field->bends ? fmax(fabs(tension), fabs(far)) : fmin(tension, far));
    const double radians = length * rd_span_wavenumber(&span);
    block.nodes = nodes_of(field, tension, far, length);
    block.halvings = rd_span_halvings(radians, 1);
    while (!field->bends &&
           ldexp(fabs(far - tension), -block.halvings) > STEEP * fmin(tension, far))
        block.halvings++;
    block.terms = rd_span_terms(1); /* for all frequencies that go by these pieces */
    const double waves = length * propagating(field, fmin(tension, far), x);
    while (block.doublings < block.halvings &&
           ldexp(waves, block.doublings + 1 - block.halvings) <= RADIANS)
        block.doublings++;
    block.pieces = (size_t)1 << (block.halvings - block.doublings);
    return block;
}

/* from `from` to `to` > 0 by equal ratios of at most RATIO; returns how many ends there are */
static size_t add_ends(double from, double to, double sign, size_t count, double *end)
{
    const size_t parts = (size_t)fmax(1, ceil(log(to / from) / log(RATIO) - 1e-9));
    for (size_t i = 1; i <= parts && count <= RD_BLOCKS_MOST; i++)
        end[count++] = sign * (i == parts ? to : from * pow(to / from, (double)i / (double)parts));
    return count;
}

/* ends of blocks by their distance from where the tension vanishes, from the lowest tension up */
static size_t ends_of(double low, double high, double least, double *end)
{
    double below[RD_BLOCKS_MOST + 1];
    size_t count = 0, under = 0;
    if (low < -least)
        under = add_ends(fmax(least, -high), -low, -1, 0, below);
    while (under > 0)
        end[count++] = below[--under];
    if (low < -least)
        end[count++] = fmin(-least, high);
    else
        end[count++] = low;
    if (high > -least && low < least)
        end[count++] = fmin(least, high);
    if (high > least)
        count = add_ends(fmax(least, low), high, 1, count, end);
    return count;
}

size_t rd_blocks_of(const struct rd_chain *chain, size_t e, const struct rd_sizes *sizes,
                    bool backward, struct rd_block *block)
{
    const struct field field = field_of(chain, e, sizes, backward);
    const double steep = fabs(field.slope), rise = fabs(chain->rise[e]);
    const double low = chain->tension[e] - rise / 2, high = chain->tension[e] + rise / 2;
    double end[2 * RD_BLOCKS_MOST + 4], pieces = 0;
    const double least = field.bends ? field.airy : low <= 0 ? field.slack : 0;
    const size_t count = ends_of(low / steep, high / steep, least, end) - 1;
    assert(count >= 1 && (field.bends || low >= 0));
    if (count > RD_BLOCKS_MOST)
        return 0;
    for (size_t i = 0; i < count; i++) {
        const size_t k = field.slope > 0 ? i : count - 1 - i;
        const double near = field.slope > 0 ? end[k] : end[k + 1];
        /* one block may be a small difference of large distances */
        const double length = count > 1 ? end[k + 1] - end[k] : chain->length[e];
        block[i] = block_of(&field, near * steep, length, sizes);
        pieces += (double)block[i].pieces;
    }
    return pieces <= (double)RD_PIECES_MOST ? count : 0;
}
