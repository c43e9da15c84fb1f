/* A rope on an axis in space: pieces one after another, all six coordinates at each node.

   y = (u, f), f the force of the right part on the left in the undeformed frame, has y' = E y along a
   piece, E = [[Phi, S], [q, -Phi^T]] with S and q symmetric. Its triple is that of any element:
   u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a. Where curvature or tension change along a piece
   E(s) = sum phi_j(s) E_j, phi_0 = 1, fields that are known by their series. */
#ifndef RD_SPACE_H
#define RD_SPACE_H

#include "base/complex.h"
#include "base/status.h"
#include "base/workspace.h"

#include <stddef.h>
#include <stdint.h>

enum {
    RD_SIX = 6,
    RD_SPACE_TRIPLE = 3 * RD_SIX * RD_SIX,
    RD_SPACE_BAND = 2 * RD_SIX - 1,        /* entries on either side of the diagonal */
    RD_SPACE_ROWS = 3 * RD_SPACE_BAND + 1, /* of its columns as LAPACK factors them */
    RD_SPACE_NODES = 24,                   /* of a piece's polynomials, at most */
    RD_SPACE_ORDERS = 14,                  /* of the fields' series */
};

/* Joints whose inverse has larger entries are not joined: near a resonance of what is on their left. A
   larger one is taken where too many parts are left: it costs the count as many digits again. */
enum { RD_SPACE_GENTLE = 2 };
static const double rd_space_gentle[RD_SPACE_GENTLE] = {1e2, 1e4};

/* How fields run along a piece: 2^-halvings of it is summed as a series about its left end. With
   nodes = 1 all such parts are alike; with 2^halvings of them they are those parts, one after another;
   else parts about the nodes of a polynomial (Chebyshev's of the first kind, decreasing), from which
   the others are interpolated. */
struct rd_space_run {
    double length; /* [m] */
    int halvings, nodes;
    size_t fields;
    const double *series; /* (nodes, fields, RD_SPACE_ORDERS) of phi_j by powers of s - left end */
};

struct rd_space {
    size_t pieces, fields;
    const double *length;    /* (pieces)          [m] */
    const int32_t *halvings; /* (pieces)  */
    const int32_t *nodes;    /* (pieces)  */
    const double *series;    /* (sum of nodes, fields, RD_SPACE_ORDERS) */
    const double *rates;     /* (pieces, fields, 3, 6, 6)  Phi, S and q at lambda = 0 */
    const double *inertia;   /* (pieces, 6, 6)    per length */
    const double *turn; /* (pieces, 6, 6)    R: components on the left of the node where it begins
                                                  to those on the right */
    const double
        *stiffness;      /* (pieces + 1, 6, 6) of nodes, in the frame on the left; at the first on
                                                  the right */
    const double *mass;  /* (pieces + 1, 6, 6) */
    const uint8_t *held; /* (pieces + 1, 6)   1: cannot move; as stiffness */
};

/* The parts of a piece at `lines` (lines, fields, 3, 6, 6) = Phi, S, q of each field, doubled
   `doublings` times or, earlier, while no joint's inverse has an entry above `gentle`: *reached says
   how often. triple (lines, parts, 3, 6, 6), parts = 2^(halvings - doublings) or 1 where they are
   alike: D = F - I, G, Q; not written where not all were reached. Takes what it needs from the
   workspace (with base NULL: counts it). RD_NO_MEMORY where that is too small. */
enum rd_status rd_space_triples(const struct rd_space_run *run, size_t lines,
                                const double _Complex *rates, int doublings, double gentle,
                                double _Complex *triple, int *reached,
                                struct rd_workspace *workspace);

/* The matrix of motion u at the nodes and force f at the right end of each part, u_0, f_0, u_1 ..,

       f_i-1 - F^T f_i + (Q + N) u_i = p_i,   u_i+1 - F u_i - G f_i = d_i,

   as LAPACK's band by columns (lines, size, RD_SPACE_ROWS), size = 12 parts + 6, of entries of `numbers`
   doubles, 1 or 2: D, G, Q (lines, parts, 6, 6), N (lines, parts + 1, 6, 6); rows and columns that
   are fixed (size) are those of 1. */
void rd_space_band(size_t lines, size_t parts, size_t numbers, const double *D, const double *G,
                   const double *Q, const double *N, const uint8_t *fixed, double *band);

/* Such bands, factored in place as LAPACK does; pivot
   (lines, size). Returns the first that is singular, or `lines`. */
size_t rd_space_factor(size_t lines, size_t size, double *band, int32_t *pivot);
size_t rd_space_factor_complex(size_t lines, size_t size, double _Complex *band, int32_t *pivot);

/* x (lines, columns, size): right sides, solved in place */
void rd_space_solve(size_t lines, size_t size, size_t columns, const double *band,
                    const int32_t *pivot, double *x);
void rd_space_solve_complex(size_t lines, size_t size, size_t columns, const double _Complex *band,
                            const int32_t *pivot, double _Complex *x);

/* Eigenvalues below each lambda (count), counted in coordinates scaled by z (count, 6), u = z u^ and
   f = f^/z, so that entries of E times a piece's length are of a size. NAN where joints between
   resonances leave more parts than are counted together. Takes what it needs from the workspace (with
   base NULL: counts it). RD_NO_MEMORY where that is too small. */
enum rd_status rd_space_count(const struct rd_space *rope, size_t count, const double *lambda,
                              const double *z, double *below, struct rd_workspace *workspace);

#endif
