/* A rope on an axis in space: uniform pieces one after another, all six coordinates at each node.

   y = (u, f), f the force of the right part on the left in the undeformed frame, has y' = E y along a
   piece, E = [[Phi, S], [q, -Phi^T]] with S and q symmetric. Its triple is that of any element:
   u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a. */
#ifndef RD_SPACE_H
#define RD_SPACE_H

#include "base/complex.h"
#include "base/status.h"
#include "base/workspace.h"

#include <stddef.h>
#include <stdint.h>

enum { RD_SIX = 6, RD_SPACE_TRIPLE = 3 * RD_SIX * RD_SIX };

/* Joints whose inverse has larger entries are not joined: near a resonance of what is on their left. A
   larger one is taken where too many parts are left: it costs the count as many digits again. */
enum { RD_SPACE_GENTLE = 2 };
static const double rd_space_gentle[RD_SPACE_GENTLE] = {1e2, 1e4};

/* coordinates scaled, u = z u^ and f = f^/z, so that entries of E times a piece's length are of a size */
struct rd_space {
    size_t pieces;
    const double *length;    /* (pieces)          [m] */
    const int32_t *halvings; /* (pieces)          2^-halvings of it is summed as a series */
    const double *phi;       /* (pieces, 6, 6)    Phi */
    const double *soft;      /* (pieces, 6, 6)    S */
    const double *load;      /* (pieces, 6, 6)    q at lambda = 0 */
    const double *inertia;   /* (pieces, 6, 6)    per length */
    const double
        *turn; /* (pieces, 6, 6)    R: components on the left of the node where it begins to
                                                  those on the right */
    const double
        *stiffness;      /* (pieces + 1, 6, 6) of nodes, in the frame on the left; at the first on
                                                  the right */
    const double *mass;  /* (pieces + 1, 6, 6) */
    const uint8_t *held; /* (pieces + 1, 6)   1: cannot move; as stiffness */
};

/* Pieces of `rates` = Phi, S, q (3, 6, 6) of the length: 2^-halvings of it is summed, and doubled
   `doublings` times or, earlier, while no joint's inverse has an entry above `gentle`. triple: D = F - I,
   G, Q. Returns how often it was doubled. */
int rd_space_triple(const double _Complex *rates, double length, int halvings, int doublings,
                    double gentle, double _Complex *triple);

/* Eigenvalues below each lambda (count), NAN where joints between resonances leave more parts than
   are counted together. Takes what it needs from the workspace (with base NULL: counts it). RD_NO_MEMORY
   where that is too small. */
enum rd_status rd_space_count(const struct rd_space *rope, size_t count, const double *lambda,
                              double *below, struct rd_workspace *workspace);

#endif
