/* Frequency response against closed forms, reciprocity, and exact resonances. */
#include "assembled/frf.h"

#include "chains.h"
#include "check.h"

#include <string.h>

typedef double _Complex complex_t;

static const double PI = 3.14159265358979323846;

enum { PORTS = 6 }; /* the most drives or responses here */

/* a chain ready to be solved */
struct ready {
    struct rope rope;
    struct rd_frf frf;
    struct rd_workspace workspace;
    double motion[PORTS]; /* of the last solution */
};

static size_t measure(const struct rope *rope, const struct rd_ports *drives,
                      const struct rd_ports *responses)
{
    struct rd_frf frf;
    struct rd_workspace workspace = {0};
    CHECK_INT(rd_frf_prepare(&rope->chain, drives, responses, &frf, &workspace), RD_NO_MEMORY);
    return workspace.used;
}

static void ready_make(struct ready *ready, struct rope rope, const struct rd_ports *drives,
                       const struct rd_ports *responses)
{
    ready->rope = rope;
    ready->workspace = exact_workspace(measure(&rope, drives, responses));
    CHECK_INT(rd_frf_prepare(&ready->rope.chain, drives, responses, &ready->frf, &ready->workspace),
              RD_OK);
}

static enum rd_status solve(struct ready *ready, const complex_t *factor, complex_t *value,
                            double *rounding)
{
    return rd_frf_solve(&ready->frf, factor, &(struct rd_stop){0}, value, rounding, ready->motion);
}

static void ready_free(struct ready *ready)
{
    free(ready->workspace.base);
    rope_free(&ready->rope);
}

/* z of the right node of the only element, or of any one coordinate */
static const int32_t first[] = {0};
static const double right_end[] = {0, 1};
static const struct rd_ports at_right_end = {1, first, right_end, NULL};

/* h = 1/(g k + g_s k_s + f m) with any damping factor on each part */
static void one_mass_is_the_textbook_oscillator(void)
{
    const double l = 0.16875, C = 0.1485, J = 2e-3, spring = 1.5, omega = 31;
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "a",
        .length = l,
        .section = {.torsion = C},
        .inertia = {[RD_ALPHA] = 2 * J},
        .left = "a",
        .right = "",
    };
    struct ready ready;
    struct rope rope = rope_make(&recipe);
    rope.stiffness[RIGHT_END] = spring;
    ready_make(&ready, rope, &at_right_end, &at_right_end);
    const complex_t damping[] = {1, CMPLX(1, 1e-4 * omega), CMPLX(1, 0.5)};
    for (size_t k = 0; k < 9; k++) {
        const complex_t factor[RD_PARTS] = {
            [RD_ELASTIC] = damping[k / 3],
            [RD_STRING] = 1,
            [RD_SPRINGS] = damping[k % 3],
            [RD_MASS] = CMPLX(-omega * omega, omega * 0.7 * (double)k),
        };
        const complex_t D =
            factor[RD_ELASTIC] * C / l + factor[RD_SPRINGS] * spring + factor[RD_MASS] * J;
        const double elastic = (creal(factor[RD_ELASTIC]) + cimag(factor[RD_ELASTIC])) * C / l;
        const double sizes =
            elastic + cabs(factor[RD_SPRINGS]) * spring + cabs(factor[RD_MASS]) * J;
        complex_t value;
        double rounding;
        CHECK_INT(solve(&ready, factor, &value, &rounding), RD_OK);
        const double tolerance = 16 * EPS * sizes / cabs(D);
        CHECK_ABS(cabs(value * D - 1), 0, tolerance, "a dozen roundings, terms of D cancel");
        CHECK_REL(rounding * cabs(D), 2 * EPS * sizes / cabs(D), 64 * EPS * sizes / cabs(D),
                  "2 eps |h| |D| |h|: its formula, by hand");
        CHECK_REL(2 * ready.motion[0], rounding * cabs(D), 64 * EPS * sizes / cabs(D),
                  "one coordinate is the whole motion");
    }
    ready_free(&ready);
}

/* fixed-fixed string of n elements, 2 cos(theta) = 2 - m omega^2/k, i <= j:
   h_ij = sin(i theta) sin((n - j) theta)/(k sin(theta) sin(n theta)), any complex k */
