/* A chain prepared for walking: its triples and its runs of equal elements. */
#include "modes/walk/walk.h"

#include "base/dense.h"
#include "chain/attached.h"
#include "chain/elements.h"
#include "chain/inertia.h"
#include "element/element.h"
#include "element/strut.h"
#include "element/triple.h"
#include "span/span.h"

#include <math.h>
#include <string.h>

/* a node, its hinge as an element of no length, and the element on its right */
static size_t hinged_legs(const struct rd_chain *chain, size_t k, size_t node, int32_t before,
                          struct rd_leg *leg)
{
    const int32_t hinge = (int32_t)chain->distinct + chain->term[k];
    if (leg) {
        leg[0] = (struct rd_leg){.node = node, .count = 1, .element = hinge, .before = before};
        leg[0].first = leg[0].term = chain->term[k];
        leg[1] = (struct rd_leg){
            .node = node, .count = 1, .element = chain->element[k], .before = hinge};
        leg[1].first = leg[1].term = RD_NO_TERM;
    }
    return 2;
}

/* whether the next stretch is more of the element on the right of this one; structures are met at the
   beginnings of legs alone */
static bool goes_on(const struct rd_chain *chain, size_t k)
{
    if (k + 2 >= chain->stretches || chain->element[k + 1] != chain->element[k])
        return false;
    const int32_t next = chain->term[k + 1];
    if (rd_attached_is_of(chain, rd_attached_first(chain, (size_t)next), next))
        return false;
    return chain->inertia ? rd_term_is_bare(chain, next) : !rd_chain_is_hinged(chain, next);
}

/* legs of the chain, written where leg is not NULL; a single node takes the stretch on its right
   along where that goes on with the same element */
static size_t make_legs(const struct rd_chain *chain, struct rd_leg *leg)
{
    size_t legs = 0, next;
    for (size_t k = 0; k + 1 < chain->stretches; k = next) {
        const size_t node = (size_t)chain->first[k];
        const int32_t before = k > 0 ? chain->element[k - 1] : -1;
        size_t count = rd_stretch_nodes(chain, k);
        next = k + 1;
        if (rd_chain_is_hinged(chain, chain->term[k])) {
            for (size_t i = 0; i < count; i++)
                legs += hinged_legs(chain, k, node + i, i > 0 ? chain->element[k] : before,
                                    leg ? leg + legs : NULL);
            continue;
        }
        if (count == 1 && goes_on(chain, k)) {
            next = k + 2;
            count += rd_stretch_nodes(chain, k + 1);
        }
        if (leg)
            leg[legs] = (struct rd_leg){
                .node = node,
                .count = count,
                .element = chain->element[k],
                .before = before,
                .first = chain->term[k],
                .term = chain->inertia ? RD_NO_TERM : chain->term[next - 1],
            };
        legs++;
    }
    return legs;
}

static enum rd_status fill_triples(struct rd_walk *walk)
{
    const struct rd_chain *chain = walk->chain;
    const size_t block = chain->width * chain->width;
    for (size_t i = 0; i < chain->distinct; i++) {
        double *D = walk->triple + 4 * block * i;
        double *G = D + block, *Q = G + block, *P = Q + block;
        struct rd_element element = rd_chain_element(chain, i);
        if (chain->kind == RD_CONTINUOUS) /* for its scales alone */
            element.tension = fmax(element.tension, 0);
        walk->strut[i] = rd_element_is_strut(&element);
        memset(P, 0, block * sizeof *P);
        const enum rd_status status = walk->strut[i] ? rd_strut_fill(&element, D, G, Q, P)
                                                     : rd_triple_change(&element, D, G, Q);
        if (status != RD_OK)
            return status;
    }
    return RD_OK;
}

/* A hinge: G = its compliance. A free one has G = g and P = -1/g, which cancel, for any g. */
static void fill_hinge(struct rd_walk *walk, size_t term, double g)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width, block = w * w;
    double *D = walk->triple + 4 * block * (chain->distinct + term);
    memset(D, 0, 4 * block * sizeof *D);
    walk->strut[chain->distinct + term] = 0;
    for (size_t i = 0; i < w; i++) {
        const double compliance = chain->hinge[term * w + i];
        const bool free = isinf(compliance);
        D[i * (w + 1)] = free ? -1 : 0;
        D[block + i * (w + 1)] = free ? g : compliance;
        D[3 * block + i * (w + 1)] = free ? -1 / g : 0;
        walk->strut[chain->distinct + term] |= free;
    }
}

