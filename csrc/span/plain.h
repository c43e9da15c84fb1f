/* Plain spans (span/span.h) of RD_LANES frequencies, in closed form: compiled once for all widths. */
#ifndef RD_PLAIN_H
#define RD_PLAIN_H

#include "span/whole.h"

/* One coordinate, or z with beta, in units of the rate matrix: soft = S', load = q, r = Phi_z,beta. */
void rd_rod_halves(const cv *soft, const cv *load, const lanes *length,
                   struct plain_halves *halves);
void rd_bent_halves(const struct wavenumbers *w, const cv *stiff, const lanes *r,
                    const lanes *length, struct bent_halves *halves);

void rd_rod_span(const cv *soft, const cv *load, const lanes *length, struct plain_span *span);
void rd_bent_span(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                  struct bent_span *span);

void rd_rod_triple(const cv *soft, const cv *load, const lanes *length, struct rod_triple *triple);
void rd_bent_triple(const cv *soft, const cv *load, const lanes *r, const lanes *length,
                    struct bent_triple *triple);

#endif