static complex_t string_receptance(size_t n, size_t i, size_t j, double mass, double omega,
                                   complex_t k)
{
    if (i > j)
        return string_receptance(n, j, i, mass, omega, k);
    const complex_t theta = cacos(1 - mass * omega * omega / (2 * k));
    return csin((double)i * theta) * csin((double)(n - j) * theta) /
           (k * csin(theta) * csin((double)n * theta));
}

static void string_of_masses_follows_its_closed_form(double damping)
{
    enum { ELEMENTS = 8 };
    const double T = 300, l = 0.16875, m = 0.01715625, k = T / l;
    const struct recipe recipe = {
        .elements = ELEMENTS,
        .coordinates = "z",
        .length = l,
        .tension = T,
        .inertia = {[RD_Z] = m},
        .left = "z",
        .right = "z",
    };
    static const int32_t node[] = {0, 1, 2, 4, 7, 3};
    static const double row[] = {0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 0.5, 0.5};
    static const size_t at[] = {1, 1, 3, 4, 7};
    const struct rd_ports ports = {6, node, row, NULL};
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &ports, &ports);
    for (int step = 1; step < 40; step++) {
        const double omega = step * 2 * PI * 3.1;
        const complex_t g = CMPLX(1, damping * omega);
        const complex_t factor[RD_PARTS] = {1, g, 1, -omega * omega};
        complex_t value[36];
        double rounding[36];
        CHECK_INT(solve(&ready, factor, value, rounding), RD_OK);
        for (size_t p = 0; p < 36; p++) {
            const size_t d = p / 6, r = p % 6;
            CHECK(rounding[p] >= 0 && rounding[p] < 1e-10);
            CHECK(ready.motion[d] > 0 && ready.motion[d] < 1e-10);
            if (d == 5 || r == 5)
                continue;
            const complex_t expected = string_receptance(ELEMENTS, at[d], at[r], m, omega, k * g);
            CHECK_ABS(cabs(value[p] - expected), 0, 8 * rounding[p] + 64 * EPS * cabs(expected),
                      "8 times the estimate reported, and 64 eps of the closed form's own");
        }
        CHECK_REL(ready.motion[4], ready.motion[0], 1e-9,
                  "driven at either end the motion is mirrored, and known as well to 1e-9");
        /* halfway between nodes a string moves by the mean */
        const complex_t mean = (value[2 * 6 + 0] + value[3 * 6 + 0]) / 2;
        CHECK_ABS(cabs(value[5 * 6 + 0] - mean), 0, 8 * (rounding[30] + rounding[12]),
                  "8 times the estimates reported");
    }
    ready_free(&ready);
}

/* omega_1 of the chain: the response grows and its estimated error with it */
static void rounding_grows_towards_a_resonance(void)
{
    const struct recipe recipe = {
        .elements = 8,
        .coordinates = "z",
        .length = 0.16875,
        .tension = 300,
        .inertia = {[RD_Z] = 0.01715625},
        .left = "z",
        .right = "z",
    };
    static const int32_t node[] = {3};
    static const double row[] = {1, 0};
    const struct rd_ports port = {1, node, row, NULL};
    const double omega = 2 * sqrt(300 / 0.16875 / 0.01715625) * sin(PI / 16);
    double last = 0, share = 0, motion = 0;
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &port, &port);
    for (int digits = 1; digits < 12; digits++) {
        const double near = omega * (1 - pow(10, -digits));
        const complex_t factor[RD_PARTS] = {1, 1, 1, -near * near};
        complex_t value;
        double rounding;
        CHECK_INT(solve(&ready, factor, &value, &rounding), RD_OK);
        const complex_t expected = string_receptance(8, 3, 3, 0.01715625, near, 300 / 0.16875);
        CHECK(rounding > last);
        CHECK(ready.motion[0] > motion);
        motion = ready.motion[0];
        CHECK_ABS(
            cabs(value - expected), 0, 8 * rounding + 64 * EPS * cabs(expected),
            "8 times the estimate reported; the closed form errs as much near sin(n theta) = 0");
        last = rounding;
        share = rounding / cabs(value);
    }
    /* one mode only, and then nothing but rounding is left */
    CHECK_REL(2 * motion, share, 1e-6, "the other modes are 1e11 smaller");
    const complex_t factor[RD_PARTS] = {1, 1, 1, -omega * omega};
    complex_t value;
    double rounding;
    if (solve(&ready, factor, &value, &rounding) == RD_OK)
        CHECK(ready.motion[0] > 0.01);
    ready_free(&ready);
}

