/* Responses of one tensed span that bends, in closed form: lanes are lines. */
#ifndef RD_CLOSED_RESPONSE_H
#define RD_CLOSED_RESPONSE_H

#include <stddef.h>
#include <stdint.h>

#include "closed/closed.h"

/* what all rows are asked for: z at `response` per force in z at `drive` */
struct rd_closed_lines {
    size_t lines;
    const double *factor; /* (5, lines) complex: of section, tension, springs, inertia, dashpots */
    double drag;          /* damping per length [N s/m^2] */
    size_t drives, responses;
    const double *drive;    /* (drives) [m] */
    const double *response; /* (responses) [m] */
};

/* value, error: rows x drives x responses x lines
   certain: rows x lines: every value of the line is right within its error, which is below 1e-9 */
struct rd_closed_response {
    double *value; /* complex [m/N] */
    double *error; /* how far rounding may have moved it, relative */
    uint8_t *certain;
};

/* Rows first <= i < last of numbers (enum rd_bent). Lines of less than a sixteenth of a radian on the span, where the
   waves are not told apart, and points beside the span are not certain. */
void rd_bent_response(const double *number, size_t first, size_t last,
                      const struct rd_closed_lines *lines,
                      const struct rd_closed_response *response);

#endif
