/* Forces that depend on the motion of single points. */
#ifndef RD_LAW_H
#define RD_LAW_H

#include <stdbool.h>

#include "chain/ports.h"

/* forces (count) of a law that the caller knows, at times [s], displacements and velocities of its
   point; false: it failed, and the run ends */
typedef bool rd_law_call(void *context, size_t law, size_t count, const double *time,
                         const double *u, const double *v, double *force);

/* On q = row (u_node, u_node+1), dq/dt = v, the rope is pushed by
       RD_POWER  -c |v|^p sign v    value: c, p; p = 0: dry friction, any force up to c at v = 0
       RD_STOP   -side max(0, k a + c side v) where a = side q - gap > 0    value: k, gap, side, c
       RD_GIVEN  what the caller says */
enum rd_law_kind { RD_POWER, RD_STOP, RD_GIVEN, RD_LAW_KINDS };

enum { RD_LAW_VALUES = 4 };

struct rd_laws {
    struct rd_ports ports; /* where */
    const int32_t *kind;   /* (ports.count) enum rd_law_kind */
    const double *value;   /* (ports.count, RD_LAW_VALUES) */
};

/* The forces of a stage: x = lean + C force with v = x/theta and q = start + x, C (laws, laws)
   positive semidefinite. force comes in as a guess, of RD_GIVEN as the answer. Each law grows with
   x, so that there is one answer: Newton's method on each law solved for its own force, and those
   one after another (Gauss-Seidel) where that goes astray. Returns the residual, the largest
   change of x relative to its terms that is left; work (laws, laws + 4). */
double rd_laws_solve(const struct rd_laws *laws, double theta, const double *lean, const double *C,
                     const double *start, double *force, double *work);

/* one force: x = lean + C f, f by law j */
double rd_law_force(const struct rd_laws *laws, size_t j, double theta, double lean, double C,
                    double start);

#endif
