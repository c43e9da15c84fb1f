/* When laws change: guards whose first zero is known, or is looked for at many times. */
#include "law/crossing.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { RATES = 6, GROWING = 2, POWERS = 4, MOST = 2, ROOM = 8 };

static const double PI = 3.14159265358979323846;

/* guards over time, all 0 to begin with; rates that are not set are 0 */
struct guards {
    struct rd_course course;
    double rate[2 * ROOM], c[MOST * 2 * ROOM], d[MOST * 2 * ROOM], a[MOST * POWERS], scale[MOST];
};

static void begin(struct guards *guards, size_t outputs)
{
    memset(guards, 0, sizeof *guards);
    guards->course = (struct rd_course){outputs,      RATES,     GROWING,   POWERS,
                                        guards->rate, guards->c, guards->d, guards->a};
}

static void set_rate(struct guards *guards, size_t j, double re, double im)
{
    guards->rate[j] = re;
    guards->rate[ROOM + j] = im;
}

static struct rd_crossing first(const struct guards *guards, double end)
{
    const struct rd_stop never = {0};
    struct rd_workspace workspace = {0};
    struct rd_crossing crossing;
    rd_crossing_first(&guards->course, guards->scale, end, &never, &workspace, &crossing);
    workspace.size = workspace.used;
    workspace.base = malloc(workspace.size);
    workspace.used = 0;
    const enum rd_status status =
        rd_crossing_first(&guards->course, guards->scale, end, &never, &workspace, &crossing);
    CHECK_INT(status, RD_OK);
    free(workspace.base);
    return crossing;
}

static void cosine_falls_below_zero_after_a_quarter(void)
{
    struct guards guards;
    begin(&guards, 1);
    set_rate(&guards, 0, 0, 7);
    guards.c[0] = 2;
    CHECK(!first(&guards, 0.22).found);
    const struct rd_crossing crossing = first(&guards, 100);
    CHECK(crossing.found && crossing.which == 0);
    CHECK_REL(crossing.time, PI / 14, 4 * EPS, "Newton's method to the last digits");
}

/* 1 + s + cos t is below zero for 2 sqrt(-2 s) around pi, of 64 looks some 12 a period */
static void the_shortest_dip_is_seen(void)
{
    struct guards guards;
    begin(&guards, 2);
    set_rate(&guards, 0, 0, 1);
    guards.c[2 * ROOM] = 1;
    guards.a[0] = 1;
    for (int k = 2; k < 13; k++) {
        const double s = pow(10, -k);
        guards.a[POWERS] = 1 - s;
        const struct rd_crossing crossing = first(&guards, 1000);
        CHECK(crossing.found && crossing.which == 1);
        CHECK_ABS(crossing.time, PI - 2 * asin(sqrt(s / 2)), 64 * EPS / sqrt(2 * s) + 8 * EPS,
                  "rounding of 1 - s over the slope");
        guards.a[POWERS] = 1 + s;
        CHECK(!first(&guards, 1000).found);
    }
}

/* 0.3 - t e^(-t), and a guard that falls later */
static void what_grows_with_time_is_seen(void)
{
    struct guards guards;
    begin(&guards, 2);
    set_rate(&guards, 0, -1, 0);
    guards.a[0] = 2;
    guards.a[1] = -1;
    guards.a[POWERS] = 0.3;
    guards.d[2 * ROOM] = -1;
    const struct rd_crossing crossing = first(&guards, 10);
    CHECK(crossing.found && crossing.which == 1);
    CHECK_ABS(crossing.time * exp(-crossing.time), 0.3, 4 * EPS, "a root of it");
    CHECK(crossing.time < 0.6);
}

