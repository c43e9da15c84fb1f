/* Shape functions of a tensed cantilever at one complex theta = T S_bb l^2. */
#include "element/cantilever.h"

#include <math.h>

enum { TERMS = 12 };

/* |theta| <= 1: with c = (cosh t - 1)/theta = sum theta^k/(2k + 2)! and
   d = (cosh t - sinh(t)/t)/theta = sum (2k + 2) theta^k/(2k + 3)!, C = cosh t = 1 + theta c:
       P1 = c/C,  P2 = d/C,  tau = 1 - theta P2 */
static struct rd_cantilever by_series(double _Complex theta)
{
    double _Complex c = 0, d = 0, power = 1;
    double factorial = 1; /* (2k + 1)! */
    for (int k = 0; k < TERMS; k++) {
        const double next = factorial * (2 * k + 2);
        c += power / next;
        d += power * ((2 * k + 2) / (next * (2 * k + 3)));
        power *= theta;
        factorial = next * (2 * k + 3);
    }
    const double _Complex C = 1 + theta * c;
    const double _Complex tau = 1 - theta * d / C;
    return (struct rd_cantilever){.tau = tau, .P = {tau, c / C, d / C}};
}

/* e = exp(-t), Re t >= 0: tanh t = (1 - e^2)/(1 + e^2), 1 - 1/cosh t = (1 - e)^2/(1 + e^2):
   nothing overflows however long the element is */
static struct rd_cantilever in_closed_form(double _Complex theta)
{
    const double _Complex t = csqrt(theta);
    const double _Complex e = cexp(-t);
    const double _Complex f = 1 + e * e;
    const double _Complex tau = (1 - e * e) / (t * f);
    return (struct rd_cantilever){
        .tau = tau,
        .P = {tau, (1 - e) * (1 - e) / (f * theta), (1 - tau) / theta},
    };
}

/* theta = -t^2 real: trigonometric, so that what is real stays real */
static struct rd_cantilever compressed(double theta)
{
    const double t = sqrt(-theta);
    const double tau = tan(t) / t;
    const double sine = sin(t / 2);
    return (struct rd_cantilever){
        .tau = tau,
        .P = {tau, -2 * sine * sine / (cos(t) * theta), (1 - tau) / theta},
    };
}

struct rd_cantilever rd_cantilever_at(enum rd_kind kind, double _Complex theta)
{
    if (kind == RD_DIFFERENCE)
        return (struct rd_cantilever){.P = {1, 0.5, 1.0 / 3}};
    if (kind == RD_RIGID) {
        const double _Complex p = 1 + theta / 3;
        return (struct rd_cantilever){.tau = 1 / p,
                                      .P = {(1 + theta / 12) / p, 1 / (2 * p), 1 / (3 * p)}};
    }
    if (cabs(theta) <= 1)
        return by_series(theta);
    if (creal(theta) < 0 && cimag(theta) == 0)
        return compressed(creal(theta));
    return in_closed_form(theta);
}

/* |theta| <= 1: c' and d' term by term, C' = c + theta c' */
static struct rd_cantilever slope_by_series(double _Complex theta)
{
    double _Complex c = 0, d = 0, c_slope = 0, d_slope = 0, power = 1, below = 0;
    double factorial = 1; /* (2k + 1)! */
    for (int k = 0; k < TERMS; k++) {
        const double next = factorial * (2 * k + 2);
        const double share = (2 * k + 2) / (next * (2 * k + 3));
        c += power / next;
        d += power * share;
        c_slope += below * k / next;
        d_slope += below * (k * share);
        below = power;
        power *= theta;
        factorial = next * (2 * k + 3);
    }
    const double _Complex C = 1 + theta * c, C_slope = c + theta * c_slope;
    const double _Complex P2_slope = (d_slope - d / C * C_slope) / C;
    const double _Complex slope = -d / C - theta * P2_slope;
    return (struct rd_cantilever){.tau = slope,
                                  .P = {slope, (c_slope - c / C * C_slope) / C, P2_slope}};
}

/* Beyond, with 1/cosh t = 1 - theta P1 and d(1/cosh t)/dtheta = -tau/(2 cosh t),
   d t/dtheta = 1/2t: */
struct rd_cantilever rd_cantilever_slope(double _Complex theta)
{
    if (cabs(theta) <= 1)
        return slope_by_series(theta);
    const struct rd_cantilever at = rd_cantilever_at(RD_TENSED, theta);
    const double _Complex P1 = at.P[1], P2 = at.P[2];
    const double _Complex secant = 1 - theta * P1;
    const double _Complex slope = (secant * secant - at.tau) / (2 * theta);
    return (struct rd_cantilever){
        .tau = slope,
        .P = {slope, (secant * at.tau / 2 - P1) / theta, -(slope + P2) / theta},
    };
}
