/* Inverse iteration on a walk, blocks of RD_LANES vectors side by side. */
#ifndef RD_REFINE_H
#define RD_REFINE_H

#include "base/real_lanes.h"
#include "modes/walk/walk.h"

/* one step of the walk: 2^level first pieces, or a single element */
struct rd_step {
    size_t at;        /* first pieces from the leg's first node */
    int32_t halvings; /* an element has 2^halvings first pieces */
    int32_t piece;    /* index of the piece, -1: the element alone */
    int32_t element;
    int32_t term;   /* node term at the first node */
    int32_t before; /* element on its left, -1: none */
    int32_t level;
    int32_t leg;
    int32_t block; /* of a leg whose tension grows (graded/blocks.h), counted from 1; 0: of none */
    _Bool plain;   /* a piece in closed form, no doubling (modes/walk/plain.h) */
};

/* What an iteration works in. */
struct rd_refine {
    const struct rd_walk *walk;
    size_t capacity;        /* steps that fit */
    size_t pieces;          /* pieces that fit */
    size_t steps;           /* of the present plan */
    struct rd_step *step;   /* (capacity) */
    lanes *piece;           /* (pieces, 6, width, width)  D, G, Q and d/dlambda */
    lanes *receptance;      /* (capacity, width (width + 3))  U and g left of each node: re, im */
    size_t blocks;          /* blocks of vectors that fit */
    size_t block;           /* the one that all but gram work on, with another load to begin with */
    lanes *vectors;         /* (blocks, rd_refine_apart) u, f and y of each */
    lanes *u;               /* (capacity + 1, width) scaled */
    lanes *f;               /* (capacity, width)     scaled, on the right end of each step */
    lanes *y;               /* (attached) unknown of each structure [m] */
    double *square;         /* (RD_SQUARES, n, n) for inner products of all n vectors */
    lanes *next;            /* (attached) while an iteration makes it */
    double z[RD_WIDTH_MAX]; /* scales of the coordinates */
    double most;            /* largest |lambda| of the present plan */
};

/* Stationary value of the mixed form at the vectors x = (u, f):
   lambda + (x^T A x)/(x^T M x), A u = f_a + (N + Q) u_a - F^T f_b, A f = u_b - F u_a - G f_b. */
struct rd_quotient {
    double lambda[RD_LANES];
    double error[RD_LANES];    /* of rounding */
    double residual[RD_LANES]; /* x^T A x/x^T M x */
};

enum { RD_SQUARES = 6 };

/* Lays out the arrays for `steps` steps, `pieces` pieces and `blocks` blocks, and chooses the first. */
void rd_refine_take(const struct rd_walk *walk, size_t steps, size_t pieces, size_t blocks,
                    struct rd_workspace *workspace, struct rd_refine *refine);

/* from one block to the next */
static inline size_t rd_refine_apart(const struct rd_refine *refine)
{
    return (2 * refine->capacity + 1) * refine->walk->chain->width + refine->walk->chain->attached;
}

/* Makes u, f and y those of a block. */
void rd_refine_choose(struct rd_refine *refine, size_t block);

/* Plans the steps for all lambda (RD_LANES). RD_NO_MEMORY: more than fit, RD_SHORT_WAVES: more than
   are walked, RD_INTERRUPTED. */
enum rd_status rd_refine_plan(struct rd_refine *refine, const double *lambda);

/* Whether its form is linear in lambda: all steps are single elements without inertia of their own. */
static inline _Bool rd_refine_is_linear(const struct rd_refine *refine)
{
    const struct rd_chain *chain = refine->walk->chain;
    return chain->inertia == NULL && chain->attached == 0 && refine->steps + 1 == chain->nodes;
}

/* One inverse iteration at lambda from the present x, or from a fixed load in the lanes whose bit of
   `begin` is set. */
void rd_refine_iterate(struct rd_refine *refine, const double *lambda, unsigned begin);

enum { RD_ALL_LANES = (1 << RD_LANES) - 1 };

/* lambda (RD_LANES) of the last iteration */
void rd_refine_quotient(struct rd_refine *refine, const double *lambda,
                        struct rd_quotient *quotient);

/* A, M (n, n): x_i^T A x_j, x_i^T M x_j of the n vectors of the blocks before `blocks` */
void rd_refine_gram(struct rd_refine *refine, const double *lambda, size_t blocks, double *A,
                    double *M);

/* u (nodes, width) of one lane at all nodes of the chain and y (attached) of its structures, of largest
   scaled value 1 */
void rd_refine_shape(struct rd_refine *refine, const double *lambda, int lane, double *u,
                     double *y);

#define RD_REFINE_WIDTH(w)                                                                         \
    enum rd_status rd_plan_##w(struct rd_refine *, const double *);                                \
    void rd_iterate_##w(struct rd_refine *, const double *, unsigned);                             \
    void rd_quotient_##w(struct rd_refine *, const double *, struct rd_quotient *);                \
    void rd_gram_##w(struct rd_refine *, const double *, size_t, double *, double *);              \
    void rd_shape_##w(struct rd_refine *, const double *, int, double *);
RD_REFINE_WIDTH(1)
RD_REFINE_WIDTH(2)
RD_REFINE_WIDTH(3)
RD_REFINE_WIDTH(4)

#endif
