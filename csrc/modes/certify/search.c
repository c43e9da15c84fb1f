/* Brackets of the lowest modes, from counts. */
#include "modes/certify/search.h"

#include "modes/count/count.h"

#include <math.h>

enum { LANES = RD_LANES, DEEPER = 48, HIGHER = 60, CUTS = 200, CUTS_EACH = 8 };

/* deeper than this times the stiffest there is, a count is of rounding */
static const double DEEPEST = 1e8;

/* a step to the next lambda that is counted; shorter ones lead nowhere */
static const double SHORTEST = 1.01;

/* of the size of the first mode; nearer to zero, counts are of rounding */
static const double ABSOLUTE = 1e-13;

/* 1/(G M) of the coordinate where it is least */
static double typical(const struct rd_walk *walk)
{
    double lambda = INFINITY;
    for (size_t i = 0; i < walk->chain->width; i++) {
        const double x = walk->flexibility[i] * walk->mass[i];
        lambda = x > 0 ? fmin(lambda, 1 / x) : lambda;
    }
    return lambda < INFINITY ? lambda : 1;
}

void rd_search_begin(const struct rd_walk *walk, size_t wanted, double *bracket,
                     struct rd_search *search)
{
    *search = (struct rd_search){
        .walk = walk,
        .wanted = wanted,
        .size = typical(walk),
        .low = bracket,
        .high = bracket + wanted,
        .below = bracket + 2 * wanted,
        .above = bracket + 3 * wanted,
    };
    for (size_t i = 0; i < wanted; i++) {
        search->low[i] = -INFINITY;
        search->high[i] = INFINITY;
        search->below[i] = 0;
        search->above[i] = INFINITY;
    }
}

void rd_search_learn(struct rd_search *search, double lambda, double count)
{
    for (size_t i = 0; i < search->wanted; i++) {
        if (count <= (double)i && lambda > search->low[i]) {
            search->low[i] = lambda;
            search->below[i] = count;
        }
        if (count > (double)i && lambda < search->high[i]) {
            search->high[i] = lambda;
            search->above[i] = count;
        }
    }
}

/* counts RD_LANES lambda and tightens all brackets */
static void count_all(struct rd_search *search, const double *lambda, double *count)
{
    rd_count(search->walk, LANES, lambda, count);
    search->counts += LANES;
    for (size_t k = 0; k < LANES; k++) {
        rd_search_learn(search, lambda[k], count[k]);
        search->lost = search->lost || isnan(count[k]);
    }
}

/* Counts at -at, step times deeper in each lane; true where one of them is 0. What is deeper than the
   first of those is not learnt: an M that is not positive has eigenvalues there that are no modes. */
static bool look_below(struct rd_search *search, double *at, double step, bool *unknown)
{
    double lambda[LANES], count[LANES];
    for (size_t k = 0; k < LANES; k++, *at *= step)
        lambda[k] = -*at;
    rd_count(search->walk, LANES, lambda, count);
    search->counts += LANES;
    for (size_t k = 0; k < LANES; k++) {
        rd_search_learn(search, lambda[k], count[k]);
        *unknown = *unknown || isnan(count[k]);
        if (count[k] == 0)
            return true;
    }
    return false;
}

/* -nearest at first, or as deep as it needs: an M that is not positive leaves a window */
enum rd_status rd_search_bottom(struct rd_search *search, double nearest)
{
    double at = nearest;
    bool unknown = false;
    if (look_below(search, &at, 16, &unknown))
        return RD_OK;
    const double deepest = DEEPEST * fmax(rd_walk_ceiling(search->walk), search->size);
    at = nearest;
    for (int pass = 0; pass < DEEPER && at < deepest; pass++)
        if (look_below(search, &at, 2, &unknown))
            return RD_OK;
    return unknown ? RD_SHORT_WAVES : RD_UNSTABLE_MASSLESS;
}

/* In small steps at first, since a count costs what lambda has half waves; in smaller ones where the
   highest of them cannot be counted, which may be far beyond what is wanted. */
enum rd_status rd_search_top(struct rd_search *search, double upper, size_t *below)
{
    double lambda[LANES], count[LANES];
    double at = search->size, counted = at, step = 2.5, longest = INFINITY;
    for (int pass = 0; pass < HIGHER; pass++) {
        for (size_t k = 0; k < LANES; k++, at *= step)
            lambda[k] = fmin(fmin(at, 1e300), upper);
        count_all(search, lambda, count);
        if (search->lost) {
            if (step < SHORTEST)
                return RD_SHORT_WAVES;
            search->lost = false;
            longest = step = sqrt(step);
            at = counted;
            continue;
        }
        if (count[LANES - 1] >= (double)search->wanted || lambda[LANES - 1] >= fmin(upper, 1e300))
            break;
        counted = lambda[LANES - 1];
        step = fmin(pass < 4 ? 2.5 : 16, longest);
    }
    *below = (size_t)fmax(count[LANES - 1], 0);
    return RD_OK;
}

/* part 0..1 of the way from low to high, by ratio where they differ much */
static double between(double low, double high, double part)
{
    if (low > 0 && high > 4 * low)
        return low * pow(high / low, part);
    if (high < 0 && low < 4 * high)
        return low * pow(high / low, part);
    return low + part * (high - low);
}

void rd_search_cut(struct rd_search *search, size_t n, const size_t *index)
{
    double lambda[LANES], count[LANES];
    const size_t cuts = n < LANES ? LANES / n : 1;
    size_t lane = 0;
    for (size_t k = 0; k < n && lane < LANES; k++)
        for (size_t c = 1; c <= cuts && lane < LANES; c++)
            lambda[lane++] = between(search->low[index[k]], search->high[index[k]],
                                     (double)c / (double)(cuts + 1));
    for (; lane < LANES; lane++)
        lambda[lane] = lambda[lane - 1];
    count_all(search, lambda, count);
}

static bool is_open(const struct rd_search *search, size_t i, double narrow)
{
    const double size = fmax(fabs(search->low[i]), fabs(search->high[i]));
    const double least = fmax(narrow * size, ABSOLUTE * search->size);
    return !rd_search_is_single(search, i) && search->high[i] - search->low[i] > least;
}

/* one mode of each bracket that is open */
void rd_search_isolate(struct rd_search *search, double narrow)
{
    const size_t passes = CUTS + CUTS_EACH * search->wanted;
    for (size_t pass = 0; pass < passes; pass++) {
        size_t index[LANES], n = 0;
        for (size_t i = 0; i < search->wanted && n < LANES; i++)
            if (is_open(search, i, narrow) &&
                (n == 0 || search->low[i] != search->low[index[n - 1]]))
                index[n++] = i;
        if (n == 0 || search->lost)
            return;
        rd_search_cut(search, n, index);
    }
}
