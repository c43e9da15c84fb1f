/* The mixed form: closed forms, hinges, its estimate of rounding, and what it refuses. */
#include "mixed/deflection.h"
#include "mixed/frf.h"

#include "check.h"
#include "line.h"

#include <stdbool.h>
#include <string.h>

typedef double _Complex complex_t;

static const double Z_ROW[] = {1, 0, 0, 0};

/* exactly `bytes`, so that valgrind and AddressSanitizer see every byte written outside */
static struct rd_workspace exact_workspace(size_t bytes)
{
    char *base = malloc(bytes);
    if (base == NULL)
        abort();
    return (struct rd_workspace){.base = base, .size = bytes};
}

/* z of node `response` per force in z at `drive`, neither the last node */
static enum rd_status solve(const struct line *line, int32_t drive, int32_t response, double omega,
                            complex_t *value, double *error)
{
    const struct rd_ports drives = {1, &drive, Z_ROW, NULL};
    const struct rd_ports responses = {1, &response, Z_ROW, NULL};
    struct rd_mixed_frf frf;
    struct rd_workspace measure = {0};
    CHECK_INT(rd_mixed_frf_prepare(&line->chain, &drives, &responses, &frf, &measure),
              RD_NO_MEMORY);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_mixed_frf_prepare(&line->chain, &drives, &responses, &frf, &workspace), RD_OK);
    const complex_t factor[RD_PARTS] = {1, 1, 1, -omega * omega, CMPLX(0, omega)};
    const enum rd_status status = rd_mixed_frf_solve(&frf, factor, 1, value, error);
    free(workspace.base);
    return status;
}

/* sin theta/2 = omega sqrt(m l/T)/2:  h_ij = sin(i theta) sin((n - j) theta) l
                                               / (T sin(theta) sin(n theta)), i <= j */
static void string_of_masses_follows_its_closed_form(size_t n)
{
    struct line line;
    line_make(&line, RD_RIGID, 1, n, 3.0, 0.0, 4.0, 0);
    line_find(&line);
    const double omega[] = {0.3, 1.7, 2.9, 4.4}, l = 1.0 / (double)n;
    const size_t i = n / 3, j = n / 2;
    for (size_t k = 0; k < 4; k++) {
        complex_t h;
        double error;
        const double theta = 2.0 * asin(0.5 * omega[k] * sqrt(4.0 * l * l / 3.0));
        const double exact = sin((double)i * theta) * sin((double)(n - j) * theta) * l /
                             (3.0 * sin(theta) * sin((double)n * theta));
        CHECK_INT(solve(&line, (int32_t)j, (int32_t)i, omega[k], &h, &error), RD_OK);
        CHECK_REL(creal(h), exact, 1e-13 * (double)n, "the closed form's own arguments");
        CHECK_EXACT(cimag(h), 0);
    }
}

/* 1/h = T sin(theta)/l (cot p theta + cot q theta) + i omega c at a dashpot c, and with c l at every
   mass 4 T sin^2(theta/2) = l^2 (m omega^2/l - i omega c), theta complex */
static void dashpots_follow_their_closed_form(double c, bool every)
{
    enum { N = 30, AT = 9 };
    const double omega[] = {0.3, 1.7, 2.9, 4.4}, l = 1.0 / N;
    struct line line;
    line_make(&line, RD_RIGID, 1, N, 3.0, 0.0, 4.0, 0);
    line.mass[FIRST] = line.mass[INNER];
    line.damping[every ? INNER : FIRST] = every ? c * l : c;
    line.term_of[AT] = every ? INNER : FIRST;
    line_find(&line);
    for (size_t k = 0; k < 4; k++) {
        complex_t h;
        double error;
        const complex_t lost = CMPLX(0, omega[k] * c);
        const complex_t q = 4.0 * omega[k] * omega[k] - (every ? lost : 0);
        const complex_t theta = 2.0 * casin(0.5 * l * csqrt(q / 3.0));
        const complex_t rest = 1 / ctan(AT * theta) + 1 / ctan((N - AT) * theta);
        const complex_t exact = 1 / (3.0 * csin(theta) / l * rest + (every ? 0 : lost));
        CHECK_INT(solve(&line, AT, AT, omega[k], &h, &error), RD_OK);
        CHECK_ABS(cabs(h - exact), 0, 1e-12 * cabs(exact), "the closed form's own arguments");
        CHECK(cabs(h - exact) <= error + 1e-13 * cabs(exact));
    }
}