/* the response at a per force at b is the response at b per force at a, all couplings present */
static void response_is_reciprocal(const char *coordinates, double tension)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 12,
        .coordinates = coordinates,
        .length = 0.1125,
        .tension = tension,
        .section = {8.5e5, 0.1485, 54.626, 120, 0.3},
        .inertia = {0.0114, 0.0114, 2.4e-8, 7.8e-5},
        .left = "zb",
        .right = "xa",
    };
    static const int32_t node[PORTS] = {0, 2, 3, 7, 10, 11};
    double row[PORTS * 2 * RD_WIDTH_MAX];
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        row[k] = check_random();
    const struct rd_ports ports = {PORTS, node, row, NULL};
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &ports, &ports);
    for (int step = 0; step < 10; step++) {
        const double omega = 2 * PI * (0.5 + 40 * step);
        const complex_t g = CMPLX(1, 1e-4 * omega);
        const complex_t factor[RD_PARTS] = {g, 1, g, CMPLX(-omega * omega, omega)};
        complex_t value[PORTS * PORTS];
        double rounding[PORTS * PORTS];
        CHECK_INT(solve(&ready, factor, value, rounding), RD_OK);
        for (size_t d = 0; d < PORTS; d++)
            for (size_t r = 0; r < PORTS; r++) {
                const size_t dr = d * PORTS + r, rd = r * PORTS + d;
                CHECK_ABS(cabs(value[dr] - value[rd]), 0, 8 * rounding[dr],
                          "8 times the estimate reported");
                CHECK_REL(rounding[dr], rounding[rd], 1e-9,
                          "the same sum of products, of solutions good to 1e-9");
            }
    }
    ready_free(&ready);
}

/* different drives and responses: value (drives, responses) is row by row */
static void value_is_laid_out_drive_by_drive(void)
{
    const struct recipe recipe = {
        .elements = 2,
        .coordinates = "z",
        .length = 1,
        .tension = 4,
        .left = "z",
        .right = "",
    };
    static const int32_t drive[] = {0, 1}, response[] = {0, 1, 0};
    static const double drive_row[] = {0, 1, 0, 1}, response_row[] = {0, 1, 0, 1, 1, 0};
    /* static: h = min(s, p)/T at s = 1, 2 and 0 for forces at p = 1, 2 */
    static const double expected[] = {0.25, 0.25, 0, 0.25, 0.5, 0};
    const struct rd_ports drives = {2, drive, drive_row, NULL},
                          responses = {3, response, response_row, NULL};
    static const complex_t factor[RD_PARTS] = {1, 1, 1, 0};
    complex_t value[6];
    double rounding[6];
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &drives, &responses);
    CHECK_INT(solve(&ready, factor, value, rounding), RD_OK);
    for (size_t k = 0; k < 6; k++) {
        CHECK_REL(creal(value[k]), expected[k], 8 * EPS, "a two by two system");
        CHECK_EXACT(cimag(value[k]), 0);
        CHECK((rounding[k] == 0) == (expected[k] == 0));
    }
    ready_free(&ready);
}

/* D is exactly zero or exactly singular: powers of two throughout */
static void exact_resonance_is_singular(void)
{
    struct recipe recipe = {
        .elements = 1,
        .coordinates = "z",
        .length = 1,
        .tension = 4,
        .inertia = {[RD_Z] = 8},
        .left = "z",
        .right = "",
    };
    static const complex_t rest[RD_PARTS] = {1, 1, 1, 0};
    static const complex_t one[RD_PARTS] = {1, 1, 1, -1}; /* omega = 1: k - m = 4 - 4 */
    complex_t value;
    double rounding;
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &at_right_end, &at_right_end);
    CHECK_INT(solve(&ready, one, &value, &rounding), RD_SINGULAR);
    /* the next frequency is none the worse for it */
    CHECK_INT(solve(&ready, rest, &value, &rounding), RD_OK);
    CHECK_EXACT(creal(value), 0.25);
    ready_free(&ready);
    /* a free string at rest */
    recipe.left = "";
    ready_make(&ready, rope_make(&recipe), &at_right_end, &at_right_end);
    CHECK_INT(solve(&ready, rest, &value, &rounding), RD_SINGULAR);
    ready_free(&ready);
    /* a free mass at rest: nothing holds it at all */
    recipe.left = "z";
    recipe.tension = 0;
    ready_make(&ready, rope_make(&recipe), &at_right_end, &at_right_end);
    CHECK_INT(solve(&ready, rest, &value, &rounding), RD_SINGULAR);
    CHECK_INT(solve(&ready, one, &value, &rounding), RD_OK);
    CHECK_EXACT(creal(value), -0.25);
    ready_free(&ready);
}

