/* Shape functions of a tensed cantilever in closed form. */
#include "element/shape.h"

#include "base/complex.h"
#include "element/area.h"

#pragma GCC diagnostic ignored "-Wpsabi"

/* with e = exp(-t), Re t >= 0: tanh t = (1 - e^2)/(1 + e^2), 1/cosh t = 2 e/(1 + e^2);
   nothing overflows however large t is. Where nothing is damped theta is that of all lanes: it is
   solved once. */
void rd_shape_closed(const cv *theta, const lane_mask *where, struct shape_lanes *p)
{
    double complex last = 0, tau = 0, P1 = 0, P2 = 0;
    for (int i = 0; i < RD_LANES; i++) {
        if (!(*where)[i])
            continue;
        const double complex x = CMPLX(theta->re[i], theta->im[i]);
        if (x != last) {
            const double complex t = csqrt(x), e = cexp(-t), f = 1.0 + e * e;
            tau = (1.0 - e * e) / (t * f);
            P1 = (1.0 - e) * (1.0 - e) / (f * x);
            P2 = (1.0 - tau) / x;
            last = x;
        }
        p->P0.re[i] = p->tau.re[i] = creal(tau);
        p->P0.im[i] = p->tau.im[i] = cimag(tau);
        p->P1.re[i] = creal(P1);
        p->P1.im[i] = cimag(P1);
        p->P2.re[i] = creal(P2);
        p->P2.im[i] = cimag(P2);
        p->less.re[i] = creal(tau) - 1.0;
        p->less.im[i] = cimag(tau);
    }
}

static void set(cv *x, int lane, double _Complex value)
{
    x->re[lane] = creal(value);
    x->im[lane] = cimag(value);
}

struct area_lanes rd_area_lanes_at(enum rd_kind kind, cv theta)
{
    struct area_lanes all = {.lean = c_zero()};
    for (int lane = 0; lane < RD_LANES; lane++) {
        const struct rd_area one = rd_area_at(kind, CMPLX(theta.re[lane], theta.im[lane]));
        set(&all.lean, lane, one.lean);
        for (int k = 0; k < 3; k++)
            set(all.P + k, lane, one.P[k]);
    }
    return all;
}
