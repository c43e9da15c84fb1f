/* Rows of a family as lanes, and back. */
#ifndef RD_ROPE_LANES_H
#define RD_ROPE_LANES_H

#include "closed/closed.h"
#include "closed/lane_math.h"

static const double ROUNDING = 0x1p-52, PI = 3.14159265358979323846;

/* an error of omega above this is none to certify */
static const double CERTAIN = 1e-8;

/* a last step of so much leaves less than rounding, its square */
static const double NEAR = 1e-8;

enum { STEPS = 40 };

RD_INLINE lane_mask finite(lanes x)
{
    return l_abs(x) < (double)INFINITY;
}

/* the largest whole number <= x, at least 0; uncertain where `slack` roundings reach another one */
RD_INLINE lanes whole_turns(lanes x, lanes slack, lane_mask *certain)
{
    const lanes shift = l_fill(0x1.8p52), near = (x + shift) - shift;
    const lanes whole = l_select(near > x, near - 1.0, near);
    *certain &= (l_abs(x - near) > ROUNDING * (slack + l_abs(x))) & (l_abs(x) < 1e9);
    return l_select(whole > 0.0, whole, l_fill(0));
}

/* the rows from `first`; lanes beyond `last` repeat its last row */
RD_INLINE void rope_lanes(const struct rd_ropes *ropes, size_t first, size_t last, int numbers,
                          lanes *number)
{
    for (int j = 0; j < numbers; j++) {
        double x[RD_LANES];
        for (size_t i = 0; i < RD_LANES; i++) {
            const size_t row = first + i < last ? first + i : last - 1;
            const int32_t column = ropes->column[j];
            x[i] =
                column < 0 ? ropes->fixed[j] : ropes->values[row * ropes->columns + (size_t)column];
        }
        __builtin_memcpy(number + j, x, sizeof x);
    }
}

/* `slope` may be NULL, or by number */
RD_INLINE void keep_mode(const struct rd_ropes *ropes, size_t first, size_t last, int numbers,
                         const struct rd_closed_modes *modes, size_t mode, lanes omega, lanes error,
                         const lanes *slope)
{
    for (size_t i = 0; i < RD_LANES && first + i < last; i++) {
        const size_t at = (first + i) * modes->number + mode;
        modes->omega[at] = omega[i];
        modes->error[at] = error[i];
        for (int j = 0; j < numbers && modes->slope; j++)
            if (ropes->column[j] >= 0)
                modes->slope[at * ropes->columns + (size_t)ropes->column[j]] = slope[j][i];
    }
}

#endif
