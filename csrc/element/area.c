/* The area under a tensed cantilever at one complex theta = T S_bb l^2. */
#include "element/area.h"

#include "element/cantilever.h"

enum { TERMS = 12 };

/* sums of numerator_k theta^k, and cosh t = 1 + theta sum theta^k/(2k + 2)! */
struct sums {
    double _Complex cosh, P[3], held;
};

/* |theta| <= 1, all terms positive: with C = cosh t
       P1 - P2 = sum theta^k/(2k + 3)!/C
       P2 - c = sum (k + 1)(2k + 3) theta^k/(2k + 4)!/C
       P2 - 2 c + d = sum (2k + 2)(4k^2 + 14k + 9)/3 theta^k/(2k + 5)!/C
       (tau/3 - P2)/theta = sum (2k + 2)(2k + 4)/3 theta^k/(2k + 5)!/C */
static struct sums by_series(double _Complex theta)
{
    struct sums s = {.cosh = 1};
    double _Complex power = 1;
    double factorial = 2; /* (2k + 2)! */
    for (int k = 0; k < TERMS; k++) {
        const double third = factorial * (2 * k + 3), fourth = third * (2 * k + 4);
        const double fifth = 3 * fourth * (2 * k + 5);
        s.cosh += theta * power / factorial;
        s.P[0] += power / third;
        s.P[1] += power * ((k + 1) * (2 * k + 3) / fourth);
        s.P[2] += power * ((2 * k + 2) * (4 * k * k + 14 * k + 9) / fifth);
        s.held += power * ((2 * k + 2) * (2 * k + 4) / fifth);
        power *= theta;
        factorial = fourth;
    }
    return s;
}

/* 1/cosh t, which 1 - theta P1 would lose for long elements */
static double _Complex cosh_inverse(double _Complex theta)
{
    const double _Complex e = cexp(-csqrt(theta));
    return 2 * e / (1 + e * e);
}

static struct rd_area tensed(double _Complex theta)
{
    const struct rd_cantilever at = rd_cantilever_at(RD_TENSED, theta);
    struct rd_area area = {.lean = at.tau - at.P[1]};
    if (cabs(theta) > 1) {
        area.P[0] = (at.tau - cosh_inverse(theta)) / theta;
        area.P[1] = (0.5 - at.tau + at.P[1]) / theta;
        area.P[2] = (1.0 / 3 - at.tau + 2 * at.P[1] - at.P[2]) / theta;
        return area;
    }
    const struct sums s = by_series(theta);
    for (int k = 0; k < 3; k++)
        area.P[k] = s.P[k] / s.cosh;
    return area;
}

/* rigid, p = 1 + theta/3: the beam without tension, 1/2, 1/6, 1/8, 1/20, its end pulled by T/l */
struct rd_area rd_area_at(enum rd_kind kind, double _Complex theta)
{
    if (kind == RD_TENSED)
        return tensed(theta);
    const double _Complex p = 1 + theta / 3;
    return (struct rd_area){
        .lean = (0.5 + theta / 24) / p,
        .P = {(1.0 / 6 - theta / 144) / p, 1 / (8 * p), (1.0 / 20 + theta / 960) / p},
    };
}

struct rd_area_held rd_area_held_at(double _Complex theta)
{
    const double _Complex quarter = theta / 4;
    const struct rd_cantilever at = rd_cantilever_at(RD_TENSED, quarter);
    struct rd_area_held held = {.lean = at.P[2] / (4 * at.tau)};
    if (cabs(quarter) > 1) {
        held.load = (at.tau / 3 - at.P[2]) / (16 * quarter * at.tau);
    } else {
        const struct sums s = by_series(quarter);
        held.load = s.held / (16 * s.cosh * at.tau);
    }
    return held;
}
