/* The mixed form of a chain: forces of elements beside displacements of nodes, as one band. */
#ifndef RD_MIXED_H
#define RD_MIXED_H

#include "assembled/assemble.h"
#include "base/complex.h"
#include "base/workspace.h"
#include "chain/ports.h"
#include "mixed/lu.h"

#include <stdbool.h>

/* Unknowns, block by block of one width: the displacement u of a node, the force f_b on the right
   end of the element on its right, the next node's u, and so on; where a hinge stands, the force in
   it and the displacement on its right come between. Rows, symmetric:

       node      f_prev + (N + Q) u_a - F^T f_b = p
       element   u_b - F u_a - G f_b = g              g: dislocation of its right end
       hinge     u_right - u_left - C f = 0           times s^2 = 1/(1 + |C|), and f = s f^

   with u = 0 for the row of a held coordinate. Scaled with static receptances of the whole rope,
   u = z u^, f = f^/z (L^3/B or L/T, L/B, L/C, L/EA), the condition grows with n only; with the
   stiffness of elements as units it would grow with n^4. */
struct rd_mixed {
    const struct rd_chain *chain;
    size_t size;            /* unknowns */
    size_t reach;           /* the largest distance of two that meet, 2 width - 1 */
    double z[RD_WIDTH_MAX]; /* scale of each coordinate */
    size_t *block;          /* (nodes) block of the node's displacement */
    double _Complex *band;  /* (size, 2 reach + 1) */
    struct rd_lu lu;        /* of the band */
    double _Complex *rest;  /* (size) */
};

/* Takes the arrays and fills what does not depend on frequency; nothing is asked whether to stop until
   lu.stop is set. */
enum rd_status rd_mixed_prepare(const struct rd_chain *chain, struct rd_mixed *mixed,
                                struct rd_workspace *workspace);

/* Fills at the factors (RD_PARTS) of sections, tension, springs, inertia and dashpots, and factorises.
   RD_SINGULAR where that meets an exact zero, RD_CRITICAL_ELEMENT where an element has no triple,
   RD_INTERRUPTED. */
enum rd_status rd_mixed_factorise(struct rd_mixed *mixed, const double _Complex *factor);

/* x (columns, size) <- solution for the right-hand side b (columns, size), refined once: small
   relative errors of the entries of the band are then all that rounding amounts to. Where lu.stop
   has said yes x has no meaning, nor has what follows from it. */
void rd_mixed_solve(struct rd_mixed *mixed, size_t columns, const double _Complex *b,
                    double _Complex *x);

/* spread (size) <- |M| |x| of the band M */
void rd_mixed_spread(const struct rd_mixed *mixed, const double _Complex *x, double *spread);

/* What rounding changes in y^T b where M x = b and M y is what reads the answer: relative errors of
   a few eps in the entries of M amount to eps |y|^T |M| |x| to first order. */
double rd_mixed_error(const struct rd_mixed *mixed, const double _Complex *y, const double *spread);

/* Whether the size x^H x of the solution x has no correct digit, by the same estimate with the
   solution y for conj(x); scratch (2, size) */
bool rd_mixed_is_lost(struct rd_mixed *mixed, const double _Complex *x, const double *spread,
                      double _Complex *scratch);

/* load (size) <- forces and dislocation of port p, scaled; the rest is zeroed */
void rd_mixed_load(const struct rd_mixed *mixed, const struct rd_ports *ports, size_t p,
                   double _Complex *load);

/* what the port reads of x (size) */
double _Complex rd_mixed_read(const struct rd_mixed *mixed, const struct rd_ports *ports, size_t p,
                              const double _Complex *x);

#endif
