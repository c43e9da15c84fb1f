/* Chains of uniform spans in closed form: references, index, counts, slopes, places that do not know
   each other. */
#include "closed/chains.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

static const double PI = 3.14159265358979323846;

enum { SPANS = 6, NUMBERS = 8 * SPANS + 4, MOST = 10, ROWS = 11 };

static const uint8_t NO_HINGE[SPANS + 1];
static double each_number[NUMBERS * NUMBERS];

struct found {
    double omega[ROWS][MOST], error[ROWS][MOST], slope[ROWS * MOST * NUMBERS];
    uint8_t certified[ROWS];
};

/* slopes by each number */
static struct rd_chains chains_of(const double *number, size_t spans, const uint8_t *hinge,
                                  size_t numbers)
{
    memset(each_number, 0, sizeof each_number);
    for (size_t j = 0; j < numbers; j++)
        each_number[j * numbers + j] = 1;
    return (struct rd_chains){spans, number, hinge, numbers, each_number};
}

static struct rd_workspace workspace_for(size_t spans)
{
    struct rd_workspace workspace = {.size = rd_chain_work(spans, MOST)};
    workspace.base = malloc(workspace.size);
    return workspace;
}

static void solve(const double *number, size_t spans, const uint8_t *hinge, size_t rows, _Bool bent,
                  struct found *found)
{
    memset(found, 0, sizeof *found);
    const size_t numbers = bent ? rd_bent_numbers(spans) : rd_plain_numbers(spans);
    const struct rd_chains chains = chains_of(number, spans, hinge, numbers);
    const struct rd_closed_modes modes = {MOST, found->omega[0], found->error[0], found->slope,
                                          found->certified};
    struct rd_workspace workspace = workspace_for(spans);
    (bent ? rd_bent_chain_modes : rd_plain_chain_modes)(&chains, 0, rows, &modes, &workspace);
    free(workspace.base);
}

static int64_t count_below(const double *number, size_t spans, const uint8_t *hinge, _Bool bent,
                           double omega)
{
    const struct rd_chains chains = {spans, number, hinge, 0, NULL};
    struct rd_workspace workspace = workspace_for(spans);
    int64_t count;
    (bent ? rd_bent_chain_count : rd_plain_chain_count)(&chains, 0, 1, omega, &count, &workspace);
    free(workspace.base);
    return count;
}

/* a beam of length 1, mu = B = 1, cut into spans of unlike lengths, between ends {z, beta} */
static void cut_beam(double *number, size_t spans, double p, const double *ends)
{
    memset(number, 0, rd_bent_numbers(spans) * sizeof *number);
    const double all = (double)(spans * (spans + 1)) / 2;
    for (size_t e = 0; e < spans; e++) {
        const double span[] = {(double)(e + 1) / all, 1, p, 1};
        memcpy(number + 4 * e, span, sizeof span);
    }
    memcpy(number + 4 * spans + 2, ends, 2 * sizeof *ends);
    memcpy(number + 8 * spans + 2, ends + 2, 2 * sizeof *ends);
}

/* what closed/bent_span.c says, in any number of spans */
static void a_cut_span_is_the_whole_one(void)
{
    static const double ends[][4] = {
        {INFINITY, INFINITY, INFINITY, INFINITY},
        {INFINITY, 0, INFINITY, 30},
        {INFINITY, INFINITY, 0, 0},
        {500, -0.5, 2000, INFINITY},
    };
    static const double p[] = {-5, 0, 100, 91627.29};
    for (size_t i = 0; i < 16; i++) {
        const double *end = ends[i % 4];
        double number[NUMBERS], omega[MOST], error[MOST];
        const double whole[] = {1, 1, p[i / 4], 1, end[0], end[1], end[2], end[3]};
        uint8_t certified;
        const struct rd_ropes ropes = {whole, 0, NULL};
        rd_bent_modes(&ropes, 0, 1,
                      &(struct rd_closed_modes){MOST, omega, error, NULL, &certified});
        for (size_t spans = 1; certified && spans <= SPANS; spans++) {
            struct found found;
            cut_beam(number, spans, p[i / 4], end);
            solve(number, spans, NO_HINGE, 1, 1, &found);
            CHECK(found.certified[0]);
            for (size_t k = 0; k < MOST; k++) {
                const double bound = error[k] + found.error[0][k];
                CHECK_REL(found.omega[0][k], omega[k], bound, "both errors");
                CHECK(found.error[0][k] < 1e-12);
            }
        }
    }
}

