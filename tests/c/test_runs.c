/* Uniform runs: where they are, and that pieces agree with the walk node by node. */
#include "check.h"
#include "line.h"

#include <string.h>

static void test_what_ends_a_run(void)
{
    struct line line;
    line_make(&line, RD_RIGID, 2, 100, 10.0, 1.0, 1.0, 1);
    line_find(&line);
    CHECK_INT(line.runs.count, 1);
    CHECK_INT(line.runs.run[0].first, 0);
    CHECK_INT(line.runs.run[0].last, 100);
    CHECK_REL(line.runs.length, 1.0, 100 * EPS, "a sum of 100");
    CHECK_REL(line.runs.mass[0], 1.0, 0.02, "a geometric mean, half masses at the ends");
    line.term_of[40] = FIRST; /* another mass, a support, a hinge: all end it */
    line.mass[FIRST * 4] *= 2.0;
    line.term_of[60] = SECOND;
    line.held[SECOND * 2] = 1;
    line_find(&line);
    CHECK_INT(line.runs.count, 3);
    CHECK_INT(line.runs.run[1].first, 40);
    CHECK_INT(line.runs.run[1].last, 60);
    line.held[SECOND * 2] = 0;
    line.hinge[SECOND * 2 + 1] = 1.0;
    line_find(&line);
    CHECK_INT(line.runs.count, 3);
    line.term_of[64] = SECOND; /* shorter than a run may be */
    line_find(&line);
    CHECK_INT(line.runs.count, 3);
    CHECK(rd_runs_capacity(&line.chain) >= 3);
}

static void test_pieces_agree_with_nodes(enum rd_kind kind, size_t width, size_t n)
{
    const double omega[] = {0.1, 3.0, 40.0, 170.0, 900.0};
    double complex h[5], g[5];
    double error[5], other[5];
    struct line line;
    line_make(&line, kind, width, n, 300.0, 2.0, 1.0, 1);
    line.term_of[n / 4] = FIRST;
    line.stiffness[FIRST * width * width] = 1e4;
    line_find(&line);
    const int32_t drive = (int32_t)n / 2, response = (int32_t)n / 3;
    CHECK_INT(line_frf(&line, drive, response, omega, 5, h, error), RD_OK);
    /* the same terms under other numbers in turn: no run is left */
    memcpy(line.mass + SECOND * width * width, line.mass + INNER * width * width,
           width * width * sizeof *line.mass);
    for (size_t i = 1; i < n; i += 2)
        line.term_of[i] = line.term_of[i] == INNER ? SECOND : line.term_of[i];
    line_find(&line);
    CHECK_INT(line.runs.count, 0);
    CHECK_INT(line_frf(&line, drive, response, omega, 5, g, other), RD_OK);
    for (size_t i = 0; i < 5; i++)
        CHECK(cabs(h[i] - g[i]) <= error[i] + other[i]);
}

/* elements with nothing between them are one run, parts end it, however short */
static void test_continuous_runs(void)
{
    struct line line;
    line_make(&line, RD_CONTINUOUS, 2, 10, 10.0, 1.0, 0.7, 1);
    line_find(&line);
    CHECK_INT(line.runs.count, 1);
    CHECK_INT(line.runs.least, 1);
    CHECK_INT(line.runs.run[0].first, 0);
    CHECK_INT(line.runs.run[0].last, 10);
    CHECK_INT(line.runs.run[0].term, RD_NO_TERM);
    CHECK_REL(line.runs.mass[0], 0.7, 32 * EPS, "a sum of ten");
    line.term_of[4] = FIRST;
    line.mass[FIRST * 4] = 100.0;
    line.term_of[5] = SECOND;
    line.hinge[SECOND * 2 + 1] = 1.0;
    line_find(&line);
    CHECK_INT(line.runs.count, 3);
    CHECK_INT(line.runs.run[1].first, 4);
    CHECK_INT(line.runs.run[1].last, 5);
    CHECK_REL(line.runs.mass[0], 0.7, 32 * EPS, "the rope's own, whatever stands on it");
    CHECK(rd_runs_capacity(&line.chain) >= 3);
}

int main(void)
{
    test_continuous_runs();
    test_what_ends_a_run();
    for (size_t n = 20; n < LINE_NODES; n *= 3)
        for (size_t width = 1; width <= 2; width++)
            for (int kind = RD_RIGID; kind <= RD_TENSED; kind++)
                test_pieces_agree_with_nodes((enum rd_kind)kind, width, n);
    return check_report("runs");
}
