/* Frequency response of the mixed form by complex band LU. */
#ifndef RD_MIXED_FRF_H
#define RD_MIXED_FRF_H

#include "mixed/mixed.h"

struct rd_mixed_frf {
    struct rd_mixed mixed;
    struct rd_ports drives;
    struct rd_ports responses;
    double _Complex *load;     /* (drives + responses, size) */
    double _Complex *solution; /* (drives + responses, size) */
    double _Complex *scratch;  /* (2, size) */
    double *spread;            /* (size) */
};

/* Takes and fills what does not depend on frequency. */
enum rd_status rd_mixed_frf_prepare(const struct rd_chain *chain, const struct rd_ports *drives,
                                    const struct rd_ports *responses, struct rd_mixed_frf *frf,
                                    struct rd_workspace *workspace);

/* At one frequency, with its factors (RD_PARTS); row r of drive d is entry stride (d responses +
   r) of both arrays:
       value   displacement or force per force
       error   its estimated absolute rounding error
   RD_SINGULAR where the motion has no correct digit, as on an undamped resonance; RD_INTERRUPTED */
enum rd_status rd_mixed_frf_solve(struct rd_mixed_frf *frf, const double _Complex *factor,
                                  size_t stride, double _Complex *value, double *error);

#endif
