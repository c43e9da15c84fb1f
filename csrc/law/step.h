/* Forces of laws in one step, constant in it, whatever moves their points. */
#ifndef RD_LAW_STEP_H
#define RD_LAW_STEP_H

#include "base/status.h"
#include "base/workspace.h"
#include "law/law.h"

/* A law sees the mean of the displacements at both ends of the step, start + x with
   x = lean + C force, and the velocity 2 x/h: what holds does not creep. */
struct rd_law_step {
    struct rd_laws laws; /* those of RD_GIVEN are what `call` says */
    rd_law_call *call;
    void *context;
    double h;      /* [s]                                                         */
    double time;   /* [s] of its middle                                           */
    double *C;     /* (laws, laws) half of what forces move in the step itself    */
    double *lean;  /* (laws,) half of what the points move without them           */
    double *start; /* (laws,)                                                     */
    double *force; /* (laws,) a guess, then the answer                            */
    double *kept;  /* (laws,)                                                     */
    double *solve; /* (laws, laws + 4) of rd_laws_solve                           */
    double *size;  /* (laws,) largest forces so far; goes on                      */
};

/* lays out the work of so many laws, or counts it while the workspace measures */
void rd_law_step_work(size_t laws, struct rd_workspace *workspace, struct rd_law_step *step);

/* RD_OK; RD_NO_CONVERGENCE; RD_INTERRUPTED: a law failed */
enum rd_status rd_law_step_solve(const struct rd_law_step *step, double *residual);

#endif
