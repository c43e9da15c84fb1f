/* The triple (F, G, Q) of an element, at any complex stiffness and tension. */
#ifndef RD_TRIPLE_H
#define RD_TRIPLE_H

#include "base/complex.h"
#include "base/status.h"
#include "element/element.h"

/* u_b = F u_a + G f_b,  f_a = F^T f_b - Q u_a;  F, G, Q (width, width), of the element with S/section
   and T tension; 1 and 1 where nothing is damped. With S_bb, theta = T S_bb l^2 and r_c = S_cb/S_bb
   for the channels c that bending drives (1 for z and beta):

       F = I but F_z,beta = l tau, F_c,beta = -r_c theta P1, F_beta,beta = 1 - theta P1
       G_ij = r_i r_j S_bb l^(1+k) P_k, k the number of z among i, j
       G_cd = l (S_cd - S_cb S_bd/S_bb) + r_c r_d S_bb l P0 among the others
       Q_beta,beta = T l tau

   tensed, t = sqrt(theta): tau = P0 = tanh(t)/t, P1 = (1 - 1/cosh(t))/theta, P2 = (1 - tau)/theta
   rigid, p = 1 + theta/3:  tau = 1/p, P0 = (1 + theta/12)/p, P1 = 1/2p, P2 = 1/3p
   difference:              tau = 0, P0 = 1, P1 = 1/2, P2 = 1/3, theta = 0

   A string, z without beta, has F = 1, G = l/T, Q = 0 and must have tension > 0.

   Rope that hangs is longer by w/T times the area a under z, and h along x loads it by (w/T) h on
   each unit of length: with a of element/area.h, w/T times its motion is added to F_x and its
   flexibilities to G_x, (w/T)^2 times its own to G_xx. Of a string a = l z + l^2 F_z/2T + l^3/3T
   per load. RD_CRITICAL_ELEMENT where the compression is the critical load of this cantilever. */
enum rd_status rd_triple(const struct rd_element *element, double _Complex section,
                         double _Complex tension, double _Complex *F, double _Complex *G,
                         double _Complex *Q);

/* D = F - I, G and Q with factors 1, which are real: in D small elements keep their digits */
enum rd_status rd_triple_change(const struct rd_element *element, double *D, double *G, double *Q);

/* the same with F */
enum rd_status rd_triple_real(const struct rd_element *element, double *F, double *G, double *Q);

#endif
