/* Many uniform ropes at once, in closed form: lanes are ropes.

   A rope is a row of numbers (enum rd_bent or rd_plain). They follow from a few values by a matrix that
   is the same in all rows, so that slopes by the values are those by the numbers times it.

   Springs at the ends are 0 (free), of either sign, or infinite (held). Bits of a row do not depend on
   what stands in the others. */
#ifndef RD_CLOSED_H
#define RD_CLOSED_H

#include <stddef.h>
#include <stdint.h>

/* a span that bends, in {z, beta}: mu w,tt = T w'' - B w'''' */
enum rd_bent {
    RD_BENT_LENGTH,
    RD_BENT_INERTIA,   /* mu [kg/m] */
    RD_BENT_TENSION,   /* T [N], of either sign */
    RD_BENT_STIFFNESS, /* B [N m^2] */
    RD_BENT_Z0,        /* springs at the left end [N/m, N m] */
    RD_BENT_BETA0,
    RD_BENT_Z1,
    RD_BENT_BETA1,
    RD_BENT_NUMBERS
};

/* a string, a rod that twists or stretches: m u,tt = D u'' */
enum rd_plain {
    RD_PLAIN_LENGTH,
    RD_PLAIN_INERTIA,
    RD_PLAIN_STIFFNESS,
    RD_PLAIN_SPRING0,
    RD_PLAIN_SPRING1,
    RD_PLAIN_NUMBERS
};

struct rd_ropes {
    const double *number;   /* rows x numbers */
    size_t values;          /* that numbers follow from */
    const double *jacobian; /* numbers x values; NULL where no slopes are asked for */
};

/* modes of a row, 1 to number by index, k = row number + mode - 1 */
struct rd_closed_modes {
    size_t number;
    double *omega; /* rows x number [rad/s] */
    double *error; /* rows x number: how far rounding may have moved it, relative */
    double *slope; /* rows x number x values: d ln omega by each value; or NULL */
    uint8_t
        *certified; /* rows: every mode was found, at its index, positive, and within the error */
};

/* Rows first <= i < last. Where a row is not certified some of its modes are not right: it is to be
   solved in another way. Shows nothing of numbers without a meaning: they are not certified. */
void rd_bent_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                   const struct rd_closed_modes *modes);
void rd_plain_modes(const struct rd_ropes *ropes, size_t first, size_t last,
                    const struct rd_closed_modes *modes);

/* eigenvalues below omega^2, omega > 0, negative ones among them; -1 where that is not certain */
void rd_bent_count(const struct rd_ropes *ropes, size_t first, size_t last, double omega,
                   int64_t *count);
void rd_plain_count(const struct rd_ropes *ropes, size_t first, size_t last, double omega,
                    int64_t *count);

#endif
