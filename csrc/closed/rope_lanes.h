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

/* which rope, and for modes which mode, a lane works on; lanes beyond the last repeat it */
struct lane_places {
    size_t row[RD_LANES], mode[RD_LANES];
    size_t used;
};

/* The places from `start` on of the modes of a few rows, mode by mode: lanes are ropes where there are
   enough of them, and else modes too. */
RD_INLINE struct lane_places lane_places(size_t first, size_t rows, size_t modes, size_t start)
{
    struct lane_places at;
    const size_t all = rows * modes;
    at.used = all - start < RD_LANES ? all - start : RD_LANES;
    for (size_t i = 0; i < RD_LANES; i++) {
        const size_t place = start + (i < at.used ? i : at.used - 1);
        at.row[i] = first + place % rows;
        at.mode[i] = place / rows;
    }
    return at;
}

RD_INLINE void rope_lanes(const struct rd_ropes *ropes, const struct lane_places *at, int numbers,
                          lanes *number)
{
    for (int j = 0; j < numbers; j++) {
        double x[RD_LANES];
        for (size_t i = 0; i < RD_LANES; i++)
            x[i] = ropes->number[at->row[i] * (size_t)numbers + (size_t)j];
        __builtin_memcpy(number + j, x, sizeof x);
    }
}

/* numbers of modes from 1, and where they are odd */
RD_INLINE lanes mode_lanes(const struct lane_places *at, lane_mask *odd)
{
    double n[RD_LANES];
    long long is_odd[RD_LANES];
    for (size_t i = 0; i < RD_LANES; i++) {
        n[i] = (double)(at->mode[i] + 1);
        is_odd[i] = at->mode[i] % 2 == 0 ? -1 : 0;
    }
    lanes number;
    __builtin_memcpy(&number, n, sizeof n);
    __builtin_memcpy(odd, is_odd, sizeof is_odd);
    return number;
}

RD_INLINE void keep_modes(const struct rd_ropes *ropes, const struct lane_places *at, int numbers,
                          const struct rd_closed_modes *modes, lanes omega, lanes error,
                          lane_mask certified, const lanes *slope)
{
    for (size_t i = 0; i < at->used; i++) {
        const size_t place = at->row[i] * modes->number + at->mode[i];
        modes->omega[place] = omega[i];
        modes->error[place] = error[i];
        if (at->mode[i] == 0)
            modes->certified[at->row[i]] = 1;
        modes->certified[at->row[i]] &= certified[i] != 0;
    }
    for (size_t c = 0; c < ropes->values && modes->slope; c++) {
        lanes sum = l_fill(0);
        for (size_t j = 0; j < (size_t)numbers; j++) {
            const double per = ropes->jacobian[j * ropes->values + c];
            if (per != 0)
                sum += per * slope[j];
        }
        for (size_t i = 0; i < at->used; i++)
            modes->slope[(at->row[i] * modes->number + at->mode[i]) * ropes->values + c] = sum[i];
    }
}

#endif
