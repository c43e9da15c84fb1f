/* The forces and the tension of a stage that depend on its own motion. */
#ifndef RD_MARCH_SETTLE_H
#define RD_MARCH_SETTLE_H

#include "march/plan.h"

/* The stage as it is, in lean: with the forces of the laws, and where motion stretches the rope
   with the tension that this makes, beside `extra` [N] from outside. RD_NO_CONVERGENCE with the
   relative residual that is left. */
enum rd_status rd_march_settle(struct rd_march *march, const struct rd_push *push, double extra,
                               double *residual);

/* half the sum of (z_b - z_a)^2/l over the elements [m], of the product of u and v */
double rd_march_lengthening(const struct rd_march *march, const double *u, const double *v);

#endif
