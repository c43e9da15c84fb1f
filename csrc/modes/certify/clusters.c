/* Block steps and Rayleigh-Ritz for modes that lie together. */
#include "modes/certify/ritz.h"
#include "modes/certify/work.h"
#include "modes/count/count.h"

#include <math.h>
#include <string.h>

enum { LANES = RD_LANES, POLISH = 3, MOST = 8 };

static const double FAR = 1e-4;   /* from where a cluster is looked at first, relative */
static const double NEAR = 1e-13; /* and then: shapes are those at lambda, off by as much */

/* blocks for n modes and a vector more at least */
static size_t blocks_for(size_t n)
{
    return n / LANES + 1;
}

/* rows n apart <- rows `from` apart, their first n */
static void narrow(size_t from, size_t n, double *A)
{
    for (size_t i = 0; i < n; i++)
        memmove(A + i * n, A + i * from, n * sizeof *A);
}

/* Ritz vectors of the first `from` vectors, those n in front whose values are nearest to lambda; false
   where there are less. */
static bool ritz_vectors(struct rd_refine *refine, const double *lambda, double near, size_t from,
                         size_t n)
{
    const size_t blocks = blocks_for(n), all = blocks * LANES, w = refine->walk->chain->width;
    double *const A = refine->square, *const M = A + all * all, *const C = M + all * all;
    double *const work = C + all * all, theta[RD_RITZ_MOST];
    rd_refine_gram(refine, lambda, blocks, A, M);
    narrow(all, from, A);
    narrow(all, from, M);
    const size_t found = rd_ritz(from, A, M, theta, C, work);
    if (found < n)
        return false;
    size_t start = 0;
    while (start + n < found &&
           fabs(theta[start + n] + lambda[0] - near) < fabs(theta[start] + lambda[0] - near))
        start++;
    const size_t count[] = {(refine->steps + 1) * w, refine->steps * w,
                            refine->walk->chain->attached};
    lanes *const x[] = {refine->u, refine->f, refine->y};
    for (int k = 0; k < 3; k++)
        rd_ritz_combine(from, n, C + start, from, count[k], rd_refine_apart(refine), x[k]);
    return true;
}

/* plans a block at one lambda */
static enum rd_status plan_block(struct rd_refine *refine, double at, double *lambda)
{
    for (size_t k = 0; k < LANES; k++)
        lambda[k] = at;
    return rd_refine_plan(refine, lambda);
}

/* The values of n vectors, least, largest and the largest error. */
struct extent {
    double low, high, error;
};

/* of the modes from `first` on, kept where they are the last and not certified yet */
static struct extent extent_of(struct rd_work *work, const double *lambda, size_t first, size_t n,
                               bool last)
{
    struct extent extent = {INFINITY, -INFINITY, 0};
    struct rd_quotient quotient;
    for (size_t i = 0; i < n; i++) {
        const size_t k = i % LANES;
        if (k == 0) {
            rd_refine_choose(work->refine, i / LANES);
            rd_refine_quotient(work->refine, lambda, &quotient);
        }
        extent.low = fmin(extent.low, quotient.lambda[k]);
        extent.high = fmax(extent.high, quotient.lambda[k]);
        extent.error = fmax(extent.error, quotient.error[k]);
        if (last && first + i < work->search.wanted && work->modes->certified[first + i] == 0)
            rd_work_keep(work, first + i, &quotient, lambda, k);
    }
    rd_refine_choose(work->refine, 0);
    return extent;
}

static bool has_moved(const struct extent *before, const struct extent *now)
{
    return fmax(fabs(now->low - before->low), fabs(now->high - before->high)) > now->error;
}

/* inverse iteration of all blocks, from fixed loads where they begin */
static void iterate(struct rd_work *work, const double *lambda, size_t blocks, bool begin)
{
    for (size_t b = 0; b < blocks; b++) {
        rd_refine_choose(work->refine, b);
        if (begin)
            rd_refine_iterate(work->refine, lambda, RD_ALL_LANES);
        rd_refine_iterate(work->refine, lambda, 0);
        work->modes->iterations++;
    }
    rd_refine_choose(work->refine, 0);
}

