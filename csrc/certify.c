/* The lowest modes of a chain, certified by counts. */
#include "certify.h"

#include "count.h"
#include "inertia.h"
#include "rigid.h"
#include "ritz.h"
#include "search.h"
#include "span.h"

#include <float.h>
#include <string.h>

enum { LANES = RD_LANES, ATTEMPTS = 12, POLISH = 3, ROUNDS = 3, WIDER = 3, WIDEST = 11 };

/* With twice the modes a continuous span has one level more, springs that make it grow aside: they
   are what the others are for, with which rd_certify_size soon comes to the most there are. */
enum { LEVELS_PER_DOUBLING = 4 };

static const double CLUSTER = 1e-8;    /* closer than this, relative, are found together */
static const double FAR = 1e-4;        /* from where a cluster is looked at first, relative */
static const double NEAR = 1e-9;       /* and then */
static const double CONVERGED = 1e-13; /* last step of the quotient by the gap, for the shape */
static const double SETTLED = 1e-6;    /* for the value alone, which is right to its square */
static const double SPREAD = 1e6;      /* of lambda in one iteration, which shares its scales */
static const double NOISE = 8;         /* what of its bound a quotient is wrong by at most times */

struct work {
    struct rd_refine *refine;
    struct rd_certified *modes;
    struct rd_search search;
    struct rd_rigid rigid;
};

static double *shape_of(const struct work *work, size_t i)
{
    const struct rd_chain *chain = work->refine->walk->chain;
    return work->modes->shape + i * chain->nodes * chain->width;
}

static void keep(const struct work *work, size_t i, const struct rd_quotient *quotient,
                 const double *lambda, size_t lane)
{
    work->modes->lambda[i] = quotient->lambda[lane];
    work->modes->error[i] = quotient->error[lane];
    if (work->modes->shape)
        rd_refine_shape(work->refine, lambda, (int)lane, shape_of(work, i));
}

/* The quotient of a vector with the share c of a mode g away is wrong by c^2 g, and the step that it
   led to leaves c times step/g: measured by the nearer end of the bracket, beyond which others are. */
static bool has_settled(const struct work *work, size_t i, const struct rd_quotient *quotient,
                        const double *lambda, size_t k)
{
    const double value = quotient->lambda[k];
    const double near = work->modes->shape ? CONVERGED : SETTLED;
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

static double middle(const struct work *work, size_t i)
{
    return (work->search.low[i] + work->search.high[i]) / 2;
}

/* whether two modes can share the scales of one iteration */
static bool are_of_one_size(const struct work *work, size_t i, size_t k)
{
    const double a = fmax(fabs(work->search.low[i]), fabs(work->search.high[i]));
    const double b = fmax(fabs(work->search.low[k]), fabs(work->search.high[k]));
    return fmax(a, b) <= SPREAD * fmin(a, b);
}

/* the next single mode from i on that is not certified yet, or how many are wanted */
static size_t next_single(const struct work *work, size_t i)
{
    while (i < work->search.wanted &&
           (work->modes->certified[i] != 0 || !rd_search_is_single(&work->search, i)))
        i++;
    return i;
}

/* gives free lanes the modes before `end`; bits of the lanes that begin */
static unsigned begin_lanes(struct work *work, size_t end, struct pool *pool)
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
static void shift_lanes(struct work *work, const struct rd_quotient *quotient, struct pool *pool)
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
static bool end_lanes(struct work *work, const struct rd_quotient *quotient, struct pool *pool)
{
    bool any = false;
    for (size_t k = 0; k < LANES; k++) {
        if (pool->busy[k] && pool->age[k] > 1 &&
            (pool->age[k] > ATTEMPTS ||
             has_settled(work, pool->mode[k], quotient, pool->lambda, k))) {
            keep(work, pool->mode[k], quotient, pool->lambda, k);
            pool->busy[k] = false;
        }
        any = any || pool->busy[k];
    }
    return any;
}

/* Rayleigh quotient iteration of the single modes from first on up to end, one a lane: a lane whose
   mode has settled goes on with the next one. */
static enum rd_status refine_singles(struct work *work, size_t first, size_t end)
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
    for (;;) {
        const unsigned begun = begin_lanes(work, end, &pool);
        rd_refine_iterate(refine, pool.lambda, begun);
        work->modes->iterations++;
        for (size_t k = 0; k < LANES; k++)
            pool.age[k]++;
        rd_refine_quotient(refine, pool.lambda, &quotient);
        if (!end_lanes(work, &quotient, &pool) && pool.next >= end)
            return RD_OK;
        shift_lanes(work, &quotient, &pool);
    }
}

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
static enum rd_status refine_cluster(struct work *work, size_t first, size_t n, double low,
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
        keep(work, first + k, &quotient, lambda, k);
    return RD_OK;
}

