/* A rope on an axis in space: pieces one after another, `width` coordinates at each node.

   All six, or three of them where a curve is plane and nothing ties its planes: {x, z, beta} in the plane
   and {y, alpha, gamma} across it. Every matrix is (width, width), width 3 or 6.

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
    RD_SIX = 6,           /* coordinates at most */
    RD_SPACE_NODES = 24,  /* of a piece's polynomials, at most */
    RD_SPACE_ORDERS = 14, /* of the fields' series */
};

/* of the matrices of one part */
static inline size_t rd_space_triple(size_t width)
{
    return 3 * width * width;
}

/* entries on either side of a band's diagonal; a closed one is folded, 0, last, 1, last but one .. */
static inline size_t rd_space_beside(size_t width, int closed)
{
    return (closed ? 3 : 2) * width - 1;
}

/* of a band's columns as LAPACK factors them */
static inline size_t rd_space_rows(size_t width, int closed)
{
    return 3 * rd_space_beside(width, closed) + 1;
}

/* Joints whose inverse has larger entries are not joined: near a resonance of what is on their left. What
   several lose one after another is multiplied: of 100 each a ring's count lost 6 digits. A larger one is taken
   where too many parts are left. */
enum { RD_SPACE_GENTLE = 3 };
static const double rd_space_gentle[RD_SPACE_GENTLE] = {4, 1e2, 1e4};

/* How fields run along a piece: 2^-halvings of each of its `equal` parts is summed as a series about its
   left end. With nodes = 1 all such parts are alike; with equal 2^halvings of them they are those parts,
   one after another; else parts about the nodes of a polynomial (Chebyshev's of the first kind, decreasing), from which
   the others are interpolated. */
struct rd_space_run {
    size_t width;
    double length; /* [m] */
    int equal, halvings, nodes;
    size_t fields;
    const double *series; /* (nodes, fields, RD_SPACE_ORDERS) of phi_j by powers of s - left end */
};

struct rd_space {
    size_t components, width, pieces, fields;
    const double *length;    /* (pieces)          [m] */
    const int32_t *halvings; /* (pieces)  where something changes; else each count finds its own */
    const int32_t *nodes;    /* (pieces)  */
    const double *series;    /* (sum of nodes, fields, RD_SPACE_ORDERS) */
    /* of each component: */
    const double *rates;   /* (pieces, fields, 3, width, width)  Phi, S and q at lambda = 0 */
    const double *inertia; /* (pieces, width, width)    per length */
    const double *turn; /* (pieces, width, width)    R: coordinates on the left of the node where it
                                begins to those on the right */
    const double
        *stiffness;      /* (pieces + 1, width, width) of nodes, in the frame on the left; at the
                                first on the right */
    const double *mass;  /* (pieces + 1, width, width) */
    const uint8_t *held; /* (pieces + 1, width)   1: cannot move; as stiffness */
    int closed; /* the last node is the first, on whose left the last piece is: nothing else stands there */
};

/* The parts of a piece at `lines` (lines, fields, 3, width, width) = Phi, S, q of each field, doubled
   `doublings` times or, earlier, while no joint's (I + G Q)^-1 is farther from I than `gentle`: *reached says
   how often. triple (lines, nodes, 3, width, width): D = F - I, G, Q of the one that all are, of the first nodes
   where there are no more than these, or about the nodes; of use only where *whole says that each was
   doubled *reached times. Takes what it needs from the
   workspace (with base NULL: counts it). RD_NO_MEMORY where that is too small. */
enum rd_status rd_space_triples(const struct rd_space_run *run, size_t lines,
                                const double _Complex *rates, int doublings, double gentle,
                                double _Complex *triple, int *reached, int *whole,
                                struct rd_workspace *workspace);

/* The matrix of motion u at the nodes and force f at the right end of each part, u_0, f_0, u_1 ..,

       f_i-1 - F^T f_i + (Q + N) u_i = p_i,   u_i+1 - F u_i - G f_i = d_i,

   a band of size = (2 parts + 1) width, at so many lines, of entries of `numbers` doubles, 1 or 2; rows
   and columns that are fixed are those of 1. Of a closed rope the last u is the first: its rows are fixed,
   and what solves leaves it there once more. */
struct rd_space_band {
    size_t width, lines, parts, numbers;
    const double *D, *G, *Q; /* (lines, parts, width, width) */
    const double *N;         /* (lines, parts + 1, width, width) */
    const uint8_t *fixed;    /* (lines, size) */
    int closed;
};

/* The real parts of such bands, factored by columns (lines, size, rd_space_rows(width, closed)) as LAPACK does;
   pivot (lines, size). Returns the first that is singular, or `lines`. */
size_t rd_space_factor(const struct rd_space_band *band, double *factor, int32_t *pivot);

/* x (lines, columns, size): right sides, solved in place; work (columns, size) */
void rd_space_solve(size_t width, int closed, size_t lines, size_t size, size_t columns,
                    const double *factor, const int32_t *pivot, double *x, double *work);

/* y = A x of columns (lines, columns, size), A complex; rows that are fixed are 0, and columns count. */
void rd_space_apply(const struct rd_space_band *band, size_t columns, const double _Complex *x,
                    double _Complex *y);

/* x (lines, columns, size) <- Re(A)^-1 Im(A) x, so many times, its columns made orthonormal before and
   after each, and form (lines, 2, columns, columns) = x^T Re(A) x and x^T Im(A) x; A complex and factored,
   work (2, columns, size). */
void rd_space_iterate(const struct rd_space_band *band, size_t columns, const double *factor,
                      const int32_t *pivot, size_t times, double *x, double *form, double *work);

/* Right sides x (lines, columns, size) of bands of complex numbers, solved in place, several lines side
   by side; not finite where one is singular. Takes what it needs from the workspace (with base NULL:
   counts it). RD_NO_MEMORY where that is too small. */
enum rd_status rd_space_respond(const struct rd_space_band *band, size_t columns,
                                double _Complex *x, struct rd_workspace *workspace);

/* Eigenvalues of a component below each lambda, both (count), counted in coordinates scaled by z (count, width), u = z u^ and
   f = f^/z, so that entries of E times a piece's length are of a size. NAN where joints between
   resonances leave more parts than are counted together. Takes what it needs from the workspace (with
   base NULL: counts it). RD_NO_MEMORY where that is too small. */
enum rd_status rd_space_count(const struct rd_space *rope, size_t count, const int32_t *component,
                              const double *lambda, const double *z, double *below,
                              struct rd_workspace *workspace);

#endif
