/* The triple (F, G, Q) of an element, at any complex stiffness and tension. */
#include "element/triple.h"

#include "element/area.h"
#include "element/cantilever.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { W = RD_WIDTH_MAX };

/* whether a coordinate's end force loads its channel by the lever of z */
static const int lever[RD_WIDTH_MAX] = {0, 1, 0, 0};

/* without bending every coordinate is a rod of its own: G_cd = l S_cd, and l/T for z */
static void rods(const struct rd_element *element, double _Complex section, double _Complex tension,
                 double _Complex *G)
{
    const size_t w = element->width;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const int c = rd_channel_of(element->coordinate[i]);
            const int d = rd_channel_of(element->coordinate[j]);
            if (c != RD_BENDING && d != RD_BENDING)
                G[i * w + j] =
                    element->length * element->flexibility[c * RD_CHANNELS + d] / section;
            else if (i == j) {
                assert(element->tension > 0);
                G[i * w + j] = element->length / (element->tension * tension);
            }
        }
}

/* S_cd - S_cb S_bd/S_bb: what of a channel's flexibility is left when the rope does not bend, by a
   difference of products that keeps its digits (Kahan; Jeannerod, Louvet, Muller 2013) */
static double unbent(const double *S, int c, int d)
{
    const double Scb = S[c * RD_CHANNELS + RD_BENDING], Sdb = S[d * RD_CHANNELS + RD_BENDING];
    const double Sbb = S[RD_BENDING * RD_CHANNELS + RD_BENDING];
    const double product = Scb * Sdb;
    const double rounding = fma(-Scb, Sdb, product);
    return (fma(S[c * RD_CHANNELS + d], Sbb, -product) + rounding) / Sbb;
}

static void bend(const struct rd_element *element, double _Complex section, double _Complex tension,
                 double _Complex *D, double _Complex *G, double _Complex *Q)
{
    const size_t w = element->width;
    const double l = element->length;
    const double *S = element->flexibility;
    const double Sbb = S[RD_BENDING * RD_CHANNELS + RD_BENDING];
    const double _Complex theta = element->tension * Sbb * l * l * tension / section;
    const struct rd_cantilever shape = rd_cantilever_at(element->kind, theta);
    const double reach[3] = {l, l * l, l * l * l};
    const size_t beta = w - 1;
    for (size_t i = 0; i < w; i++) {
        const int c = rd_channel_of(element->coordinate[i]);
        const double ri = c == RD_BENDING ? 1 : S[c * RD_CHANNELS + RD_BENDING] / Sbb;
        for (size_t j = 0; j < w; j++) {
            const int d = rd_channel_of(element->coordinate[j]);
            const double rj = d == RD_BENDING ? 1 : S[d * RD_CHANNELS + RD_BENDING] / Sbb;
            const int k = lever[element->coordinate[i]] + lever[element->coordinate[j]];
            if (c != RD_BENDING && d != RD_BENDING)
                G[i * w + j] = l * (unbent(S, c, d) + ri * rj * Sbb * shape.P[0]) / section;
            else
                G[i * w + j] = ri * rj * Sbb * reach[k] * shape.P[k] / section;
        }
        if (lever[element->coordinate[i]])
            D[i * w + beta] = l * shape.tau;
        else
            D[i * w + beta] = -ri * theta * shape.P[1];
    }
    Q[beta * w + beta] = element->tension * tension * l * shape.tau;
}

/* adds w/T times the area under z to x, see element/triple.h */
static void hang(const struct rd_element *element, double _Complex section, double _Complex tension,
                 double _Complex *D, double _Complex *G)
{
    enum { X, Z };
    const size_t w = element->width;
    const double l = element->length, sag = element->sag;
    const double *S = element->flexibility;
    const double Sbb = S[RD_BENDING * RD_CHANNELS + RD_BENDING];
    D[Z] = sag * l;
    if (rd_element_find(element, RD_BETA) == w) {
        const double _Complex slack = l / (element->tension * tension);
        G[Z] = G[w] = sag * l * slack / 2;
        G[X] += sag * sag * l * l * slack / 3;
        return;
    }
    const struct rd_area area =
        rd_area_at(element->kind, element->tension * Sbb * l * l * tension / section);
    const double _Complex soft = sag * Sbb * l * l * l / section;
    for (size_t j = 0; j < w; j++) {
        const int d = rd_channel_of(element->coordinate[j]);
        const double r = d == RD_BENDING ? 1 : S[d * RD_CHANNELS + RD_BENDING] / Sbb;
        const double _Complex g = j == Z ? l * soft * area.P[1] : r * soft * area.P[0];
        G[j] += g;
        G[j * w] += g;
    }
    G[X] += sag * l * l * soft * area.P[2];
    D[w - 1] += sag * l * l * area.lean;
}

/* D = F - I, G, Q */
static enum rd_status fill(const struct rd_element *element, double _Complex section,
                           double _Complex tension, double _Complex *D, double _Complex *G,
                           double _Complex *Q)
{
    const size_t w = element->width;
    for (size_t i = 0; i < w * w; i++)
        D[i] = G[i] = Q[i] = 0;
    if (rd_element_find(element, RD_BETA) == w) {
        rods(element, section, tension, G);
        if (element->sag != 0)
            hang(element, section, tension, D, G);
        return RD_OK;
    }
    bend(element, section, tension, D, G, Q);
    if (element->sag != 0)
        hang(element, section, tension, D, G);
    for (size_t i = 0; i < w * w; i++)
        if (!isfinite(creal(G[i])) || !isfinite(cimag(G[i])))
            return RD_CRITICAL_ELEMENT;
    return RD_OK;
}

enum rd_status rd_triple(const struct rd_element *element, double _Complex section,
                         double _Complex tension, double _Complex *F, double _Complex *G,
                         double _Complex *Q)
{
    const enum rd_status status = fill(element, section, tension, F, G, Q);
    for (size_t i = 0; i < element->width; i++)
        F[i * (element->width + 1)] += 1;
    return status;
}

enum rd_status rd_triple_change(const struct rd_element *element, double *D, double *G, double *Q)
{
    const size_t block = element->width * element->width;
    double _Complex Dc[W * W], Gc[W * W], Qc[W * W];
    const enum rd_status status = fill(element, 1, 1, Dc, Gc, Qc);
    for (size_t i = 0; i < block; i++) {
        D[i] = creal(Dc[i]);
        G[i] = creal(Gc[i]);
        Q[i] = creal(Qc[i]);
    }
    return status;
}

enum rd_status rd_triple_real(const struct rd_element *element, double *F, double *G, double *Q)
{
    const enum rd_status status = rd_triple_change(element, F, G, Q);
    for (size_t i = 0; i < element->width; i++)
        F[i * (element->width + 1)] += 1;
    return status;
}