/* how far from a mode it is counted */
static double reach_of(const struct work *work, size_t i, double width)
{
    const struct rd_certified *modes = work->modes;
    return width * fmax(modes->error[i], DBL_EPSILON * fabs(modes->lambda[i]));
}

/* Whether counts so near can be of the mode: a value far above its bracket is not one of it, and to
   count the waves that are there may take long. */
static bool is_in_reach(const struct work *work, size_t i, double width)
{
    const double value = work->modes->lambda[i], apart = reach_of(work, i, width);
    return value - apart <= work->search.high[i] && value + apart >= work->search.low[i];
}

/* Counts at lambda -+ width times the error: the modes index (n) are between them, these become their
   brackets, and the error is what was counted. */
static void certify_some(struct work *work, const size_t *index, size_t n, double width)
{
    struct rd_certified *modes = work->modes;
    double lambda[LANES], count[LANES];
    for (size_t k = 0; k < LANES; k++) {
        const size_t j = index[k / 2 < n ? k / 2 : n - 1];
        const double apart = reach_of(work, j, width);
        lambda[k] = modes->lambda[j] + (k % 2 ? apart : -apart);
    }
    rd_count(work->refine->walk, LANES, lambda, count);
    work->search.counts += LANES;
    for (size_t k = 0; k < n; k++) {
        const size_t i = index[k];
        if (!(count[2 * k] <= (double)i && count[2 * k + 1] > (double)i))
            continue;
        modes->certified[i] = 1;
        modes->error[i] = fmax(modes->error[i], lambda[2 * k + 1] - modes->lambda[i]);
        work->search.low[i] = lambda[2 * k];
        work->search.high[i] = lambda[2 * k + 1];
        work->search.below[i] = count[2 * k];
        work->search.above[i] = count[2 * k + 1];
    }
}

/* All that are not certified yet, wider in each pass; true when all are. Where only a wide one holds,
   rounding has spoilt more than the quotient knows. */
static bool certify(struct work *work, int passes)
{
    bool all_are = true;
    double width = 1;
    for (int pass = 0; pass < passes; pass++, width *= 8) {
        size_t index[LANES / 2], n = 0;
        for (size_t i = 0; i < work->search.wanted; i++) {
            if (work->modes->certified[i] == 0 && is_in_reach(work, i, width))
                index[n++] = i;
            if (n == LANES / 2) {
                certify_some(work, index, n, width);
                n = 0;
            }
        }
        if (n > 0)
            certify_some(work, index, n, width);
        all_are = true;
        for (size_t i = 0; i < work->search.wanted; i++)
            all_are = all_are && work->modes->certified[i] != 0;
        if (all_are)
            break;
    }
    return all_are;
}

/* the single modes that are not certified yet, those of one size together */
static enum rd_status refine_round(struct work *work)
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

/* where mode i is: its value, or the bracket that it shares; false where that is not known yet */
static bool locate(const struct work *work, size_t i, double *low, double *high)
{
    const bool single = rd_search_is_single(&work->search, i);
    const double value = work->modes->lambda[i];
    *low = single ? value : work->search.low[i];
    *high = single ? value : work->search.high[i];
    return !single || rd_search_is_inside(&work->search, i, value);
}

