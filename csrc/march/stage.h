/* One implicit stage: where it begins, its linear answer, its share of the step. */
#ifndef RD_MARCH_STAGE_H
#define RD_MARCH_STAGE_H

#include "march/plan.h"

/* star and lean are those of stage 0 or 1 */
void rd_march_choose(struct rd_march *march, int stage);

/* Where a stage begins; the loads on it are then there until rd_march_take. */
void rd_march_begin(struct rd_march *march, double g, int stage, const struct rd_push *push);

/* lean and alone at the tension of the factors */
void rd_march_lean(struct rd_march *march, const struct rd_push *push);

/* What the forces of the laws are found from: increments of their points alone, per force, and
   where they set out, as in rd_laws_solve. */
void rd_march_points(const struct rd_march *march, double *alone, double *compliance,
                     double *start);

/* lean with the forces of the laws */
void rd_march_add_laws(struct rd_march *march);

/* the changes of velocity; after stage 1 start is the end of the step */
void rd_march_take(struct rd_march *march, double g, int stage);

/* takes the loads away */
void rd_march_clear(struct rd_march *march, const struct rd_push *push);

#endif
