/* Roots that lie closer to each other than to all others. */
#include "damped/clusters.h"

#include <math.h>
#include <stdbool.h>

/* roots nearer than this part of what is apart are one in any case */
static const double TOGETHER = 0.1;

struct pair {
    double distance;
    size_t i, j;
};

static bool is_before(const struct pair *a, const struct pair *b)
{
    if (a->distance != b->distance)
        return a->distance < b->distance;
    return a->i < b->i || (a->i == b->i && a->j < b->j);
}

/* the nearest pair behind another one, no farther than `most` apart; false where there is none.
   Hardly any roots are that near, so that all pairs are looked at a few times. */
static bool next_pair(size_t count, const double _Complex *root, double most, struct pair *pair)
{
    struct pair best = {.distance = INFINITY};
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++) {
            const double _Complex apart = root[i] - root[j];
            if (fabs(creal(apart)) > most || fabs(cimag(apart)) > most)
                continue;
            const struct pair one = {cabs(apart), i, j};
            if (one.distance <= most && is_before(pair, &one) && is_before(&one, &best))
                best = one;
        }
    if (best.distance == INFINITY)
        return false;
    *pair = best;
    return true;
}

/* distance of two groups, which may be one, to all others */
static double gap_of(size_t count, const double _Complex *root, const size_t *group, size_t a,
                     size_t b, double spacing)
{
    double gap = spacing;
    for (size_t i = 0; i < count; i++) {
        if (group[i] != a && group[i] != b)
            continue;
        for (size_t j = 0; j < count; j++)
            if (group[j] != a && group[j] != b)
                gap = fmin(gap, cabs(root[i] - root[j]));
    }
    return gap;
}

void rd_clusters_find(size_t count, const double _Complex *root, double spacing, double apart,
                      size_t *group)
{
    struct pair pair = {.distance = -1};
    for (size_t i = 0; i < count; i++)
        group[i] = i;
    while (next_pair(count, root, apart * spacing, &pair)) {
        const size_t a = group[pair.i], b = group[pair.j];
        const double gap = gap_of(count, root, group, a, b, spacing);
        if (pair.distance > fmax(apart * gap, TOGETHER * apart * spacing))
            continue;
        for (size_t i = 0; i < count; i++)
            if (group[i] == b)
                group[i] = a;
    }
}

double rd_clusters_gap(size_t count, const double _Complex *root, const size_t *group, size_t own,
                       double spacing)
{
    return gap_of(count, root, group, own, own, spacing);
}