/* heavy parts count once each in the mean: what waves meet is the rope between them */
static void add_mass(struct rd_walk *walk, int32_t term, double n, double *with_mass)
{
    const size_t w = walk->chain->width;
    const double *M = rd_walk_mass(walk, term);
    for (size_t i = 0; i < w; i++) {
        const double m = fabs(M[i * (w + 1)]);
        walk->mass[i] += n * m;
        if (m > 0 && n > 0) {
            walk->carried[i] += n * log(m);
            with_mass[i] += n;
        }
    }
}

static void add_leg(struct rd_walk *walk, const struct rd_leg *leg, bool bends, double *with_mass,
                    double *rope)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width, block = w * w;
    const size_t e = (size_t)leg->element;
    const double n = (double)leg->count;
    const double *G = walk->triple + 4 * block * e + block;
    add_mass(walk, leg->first, 1, with_mass);
    add_mass(walk, leg->term, n - 1, with_mass);
    if (e >= chain->distinct)
        return;
    for (size_t i = 0; i < w; i++) {
        const double own = chain->inertia ? n * chain->length[e] * chain->inertia[e * w + i] : 0;
        walk->flexibility[i] += n * fabs(G[i * (w + 1)]);
        walk->mass[i] += own;
        rope[i] += own;
    }
    walk->length += n * chain->length[e];
    walk->tension += n * chain->length[e] * chain->tension[e];
    walk->sag += chain->sag ? n * chain->length[e] * chain->sag[e] : 0;
    if (bends)
        walk->bend += n * chain->length[e] * chain->flexibility[e * 9 + 8];
}

static void add_legs(struct rd_walk *walk)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width;
    const size_t z = rd_coordinate_find(w, chain->coordinate, RD_Z);
    const size_t beta = rd_coordinate_find(w, chain->coordinate, RD_BETA);
    const bool bends = z < w && beta < w && chain->kind != RD_DIFFERENCE;
    double with_mass[RD_WIDTH_MAX] = {0}, rope[RD_WIDTH_MAX] = {0};
    for (size_t r = 0; r < walk->legs; r++) {
        const struct rd_leg *leg = walk->leg + r;
        add_leg(walk, leg, bends, with_mass, rope);
    }
    add_mass(walk, walk->last, 1, with_mass);
    for (size_t i = 0; i < w; i++)
        walk->carried[i] = rope[i] > 0        ? rope[i]
                           : with_mass[i] > 0 ? with_mass[i] * exp(walk->carried[i] / with_mass[i])
                                              : 0;
    walk->tension /= walk->length;
    walk->sag /= walk->length;
    if (walk->bend > 0)
        walk->flexibility[z] = 1 / (3 / (walk->bend * walk->length * walk->length) +
                                    fabs(walk->tension) / walk->length);
}

static bool are_finite(size_t count, const double *x)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += x[i] * 0;
    return sum == 0;
}

static bool is_finite(const struct rd_chain *chain)
{
    for (size_t i = 0; chain->hinge && i < chain->terms * chain->width; i++)
        if (isnan(chain->hinge[i]))
            return false;
    const size_t terms = chain->terms * chain->width * chain->width;
    return (!chain->inertia || are_finite(chain->distinct * chain->width, chain->inertia)) &&
           are_finite(chain->attached * RD_ATTACHED_VALUES, chain->attached_value) &&
           are_finite(chain->attached * 2 * chain->width, chain->attached_row) &&
           are_finite(chain->distinct, chain->length) &&
           are_finite(chain->distinct, chain->tension) &&
           (!chain->sag || are_finite(chain->distinct, chain->sag)) &&
           are_finite(chain->distinct * 9, chain->flexibility) && are_finite(terms, chain->mass) &&
           are_finite(terms, chain->stiffness);
}

enum rd_status rd_walk_fill(const struct rd_chain *chain, struct rd_workspace *workspace,
                            struct rd_walk *walk)
{
    const size_t block = chain->width * chain->width;
    const size_t elements = chain->distinct + (chain->hinge ? chain->terms : 0);
    *walk = (struct rd_walk){
        .chain = chain,
        .legs = make_legs(chain, NULL),
        .last = chain->term[chain->stretches - 1],
        .behind = chain->element[chain->stretches - 2],
    };
    walk->leg = rd_take(workspace, walk->legs, sizeof *walk->leg);
    walk->triple = rd_take(workspace, elements * 4 * block, sizeof *walk->triple);
    walk->strut = rd_take(workspace, elements, 1);
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    if (!is_finite(chain))
        return RD_NOT_POSITIVE_DEFINITE;
    const enum rd_status status = fill_triples(walk);
    if (status != RD_OK)
        return status;
    rd_body_find(chain, &walk->body);
    make_legs(chain, walk->leg);
    add_legs(walk);
    for (size_t t = 0; chain->hinge && t < chain->terms; t++)
        fill_hinge(walk, t, walk->bend > 0 ? walk->bend : 1);
    return RD_OK;
}

