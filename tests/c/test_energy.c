/* Energies of shapes against closed forms; strain and kinetic energy of a mode agree. */
#include "mode.h"

#include "assembled/assemble.h"
#include "chains.h"
#include "check.h"

#include <string.h>

static const double PI = 3.14159265358979323846;
static const double B = 54.626, C = 0.1485;

/* the energies of massless elements know nothing of the eigenvalue */
static enum rd_status strain_of(const struct rope *rope, const double *shape, double *strain)
{
    double kinetic[RD_WIDTH_MAX], dragged;
    return mode_energy(&rope->chain, 0, shape, strain, kinetic, &dragged);
}

static void kinetic_of(const struct rope *rope, const double *shape, double *kinetic)
{
    double strain[RD_STRAINS], dragged;
    CHECK_INT(mode_energy(&rope->chain, 0, shape, strain, kinetic, &dragged), RD_OK);
}

static double sum_of(const double *part, size_t count)
{
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += part[k];
    return sum;
}

/* x^T A x and, in size, |x|^T |A| |x| */
static double quadratic(const double *A, size_t n, const double *x, double *size)
{
    double sum = 0;
    *size = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            sum += x[i] * A[i * n + j] * x[j];
            *size += fabs(x[i] * A[i * n + j] * x[j]);
        }
    return sum;
}

/* mode k of a fixed-fixed chain of one coordinate, x_j = sin(j k pi/n): its energy is
   lambda x^T M x, all of it where this coordinate keeps it */
static void mode_of_one_coordinate_stores_all_in_one_place(const char *coordinate,
                                                           enum rd_strain place, double stiffness)
{
    enum { ELEMENTS = 8 };
    const double l = 0.25, m = 0.5;
    const struct recipe recipe = {
        .elements = ELEMENTS,
        .coordinates = coordinate,
        .length = l,
        .tension = stiffness,
        .section = {.axial = stiffness, .torsion = stiffness},
        .inertia = {m, m, m, m},
        .left = coordinate,
        .right = coordinate,
    };
    struct rope rope = rope_make(&recipe);
    for (int k = 1; k < ELEMENTS; k++) {
        double shape[ELEMENTS + 1], strain[RD_STRAINS], kinetic;
        for (int j = 0; j <= ELEMENTS; j++)
            shape[j] = j % ELEMENTS == 0 ? 0 : sin(j * k * PI / ELEMENTS);
        const double s = 2 * sin(k * PI / (2 * ELEMENTS));
        const double lambda = stiffness / (l * m) * s * s;
        CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
        kinetic_of(&rope, shape, &kinetic);
        CHECK_REL(kinetic, m * ELEMENTS / 2, 32 * EPS, "sum of sin^2 over nine nodes");
        CHECK_REL(strain[place], lambda * kinetic, 64 * EPS / (s * s) + 32 * EPS,
                  "differences of neighbouring sines cancel by s");
        for (int part = 0; part < RD_STRAINS; part++)
            if (part != (int)place)
                CHECK_EXACT(strain[part], 0);
    }
    rope_free(&rope);
}

/* a laid rope with springs of every kind and arbitrary motion: the shares add up to x^T K x */
static void shares_add_up_to_the_whole(const char *coordinates, enum rd_kind kind, double tension,
                                       double H, double D)
{
    static const double K_of[RD_PARTS] = {1, 1, 1}, M_of[RD_PARTS] = {0, 0, 0, 1};
    const struct recipe recipe = {
        .kind = kind,
        .elements = 6,
        .coordinates = coordinates,
        .length = 0.16875,
        .tension = tension,
        .section = {8.5e5, C, B, D, H},
        .inertia = {2, 2, 0.5, 0.25},
        .left = "",
        .right = "",
        .distinct = 2,
        .more = 1,
    };
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width, n = rope.chain.nodes * w;
    rope.length[1] = 0.2;
    rope.element_of[2] = rope.element_of[5] = 1;
    rope.term_of[3] = MORE;
    for (size_t k = 0; k < w * w; k++) {
        rope.stiffness[MORE * w * w + k] = 100 + (double)(k / w + k % w);
        rope.mass[MORE * w * w + k] = k % (w + 1) == 0 ? 2 : 0.5;
    }
    double *K = rope_dense(&rope.chain, K_of), *M = rope_dense(&rope.chain, M_of);
    double *shape = zeros(n);
    for (int round = 0; round < 20; round++) {
        double strain[RD_STRAINS], kinetic[RD_WIDTH_MAX], size;
        for (size_t i = 0; i < n; i++)
            shape[i] = check_random();
        CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
        kinetic_of(&rope, shape, kinetic);
        double expected = quadratic(K, n, shape, &size);
        CHECK_ABS(sum_of(strain, RD_STRAINS), expected, 4000 * EPS * size,
                  "condition 624 of unit-diagonal G at H = 1, times a few roundings");
        expected = quadratic(M, n, shape, &size);
        CHECK_ABS(sum_of(kinetic, w), expected, 64 * EPS * size, "the same terms in another order");
        for (int part = 0; part < RD_STRAINS; part++)
            CHECK(part == RD_STRAIN_LAY || part == RD_STRAIN_TENSION || strain[part] >= 0);
        CHECK(H != 0 || D != 0 || strain[RD_STRAIN_LAY] == 0);
        CHECK((tension == 0) == (strain[RD_STRAIN_TENSION] == 0));
    }
    free(shape);
    free(K);
    free(M);
    rope_free(&rope);
}

