/* Roots that lie closer to each other than to all others. */
#ifndef RD_CLUSTERS_H
#define RD_CLUSTERS_H

#include "base/complex.h"

#include <stddef.h>

/* group (count) <- the same number for all of a cluster: roots nearer to each other than `apart` times
   their mean distance, and than that part of the distance to others */
void rd_clusters_find(size_t count, const double _Complex *root, double spacing, double apart,
                      size_t *group);

/* distance of a group to all other roots, `spacing` at most */
double rd_clusters_gap(size_t count, const double _Complex *root, const size_t *group, size_t own,
                       double spacing);

#endif
