/* Elements: massless pieces of rope between two nodes. */
#ifndef RD_ELEMENT_H
#define RD_ELEMENT_H

#include "chain.h"
#include "status.h"

#include <complex.h>
#include <stdbool.h>

/* One element of a chain: its kind, its coordinates and the numbers of its piece of rope. */
struct rd_element {
    enum rd_kind kind;
    size_t width;
    const int32_t *coordinate; /* (width) */
    double length;             /* [m] */
    double tension;            /* [N] */
    double sag;                /* w/T [1/m] of rope that hangs, else 0; x and z come first */
    const double *flexibility; /* (3, 3) S */
    const double *hinge; /* (width) compliance between the left node and the element, or NULL */
};

/* index of a coordinate in the element, or its width where absent */
static inline size_t rd_element_find(const struct rd_element *element, enum rd_coordinate sought)
{
    return rd_coordinate_find(element->width, element->coordinate, sought);
}

/* the distinct element i of a chain, without a hinge */
struct rd_element rd_chain_element(const struct rd_chain *chain, size_t i);

/* the element on the right of each node of a stretch, with the hinge between them */
struct rd_element rd_chain_span(const struct rd_chain *chain, size_t stretch);

/* whether nodes with this term have one */
bool rd_chain_is_hinged(const struct rd_chain *chain, int32_t term);

/* K_e = [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] of the triple (see triple.h), over the motion
   (u_a, u_b) of the nodes: K (2 width, 2 width), with sections, tension and the spring in a hinge
   times complex factors. It exists where the triple does not, at the critical load of the
   cantilever. RD_NOT_POSITIVE_DEFINITE where a section would create energy, RD_CRITICAL_ELEMENT at
   the critical load of the element held at both ends. */
enum rd_status rd_element_matrix(const struct rd_element *element, double _Complex section,
                                 double _Complex tension, double _Complex spring,
                                 double _Complex *K);

/* The same with factors 1, its elastic and its tension part apart. A tensed element that bends has
   both in `elastic`. */
enum rd_status rd_element_stiffness(const struct rd_element *element, double *elastic,
                                    double *tension);

/* how far the hinge opens: the element's left end moves by u_a + jump (u_a, u_b),
   jump (width, 2 width) */
enum rd_status rd_element_jump(const struct rd_element *element, double *jump);

/* The element's static shape: u(s) = shape (u_a, u_b) at the distance s from its left node,
   shape (width, 2 width). */
enum rd_status rd_element_shape(const struct rd_element *element, double s, double *shape);

/* Displacement at s per force at p with both nodes held: local (width, width). */
enum rd_status rd_element_local(const struct rd_element *element, double s, double p,
                                double *local);

#endif