/* clamped and free, or pinned, half beams; as in any textbook */
static void hinges_and_supports_part_a_beam_into_halves(void)
{
    static const double free_end = 1.875104068711961166, pinned_end = 3.926602312047918823;
    const double clamped[] = {INFINITY, INFINITY, INFINITY, INFINITY};
    const double pinned[] = {INFINITY, 0, INFINITY, 0};
    const uint8_t hinge[] = {0, 1, 0};
    double number[20];
    struct found found;
    cut_beam(number, 2, 0, clamped);
    number[0] = number[4] = 0.5;
    solve(number, 2, hinge, 1, 1, &found);
    CHECK(found.certified[0]);
    CHECK_REL(found.omega[0][0], 4 * free_end * free_end, 32 * EPS, "three scatterings");
    CHECK_REL(found.omega[0][1], 4 * pinned_end * pinned_end, 32 * EPS, "three scatterings");
    cut_beam(number, 2, 0, pinned);
    number[0] = number[4] = 0.5;
    number[8 + 4 + 2] = INFINITY;
    solve(number, 2, NO_HINGE, 1, 1, &found);
    CHECK(found.certified[0]);
    CHECK_REL(found.omega[0][0], 4 * PI * PI, 32 * EPS, "three scatterings");
    CHECK_REL(found.omega[0][1], 4 * pinned_end * pinned_end, 32 * EPS, "three scatterings");
    CHECK_EXACT(found.slope[8 + 4 + 2], 0);
}

/* a clamp, or a hinge on a support, parts a beam for good: equal halves have pairs, each mode moves
   in one of them */
static void a_split_beam_has_its_modes_twice(void)
{
    const double clamped[] = {INFINITY, INFINITY, INFINITY, INFINITY};
    const uint8_t hinge[] = {0, 1, 0};
    for (int hinged = 0; hinged < 2; hinged++) {
        double number[20], half[12];
        struct found found, one;
        cut_beam(number, 2, 10, clamped);
        number[0] = number[4] = 0.5;
        number[8 + 4 + 2] = INFINITY;
        number[8 + 4 + 3] = hinged ? 0 : INFINITY;
        solve(number, 2, hinged ? hinge : NO_HINGE, 1, 1, &found);
        CHECK(found.certified[0]);
        cut_beam(half, 1, 10, clamped);
        half[0] = 0.5;
        solve(half, 1, NO_HINGE, 1, 1, &one);
        for (size_t k = 0; k < MOST && !hinged; k++)
            CHECK_REL(found.omega[0][k], one.omega[0][k / 2], 4 * EPS, "the same span");
        for (size_t k = 0; k < MOST; k++) {
            const double *slope = found.slope + k * 20;
            CHECK((slope[0] == 0) != (slope[4] == 0));
        }
        const uint8_t *parting = hinged ? hinge : NO_HINGE;
        CHECK_INT(count_below(number, 2, parting, 1, found.omega[0][3] * (1 + 1e-9)), 4);
    }
}

