/* Implicit time steps of a chain, each stage a sweep that keeps its factorisation. */
#ifndef RD_MARCH_H
#define RD_MARCH_H

#include "base/status.h"
#include "base/workspace.h"
#include "chain/chain.h"
#include "chain/ports.h"
#include "law/law.h"

#include <stdbool.h>

/* Two equal implicit stages at t + g h and t + (1 - g) h: with theta = g h and k of y' = k

       Y_1 = y_0 + theta k_1,  Y_2 = y_0 + (1 - 2g) h k_1 + theta k_2,  y_1 = y_0 + h/2 (k_1 + k_2)

   Second order; g = 1/4 is two midpoint steps and keeps energy, up to g = 1 - 1/sqrt 2 fast motion
   is damped more and more (Alexander 1977). State is motion and the elastic forces of the elements,
   which are carried along: from displacements they would lose digits as n^4.

   A stage seeks D, what the motion changes by. With S^ = S_T + drag/theta of the strings and
   r = 1 + rate/theta,

       (M/theta^2 + C/theta + K (1 + rate/theta)) D + elements (F, G/r, r Q) beside S^ on D = p

   p being loads, M v/theta and what springs and forces need at the start; then v = D/theta. It is
   solved in scattering form (u = z u^, f = f^/z, z powers of two): the left part is u = R f + w,
   R >= 0, and with s = u + f, U = R (I + R)^-1 of eigenvalues in 0 ... 1

       u = U s + c,   f = s - u

   At a node with term N, K = (G + I)^-1, A = K G, B = K F, W = Q + N + F^T B - I of the element on
   its right:

       E = (I + W U)^-1,  Z = U E,   U' = A + B Z B^T,   H = B E^T,   J = B Z
       c' = H c + J p                                    forward
       s = H^T s' + E (p - W c),   u = U s + c           backward

   Where a coordinate is held, Z and E lose it: Z -= Z_i Z_i^T/Z_ii. A string k between the nodes,
   a = A e_z, b = (B - I)^T e_z, x = k/(1 + k A_zz), makes it A - x a a^T, B - x a b^T,
   W + x b b^T; a hinge of compliance t at the left end with P = W + I, b = B e_i, q = P e_i,
   x = 1/(P_ii + 1/t) makes it A + x b b^T, B - x b q^T, P - x q q^T, free ones included. */

/* what acts beside the chain's own elements, dashpots and springs */
struct rd_beside {
    const double *rate;   /* (distinct)  gamma [s]: end force f + gamma df/dt, its hinge alike */
    const double *string; /* (distinct)  tension of a string parallel to each element [N] */
    const double *drag;   /* (distinct)  of that string, force drag/l (dz_b/dt - dz_a/dt) [N s] */
    double spring_rate;   /* of node springs [s] */
    double mass_rate;     /* alpha of the resonators' masses: force alpha m dy/dt [1/s] */
    double stretching; /* EA/L [N/m]: tension += stretching sum (z_b - z_a)^2/2l of all elements */
};

/* a motion, changed in place */
struct rd_motion {
    double *u; /* (nodes, width)      displacement */
    double *v; /* (nodes, width)      velocity */
    double *f; /* (nodes - 1, width)  elastic force on the right ends of elements, strings apart */
    double *y; /* (attached)          displacement of the resonators' masses */
    double *w; /* (attached)          velocity */
};

/* what moves a stage */
struct rd_push {
    const struct rd_ports *drives;
    const double *force; /* (drives) [N, N m] */
    size_t moved;
    const int32_t *place; /* (moved, 2)  node and index of a held coordinate that moves */
    const double *speed;  /* (moved)     its velocity */
};

/* the numbers of one block of steps */
struct rd_steps {
    size_t count;
    double g;
    double h;            /* [s] */
    const double *force; /* (count, 2, drives) at the stage times */
    const double *speed; /* (count, 2, moved): u += h/2 (both) */
    const double *extra; /* (count, 2) tension added to every string, or NULL: as factored */
    bool refined;        /* each stage solved twice: see march/stage.c */
    double *read;        /* (count, 3, responses) displacement, velocity, acceleration */
    double *energy;      /* (count, RD_ENERGIES) or NULL */
    double *taken;       /* (count, laws) or NULL  [J] by each law during the step */
    double residual;     /* of the stage that did not converge, relative */
};

/* at g = 1/4 the change of kinetic and strain energy is input - dissipated - taken */
enum rd_energy { RD_KINETIC, RD_STRAIN, RD_INPUT, RD_DISSIPATED, RD_ENERGIES };

struct rd_march; /* see march/form/state.h */

#endif
