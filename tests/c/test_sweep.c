/* Frequency response against closed forms. */
#include "check.h"
#include "line.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

/* one mass m between two strings of length 1/2: h = 1/(4 T - m omega^2) */
static void test_one_mass_on_a_string(void)
{
    struct line line;
    line_make(&line, RD_RIGID, 1, 2, 3.0, 0.0, 4.0, 0);
    line_find(&line);
    const double omega[] = {0.0, 0.7, 2.0, 50.0};
    double complex h[4];
    double error[4];
    CHECK_INT(line_frf(&line, 1, 1, omega, 4, h, error), RD_OK);
    for (size_t i = 0; i < 4; i++) {
        const double exact = 1.0 / (12.0 - 2.0 * omega[i] * omega[i]);
        CHECK_REL(creal(h[i]), exact, 8 * EPS, "a few operations");
        CHECK(fabs(creal(h[i]) - exact) <= error[i]);
        CHECK_ABS(cimag(h[i]), 0.0, error[i], "undamped");
    }
}

/* sin theta/2 = omega sqrt(m l/T)/2:  h_ij = sin(i theta) sin((n - j) theta) l
                                               / (T sin(theta) sin(n theta)), i <= j */
static void test_string_of_n_masses(size_t n)
{
    struct line line;
    line_make(&line, RD_RIGID, 1, n, 3.0, 0.0, 4.0, 0);
    line_find(&line);
    const double omega[] = {0.3, 1.7, 2.9, 4.4};
    const double l = 1.0 / (double)n;
    const size_t i = n / 3, j = n / 2;
    double complex h[4];
    double error[4];
    CHECK_INT(line_frf(&line, (int32_t)j, (int32_t)i, omega, 4, h, error), RD_OK);
    for (size_t k = 0; k < 4; k++) {
        const double theta = 2.0 * asin(0.5 * omega[k] * sqrt(4.0 * l * l / 3.0));
        const double exact = sin((double)i * theta) * sin((double)(n - j) * theta) * l /
                             (3.0 * sin(theta) * sin((double)n * theta));
        CHECK_REL(creal(h[k]), exact, 1e-13 * (double)n, "the closed form's own arguments");
    }
}

/* static middle deflection of a clamped beam L^3/192 B and of a pinned one L^3/48 B; clamped with
   tension, xi = L sqrt(T/B): (xi/4 - tanh(xi/4)) L/(T xi) */
static void test_static_beams(enum rd_kind kind, size_t n)
{
    const double omega[] = {0.0}, B = 2.0, T = 50.0, xi = sqrt(T / B);
    double complex h;
    double error;
    struct line line;
    for (int clamped = 0; clamped < 2; clamped++) {
        line_make(&line, kind, 2, n, 0.0, B, 1.0, clamped);
        line_find(&line);
        CHECK_INT(line_frf(&line, (int32_t)n / 2, (int32_t)n / 2, omega, 1, &h, &error), RD_OK);
        CHECK_REL(creal(h), 1.0 / ((clamped ? 192.0 : 48.0) * B), 1e-12, "measured 1e-14");
    }
    if (kind != RD_TENSED)
        return;
    line_make(&line, kind, 2, n, T, B, 1.0, 1);
    line_find(&line);
    CHECK_INT(line_frf(&line, (int32_t)n / 2, (int32_t)n / 2, omega, 1, &h, &error), RD_OK);
    CHECK_REL(creal(h), (xi / 4 - tanh(xi / 4)) / (T * xi), 1e-12, "measured 1e-14");
}

/* a clamped beam with free hinges at its ends is a pinned one; with a free hinge at its middle it
   is two cantilevers: L^3/48 B as well, by chance, and (L/2)^3/3B/2 = L^3/48 B */
static void test_hinges(void)
{
    const double omega[] = {0.0}, B = 2.0;
    double complex h;
    double error;
    struct line line;
    line_make(&line, RD_RIGID, 2, 20, 0.0, B, 1.0, 1);
    line.hinge[2 * FIRST + 1] = INFINITY;
    line.term_of[10] = FIRST;
    line_find(&line);
    CHECK_INT(line_frf(&line, 10, 10, omega, 1, &h, &error), RD_OK);
    CHECK_REL(creal(h), 1.0 / (48.0 * B), 1e-13, "measured 1e-15");
    /* a compliance c in the middle of a pinned beam: L^3/48B + c (L/4)^2 */
    line_make(&line, RD_RIGID, 2, 20, 0.0, B, 1.0, 0);
    line.hinge[2 * FIRST + 1] = 0.3;
    line.term_of[10] = FIRST;
    line_find(&line);
    CHECK_INT(line_frf(&line, 10, 10, omega, 1, &h, &error), RD_OK);
    CHECK_REL(creal(h), 1.0 / (48.0 * B) + 0.3 / 16.0, 1e-13, "measured 1e-15");
}

/* the same with every elastic part times g = 1 + 0.4 i: all of h is divided by g, the hinge too;
   from both sides of it */
