/* The lowest modes of a chain, certified by counts. */
#include "modes/certify/certify.h"

#include "chain/inertia.h"
#include "graded/blocks.h"
#include "modes/certify/work.h"
#include "modes/count/count.h"
#include "span/span.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LANES = RD_LANES, ROUNDS = 3, WIDER = 3, WIDEST = 11 };

/* With twice the modes a continuous span has one level more, springs that make it grow aside: they
   are what the others are for, with which rd_certify_size soon comes to the most there are. */
enum { LEVELS_PER_DOUBLING = 4 };

/* steps of a leg in closed form */
enum { PLAIN_LEAST = 3 };

/* how far from a mode it is counted */
static double reach_of(const struct rd_work *work, size_t i, double width)
{
    const struct rd_certified *modes = work->modes;
    return width * fmax(modes->error[i], DBL_EPSILON * fabs(modes->lambda[i]));
}

/* Whether counts so near can be of the mode: a value far above its bracket is not one of it, and to
   count the waves that are there may take long. */
static bool is_in_reach(const struct rd_work *work, size_t i, double width)
{
    const double value = work->modes->lambda[i], apart = reach_of(work, i, width);
    return value - apart <= work->search.high[i] && value + apart >= work->search.low[i];
}

/* Counts at lambda -+ width times the error: the modes index (n) are between them, these become their
   brackets, and the error is what was counted. */
static void certify_some(struct rd_work *work, const size_t *index, size_t n, double width)
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
static bool certify(struct rd_work *work, int passes)
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

/* the modes that are not certified, LANES at most */
static size_t doubtful(const struct rd_work *work, size_t *index)
{
    size_t n = 0;
    for (size_t i = 0; i < work->search.wanted && n < LANES; i++)
        if (work->modes->certified[i] == 0)
            index[n++] = i;
    return n;
}

static size_t unconfirmed(const struct rd_work *work)
{
    size_t n = 0;
    for (size_t i = 0; i < work->search.wanted; i++)
        n += work->modes->certified[i] == 0;
    return n;
}

/* An iteration may settle on the wrong mode or between two: the counts tell, the bracket is cut
   by more each round and the iteration begins again. */
static enum rd_status refine_all(struct rd_work *work)
{
    for (int round = 0; round < ROUNDS; round++) {
        enum rd_status status = rd_singles_refine(work);
        if (status == RD_OK)
            status = rd_clusters_refine(work);
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
static double near_zero(struct rd_work *work, double *below)
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
static void set_rigid(struct rd_work *work, double apart, double below)
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
            rd_rigid_shape(work->refine->walk, &work->rigid, j, rd_work_shape(work, i),
                           rd_work_motion(work, i));
    }
}

/* The brackets of the modes that exist below upper, as many as are wanted. */
static enum rd_status bracket(struct rd_work *work)
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
    rd_search_isolate(&work->search, RD_TOGETHER);
    return work->search.lost ? RD_SHORT_WAVES : RD_OK;
}

enum rd_status rd_certify(struct rd_refine *refine, struct rd_certified *modes)
{
    struct rd_work work = {.refine = refine, .modes = modes};
    modes->counts = modes->iterations = modes->redone = modes->found = modes->existing =
        modes->rigid = 0;
    memset(modes->certified, 0, modes->wanted * sizeof *modes->certified);
    if (isnan(modes->upper))
        return RD_NO_CONVERGENCE;
    rd_search_begin(refine->walk, modes->wanted, modes->bracket, &work.search);
    enum rd_status status = bracket(&work);
    if (status == RD_OK)
        status = refine_all(&work);
    modes->counts = work.search.counts;
    modes->found = status == RD_OK ? work.search.wanted : 0;
    return status;
}

bool rd_certify_size(const struct rd_walk *walk, size_t wanted, size_t *steps, size_t *pieces)
{
    const bool endless = rd_inertia_is_endless(walk->chain);
    size_t finer = 0; /* levels below a piece of the rope at rest */
    double most = 0;  /* first pieces of the rope at rest */
    bool graded = false;
    for (size_t n = wanted; n > 0; n /= 2)
        finer += LEVELS_PER_DOUBLING;
    *steps = 16 * (wanted + 4);
    *pieces = 1;
    for (size_t r = 0; r < walk->legs; r++) {
        const size_t count = walk->leg[r].count;
        const double still = rd_walk_radians(walk, walk->leg + r, 0);
        const bool whole = count < 4 && !walk->chain->inertia;
        const int halvings = rd_span_halvings(still, count);
        size_t levels = (endless ? finer : 0) + (size_t)halvings;
        levels = levels < RD_HALVINGS_MOST ? levels : RD_HALVINGS_MOST;
        most += fmax(ldexp((double)count, halvings), PLAIN_LEAST);
        for (size_t n = count; n > 1; n /= 2)
            levels++;
        *steps += whole ? count : PLAIN_LEAST + 2 * levels;
        *pieces += whole ? 0 : levels + 2;
        graded |= rd_is_graded(walk->chain, (size_t)walk->leg[r].element);
    }
    if (graded) /* each step is a piece of its own */
        *pieces += *steps;
    if (endless || (double)*steps < most)
        return false;
    *steps = (size_t)most;
    return true;
}