/* L^3/192 B and L^3/48 B in the middle */
static void beams_bend_as_in_the_textbook(enum rd_kind kind, size_t n)
{
    const double B = 2.0;
    for (int clamped = 0; clamped < 2; clamped++) {
        struct line line;
        complex_t h;
        double error;
        line_make(&line, kind, 2, n, 0.0, B, 1.0, clamped);
        line_find(&line);
        const double exact = 1.0 / ((clamped ? 192.0 : 48.0) * B);
        CHECK_INT(solve(&line, (int32_t)n / 2, (int32_t)n / 2, 0.0, &h, &error), RD_OK);
        CHECK_REL(creal(h), exact, 4 * EPS * (double)n, "condition n");
        CHECK(fabs(creal(h) - exact) <= error);
        CHECK(error < 100 * EPS * (double)n * exact);
    }
}

/* clamped with a free hinge in the middle: two cantilevers, (L/2)^3/3B/2; pinned with the
   compliance c there: L^3/48B + c (L/4)^2, undamped as any spring */
static void hinges_add_their_compliance(enum rd_kind kind)
{
    const double B = 2.0;
    struct line line;
    complex_t h;
    double error;
    line_make(&line, kind, 2, 20, 0.0, B, 1.0, 1);
    line.hinge[2 * FIRST + 1] = INFINITY;
    line.term_of[10] = FIRST;
    line_find(&line);
    CHECK_INT(solve(&line, 10, 10, 0.0, &h, &error), RD_OK);
    CHECK_REL(creal(h), 1.0 / (48.0 * B), 1e-13, "20 elements of condition 20");
    line_make(&line, kind, 2, 20, 0.0, B, 1.0, 0);
    line.term_of[10] = FIRST;
    for (double c = 1e-30; c < 1e12; c *= 1e6) {
        line.hinge[2 * FIRST + 1] = c;
        line_find(&line);
        CHECK_INT(solve(&line, 10, 10, 0.0, &h, &error), RD_OK);
        CHECK_REL(creal(h), 1.0 / (48.0 * B) + c / 16.0, 1e-13, "20 elements of condition 20");
        CHECK(fabs(creal(h) - 1.0 / (48.0 * B) - c / 16.0) <= error);
    }
}

/* a force p in the middle of a clamped beam: reactions p/2, moments p L/8 */
static void deflection_knows_its_forces(void)
{
    enum { N = 16 };
    struct line line;
    line_make(&line, RD_TENSED, 2, N, 0.0, 2.0, 1.0, 1);
    line_find(&line);
    double load[2 * (N + 1)] = {0}, u[2 * (N + 1)], force[2 * N];
    load[N] = 3.0;
    struct rd_mixed_deflection deflection;
    struct rd_workspace measure = {0};
    CHECK_INT(rd_mixed_deflection_prepare(&line.chain, &deflection, &measure), RD_NO_MEMORY);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_mixed_deflection_prepare(&line.chain, &deflection, &workspace), RD_OK);
    CHECK_INT(rd_mixed_deflection_solve(&deflection, load, u, force), RD_OK);
    CHECK_REL(u[N], 3.0 / (192.0 * 2.0), 64 * EPS * N, "condition n");
    CHECK_EXACT(u[0], 0);
    CHECK_EXACT(u[2 * N + 1], 0);
    CHECK_REL(force[0], 1.5, 64 * EPS * N, "condition n");
    CHECK_REL(force[2 * N - 2], -1.5, 64 * EPS * N, "condition n");
    CHECK_REL(force[2 * N - 1], 3.0 / 8, 64 * EPS * N, "condition n");
    free(workspace.base);
}

/* T/l + T/l = m omega^2 at omega = 1; a free string at rest */
static void resonances_have_no_answer(void)
{
    struct line line;
    complex_t h;
    double error;
    line_make(&line, RD_RIGID, 1, 2, 1.0, 0.0, 8.0, 0);
    line_find(&line);
    CHECK_INT(solve(&line, 1, 1, 0.5, &h, &error), RD_OK);
    CHECK_INT(solve(&line, 1, 1, 1.0, &h, &error), RD_SINGULAR);
    memset(line.held, 0, sizeof line.held);
    CHECK_INT(solve(&line, 1, 1, 0.0, &h, &error), RD_SINGULAR);
}

