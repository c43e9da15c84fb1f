/* A continuous span: how short the pieces are whose transfer is summed as a series. */
#include "span/span.h"

#include <math.h>

/* radians of a piece: beyond it more terms cost what another doubling does */
static const double REACH = 1;

/* the entries of the series begin with its power 3 at the latest: so many more terms */
enum { LEADING = 3 };

static const double NEGLIGIBLE = 1e-18;

struct rd_span rd_span_of(const struct rd_chain *chain, size_t e, double section, double tension,
                          double inertia, double dashpot)
{
    struct rd_span span = {
        .width = chain->width,
        .coordinate = chain->coordinate,
        .flexibility = chain->flexibility + e * RD_CHANNELS * RD_CHANNELS,
        .section = section,
        .tension = fabs(chain->tension[e]) * tension,
    };
    for (size_t i = 0; i < chain->width; i++)
        span.load[i] = inertia * chain->inertia[e * chain->width + i] +
                       (chain->drag ? dashpot * chain->drag[e * chain->width + i] : 0);
    return span;
}

static int is_coupled(const double *S)
{
    return S[RD_AXIAL * RD_CHANNELS + RD_TORSION] != 0 ||
           S[RD_AXIAL * RD_CHANNELS + RD_BENDING] != 0 ||
           S[RD_TORSION * RD_CHANNELS + RD_BENDING] != 0;
}

_Bool rd_span_is_plain(const struct rd_chain *chain, size_t e)
{
    return chain->inertia && !chain->sag && !(chain->rise && chain->rise[e] != 0) &&
           !is_coupled(chain->flexibility + e * RD_CHANNELS * RD_CHANNELS);
}

double rd_span_wavenumber(const struct rd_span *span)
{
    const size_t w = span->width;
    const double *S = span->flexibility;
    const double Sbb = S[RD_BENDING * (RD_CHANNELS + 1)] / span->section;
    const int bends = span->coordinate[w - 1] == RD_BETA;
    double square = 0;
    for (size_t i = 0; i < w; i++) {
        const double load = span->load[i];
        if (span->coordinate[i] == RD_Z) {
            const double h = bends ? 0.5 * (span->tension + span->load[w - 1]) * Sbb : 0;
            square += bends ? h + sqrt(h * h + load * Sbb) : load / span->tension;
        } else if (span->coordinate[i] != RD_BETA) {
            const size_t c = span->coordinate[i] == RD_X ? RD_AXIAL : RD_TORSION;
            square += load * S[c * (RD_CHANNELS + 1)] / span->section;
        }
    }
    return sqrt(is_coupled(S) ? 2 * square : square);
}

int rd_span_halvings(double radians, size_t count)
{
    if (!(radians > REACH))
        return 0;
    int exponent = RD_HALVINGS_MOST;
    if (radians < REACH * 0x1p60)
        frexp(radians / REACH, &exponent); /* radians < REACH 2^exponent */
    while (count << exponent >> exponent != count)
        exponent--;
    return exponent;
}

int rd_span_terms(double radians)
{
    double term = 1;
    int m = 1;
    while (m + LEADING < RD_SLICE_TERMS && term > NEGLIGIBLE)
        term *= radians / m++;
    return m + LEADING < RD_SLICE_TERMS ? m + LEADING : RD_SLICE_TERMS;
}
