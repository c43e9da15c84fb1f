/* A continuous span: how short the pieces are whose transfer is summed as a series. */
#ifndef RD_SPAN_H
#define RD_SPAN_H

#include "chain/chain.h"

/* Rope between two nodes, in magnitudes: what sets its wavenumbers. */
struct rd_span {
    size_t width;
    const int32_t *coordinate; /* (width) */
    const double *flexibility; /* (3, 3) S, to be divided by section */
    double section;            /* |factor of the sections| */
    double tension;            /* |T| [N] */
    double load[RD_WIDTH_MAX]; /* (width) of |lambda| inertia and |s| drag per length [N/m^2, N] */
};

/* that of distinct continuous element e, with sizes of the factors on sections, tension,
   inertia and drag */
struct rd_span rd_span_of(const struct rd_chain *chain, size_t e, double section, double tension,
                          double inertia, double dashpot);

/* whether the coordinates of distinct continuous element e know nothing of each other but that z turns
   with beta: then the whole of it is known in closed form (span/whole.h) */
_Bool rd_span_is_plain(const struct rd_chain *chain, size_t e);

/* A bound of the largest wavenumber [1/m], evanescent ones included: with h = (T + lambda j) S_bb/2

       a^2 = h + sqrt(h^2 + lambda mu S_bb) + lambda (mu S_aa + p S_tt)

   twice that where bending, twist and stretch are coupled. */
double rd_span_wavenumber(const struct rd_span *span);

/* How often each of `count` spans of so many radians is halved until a piece has one of them, at most
   RD_HALVINGS_MOST times and so that all pieces can be counted. */
int rd_span_halvings(double radians, size_t count);

/* RD_PIECES_MOST: of one span that are walked one after another */
enum { RD_HALVINGS_MOST = 60, RD_SLICE_TERMS = 24, RD_PIECES_MOST = 10000000 };

/* terms of the exponential series of a piece of so many radians, for all digits of all entries */
int rd_span_terms(double radians);

#endif
