/* What the finding of certified modes works with, and its two kinds of refinement. */
#ifndef RD_CERTIFY_WORK_H
#define RD_CERTIFY_WORK_H

#include "modes/certify/certified.h"
#include "modes/certify/rigid.h"
#include "modes/certify/search.h"
#include "modes/refine/refine.h"

/* modes that are closer than this, relative, are found together */
static const double RD_TOGETHER = 1e-8;

struct rd_work {
    struct rd_refine *refine;
    struct rd_certified *modes;
    struct rd_search search;
    struct rd_rigid rigid;
};

static inline double *rd_work_shape(const struct rd_work *work, size_t i)
{
    const struct rd_chain *chain = work->refine->walk->chain;
    return work->modes->shape + i * chain->nodes * chain->width;
}

static inline double *rd_work_motion(const struct rd_work *work, size_t i)
{
    return work->modes->motion + i * work->refine->walk->chain->attached;
}

/* takes value, bound and shape of mode i from a lane */
static inline void rd_work_keep(const struct rd_work *work, size_t i,
                                const struct rd_quotient *quotient, const double *lambda,
                                size_t lane)
{
    work->modes->lambda[i] = quotient->lambda[lane];
    work->modes->error[i] = quotient->error[lane];
    if (work->modes->shape)
        rd_refine_shape(work->refine, lambda, (int)lane, rd_work_shape(work, i),
                        rd_work_motion(work, i));
}

/* Refines the modes that are alone in their bracket and not certified yet, a lane each. */
enum rd_status rd_singles_refine(struct rd_work *work);

/* Refines those that lie together and are not certified yet. */
enum rd_status rd_clusters_refine(struct rd_work *work);

#endif