/* from mode i on: how many lie together, and from where to where */
static size_t group(const struct work *work, size_t i, double *low, double *high)
{
    size_t n = 1;
    double next_low, next_high;
    if (!locate(work, i, low, high))
        return n;
    for (; i + n < work->search.wanted; n++) {
        if (!locate(work, i + n, &next_low, &next_high) ||
            next_low - *high > CLUSTER * fmax(fabs(*low), fabs(*high)))
            break;
        *high = fmax(*high, next_high);
    }
    const double end = rd_search_is_single(&work->search, i + n - 1)
                           ? (double)(i + n)
                           : work->search.above[i + n - 1];
    return (size_t)end - i;
}

/* Modes that lie together, the single ones found, are found once more as a block. */
static enum rd_status refine_groups(struct work *work)
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

/* the modes that are not certified, LANES at most */
static size_t doubtful(const struct work *work, size_t *index)
{
    size_t n = 0;
    for (size_t i = 0; i < work->search.wanted && n < LANES; i++)
        if (work->modes->certified[i] == 0)
            index[n++] = i;
    return n;
}

/* whether as many modes lie together as there are lanes: counts do not tell them apart for certain */
static bool is_crowded(const struct work *work)
{
    const double *lambda = work->modes->lambda;
    size_t n = 1;
    for (size_t i = 1; i < work->search.wanted && n < LANES; i++)
        n = lambda[i] - lambda[i - 1] <= CLUSTER * fabs(lambda[i]) ? n + 1 : 1;
    return n >= LANES;
}

static size_t unconfirmed(const struct work *work)
{
    size_t n = 0;
    for (size_t i = 0; i < work->search.wanted; i++)
        n += work->modes->certified[i] == 0;
    return n;
}

/* An iteration may settle on the wrong mode or between two: the counts tell, the bracket is cut
   by more each round and the iteration begins again. */
static enum rd_status refine_all(struct work *work)
{
    for (int round = 0; round < ROUNDS; round++) {
        enum rd_status status = refine_round(work);
        if (status == RD_OK)
            status = refine_groups(work);
        if (status != RD_OK)
            return status;
        if (certify(work, WIDER))
            return RD_OK;
        size_t index[LANES];
        const size_t n = doubtful(work, index);
        if (round == 0)
            work->modes->redone = unconfirmed(work);
        for (int cut = 0; cut < 1 << round; cut++)
            rd_search_cut(&work->search, n, index);
    }
    certify(work, WIDEST);
    return RD_OK;
}

/* Rigid motions are exactly zero: the counts on both sides must tell as many, as near as they are
   right, and nearer ones are of rounding. Returns how near [rad^2/s^2]. */
static double near_zero(struct work *work, double *below)
{
    double lambda[LANES], count[LANES];
    for (size_t k = 0; k < LANES; k++) {
        const double apart = work->search.size * pow(10, -8 + 2.5 * (double)(k / 2));
        lambda[k] = k % 2 ? apart : -apart;
    }
    rd_count(work->refine->walk, LANES, lambda, count);
    work->search.counts += LANES;
    size_t k = 0;
    while (k + 2 < LANES && count[k + 1] - count[k] != (double)work->rigid.count)
        k += 2;
    *below = count[k + 1] - count[k] == (double)work->rigid.count ? count[k] : -1;
    return lambda[k + 1];
}

