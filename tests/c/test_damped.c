/* Rates of damped motion against closed forms. */
#include "base/complex.h"
#include "chains.h"
#include "check.h"
#include "damped/circle.h"
#include "damped/clusters.h"
#include "damped/powers.h"
#include "damped/search.h"
#include "damped/winding.h"

#include <string.h>

enum { ROOM = 300 };

static const double PI = 3.14159265358979323846;

/* a continuous string of 1.5 m, both ends held or the right one free; its waves [m/s] and impedance */
static const double T = 300, MU = 0.2, LENGTH = 1.5;

static struct rope make_string(const char *right)
{
    return rope_make(&(struct recipe){.kind = RD_CONTINUOUS,
                                      .elements = 1,
                                      .coordinates = "z",
                                      .length = LENGTH,
                                      .tension = T,
                                      .inertia = {[RD_Z] = MU},
                                      .left = "z",
                                      .right = right});
}

static double omega_1(void)
{
    return PI * sqrt(T / MU) / LENGTH;
}

/* what only dashpots damp */
static struct rd_damping plain(void)
{
    return (struct rd_damping){.constant = {1, 1, 1, 0, 0}, .linear = {[RD_DASHPOTS] = 1}};
}

/* --- the circle ------------------------------------------------------------------------------ */

/* a walk around a circle that has `known` roots +-i k omega_1 taken out of its two moments */
static bool wind(const struct rd_chain *chain, double radius, size_t known, size_t *count,
                 double complex *moment)
{
    const struct rd_damping damping = plain();
    const struct rd_stop stop = {0};
    struct rd_workspace space = {0};
    struct rd_function f;
    struct rd_winding w;
    double complex root[ROOM];
    bool found;
    rd_function_take(chain, &damping, stop, 1.4 * radius, &space, &f);
    CHECK_INT(rd_winding_take(&f, 0, radius, &space, &w), RD_NO_MEMORY);
    space = exact_workspace(space.used);
    CHECK(rd_function_take(chain, &damping, stop, 1.4 * radius, &space, &f));
    CHECK_INT(rd_winding_take(&f, 0, radius, &space, &w), RD_OK);
    CHECK_INT(rd_winding_walk(&f, &w, &found), RD_OK);
    *count = w.count;
    for (size_t k = 0; k < known; k++) {
        root[2 * k] = I * omega_1() * (double)(k + 1);
        root[2 * k + 1] = conj(root[2 * k]);
    }
    if (found)
        rd_winding_moments(&w, 2 * known, root, 2, moment);
    free(space.base);
    return found;
}

static void test_winding_counts_the_roots_of_a_string_however_many(void)
{
    struct rope rope = make_string("z");
    for (size_t waves = 1; waves < 140; waves += 23) {
        double complex moment[2];
        size_t count;
        const double ratio = (double)waves / ((double)waves + 0.37);
        CHECK(wind(&rope.chain, (double)waves / ratio * omega_1(), waves - 1, &count, moment));
        CHECK_INT(count, 2 * waves);
        /* all are known but the highest pair */
        CHECK_ABS(cabs(moment[0]), 0, 0.1, "some per cent");
        CHECK_ABS(cabs(moment[1] + 2 * ratio * ratio), 0, 0.1, "some per cent");
    }
    double complex moment[2];
    size_t count;
    CHECK(!wind(&rope.chain, 4 * omega_1(), 0, &count, moment));
    rope_free(&rope);
}

/* --- numbers --------------------------------------------------------------------------------- */

static void test_numbers_follow_from_sums_of_their_powers(void)
{
    const double complex root[] = {0.5, -0.2 + 0.1 * I, 0.3 * I, -0.6};
    enum { COUNT = sizeof root / sizeof *root };
    double complex moment[COUNT] = {0}, found[COUNT];
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; i < COUNT; i++)
            moment[k] += cpow(root[i], k + 1);
    CHECK_INT(rd_powers_invert(COUNT, moment, found), RD_OK);
    for (int i = 0; i < COUNT; i++) {
        double nearest = INFINITY;
        for (int j = 0; j < COUNT; j++)
            nearest = fmin(nearest, cabs(found[j] - root[i]));
        CHECK_ABS(nearest, 0, 100 * EPS, "of coefficients, over a product of distances of 0.1");
    }
    moment[1] = NAN;
    CHECK_INT(rd_powers_invert(COUNT, moment, found), RD_NO_CONVERGENCE);
}

