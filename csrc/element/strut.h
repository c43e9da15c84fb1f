/* The transfer of a strongly compressed element, without the poles of its cantilever. */
#ifndef RD_STRUT_H
#define RD_STRUT_H

#include "element/element.h"

#include <stdbool.h>

/* Whether an element bends and its compression exceeds S_bb^-1/l^2, 0.4 of the critical load of its
   cantilever. */
bool rd_element_is_strut(const struct rd_element *element);

/* The triple of such an element has a pole at the critical load of its cantilever, which the chain
   has not. Here a part P of the assembled element's K_bb is left to the node on its right, so that
   what remains there is the untensed G^-1:

       u_b = F u_a + G (f_b - P u_b),   f_a = F^T (f_b - P u_b) - Q u_a
       F = -G K_ba,  P = K_bb - G^-1,  Q = K_aa - K_ab G K_ba

   D = F - I, G, Q, P (width, width).
   RD_CRITICAL_ELEMENT: the compression is the critical load of the element with both ends clamped. */
enum rd_status rd_strut_fill(const struct rd_element *element, double *D, double *G, double *Q,
                             double *P);

#endif