static void test_hinge_is_damped_as_a_spring(void)
{
    const double B = 2.0, g[2] = {1.0, 0.4}, none[2] = {0.0, 0.0};
    const double row[4] = {1.0}, exact = 1.0 / (48.0 * B) + 0.3 / 16.0;
    const int32_t node[] = {7, 10, 13};
    struct line line;
    line_make(&line, RD_RIGID, 2, 20, 0.0, B, 1.0, 0);
    line.hinge[2 * FIRST + 1] = 0.3;
    line.term_of[10] = FIRST;
    line_find(&line);
    const struct rd_factors factors = {
        .count = 1, .section = g, .tension = g, .spring = g, .inertia = none, .dashpot = none};
    double complex h[3];
    for (size_t k = 0; k < 3; k++) {
        const struct rd_ports port = {1, node + k, row, NULL}, middle = {1, node + 1, row, NULL};
        struct rd_workspace space = {0};
        double error;
        size_t failed = 0;
        rd_frf_sweep(&line.chain, &factors, &port, &middle, &space, (double *)(h + k), &error,
                     &failed);
        space = (struct rd_workspace){.base = malloc(space.used), .size = space.used};
        if (!space.base)
            abort();
        CHECK_INT(rd_frf_sweep(&line.chain, &factors, &port, &middle, &space, (double *)(h + k),
                               &error, &failed),
                  RD_OK);
        free(space.base);
    }
    CHECK_ABS(cabs(h[1] * CMPLX(1.0, 0.4) / exact - 1.0), 0, 1e-13, "measured 1e-15");
    CHECK_ABS(cabs(h[0] / h[2] - 1.0), 0, 1e-13, "left and right of the middle are alike");
}

/* same bits whatever the frequencies beside it */
static void test_neighbours_do_not_matter(void)
{
    struct line line;
    line_make(&line, RD_TENSED, 2, 300, 300.0, 2.0, 1.0, 1);
    line_find(&line);
    double omega[LINE_POINTS], error[LINE_POINTS], other[LINE_POINTS];
    double complex h[LINE_POINTS], g[LINE_POINTS];
    for (size_t i = 0; i < LINE_POINTS; i++)
        omega[i] = 0.1 * exp(0.2 * (double)i);
    CHECK_INT(line_frf(&line, 150, 100, omega, LINE_POINTS, h, error), RD_OK);
    for (size_t n = 1; n < LINE_POINTS; n += 6)
        for (size_t i = 0; i + n <= LINE_POINTS; i += n) {
            CHECK_INT(line_frf(&line, 150, 100, omega + i, n, g, other), RD_OK);
            CHECK(memcmp(g, h + i, n * sizeof *g) == 0);
            CHECK(memcmp(other, error + i, n * sizeof *other) == 0);
        }
}

static void test_failures(void)
{
    struct line line;
    /* T/l + T/l = m omega^2 at omega = 1 */
    line_make(&line, RD_RIGID, 1, 2, 1.0, 0.0, 8.0, 0);
    line_find(&line);
    const double omega[] = {0.5, 1.0, 1.5};
    double complex h[3];
    double error[3];
    size_t failed = 99;
    CHECK_INT(line_frf_less(&line, 1, 1, omega, 3, h, error, 0, &failed), RD_SINGULAR);
    CHECK_INT(failed, 1);
    CHECK_INT(line_frf_less(&line, 1, 1, omega, 1, h, error, 1, &failed), RD_NO_MEMORY);
}

/* sin(k a) sin(k (1 - b))/(T k sin k), k^2 = omega^2 mu/T, a <= b, of any cut */
static void test_continuous_string(size_t n)
{
    const double omega[] = {0.3, 5.0, 40.0, 3000.0};
    double complex h[4];
    double error[4];
    struct line line;
    line_make(&line, RD_CONTINUOUS, 1, n, 3.0, 0.0, 4.0, 0);
    line_find(&line);
    CHECK_INT(line_frf(&line, (int32_t)n / 2, (int32_t)n / 3, omega, 4, h, error), RD_OK);
    const double a = (double)(n / 3) / (double)n, b = (double)(n / 2) / (double)n;
    for (size_t i = 0; i < 4; i++) {
        const double k = omega[i] * sqrt(4.0 / 3.0);
        const double exact = sin(k * a) * sin(k * (1 - b)) / (3 * k * sin(k));
        /* the closed form has the argument k to EPS, times the slopes of its sines */
        CHECK_ABS(creal(h[i]), exact, error[i] + 16 * EPS * k / (3 * k * sin(k) * sin(k)),
                  "the bound that is reported, and the closed form's own arguments");
        CHECK(error[i] <= 1e-12 / (3 * sin(k) * sin(k))); /* k dh/dk; measured 1e-14 */
        CHECK_ABS(cimag(h[i]), 0.0, error[i], "undamped");
    }
}

/* a dashpot c beside the middle of n masses m, or all of a string: 1/h = pull (cot p theta + cot q
   theta) + i omega c, pull = T sin(theta)/l with 2 sin(theta/2) = omega sqrt(m l/T), or T k */
