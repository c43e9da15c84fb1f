/* Stiffness and static shapes of an element between two nodes. */
#ifndef RD_STIFFNESS_H
#define RD_STIFFNESS_H

#include "base/complex.h"
#include "base/status.h"
#include "element/element.h"

/* K_e = [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] of the triple (see element/triple.h), over
   the motion (u_a, u_b) of the nodes: K (2 width, 2 width), with sections, tension and the spring
   in a hinge times complex factors. It exists where the triple does not, at the critical load of
   the cantilever. RD_NOT_POSITIVE_DEFINITE where a section would create energy, RD_CRITICAL_ELEMENT
   at the critical load of the element held at both ends. */
enum rd_status rd_element_matrix(const struct rd_element *element, double _Complex section,
                                 double _Complex tension, double _Complex spring,
                                 double _Complex *K);

/* The same with factors 1, its elastic and its tension part apart. A tensed element that bends has
   both in `elastic`. */
enum rd_status rd_element_stiffness(const struct rd_element *element, double *elastic,
                                    double *tension);

/* The element's static shape: u(s) = shape (u_a, u_b) at the distance s from its left node,
   shape (width, 2 width). */
enum rd_status rd_element_shape(const struct rd_element *element, double s, double *shape);

/* Displacement at s per force at p with both nodes held: local (width, width). */
enum rd_status rd_element_local(const struct rd_element *element, double s, double p,
                                double *local);

#endif
