/* A march laid out in the caller's memory: factors that stay and arrays that a stage fills. */
#ifndef RD_MARCH_PLAN_H
#define RD_MARCH_PLAN_H

#include "march/form/state.h"
#include "march/kernel/kernel.h"

/* Takes the arrays of a march and finds its resonators; RD_SPREAD_INERTIA where a broken wire is
   carried. What rd_march_factor put there stays. */
enum rd_status rd_march_prepare(const struct rd_chain *chain, const struct rd_beside *beside,
                                const struct rd_laws *laws, struct rd_march *march,
                                struct rd_workspace *workspace);

/* Everything that depends on theta [s] and on the tension `extra` [N]. RD_CRITICAL_ELEMENT,
   RD_NOT_POSITIVE_DEFINITE of an element, RD_SINGULAR, RD_FAST_GROWTH: compression makes motion
   grow by more than 1/theta. */
enum rd_status rd_march_factor(struct rd_march *march, double theta, double extra);

/* the same at another tension */
enum rd_status rd_march_tighten(struct rd_march *march, double extra);

/* Motion into the scales of the march, and back. */
void rd_march_load(struct rd_march *march, const struct rd_motion *motion);
void rd_march_unload(const struct rd_march *march, const struct rd_motion *motion);

/* load (nodes, width) += a force at a port */
void rd_march_push(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                   double force, double *load);

/* displacement of a port from the scaled u (nodes, width) */
double rd_march_read(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                     const double *u);

const struct rd_march_kernel *rd_march_kernel_of(const struct rd_march *march);

#endif
