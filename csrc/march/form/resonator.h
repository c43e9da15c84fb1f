/* Resonators at the nodes of a march. */
#ifndef RD_MARCH_RESONATOR_H
#define RD_MARCH_RESONATOR_H

#include "march/form/state.h"

/* A resonator's mass on its spring: what it adds to the node term, and at a stage to the load; its
   own change when the node's is known. */
void rd_resonator_add(const struct rd_march *march, size_t k, double *N);
void rd_resonator_load(struct rd_march *march, size_t k);
void rd_resonator_follow(struct rd_march *march, size_t k);

/* p += its force on the foot at the stage in lean */
void rd_resonator_pull(struct rd_march *march, size_t k);

/* its numbers at the stage, and how far its foot is moved by u (nodes, width) [m] */
struct rd_resonator {
    double m, k, c;           /* m/theta^2, k, c/theta [N/m] */
    double drag;              /* alpha m/theta [N/m] */
    double row[RD_WIDTH_MAX]; /* foot per scaled motion of the node [m] */
};
struct rd_resonator rd_resonator_of(const struct rd_march *march, size_t k);
double rd_resonator_force(const struct rd_march *march, const struct rd_resonator *one, size_t k);
double rd_resonator_foot(const struct rd_march *march, const struct rd_resonator *resonator,
                         size_t k, const double *u);

#endif
