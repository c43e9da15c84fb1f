/* A chain as a rigid body: how its nodes resist its motion as a whole. */
#ifndef RD_BODY_H
#define RD_BODY_H

#include "chain/chain.h"

/* |mass| (first of a pair) and |stiffness| (second) of the nodes: sums of each coordinate, and of z
   where it is not held their centre and moment about it. */
struct rd_body {
    double sum[RD_WIDTH_MAX]
              [2];    /* [kg, kg m^2], [N/m, N m]; stiffness INFINITY where one is held */
    double weight[2]; /* sum n [kg, N/m] */
    double centre[2]; /* sum n x/sum n [m] from the left end */
    double moment[2]; /* sum n (x - centre)^2 [kg m^2, N m] */
    double pins;      /* nodes where z is held */
    double pin;       /* x of the last of them [m] */
    double length;    /* [m] */
};

void rd_body_find(const struct rd_chain *chain, struct rd_body *body);

/* The largest motion in coordinate i per unit force on it that the rigid body makes: as mass alone
   (lambda, |inertia factor|) and springs (their factor) let it, against a tension [N].
   0 where something held forbids it or nothing resists it. */
double rd_body_receptance(const struct rd_body *body, const struct rd_chain *chain, size_t i,
                          double lambda, double spring, double tension);

#endif
