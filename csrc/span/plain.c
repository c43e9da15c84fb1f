/* Plain spans of RD_LANES frequencies, in closed form. */
#include "span/plain.h"

#pragma GCC diagnostic ignored "-Wpsabi"

RD_CLONES void rd_rod_halves(const cv *soft, const cv *load, const lanes *length,
                             struct plain_halves *halves)
{
    *halves = plain_halves_of(*soft, *load, *length);
}

RD_CLONES void rd_bent_halves(const struct wavenumbers *w, const cv *stiff, const lanes *r,
                              const lanes *length, struct bent_halves *halves)
{
    *halves = bent_halves_of(w, *stiff, *r, *length);
}

RD_CLONES void rd_rod_span(const cv *soft, const cv *load, const lanes *length,
                           struct plain_span *span)
{
    *span = plain_span_of(*soft, *load, *length);
}

RD_CLONES void rd_bent_span(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                            struct bent_span *span)
{
    *span = bent_span_of(*soft, load, *r, *length);
}

RD_CLONES void rd_rod_triple(const cv *soft, const cv *load, const lanes *length,
                             struct rod_triple *triple)
{
    *triple = rod_triple_of(*soft, *load, *length);
}

RD_CLONES void rd_bent_triple(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                              struct bent_triple *triple)
{
    *triple = bent_triple_of(*soft, load, *r, *length);
}
