/* Uniform ropes in closed form: references, index, counts, and rows that do not know each other. */
#include "closed/closed.h"

#include <string.h>

#include "check.h"

static const double PI = 3.14159265358979323846;

enum { MOST = 20, ROWS = 21 };

struct found {
    double omega[ROWS][MOST], error[ROWS][MOST], slope[ROWS][MOST][RD_BENT_NUMBERS];
    uint8_t certified[ROWS];
};

/* ropes whose values are their numbers */
static struct rd_ropes ropes_of(const double *number, size_t numbers)
{
    static double same[RD_BENT_NUMBERS * RD_BENT_NUMBERS];
    memset(same, 0, sizeof same);
    for (size_t j = 0; j < numbers; j++)
        same[j * numbers + j] = 1;
    return (struct rd_ropes){number, numbers, same};
}

/* MOST modes of bent spans */
static void solve(const double *values, size_t rows, struct found *found)
{
    memset(found, 0, sizeof *found);
    const struct rd_ropes ropes = ropes_of(values, RD_BENT_NUMBERS);
    const struct rd_closed_modes modes = {MOST, found->omega[0], found->error[0],
                                          found->slope[0][0], found->certified};
    rd_bent_modes(&ropes, 0, rows, &modes);
}

/* omega L^2 sqrt(mu/B) of modes 1, 2, 3, 10, 20; roots found with 90 digits in mpmath, certified by a
   change of sign within 1e-70 */
static void tensed_beams_have_their_frequencies_to_the_last_digit(void)
{
    static const struct {
        double p, beta, omega[5];
    } reference[] = {
        {0,
         INFINITY,
         {22.37328544806132392, 61.67282286792024525, 120.9033917271237795, 1088.123885220101164,
          4147.701249557802959}},
        {100,
         INFINITY,
         {40.99316099896628056, 91.26431110070636085, 156.3954926814894144, 1134.117484348911006,
          4195.868656450098144}},
        {100,
         0,
         {32.92976664270395796, 74.20503498402101314, 129.5097692636915331, 1035.754292460773709,
          3997.529079504483642}},
        {91627.29,
         INFINITY,
         {957.3367362876413662, 1914.983424162017058, 2873.249842801351724, 9624.373532245903153,
          19554.52869586837619}},
    };
    static const size_t mode[] = {0, 1, 2, 9, 19};
    for (size_t i = 0; i < 4; i++) {
        const double p = reference[i].p, beta = reference[i].beta;
        const double beam[] = {1, 1, p, 1, INFINITY, beta, INFINITY, beta};
        struct found found;
        solve(beam, 1, &found);
        CHECK(found.certified[0]);
        for (size_t k = 0; k < 5; k++) {
            const double omega = reference[i].omega[k], error = found.error[0][mode[k]];
            CHECK_REL(found.omega[0][mode[k]], omega, 4 * EPS, "two roots and a product");
            CHECK_REL(found.omega[0][mode[k]], omega, error, "the error says so");
            CHECK(error < 64 * EPS);
        }
    }
}

/* first roots of 1 + cos cosh = 0 and of tan = tanh; as in any textbook */
static void free_and_pinned_ends_have_their_roots(void)
{
    const double beams[2][RD_BENT_NUMBERS] = {
        {2, 3, 0, 5, INFINITY, INFINITY, 0, 0},
        {2, 3, 0, 5, INFINITY, INFINITY, INFINITY, 0},
    };
    static const double root[] = {1.875104068711961166, 3.926602312047918823};
    struct found found;
    solve(beams[0], 2, &found);
    for (size_t i = 0; i < 2; i++) {
        CHECK(found.certified[i]);
        CHECK_REL(found.omega[i][0], root[i] * root[i] * sqrt(5.0 / 3) / 4, 8 * EPS, "as above");
    }
}

/* p from -pi^2 to nothing: omega_n^2 = n^2 pi^2 (n^2 pi^2 + p) */
static void pinned_beams_soften_until_they_buckle(void)
{
    for (int i = 1; i < 7; i++) {
        const double p = -PI * PI * (1 - pow(10, -i)), condition = pow(10, i);
        const double beam[] = {1, 1, p, 1, INFINITY, 0, INFINITY, 0};
        struct found found;
        solve(beam, 1, &found);
        CHECK(found.certified[0]);
        const double omega = PI * sqrt((double)((long double)PI * PI + p));
        CHECK_REL(found.omega[0][0], omega, 4 * condition * EPS, "condition of the first");
        CHECK(found.error[0][0] < 10 * condition * EPS);
        CHECK_REL(found.omega[0][1], 2 * PI * sqrt(4 * PI * PI + p), 8 * EPS, "two roots");
    }
}

