/* Shape functions of a tensed cantilever, lanes of complex theta = T S_bb l^2. */
#ifndef RD_SHAPE_H
#define RD_SHAPE_H

#include "chain.h"
#include "lanes.h"

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

/* |theta| <= 1: with c = (cosh t - 1)/theta, d = (cosh t - sinh(t)/t)/theta, C = 1 + theta c:
       P1 = c/C,  P2 = d/C,  tau = 1 - theta P2 */
RD_INLINE void shape_series(cv theta, struct shape_lanes *p)
{
    cv c = c_real(shape_cosh[SHAPE_TERMS - 1]), d = c_real(shape_lag[SHAPE_TERMS - 1]);
#pragma GCC unroll 8
    for (int k = SHAPE_TERMS - 2; k >= 0; k--) {
        c = c_mul(c, theta);
        d = c_mul(d, theta);
        c.re += shape_cosh[k];
        d.re += shape_lag[k];
    }
    cv C = c_mul(theta, c);
    C.re += 1.0;
    const cv s = c_inverse(C);
    p->P1 = c_mul(c, s);
    p->P2 = c_mul(d, s);
    p->less = c_neg(c_mul(theta, p->P2));
    p->tau = p->less;
    p->tau.re += 1.0;
    p->P0 = p->tau;
}

RD_INLINE void shape_tensed(cv theta, struct shape_lanes *p)
{
    const lane_mask far = theta.re * theta.re + theta.im * theta.im > 1.0;
    long long any = 0;
    for (int i = 0; i < RD_LANES; i++)
        any |= far[i];
    cv near = theta;
    if (any) {
        near.re = l_select(far, (lanes){0}, theta.re);
        near.im = l_select(far, (lanes){0}, theta.im);
    }
    shape_series(near, p);
    if (any)
        rd_shape_closed(&theta, &far, p);
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

RD_INLINE void shape_functions(enum rd_kind kind, cv theta, struct shape_lanes *p)
{
    if (kind == RD_TENSED) {
        shape_tensed(theta, p);
    } else if (kind == RD_RIGID) {
        shape_rigid(theta, p);
    } else {
        *p = (struct shape_lanes){c_real(1.0), c_real(0.5), c_real(1.0 / 3.0), c_zero(), c_zero()};
    }
}

#endif