/* m omega^2 = 2 D k cot(kl) where two strings l carry a mass and it moves, kl = n pi where not */
static void a_mass_on_a_string_slows_what_moves_it(void)
{
    const double number[] = {1, 3, 12, 1, 3, 12, 0, INFINITY, 5, 0, 0, INFINITY};
    struct found found;
    solve(number, 2, NO_HINGE, 1, 0, &found);
    CHECK(found.certified[0]);
    for (size_t k = 0; k < MOST; k++) {
        const double omega = found.omega[0][k], kl = omega / 2;
        if (k % 2)
            CHECK_REL(kl, (double)(k + 1) / 2 * PI, 16 * EPS, "two scatterings");
        else
            CHECK_REL(5 * omega * omega * sin(kl), 24 * kl * cos(kl), 1e-12, "a cotangent");
        const double off = 1e-12;
        CHECK_INT(count_below(number, 2, NO_HINGE, 0, omega * (1 - off)), k);
        CHECK_INT(count_below(number, 2, NO_HINGE, 0, omega * (1 + off)), k + 1);
    }
}

/* n pi/l of either side of a support, whose slopes by the length of the other side are 0 */
static void a_held_string_has_the_modes_of_both_sides(void)
{
    static const double side[] = {1, 0.3};
    /* of 1: n pi; of 0.3: n pi/0.3 */
    static const int of[] = {0, 0, 0, 1, 0, 0};
    const double number[] = {side[0], 3, 3, side[1], 3, 3, 0, INFINITY, 0, INFINITY, 0, INFINITY};
    struct found found;
    solve(number, 2, NO_HINGE, 1, 0, &found);
    CHECK(found.certified[0]);
    int n[2] = {0};
    for (size_t k = 0; k < 6 && k < MOST; k++) {
        const double omega = found.omega[0][k], l = side[of[k]];
        const double *slope = found.slope + k * rd_plain_numbers(2);
        CHECK_REL(omega, ++n[of[k]] * PI / l, 16 * EPS, "a root and a quotient");
        CHECK_REL(slope[of[k] ? 3 : 0], -1 / l, 64 * EPS, "1/l");
        CHECK_EXACT(slope[of[k] ? 0 : 3], 0);
        CHECK_INT(count_below(number, 2, NO_HINGE, 0, omega * (1 - 1e-12)), k);
        CHECK_INT(count_below(number, 2, NO_HINGE, 0, omega * (1 + 1e-12)), k + 1);
    }
}

/* nothing moves it, what grows, what has no meaning */
static void what_has_no_positive_eigenvalue_is_not_certified(void)
{
    const double pinned[] = {INFINITY, 0, INFINITY, 0}, nothing[] = {0, 0, 0, 0};
    const double *end[] = {pinned, nothing, pinned, pinned, pinned, pinned};
    const double p[] = {-1.001 * PI * PI, 10, 10, 10, 10, (double)NAN};
    for (size_t i = 0; i < 6; i++) {
        double number[NUMBERS];
        struct found found;
        cut_beam(number, 3, p[i], end[i]);
        if (i == 2)
            number[0] = -number[0];
        if (i == 3)
            number[8 * 3 + 2] = -INFINITY;
        if (i == 4)
            number[4 * 3] = -1;
        solve(number, 3, NO_HINGE, 1, 1, &found);
        CHECK(!found.certified[0]);
        const int64_t count = count_below(number, 3, NO_HINGE, 1, 1e-3);
        CHECK_INT(count, i < 2 ? 1 : -1);
    }
}

/* unlike spans under tension and compression, masses, springs of either sign */
static void fill(double *number, size_t spans)
{
    for (size_t e = 0; e < spans; e++) {
        const double T = pow(10, 2 * check_random()), kind = check_random();
        const double span[] = {0.6 + 0.4 * check_random(), pow(10, check_random()),
                               kind < -0.8   ? 0
                               : kind < -0.3 ? -T
                                             : T,
                               pow(10, check_random())};
        memcpy(number + 4 * e, span, sizeof span);
    }
    for (size_t s = 0; s <= spans; s++) {
        double *here = number + 4 * (spans + s);
        here[0] = check_random() > 0 ? 1 + check_random() : 0;
        here[1] = check_random() > 0.5 ? 0.02 + 0.01 * check_random() : 0;
        for (int j = 2; j < 4; j++) {
            const double spring = pow(10, 2 * check_random()), kind = check_random();
            here[j] = kind < -0.7  ? (double)INFINITY
                      : kind < 0.4 ? 0
                      : kind < 0.6 ? -spring
                                   : spring;
        }
    }
}