static void test_dashpot_on_a_string(enum rd_kind kind, double c)
{
    enum { N = 30, AT = 9 };
    const double omega[] = {0.3, 1.7, 2.9, 4.4}, l = 1.0 / N;
    double complex h[4];
    double error[4];
    struct line line;
    line_make(&line, kind, 1, N, 3.0, 0.0, 4.0, 0);
    line.mass[FIRST] = line.mass[INNER];
    line.damping[FIRST] = c;
    line.term_of[AT] = FIRST;
    line_find(&line);
    CHECK_INT(line_frf(&line, AT, AT, omega, 4, h, error), RD_OK);
    for (size_t i = 0; i < 4; i++) {
        const double k = omega[i] * sqrt(4.0 / 3.0);
        const double theta = kind == RD_CONTINUOUS ? k * l : 2.0 * asin(0.5 * k * l);
        const double pull = kind == RD_CONTINUOUS ? 3.0 * k : 3.0 * sin(theta) / l;
        const double rest = pull * (1 / tan(AT * theta) + 1 / tan((N - AT) * theta));
        const double complex exact = 1.0 / CMPLX(rest, omega[i] * c);
        CHECK_ABS(cabs(h[i] - exact), 0, 1e-12 * cabs(exact), "the closed form's own arguments");
        CHECK(cabs(h[i] - exact) <= error[i] + 1e-13 * cabs(exact));
    }
}

/* sin(k a) sin(k (1 - a))/(T k sin k), T k^2 = mu omega^2 - i omega c */
static void test_drag_along_a_string(double c)
{
    const double omega[] = {0.3, 5.0, 40.0, 300.0}, a = 0.3;
    double complex h[4];
    double error[4];
    struct line line;
    line_make(&line, RD_CONTINUOUS, 1, 10, 3.0, 0.0, 4.0, 0);
    line.drag[0] = c;
    line_find(&line);
    CHECK_INT(line_frf(&line, 3, 3, omega, 4, h, error), RD_OK);
    for (size_t i = 0; i < 4; i++) {
        const double complex k = csqrt(CMPLX(4.0 * omega[i] * omega[i], -omega[i] * c) / 3.0);
        const double complex exact = csin(k * a) * csin(k * (1 - a)) / (3 * k * csin(k));
        const double slope = cabs(k) * (1 + cabs(1 / ctan(k)) + cabs(1 / ctan(k * a)));
        CHECK_ABS(cabs(h[i] - exact), 0, 64 * EPS * (1 + slope) * cabs(exact),
                  "the closed form's own arguments");
        CHECK(cabs(h[i] - exact) <= error[i] + 4 * EPS * slope * cabs(exact));
    }
}

/* static: the middle of a clamped tensed beam, as of tensed elements */
static void test_continuous_beam_at_rest(void)
{
    const double omega[] = {0.0}, xi = 5.0;
    double complex h;
    double error;
    struct line line;
    line_make(&line, RD_CONTINUOUS, 2, 2, 50.0, 2.0, 1.0, 1);
    line_find(&line);
    CHECK_INT(line_frf(&line, 1, 1, omega, 1, &h, &error), RD_OK);
    CHECK_REL(creal(h), (xi / 4 - tanh(xi / 4)) / (50.0 * xi), 1e-12, "measured 1e-14");
    CHECK(error < 1e-12 * creal(h));
}

/* at 1e12 rad/s there are more pieces than are walked; nothing hangs */
static void test_continuous_string_of_too_many_waves(void)
{
    const double omega[] = {1.0, 1e12};
    double complex h[2];
    double error[2];
    struct line line;
    line_make(&line, RD_CONTINUOUS, 1, 2, 3.0, 0.0, 4.0, 0);
    line_find(&line);
    CHECK_INT(line_frf(&line, 1, 1, omega, 2, h, error), RD_SHORT_WAVES);
    CHECK_INT(line_frf(&line, 1, 1, omega, 1, h, error), RD_OK);
}

int main(void)
{
    for (size_t n = 3; n < 500; n *= 3)
        test_continuous_string(n);
    for (double c = 1e-6; c < 1e10; c *= 1e3) {
        test_dashpot_on_a_string(RD_RIGID, c);
        test_dashpot_on_a_string(RD_CONTINUOUS, c);
    }
    for (double c = 1e-6; c < 1e3; c *= 1e2)
        test_drag_along_a_string(c);
    test_continuous_beam_at_rest();
    test_continuous_string_of_too_many_waves();
    (void)PI;
    test_one_mass_on_a_string();
    for (size_t n = 3; n < 300; n *= 3)
        test_string_of_n_masses(n);
    for (size_t n = 2; n < 300; n *= 4) {
        test_static_beams(RD_RIGID, n);
        test_static_beams(RD_TENSED, n);
    }
    test_hinges();
    test_hinge_is_damped_as_a_spring();
    test_neighbours_do_not_matter();
    test_failures();
    return check_report("sweep");
}
