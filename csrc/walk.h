/* A chain prepared for walking: its triples and its runs of equal elements. */
#ifndef RD_WALK_H
#define RD_WALK_H

#include "chain.h"
#include "status.h"
#include "workspace.h"

/* equal elements one after another, equal node terms between them */
struct rd_stretch {
    size_t node;  /* first node */
    size_t count; /* elements */
    int32_t element;
    int32_t before; /* element on the left of the first node, -1: none */
    int32_t first;  /* node term at the first node */
    int32_t term;   /* node term at the inner nodes */
};

struct rd_walk {
    const struct rd_chain *chain;
    size_t runs;
    struct rd_stretch *run; /* (runs) */
    double *triple;         /* (distinct, 4, width, width)  D, G, Q and P of strut.h */
    uint8_t *strut;         /* (distinct)  1: P is not zero */
    double below;           /* eigenvalues below zero of the elements themselves */
    double flexibility[RD_WIDTH_MAX]; /* of the whole chain, one end held: sum of G_ii */
    double mass[RD_WIDTH_MAX];        /* sum of |M_ii| */
    double length;                    /* [m] */
    double bend;                      /* [rad/N m] sum of l S_bb, 0 without z and beta together */
    double tension;                   /* [N] mean */
    double carried[RD_WIDTH_MAX];     /* nodes times the geometric mean of |M_ii| that are not 0 */
};

/* Takes the arrays of walk from the workspace (with base NULL: counts what they need) and fills
   them, O(nodes) once. RD_NO_MEMORY where they do not fit, RD_NOT_POSITIVE_DEFINITE where a number is NaN
   or infinite, RD_CRITICAL_ELEMENT as rd_strut_fill. */
enum rd_status rd_walk_fill(const struct rd_chain *chain, struct rd_workspace *workspace,
                            struct rd_walk *walk);

/* z (width): scales of the coordinates, u = z u^, f = f^/z: z^2 is the receptance of a long rope,
   1/(B k (k^2 + a^2)) and 1/(B a) for z and beta together, 1/sqrt(|lambda| mu T) for others. */
void rd_walk_scale(const struct rd_walk *walk, double lambda, double *z);

/* the larger of the two diagonal entries of coordinate i in the assembled distinct element */
double rd_walk_stiffness(const struct rd_walk *walk, size_t element, size_t i);

#endif