/* a dislocation g at node j moves node i as the force there moves under a load at i */
static void dislocations_and_forces_are_reciprocal(void)
{
    enum { N = 12 };
    struct line line;
    line_make(&line, RD_TENSED, 2, N, 20.0, 2.0, 1.0, 1);
    line_find(&line);
    const int32_t node[2] = {4, 7};
    const double row[8] = {1, 0, 0, 0, 0, 0, 0, 0}, force[4] = {0, 0, 0.3, 1};
    const struct rd_ports ports = {2, node, row, force};
    struct rd_mixed_frf frf;
    struct rd_workspace measure = {0};
    rd_mixed_frf_prepare(&line.chain, &ports, &ports, &frf, &measure);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_mixed_frf_prepare(&line.chain, &ports, &ports, &frf, &workspace), RD_OK);
    const complex_t factor[RD_PARTS] = {CMPLX(1, 0.01), 1, 1, -400.0};
    complex_t h[4];
    double error[4];
    CHECK_INT(rd_mixed_frf_solve(&frf, factor, 1, h, error), RD_OK);
    CHECK(cabs(h[1] - h[2]) <= error[1] + error[2]);
    CHECK(error[1] + error[2] < 1e-11 * cabs(h[1]));
    free(workspace.base);
}

/* lines and deflections end with whatever they are in: factors, substitutions, what is left */
static void whoever_asks_to_stop_is_heard(void)
{
    enum { N = 9 };
    struct line line;
    line_make(&line, RD_TENSED, 2, N, 20.0, 2.0, 1.0, 1);
    line_find(&line);
    const int32_t node = 4;
    const double row[4] = {1, 0, 0, 0};
    const struct rd_ports ports = {1, &node, row, NULL};
    struct rd_mixed_frf frf;
    struct rd_mixed_deflection deflection;
    struct rd_workspace measure = {0}, other = {0};
    rd_mixed_frf_prepare(&line.chain, &ports, &ports, &frf, &measure);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_mixed_frf_prepare(&line.chain, &ports, &ports, &frf, &workspace), RD_OK);
    rd_mixed_deflection_prepare(&line.chain, &deflection, &other);
    struct rd_workspace more = exact_workspace(other.used);
    CHECK_INT(rd_mixed_deflection_prepare(&line.chain, &deflection, &more), RD_OK);
    const complex_t factor[RD_PARTS] = {1, 1, 1, -400.0};
    const double load[2 * (N + 1)] = {[8] = 1};
    double error, u[2 * (N + 1)], force[2 * N];
    complex_t h;
    int questions = 0;
    for (int late = 1; late < 100 && questions == 0; late++) {
        int left = late;
        frf.mixed.lu.stop = (struct rd_stop){says_yes, &left};
        const enum rd_status status = rd_mixed_frf_solve(&frf, factor, 1, &h, &error);
        CHECK_INT(status, left == 0 ? RD_INTERRUPTED : RD_OK);
        left = late;
        deflection.mixed.lu.stop = (struct rd_stop){says_yes, &left};
        const enum rd_status deflected = rd_mixed_deflection_solve(&deflection, load, u, force);
        CHECK_INT(deflected, left == 0 ? RD_INTERRUPTED : RD_OK);
        questions = status == RD_OK && deflected == RD_OK ? late : 0;
    }
    /* a factorisation, and both ways through each of four solutions that are refined once */
    CHECK(questions > 8);
    free(workspace.base);
    free(more.base);
}

int main(void)
{
    for (size_t n = 3; n < 300; n *= 3)
        string_of_masses_follows_its_closed_form(n);
    for (double c = 1e-6; c < 1e10; c *= 1e3)
        dashpots_follow_their_closed_form(c, false);
    for (double c = 1e-6; c < 1e2; c *= 1e2)
        dashpots_follow_their_closed_form(c, true);
    for (size_t n = 2; n < 500; n *= 4) {
        beams_bend_as_in_the_textbook(RD_RIGID, n);
        beams_bend_as_in_the_textbook(RD_TENSED, n);
    }
    hinges_add_their_compliance(RD_RIGID);
    hinges_add_their_compliance(RD_TENSED);
    deflection_knows_its_forces();
    resonances_have_no_answer();
    dislocations_and_forces_are_reciprocal();
    whoever_asks_to_stop_is_heard();
    return check_report("mixed");
}
