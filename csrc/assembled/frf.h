/* Frequency response of the assembled system by complex band LU. */
#ifndef RD_FRF_H
#define RD_FRF_H

#include "assembled/system.h"
#include "base/complex.h"
#include "base/stop.h"

struct rd_frf {
    const struct rd_chain *chain;
    struct rd_system system; /* its elements at the last frequency solved */
    struct rd_ports drives;
    struct rd_ports responses;
    double _Complex *matrix;   /* (free, 3 reach + 1) band, then its factors */
    double _Complex *solution; /* (drives + responses, free) */
    double _Complex *adjoint;  /* (free) */
    double *size;              /* (drives + responses, free) */
    int32_t *pivot;            /* (free) */
};

/* Takes and fills what does not depend on frequency. */
enum rd_status rd_frf_prepare(const struct rd_chain *chain, const struct rd_ports *drives,
                              const struct rd_ports *responses, struct rd_frf *frf,
                              struct rd_workspace *workspace);

/* At one frequency, with factor (RD_PARTS) on the parts of the dynamic stiffness:
       value (drives, responses)     displacement per force [m/N, rad/N, ...]
       rounding (drives, responses)  what entries off by eps change in it, all signs alike
       motion (drives)               the estimated relative error of the whole motion: 1 or more
                                     where no digit is left, as on an undamped resonance
   RD_SINGULAR where the factorisation meets an exact zero, RD_CRITICAL_ELEMENT where an element has
   no stiffness, RD_INTERRUPTED where `stop` is asked between two passes over the nodes. */
enum rd_status rd_frf_solve(struct rd_frf *frf, const double _Complex *factor,
                            const struct rd_stop *stop, double _Complex *value, double *rounding,
                            double *motion);

#endif
