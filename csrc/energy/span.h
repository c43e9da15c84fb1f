/* How the form of continuous elements, and of massless ones that hang, changes with their numbers. */
#ifndef RD_SENSITIVITY_SPAN_H
#define RD_SENSITIVITY_SPAN_H

#include "base/status.h"
#include "energy/lines.h"
#include "energy/moved.h"
#include "energy/property.h"
#include "span/rate_matrix.h"

#include <stdbool.h>

enum { RD_STATE_MAX = 2 * RD_WIDTH_MAX };

/* The integral of row i times row j of y = (u, f) along an element, as a form of (u_a, f_b), or of
   the waves that come in at both ends. */
struct rd_wave_form {
    size_t i, j;
    cv form[RD_STATE_MAX * RD_STATE_MAX]; /* (2 width, 2 width) symmetric */
};

/* One number of an element: dPi/dp is a factor times a form. */
struct rd_wave_number {
    size_t property; /* enum rd_property */
    size_t form;
    cv factor;
};

/* Waves a in, b out: u = z (a + b), f = i (a - b)/z at the right and i (b - a)/z at the left end. */
struct rd_scattering {
    lanes z[RD_WIDTH_MAX];
    cv S11[RD_WIDTH_MAX * RD_WIDTH_MAX], S12[RD_WIDTH_MAX * RD_WIDTH_MAX];
    cv S21[RD_WIDTH_MAX * RD_WIDTH_MAX], S22[RD_WIDTH_MAX * RD_WIDTH_MAX];
    cv enter[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* a_L by the motion of the left node, hinged or not */
};

/* An element at some lines, ready to be asked; of a rigid one that bends without its string. */
struct rd_wave_slopes {
    const struct rd_chain *chain;
    size_t element; /* which distinct one; `distinct` before the first */
    struct rate_matrix rate;
    cv D[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* F - I */
    cv Q[RD_WIDTH_MAX * RD_WIDTH_MAX];
    cv stiff[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* G^-1 */
    struct rd_scattering waves;            /* in place of D, Q, stiff where forces are told */
    size_t forms, numbers;
    struct rd_wave_form form[RD_PROPERTIES];     /* (forms) */
    struct rd_wave_number number[RD_PROPERTIES]; /* (numbers) */
};

/* Where forces are told the halves of an element are joined by the waves between them, which meet no
   resonance. Else RD_INDEFINITE_ELEMENT where G is not: the element is longer than its first
   resonance as a cantilever. Where it is damped that is not seen. */
enum rd_status rd_wave_slopes_of(const struct rd_chain *chain, size_t e,
                                 const struct rd_lines *lines, bool forces,
                                 struct rd_wave_slopes *slopes);

/* With forces: hinges of compliances `hinge` (width) or NULL on its left from now on; and all of
   `moved` from u, the motion of the nodes, and the force on the right end. */
void rd_wave_slopes_hinge(struct rd_wave_slopes *slopes, const double *hinge, cv spring);
void rd_wave_slopes_scatter(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                            struct rd_moved *moved);

/* opens hinges of compliances `hinge` (width) or NULL of an element whose nodes move by moved->u */
void rd_wave_slopes_open(const struct rd_wave_slopes *slopes, const double *hinge, cv spring,
                         struct rd_moved *moved);

/* the rest of `moved` from its u */
void rd_wave_slopes_move(const struct rd_wave_slopes *slopes, struct rd_moved *moved);

/* adds dPi/dp of the bilinear form of two motions to slope (RD_PROPERTIES), p being S/section,
   T tension, and inertia and drag together */
void rd_wave_slopes_add(const struct rd_wave_slopes *slopes, const struct rd_moved *a,
                        const struct rd_moved *b, cv *slope);

#endif