/* below: how many are less than -apart, or -1 where counts have not told */
static void set_rigid(struct work *work, double apart, double below)
{
    struct rd_certified *modes = work->modes;
    if (below < 0)
        return;
    rd_search_learn(&work->search, -apart, below);
    rd_search_learn(&work->search, apart, below + (double)modes->rigid);
    for (size_t j = 0; j < modes->rigid; j++) {
        const size_t i = (size_t)below + j;
        if (i >= work->search.wanted)
            break;
        work->search.low[i] = -apart;
        work->search.high[i] = apart;
        work->search.below[i] = (double)i;
        work->search.above[i] = (double)(i + 1);
        modes->lambda[i] = modes->error[i] = 0;
        modes->certified[i] = 1;
        if (modes->shape)
            rd_rigid_shape(work->refine->walk, &work->rigid, j, shape_of(work, i));
    }
}

/* The brackets of the modes that exist below upper, as many as are wanted. */
static enum rd_status bracket(struct work *work)
{
    struct rd_certified *modes = work->modes;
    double apart = 1e-10 * work->search.size, unstable = -1;
    enum rd_status status = rd_rigid_fill(work->refine->walk, &work->rigid);
    if (status == RD_OK && work->rigid.count > 0)
        apart = near_zero(work, &unstable);
    if (status == RD_OK)
        status = rd_search_bottom(&work->search, apart);
    if (status != RD_OK)
        return status;
    const size_t finite = rd_inertia_positive(work->refine->walk->chain);
    modes->rigid = work->rigid.count;
    if (work->search.wanted > finite)
        work->search.wanted = finite;
    if (work->search.wanted == 0) {
        modes->existing = finite;
        return RD_OK;
    }
    size_t below;
    status = rd_search_top(&work->search, modes->upper, &below);
    if (status != RD_OK)
        return status;
    modes->existing = modes->upper < INFINITY && below < finite ? below : finite;
    if (work->search.wanted > below)
        work->search.wanted = below;
    if (modes->rigid > 0)
        set_rigid(work, apart, unstable);
    rd_search_isolate(&work->search, CLUSTER);
    return work->search.lost ? RD_SHORT_WAVES : RD_OK;
}

enum rd_status rd_certify(struct rd_refine *refine, struct rd_certified *modes)
{
    struct work work = {.refine = refine, .modes = modes};
    modes->counts = modes->iterations = modes->redone = modes->found = modes->existing =
        modes->rigid = 0;
    memset(modes->certified, 0, modes->wanted * sizeof *modes->certified);
    if (isnan(modes->upper))
        return RD_NO_CONVERGENCE;
    rd_search_begin(refine->walk, modes->wanted, modes->bracket, &work.search);
    enum rd_status status = bracket(&work);
    if (status == RD_OK)
        status = refine_all(&work);
    if (status == RD_OK && is_crowded(&work))
        status = RD_CLUSTER;
    modes->counts = work.search.counts;
    modes->found = status == RD_OK ? work.search.wanted : 0;
    return status;
}

bool rd_certify_size(const struct rd_walk *walk, size_t wanted, size_t *steps, size_t *pieces)
{
    const bool endless = rd_inertia_is_endless(walk->chain);
    size_t finer = 0; /* levels below a piece of the rope at rest */
    double most = 0;  /* first pieces of the rope at rest */
    for (size_t n = wanted; n > 0; n /= 2)
        finer += LEVELS_PER_DOUBLING;
    *steps = 16 * (wanted + 4);
    *pieces = 1;
    for (size_t r = 0; r < walk->legs; r++) {
        const size_t count = walk->leg[r].count;
        const double still = rd_walk_radians(walk, walk->leg + r, 0);
        const bool whole = count < 4 && still == 0 && !endless;
        const int halvings = rd_span_halvings(still, count);
        size_t levels = (endless ? finer : 0) + (size_t)halvings;
        levels = levels < RD_HALVINGS_MOST ? levels : RD_HALVINGS_MOST;
        most += ldexp((double)count, halvings);
        for (size_t n = count; n > 1; n /= 2)
            levels++;
        *steps += whole ? count : 2 + 2 * levels;
        *pieces += whole ? 0 : levels + 1;
    }
    if (endless || (double)*steps < most)
        return false;
    *steps = (size_t)most;
    return true;
}
