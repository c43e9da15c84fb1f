/* Rayleigh-Ritz in the space of a few vectors. */
#include "modes/certify/ritz.h"

#include <math.h>
#include <string.h>

enum { SWEEPS = 12 };

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

static void unit(size_t n, double *V)
{
    memset(V, 0, n * n * sizeof *V);
    for (size_t i = 0; i < n; i++)
        V[i * n + i] = 1;
}

/* Y (n, m) with Y^T M Y = I: the eigenvectors V (n, n) of the scaled M that are not rounding */
static size_t basis(size_t n, double *M, double *scale, double *V, double *Y)
{
    double most = 0;
    size_t m = 0;
    for (size_t i = 0; i < n; i++)
        scale[i] = M[i * n + i] > 0 ? 1 / sqrt(M[i * n + i]) : 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            M[i * n + j] = M[j * n + i] = (M[i * n + j] + M[j * n + i]) / 2 * scale[i] * scale[j];
    for (size_t i = 0; i < n; i++)
        M[i * n + i] = scale[i] > 0;
    unit(n, V);
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

/* B (m, m) = Y^T A Y, Y (n, n) of which m columns are used; product (n, m) <- A Y */
static void project(size_t n, size_t m, const double *A, const double *Y, double *product,
                    double *B)
{
    memset(product, 0, n * m * sizeof *product);
    memset(B, 0, m * m * sizeof *B);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double a = (A[i * n + j] + A[j * n + i]) / 2;
            for (size_t b = 0; b < m; b++)
                product[i * m + b] += a * Y[j * n + b];
        }
    for (size_t i = 0; i < n; i++)
        for (size_t a = 0; a < m; a++)
            for (size_t b = 0; b < m; b++)
                B[a * m + b] += Y[i * n + a] * product[i * m + b];
}

/* which is the least of the diagonal */
static size_t least_of(size_t m, const double *B)
{
    size_t least = 0;
    for (size_t k = 1; k < m; k++)
        if (B[k * m + k] < B[least * m + least])
            least = k;
    return least;
}

size_t rd_ritz(size_t n, double *A, double *M, double *theta, double *C, double *work)
{
    double *const Y = work, *const B = work + n * n, *const V = M;
    const size_t m = basis(n, M, theta, B, Y);
    project(n, m, A, Y, C, B);
    unit(m, V);
    rd_ritz_rotate(m, B, V);
    for (size_t j = 0; j < m; j++) {
        const size_t least = least_of(m, B);
        theta[j] = B[least * m + least];
        B[least * m + least] = INFINITY;
        for (size_t i = 0; i < n; i++) {
            C[i * n + j] = 0;
            for (size_t k = 0; k < m; k++)
                C[i * n + j] += Y[i * n + k] * V[k * m + least];
        }
    }
    return m;
}

void rd_ritz_combine(size_t from, size_t to, const double *C, size_t row, size_t count,
                     size_t apart, lanes *x)
{
    double old[RD_RITZ_MOST];
    for (size_t m = 0; m < count; m++) {
        for (size_t i = 0; i < from; i++)
            old[i] = x[m + i / RD_LANES * apart][i % RD_LANES];
        for (size_t j = 0; j < to; j++) {
            double sum = 0;
            for (size_t i = 0; i < from; i++)
                sum += old[i] * C[i * row + j];
            x[m + j / RD_LANES * apart][j % RD_LANES] = sum;
        }
    }
}
