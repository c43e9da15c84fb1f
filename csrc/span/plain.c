/* Plain spans of RD_LANES frequencies, in closed form. */
#include "span/plain.h"

#pragma GCC diagnostic ignored "-Wpsabi"

static RD_CLONES void rod_halves(const cv *soft, const cv *load, const lanes *length,
                                 struct plain_halves *halves)
{
    *halves = plain_halves_of(*soft, *load, *length);
}

static RD_CLONES void bent_halves(const struct wavenumbers *w, const cv *stiff, const lanes *r,
                                  const lanes *length, struct bent_halves *halves)
{
    *halves = bent_halves_of(w, *stiff, *r, *length);
}

static RD_CLONES void rod_span(const cv *soft, const cv *load, const lanes *length,
                               struct plain_span *span)
{
    *span = plain_span_of(*soft, *load, *length);
}

static RD_CLONES void bent_span(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                                struct bent_span *span)
{
    *span = bent_span_of(*soft, load, *r, *length);
}

static RD_CLONES void rod_triple(const cv *soft, const cv *load, const lanes *length,
                                 struct rod_triple *triple)
{
    *triple = rod_triple_of(*soft, *load, *length);
}

static RD_CLONES void bent_triple(const cv *soft, const cv *load, const lanes *r,
                                  const lanes *length, struct bent_triple *triple)
{
    *triple = bent_triple_of(*soft, load, *r, *length);
}

void rd_rod_halves(const cv *soft, const cv *load, const lanes *length, struct plain_halves *halves)
{
    rod_halves(soft, load, length, halves);
}

void rd_bent_halves(const struct wavenumbers *w, const cv *stiff, const lanes *r,
                    const lanes *length, struct bent_halves *halves)
{
    bent_halves(w, stiff, r, length, halves);
}

void rd_rod_span(const cv *soft, const cv *load, const lanes *length, struct plain_span *span)
{
    rod_span(soft, load, length, span);
}

void rd_bent_span(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                  struct bent_span *span)
{
    bent_span(soft, load, r, length, span);
}

void rd_rod_triple(const cv *soft, const cv *load, const lanes *length, struct rod_triple *triple)
{
    rod_triple(soft, load, length, triple);
}

void rd_bent_triple(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                    struct bent_triple *triple)
{
    bent_triple(soft, load, r, length, triple);
}