/* h = T/2B, r = sqrt(h^2 + mu lambda/B), a^2 = r + h, k^2 = mu lambda/(B (r + h)) */
static void bending_scale(const struct rd_walk *walk, double m, double *z, double *beta)
{
    const double L = walk->length;
    const double B = L / walk->bend;
    const double h = fabs(walk->tension) / (2 * B);
    const double r = sqrt(h * h + m / L / B);
    const double a = fmax(sqrt(r + h), 1 / L);
    const double k = fmax(sqrt(m / L / B / fmax(r + h, 1 / (L * L))), 1 / L);
    *z = 1 / sqrt(B * k * (k * k + a * a));
    *beta = 1 / sqrt(B * a);
}

void rd_walk_scale(const struct rd_walk *walk, double lambda, double *z)
{
    const struct rd_chain *chain = walk->chain;
    const size_t iz = rd_coordinate_find(chain->width, chain->coordinate, RD_Z);
    const size_t ibeta = rd_coordinate_find(chain->width, chain->coordinate, RD_BETA);
    for (size_t i = 0; i < chain->width; i++) {
        const double G = walk->flexibility[i] > 0 ? walk->flexibility[i] : 1;
        const double x = fabs(lambda) * walk->carried[i] * G;
        z[i] = sqrt(G / sqrt(fmax(x, 1)));
    }
    if (walk->bend > 0)
        bending_scale(walk, fabs(lambda) * walk->carried[iz], z + iz, z + ibeta);
    for (size_t i = 0; i < chain->width; i++) {
        const double rigid =
            rd_body_receptance(&walk->body, chain, i, fabs(lambda), 1, walk->tension);
        z[i] = fmax(z[i], sqrt(rigid));
    }
    /* x of a rope that hangs follows z */
    if (chain->sag)
        z[0] = hypot(z[0], walk->sag * walk->length * z[iz]);
}

/* G^-1 + P at the right end, Q + F^T G^-1 F at the left */
double rd_walk_stiffness(const struct rd_walk *walk, size_t element, size_t i)
{
    const size_t w = walk->chain->width, block = w * w;
    const double *D = walk->triple + element * 4 * block;
    double Gi[RD_WIDTH_MAX * RD_WIDTH_MAX], left = fabs(D[2 * block + i * (w + 1)]);
    const double *P = D + 3 * block;
    memcpy(Gi, D + block, block * sizeof *Gi);
    if (!rd_dense_invert(w, Gi))
        return INFINITY;
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++)
            left += (D[a * w + i] + (a == i)) * Gi[a * w + b] * (D[b * w + i] + (b == i));
    return fmax(fabs(Gi[i * (w + 1)]) + fabs(P[i * (w + 1)]), fabs(left));
}

/* of the structures of a node term, far above their own eigenvalues */
static double carried_stiffness(const struct rd_chain *chain, size_t t, size_t i, double lambda)
{
    double _Complex D[RD_WIDTH_MAX * RD_WIDTH_MAX] = {0};
    rd_attached_add(chain, t, -lambda, 0, D);
    return cabs(D[i * (chain->width + 1)]);
}

double rd_walk_ceiling(const struct rd_walk *walk)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width, block = w * w;
    double ceiling = 0;
    const double above = 16 * rd_attached_highest(chain);
    if (rd_inertia_is_endless(chain) || isinf(above))
        return INFINITY;
    for (size_t i = 0; i < w; i++) {
        double stiffness = 0, springs = 0, mass = INFINITY;
        for (size_t e = 0; e < chain->distinct; e++)
            stiffness = fmax(stiffness, rd_walk_stiffness(walk, e, i));
        for (size_t t = 0; t < chain->terms; t++) {
            const double m = fabs(chain->mass[t * block + i * (w + 1)]);
            springs = fmax(springs, fabs(chain->stiffness[t * block + i * (w + 1)]) +
                                        carried_stiffness(chain, t, i, above));
            mass = m > 0 ? fmin(mass, m) : mass;
        }
        ceiling = fmax(ceiling, 16 * (double)w * (stiffness + springs) / mass);
    }
    return fmax(ceiling, above);
}

double rd_walk_radians(const struct rd_walk *walk, const struct rd_leg *leg, double lambda)
{
    const struct rd_chain *chain = walk->chain;
    const size_t e = (size_t)leg->element;
    if (!chain->inertia || e >= chain->distinct)
        return 0;
    const struct rd_span span = rd_span_of(chain, e, 1, 1, fabs(lambda), 0);
    return chain->length[e] * rd_span_wavenumber(&span);
}
