/* A chain: nodes joined by elements, as views of the caller's arrays. */
#ifndef RD_CHAIN_H
#define RD_CHAIN_H

#include "element/coordinate.h"

#include <stddef.h>
#include <stdint.h>

/* structures that nodes carry, condensed to their foot: see chain/attached.h */
enum rd_attached_kind { RD_RESONATOR, RD_WIRE, RD_ATTACHED_KINDS };

/* dynamic stiffness = section elastic + tension string + spring springs + inertia mass + rate dashpots */
enum rd_part { RD_ELASTIC, RD_STRING, RD_SPRINGS, RD_MASS, RD_DASHPOTS, RD_PARTS };

enum { RD_ATTACHED_VALUES = 4 }; /* numbers of one */

enum { RD_NO_TERM = -1 }; /* where nothing stands: between continuous pieces, right of a hinge */

/* Nodes first[k] .. first[k + 1] - 1 are a stretch: the same term and the same element on their
   right. The last node, which has no element on its right, is the last stretch. Where elements are
   continuous nothing stands at the nodes of a stretch of more than one. */
struct rd_chain {
    size_t nodes;              /* elements + 1 */
    size_t stretches;          /* 2 to nodes */
    size_t width;              /* coordinates of a node, 1 to 4 */
    size_t distinct;           /* different elements */
    size_t terms;              /* different node terms */
    size_t attached;           /* structures that nodes carry */
    enum rd_kind kind;         /* of every element */
    const int32_t *coordinate; /* (width)                 enum rd_coordinate, increasing */
    const double *length;      /* (distinct)              [m] */
    const double *tension;     /* (distinct)              [N] */
    const double *flexibility; /* (distinct, 3, 3)        S, absent channels zero */
    const double *inertia;     /* (distinct, width)       of continuous elements, per length
                                                          [kg/m, kg m]; else NULL */
    const int32_t *first;      /* (stretches)             node, increasing from 0 to nodes - 1 */
    const int32_t *element;    /* (stretches - 1)         distinct element right of its nodes */
    const int32_t *term;       /* (stretches)             node term at its nodes */
    const double *mass;        /* (terms, width, width)   [kg, kg m, kg m^2] */
    const double *stiffness;   /* (terms, width, width)   [N/m, N, N m] */
    const uint8_t *held;       /* (terms, width)          1: the coordinate cannot move */
    const double *hinge;       /* (terms, width) or NULL   compliance between the node and the
                                                           element on its right [rad/(N m), m/N],
                                                           INFINITY: free */
    const double *damping;     /* (terms, width, width) or NULL  [N s/m, N s, N m s] */
    const double *drag;        /* (distinct, width) or NULL      of continuous elements, per length
                                                          [N s/m^2, N s] */
    const double *sag;         /* (distinct) or NULL      weight per length over tension, which is
                                                          > 0, of x and z [1/m] */
    const double *rise; /* (distinct) or NULL      how much more the tension is at the right end
                                                          of a continuous element of a string or a
                                                          beam, which is linear between [N]; elements that
                                                          have any stand once in the chain */
    const int32_t *attached_kind; /* (attached)           enum rd_attached_kind */
    const int32_t
        *attached_term;         /* (attached)           node term that carries it, increasing; of a
                                                          single node */
    const double *attached_row; /* (attached, 2, width) displacement and rotation of its foot */
    const double *attached_value; /* (attached, RD_ATTACHED_VALUES) its numbers, its damping last */
    const int32_t *element_of; /* (nodes - 1)             element node by node: right of node i */
    const int32_t *term_of; /* (nodes)                 term node by node; a sweep reads neither */
};

/* whether anything of the chain itself is in proportion to velocity */
static inline int rd_chain_is_dragged(const struct rd_chain *chain)
{
    return chain->damping != NULL || chain->drag != NULL;
}

/* nodes of a stretch */
static inline size_t rd_stretch_nodes(const struct rd_chain *chain, size_t k)
{
    return (size_t)(k + 1 < chain->stretches ? chain->first[k + 1] - chain->first[k] : 1);
}

/* The first structure of a node term, or of a later one; they go on while attached_term is the same. */
static inline size_t rd_attached_first(const struct rd_chain *chain, size_t term)
{
    size_t low = 0, high = chain->attached;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if ((size_t)chain->attached_term[middle] < term)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* whether structure k exists and belongs to a node term */
static inline int rd_attached_is_of(const struct rd_chain *chain, size_t k, int32_t term)
{
    return k < chain->attached && chain->attached_term[k] == term;
}

/* whether nothing stands at a node with this term */
static inline int rd_term_is_bare(const struct rd_chain *chain, int32_t term)
{
    const size_t w = chain->width, t = (size_t)term;
    int any = 0;
    for (size_t i = 0; i < w * w; i++)
        any |= chain->mass[t * w * w + i] != 0 || chain->stiffness[t * w * w + i] != 0 ||
               (chain->damping && chain->damping[t * w * w + i] != 0);
    for (size_t i = 0; i < w; i++)
        any |= chain->held[t * w + i] || (chain->hinge && chain->hinge[t * w + i] != 0);
    any |= rd_attached_is_of(chain, rd_attached_first(chain, t), term);
    return !any;
}

/* the stretch that a node belongs to, sought from a near one */
static inline size_t rd_stretch_of(const struct rd_chain *chain, size_t node, size_t near)
{
    while ((size_t)chain->first[near] > node)
        near--;
    while (near + 1 < chain->stretches && (size_t)chain->first[near + 1] <= node)
        near++;
    return near;
}

#endif
