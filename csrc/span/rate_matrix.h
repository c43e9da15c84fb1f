/* How motion and force change along a continuous span, at several lambda side by side. */
#ifndef RD_RATE_MATRIX_H
#define RD_RATE_MATRIX_H

#include "base/lanes.h"
#include "chain/chain.h"

/* y = (u, f), f the force of the right part on the left, has y' = E y,

       E = | Phi  S'    |   Phi_z,beta = 1,  q = -lambda inertia + s drag, + T for beta,
           | q   -Phi^T |   S' the section flexibility, 1/T for z without bending

   A rope that hangs is curved by w/T, w its weight per length: with x along the curve and z towards
   its centre, which is up, the strain is x' - (w/T) z, and the tension h that it adds pulls by
   (w/T) h (Irvine and Caughey 1974): Phi_x,z = w/T. */
struct rate_matrix {
    cv S[RD_WIDTH_MAX][RD_WIDTH_MAX];          /* S' */
    _Bool elastic[RD_WIDTH_MAX][RD_WIDTH_MAX]; /* where it is not zero */
    cv q[RD_WIDTH_MAX];
    lanes lever; /* Phi_z,beta */
    int z;       /* index of z where it bends, beta being the last; else -1 */
    int across;  /* index of z, -1 where there is none */
    cv sag;      /* Phi_x,z */
    _Bool hangs; /* it is there; x and z are the first two coordinates */
};

/* The rate matrix of distinct element e with S/section, T tension, and inertia and
   dashpot times what a node of unit length would have. */
void rd_rate_fill(const struct rd_chain *chain, size_t e, cv section, cv tension, cv inertia,
                  cv dashpot, struct rate_matrix *rate);

/* a^T H b of two states (2 width), y' = J H y: H = [-q Phi^T; Phi S'], the same everywhere along the
   span where both obey it */
cv rd_rate_form(const struct rate_matrix *rate, size_t w, const cv *a, const cv *b);

/* the same with the sizes of all its terms, of states by theirs */
lanes rd_rate_size(const struct rate_matrix *rate, size_t w, const lanes *a, const lanes *b);

#endif
