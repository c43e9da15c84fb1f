/* Sums are taken by harmonics k and l: what both +l and -l do to k, by Re q_l and by Im q_l. */
#include "balance/balance.h"

#include <math.h>
#include <string.h>

static const double TINY = 1e-150; /* motion is taken for at least this in a sample */

static double _Complex coefficient(const double _Complex *series, ptrdiff_t order)
{
    return order < 0 ? conj(series[-order]) : series[order];
}

/* slopes of the forces' harmonic k by Re q_l, and over i by Im q_l: (2, 2, m, m), real parts first */
static void slopes(const struct rd_balance *balance, ptrdiff_t k, ptrdiff_t l, double *slope)
{
    const size_t all = balance->points * balance->points, width = balance->orders;
    const double turn = (double)l * balance->omega, share = l == 0 ? 0.5 : 1.0;
    for (size_t pair = 0; pair < all; pair++) {
        const double _Complex near = coefficient(balance->by_u + pair * width, k - l);
        const double _Complex far = coefficient(balance->by_u + pair * width, k + l);
        double _Complex real = near + far, imaginary = near - far;
        if (balance->by_v != NULL) {
            const double _Complex ahead = coefficient(balance->by_v + pair * width, k - l);
            const double _Complex behind = coefficient(balance->by_v + pair * width, k + l);
            real += CMPLX(-turn * cimag(ahead - behind), turn * creal(ahead - behind));
            imaginary += CMPLX(-turn * cimag(ahead + behind), turn * creal(ahead + behind));
        }
        slope[pair] = share * creal(real);
        slope[all + pair] = share * cimag(real);
        slope[2 * all + pair] = creal(imaginary);
        slope[3 * all + pair] = cimag(imaginary);
    }
}

/* takes what H_k makes of the slopes from the rows of harmonic k, in the columns of harmonic l */
static void take(const struct rd_balance *balance, size_t k, size_t l, const double *slope,
                 double *jacobian)
{
    const size_t m = balance->points, K = balance->harmonics, width = 2 * K + 1, n = m * width;
    for (size_t i = 0; i < m; i++) {
        double *real = jacobian + (i * width + k) * n;
        double *imaginary = jacobian + (i * width + K + k) * n;
        for (size_t p = 0; p < m; p++) {
            const double _Complex H = balance->transfer[(k * m + i) * balance->pitch + p];
            const double a = creal(H), b = cimag(H), *from = slope + p * m;
            for (size_t j = 0; j < m; j++) {
                const double *at = from + j;
                const double re[] = {at[0], at[2 * m * m]}, im[] = {at[m * m], at[3 * m * m]};
                const size_t own = j * width + l, turned = j * width + K + l;
                real[own] -= a * re[0] - b * im[0];
                if (l > 0)
                    real[turned] += a * im[1] + b * re[1];
                if (k > 0)
                    imaginary[own] -= a * im[0] + b * re[0];
                if (k > 0 && l > 0)
                    imaginary[turned] -= a * re[1] - b * im[1];
            }
        }
    }
}

void rd_balance_jacobian(const struct rd_balance *balance, double *work, double *jacobian)
{
    const size_t K = balance->harmonics, n = balance->points * (2 * K + 1);
    memset(jacobian, 0, n * n * sizeof *jacobian);
    for (size_t i = 0; i < n; i++)
        jacobian[i * n + i] = 1.0;
    for (size_t k = 0; k <= K; k++)
        for (size_t l = 0; l <= K; l++) {
            slopes(balance, (ptrdiff_t)k, (ptrdiff_t)l, work);
            take(balance, k, l, work, jacobian);
        }
}

/* the largest change of velocity from one sample to the next, round the period */
static double largest_change(size_t samples, const double *v)
{
    double largest = fabs(v[0] - v[samples - 1]);
    for (size_t n = 1; n < samples; n++)
        largest = fmax(largest, fabs(v[n] - v[n - 1]));
    return largest;
}

void rd_balance_stopped(const struct rd_balance_stop *stop, size_t samples, const double *u,
                        const double *v, double *force, double *by_u, double *by_v)
{
    const double k = stop->stiffness, half = stop->step / 2;
    /* where v passes 0 it is the acceleration that moves */
    const double turns = largest_change(samples, v) / 4;
    for (size_t n = 0; n < samples; n++) {
        /* a changes by 2 w while the sample stands: so the force has a slope when contact begins at
           one more of them */
        const double passing = fmax(hypot(v[n], turns), TINY), w = fmax(passing * half, TINY);
        const double a = stop->side * u[n] - stop->gap;
        const double share = fmin(fmax((a + w) / (2 * w), 0.0), 1.0);
        force[n] -= stop->side * k * (share < 1 ? share * share * w : a);
        by_u[n] -= k * share;
        by_v[n] -= share * (1 - share) * (v[n] / passing) * (stop->side * k * half);
    }
}
