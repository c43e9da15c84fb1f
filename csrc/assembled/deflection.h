/* Static deflection of the assembled system by band LU. */
#ifndef RD_DEFLECTION_H
#define RD_DEFLECTION_H

#include "assembled/system.h"

struct rd_deflection {
    struct rd_system system;
    double *matrix;    /* (free, 3 reach + 1) band, then its factors */
    double *load;      /* (free) */
    double *work;      /* (3 free) */
    int32_t *pivot;    /* (free) */
    int32_t *integers; /* (free) */
};

/* Takes and fills the arrays of the solution. */
enum rd_status rd_deflection_prepare(const struct rd_chain *chain, struct rd_deflection *deflection,
                                     struct rd_workspace *workspace);

/* displacement (nodes, width) under force (nodes, width); condition <- the reciprocal condition
   number of the scaled stiffness. RD_SINGULAR where that is below the rounding of one number. */
enum rd_status rd_deflection_solve(struct rd_deflection *deflection, const double *force,
                                   double *displacement, double *condition);

#endif
