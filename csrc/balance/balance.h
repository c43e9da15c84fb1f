/* Harmonic balance: forces on points over a period, and how they answer to the motion's harmonics. */
#ifndef RD_BALANCE_H
#define RD_BALANCE_H

#include <stddef.h>

#include "base/complex.h"

/* Motion of points is the sum of q_k e^(i k omega t) over k = -K..K, q_-k = conj q_k. The harmonics of
   the forces follow the motion's by the Fourier coefficients of their slopes,

       dr_k = sum of (by_u_(k-l) + i l omega by_v_(k-l)) dq_l over l = -K..K,

   and q_k - H_k r_k is what is balanced. */
struct rd_balance {
    size_t points;                   /* m                                                        */
    size_t harmonics;                /* K                                                        */
    double omega;                    /* [rad/s]                                                  */
    const double _Complex *transfer; /* (K + 1, m, m) H at k omega, points follow each other by  */
    size_t pitch;                    /* so many numbers, m at least                              */
    const double _Complex *by_u;     /* (m, m, orders) of df/du, from 0 on                       */
    const double _Complex *by_v;     /* as by_u, of df/dv; NULL: none                            */
    size_t orders;                   /* 2 K + 1 at least                                         */
};

/* jacobian (n, n), n = m (2 K + 1), of what is balanced by the motion: of each point Re q_0..q_K and
   Im q_1..q_K; work (4 m m) */
void rd_balance_jacobian(const struct rd_balance *balance, double *work, double *jacobian);

/* An elastic stop, -side stiffness a where a = side u - gap > 0, on average while a sample stands. */
struct rd_balance_stop {
    double stiffness; /* [N/m]   */
    double gap;       /* [m]     */
    double side;      /* 1 or -1 */
    double step;      /* [s]     */
};

/* u, v (samples) of one period; force, by_u, by_v (samples) are added to */
void rd_balance_stopped(const struct rd_balance_stop *stop, size_t samples, const double *u,
                        const double *v, double *force, double *by_u, double *by_v);

#endif
