/* Shape functions of a tensed cantilever, lanes of complex theta = T S_bb l^2. */
#ifndef RD_SHAPE_H
#define RD_SHAPE_H

#include "base/lanes.h"
#include "element/coordinate.h"

/* With one element's S_bb and l, per unit of S_bb l, S_bb l^2, S_bb l^3 and l:
       G_beta,beta = P0,  G_z,beta = P1,  G_zz = P2,  F_z,beta = tau
       F_beta,beta = 1 - theta P1,  Q_beta,beta = T l tau,  less = P0 - 1
   tensed, t = sqrt(theta): tau = P0 = tanh(t)/t,  P1 = (1 - 1/cosh(t))/theta,
       P2 = (1 - tau)/theta; even in t, so one branch of the root is as good as the other
   rigid, p = 1 + theta/3: tau = 1/p,  P0 = (1 + theta/12)/p,  P1 = 1/2p,  P2 = 1/3p
   difference: tau = 0,  P0 = 1,  P1 = 1/2,  P2 = 1/3 and no theta. */
struct shape_lanes {
    cv P0, P1, P2, tau, less;
};

/* the closed form, for lanes beyond the series */
void rd_shape_closed(const cv *theta, const lane_mask *where, struct shape_lanes *p);

enum { SHAPE_TERMS = 8 };

/* 1/(2k+2)! and (2k+2)/(2k+3)!: (cosh t - 1)/theta and (cosh t - sinh(t)/t)/theta */
static const double shape_cosh[SHAPE_TERMS] = {
    1.0 / 2,       1.0 / 24,        1.0 / 720,           1.0 / 40320,
    1.0 / 3628800, 1.0 / 479001600, 1.0 / 87178291200.0, 1.0 / 20922789888000.0};
static const double shape_lag[SHAPE_TERMS] = {
    1.0 / 3,       1.0 / 30,        1.0 / 840,           1.0 / 45360,
    1.0 / 3991680, 1.0 / 518918400, 1.0 / 93405312000.0, 1.0 / 22230464256000.0};

/* theta = phi s: phi of the frequencies, s real and of the element. What the series of all elements
   share is shape_cosh[k] phi^k and shape_lag[k] phi^k. */
struct shape_series {
    cv phi, cosh[SHAPE_TERMS], lag[SHAPE_TERMS];
    lane_mask large; /* |phi| > 1, which no damping makes it */
    double most;     /* largest |phi|^2 */
    int any_large;
};

RD_INLINE void shape_prepare(cv phi, struct shape_series *series)
{
    const lanes square = phi.re * phi.re + phi.im * phi.im;
    cv power = c_real(1.0);
    for (int k = 0; k < SHAPE_TERMS; k++) {
        series->cosh[k] = c_scale(power, shape_cosh[k]);
        series->lag[k] = c_scale(power, shape_lag[k]);
        power = c_mul(power, phi);
    }
    series->phi = phi;
    series->large = square > 1.0 + 1e-12;
    series->most = 0.0;
    series->any_large = 0;
    for (int i = 0; i < RD_LANES; i++) {
        series->most = square[i] > series->most ? square[i] : series->most;
        series->any_large |= series->large[i] != 0;
    }
}

/* so many terms leave less than 2^-55 of the sum for |phi| <= 1: the next one of the lag, which
   decides, is (2k + 2)!/(2k + 3)! ... = 7.5e-7 s^4 for 4 and 5.8e-9 s^5 for 5 of them */
RD_INLINE int shape_terms(double s)
{
    const double size = s < 0.0 ? -s : s;
    return size <= 1.0 / 512 ? 4 : size <= 1.0 / 64 ? 5 : SHAPE_TERMS;
}

RD_INLINE cv shape_sum(const cv *term, int terms, double s)
{
    const lanes step = l_fill(s);
    cv sum = term[terms - 1];
    for (int k = terms - 2; k >= 0; k--)
        sum = c_add(c_scale_lanes(sum, step), term[k]);
    return sum;
}

/* |theta| <= 1: with c = (cosh t - 1)/theta, d = (cosh t - sinh(t)/t)/theta, C = 1 + theta c:
       P1 = c/C,  P2 = d/C,  tau = 1 - theta P2 */
RD_INLINE void shape_by_series(const struct shape_series *series, double s, struct shape_lanes *p)
{
    const cv theta = c_scale(series->phi, s);
    const int terms = shape_terms(s);
    cv c = shape_sum(series->cosh, terms, s), d = shape_sum(series->lag, terms, s);
    if (series->any_large) {
        const cv all_c = shape_sum(series->cosh, SHAPE_TERMS, s);
        const cv all_d = shape_sum(series->lag, SHAPE_TERMS, s);
        c.re = l_select(series->large, all_c.re, c.re);
        c.im = l_select(series->large, all_c.im, c.im);
        d.re = l_select(series->large, all_d.re, d.re);
        d.im = l_select(series->large, all_d.im, d.im);
    }
    cv C = c_mul(theta, c);
    C.re += 1.0;
    const cv inverse = c_inverse(C);
    p->P1 = c_mul(c, inverse);
    p->P2 = c_mul(d, inverse);
    p->less = c_neg(c_mul(theta, p->P2));
    p->tau = p->less;
    p->tau.re += 1.0;
    p->P0 = p->tau;
}

RD_INLINE void shape_tensed(const struct shape_series *series, double s, struct shape_lanes *p)
{
    shape_by_series(series, s, p);
    if (s * s * series->most > 1.0) {
        const cv theta = c_scale(series->phi, s);
        const lane_mask far = theta.re * theta.re + theta.im * theta.im > 1.0;
        struct shape_lanes beyond = *p;
        rd_shape_closed(&theta, &far, &beyond);
        *p = beyond;
    }
}

RD_INLINE void shape_rigid(cv theta, struct shape_lanes *p)
{
    cv q = c_scale(theta, 1.0 / 3.0);
    q.re += 1.0;
    p->tau = c_inverse(q);
    p->P1 = c_scale(p->tau, 0.5);
    p->P2 = c_scale(p->tau, 1.0 / 3.0);
    p->less = c_scale(c_mul(theta, p->tau), -0.25);
    p->P0 = p->less;
    p->P0.re += 1.0;
}

RD_INLINE void shape_functions(enum rd_kind kind, const struct shape_series *series, double s,
                               struct shape_lanes *p)
{
    if (kind == RD_TENSED) {
        shape_tensed(series, s, p);
    } else if (kind == RD_RIGID) {
        shape_rigid(c_scale(series->phi, s), p);
    } else {
        *p = (struct shape_lanes){c_real(1.0), c_real(0.5), c_real(1.0 / 3.0), c_zero(), c_zero()};
    }
}

/* The area under it, as in element/area.h. */
struct area_lanes {
    cv lean, P[3];
};

struct area_lanes rd_area_lanes_at(enum rd_kind kind, cv theta);

#endif
