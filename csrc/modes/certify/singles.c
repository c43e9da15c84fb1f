/* Rayleigh quotient iteration of modes that are alone in their bracket. */
#include "modes/certify/work.h"

#include <math.h>

enum { LANES = RD_LANES, ATTEMPTS = 12 };

static const double CONVERGED = 1e-13; /* last step of the quotient by the gap, for the shape */
static const double SETTLED = 1e-6;    /* for the value alone, which is right to its square */
static const double CURVED = 1e-8;     /* where pieces move inside, whose forms are not linear */
static const double SPREAD = 1e6;      /* of lambda in one iteration, which shares its scales */
static const double NOISE = 8;         /* what of its bound a quotient is wrong by at most times */

/* The quotient of a vector with the share c of a mode g away is wrong by c^2 g, and the step that it
   led to leaves c times step/g: measured by the nearer end of the bracket, beyond which others are. */
static bool has_settled(const struct rd_work *work, size_t i, const struct rd_quotient *quotient,
                        const double *lambda, size_t k)
{
    const double value = quotient->lambda[k];
    const double alone = rd_refine_is_linear(work->refine) ? SETTLED : CURVED;
    const double near = work->modes->shape ? CONVERGED : alone;
    const double gap = fmin(value - work->search.low[i], work->search.high[i] - value);
    return gap >= 0 && fabs(value - lambda[k]) <= fmax(near * gap, quotient->error[k] / NOISE);
}

/* Lanes at work on single modes: whose mode, at which lambda, and how many iterations old. */
struct pool {
    size_t mode[LANES];
    double lambda[LANES];
    int age[LANES];
    bool busy[LANES];
    size_t next; /* mode to begin with when a lane is free */
};

static double middle(const struct rd_work *work, size_t i)
{
    return (work->search.low[i] + work->search.high[i]) / 2;
}

/* whether two modes can share the scales of one iteration */
static bool are_of_one_size(const struct rd_work *work, size_t i, size_t k)
{
    const double a = fmax(fabs(work->search.low[i]), fabs(work->search.high[i]));
    const double b = fmax(fabs(work->search.low[k]), fabs(work->search.high[k]));
    return fmax(a, b) <= SPREAD * fmin(a, b);
}

/* the next single mode from i on that is not certified yet, or how many are wanted */
static size_t next_single(const struct rd_work *work, size_t i)
{
    while (i < work->search.wanted &&
           (work->modes->certified[i] != 0 || !rd_search_is_single(&work->search, i)))
        i++;
    return i;
}

/* gives free lanes the modes before `end`; bits of the lanes that begin */
static unsigned begin_lanes(struct rd_work *work, size_t end, struct pool *pool)
{
    unsigned begun = 0;
    for (size_t k = 0; k < LANES; k++) {
        if (pool->busy[k] || pool->next >= end)
            continue;
        pool->mode[k] = pool->next;
        pool->lambda[k] = middle(work, pool->next);
        pool->age[k] = 0;
        pool->busy[k] = true;
        begun |= 1u << k;
        pool->next = next_single(work, pool->next + 1);
    }
    return begun;
}

/* The next lambda of each lane: the quotient, or the middle of a bracket that is cut because the
   quotient has left it. */
static void shift_lanes(struct rd_work *work, const struct rd_quotient *quotient, struct pool *pool)
{
    size_t lost[LANES], count = 0;
    for (size_t k = 0; k < LANES; k++)
        if (pool->busy[k] && pool->age[k] > 1 &&
            !rd_search_is_inside(&work->search, pool->mode[k], quotient->lambda[k]))
            lost[count++] = pool->mode[k];
    if (count > 0)
        rd_search_cut(&work->search, count, lost);
    for (size_t k = 0; k < LANES; k++) {
        const size_t i = pool->mode[k];
        if (!pool->busy[k] || pool->age[k] < 2)
            continue;
        const bool inside = rd_search_is_inside(&work->search, i, quotient->lambda[k]);
        pool->lambda[k] = inside ? quotient->lambda[k] : middle(work, i);
    }
}

/* ends lanes that have settled or tried for too long; true while any is at work */
static bool end_lanes(struct rd_work *work, const struct rd_quotient *quotient, struct pool *pool)
{
    bool any = false;
    for (size_t k = 0; k < LANES; k++) {
        if (pool->busy[k] && pool->age[k] > 1 &&
            (pool->age[k] > ATTEMPTS ||
             has_settled(work, pool->mode[k], quotient, pool->lambda, k))) {
            rd_work_keep(work, pool->mode[k], quotient, pool->lambda, k);
            pool->busy[k] = false;
        }
        any = any || pool->busy[k];
    }
    return any;
}

/* Rayleigh quotient iteration of the single modes from first on up to end, one a lane: a lane whose
   mode has settled goes on with the next one. */
static enum rd_status refine_singles(struct rd_work *work, size_t first, size_t end)
{
    struct rd_refine *refine = work->refine;
    struct rd_quotient quotient;
    struct pool pool = {.next = first};
    double extreme[LANES];
    size_t last = first;
    for (size_t i = first; i < end; i = next_single(work, i + 1))
        last = i;
    for (size_t k = 0; k < LANES; k++) {
        extreme[k] = k % 2 ? work->search.high[last] : work->search.low[first];
        pool.lambda[k] = middle(work, first);
    }
    const enum rd_status status = rd_refine_plan(refine, extreme);
    if (status != RD_OK)
        return status;
    for (bool begun = false;; begun = true) {
        const unsigned fresh = begin_lanes(work, end, &pool);
        /* lanes without a mode begin too: nothing is read that was not written */
        rd_refine_iterate(refine, pool.lambda, begun ? fresh : RD_ALL_LANES);
        work->modes->iterations++;
        for (size_t k = 0; k < LANES; k++)
            pool.age[k]++;
        rd_refine_quotient(refine, pool.lambda, &quotient);
        if (!end_lanes(work, &quotient, &pool) && pool.next >= end)
            return RD_OK;
        if (rd_stop_is_asked(&refine->walk->stop))
            return RD_INTERRUPTED;
        shift_lanes(work, &quotient, &pool);
    }
}

/* the single modes that are not certified yet, those of one size together */
enum rd_status rd_singles_refine(struct rd_work *work)
{
    enum rd_status status = RD_OK;
    size_t first = next_single(work, 0);
    while (first < work->search.wanted && status == RD_OK) {
        size_t end = next_single(work, first + 1);
        while (end < work->search.wanted && are_of_one_size(work, first, end))
            end = next_single(work, end + 1);
        status = refine_singles(work, first, end);
        first = end;
    }
    return status;
}
