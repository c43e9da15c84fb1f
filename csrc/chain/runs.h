/* What of a chain repeats, and its averages: found once, used by every sweep. */
#ifndef RD_RUNS_H
#define RD_RUNS_H

#include "base/status.h"
#include "chain/body.h"
#include "chain/chain.h"

/* Elements first .. last - 1 are the same and so are the node terms at first + 1 .. last - 1,
   where nothing is held. Only stretches of so many elements or more are runs: RD_RUN_LEAST, or 1
   where elements are continuous, which have nothing at those nodes. */
struct rd_run {
    size_t first, last;
    int32_t element;
    int32_t term; /* RD_NO_TERM: nothing */
};

enum { RD_RUN_LEAST = 8 };

struct rd_runs {
    size_t count;
    size_t least;                    /* elements of a run */
    const struct rd_run *run;        /* (count) */
    double length;                   /* [m] of the chain */
    double tension;                  /* [N] mean over the length */
    double sag;                      /* [1/m] likewise */
    double flexibility[RD_CHANNELS]; /* mean S_cc over the length */
    double mass[RD_WIDTH_MAX];       /* per length: the rope's own, or where elements have none the
                                        geometric mean of nodes that have any */
    struct rd_body body;
};

/* places needed for the runs of a chain */
size_t rd_runs_capacity(const struct rd_chain *chain);

/* fills run (capacity) and the view of it */
void rd_runs_find(const struct rd_chain *chain, struct rd_run *run, struct rd_runs *runs);

#endif