/* modes without a positive eigenvalue are not certified; nor is what only looks like a crossing: there
   Delta < 0 on one side, and the first eigenvalue is -7.2 */
static void what_has_no_positive_eigenvalue_is_not_certified(void)
{
    const double beams[][RD_BENT_NUMBERS] = {
        {1, 1, -1.001 * PI * PI, 1, INFINITY, 0, INFINITY, 0},
        {1, 1, -5, 1, 1.657, 0, 9618, INFINITY},
        {1, 1, 10, 1, 0, 0, 0, 0},
        {1, 1, 10, 1, -1, INFINITY, 0.5, INFINITY},
        {-1, 1, 10, 1, INFINITY, 0, INFINITY, 0},
        {1, 0, 10, 1, INFINITY, 0, INFINITY, 0},
        {1, 1, (double)NAN, 1, INFINITY, 0, INFINITY, 0},
        {1, 1, 10, 1, -INFINITY, 0, INFINITY, 0},
        {1, 1, 1e300, 1, INFINITY, 5, INFINITY, 0},
        {1, 1, 10, 1, INFINITY, (double)NAN, INFINITY, 0},
    };
    enum { COUNT = sizeof beams / sizeof *beams };
    struct found found;
    int64_t count[COUNT];
    solve(beams[0], COUNT, &found);
    const struct rd_ropes ropes = ropes_of(beams[0], RD_BENT_NUMBERS);
    rd_bent_count(&ropes, 0, COUNT, 1e-3, count);
    for (size_t i = 0; i < COUNT; i++) {
        CHECK(!found.certified[i]);
        if (i >= 4 && i != 8)
            CHECK_INT(count[i], -1);
    }
    CHECK_INT(count[0], 1);
    CHECK(count[1] != 0);   /* the one that grows, or not certain */
    CHECK_INT(count[2], 1); /* it slides; tension holds what turns */
}

/* of either sign, at both ends, under tension and compression */
static void fill(double *beam)
{
    beam[RD_BENT_LENGTH] = 2 + check_random();
    beam[RD_BENT_INERTIA] = 2 + check_random();
    beam[RD_BENT_STIFFNESS] = 2 + check_random();
    const double p = pow(10, 3 * check_random());
    beam[RD_BENT_TENSION] = check_random() < -0.4 ? -p : p;
    for (int j = RD_BENT_Z0; j < RD_BENT_NUMBERS; j++) {
        const double spring = pow(10, 3 * check_random()), kind = check_random();
        beam[j] = kind < -0.6 ? (double)INFINITY : kind < -0.4 ? 0 : kind < 0 ? -spring : spring;
    }
}

static void counts_step_at_each_mode(void)
{
    size_t seen = 0;
    for (int i = 0; i < 200; i++) {
        double beam[RD_BENT_NUMBERS];
        fill(beam);
        struct found found;
        solve(beam, 1, &found);
        const struct rd_ropes ropes = ropes_of(beam, RD_BENT_NUMBERS);
        for (size_t k = 0; k < MOST && found.certified[0]; k++) {
            int64_t below, above;
            const double omega = found.omega[0][k], off = 1e-12 + 8 * found.error[0][k];
            rd_bent_count(&ropes, 0, 1, omega * (1 - off), &below);
            rd_bent_count(&ropes, 0, 1, omega * (1 + off), &above);
            CHECK_INT(below, k);
            CHECK_INT(above, k + 1);
            seen++;
        }
    }
    CHECK(seen > 1000);
}

/* against differences over 1e-5 of each number */
static void slopes_are_those_of_frequencies(void)
{
    size_t seen = 0;
    for (int i = 0; i < 100; i++) {
        double beam[RD_BENT_NUMBERS];
        fill(beam);
        struct found found, more, less;
        solve(beam, 1, &found);
        for (int j = 0; j < RD_BENT_NUMBERS; j++) {
            const double x = beam[j], step = 1e-5 * x;
            if (!isfinite(x) || x == 0)
                continue;
            beam[j] = x + step;
            solve(beam, 1, &more);
            beam[j] = x - step;
            solve(beam, 1, &less);
            beam[j] = x;
            for (size_t k = 0; k < 4; k++) {
                /* of the softest modes logarithms are not nearly linear in any number */
                if (!found.certified[0] || !more.certified[0] || !less.certified[0] ||
                    more.error[0][k] + less.error[0][k] > 1e-13)
                    continue;
                const double moved = log(more.omega[0][k] / less.omega[0][k]) / 2e-5;
                CHECK_ABS(found.slope[0][k][j] * x, moved, 1e-6, "steps of 1e-5");
                seen++;
            }
        }
    }
    CHECK(seen > 500);
}

