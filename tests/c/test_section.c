/* The section flexibility against closed forms. */
#include "element/section.h"

#include "chain/chain.h"
#include "check.h"

/* the study's wire rope */
static const double C = 0.1485, B = 54.626;

static double entry(const double *S, int i, int j)
{
    return S[3 * i + j];
}

/* twist and bending: S = [1/C + H^2/B, H (1/C - 1/B); ., H^2/C + 1/B] / (1 + H^2) */
static void lay_slope_tilts_twist_and_bending(double H)
{
    static const char reason[] = "five roundings of positive terms on either side";
    const struct rd_section section = {.torsion = C, .bending = B, .slope = H};
    const double norm = 1 + H * H;
    double S[9];
    CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
    CHECK_REL(entry(S, 1, 1), (1 / C + H * H / B) / norm, 8 * EPS, reason);
    CHECK_REL(entry(S, 1, 2), H * (1 / C - 1 / B) / norm, 8 * EPS, reason);
    CHECK_REL(entry(S, 2, 2), (H * H / C + 1 / B) / norm, 8 * EPS, reason);
    CHECK_EXACT(entry(S, 2, 1), entry(S, 1, 2));
    for (int k = 0; k < 3; k++) {
        CHECK_EXACT(entry(S, 0, k), 0);
        CHECK_EXACT(entry(S, k, 0), 0);
    }
}

/* 1/C + 1/B and C B do not change under a rotation: trace and determinant of S */
static void tilting_keeps_trace_and_determinant(double H)
{
    const struct rd_section section = {.torsion = C, .bending = B, .slope = H};
    double S[9];
    CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
    CHECK_REL(entry(S, 1, 1) + entry(S, 2, 2), 1 / C + 1 / B, 8 * EPS, "positive sums");
    const double product = entry(S, 1, 1) * entry(S, 2, 2);
    const double determinant = product - entry(S, 1, 2) * entry(S, 1, 2);
    CHECK_ABS(determinant, 1 / (C * B), 16 * EPS * product, "difference of two such products");
}

static void equal_stiffnesses_have_no_tilt(void)
{
    const struct rd_section section = {.torsion = 4, .bending = 4, .slope = 1};
    double S[9];
    CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
    CHECK_EXACT(entry(S, 1, 2), 0);
    CHECK_REL(entry(S, 1, 1), 0.25, 4 * EPS, "1/sqrt(2) squared twice");
}

static void lay_direction_changes_only_the_sign_of_the_coupling(void)
{
    const struct rd_section left = {.axial = 9, .torsion = 2, .bending = 5, .slope = 0.3};
    struct rd_section right = left;
    right.slope = -0.3;
    double S[9], R[9];
    CHECK_INT(rd_section_flexibility(&left, S), RD_OK);
    CHECK_INT(rd_section_flexibility(&right, R), RD_OK);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            CHECK_EXACT(entry(R, i, j),
                        (i == RD_BENDING) == (j == RD_BENDING) ? entry(S, i, j) : -entry(S, i, j));
}

/* [EA D; D C]^-1 with EA = 4, C = 2, D = 2: every step is exact */
static void extension_and_twist_couple(void)
{
    static const double expected[9] = {0.5, -0.5, 0, -0.5, 1, 0, 0, 0, 0.125};
    const struct rd_section section = {.axial = 4, .torsion = 2, .bending = 8, .coupling = 2};
    double S[9];
    CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
    for (int k = 0; k < 9; k++)
        CHECK_EXACT(S[k], expected[k]);
}

/* S times the stiffness R^T [EA D 0; D C 0; 0 0 B] R is the identity, with every coupling at once */
static void full_section_inverts_its_stiffness(double H)
{
    const double EA = 8.5e5, D = 120;
    const struct rd_section section = {EA, C, B, D, H};
    const double c = 1 / sqrt(1 + H * H), s = H * c;
    const double K[9] = {
        EA,
        D * c,
        D * s,
        D * c,
        c * c * C + s * s * B,
        c * s * (C - B),
        D * s,
        c * s * (C - B),
        s * s * C + c * c * B,
    };
    double S[9];
    CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0, size = 0;
            for (int k = 0; k < 3; k++) {
                sum += entry(S, i, k) * entry(K, k, j);
                size += fabs(entry(S, i, k) * entry(K, k, j));
            }
            CHECK_ABS(sum, i == j, 16 * EPS * size, "cancellation of the terms of the product");
        }
}

