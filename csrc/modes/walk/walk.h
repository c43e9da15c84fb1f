/* A chain prepared for walking: its triples and its runs of equal elements. */
#ifndef RD_WALK_H
#define RD_WALK_H

#include "base/status.h"
#include "base/stop.h"
#include "base/workspace.h"
#include "chain/body.h"
#include "chain/chain.h"

/* Equal elements one after another, equal node terms between them; or a hinge, alone: the element
   chain->distinct + its term. */
struct rd_leg {
    size_t node;  /* first node */
    size_t count; /* elements */
    int32_t element;
    int32_t before; /* element on the left of the first node, -1: none */
    int32_t first;  /* node term at the first node */
    int32_t term;   /* node term at the inner nodes and, of a continuous leg, inside elements */
};

struct rd_walk {
    const struct rd_chain *chain;
    size_t legs;
    struct rd_leg *leg; /* (legs) */
    int32_t last;       /* node term at the last node */
    int32_t behind;     /* element on its left */
    double *triple;     /* (elements, 4, width, width)  D, G, Q and P of element/strut.h */
    uint8_t *strut;     /* (elements)  1: P is not zero */
    double flexibility[RD_WIDTH_MAX]; /* of the whole chain, one end held */
    double mass[RD_WIDTH_MAX];        /* sum of |M_ii|, the rope's own included */
    struct rd_body body;
    double length;       /* [m] */
    double bend;         /* [rad/N m] sum of l S_bb, 0 without z and beta together */
    double tension;      /* [N] mean */
    double sag;          /* [1/m] mean of w/T */
    struct rd_stop stop; /* nothing at first; asked between and on long walks */
    double
        carried[RD_WIDTH_MAX]; /* the rope's own mass, of continuous elements; else nodes times the
                                     geometric mean of |M_ii| that are not 0 */
};

/* Takes the arrays of walk from the workspace (with base NULL: counts what they need) and fills
   them, O(nodes) once. RD_NO_MEMORY where they do not fit, RD_NOT_POSITIVE_DEFINITE where a number is NaN
   or infinite, RD_CRITICAL_ELEMENT as rd_strut_fill. */
enum rd_status rd_walk_fill(const struct rd_chain *chain, struct rd_workspace *workspace,
                            struct rd_walk *walk);

static const double rd_walk_nothing[RD_WIDTH_MAX * RD_WIDTH_MAX] = {0};

/* M and K (width, width) of a node term, and what it holds (width) */
static inline const double *rd_walk_mass(const struct rd_walk *walk, int32_t term)
{
    const size_t w = walk->chain->width;
    return term == RD_NO_TERM ? rd_walk_nothing : walk->chain->mass + (size_t)term * w * w;
}

static inline const double *rd_walk_springs(const struct rd_walk *walk, int32_t term)
{
    const size_t w = walk->chain->width;
    return term == RD_NO_TERM ? rd_walk_nothing : walk->chain->stiffness + (size_t)term * w * w;
}

static inline const uint8_t *rd_walk_held(const struct rd_walk *walk, int32_t term)
{
    static const uint8_t nothing[RD_WIDTH_MAX] = {0};
    return term == RD_NO_TERM ? nothing : walk->chain->held + (size_t)term * walk->chain->width;
}

/* z (width): scales of the coordinates, u = z u^, f = f^/z: z^2 is the receptance of a long rope,
   1/(B k (k^2 + a^2)) and 1/(B a) for z and beta together, 1/sqrt(|lambda| mu T) for others, or that
   of the chain as a rigid body if it is larger. */
void rd_walk_scale(const struct rd_walk *walk, double lambda, double *z);

/* An upper bound of all eigenvalues where inertia is diagonal [rad^2/s^2]: the largest stiffness over
   the least mass of a coordinate, times what a node's elements can add up to. INFINITY where elements
   have inertia of their own. */
double rd_walk_ceiling(const struct rd_walk *walk);

/* Radians that the shortest wave of a continuous leg has over one element, evanescent ones included;
   0 of any other leg. */
double rd_walk_radians(const struct rd_walk *walk, const struct rd_leg *leg, double lambda);

/* the larger of the two diagonal entries of coordinate i in the assembled distinct element */
double rd_walk_stiffness(const struct rd_walk *walk, size_t element, size_t i);

#endif
