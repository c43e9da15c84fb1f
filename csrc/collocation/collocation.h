/* Steps of a linear system that smooth laws push: forces of the laws at the stages are unknown. */
#ifndef RD_COLLOCATION_H
#define RD_COLLOCATION_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/workspace.h"
#include "law/law.h"

enum rd_smooth_kind {
    RD_SMOOTH_POWER, /* force = -value[0] |v|^value[1] sign(v) */
    RD_SMOOTH_CALL,  /* force is what `call` says              */
};

struct rd_smooth_laws {
    size_t count;
    const int32_t *kind; /* (count,) of enum rd_smooth_kind */
    const double *value; /* (count, 2)                      */
    rd_law_call *call;
    void *context;
};

/* A step of length h from amplitudes x = (q, v) of each mode, one set for each law:

       x <- change x + sum over stages j of push_j R_j
       (u, v) at the stages = known + seen x + own R                                            */
struct rd_collocation {
    size_t stages;
    size_t laws;
    size_t modes;
    double h;             /* [s]                                                         */
    const double *node;   /* (stages,) of the step, the last is 1                        */
    const double *change; /* (2, 2, modes)                                               */
    const double *push;   /* (stages, 2, modes)                                          */
    const double *seen;   /* (laws, 2, modes, stages, 2, laws) u and v of laws' points   */
    const double *own;    /* (stages, 2, laws, stages, laws)                             */
    const double *ahead;  /* (stages, stages) forces of the next step from those of one  */
};

struct rd_collocated {
    size_t steps;
    const double *begin; /* (steps,) [s]                                          */
    const double *known; /* (steps, stages, 2, laws) u and v without laws         */
    double *force;       /* (steps + 1, stages, laws); the first row is a guess   */
    double *state;       /* (steps + 1, laws, 2, modes); the first row is given   */
    double *motion;      /* (steps, stages, 2, laws) u and v                      */
    double *size;        /* (3, laws) largest u, v and force so far; goes on      */
    size_t made;         /* steps that hold                                       */
    size_t iterations;   /* of Newton's method                                    */
    double residual;     /* of the last step, of the forces                       */
};

/* lays out the work, or counts it while the workspace measures */
struct rd_collocation_work {
    double *point;    /* (stages, 2, laws)                             */
    double *wanted;   /* (stages, laws) what the laws say              */
    double *slope;    /* (stages, 2, laws) of a law by u and by v      */
    double *gap;      /* (stages, laws)                                */
    double *tried;    /* (stages, laws)                                */
    double *further;  /* (stages, laws)                                */
    double *jacobian; /* (stages laws)^2                               */
    double *call;     /* (4, 3 stages) time, u, v, force of a law      */
    int32_t *pivot;   /* (stages laws,)                                */
};

void rd_collocation_work(const struct rd_collocation *step, struct rd_workspace *workspace,
                         struct rd_collocation_work *work);

/* RD_OK; RD_NO_CONVERGENCE: the step after those made does not hold; RD_INTERRUPTED: a law failed
   in it */
enum rd_status rd_collocation_run(const struct rd_collocation *step,
                                  const struct rd_smooth_laws *laws,
                                  const struct rd_collocation_work *work,
                                  struct rd_collocated *run);

#endif
