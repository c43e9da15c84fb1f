/* Krylov's functions, of which the motion of beams is made. */
#ifndef RD_KRYLOV_H
#define RD_KRYLOV_H

#include "base/complex.h"

/* c_j(p) = sum of p^n/(4n + j)!, n = 0, 1, ..: for p = P^4

       c_0 = (cosh P + cos P)/2          c_1 = (sinh P + sin P)/2P
       c_2 = (cosh P - cos P)/2P^2       c_3 = (sinh P - sin P)/2P^3      c_4 = (c_0 - 1)/P^4

   and for p = -4 x^4

       c_0 = cos x cosh x                c_1 = (cos x sinh x + sin x cosh x)/2x
       c_2 = sin x sinh x/2x^2           c_3 = (sin x cosh x - cos x sinh x)/4x^3 */
struct rd_krylov {
    double _Complex c[5]; /* times exp(-growth) */
    double _Complex one;  /* exp(-growth) */
};

/* Analytic in p beside the imaginary axis: with a small imaginary part of p as a step, derivatives
   follow. */
struct rd_krylov rd_krylov(double _Complex p, double _Complex growth);

/* d/dp of all of them at the same growth, `one` apart */
struct rd_krylov rd_krylov_slope(double _Complex p, double _Complex growth);

/* A growth that leaves all of them finite; 0 where p is small, and of real p continuous there. */
double _Complex rd_krylov_growth(double _Complex p);

#endif
