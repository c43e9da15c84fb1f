/* Block steps and Rayleigh-Ritz for modes that lie together. */
#include "modes/certify/ritz.h"
#include "modes/certify/work.h"

#include <math.h>

enum { LANES = RD_LANES, POLISH = 3 };

static const double FAR = 1e-4;   /* from where a cluster is looked at first, relative */
static const double NEAR = 1e-13; /* and then: shapes are those at lambda, off by as much */

/* Ritz vectors of the lanes, those n in front whose values are nearest to lambda; false where there
   are less. */
static bool ritz_lanes(struct rd_refine *refine, const double *lambda, double near, size_t from,
                       size_t n)
{
    double A[LANES * LANES], M[LANES * LANES], theta[LANES], C[LANES * LANES];
    double chosen[LANES * LANES] = {0};
    rd_refine_gram(refine, lambda, A, M);
    for (size_t i = 0; i < from; i++)
        for (size_t j = 0; j < from; j++) {
            A[i * from + j] = A[i * LANES + j];
            M[i * from + j] = M[i * LANES + j];
        }
    const size_t found = rd_ritz(from, A, M, theta, C);
    if (found < n)
        return false;
    size_t start = 0;
    while (start + n < found &&
           fabs(theta[start + n] + lambda[0] - near) < fabs(theta[start] + lambda[0] - near))
        start++;
    for (size_t i = 0; i < from; i++)
        for (size_t j = 0; j < n; j++)
            chosen[i * n + j] = C[i * from + start + j];
    const size_t w = refine->walk->chain->width;
    rd_ritz_combine(n, chosen, (refine->steps + 1) * w, refine->u);
    rd_ritz_combine(n, chosen, refine->steps * w, refine->f);
    rd_ritz_combine(n, chosen, refine->walk->chain->attached, refine->y);
    return true;
}

/* plans a block at one lambda */
static enum rd_status plan_block(struct rd_refine *refine, double at, double *lambda)
{
    for (size_t k = 0; k < LANES; k++)
        lambda[k] = at;
    return rd_refine_plan(refine, lambda);
}

/* The values of the lanes 0 .. n - 1, least, largest and the largest error. */
struct extent {
    double low, high, error;
};

static struct extent extent_of(struct rd_refine *refine, const double *lambda, size_t n,
                               struct rd_quotient *quotient)
{
    struct extent extent = {INFINITY, -INFINITY, 0};
    rd_refine_quotient(refine, lambda, quotient);
    for (size_t k = 0; k < n; k++) {
        extent.low = fmin(extent.low, quotient->lambda[k]);
        extent.high = fmax(extent.high, quotient->lambda[k]);
        extent.error = fmax(extent.error, quotient->error[k]);
    }
    return extent;
}

/* Block steps just below a cluster of n modes: Rayleigh-Ritz among all lanes from far, then among
   those n alone from as near as the cluster is wide, where what pieces and quotients take as linear
   in lambda is so to the last digit. */
static enum rd_status refine_cluster(struct rd_work *work, size_t first, size_t n, double low,
                                     double high)
{
    struct rd_refine *refine = work->refine;
    struct rd_quotient quotient;
    double lambda[LANES];
    struct extent extent = {low, high, 0};
    double width = fmax(high - low, FAR * fmax(fabs(low), fabs(high)));
    for (int i = 0; i < POLISH; i++) {
        const enum rd_status status = plan_block(refine, extent.low - width, lambda);
        if (status != RD_OK)
            return status;
        if (i == 0)
            rd_refine_iterate(refine, lambda, RD_ALL_LANES);
        rd_refine_iterate(refine, lambda, 0);
        work->modes->iterations++;
        if (!ritz_lanes(refine, lambda, (low + high) / 2, i == 0 ? LANES : n, n))
            return RD_NO_CONVERGENCE;
        extent = extent_of(refine, lambda, n, &quotient);
        width = fmax(extent.high - extent.low, NEAR * fabs(extent.low));
        width = fmax(width, 4 * extent.error);
    }
    for (size_t k = 0; k < n && first + k < work->search.wanted; k++)
        rd_work_keep(work, first + k, &quotient, lambda, k);
    return RD_OK;
}

/* where mode i is: its value, or the bracket that it shares; false where that is not known yet */
static bool locate(const struct rd_work *work, size_t i, double *low, double *high)
{
    const bool single = rd_search_is_single(&work->search, i);
    const double value = work->modes->lambda[i];
    *low = single ? value : work->search.low[i];
    *high = single ? value : work->search.high[i];
    return !single || rd_search_is_inside(&work->search, i, value);
}

/* from mode i on: how many lie together, and from where to where */
static size_t group(const struct rd_work *work, size_t i, double *low, double *high)
{
    size_t n = 1;
    double next_low, next_high;
    if (!locate(work, i, low, high))
        return n;
    for (; i + n < work->search.wanted; n++) {
        if (!locate(work, i + n, &next_low, &next_high) ||
            next_low - *high > RD_TOGETHER * fmax(fabs(*low), fabs(*high)))
            break;
        *high = fmax(*high, next_high);
    }
    const double end = rd_search_is_single(&work->search, i + n - 1)
                           ? (double)(i + n)
                           : work->search.above[i + n - 1];
    return (size_t)end - i;
}

/* Modes that lie together, the single ones found, are found once more as a block. */
enum rd_status rd_clusters_refine(struct rd_work *work)
{
    enum rd_status status = RD_OK;
    double low, high;
    for (size_t i = 0, n; i < work->search.wanted && status == RD_OK; i += n) {
        n = group(work, i, &low, &high);
        bool certified = true;
        for (size_t k = i; k < i + n && k < work->search.wanted; k++)
            certified = certified && work->modes->certified[k] != 0;
        if (n == 1 || certified)
            continue;
        status = n < LANES ? refine_cluster(work, i, n, low, high) : RD_CLUSTER;
    }
    return status;
}
