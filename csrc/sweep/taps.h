/* Where a sweep stops: nodes that carry a drive or a response. */
#ifndef RD_TAPS_H
#define RD_TAPS_H

#include "base/workspace.h"
#include "chain/chain.h"
#include "chain/ports.h"

/* one port at one node; the force is the one on the part to the left of the node */
struct tap {
    size_t node;
    size_t term; /* the node's */
    size_t port;
    size_t rank;          /* row of a carried port: ranks increase with the node */
    const double *motion; /* (width) or NULL */
    const double *force;  /* (width) or NULL */
};

struct taps {
    size_t count;
    struct tap *tap; /* (count) by node */
};

/* Takes and fills the taps of the ports. While measuring only counts them. */
void rd_taps_find(const struct rd_ports *ports, const struct rd_chain *chain, struct taps *taps,
                  struct rd_workspace *workspace);

/* numbers the ports by their first tap; `rank` (ports) is filled too */
void rd_taps_rank(struct taps *taps, size_t ports, size_t *rank);

/* different nodes among the taps */
size_t rd_taps_nodes(const struct taps *taps);

#endif