/* z = c x^2/2, beta = c x: bending B c^2 L, tension T sum of rise^2/l, nothing else */
static void pure_bending_stores_B_times_curvature_squared(void)
{
    const double c = 0.5, l = 0.25, T = 8;
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 4,
        .coordinates = "zab",
        .length = l,
        .tension = T,
        .section = {.torsion = C, .bending = 4},
        .left = "zab",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    double shape[15] = {0}, strain[RD_STRAINS], tension = 0;
    for (int i = 0; i < 5; i++) {
        shape[3 * i] = c * (i * l) * (i * l) / 2;
        shape[3 * i + 2] = c * i * l;
        const double rise = i == 0 ? 0 : shape[3 * i] - shape[3 * (i - 1)];
        tension += T / l * rise * rise;
    }
    CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
    CHECK_REL(strain[RD_STRAIN_BENDING], 4 * c * c * (4 * l), 200 * EPS,
              "condition 14 of unit-diagonal G");
    CHECK_REL(strain[RD_STRAIN_TENSION], tension, 8 * EPS, "a sum of four");
    CHECK_EXACT(strain[RD_STRAIN_TWIST], 0);
    CHECK_EXACT(strain[RD_STRAIN_STRETCH], 0);
    CHECK_EXACT(strain[RD_STRAIN_LAY], 0);
    CHECK_EXACT(strain[RD_STRAIN_SPRING], 0);
    rope_free(&rope);
}

/* uniform strain e and twist rate t: axial force a = EA e + D t, torque q = D e + C t; with
   S = [0.5 -0.5; -0.5 1] shares S_aa a^2 L, S_tt q^2 L, 2 S_at a q L; numbers chosen exact */
static void extension_and_twist_share_with_the_lay(void)
{
    const double e = 0.25, t = 1, L = 2;
    const struct recipe recipe = {
        .elements = 4,
        .coordinates = "xa",
        .length = L / 4,
        .section = {.axial = 4, .torsion = 2, .coupling = 2},
        .left = "xa",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    double shape[10], strain[RD_STRAINS];
    for (int i = 0; i < 5; i++) {
        shape[2 * i] = e * i * L / 4;
        shape[2 * i + 1] = t * i * L / 4;
    }
    const double a = 4 * e + 2 * t, q = 2 * e + 2 * t;
    CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
    CHECK_REL(strain[RD_STRAIN_STRETCH], 0.5 * a * a * L, 64 * EPS, "a two by two inverse");
    CHECK_REL(strain[RD_STRAIN_TWIST], q * q * L, 64 * EPS, "a two by two inverse");
    CHECK_REL(strain[RD_STRAIN_LAY], -a * q * L, 64 * EPS, "a two by two inverse");
    CHECK_REL(sum_of(strain, RD_STRAINS), (4 * e * e + 4 * e * t + 2 * t * t) * L, 256 * EPS,
              "cancellation against the lay's negative share");
    rope_free(&rope);
}

/* turned as a whole, powers of two throughout: only tension and springs notice */
static void rigid_turn_stores_tension_and_springs_only(void)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 4,
        .coordinates = "zb",
        .length = 0.5,
        .tension = 8,
        .section = {.bending = B},
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    rope.stiffness[4 * RIGHT_END] = 16;
    double shape[10], strain[RD_STRAINS];
    for (int i = 0; i < 5; i++) {
        shape[2 * i] = i * 0.5 * 0.25;
        shape[2 * i + 1] = 0.25;
    }
    CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
    CHECK_EXACT(strain[RD_STRAIN_BENDING], 0);
    CHECK_REL(strain[RD_STRAIN_TENSION], 8 * 0.25 * 0.25 * 2, 8 * EPS, "a complex step's rounding");
    CHECK_EXACT(strain[RD_STRAIN_SPRING], 16 * 0.5 * 0.5);
    CHECK_REL(sum_of(strain, RD_STRAINS), 1 + 4, 8 * EPS, "a complex step's rounding");
    rope_free(&rope);
}

/* the mode's Rayleigh quotient: exact pinned mode of the rigid chain, z_j = sin(j phi) and
   beta_j = b cos(j phi) with massless rotations in balance,
   b = a12 sin(phi) 2/(2 a22 + 2 a23 cos(phi))/a, a12 = 6, a22 = 4, a23 = 2 */
