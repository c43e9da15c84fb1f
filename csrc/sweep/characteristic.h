/* The characteristic function of a chain: an analytic function that vanishes at its eigenvalues. */
#ifndef RD_CHARACTERISTIC_H
#define RD_CHARACTERISTIC_H

#include "base/status.h"
#include "base/workspace.h"
#include "sweep/scale.h"

/* With motion Re(.. e^{s t}) and the factors at s (section 1 + s gamma, inertia s^2, dashpot s, ..)

       Delta(s) = value exp(magnitude),  |value| <= 1

   is real for real factors and has the multiplicity of each eigenvalue, the freedom of structures that
   nodes carry included: their e (chain/attached.h) are among its factors. It is analytic while
   pieces are below their first cantilever resonance, and no element has one, as `bound` says: one
   set of factors, the least |section| and the largest of the others that a search meets. It sets
   the pieces, so all that is compared must have the same.

       value (count) complex      of the order of its rounding, eps sqrt(*steps), at a root
       magnitude (count)
       steps                      pieces walked

   RD_NO_MEMORY: the workspace measures too small (base NULL: `used` says what is needed).
   RD_SHORT_WAVES: a span has more pieces than are walked (span/span.h). */
enum rd_status rd_characteristic(const struct rd_chain *chain, const struct rd_factors *factors,
                                 const struct rd_factors *bound, struct rd_workspace *workspace,
                                 double *value, double *magnitude, size_t *steps);

#endif
