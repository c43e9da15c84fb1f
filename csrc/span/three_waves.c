/* Spans of three coordinates in closed form, compiled once. */

#include "span/three_waves.h"

#pragma GCC diagnostic ignored "-Wpsabi"

static RD_CLONES void three_span(const struct rate_matrix *rate, const lanes *length,
                                 struct three_span *span)
{
    three_span_of(rate, *length, span);
}

void rd_three_span(const struct rate_matrix *rate, const lanes *length, struct three_span *span)
{
    three_span(rate, length, span);
}
