/* Where a sweep stops: nodes that carry a drive or a response. */
#include "sweep/taps.h"

#include <stdbool.h>

static const double *unless_zero(const double *row, size_t width)
{
    for (size_t i = 0; row && i < width; i++)
        if (row[i] != 0.0)
            return row;
    return NULL;
}

/* the tap of port p at its left (half 0) or right node; false where there is nothing */
static bool tap_of(const struct rd_ports *ports, size_t width, size_t p, size_t half,
                   struct tap *tap)
{
    const double *force = half && ports->force ? ports->force + p * width : NULL;
    *tap = (struct tap){
        .node = (size_t)ports->node[p] + half,
        .port = p,
        .motion = unless_zero(ports->row + (2 * p + half) * width, width),
        .force = unless_zero(force, width),
    };
    return tap->motion || tap->force;
}

/* Shell's sort: no memory, one pass where the ports are in order already */
static void sort_taps(struct tap *tap, size_t count)
{
    size_t gap = 1;
    while (gap < count / 3)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (size_t i = gap; i < count; i++) {
            const struct tap moved = tap[i];
            size_t j = i;
            for (; j >= gap && tap[j - gap].node > moved.node; j -= gap)
                tap[j] = tap[j - gap];
            tap[j] = moved;
        }
}

/* the taps stand in order, so one walk along the stretches finds all terms */
static void find_terms(const struct rd_chain *chain, struct taps *taps)
{
    size_t k = 0;
    for (size_t i = 0; i < taps->count; i++) {
        k = rd_stretch_of(chain, taps->tap[i].node, k);
        taps->tap[i].term = (size_t)chain->term[k];
    }
}

void rd_taps_find(const struct rd_ports *ports, const struct rd_chain *chain, struct taps *taps,
                  struct rd_workspace *workspace)
{
    const size_t width = chain->width;
    struct tap tap;
    size_t count = 0;
    for (size_t p = 0; p < ports->count; p++)
        for (size_t half = 0; half < 2; half++)
            count += tap_of(ports, width, p, half, &tap);
    taps->count = count;
    taps->tap = rd_take(workspace, count, sizeof *taps->tap);
    if (!taps->tap)
        return;
    count = 0;
    for (size_t p = 0; p < ports->count; p++)
        for (size_t half = 0; half < 2; half++)
            if (tap_of(ports, width, p, half, &tap))
                taps->tap[count++] = tap;
    sort_taps(taps->tap, count);
    find_terms(chain, taps);
}

void rd_taps_rank(struct taps *taps, size_t ports, size_t *rank)
{
    size_t next = 0;
    for (size_t p = 0; p < ports; p++)
        rank[p] = ports;
    for (size_t i = 0; i < taps->count; i++) {
        struct tap *tap = taps->tap + i;
        if (rank[tap->port] == ports)
            rank[tap->port] = next++;
        tap->rank = rank[tap->port];
    }
    for (size_t p = 0; p < ports; p++)
        if (rank[p] == ports)
            rank[p] = next++;
}

size_t rd_taps_nodes(const struct taps *taps)
{
    size_t nodes = 0;
    for (size_t i = 0; i < taps->count; i++)
        nodes += i == 0 || taps->tap[i].node != taps->tap[i - 1].node;
    return nodes;
}
