/* Rayleigh-Ritz in the space of a few vectors. */
#include "modes/certify/ritz.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { N = RD_LANES, SWEEPS = 12 };

/* squared size, relative to the largest, below which a combination of vectors is rounding */
static const double DEPENDENT = 1e-12;

/* x, y <- c x - s y, s x + c y, `step` apart */
static void turn_pair(size_t n, size_t step, double c, double s, double *x, double *y)
{
    for (size_t i = 0; i < n; i++, x += step, y += step) {
        const double a = *x, b = *y;
        *x = c * a - s * b;
        *y = s * a + c * b;
    }
}

/* One Jacobi rotation that removes A_pq */
static void rotate(size_t n, double *A, double *V, size_t p, size_t q)
{
    const double pq = A[p * n + q], pp = A[p * n + p], qq = A[q * n + q];
    if (fabs(pq) <= 1e-18 * (fabs(pp) + fabs(qq)) && fabs(pq) <= 1e-18 * sqrt(fabs(pp * qq)))
        return;
    const double t0 = (qq - pp) / (2 * pq);
    const double t = (t0 >= 0 ? 1 : -1) / (fabs(t0) + hypot(t0, 1));
    const double c = 1 / hypot(t, 1);
    const double s = t * c;
    turn_pair(n, n, c, s, A + p, A + q);
    turn_pair(n, 1, c, s, A + p * n, A + q * n);
    A[p * n + q] = A[q * n + p] = 0;
    turn_pair(n, n, c, s, V + p, V + q);
}

void rd_ritz_rotate(size_t n, double *A, double *V)
{
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t p = 0; p < n; p++)
            for (size_t q = p + 1; q < n; q++)
                rotate(n, A, V, p, q);
}

/* Y (n, m) with Y^T M Y = I: the eigenvectors of the scaled M that are not rounding */
static size_t basis(size_t n, double *M, double *Y)
{
    double scale[N], V[N * N] = {0}, most = 0;
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        scale[i] = M[i * n + i] > 0 ? 1 / sqrt(M[i * n + i]) : 0;
        V[i * n + i] = 1;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            M[i * n + j] = M[j * n + i] = (M[i * n + j] + M[j * n + i]) / 2 * scale[i] * scale[j];
    for (size_t i = 0; i < n; i++)
        M[i * n + i] = scale[i] > 0;
    rd_ritz_rotate(n, M, V);
    for (size_t i = 0; i < n; i++)
        most = fmax(most, M[i * n + i]);
    for (size_t k = 0; k < n; k++) {
        if (!(M[k * n + k] > DEPENDENT * most))
            continue;
        for (size_t i = 0; i < n; i++)
            Y[i * n + m] = scale[i] * V[i * n + k] / sqrt(M[k * n + k]);
        m++;
    }
    return m;
}

/* B (m, m) = Y^T A Y, Y (n, n) of which m columns are used */
static void project(size_t n, size_t m, const double *A, const double *Y, double *B)
{
    for (size_t a = 0; a < m; a++)
        for (size_t b = 0; b < m; b++) {
            double sum = 0;
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < n; j++)
                    sum += Y[i * n + a] * (A[i * n + j] + A[j * n + i]) / 2 * Y[j * n + b];
            B[a * m + b] = sum;
        }
}

size_t rd_ritz(size_t n, double *A, double *M, double *theta, double *C)
{
    double Y[N * N] = {0}, B[N * N] = {0}, V[N * N] = {0};
    const size_t m = basis(n, M, Y);
    project(n, m, A, Y, B);
    for (size_t i = 0; i < m; i++)
        V[i * m + i] = 1;
    rd_ritz_rotate(m, B, V);
    bool taken[N] = {false};
    for (size_t j = 0; j < m; j++) {
        size_t least = m;
        for (size_t k = 0; k < m; k++)
            if (!taken[k] && (least == m || B[k * m + k] < B[least * m + least]))
                least = k;
        taken[least] = true;
        theta[j] = B[least * m + least];
        for (size_t i = 0; i < n; i++) {
            C[i * n + j] = 0;
            for (size_t k = 0; k < m; k++)
                C[i * n + j] += Y[i * n + k] * V[k * m + least];
        }
    }
    return m;
}

void rd_ritz_combine(size_t n, const double *C, size_t count, lanes *x)
{
    for (size_t m = 0; m < count; m++) {
        lanes y = x[m];
        for (size_t j = 0; j < n; j++) {
            y[j] = 0;
            for (size_t i = 0; i < N; i++)
                y[j] += C[i * n + j] * x[m][i];
        }
        x[m] = y;
    }
}
