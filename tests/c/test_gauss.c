/* Gauss in wide numbers: exact systems, exchanges of rows, several loads. */
#include "mixed/gauss.h"

#include <math.h>

#include "check.h"

enum { N = 6, LOADS = 2, COLUMNS = N + LOADS };

/* rounding of one operation; valgrind works with 53 digits of 2, whatever the numbers have */
static long double rounding(void)
{
    volatile long double eps = 1, more;
    do {
        eps /= 2;
        more = 1 + eps;
    } while (more != 1);
    return 2 * eps;
}

/* Hilbert's matrix, whose condition is 1.5e7, beside what it makes of 1, 2, 3 .. and of -1, 1, -1 .. */
static void fill(long double *A)
{
    for (int i = 0; i < N; i++) {
        A[i * COLUMNS + N] = A[i * COLUMNS + N + 1] = 0;
        for (int j = 0; j < N; j++) {
            const long double a = 1.0L / (long double)(i + j + 1);
            A[i * COLUMNS + j] = a;
            A[i * COLUMNS + N] += a * (long double)(j + 1);
            A[i * COLUMNS + N + 1] += j % 2 ? a : -a;
        }
    }
}

static void hilberts_system_is_solved_to_its_condition(void)
{
    long double A[N * COLUMNS], x[N * LOADS];
    fill(A);
    rd_gauss_eliminate(A, N, COLUMNS, N);
    for (int i = 0; i < N; i++)
        for (int k = 0; k < LOADS; k++)
            x[i * LOADS + k] = A[i * COLUMNS + N + k];
    rd_gauss_substitute(A, COLUMNS, N, LOADS, x);
    for (int j = 0; j < N; j++) {
        CHECK(fabsl(x[j * LOADS] - (long double)(j + 1)) < 3e8L * rounding());
        CHECK(fabsl(x[j * LOADS + 1] - (j % 2 ? 1.0L : -1.0L)) < 3e8L * rounding());
    }
}

static void turned_by_a_phase_it_has_the_same_solution(void)
{
    long double A[N * COLUMNS];
    long double _Complex B[N * COLUMNS], x[N * LOADS];
    fill(A);
    for (int i = 0; i < N * COLUMNS; i++)
        B[i] = A[i] * (0.6L + 0.8L * I);
    rd_gauss_eliminate_complex(B, N, COLUMNS, N);
    for (int i = 0; i < N; i++)
        for (int k = 0; k < LOADS; k++)
            x[i * LOADS + k] = B[i * COLUMNS + N + k];
    rd_gauss_substitute_complex(B, COLUMNS, N, LOADS, x);
    for (int j = 0; j < N; j++)
        CHECK(cabsl(x[j * LOADS] - (long double)(j + 1)) < 3e8L * rounding());
}

/* [[0, 1], [2, 0], [4, 2]]: no first pivot without an exchange, and a row that goes on */
static void rows_are_exchanged_and_those_left_are_carried_on(void)
{
    long double A[3 * 3] = {0, 1, 5, 2, 0, 6, 4, 2, 7};
    rd_gauss_eliminate(A, 3, 3, 2);
    CHECK(A[0] == 4 && A[1] == 2 && A[2] == 7);
    /* rows without the first unknown: (-1, 2.5) and (1, 5), so that their sum is left */
    CHECK(A[8] == 7.5L || A[8] == -7.5L);
}

int main(void)
{
    hilberts_system_is_solved_to_its_condition();
    turned_by_a_phase_it_has_the_same_solution();
    rows_are_exchanged_and_those_left_are_carried_on();
    return check_report("test_gauss");
}
