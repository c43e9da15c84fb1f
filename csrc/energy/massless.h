/* How the form of massless elements changes with their numbers. */
#ifndef RD_SENSITIVITY_MASSLESS_H
#define RD_SENSITIVITY_MASSLESS_H

#include "base/status.h"
#include "element/element.h"
#include "element/rods.h"
#include "energy/lines.h"
#include "energy/moved.h"
#include "energy/property.h"

/* A massless element of sections S/section and tension T tension, ready to be asked. */
struct rd_massless {
    struct rd_element element;
    struct rd_rods rods;                  /* of S */
    cv section, tension;                  /* factors */
    cv theta;                             /* T S_bb l^2/4, of the halves */
    cv bow, bow_slope;                    /* 1/tau and its derivative with respect to theta */
    cv sway, sway_slope;                  /* tau/P2 */
    cv near[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* where it is hinged: its stiffness without, of the */
    cv far[RD_WIDTH_MAX * RD_WIDTH_MAX];  /* left end by the motion of the left and the right one */
};

/* that on the right of the nodes of a stretch. RD_NOT_POSITIVE_DEFINITE, RD_CRITICAL_ELEMENT: as
   rd_element_matrix */
enum rd_status rd_massless_of(const struct rd_chain *chain, size_t stretch,
                              const struct rd_lines *lines, struct rd_massless *massless);

/* opens the hinges of an element whose nodes move by moved->u */
void rd_massless_open(const struct rd_massless *massless, const cv spring, struct rd_moved *moved);

/* the rest of `moved` from its u */
void rd_massless_move(const struct rd_massless *massless, struct rd_moved *moved);

/* adds dPi/dp of the string in an element, Pi = T (z_b - z_a)^2/l */
void rd_string_slope(const struct rd_element *element, cv tension, const struct rd_moved *a,
                     const struct rd_moved *b, cv *slope);

/* adds dPi/dp of the bilinear form of two motions to slope (RD_PROPERTIES), p being S/section and
   T tension */
void rd_massless_slope(const struct rd_massless *massless, const struct rd_moved *a,
                       const struct rd_moved *b, cv *slope);

#endif