static void test_roots_near_each_other_are_a_cluster(void)
{
    const double complex root[] = {0, 1e-8, 1, 1 + 1e-8 * I, 1 + 2e-8 * I, 2};
    size_t group[6];
    rd_clusters_find(6, root, 1, 1e-6, group);
    CHECK(group[0] == group[1] && group[2] == group[3] && group[3] == group[4]);
    CHECK(group[0] != group[2] && group[2] != group[5] && group[0] != group[5]);
    CHECK_REL(rd_clusters_gap(6, root, group, group[0], 1), 1 - 1e-8, 4 * EPS, "rounding");
    CHECK_EXACT(rd_clusters_gap(6, root, group, group[5], 0.5), 0.5);
    /* what is 1e-8 apart is told apart at 1e-9 */
    rd_clusters_find(6, root, 1, 1e-9, group);
    for (size_t i = 0; i < 6; i++)
        CHECK_INT(group[i], i);
}

/* --- the search ------------------------------------------------------------------------------ */

struct answer {
    double complex value[ROOM];
    double error[ROOM];
};

/* in memory of exactly its size less so many bytes, from the undamped rates of the string */
static enum rd_status search_less(struct rd_search *search, struct answer *answer, size_t less)
{
    double complex guess[40];
    for (size_t k = 0; k < 20; k++) {
        guess[2 * k] = I * omega_1() * (double)(k + 1);
        guess[2 * k + 1] = conj(guess[2 * k]);
    }
    struct rd_workspace space = {0};
    search->edge =
        less > 0 ? search->radius : INFINITY; /* one circle, as large as it is measured */
    search->horizon = INFINITY;
    search->guesses = sizeof guess / sizeof *guess;
    search->guess = guess;
    search->value = answer->value;
    search->error = answer->error;
    const enum rd_status measured = rd_search(search, &space);
    if (measured != RD_NO_MEMORY)
        return measured;
    space = exact_workspace(space.used - less);
    const enum rd_status status = rd_search(search, &space);
    free(space.base);
    return status;
}

/* cosh x + (c/Z) sinh x = 0 of x = s L/v: x = log((c - Z)/(c + Z))/2 + i k pi, from k = 1/2 for c < Z */
static double complex exact(double c, int k)
{
    const double Z = sqrt(T * MU), size = log(fabs(c - Z) / (c + Z)) / 2;
    return CMPLX(size / PI, c < Z ? k + 0.5 : k) * omega_1();
}

static void test_string_before_a_dashpot(double ratio)
{
    struct rope rope = make_string("");
    double damping[MORE] = {[RIGHT_END] = ratio * sqrt(T * MU)};
    rope.chain.damping = damping;
    struct answer answer;
    struct rd_search search = {
        .chain = &rope.chain, .damping = plain(), .radius = 6.2 * omega_1(), .room = 32};
    CHECK_INT(search_less(&search, &answer, 0), RD_OK);
    CHECK(search.certified);
    CHECK_INT(search.mirror, RD_CONJUGATE);
    CHECK_INT(search.count, ratio < 1 ? 12 : 13);
    CHECK_INT(search.found, ratio < 1 ? 6 : 7);
    for (int k = 0; k < (int)search.found; k++) {
        const double complex s = exact(damping[RIGHT_END], k);
        bool found = false;
        for (size_t i = 0; i < search.found; i++)
            found = found || cabs(answer.value[i] - s) <= answer.error[i] + 8 * EPS * cabs(s);
        CHECK(found);
    }
    CHECK_INT(search_less(&search, &answer, 1), RD_NO_MEMORY);
    search.room = 11;
    CHECK_INT(search_less(&search, &answer, 0), RD_NO_MEMORY);
    CHECK_INT(search.count, ratio < 1 ? 12 : 13);
    rope_free(&rope);
}

