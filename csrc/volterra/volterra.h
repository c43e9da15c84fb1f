/* Forces of laws at points of a linear system by Volterra's equation. */
#ifndef RD_VOLTERRA_H
#define RD_VOLTERRA_H

#include <stddef.h>

#include "base/status.h"
#include "law/step.h"

/* In step n, of length h, the forces f_n are constant: with the step responses S of the points

       u_(n+1) = linear_(n+1) + sum over m <= n of (S((n+1-m) h) - S((n-m) h)) f_m,

   and a law sees the mean of u_n and u_(n+1), and (u_(n+1) - u_n)/h: what holds does not creep. */
struct rd_volterra {
    struct rd_laws laws; /* points.count laws; those of RD_GIVEN are what `call` says       */
    rd_law_call *call;
    void *context;
    size_t steps;         /* in all                                                          */
    double begin;         /* [s]                                                             */
    double h;             /* [s]                                                             */
    const double *kernel; /* (laws, laws, steps) S((steps - k) h) - S((steps - k - 1) h) of a
                             point, of a force at another                                    */
    const double *linear; /* (laws, steps + 1) how the points move without the laws          */
};

struct rd_volterra_run {
    double *force;   /* (laws, steps)                                 */
    double *motion;  /* (laws, steps + 1); the first column is given  */
    double *size;    /* (laws,) largest forces so far; goes on        */
    size_t made;     /* steps that hold                               */
    double residual; /* of the last one                               */
};

/* Take steps from run->made to `until`. RD_OK; RD_NO_CONVERGENCE: the next step does not hold;
   RD_INTERRUPTED: a law failed in it. Of `step` only the work need be laid out. */
enum rd_status rd_volterra_run(const struct rd_volterra *system, size_t until,
                               struct rd_law_step *step, struct rd_volterra_run *run);

#endif