/* Block steps just below the n modes from `first` on, which lie within low .. high: Rayleigh-Ritz among
   all vectors from `far` below them, then among those n alone from as near as the cluster is wide,
   where what pieces and quotients take as linear in lambda is so to the last digit. */
static enum rd_status refine_cluster(struct rd_work *work, size_t first, size_t n, double low,
                                     double high, double far)
{
    const size_t blocks = blocks_for(n);
    double lambda[LANES];
    struct extent extent = {low, high, 0}, before = {-INFINITY, INFINITY, 0};
    double width = far;
    if (n >= RD_RITZ_MOST)
        return RD_CLUSTER;
    if (blocks > work->refine->blocks) {
        work->modes->blocks = blocks;
        return RD_NO_MEMORY;
    }
    for (int i = 0; i < POLISH || (i < MOST && has_moved(&before, &extent)); i++) {
        const enum rd_status status = plan_block(work->refine, extent.low - width, lambda);
        if (status != RD_OK)
            return status;
        iterate(work, lambda, blocks, i == 0);
        const size_t from = i == 0 ? blocks * LANES : n;
        if (!ritz_vectors(work->refine, lambda, (low + high) / 2, from, n))
            return RD_NO_CONVERGENCE;
        before = extent;
        extent = extent_of(work, lambda, first, n, false);
        width = fmax(extent.high - extent.low, NEAR * fabs(extent.low));
        width = fmax(width, 4 * extent.error);
    }
    extent_of(work, lambda, first, n, true);
    return RD_OK;
}

/* Where mode i is: its value, or the bracket that it shares, or that is narrow: counts among modes that
   lie together may isolate one wrongly. False where that is not known yet. */
static bool locate(const struct rd_work *work, size_t i, double *low, double *high)
{
    const struct rd_search *search = &work->search;
    const double value = work->modes->lambda[i];
    *low = search->low[i];
    *high = search->high[i];
    if (!rd_search_is_single(search, i))
        return true;
    if (!rd_search_is_inside(search, i, value))
        return *high - *low <= RD_TOGETHER * fmax(fabs(*low), fabs(*high));
    *low = *high = value;
    return true;
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

/* Modes that a block has: those n from `first` on, and the ones beside them that are nearer than
   others beyond them by a factor of ten. */
struct window {
    size_t first, n;
    double far; /* from where the block is looked at first */
};

static struct window window_of(struct rd_work *work, size_t first, size_t n, double low,
                               double high)
{
    enum { RADII = LANES / 2 };
    double lambda[LANES], count[LANES], radius[RADII];
    for (size_t j = 0; j < RADII; j++) {
        const double part = FAR * pow(10, (double)j + 1 - RADII);
        radius[j] = fmax(high - low, part * fmax(fabs(low), fabs(high)));
        lambda[2 * j] = low - radius[j];
        lambda[2 * j + 1] = high + radius[j];
    }
    rd_count(work->refine->walk, LANES, lambda, count);
    work->search.counts += LANES;
    size_t own = 0, end;
    for (end = 1; end < RADII; end++) {
        const bool same =
            count[2 * own] == count[2 * end] && count[2 * own + 1] == count[2 * end + 1];
        if (!same && end > own + 1)
            break;
        own = same ? own : end;
    }
    const double begins = fmin(count[2 * own], (double)first);
    const double ends = fmax(count[2 * own + 1], (double)(first + n));
    return (struct window){
        .first = (size_t)begins,
        .n = (size_t)(ends - begins),
        .far = radius[end == RADII ? end - 1 : end - 2],
    };
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
        const struct window window = window_of(work, i, n, low, high);
        status = refine_cluster(work, window.first, window.n, low, high, window.far);
        n = window.first + window.n - i;
    }
    return status;
}
