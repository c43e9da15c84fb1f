/* Modes that laws of points, a tension that varies and dampers couple, in steps of constant force. */
#ifndef RD_MODAL_H
#define RD_MODAL_H

#include <stddef.h>

#include "base/status.h"
#include "law/step.h"

/* Amplitudes of modes Q = known + q, of unit modal mass, with t the tension beside its mean:

       q'' + 2 sigma q' + square q = F = -t form Q - drag Q' + row^T f,
       t = tension + stretching/2 Q^T form Q

   F is constant over a step, of the means of Q and t at its ends and of Q' in it, and q moves
   exactly under it: energy is kept to rounding. */
struct rd_modal {
    struct rd_laws laws; /* those of RD_GIVEN are what `call` says                         */
    rd_law_call *call;
    void *context;
    size_t modes;
    size_t steps;
    double begin;          /* [s]                                                          */
    double h;              /* [s]                                                          */
    const double *change;  /* (2, 2, modes) (q, q') after a step per (q, q') before        */
    const double *push;    /* (2, modes) and per force                                     */
    const double *row;     /* (laws, modes) how modes move points                          */
    const double *form;    /* (modes, modes), symmetric                                    */
    const double *drag;    /* (modes, modes), symmetric, [1/s]; NULL: none                 */
    const double *tension; /* (steps,) [N], the mean of both ends                          */
    double stretching;     /* [N per Q^T form Q]                                           */
    const double *known;   /* (steps + 1, modes)                                           */
};

struct rd_modal_run {
    double *state;   /* (steps + 1, 2, modes) q and q'; the first is given */
    double *pushed;  /* (steps + 1, modes) F; the first is a guess         */
    double *force;   /* (steps + 1, laws) f; the first is a guess          */
    double *largest; /* (1,) of all Q so far; goes on                      */
    double *size;    /* (laws,) largest forces so far; goes on             */
    size_t made;     /* steps that hold                                    */
    double residual; /* of the last one                                    */
};

struct rd_modal_work {
    struct rd_law_step step;
    double *mean;    /* (modes,) Q in the middle                              */
    double *base;    /* (modes,) that without forces of laws                  */
    double *begun;   /* (modes,) Q at the beginning                           */
    double *lean;    /* (modes,) Q in the middle without F                    */
    double *soft;    /* (modes,) Q in the middle per force of laws            */
    double *bent;    /* (modes,) form Q                                       */
    double *dragged; /* (modes,) drag Q                                      */
    double *kicked;  /* (modes,) row^T f                                      */
};

/* lays out the work, or counts it while the workspace measures */
void rd_modal_work(const struct rd_modal *system, struct rd_workspace *workspace,
                   struct rd_modal_work *work);

/* Take all steps. RD_OK; RD_NO_CONVERGENCE: the step after those made does not hold;
   RD_INTERRUPTED: a law failed in it. */
enum rd_status rd_modal_run(const struct rd_modal *system, struct rd_modal_work *work,
                            struct rd_modal_run *run);

#endif
