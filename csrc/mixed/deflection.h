/* Static deflection of the mixed form by band LU. */
#ifndef RD_MIXED_DEFLECTION_H
#define RD_MIXED_DEFLECTION_H

#include "mixed/mixed.h"

struct rd_mixed_deflection {
    struct rd_mixed mixed;
    double _Complex *load;     /* (size) */
    double _Complex *solution; /* (size) */
    double _Complex *scratch;  /* (2, size) */
    double *spread;            /* (size) */
};

/* Takes the arrays of the solution. */
enum rd_status rd_mixed_deflection_prepare(const struct rd_chain *chain,
                                           struct rd_mixed_deflection *deflection,
                                           struct rd_workspace *workspace);

/* displacement (nodes, width) and force (nodes - 1, width) on the right ends of the elements under
   load (nodes, width). RD_SINGULAR where the motion has no correct digit, RD_INTERRUPTED */
enum rd_status rd_mixed_deflection_solve(struct rd_mixed_deflection *deflection, const double *load,
                                         double *displacement, double *force);

#endif