static void counts_step_at_each_mode(void)
{
    const uint8_t hinge[] = {0, 0, 1, 0, 0};
    size_t seen = 0;
    for (int i = 0; i < 150; i++) {
        double number[NUMBERS];
        struct found found;
        fill(number, 4);
        const uint8_t *hinges = i % 3 ? NO_HINGE : hinge;
        solve(number, 4, hinges, 1, 1, &found);
        for (size_t k = 0; k < MOST && found.certified[0]; k++) {
            const double omega = found.omega[0][k], off = 1e-12 + 8 * found.error[0][k];
            CHECK_INT(count_below(number, 4, hinges, 1, omega * (1 - off)), k);
            CHECK_INT(count_below(number, 4, hinges, 1, omega * (1 + off)), k + 1);
            seen++;
        }
    }
    CHECK(seen > 300);
}

/* against differences over 1e-5 of each number, of modes that are not near another */
static void slopes_are_those_of_frequencies(void)
{
    size_t seen = 0;
    for (int i = 0; i < 40; i++) {
        double number[NUMBERS];
        struct found found, more, less;
        fill(number, 3);
        const size_t numbers = rd_bent_numbers(3);
        solve(number, 3, NO_HINGE, 1, 1, &found);
        for (size_t j = 0; j < numbers && found.certified[0]; j++) {
            const double x = number[j];
            if (!isfinite(x) || x == 0)
                continue;
            number[j] = x * (1 + 1e-5);
            solve(number, 3, NO_HINGE, 1, 1, &more);
            number[j] = x * (1 - 1e-5);
            solve(number, 3, NO_HINGE, 1, 1, &less);
            number[j] = x;
            for (size_t k = 1; k < 4; k++) {
                const double *omega = found.omega[0];
                const _Bool apart =
                    omega[k] > 1.01 * omega[k - 1] && 1.01 * omega[k] < omega[k + 1];
                if (!more.certified[0] || !less.certified[0] || !apart ||
                    more.error[0][k] + less.error[0][k] > 1e-13)
                    continue;
                const double moved = log(more.omega[0][k] / less.omega[0][k]) / 2e-5;
                CHECK_ABS(found.slope[k * numbers + j] * x, moved, 1e-6, "steps of 1e-5");
                seen++;
            }
        }
    }
    CHECK(seen > 300);
}

static void rows_keep_their_bits_in_any_company(void)
{
    const size_t numbers = rd_bent_numbers(4), slopes = MOST * numbers;
    double number[ROWS * NUMBERS];
    struct found all, alone;
    for (size_t i = 0; i < ROWS; i++)
        fill(number + i * numbers, 4);
    solve(number, 4, NO_HINGE, ROWS, 1, &all);
    for (size_t i = 0; i < ROWS; i++) {
        solve(number + i * numbers, 4, NO_HINGE, 1, 1, &alone);
        CHECK_INT(all.certified[i], alone.certified[0]);
        if (!all.certified[i])
            continue;
        CHECK(memcmp(all.omega[i], alone.omega[0], sizeof all.omega[i]) == 0);
        CHECK(memcmp(all.error[i], alone.error[0], sizeof all.error[i]) == 0);
        CHECK(memcmp(all.slope + i * slopes, alone.slope, slopes * sizeof *all.slope) == 0);
    }
}

int main(void)
{
    a_cut_span_is_the_whole_one();
    hinges_and_supports_part_a_beam_into_halves();
    a_split_beam_has_its_modes_twice();
    a_mass_on_a_string_slows_what_moves_it();
    a_held_string_has_the_modes_of_both_sides();
    what_has_no_positive_eigenvalue_is_not_certified();
    counts_step_at_each_mode();
    slopes_are_those_of_frequencies();
    rows_keep_their_bits_in_any_company();
    return check_report("test_closed_chain");
}
