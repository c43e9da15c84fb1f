/* The area under a tensed cantilever, which a rope that hangs stretches by. */
#ifndef RD_AREA_H
#define RD_AREA_H

#include "base/complex.h"
#include "element/coordinate.h"

/* a = integral of z dx over an element held at its left end. With the shape functions of
   element/triple.h, c = (1/2 - P1)/theta and d = (1/3 - P2)/theta:

       of the left end's motion             a = l z + l^2 (tau - P1) beta
       per moment and force at the right    S_bb l^3 (P1 - P2),  S_bb l^4 (P2 - c)
       per force on each unit of length     S_bb l^5 (P2 - 2 c + d)                        */
struct rd_area {
    double _Complex lean; /* tau - P1 */
    double _Complex P[3]; /* P1 - P2, P2 - c, P2 - 2 c + d */
};

/* at theta = T S_bb l^2 of a tensed or rigid element under tension, Re theta >= 0 */
struct rd_area rd_area_at(enum rd_kind kind, double _Complex theta);

/* The same with both ends held, without tension at theta = 0:

       a = l (z_a + z_b)/2 + l^2 lean (beta_a - beta_b) + S_bb l^5 load  per force on unit length

   with the functions at theta/4: lean = P2/(4 tau), load = (tau/3 - P2)/(4 tau theta) */
struct rd_area_held {
    double _Complex lean, load;
};

struct rd_area_held rd_area_held_at(double _Complex theta);

#endif