/* every subset of channels: zero rows and columns where absent, reciprocals where present */
static void absent_channels_are_zero(void)
{
    for (int mask = 0; mask < 8; mask++) {
        const double stiffness[3] = {mask & 1 ? 4 : 0, mask & 2 ? 2 : 0, mask & 4 ? 8 : 0};
        const struct rd_section section = {stiffness[0], stiffness[1], stiffness[2], 0, 0};
        double S[9];
        CHECK_INT(rd_section_flexibility(&section, S), RD_OK);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                CHECK_EXACT(entry(S, i, j), i == j && stiffness[i] > 0 ? 1 / stiffness[i] : 0);
    }
}

/* the slope tilts what is there; it does not make a channel */
static void slope_does_not_create_an_absent_channel(void)
{
    const struct rd_section bent = {.bending = 2, .slope = 0.3};
    const struct rd_section twisted = {.torsion = 2, .slope = 0.3};
    double S[9];
    if (rd_section_flexibility(&bent, S) == RD_OK)
        for (int k = 0; k < 3; k++)
            CHECK_EXACT(entry(S, RD_TORSION, k), 0);
    if (rd_section_flexibility(&twisted, S) == RD_OK)
        for (int k = 0; k < 3; k++)
            CHECK_EXACT(entry(S, RD_BENDING, k), 0);
}

static void section_that_creates_energy_is_refused(void)
{
    static const struct rd_section refused[] = {
        {.axial = 4, .torsion = 1, .coupling = 2},  /* EA C = D^2 */
        {.axial = 4, .torsion = 1, .coupling = -2}, /* the same, other hand */
        {.axial = 4, .torsion = 1, .coupling = 3},  /* EA C < D^2 */
        {.axial = 4, .coupling = 1},                /* nothing to couple with */
        {.torsion = 4, .coupling = 1},
        {.axial = -1},
        {.torsion = -1},
        {.bending = -1},
    };
    double S[9];
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        CHECK_INT(rd_section_flexibility(refused + k, S), RD_NOT_POSITIVE_DEFINITE);
}

/* EA C above D^2 by rounding only: refused, or finite and positive; never infinite */
static void nearly_singular_section_is_refused_or_finite(void)
{
    static const struct rd_section close[] = {
        {.axial = 0x1.8e5c32bb7479p+0,
         .torsion = 0x1.6b5453e9649f4p-1,
         .coupling = 0x1.0d0352014d9p+0},
        {.axial = 0x1.409aa63c700dp+0,
         .torsion = 0x1.588099772c0ebp+0,
         .coupling = 0x1.4c56a6636394p+0},
        {.axial = 0x1.e4d7046100abp+0,
         .torsion = 0x1.ae6f23e2ee8abp+0,
         .coupling = 0x1.c8d3eb8aeadap+0},
    };
    for (size_t k = 0; k < sizeof close / sizeof *close; k++) {
        double S[9];
        if (rd_section_flexibility(close + k, S) != RD_OK)
            continue;
        CHECK(isfinite(S[0]) && S[0] > 0);
        CHECK(isfinite(S[4]) && S[4] > 0);
    }
}

int main(void)
{
    static const double slope[] = {0, 0.01, 0.3, 1, -0.3};
    for (size_t k = 0; k < sizeof slope / sizeof *slope; k++) {
        lay_slope_tilts_twist_and_bending(slope[k]);
        tilting_keeps_trace_and_determinant(slope[k]);
        full_section_inverts_its_stiffness(slope[k]);
    }
    equal_stiffnesses_have_no_tilt();
    lay_direction_changes_only_the_sign_of_the_coupling();
    extension_and_twist_couple();
    absent_channels_are_zero();
    slope_does_not_create_an_absent_channel();
    section_that_creates_energy_is_refused();
    nearly_singular_section_is_refused_or_finite();
    return check_report("test_section");
}
