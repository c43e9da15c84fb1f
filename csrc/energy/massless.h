/* How the form of massless elements changes with their numbers. */
#ifndef RD_SENSITIVITY_MASSLESS_H
#define RD_SENSITIVITY_MASSLESS_H

#include "element/element.h"
#include "element/rods.h"
#include "energy/property.h"

/* A massless element, see element/element.h for its form, ready to be asked. */
struct rd_massless {
    struct rd_element element;
    struct rd_rods rods;
    double jump[RD_WIDTH_MAX * 2 * RD_WIDTH_MAX]; /* of its hinge, rd_element_jump */
    double bow, bow_slope;   /* 1/tau and its derivative with respect to theta = T S_bb l^2/4 */
    double sway, sway_slope; /* tau/P2 */
};

/* that on the right of the nodes of a stretch */
enum rd_status rd_massless_of(const struct rd_chain *chain, size_t stretch,
                              struct rd_massless *massless);

/* u (2, width), the motion of the nodes, <- that of the element's ends; adds the squares of the
   jumps to jump (width) */
void rd_massless_open(const struct rd_massless *massless, double *u, double *jump);

/* adds dPi/dp of the string in an element, Pi = T (z_b - z_a)^2/l */
void rd_string_slope(const struct rd_element *element, const double *u, double *slope);

/* adds dPi/dp of an element with its ends moved by u (2, width) to slope (RD_PROPERTIES) */
void rd_massless_slope(const struct rd_massless *massless, const double *u, double *slope);

#endif
