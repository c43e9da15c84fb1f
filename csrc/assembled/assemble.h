/* Assembled matrices of a chain: block tridiagonal, in parts that damping scales apart. */
#ifndef RD_ASSEMBLE_H
#define RD_ASSEMBLE_H

#include "base/complex.h"
#include "base/status.h"
#include "chain/chain.h"

/* symmetric block tridiagonal matrix: node i meets itself and node i + 1 */
struct rd_blocks {
    double *diagonal; /* (nodes, width, width) */
    double *coupling; /* (nodes - 1, width, width): rows of node i, columns of node i + 1 */
};

struct rd_assembly {
    size_t nodes;
    size_t width;
    struct rd_blocks elastic; /* of the sections */
    struct rd_blocks string;  /* of the tension */
    double *springs;          /* (nodes, width, width) of the node terms */
    double *mass;             /* (nodes, width, width) of the node terms */
    double *dashpots;         /* (nodes, width, width) of the node terms */
};

/* Fills every array of the assembly, all of them the caller's. */
enum rd_status rd_assemble(const struct rd_chain *chain, struct rd_assembly *assembly);

/* Fills the elements again, and what nodes carry (chain/attached.h), at complex factors (RD_PARTS):
   the real part into `elastic`, the imaginary one into `string`. With factor NULL as rd_assemble
   does, and nothing that nodes carry: it is not linear. */
enum rd_status rd_assemble_elements(const struct rd_chain *chain, const double _Complex *factor,
                                    struct rd_assembly *assembly);

#endif
