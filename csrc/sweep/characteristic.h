/* The characteristic function of a chain: an analytic function that vanishes at its eigenvalues. */
#ifndef RD_CHARACTERISTIC_H
#define RD_CHARACTERISTIC_H

#include "base/status.h"
#include "base/workspace.h"
#include "sweep/scale.h"

struct rd_characteristic;

/* With motion Re(.. e^{s t}) and the factors at s (section 1 + s gamma, inertia s^2, dashpot s, ..)

       Delta(s) = value exp(magnitude),  |value| <= 1

   is real for real factors and has the multiplicity of each eigenvalue, the freedom of structures that
   nodes carry included: their e (chain/attached.h) are among its factors. It is analytic while
   pieces are below their first cantilever resonance, and no element has one, as `bound` says: one
   set of factors, the least |section| and the largest of the others that a search meets. It sets
   the pieces, so all that is compared must have the same.

   NULL: the workspace measures or is too small. */
struct rd_characteristic *rd_characteristic_take(const struct rd_chain *chain,
                                                 const struct rd_factors *bound,
                                                 struct rd_workspace *workspace);

/* Up to RD_LANES values side by side, as long to walk as one.

       value (count) complex      of the order of its rounding, eps sqrt(steps), at a root
       magnitude (count)

   RD_SHORT_WAVES: a span has more pieces than are walked (span/span.h). */
enum rd_status rd_characteristic_at(struct rd_characteristic *c, const struct rd_factors *factors,
                                    double *value, double *magnitude);

/* pieces that the last walk crossed */
size_t rd_characteristic_steps(const struct rd_characteristic *c);

#endif
