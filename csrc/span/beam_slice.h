/* The first piece of a continuous span that bends and does nothing else, by four power series.

   In units of the piece, z, phi = l beta, m = S_bb l^2 M, f = S_bb l^3 F, the shapes solve
   z'''' = theta z'' + kappa z with theta = (T - lambda j) S_bb l^2, kappa = lambda mu S_bb l^4: with
   g_0 = 1, g_1 = theta, g_n+1 = theta g_n + kappa g_n-1 and S_k = sum g_n/(2 n + k)! the force at the
   right end is (f, m) = E22 (f, m) + E21 (z, phi) of the left end, and so is (z, phi) with E12:

       E22 = | 1 + kappa S4   -kappa S3 |   E12 = | -S3   S2 |   E21 = | -kappa (1 + kappa S5)   -kappa S2           |
             | -S1             S0       |         | -S2   S1 |         |  kappa S2           theta S1 + kappa S3  |  */
#ifndef RD_BEAM_SLICE_H
#define RD_BEAM_SLICE_H

#include "base/lanes.h"

/* z, beta: D = F - I, G, Q in units of the piece */
struct beam_slice {
    cv Dzz, Dzb, Dbz, Dbb, Gzz, Gzb, Gbb, Qzz, Qzb, Qbb;
};

/* S_0 - 1 = theta S_2 + kappa S_4, S_1 = 1 + theta S_3 + kappa S_5, and S_2 .. S_5 summed */
RD_INLINE void beam_series(cv theta, cv kappa, int terms, cv *S)
{
    cv before = c_zero(), g = c_real(1.0);
    double first = 0.5; /* 1/(2 n + 2)! */
    for (int k = 2; k < 6; k++)
        S[k] = c_zero();
    for (int n = 0;; n++) {
        double part = first;
        for (int k = 2; k < 6; k++) {
            S[k] = c_add(S[k], c_scale(g, part));
            part /= (double)(2 * n + k + 1);
        }
        if (n == terms)
            break;
        const cv next = c_add(c_mul(theta, g), c_mul(kappa, before));
        before = g;
        g = next;
        first /= (double)((2 * n + 3) * (2 * n + 4));
    }
    S[0] = c_add(c_mul(theta, S[2]), c_mul(kappa, S[4]));
    S[1] = c_add(c_mul(theta, S[3]), c_mul(kappa, S[5]));
    S[1].re += 1.0;
}

/* terms: of the series in powers of theta and kappa */
RD_INLINE void beam_slice_fill(cv theta, cv kappa, int terms, struct beam_slice *b)
{
    cv S[6];
    beam_series(theta, kappa, terms, S);
    const cv one = c_real(1.0), S0 = c_add(one, S[0]);
    const cv kS3 = c_mul(kappa, S[3]), kS4 = c_mul(kappa, S[4]), kS2 = c_mul(kappa, S[2]);
    const cv C = c_add(one, kS4), S13 = c_mul(kS3, S[1]);
    const cv det = c_sub(c_mul(C, S0), S13), s = c_inverse(det);
    b->Dzz = c_mul(c_sub(S13, c_mul(kS4, S0)), s);
    b->Dzb = c_mul(S[1], s);
    b->Dbz = c_mul(kS3, s);
    b->Dbb = c_mul(c_sub(S13, c_mul(C, S[0])), s);
    b->Gzz = c_mul(c_sub(c_mul(S[1], S[2]), c_mul(S0, S[3])), s);
    b->Gzb = c_mul(c_sub(c_mul(S[2], C), c_mul(kS3, S[3])), s);
    b->Gbb = c_mul(c_sub(c_mul(S[1], C), c_mul(kS3, S[2])), s);
    const cv stretch = c_add(one, c_mul(kappa, S[5]));
    const cv moment = c_add(c_mul(theta, S[1]), kS3);
    b->Qzz = c_mul(c_mul(kappa, c_sub(c_mul(kS2, S[3]), c_mul(stretch, S0))), s);
    b->Qzb = c_mul(c_sub(c_mul(kS3, moment), c_mul(kS2, S0)), s);
    b->Qbb = c_mul(c_sub(c_mul(C, moment), c_mul(kS2, S[1])), s);
}

#endif