/* sections and springs count nothing in a string: a loss of the tension turns all rates */
static void test_complex_tension_has_opposite_roots(void)
{
    struct rope rope = make_string("z");
    struct answer answer;
    struct rd_search search = {
        .chain = &rope.chain, .damping = plain(), .radius = 6.4 * omega_1(), .room = 32};
    search.damping.constant[RD_STRING] = CMPLX(1, 0.2);
    CHECK_INT(search_less(&search, &answer, 0), RD_OK);
    CHECK(search.certified);
    CHECK_INT(search.mirror, RD_OPPOSITE);
    CHECK_INT(search.count, 12);
    CHECK_INT(search.found, 6);
    for (int k = 1; k <= 6; k++) {
        const double complex s = I * (double)k * omega_1() * csqrt(CMPLX(1, 0.2));
        bool found = false;
        for (size_t i = 0; i < search.found; i++)
            found = found || cabs(answer.value[i] - s) <= answer.error[i] + 8 * EPS * cabs(s);
        CHECK(found);
    }
    /* in proportion to velocity as well: no root tells of another one */
    search.damping.linear[RD_MASS] = 0.1 * omega_1();
    CHECK_INT(search_less(&search, &answer, 0), RD_OK);
    CHECK(search.certified);
    CHECK_INT(search.mirror, RD_NO_MIRROR);
    CHECK_INT(search.found, search.count);
    rope_free(&rope);
}

/* one mass between two strings with a dashpot: m s^2 + c s + k = 0 */
static void test_two_real_rates_that_meet(void)
{
    struct rope rope = rope_make(&(struct recipe){.kind = RD_RIGID,
                                                  .elements = 2,
                                                  .coordinates = "z",
                                                  .length = 1,
                                                  .tension = 2,
                                                  .inertia = {[RD_Z] = 1},
                                                  .left = "z",
                                                  .right = "z"});
    double damping[MORE] = {0};
    rope.chain.damping = damping;
    const double c[] = {3.9, 4, 4 + 1e-9, 4.1, 40};
    for (size_t k = 0; k < sizeof c / sizeof *c; k++) {
        const double complex root = csqrt(c[k] * c[k] / 4 - 4), fast = -c[k] / 2 - root;
        struct answer answer;
        struct rd_search search = {
            .chain = &rope.chain, .damping = plain(), .radius = 60, .room = 8};
        damping[INNER] = c[k];
        CHECK_INT(search_less(&search, &answer, 0), RD_OK);
        CHECK(search.certified);
        CHECK_INT(search.count, 2);
        for (size_t i = 0; i < search.found; i++) {
            const double off = fmin(cabs(answer.value[i] - fast), cabs(answer.value[i] - 4 / fast));
            CHECK(off <= answer.error[i] || c[k] < 4);
        }
    }
    rope_free(&rope);
}

/* rounding of c/Z = 1 alone puts roots anywhere */
static void test_matched_dashpot_is_not_certified(void)
{
    struct rope rope = make_string("");
    double damping[MORE] = {[RIGHT_END] = sqrt(T * MU)};
    rope.chain.damping = damping;
    struct answer answer;
    struct rd_search search = {
        .chain = &rope.chain, .damping = plain(), .radius = 20.2 * omega_1(), .room = 64};
    CHECK_INT(search_less(&search, &answer, 0), RD_OK);
    CHECK(!search.certified);
    rope_free(&rope);
}

static void test_search_ends_where_it_is_asked_to(void)
{
    struct rope rope = make_string("z");
    struct answer answer;
    int left = 3;
    struct rd_search search = {.chain = &rope.chain,
                               .damping = plain(),
                               .stop = {says_yes, &left},
                               .radius = 6.4 * omega_1(),
                               .room = 32};
    CHECK_INT(search_less(&search, &answer, 0), RD_INTERRUPTED);
    CHECK_INT(left, 0);
    /* waves too short to be walked, and more arcs than there can be */
    search.stop = (struct rd_stop){0};
    search.radius = 1e12;
    CHECK_INT(search_less(&search, &answer, 0), RD_SHORT_WAVES);
    search.radius = NAN;
    CHECK_INT(search_less(&search, &answer, 0), RD_SHORT_WAVES);
    rope_free(&rope);
}

int main(void)
{
    test_winding_counts_the_roots_of_a_string_however_many();
    test_numbers_follow_from_sums_of_their_powers();
    test_roots_near_each_other_are_a_cluster();
    test_string_before_a_dashpot(0.3);
    test_string_before_a_dashpot(1.7);
    test_complex_tension_has_opposite_roots();
    test_two_real_rates_that_meet();
    test_matched_dashpot_is_not_certified();
    test_search_ends_where_it_is_asked_to();
    return check_report("damped");
}
