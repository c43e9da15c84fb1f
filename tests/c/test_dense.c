/* Small dense matrices against known ones. */
#include "base/dense.h"

#include "check.h"

#include <string.h>

static void inverse_of_one_number(void)
{
    double A[] = {4};
    CHECK(rd_dense_invert(1, A));
    CHECK_EXACT(A[0], 0.25);
    CHECK(rd_dense_invert(0, A));
    CHECK_EXACT(A[0], 0.25);
}

/* [4 2; 2 2]: pivots 4 and 1, every step exact */
static void inverse_of_two_by_two_is_exact(void)
{
    static const double expected[] = {0.5, -0.5, -0.5, 1};
    double A[] = {4, 2, 2, 2};
    CHECK(rd_dense_invert(2, A));
    for (int k = 0; k < 4; k++)
        CHECK_EXACT(A[k], expected[k]);
}

/* Pascal's matrix: all pivots 1, inverse of integers */
static void inverse_of_pascal_matrix_is_exact(void)
{
    static const double expected[] = {4, -6, 4, -1, -6, 14, -11, 3, 4, -11, 10, -3, -1, 3, -3, 1};
    double A[] = {1, 1, 1, 1, 1, 2, 3, 4, 1, 3, 6, 10, 1, 4, 10, 20};
    CHECK(rd_dense_invert(4, A));
    for (int k = 0; k < 16; k++)
        CHECK_EXACT(A[k], expected[k]);
}

static void inverse_of_hilbert_matrix(void)
{
    static const double expected[] = {16,  -120,  240,  -140,  -120, 1200, -2700, 1680,
                                      240, -2700, 6480, -4200, -140, 1680, -4200, 2800};
    double A[16];
    for (int k = 0; k < 16; k++)
        A[k] = 1.0 / (k / 4 + k % 4 + 1);
    CHECK(rd_dense_invert(4, A));
    for (int k = 0; k < 16; k++)
        CHECK_REL(A[k], expected[k], 15514 * 4 * EPS, "condition number 15514");
}

/* one ulp of asymmetry in the work does not reach the caller */
static void inverse_is_symmetric_to_the_last_bit(void)
{
    double L[16] = {0}, A[16], Lt[16];
    for (int round = 0; round < 50; round++) {
        for (int i = 0; i < 4; i++)
            for (int j = 0; j <= i; j++)
                L[4 * i + j] = i == j ? 1.5 + check_random() : check_random();
        rd_dense_transpose(4, 4, L, Lt);
        rd_dense_multiply(4, 4, 4, L, Lt, A);
        CHECK(rd_dense_invert(4, A));
        for (int k = 0; k < 16; k++)
            CHECK_EXACT(A[k], A[4 * (k % 4) + k / 4]);
    }
}

/* stiffnesses of different units: 1e-300 to 1e300 on the diagonal */
static void inverse_does_not_care_about_units(void)
{
    double A[] = {0x1p-900, 0, 0, 0, 1, 0, 0, 0, 0x1p900};
    CHECK(rd_dense_invert(3, A));
    CHECK_EXACT(A[0], 0x1p900);
    CHECK_EXACT(A[4], 1);
    CHECK_EXACT(A[8], 0x1p-900);
}

static void absent_coordinates_stay_zero(void)
{
    static const double expected[] = {0.5, 0, -0.5, 0, 0, 0, -0.5, 0, 1};
    double A[] = {4, 0, 2, 0, 0, 0, 2, 0, 2};
    CHECK(rd_dense_invert(3, A));
    for (int k = 0; k < 9; k++)
        CHECK_EXACT(A[k], expected[k]);
    double none[9] = {0};
    CHECK(rd_dense_invert(3, none));
    for (int k = 0; k < 9; k++)
        CHECK_EXACT(none[k], 0);
}