static void rows_keep_their_bits_in_any_company(void)
{
    double beams[ROWS][RD_BENT_NUMBERS];
    for (size_t i = 0; i < ROWS; i++)
        fill(beams[i]);
    struct found all, alone;
    solve(beams[0], ROWS, &all);
    for (size_t i = 0; i < ROWS; i++) {
        solve(beams[i], 1, &alone);
        CHECK_INT(all.certified[i], alone.certified[0]);
        CHECK(memcmp(all.omega[i], alone.omega[0], sizeof all.omega[i]) == 0);
        CHECK(memcmp(all.error[i], alone.error[0], sizeof all.error[i]) == 0);
        CHECK(memcmp(all.slope[i], alone.slope[0], sizeof all.slope[i]) == 0);
    }
}

/* d/dv = sum of d/d number times d number/dv, in the order of the numbers */
static void slopes_are_by_what_numbers_follow_from(void)
{
    const double beam[] = {2, 3, 60, 5, INFINITY, INFINITY, INFINITY, 0};
    double jacobian[RD_BENT_NUMBERS][2] = {0};
    jacobian[RD_BENT_TENSION][1] = 1;
    jacobian[RD_BENT_INERTIA][1] = -2;
    const struct rd_ropes ropes = {beam, 2, jacobian[0]};
    double omega, error, slope[2] = {9, 9};
    uint8_t certified;
    rd_bent_modes(&ropes, 0, 1, &(struct rd_closed_modes){1, &omega, &error, slope, &certified});
    struct found found;
    solve(beam, 1, &found);
    CHECK_EXACT(omega, found.omega[0][0]);
    CHECK_EXACT(slope[0], 0);
    const double *by = found.slope[0][0];
    CHECK_EXACT(slope[1], -2 * by[RD_BENT_INERTIA] + by[RD_BENT_TENSION]);
    /* without slopes the frequencies are the same */
    const struct rd_ropes alone = {beam, 0, NULL};
    rd_bent_modes(&alone, 0, 1, &(struct rd_closed_modes){1, &omega, &error, NULL, &certified});
    CHECK_EXACT(omega, found.omega[0][0]);
}

/* K tan K = sigma for one held and one sprung end; strings between held and free ends by their names */
static void strings_and_rods_have_their_roots(void)
{
    const double rope[][RD_PLAIN_NUMBERS] = {
        {2, 3, 12, INFINITY, INFINITY}, {2, 3, 12, INFINITY, 0},   {2, 3, 12, 0, 6.0},
        {2, 3, 12, INFINITY, -3},       {2, 3, 12, INFINITY, -12},
    };
    const struct rd_ropes ropes = ropes_of(rope[0], RD_PLAIN_NUMBERS);
    double omega[10], error[10], slope[10 * RD_PLAIN_NUMBERS];
    uint8_t certified[5];
    int64_t count[5];
    const struct rd_closed_modes modes = {2, omega, error, slope, certified};
    rd_plain_modes(&ropes, 0, 5, &modes);
    CHECK_REL(omega[0], PI, 4 * EPS, "a root and a product");
    CHECK_REL(omega[1], 2 * PI, 4 * EPS, "a root and a product");
    CHECK_REL(omega[2], PI / 2, 4 * EPS, "a root and a product");
    CHECK_REL(omega[5] * tan(omega[5]), 1, 64 * EPS, "a tangent");
    CHECK_REL(omega[6] / tan(omega[6]), 0.5, 64 * EPS, "a tangent");
    CHECK(certified[0] && certified[1] && certified[2] && certified[3] && !certified[4]);
    CHECK_REL(slope[RD_PLAIN_LENGTH], -0.5, 4 * EPS, "1/L");
    CHECK_REL(slope[RD_PLAIN_STIFFNESS], 0.5 / 12, 4 * EPS, "half");
    CHECK_REL(slope[RD_PLAIN_INERTIA], -0.5 / 3, 4 * EPS, "half");
    rd_plain_count(&ropes, 0, 5, 3, count);
    static const int64_t below[] = {0, 1, 1, 1, 1};
    for (size_t i = 0; i < 5; i++)
        CHECK_INT(count[i], below[i]);
}

int main(void)
{
    tensed_beams_have_their_frequencies_to_the_last_digit();
    free_and_pinned_ends_have_their_roots();
    pinned_beams_soften_until_they_buckle();
    what_has_no_positive_eigenvalue_is_not_certified();
    counts_step_at_each_mode();
    slopes_are_those_of_frequencies();
    rows_keep_their_bits_in_any_company();
    slopes_are_by_what_numbers_follow_from();
    strings_and_rods_have_their_roots();
    return check_report("test_closed");
}