static void strain_of_a_bending_mode_is_lambda_times_its_mass(double tension)
{
    enum { ELEMENTS = 8 };
    const double L = 1.35, mu = 0.13725 / 1.35, a = L / ELEMENTS;
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = ELEMENTS,
        .coordinates = "zb",
        .length = a,
        .tension = tension,
        .section = {.bending = B},
        .inertia = {[RD_Z] = mu * a},
        .left = "z",
        .right = "z",
    };
    struct rope rope = rope_make(&recipe);
    for (int k = 1; k < ELEMENTS; k++) {
        const double phi = k * PI / ELEMENTS, c = cos(phi);
        const double a11 = 12 + tension * a * a / B;
        const double lambda =
            (2 * a11 * (1 - c) - 144 * (1 - c * c) / (8 + 4 * c)) * B / (mu * a * a * a * a);
        double shape[2 * ELEMENTS + 2], strain[RD_STRAINS], kinetic[2];
        for (int j = 0; j <= ELEMENTS; j++) {
            shape[2 * j] = j % ELEMENTS == 0 ? 0 : sin(j * phi);
            shape[2 * j + 1] = 12 * sin(phi) / (8 + 4 * c) / a * cos(j * phi);
        }
        CHECK_INT(strain_of(&rope, shape, strain), RD_OK);
        kinetic_of(&rope, shape, kinetic);
        CHECK_EXACT(kinetic[1], 0);
        CHECK_REL(kinetic[0], mu * a * ELEMENTS / 2, 32 * EPS, "sum of sin^2 over nine nodes");
        CHECK_ABS(sum_of(strain, RD_STRAINS), lambda * kinetic[0],
                  200 * EPS * 24 * B / (mu * a * a * a * a) * kinetic[0],
                  "cancellation of 24 in the closed form, condition 14 of unit-diagonal G");
        CHECK_ABS(strain[RD_STRAIN_TENSION], tension * 2 * (1 - c) / (mu * a * a) * kinetic[0],
                  200 * EPS * fabs(tension) / (mu * a * a) * kinetic[0],
                  "differences of neighbouring sines");
    }
    rope_free(&rope);
}

/* M = [2 1; 1 4]: each coordinate gets its own, and the first what they share */
static void kinetic_energy_is_shared_by_coordinates(void)
{
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "za",
        .length = 1,
        .tension = 1,
        .section = {.torsion = 1},
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    static const double mass[4] = {2, 1, 1, 4}, shape[4] = {7, 7, 1, -3};
    memcpy(rope.mass + 4 * RIGHT_END, mass, sizeof mass);
    double kinetic[2];
    kinetic_of(&rope, shape, kinetic);
    CHECK_EXACT(kinetic[0], 2 - 6);
    CHECK_EXACT(kinetic[1], 36);
    rope_free(&rope);
}

static void section_that_creates_energy_is_refused(void)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 2,
        .coordinates = "zb",
        .length = 1,
        .section = {.bending = 1},
        .left = "",
        .right = "",
        .distinct = 2,
    };
    struct rope rope = rope_make(&recipe);
    static const double shape[6] = {1, 0, 0, 0, 0, 0};
    double strain[RD_STRAINS];
    rope.element_of[1] = 1;
    rope.flexibility[9 + 8] = -1;
    CHECK_INT(strain_of(&rope, shape, strain), RD_NOT_POSITIVE_DEFINITE);
    rope_free(&rope);
}

int main(void)
{
    mode_of_one_coordinate_stores_all_in_one_place("z", RD_STRAIN_TENSION, 300);
    mode_of_one_coordinate_stores_all_in_one_place("a", RD_STRAIN_TWIST, 0.1485);
    mode_of_one_coordinate_stores_all_in_one_place("x", RD_STRAIN_STRETCH, 8.5e5);
    shares_add_up_to_the_whole("z", RD_RIGID, 300, 0, 0);
    shares_add_up_to_the_whole("zb", RD_RIGID, -100, 0, 0);
    shares_add_up_to_the_whole("xa", RD_RIGID, 0, 0, 120);
    shares_add_up_to_the_whole("zab", RD_DIFFERENCE, 0, 0.01, 0);
    shares_add_up_to_the_whole("zab", RD_RIGID, 300, 0.3, 0);
    shares_add_up_to_the_whole("xzab", RD_DIFFERENCE, 0, -0.3, 120);
    shares_add_up_to_the_whole("xzab", RD_RIGID, 300, 1, -120);
    pure_bending_stores_B_times_curvature_squared();
    extension_and_twist_share_with_the_lay();
    rigid_turn_stores_tension_and_springs_only();
    strain_of_a_bending_mode_is_lambda_times_its_mass(0);
    strain_of_a_bending_mode_is_lambda_times_its_mass(300);
    strain_of_a_bending_mode_is_lambda_times_its_mass(-400);
    kinetic_energy_is_shared_by_coordinates();
    section_that_creates_energy_is_refused();
    return check_report("test_energy");
}
