/* The area under a tensed cantilever, at the theta of several frequencies side by side. */
#include "sweep_area.h"

#include "area.h"

#pragma GCC diagnostic ignored "-Wpsabi"

static void set(cv *x, int lane, double _Complex value)
{
    x->re[lane] = creal(value);
    x->im[lane] = cimag(value);
}

struct sweep_area rd_sweep_area(enum rd_kind kind, cv theta)
{
    struct sweep_area all = {.lean = c_zero()};
    for (int lane = 0; lane < RD_LANES; lane++) {
        const struct rd_area one = rd_area_at(kind, CMPLX(theta.re[lane], theta.im[lane]));
        set(&all.lean, lane, one.lean);
        for (int k = 0; k < 3; k++)
            set(all.P + k, lane, one.P[k]);
    }
    return all;
}
