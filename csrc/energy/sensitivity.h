/* How the form of two motions changes with the numbers of each stretch. */
#ifndef RD_SENSITIVITY_H
#define RD_SENSITIVITY_H

#include "base/workspace.h"
#include "energy/lines.h"
#include "energy/massless.h"
#include "energy/place.h"
#include "energy/span.h"

#include <stdbool.h>

/* A mode u with its eigenvalue lambda makes Pi = u^T (K - lambda M) u stationary, the motion inside
   elements and hinges too, so that with any number p of the chain

       dlambda/dp = dPi/dp at a fixed shape / (u^T M u)

   Two responses u_d, u_r to unit loads, of which Z u_d = e_d and h = e_r^T u_d, have

       dh/dp = -u_r^T (dZ/dp) u_d = -dPi/dp of the bilinear form at fixed motion of the nodes

   Stretch after stretch; several of them may share one of these. */
struct rd_sensitivity {
    const struct rd_chain *chain;
    const struct rd_lines *lines;
    const struct rd_fields *fields;
    struct rd_moved *moved;  /* (loads) */
    struct rd_kink *kink;    /* (loads) at the node where the stretch begins */
    struct rate_matrix left; /* of the stretch before it */
    bool waves;              /* elements are stepped along: continuous ones, and those that hang */
    union {
        struct rd_massless massless;
        struct rd_wave_slopes span;
    } of;
};

/* takes what the loads need from a workspace, false where it is too small or measures */
bool rd_sensitivity_prepare(const struct rd_chain *chain, const struct rd_fields *fields,
                            struct rd_sensitivity *sensitivity, struct rd_workspace *workspace);

/* turns to other lines */
void rd_sensitivity_begin(struct rd_sensitivity *sensitivity, const struct rd_lines *lines);

/* For each pair of loads slope (pairs, RD_PROPERTIES) <- dPi/dp summed over the elements of a
   stretch, jump (pairs, width) <- the sum of the products by which its hinges open:
   dPi/d(spring stiffness of the hinge). place (pairs), or NULL: of continuous elements, whose
   stretches come in order, dPi/dx of the node where the stretch begins; 0 of the first.
   RD_NOT_POSITIVE_DEFINITE, RD_CRITICAL_ELEMENT: as rd_element_matrix; RD_INDEFINITE_ELEMENT where a
   continuous element without forces is longer than its first resonance as a cantilever and nothing
   is damped. */
enum rd_status rd_sensitivity_stretch(struct rd_sensitivity *sensitivity, size_t stretch,
                                      const struct rd_pairs *pairs, cv *slope, cv *jump,
                                      struct rd_place *place);

/* place (pairs) <- dPi/dx of the last node, after the last stretch, by its slope (pairs,
   RD_PROPERTIES); 0 of massless elements */
void rd_sensitivity_last(const struct rd_sensitivity *sensitivity, const struct rd_pairs *pairs,
                         const cv *slope, struct rd_place *place);

/* dyad (pairs, width, width) <- the sum of u u^T over the nodes of a stretch: dPi/dK and
   dPi/d(inertia M) of its node term; 0 inside continuous spans, where nothing stands */
void rd_sensitivity_nodes(const struct rd_sensitivity *sensitivity, size_t stretch,
                          const struct rd_pairs *pairs, cv *dyad);

#endif
