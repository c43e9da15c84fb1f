/* Steps one after another. */
#ifndef RD_MARCH_RUN_H
#define RD_MARCH_RUN_H

#include "base/stop.h"
#include "march/plan.h"

/* Steps from the start of the march, which is then where they lead; how many were made. *status is
   RD_OK after all of them, else what stopped the next one: RD_NO_CONVERGENCE with steps->residual,
   as rd_march_tighten, or RD_INTERRUPTED. push has the places; its numbers are taken from the steps. */
size_t rd_march_run(struct rd_march *march, const struct rd_push *push,
                    const struct rd_ports *responses, struct rd_steps *steps,
                    const struct rd_stop *stop, enum rd_status *status);

#endif