static void indefinite_is_refused(void)
{
    double negative[] = {-1};
    CHECK(!rd_dense_invert(1, negative));
    double saddle[] = {1, 2, 2, 1};
    CHECK(!rd_dense_invert(2, saddle));
    double last[] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
    CHECK(!rd_dense_invert(3, last));
    double nan[] = {(double)NAN};
    CHECK(!rd_dense_invert(1, nan));
}

/* G as the 2015 study prints it, with H^2 l/C - l/B for its last entry; one eigenvalue of its
   inverse is -321.55 */
static void misprinted_flexibility_of_the_study_is_refused(void)
{
    const double l = 0.16875, H = 0.01, C = 0.1485, B = 54.626;
    const double P = H * H / C + 1 / B, Q = 1 / C + H * H / B, R = H * (1 / C - 1 / B);
    const double zb = P * l * l / 2, za = R * l * l / 2;
    double printed[] = {P * l * l * l / 3, za, zb, za, Q * l, R * l, zb, R * l, P * l - 2 * l / B};
    CHECK(!rd_dense_invert(3, printed));
    double corrected[] = {P * l * l * l / 3, za, zb, za, Q * l, R * l, zb, R * l, P * l};
    CHECK(rd_dense_invert(3, corrected));
}

/* exactly singular is not positive definite either: only a zero diagonal means absent */
static void singular_is_refused(void)
{
    double ones[] = {1, 1, 1, 1};
    CHECK(!rd_dense_invert(2, ones));
    double rank2[] = {2, 1, 1, 1, 1, 0, 1, 0, 1};
    CHECK(!rd_dense_invert(3, rank2));
}

/* a coordinate without flexibility of its own cannot be coupled with another */
static void coupled_absent_coordinate_is_refused(void)
{
    double swap[] = {0, 1, 1, 0};
    CHECK(!rd_dense_invert(2, swap));
    double half[] = {0, 1, 1, 1};
    CHECK(!rd_dense_invert(2, half));
}

/* (2, 3) times (3, 4) by hand */
static void product_of_oblong_matrices(void)
{
    static const double A[] = {1, 2, 3, 4, 5, 6};
    static const double X[] = {1, 0, 2, -1, 0, 1, 3, 1, 2, 0, 1, 2};
    static const double expected[] = {7, 2, 11, 7, 16, 5, 29, 13};
    double P[8];
    rd_dense_multiply(2, 3, 4, A, X, P);
    for (int k = 0; k < 8; k++)
        CHECK_EXACT(P[k], expected[k]);
}

static void transpose_of_oblong_matrix(void)
{
    static const double A[] = {1, 2, 3, 4, 5, 6};
    static const double expected[] = {1, 4, 2, 5, 3, 6};
    double T[6], back[6];
    rd_dense_transpose(2, 3, A, T);
    rd_dense_transpose(3, 2, T, back);
    for (int k = 0; k < 6; k++)
        CHECK_EXACT(T[k], expected[k]);
    CHECK(memcmp(A, back, sizeof A) == 0);
}

static void inner_product_of_any_length(void)
{
    double a[21], b[21], sum = 0;
    for (int k = 0; k < 21; k++) {
        CHECK_EXACT(rd_dense_inner((size_t)k, a, b), sum);
        a[k] = k + 1;
        b[k] = k % 3 - 1;
        sum += a[k] * b[k];
    }
}

int main(void)
{
    inverse_of_one_number();
    inverse_of_two_by_two_is_exact();
    inverse_of_pascal_matrix_is_exact();
    inverse_of_hilbert_matrix();
    inverse_is_symmetric_to_the_last_bit();
    inverse_does_not_care_about_units();
    absent_coordinates_stay_zero();
    indefinite_is_refused();
    misprinted_flexibility_of_the_study_is_refused();
    singular_is_refused();
    coupled_absent_coordinate_is_refused();
    product_of_oblong_matrices();
    transpose_of_oblong_matrix();
    inner_product_of_any_length();
    return check_report("test_dense");
}
