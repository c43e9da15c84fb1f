/* The characteristic function of a chain at rates s of damped motion. */
#ifndef RD_FUNCTION_H
#define RD_FUNCTION_H

#include "base/complex.h"
#include "base/status.h"
#include "base/stop.h"
#include "base/workspace.h"
#include "chain/chain.h"

#include <stdbool.h>

/* factors of the five parts of the dynamic stiffness, constant + linear s, of inertia + s^2 */
struct rd_damping {
    double _Complex constant[RD_PARTS];
    double _Complex linear[RD_PARTS]; /* [s], of inertia [1/s] */
};

/* What else is a root where s is one: its conjugate where all factors of conjugate rates are
   conjugate; -s where they depend on s^2 alone, as with a complex modulus and nothing else. */
enum rd_mirror { RD_NO_MIRROR, RD_CONJUGATE, RD_OPPOSITE };

struct rd_function {
    const struct rd_chain *chain;
    struct rd_damping damping;
    struct rd_stop stop; /* asked between walks */
    double reach;        /* it may be asked for |s| below [rad/s] */
    double rounding;     /* of values */
    size_t steps;        /* pieces shorter than the waves at its reach */
    size_t sweeps;       /* how often it was asked */
    enum rd_mirror mirror;
    struct rd_characteristic *of;
};

/* Fills all of it; false: the workspace measures or is too small, and `of` is missing alone. */
bool rd_function_take(const struct rd_chain *chain, const struct rd_damping *damping,
                      struct rd_stop stop, double reach, struct rd_workspace *workspace,
                      struct rd_function *f);

/* value (count) and magnitude (count) at s (count), any number: csrc/sweep/characteristic.h.
   RD_SHORT_WAVES, RD_INTERRUPTED */
enum rd_status rd_function_at(struct rd_function *f, size_t count, const double _Complex *s,
                              double _Complex *value, double *magnitude);

/* how far waves of one coordinate turn along the chain where |s| <= radius, and more [rad] */
double rd_function_turning(const struct rd_function *f, double radius);

/* where another root is, or s itself */
static inline double _Complex rd_mirrored(enum rd_mirror mirror, double _Complex s)
{
    return mirror == RD_CONJUGATE ? conj(s) : mirror == RD_OPPOSITE ? -s : s;
}

#endif
