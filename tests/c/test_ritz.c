/* Rayleigh-Ritz in the space of a few vectors. */
#include "modes/certify/ritz.h"

#include "check.h"

#include <string.h>

enum { N = RD_LANES };

/* A (n, n) = X^T diag(d) X with X (m, n) */
static void gram(size_t m, size_t n, const double *X, const double *d, double *A)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            A[i * n + j] = 0;
            for (size_t k = 0; k < m; k++)
                A[i * n + j] += X[k * n + i] * d[k] * X[k * n + j];
        }
}

static double form(size_t n, const double *A, const double *x, size_t a, const double *y, size_t b,
                   size_t m)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            sum += x[i * m + a] * A[i * n + j] * y[j * m + b];
    return sum;
}

static void rotation_of_two_has_its_closed_form(void)
{
    /* [[3, 4], [4, -3]] has the eigenvalues -5 and 5 */
    double A[] = {3, 4, 4, -3}, V[] = {1, 0, 0, 1};
    rd_ritz_rotate(2, A, V);
    CHECK_REL(fmax(A[0], A[3]), 5, 8 * EPS, "one rotation");
    CHECK_REL(fmin(A[0], A[3]), -5, 8 * EPS, "one rotation");
    const size_t k = A[0] > 0 ? 0 : 1;
    CHECK_REL(fabs(V[k]), 2 / sqrt(5), 8 * EPS, "one rotation");
    CHECK_REL(fabs(V[2 + k]), 1 / sqrt(5), 8 * EPS, "one rotation");
}

static void rotations_make_any_symmetric_matrix_diagonal(size_t n)
{
    static const char reason[] = "n roundings in each of a few sweeps";
    double A[N * N], before[N * N], V[N * N] = {0};
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++)
            A[i * n + j] = A[j * n + i] = check_random();
    for (size_t i = 0; i < n; i++)
        V[i * (n + 1)] = 1;
    memcpy(before, A, n * n * sizeof *A);
    rd_ritz_rotate(n, A, V);
    const double one[N] = {1, 1, 1, 1, 1, 1, 1, 1};
    double unit[N * N];
    gram(n, n, V, one, unit);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            CHECK_ABS(unit[i * n + j], i == j, 64 * EPS, reason);
            CHECK_ABS(form(n, before, V, i, V, j, n), i == j ? A[i * n + i] : 0, 128 * EPS, reason);
            CHECK(i == j || fabs(A[i * n + j]) <= EPS);
        }
}

/* vectors that are combinations of eigenvectors of 1 .. n: all of these come back */
static void all_values_of_a_whole_space_come_back(size_t n)
{
    static const char reason[] = "EPS times n and the condition of the vectors, below 1e3";
    double X[N * N], one[N], value[N], A[N * N], M[N * N], A0[N * N], M0[N * N], theta[N], C[N * N];
    double work[2 * N * N];
    for (size_t i = 0; i < n; i++) {
        one[i] = 1;
        value[i] = (double)(i + 1);
        for (size_t j = 0; j < n; j++)
            X[i * n + j] = (i == j ? 2 : 0) + check_random() / 2;
    }
    gram(n, n, X, value, A);
    gram(n, n, X, one, M);
    memcpy(A0, A, n * n * sizeof *A);
    memcpy(M0, M, n * n * sizeof *M);
    CHECK_INT(rd_ritz(n, A, M, theta, C, work), n);
    for (size_t i = 0; i < n; i++) {
        CHECK_REL(theta[i], value[i], 1e4 * EPS, reason);
        for (size_t j = 0; j < n; j++) {
            CHECK_ABS(form(n, M0, C, i, C, j, n), i == j, 1e4 * EPS, reason);
            CHECK_ABS(form(n, A0, C, i, C, j, n), i == j ? value[i] : 0, 1e4 * EPS, reason);
        }
    }
}

/* Lengths of the vectors, here 1e-80 to 1e80, are no part of the space. */
static void lengths_of_the_vectors_do_not_matter(void)
{
    const double length[] = {1e-80, 1, 1e80};
    double A[9] = {2, 1, 0, 1, 2, 1, 0, 1, 2}, M[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, theta[3], C[9];
    double work[18];
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++) {
            A[i * 3 + j] *= length[i] * length[j];
            M[i * 3 + j] *= length[i] * length[j];
        }
    CHECK_INT(rd_ritz(3, A, M, theta, C, work), 3);
    for (int k = -1; k <= 1; k++)
        CHECK_ABS(theta[k + 1], 2 + k * sqrt(2), 32 * EPS, "sums of nine products of size 2");
}

/* the third vector is the sum of the first two, the fourth zero: two values, those of the first two */
static void dependent_vectors_are_left_out(void)
{
    static const char reason[] = "rounding of the sum over a basis of condition 2";
    const double X[] = {1, 0, 1, 0, 0, 1, 1, 0}, value[] = {3, 7}, one[] = {1, 1};
    double A[16], M[16], theta[4], C[16], work[32];
    gram(2, 4, X, value, A);
    gram(2, 4, X, one, M);
    CHECK_INT(rd_ritz(4, A, M, theta, C, work), 2);
    CHECK_REL(theta[0], 3, 64 * EPS, reason);
    CHECK_REL(theta[1], 7, 64 * EPS, reason);
    for (size_t j = 0; j < 2; j++)
        CHECK_EXACT(C[3 * 4 + j], 0);
}

static void vectors_without_mass_have_no_values(void)
{
    double A[4] = {1, 0, 0, 1}, M[4] = {0}, theta[2], C[4], work[8];
    CHECK_INT(rd_ritz(2, A, M, theta, C, work), 0);
}

/* of three vectors in two blocks, one lane after another: j < 2 is vector j + 1 less vector N */
static void vectors_of_all_blocks_are_combined_and_the_others_stay(void)
{
    enum { COUNT = 3, FROM = N + 1, ROW = 4 };
    double C[FROM * ROW] = {0};
    lanes x[2 * COUNT];
    C[1 * ROW + 0] = C[2 * ROW + 1] = 1;
    C[N * ROW + 0] = C[N * ROW + 1] = -1;
    for (int m = 0; m < 2 * COUNT; m++)
        for (int k = 0; k < N; k++)
            x[m][k] = 10 * m + k * k;
    rd_ritz_combine(FROM, 2, C, ROW, COUNT, COUNT, x);
    for (int m = 0; m < COUNT; m++)
        for (int k = 0; k < N; k++) {
            CHECK_EXACT(x[m][k], k < 2 ? (k + 1) * (k + 1) - 10 * COUNT : 10 * m + k * k);
            CHECK_EXACT(x[COUNT + m][k], 10 * (COUNT + m) + k * k);
        }
}

int main(void)
{
    rotation_of_two_has_its_closed_form();
    for (size_t n = 1; n <= N; n++) {
        rotations_make_any_symmetric_matrix_diagonal(n);
        all_values_of_a_whole_space_come_back(n);
    }
    lengths_of_the_vectors_do_not_matter();
    dependent_vectors_are_left_out();
    vectors_without_mass_have_no_values();
    vectors_of_all_blocks_are_combined_and_the_others_stay();
    return check_report("test_ritz");
}
