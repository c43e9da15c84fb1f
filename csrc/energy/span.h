/* How the form of continuous elements, and of massless ones that hang, changes with their numbers. */
#ifndef RD_SENSITIVITY_SPAN_H
#define RD_SENSITIVITY_SPAN_H

#include "base/status.h"
#include "energy/lines.h"
#include "energy/moved.h"
#include "energy/property.h"
#include "span/rate_matrix.h"

enum { RD_STATE_MAX = 2 * RD_WIDTH_MAX };

/* The integral of row i times row j of y = (u, f) along an element, as a form of (u_a, f_b). */
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

/* An element at some lines, ready to be asked; of a rigid one that bends without its string. */
struct rd_wave_slopes {
    const struct rd_chain *chain;
    size_t element; /* which distinct one; `distinct` before the first */
    struct rate_matrix rate;
    cv D[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* F - I */
    cv Q[RD_WIDTH_MAX * RD_WIDTH_MAX];
    cv stiff[RD_WIDTH_MAX * RD_WIDTH_MAX]; /* G^-1 */
    size_t forms, numbers;
    struct rd_wave_form form[RD_PROPERTIES];     /* (forms) */
    struct rd_wave_number number[RD_PROPERTIES]; /* (numbers) */
};

/* RD_NOT_POSITIVE_DEFINITE where G is not: the element is longer than its first resonance as a
   cantilever, which the joints of its halves meet. Where it is damped that is not seen. */
enum rd_status rd_wave_slopes_of(const struct rd_chain *chain, size_t e,
                                 const struct rd_lines *lines, struct rd_wave_slopes *slopes);

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
