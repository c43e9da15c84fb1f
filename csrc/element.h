/* Elements: massless pieces of rope between two nodes. */
#ifndef RD_ELEMENT_H
#define RD_ELEMENT_H

#include "chain.h"
#include "status.h"

#include <stdbool.h>

/* One element of a chain: its kind, its coordinates and the numbers of its piece of rope. */
struct rd_element {
    enum rd_kind kind;
    size_t width;
    const int32_t *coordinate; /* (width) */
    double length;             /* [m] */
    double tension;            /* [N] */
    const double *flexibility; /* (3, 3) S */
};

/* the distinct element i of a chain */
struct rd_element rd_chain_element(const struct rd_chain *chain, size_t i);

/* The assembled element over (u_a, u_b), its elastic and its tension part apart:
   elastic, tension (2 width, 2 width). A tensed element that bends has both in `elastic`.
   RD_NOT_POSITIVE_DEFINITE where G is not, RD_CRITICAL_ELEMENT where compression makes it so. */
enum rd_status rd_element_stiffness(const struct rd_element *element, double *elastic,
                                    double *tension);

/* The untensed element's F and G^-1: its end force is G^-1 (u_b - F u_a). False where G is not
   positive definite. */
bool rd_element_grip(const struct rd_element *element, double *F, double *inverse);

/* The element's static shape: u(s) = shape (u_a, u_b) at the distance s from its left node,
   shape (width, 2 width). */
enum rd_status rd_element_shape(const struct rd_element *element, double s, double *shape);

/* Displacement at s per force at p with both nodes held: local (width, width). */
enum rd_status rd_element_local(const struct rd_element *element, double s, double p,
                                double *local);

#endif