/* what begins a little below zero begins at zero; more is below it at once */
static void what_begins_below_zero_is_there_at_once(void)
{
    struct guards guards;
    begin(&guards, 1);
    guards.a[1] = 1;
    guards.scale[0] = 1;
    guards.a[0] = -1e-11;
    CHECK(!first(&guards, 1).found);
    guards.a[0] = -1e-9;
    const struct rd_crossing crossing = first(&guards, 1);
    CHECK(crossing.found);
    CHECK_EXACT(crossing.time, 0);
}

/* t^3 - t^3 e^(-t) is above zero though its slopes are 0 where it begins */
static void high_powers_of_time_are_told_by_taylor(void)
{
    struct guards guards;
    begin(&guards, 1);
    guards.a[3] = 1;
    CHECK(!first(&guards, 10).found);
    guards.a[3] = -1;
    guards.a[0] = 8;
    CHECK_REL(first(&guards, 10).time, 2, 4 * EPS, "a root of 8 - t^3");
}

static double at(const struct guards *guards, size_t i, double t)
{
    double waves[2 * ROOM];
    rd_course_waves(&guards->course, t, waves);
    return rd_course_value(&guards->course, i, waves, t);
}

static void random_guards_fall_where_they_are_first_seen_below(void)
{
    int found = 0;
    for (int n = 0; n < 60; n++) {
        struct guards guards;
        begin(&guards, MOST);
        for (size_t j = 0; j < RATES; j++) {
            set_rate(&guards, j, -fabs(check_random()), 40 * check_random());
            for (size_t i = 0; i < MOST; i++) {
                guards.c[i * 2 * ROOM + j] = check_random();
                guards.c[(2 * i + 1) * ROOM + j] = check_random();
            }
        }
        for (size_t i = 0; i < MOST; i++)
            guards.a[i * POWERS] = 3 + 2 * check_random();
        const struct rd_crossing crossing = first(&guards, 3);
        const double end = crossing.found ? crossing.time : 3;
        double least = 0;
        for (int k = 0; k < 2000; k++)
            for (size_t i = 0; i < MOST; i++)
                least = fmin(least, at(&guards, i, k * end / 2000));
        CHECK(least > -1e-12 || end == 0);
        if (crossing.found && end > 0)
            CHECK_ABS(at(&guards, crossing.which, end), 0, 1e-12,
                      "of sums up to 10, slopes of 400");
        found += crossing.found && end > 0;
    }
    CHECK(found > 15 && found < 45);
}

static void what_cannot_be_searched_says_so(void)
{
    struct guards guards;
    begin(&guards, 1);
    set_rate(&guards, 0, 0, 1);
    guards.c[0] = guards.scale[0] = 1;
    int left = 1;
    const struct rd_stop never = {0}, asked = {says_yes, &left};
    struct rd_workspace workspace = {0};
    struct rd_crossing crossing;
    rd_crossing_first(&guards.course, guards.scale, 1, &never, &workspace, &crossing);
    const size_t needed = workspace.used;
    workspace = (struct rd_workspace){malloc(needed), needed - 1, 0};
    CHECK_INT(rd_crossing_first(&guards.course, guards.scale, 1, &never, &workspace, &crossing),
              RD_NO_MEMORY);
    workspace = (struct rd_workspace){workspace.base, needed, 0};
    CHECK_INT(rd_crossing_first(&guards.course, guards.scale, 1, &asked, &workspace, &crossing),
              RD_INTERRUPTED);
    workspace.used = 0;
    guards.c[0] = 1e308;
    set_rate(&guards, 0, 0, 1e10);
    CHECK_INT(rd_crossing_first(&guards.course, guards.scale, 1, &never, &workspace, &crossing),
              RD_OVERFLOW);
    free(workspace.base);
}

int main(void)
{
    cosine_falls_below_zero_after_a_quarter();
    the_shortest_dip_is_seen();
    what_grows_with_time_is_seen();
    what_begins_below_zero_is_there_at_once();
    high_powers_of_time_are_told_by_taylor();
    random_guards_fall_where_they_are_first_seen_below();
    what_cannot_be_searched_says_so();
    return check_report("test_crossing");
}
