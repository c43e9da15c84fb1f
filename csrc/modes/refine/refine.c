/* Inverse iteration on a walk: the right width. */
#include "modes/refine/refine.h"

#include <stdint.h>

enum { ALIGNMENT = 8 * RD_LANES };

static lanes *take_lanes(struct rd_workspace *workspace, size_t count)
{
    char *at = rd_take(workspace, count * sizeof(lanes) + ALIGNMENT, 1);
    if (at == NULL)
        return NULL;
    return (lanes *)(void *)(at + (ALIGNMENT - (uintptr_t)at % ALIGNMENT) % ALIGNMENT);
}

void rd_refine_take(const struct rd_walk *walk, size_t steps, size_t pieces, size_t blocks,
                    struct rd_workspace *workspace, struct rd_refine *refine)
{
    const size_t w = walk->chain->width, n = blocks * RD_LANES;
    *refine =
        (struct rd_refine){.walk = walk, .capacity = steps, .pieces = pieces, .blocks = blocks};
    refine->step = rd_take(workspace, steps, sizeof *refine->step);
    refine->piece = take_lanes(workspace, pieces * 6 * w * w);
    refine->receptance = take_lanes(workspace, steps * w * (w + 3));
    refine->vectors = take_lanes(workspace, blocks * rd_refine_apart(refine));
    refine->next = take_lanes(workspace, walk->chain->attached);
    refine->square = rd_take(workspace, RD_SQUARES * n * n, sizeof *refine->square);
    if (refine->vectors != NULL)
        rd_refine_choose(refine, 0);
}

void rd_refine_choose(struct rd_refine *refine, size_t block)
{
    const size_t w = refine->walk->chain->width;
    refine->block = block;
    refine->u = refine->vectors + block * rd_refine_apart(refine);
    refine->f = refine->u + (refine->capacity + 1) * w;
    refine->y = refine->f + refine->capacity * w;
}

enum rd_status rd_refine_plan(struct rd_refine *refine, const double *lambda)
{
    enum rd_status (*const of[])(struct rd_refine *, const double *) = {rd_plan_1, rd_plan_2,
                                                                        rd_plan_3, rd_plan_4};
    if (rd_stop_is_asked(&refine->walk->stop))
        return RD_INTERRUPTED;
    return of[refine->walk->chain->width - 1](refine, lambda);
}

void rd_refine_iterate(struct rd_refine *refine, const double *lambda, unsigned begin)
{
    void (*const of[])(struct rd_refine *, const double *, unsigned) = {rd_iterate_1, rd_iterate_2,
                                                                        rd_iterate_3, rd_iterate_4};
    of[refine->walk->chain->width - 1](refine, lambda, begin);
}

void rd_refine_quotient(struct rd_refine *refine, const double *lambda,
                        struct rd_quotient *quotient)
{
    void (*const of[])(struct rd_refine *, const double *, struct rd_quotient *) = {
        rd_quotient_1, rd_quotient_2, rd_quotient_3, rd_quotient_4};
    of[refine->walk->chain->width - 1](refine, lambda, quotient);
}

void rd_refine_gram(struct rd_refine *refine, const double *lambda, size_t blocks, double *A,
                    double *M)
{
    void (*const of[])(struct rd_refine *, const double *, size_t, double *,
                       double *) = {rd_gram_1, rd_gram_2, rd_gram_3, rd_gram_4};
    of[refine->walk->chain->width - 1](refine, lambda, blocks, A, M);
}

void rd_refine_shape(struct rd_refine *refine, const double *lambda, int lane, double *u, double *y)
{
    void (*const of[])(struct rd_refine *, const double *, int,
                       double *) = {rd_shape_1, rd_shape_2, rd_shape_3, rd_shape_4};
    of[refine->walk->chain->width - 1](refine, lambda, lane, u);
    for (size_t k = 0; k < refine->walk->chain->attached; k++)
        y[k] = refine->y[k][lane];
}
