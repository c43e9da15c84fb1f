/* How the form of a mode changes with the numbers of each stretch. */
#ifndef RD_SENSITIVITY_H
#define RD_SENSITIVITY_H

#include "energy/massless.h"
#include "energy/span.h"

#include <stdbool.h>

/* A mode u with its eigenvalue lambda makes Pi = u^T (K - lambda M) u stationary, the motion inside
   elements and hinges too, so that with any number p of the chain

       dlambda/dp = dPi/dp at a fixed shape / (u^T M u)

   For a shape (nodes, width), stretch after stretch; several of them may share one of these. */
struct rd_sensitivity {
    const struct rd_chain *chain;
    double lambda;
    bool waves; /* elements are stepped along: continuous ones, and those that hang */
    union {
        struct rd_massless massless;
        struct rd_wave_slopes span;
    } of;
};

void rd_sensitivity_begin(const struct rd_chain *chain, double lambda,
                          struct rd_sensitivity *sensitivity);

/* slope (RD_PROPERTIES) <- dPi/dp summed over the elements of a stretch, jump (width) <- the sum of
   the squares by which its hinges open: dPi/d(stiffness of the hinge).
   RD_NOT_POSITIVE_DEFINITE, RD_CRITICAL_ELEMENT: as rd_element_matrix; the first also where a
   continuous element is longer than its first resonance as a cantilever. */
enum rd_status rd_sensitivity_stretch(struct rd_sensitivity *sensitivity, size_t stretch,
                                      const double *shape, double *slope, double *jump);

/* dyad (width, width) <- the sum of u u^T over the nodes of a stretch: dPi/dK and
   -dPi/d(lambda M) of its node term */
void rd_sensitivity_nodes(const struct rd_chain *chain, size_t stretch, const double *shape,
                          double *dyad);

#endif
