/* All rates of damped motion of a chain within a circle, certified by count. */
#include "damped/search.h"

#include "damped/circle.h"
#include "damped/clusters.h"
#include "damped/iterate.h"

#include <math.h>

/* a circle on which a root lies grows by these factors */
static const double NUDGES[] = {1, 1.004, 1.01, 1.03, 1.07};
enum { MOST_NUDGES = sizeof NUDGES / sizeof *NUDGES };

/* roots nearer than this part of the distance to others are a cluster, in one try after another */
static const double APART[] = {1e-6, 1e-4, 1e-2};
enum { TRIES = sizeof APART / sizeof *APART };

/* an imaginary part below this part of the mean distance of roots may be rounding */
static const double REAL = 1e-6;

struct arrays {
    struct rd_function function;
    struct rd_winding winding;
    struct rd_iterate iterate;
    struct rd_circle circle;
    size_t *group;          /* (iterate.most) */
    double _Complex *spare; /* (iterate.most) */
};

/* Lays out what a circle needs: RD_OK, RD_NO_MEMORY or RD_SHORT_WAVES. */
static enum rd_status take(const struct rd_search *search, double wide,
                           struct rd_workspace *workspace, struct arrays *a)
{
    const double most = search->middle + wide;
    const double reach = fmin(1.1 * most, (most + search->horizon) / 2);
    rd_function_take(search->chain, &search->damping, search->stop, reach, workspace, &a->function);
    rd_iterate_take(search->room, workspace, &a->iterate);
    rd_circle_take(search->room, workspace, &a->circle);
    a->group = rd_take(workspace, a->iterate.most, sizeof *a->group);
    a->spare = rd_take(workspace, a->iterate.most, sizeof *a->spare);
    return rd_winding_take(&a->function, search->middle, wide, workspace, &a->winding);
}

/* Roots inside the circle first, of mirror images those with Im s > 0; how many they are. */
static size_t wanted_first(struct arrays *a)
{
    struct rd_iterate *it = &a->iterate;
    const double least = a->winding.mirror == RD_NO_MIRROR ? -INFINITY : -REAL * it->spacing;
    size_t wanted = 0, others = 0;
    for (size_t i = 0; i < it->count; i++)
        if (cabs(it->z[i] - a->winding.middle) < a->winding.radius && cimag(it->z[i]) >= least)
            it->z[wanted++] = it->z[i];
        else
            a->spare[others++] = it->z[i];
    for (size_t i = 0; i < others; i++)
        it->z[wanted + i] = a->spare[i];
    return wanted;
}

/* Adds the roots of group `own` and their errors if a circle surrounds as many, *surrounded of all. */
static enum rd_status settle(struct rd_search *search, struct arrays *a, size_t own,
                             size_t *surrounded)
{
    const struct rd_iterate *it = &a->iterate;
    double _Complex *member = search->value + search->found;
    double most = 0, height = 0;
    size_t count = 0;
    for (size_t i = 0; i < it->count; i++) {
        if (a->group[i] != own)
            continue;
        if (search->found + count == search->room)
            return RD_OK;
        member[count++] = it->z[i];
        most = fmax(most, cabs(it->z[i] - a->winding.middle));
        height += cimag(it->z[i]);
    }
    /* what lies beyond the circle is not known */
    const double gap = rd_clusters_gap(it->count, it->z, a->group, own, it->spacing);
    bool settled;
    const enum rd_status status =
        rd_circle_settle(&a->circle, &a->function, count, fmin(gap, a->winding.radius - most),
                         member, search->error + search->found, &settled);
    if (status != RD_OK || !settled)
        return status;
    const bool paired =
        a->winding.mirror != RD_NO_MIRROR && height > REAL * it->spacing * (double)count;
    search->found += count;
    *surrounded += count * (paired ? 2 : 1);
    return RD_OK;
}

/* Draws a circle around each root or cluster, and sees that it surrounds as many. */
static enum rd_status isolate(struct rd_search *search, struct arrays *a)
{
    const struct rd_iterate *it = &a->iterate;
    const size_t wanted = wanted_first(a);
    for (int try = 0; try < TRIES && !search->certified; try++) {
        size_t surrounded = 0;
        search->found = 0;
        rd_clusters_find(it->count, it->z, it->spacing, APART[try], a->group);
        for (size_t i = 0; i < wanted; i++) {
            size_t first = 0;
            while (a->group[first] != a->group[i])
                first++;
            const enum rd_status status =
                first == i ? settle(search, a, a->group[i], &surrounded) : RD_OK;
            if (status != RD_OK)
                return status;
        }
        search->certified = surrounded == search->count;
    }
    return RD_OK;
}

/* one circle; not certified where a root may lie on it */
static enum rd_status search_within(struct rd_search *search, struct arrays *a)
{
    bool known;
    enum rd_status status = rd_winding_walk(&a->function, &a->winding, &known);
    search->mirror = a->function.mirror;
    search->wide = a->winding.radius;
    if (status != RD_OK || !known)
        return status;
    search->count = a->winding.count;
    search->found = 0;
    search->certified = search->count == 0;
    if (search->certified)
        return RD_OK;
    if (search->count > search->room)
        return RD_NO_MEMORY;
    status =
        rd_iterate_find(&a->iterate, &a->function, &a->winding, search->guesses, search->guess);
    return status == RD_OK ? isolate(search, a) : status;
}

enum rd_status rd_search(struct rd_search *search, struct rd_workspace *workspace)
{
    const size_t used = workspace->used;
    const double most = search->edge - search->middle;
    struct arrays a;
    if (!isfinite(search->radius))
        return RD_SHORT_WAVES;
    search->certified = false;
    search->sweeps = search->count = search->found = 0;
    if (workspace->base == NULL) {
        const double widest = fmin(search->radius * NUDGES[MOST_NUDGES - 1], most);
        return take(search, widest, workspace, &a);
    }
    for (int k = 0; k < MOST_NUDGES && !search->certified; k++) {
        const double wide = fmin(search->radius * NUDGES[k], most);
        workspace->used = used;
        enum rd_status status = take(search, wide, workspace, &a);
        if (status == RD_OK)
            status = search_within(search, &a);
        search->sweeps += a.function.sweeps;
        if (status != RD_OK)
            return status;
    }
    return RD_OK;
}
