/* All that a sweep works with, laid out in one workspace. */
#ifndef RD_SWEEP_PLAN_H
#define RD_SWEEP_PLAN_H

#include "chain/runs.h"
#include "sweep/kernel/kernel.h"
#include "sweep/scale.h"
#include "sweep/taps.h"

/* what the pieces in the table are of */
struct sweep_table {
    size_t levels; /* 0: of nothing */
    size_t rest;   /* binary digits that have coefficients beside the largest piece */
    int32_t element, term;
    int way;
    int flat; /* triples, not coefficients */
};

/* the plain span in the first place of the table */
struct sweep_whole {
    size_t count; /* elements, 0: none */
    int32_t element;
    lanes radians;
};

/* the coupled span in the first place of the table, and 2, 4, .. of them in the next */
struct sweep_coupled {
    size_t count;
    int32_t element;
    lanes steps; /* of one */
};

/* the plain span of real minors */
struct sweep_compound {
    size_t count;
    int32_t element;
    struct bent_compound of;
};

struct sweep {
    const struct rd_chain *chain;
    const struct rd_between *between; /* or NULL */
    struct rd_runs runs;
    const struct sweep_kernel *kernel;
    size_t coefs;   /* complex lanes in the coefficients of an element */
    size_t sym;     /* and in U */
    size_t carried; /* ports whose rows are carried: the fewer */
    int swapped;    /* the carried ports are the drives */
    int minors;     /* without rows a walk may go by them */
    double shear;   /* largest (S_cb/S_bb)^2 of a width of 3 */
    int planar;     /* this block's does */
    int undamped;   /* and with real numbers */
    int waves;      /* spans have two real wavenumbers */
    struct taps carry, meet;
    size_t *rank;            /* (carried) */
    size_t records;          /* different nodes where parts meet */
    cv *record;              /* (records, 2 sym + 2 carried width) left parts there */
    cv *rows;                /* (carried, 2, width) each with its companion */
    cv *table;               /* (levels, coefs) of the pieces of one run */
    cv *triple;              /* (2, coefs) */
    cv *coefficients;        /* (distinct, coefs) or NULL */
    cv *plain;               /* (distinct, RD_PLAIN) or NULL */
    cv *value;               /* (carried) */
    lanes *error;            /* (carried) */
    lanes *weight;           /* (carried) of rounding, 1 where no node is heavy */
    struct sweep_foot *foot; /* (attached) */
    uint8_t *trait;          /* (terms) enum rd_trait */
    size_t *order;           /* (frequencies) */
    size_t index[RD_LANES];  /* frequencies of the block */
    size_t used;             /* lanes of it that are not repeated */
    size_t failed;           /* the first frequency without a response, or their count */
    struct sweep_table tabled;
    struct sweep_whole whole;
    struct sweep_compound compound;
    struct sweep_coupled coupled;
    struct sweep_made made;
    struct sweep_block block;
    struct sweep_way way[2];
    struct sweep_extent extent[RD_LANES], most;
    struct sweep_walk walk[2];
    struct sweep_state state;
    lanes steps;   /* elements crossed + squares of equal pieces in a row, or of radians */
    lanes radians; /* of the longest plain span */
};

/* NULL: the workspace measures or is too small */
struct sweep *rd_sweep_plan(const struct rd_chain *chain, const struct rd_factors *factors,
                            const struct rd_ports *drives, const struct rd_ports *responses,
                            struct rd_workspace *workspace);

#endif