static void held_chain_does_not_move(void)
{
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "zb",
        .kind = RD_RIGID,
        .length = 1,
        .tension = 4,
        .section = {.bending = 1},
        .inertia = {[RD_Z] = 1, [RD_BETA] = 1},
        .left = "zb",
        .right = "zb",
    };
    static const double row[] = {1, 2, 3, 4};
    const struct rd_ports port = {1, first, row, NULL};
    static const complex_t factor[RD_PARTS] = {1, 1, 1, -1};
    complex_t value = 1;
    double rounding = 1;
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &port, &port);
    CHECK_INT(solve(&ready, factor, &value, &rounding), RD_OK);
    CHECK_EXACT(cabs(value), 0);
    CHECK_EXACT(rounding, 0);
    CHECK_EXACT(ready.motion[0], 0);
    ready_free(&ready);
}

/* every size that is too small: refused, and nothing is written outside the block */
static void short_memory_is_refused_at_every_size(void)
{
    const struct recipe recipe = {
        .elements = 2,
        .coordinates = "zb",
        .kind = RD_RIGID,
        .length = 1,
        .tension = 4,
        .section = {.bending = 1},
        .inertia = {[RD_Z] = 1, [RD_BETA] = 1},
        .left = "z",
        .right = "zb",
    };
    static const int32_t node[] = {0, 1};
    static const double row[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    const struct rd_ports drives = {2, node, row, NULL}, responses = {1, node, row, NULL};
    struct rope rope = rope_make(&recipe);
    const size_t needed = measure(&rope, &drives, &responses);
    for (size_t bytes = 0; bytes < needed; bytes += bytes + 8 < needed ? 8 : 1) {
        struct rd_frf frf;
        struct rd_workspace workspace = exact_workspace(bytes);
        CHECK_INT(rd_frf_prepare(&rope.chain, &drives, &responses, &frf, &workspace), RD_NO_MEMORY);
        CHECK_INT(workspace.used, needed);
        free(workspace.base);
    }
    rope.flexibility[8] = -1;
    struct rd_frf frf;
    struct rd_workspace workspace = exact_workspace(needed);
    CHECK_INT(rd_frf_prepare(&rope.chain, &drives, &responses, &frf, &workspace),
              RD_NOT_POSITIVE_DEFINITE);
    free(workspace.base);
    rope_free(&rope);
}

static void whoever_asks_to_stop_is_heard(void)
{
    const struct recipe recipe = {
        .elements = 3,
        .coordinates = "z",
        .length = 1.0,
        .tension = 300,
        .inertia = {[RD_Z] = 0.1},
        .left = "z",
        .right = "",
    };
    struct ready ready;
    ready_make(&ready, rope_make(&recipe), &at_right_end, &at_right_end);
    const complex_t factor[RD_PARTS] = {1, 1, 1, -400.0};
    int questions = 0;
    for (int late = 1; late < 10 && questions == 0; late++) {
        complex_t value;
        double rounding;
        int left = late;
        const struct rd_stop stop = {says_yes, &left};
        const enum rd_status status =
            rd_frf_solve(&ready.frf, factor, &stop, &value, &rounding, ready.motion);
        CHECK_INT(status, left == 0 ? RD_INTERRUPTED : RD_OK);
        questions = status == RD_OK ? late : 0;
    }
    CHECK_INT(questions, 4); /* one more than between assembly, factors, columns and the adjoint */
    ready_free(&ready);
}

int main(void)
{
    one_mass_is_the_textbook_oscillator();
    string_of_masses_follows_its_closed_form(0);
    string_of_masses_follows_its_closed_form(1e-4);
    rounding_grows_towards_a_resonance();
    response_is_reciprocal("zb", 300);
    response_is_reciprocal("zab", 0);
    response_is_reciprocal("xzab", 300);
    value_is_laid_out_drive_by_drive();
    exact_resonance_is_singular();
    held_chain_does_not_move();
    whoever_asks_to_stop_is_heard();
    short_memory_is_refused_at_every_size();
    return check_report("test_frf");
}
