/* Small dense matrices, row by row. */
#include "base/dense.h"

#include <string.h>

#include "base/lanes.h"

static bool is_absent(size_t n, const double *A, size_t k)
{
    for (size_t j = 0; j < n; j++)
        if (A[k * n + j] != 0)
            return false;
    return true;
}

/* Gauss-Jordan in place; without pivoting, which is stable for positive definite matrices. */
bool rd_dense_invert(size_t n, double *A)
{
    for (size_t k = 0; k < n; k++) {
        const double pivot = A[k * n + k];
        if (is_absent(n, A, k))
            continue;
        if (!(pivot > 0))
            return false;
        A[k * n + k] = 1;
        for (size_t j = 0; j < n; j++)
            A[k * n + j] /= pivot;
        for (size_t i = 0; i < n; i++) {
            if (i == k)
                continue;
            const double factor = A[i * n + k];
            A[i * n + k] = 0;
            for (size_t j = 0; j < n; j++)
                A[i * n + j] -= factor * A[k * n + j];
        }
    }
    /* rounding leaves the two triangles apart by a few last digits */
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            A[i * n + j] = A[j * n + i] = (A[i * n + j] + A[j * n + i]) / 2;
    return true;
}

void rd_dense_multiply(size_t n, size_t k, size_t m, const double *A, const double *B, double *C)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++) {
            double sum = 0;
            for (size_t p = 0; p < k; p++)
                sum += A[i * k + p] * B[p * m + j];
            C[i * m + j] = sum;
        }
}

void rd_dense_transpose(size_t n, size_t m, const double *A, double *B)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < m; j++)
            B[j * n + i] = A[i * m + j];
}

static RD_CLONES double inner(size_t n, const double *a, const double *b)
{
    lanes sum = {0};
    size_t k = 0;
    for (; k + RD_LANES <= n; k += RD_LANES) {
        lanes x, y;
        memcpy(&x, a + k, sizeof x);
        memcpy(&y, b + k, sizeof y);
        sum += x * y;
    }
    double all = 0;
    for (int i = 0; i < RD_LANES; i++)
        all += sum[i];
    for (; k < n; k++)
        all += a[k] * b[k];
    return all;
}

/* a function of several copies that others call would be a symbol of the library */
double rd_dense_inner(size_t n, const double *a, const double *b)
{
    return inner(n, a, b);
}
