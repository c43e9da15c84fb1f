/* A chain prepared for walking: its triples and its runs of equal elements. */
#include "walk.h"

#include "dense.h"
#include "element.h"
#include "strut.h"
#include "triple.h"

#include <math.h>
#include <string.h>

/* elements from node i on that are equal, with equal node terms between them */
static size_t run_length(const struct rd_chain *chain, size_t i)
{
    size_t n = 1;
    while (i + n + 1 < chain->nodes && chain->element_of[i + n] == chain->element_of[i] &&
           (n == 1 || chain->term_of[i + n] == chain->term_of[i + 1]))
        n++;
    return n;
}

static size_t number_of_runs(const struct rd_chain *chain)
{
    size_t runs = 0;
    for (size_t i = 0; i + 1 < chain->nodes; i += run_length(chain, i))
        runs++;
    return runs;
}

/* of the symmetric A = L diag(g) L^T */
static int32_t negative_pivots(size_t w, const double *A)
{
    double L[RD_WIDTH_MAX][RD_WIDTH_MAX], g[RD_WIDTH_MAX];
    int32_t count = 0;
    for (size_t j = 0; j < w; j++) {
        for (size_t i = j; i < w; i++) {
            L[i][j] = A[i * w + j];
            for (size_t k = 0; k < j; k++)
                L[i][j] -= L[i][k] * L[j][k] / g[k];
        }
        g[j] = L[j][j];
        count += g[j] < 0;
    }
    return count;
}

static enum rd_status fill_triples(struct rd_walk *walk, int32_t *below)
{
    const struct rd_chain *chain = walk->chain;
    const size_t block = chain->width * chain->width;
    for (size_t i = 0; i < chain->distinct; i++) {
        double *D = walk->triple + 4 * block * i;
        double *G = D + block, *Q = G + block, *P = Q + block;
        const struct rd_element element = rd_chain_element(chain, i);
        walk->strut[i] = rd_element_is_strut(&element);
        memset(P, 0, block * sizeof *P);
        const enum rd_status status = walk->strut[i] ? rd_strut_fill(&element, D, G, Q, P)
                                                     : rd_triple_change(&element, D, G, Q);
        if (status != RD_OK)
            return status;
        below[i] = negative_pivots(chain->width, G);
    }
    return RD_OK;
}

/* heavy parts count once each in the mean: what waves meet is the rope between them */
static void add_mass(struct rd_walk *walk, int32_t term, double n, double *with_mass)
{
    const size_t w = walk->chain->width;
    for (size_t i = 0; i < w; i++) {
        const double m = fabs(walk->chain->mass[((size_t)term * w + i) * w + i]);
        walk->mass[i] += n * m;
        if (m > 0 && n > 0) {
            walk->carried[i] += n * log(m);
            with_mass[i] += n;
        }
    }
}

static void add_run(struct rd_walk *walk, const struct rd_stretch *run, bool bends,
                    double *with_mass)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width, block = w * w;
    const size_t e = (size_t)run->element;
    const double n = (double)run->count;
    const double *G = walk->triple + 4 * block * e + block;
    for (size_t i = 0; i < w; i++)
        walk->flexibility[i] += n * fabs(G[i * (w + 1)]);
    add_mass(walk, run->first, 1, with_mass);
    add_mass(walk, run->term, n - 1, with_mass);
    walk->length += n * chain->length[e];
    walk->tension += n * chain->length[e] * chain->tension[e];
    if (bends)
        walk->bend += n * chain->length[e] * chain->flexibility[e * 9 + 8];
}

static void add_runs(struct rd_walk *walk, const int32_t *below)
{
    const struct rd_chain *chain = walk->chain;
    const size_t w = chain->width;
    bool z = false, beta = false;
    for (size_t i = 0; i < w; i++) {
        z = z || chain->coordinate[i] == RD_Z;
        beta = beta || chain->coordinate[i] == RD_BETA;
    }
    double with_mass[RD_WIDTH_MAX] = {0};
    size_t node = 0;
    for (size_t r = 0; r < walk->runs; r++) {
        struct rd_stretch *run = walk->run + r;
        run->node = node;
        run->count = run_length(chain, node);
        run->element = chain->element_of[node];
        run->before = node > 0 ? chain->element_of[node - 1] : -1;
        run->first = chain->term_of[node];
        run->term = chain->term_of[node + (run->count > 1)];
        walk->below += (double)run->count * below[run->element];
        add_run(walk, run, z && beta && chain->kind != RD_DIFFERENCE, with_mass);
        node += run->count;
    }
    add_mass(walk, chain->term_of[node], 1, with_mass);
    for (size_t i = 0; i < w && node > 0; i++)
        walk->carried[i] =
            with_mass[i] > 0 ? with_mass[i] * exp(walk->carried[i] / with_mass[i]) : 0;
    walk->tension /= walk->length;
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
    const size_t terms = chain->terms * chain->width * chain->width;
    return are_finite(chain->distinct, chain->length) &&
           are_finite(chain->distinct, chain->tension) &&
           are_finite(chain->distinct * 9, chain->flexibility) && are_finite(terms, chain->mass) &&
           are_finite(terms, chain->stiffness);
}

enum rd_status rd_walk_fill(const struct rd_chain *chain, struct rd_workspace *workspace,
                            struct rd_walk *walk)
{
    const size_t block = chain->width * chain->width;
    *walk = (struct rd_walk){.chain = chain, .runs = number_of_runs(chain)};
    walk->run = rd_take(workspace, walk->runs, sizeof *walk->run);
    walk->triple = rd_take(workspace, chain->distinct * 4 * block, sizeof *walk->triple);
    walk->strut = rd_take(workspace, chain->distinct, 1);
    int32_t *below = rd_take(workspace, chain->distinct, sizeof *below);
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    if (!is_finite(chain))
        return RD_NOT_POSITIVE_DEFINITE;
    const enum rd_status status = fill_triples(walk, below);
    if (status == RD_OK)
        add_runs(walk, below);
    return status;
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
    size_t iz = 0, ibeta = 0;
    for (size_t i = 0; i < chain->width; i++) {
        const double G = walk->flexibility[i] > 0 ? walk->flexibility[i] : 1;
        const double x = fabs(lambda) * walk->carried[i] * G;
        z[i] = sqrt(G / sqrt(fmax(x, 1)));
        iz = chain->coordinate[i] == RD_Z ? i : iz;
        ibeta = chain->coordinate[i] == RD_BETA ? i : ibeta;
    }
    if (walk->bend > 0)
        bending_scale(walk, fabs(lambda) * walk->carried[iz], z + iz, z + ibeta);
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
