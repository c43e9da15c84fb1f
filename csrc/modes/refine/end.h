/* Where the iteration turns round: the right end, one lane after another. */
#ifndef RD_REFINE_END_H
#define RD_REFINE_END_H

#include "base/complex.h"
#include "modes/refine/left.h"

#include <float.h>
#include <math.h>
#include <string.h>

static double _Complex lane_of(const cv *x, int k)
{
    return CMPLX(x->re[k], x->im[k]);
}

/* a/b by the textbook's formula: the same bits with every compiler */
static double _Complex quotient(double _Complex a, double _Complex b)
{
    return a * conj(b) / (creal(b) * creal(b) + cimag(b) * cimag(b));
}

/* x <- A[:, :W]^-1 A[:, W] by elimination with pivoting; A, made of numbers of a size, is destroyed.
   True where it is singular but for their rounding: x is then what A takes to 0, very large and of any
   phase. */
static _Bool eliminate(double _Complex A[W][W + 1], double size, double _Complex *x)
{
    _Bool singular = 0;
    for (int c = 0; c < W; c++) {
        int best = c;
        for (int i = c + 1; i < W; i++)
            if (cabs(A[i][c]) > cabs(A[best][c]))
                best = i;
        double _Complex row[W + 1];
        memcpy(row, A[c], sizeof row);
        memmove(A[c], A[best], sizeof row);
        memcpy(A[best], row, sizeof row);
        singular = singular || cabs(A[c][c]) < 64 * DBL_EPSILON * size;
        if (cabs(A[c][c]) < 1e-40)
            A[c][c] = 1e-40;
        for (int i = 0; i < W; i++) {
            if (i == c)
                continue;
            const double _Complex share = quotient(A[i][c], A[c][c]);
            for (int j = c; j <= W; j++)
                A[i][j] -= share * A[c][j];
        }
    }
    for (int c = 0; c < W; c++)
        x[c] = quotient(A[c][W], A[c][c]);
    return singular;
}

/* s of a motion that nothing drives is free by a phase: that which makes u = U s and
   f = -i (s - u) real, by the largest of both */
static void make_real(const struct left *left, int lane, double _Complex *s)
{
    double _Complex largest = 0;
    for (int i = 0; i < W; i++) {
        double _Complex u = 0;
        for (int j = 0; j < W; j++)
            u += lane_of(&left->U[i][j], lane) * s[j];
        const double _Complex f = CMPLX(0, -1) * (s[i] - u);
        largest = cabs(u) > cabs(largest) ? u : largest;
        largest = cabs(f) > cabs(largest) ? f : largest;
    }
    const double size = cabs(largest);
    for (int i = 0; i < W && size > 0; i++)
        s[i] *= conj(largest / size);
}

/* The right end: f + N u = p where free, u = 0 where held: row i of (N U - i Y) s = p - N g - i g
   or of U s = -g; one lane after another. */
static void end_solve(const struct left *left, const struct rate *rate, const uint8_t *held,
                      const lanes *p, cv *s)
{
    for (int k = 0; k < RD_LANES; k++) {
        double _Complex A[W][W + 1], x[W];
        double size = 1; /* U has no larger entries */
        for (int i = 0; i < W; i++) {
            for (int j = 0; j < W; j++) {
                const double _Complex U = lane_of(&left->U[i][j], k);
                A[i][j] = held[i] ? U : CMPLX(-cimag(U), creal(U) - (i == j));
            }
            const double _Complex g = lane_of(left->g + i, k);
            A[i][W] = held[i] ? -g : CMPLX(p[i][k] + cimag(g), -creal(g));
            for (int m = 0; m < W && !held[i]; m++) {
                const double N = rate->V[i][m][k];
                size = fmax(size, fabs(N));
                for (int j = 0; j < W; j++)
                    A[i][j] += N * lane_of(&left->U[m][j], k);
                A[i][W] -= N * lane_of(left->g + m, k);
            }
        }
        if (eliminate(A, size, x))
            make_real(left, k, x);
        for (int c = 0; c < W; c++) {
            s[c].re[k] = creal(x[c]);
            s[c].im[k] = cimag(x[c]);
        }
    }
}

#endif
