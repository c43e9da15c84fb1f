/* Counts of eigenvalues against the inertia of the dense matrices and against closed forms. */
#include "modes/count/count.h"

#include "check.h"
#include "walked.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, LAMBDAS = 11, HEAVY = MORE, SECOND, HINGED };

static const double PI = 3.14159265358979323846;

/* every coupling that the coordinates can have, and a mass in each of them */
static const struct recipe coupled = {
    .kind = RD_TENSED,
    .elements = 9,
    .coordinates = "zb",
    .length = 0.15,
    .tension = 300,
    .section =
        {.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626, .coupling = 120, .slope = 0.3},
    .inertia = {0.0152, 0.0152, 2e-6, 3e-5},
    .left = "",
    .right = "",
    .distinct = 2,
    .more = 3,
};

/* that of a kind: differences have no kinematics for tension where they bend */
static struct recipe recipe_of(enum rd_kind kind, const char *names)
{
    struct recipe recipe = coupled;
    recipe.kind = kind;
    recipe.coordinates = names;
    if (kind == RD_DIFFERENCE && strchr(names, 'b'))
        recipe.tension = 0;
    return recipe;
}

static const char *const coordinates[] = {"z", "a", "za", "zb", "zab", "xzb", "xzab"};

/* Rounding of LAPACK on a matrix scaled to one, 40 rows: 40 EPS. Nearer to an eigenvalue than that
   the dense count says nothing; no lambda below is as near as this. */
static const double APART = 1e-12;

/* counts at many lambda of both signs are those of the dense matrix, as single nodes and gathered */
static void check_counts(struct rope *rope)
{
    double lambda[LAMBDAS], count[LAMBDAS], dense[LAMBDAS];
    for (int k = 0; k < LAMBDAS; k++)
        lambda[k] = (k % 4 == 3 ? -1 : 1) * pow(10, 4.5 + 4.5 * check_random());
    lambda[LAMBDAS - 1] = -1e-3;
    for (int k = 0; k < LAMBDAS; k++) {
        double nearest;
        dense[k] = (double)dense_count(&rope->chain, lambda[k], &nearest);
        CHECK(nearest > APART);
    }
    for (int gathered = 0; gathered < 2; gathered++) {
        struct walked walked = walked_make(&rope->chain);
        rd_count(&walked.walk, LAMBDAS, lambda, count);
        for (int k = 0; k < LAMBDAS; k++)
            CHECK_EXACT(count[k], dense[k]);
        walked_free(&walked);
        rope_gather(rope);
    }
}

static void chains_of_every_width_and_end(enum rd_kind kind, const char *names)
{
    const char *const held[] = {"", names, "z", "xa"};
    for (size_t left = 0; left < 4; left++)
        for (size_t right = 0; right < 4; right++) {
            struct recipe recipe = recipe_of(kind, names);
            recipe.left = held[left];
            recipe.right = held[right];
            struct rope rope = rope_make(&recipe);
            check_counts(&rope);
            rope_free(&rope);
        }
}

static double *of_term(const struct rope *rope, double *matrix, size_t term, char coordinate)
{
    const size_t w = rope->chain.width, i = rope_find(&rope->chain, coordinate);
    return matrix + (term * w + i) * w + i;
}

/* springs of both signs, a mass that is heavy and one beside the rope, held inner nodes and another
   element */
static void chains_with_parts(enum rd_kind kind, const char *names)
{
    struct recipe recipe = recipe_of(kind, names);
    recipe.elements = 30;
    recipe.left = "z";
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    rope.length[1] = 0.4;
    rope.tension[1] = 500;
    for (size_t i = 17; i < 30; i++)
        rope.element_of[i] = 1;
    *of_term(&rope, rope.mass, HEAVY, 'z') = 1e4;
    *of_term(&rope, rope.stiffness, HEAVY, 'z') = 4000;
    *of_term(&rope, rope.stiffness, HINGED, 'z') = -700;
    *of_term(&rope, rope.stiffness, HINGED, 'b') = -20;
    /* eccentric by 10 mm */
    const size_t z = rope_find(&rope.chain, 'z'), b = rope_find(&rope.chain, 'b');
    rope.mass[HINGED * w * w + z * w + b] = rope.mass[HINGED * w * w + b * w + z] = 1e-5;
    rope.held[SECOND * w + z] = 1;
    rope.term_of[6] = HEAVY;
    rope.term_of[13] = rope.term_of[14] = SECOND;
    rope.term_of[22] = HINGED;
    check_counts(&rope);
    rope_free(&rope);
}

/* between a node and its element, at the left end and next to each other, elastic and free */
static void hinged_chains(enum rd_kind kind, const char *names, double compliance)
{
    double hinge[6 * W] = {0};
    struct recipe recipe = recipe_of(kind, names);
    recipe.left = "zb";
    recipe.right = names;
    recipe.elements = 14;
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    hinge[LEFT_END * w + rope_find(&rope.chain, 'b')] = compliance;
    hinge[HINGED * w + rope_find(&rope.chain, 'b')] = compliance;
    rope.chain.hinge = hinge;
    rope.term_of[5] = rope.term_of[6] = rope.term_of[13] = HINGED;
    check_counts(&rope);
    rope_free(&rope);
}

/* up to some critical loads of the whole and of single elements, struts among them */
static void compressed_chains(enum rd_kind kind, const char *names)
{
    static const double load[] = {20, 500, 1500, 2500, 5000, 12000, 30000};
    for (size_t k = 0; k < sizeof load / sizeof *load; k++) {
        struct recipe recipe = recipe_of(kind, names);
        recipe.tension = -load[k];
        recipe.section.slope = strchr(names, 'a') ? 0.3 : 0;
        recipe.left = "z";
        recipe.right = "z";
        struct rope rope = rope_make(&recipe);
        check_counts(&rope);
        rope_free(&rope);
    }
}

static void check_string(const struct rope *rope)
{
    static const size_t mode[] = {1, 2, 3, 10, 100, 499, 500, 501, 998, 999};
    enum { MODES = sizeof mode / sizeof *mode };
    double lambda[2 * MODES], count[2 * MODES];
    /* Rounding of a thousand steps, each EPS of the stiffness scaled to the wave: 1000 EPS; the
       highest lambda follow from 1 - sin^2, so that EPS of it is all they know. */
    for (int k = 0; k < MODES; k++) {
        lambda[2 * k] = long_string_eigenvalue(mode[k]) * (1 - 1e-12);
        lambda[2 * k + 1] = long_string_eigenvalue(mode[k]) * (1 + 1e-12);
    }
    struct walked walked = walked_make(&rope->chain);
    rd_count(&walked.walk, 2 * MODES, lambda, count);
    for (int k = 0; k < MODES; k++) {
        CHECK_EXACT(count[2 * k], (double)(mode[k] - 1));
        CHECK_EXACT(count[2 * k + 1], (double)mode[k]);
    }
    walked_free(&walked);
}

static void fixed_string_is_counted_as_its_closed_form(void)
{
    struct rope rope = rope_make(&long_string);
    check_string(&rope);
    rope_gather(&rope);
    CHECK_INT(rope.chain.stretches, 3);
    check_string(&rope);
    rope_free(&rope);
}

/* nothing below a very negative lambda, all coordinates that move mass below a very large one; in
   any number and order, each as alone */
static void counts_far_away_are_none_and_all(enum rd_kind kind, const char *names, double inertia,
                                             double far)
{
    const double lambda[] = {far, -far, 1e14, -1e14, 1e18, -1e-100, far, 1e12, -1e12, -0.0, 1e10};
    enum { COUNT = sizeof lambda / sizeof *lambda };
    struct recipe recipe = recipe_of(kind, names);
    recipe.left = names;
    recipe.right = names;
    recipe.inertia[RD_BETA] = inertia;
    struct rope rope = rope_make(&recipe);
    const size_t massless = inertia == 0 && strchr(names, 'b') != NULL;
    const double moving = (double)(8 * (strlen(names) - massless));
    for (int gathered = 0; gathered < 2; gathered++) {
        struct walked walked = walked_make(&rope.chain);
        double count[COUNT], alone;
        rd_count(&walked.walk, COUNT, lambda, count);
        for (int k = 0; k < COUNT; k++) {
            CHECK_EXACT(count[k], lambda[k] > 0 ? moving : 0);
            rd_count(&walked.walk, 1, lambda + k, &alone);
            CHECK_EXACT(alone, count[k]);
        }
        walked_free(&walked);
        rope_gather(&rope);
    }
    rope_free(&rope);
}

/* Euler: pinned, each load B (k pi/L)^2 makes one eigenvalue more negative. A rigid element's tension
   is a string between its nodes, which resists less by x^2/12, x = k pi/n, to O(x^4/240) = 1.5e-5. */
static void loads_above_eulers_are_counted_at_zero(enum rd_kind kind)
{
    for (size_t k = 1; k < 6; k++)
        for (int side = -1; side < 2; side += 2) {
            struct recipe recipe = coupled;
            const double x = (double)k * PI;
            recipe.kind = kind;
            recipe.elements = 64;
            recipe.length = 1.0 / 64;
            recipe.section = (struct rd_section){.bending = 54.626};
            recipe.left = recipe.right = "z";
            recipe.tension = -54.626 * x * x;
            recipe.tension *=
                kind == RD_RIGID ? 1 + x * x / 4096 / 12 + side * 1e-4 : 1 + side * 1e-9;
            struct rope rope = rope_make(&recipe);
            rope_gather(&rope);
            struct walked walked = walked_make(&rope.chain);
            const double zero = 0;
            double count;
            rd_count(&walked.walk, 1, &zero, &count);
            CHECK_EXACT(count, (double)(side < 0 ? k - 1 : k));
            walked_free(&walked);
            rope_free(&rope);
        }
}

/* no lambda: nothing is read or written */
static void no_lambda_is_no_count(void)
{
    struct rope rope = rope_make(&long_string);
    struct walked walked = walked_make(&rope.chain);
    rd_count(&walked.walk, 0, NULL, NULL);
    CHECK_INT(walked.walk.legs, 500);
    walked_free(&walked);
    rope_free(&rope);
}

/* Pinned, with rotary inertia: lambda_k = (B p^4 + T p^2)/(mu + j p^2), p = k pi/L; held rods and
   strings, lambda_k = (stiffness/inertia) p^2. On both sides of each, whatever the span is cut into. */
static void continuous_span_is_counted_as_its_closed_form(const char *names, double tension)
{
    static const size_t mode[] = {1, 2, 3, 17, 100, 1000};
    enum { MODES = sizeof mode / sizeof *mode };
    const double L = 1.5, B = 54.626, mu = 0.1, j = 3e-5;
    const double stiffness = *names == 'z' ? tension : *names == 'x' ? 8.5e5 : 0.1485;
    double lambda[2 * MODES], count[2 * MODES];
    for (int k = 0; k < MODES; k++) {
        const double p = (double)mode[k] * PI / L;
        const double exact = names[1] ? p * p * (B * p * p + tension) / (mu + j * p * p)
                                      : stiffness / (*names == 'a' ? 2e-6 : mu) * p * p;
        /* 2000 pieces of about 64 EPS each; measured 1e-14 */
        lambda[2 * k] = exact * (1 - 1e-11);
        lambda[2 * k + 1] = exact * (1 + 1e-11);
    }
    static const size_t elements[] = {1, 2, 7};
    for (int n = 0; n < 3; n++)
        for (int gathered = 0; gathered < 2; gathered++) {
            const struct recipe recipe = {
                .kind = RD_CONTINUOUS,
                .elements = elements[n],
                .coordinates = names,
                .length = L / (double)elements[n],
                .tension = tension,
                .section = {.axial = 8.5e5, .torsion = 0.1485, .bending = B},
                .inertia = {mu, mu, 2e-6, j},
                .left = names[1] ? "z" : names,
                .right = names[1] ? "z" : names,
            };
            struct rope rope = rope_make(&recipe);
            if (gathered)
                rope_gather(&rope);
            struct walked walked = walked_make(&rope.chain);
            rd_count(&walked.walk, 2 * MODES, lambda, count);
            for (int k = 0; k < MODES; k++) {
                CHECK_EXACT(count[2 * k], (double)(mode[k] - 1));
                CHECK_EXACT(count[2 * k + 1], (double)mode[k]);
            }
            walked_free(&walked);
            rope_free(&rope);
        }
}

/* A clamped span hinged freely at both ends is a pinned one. */
static void continuous_span_is_hinged_as_a_pinned_one(void)
{
    const double B = 54.626, p = 3 * PI / 1.5, lambda = B * p * p * p * p / 0.1;
    const double ends[] = {lambda * (1 - 1e-11), lambda * (1 + 1e-11)};
    double hinge[4 * 2] = {0}, count[2];
    const struct recipe recipe = {
        .kind = RD_CONTINUOUS,
        .elements = 2,
        .coordinates = "zb",
        .length = 0.75,
        .section = {.bending = B},
        .inertia = {[RD_Z] = 0.1},
        .left = "zb",
        .right = "z",
        .more = 1,
    };
    struct rope rope = rope_make(&recipe);
    hinge[LEFT_END * 2 + 1] = INFINITY;
    rope.chain.hinge = hinge;
    struct walked walked = walked_make(&rope.chain);
    rd_count(&walked.walk, 2, ends, count);
    CHECK_EXACT(count[0], 2);
    CHECK_EXACT(count[1], 3);
    walked_free(&walked);
    rope_free(&rope);
}

/* 1e12 m at a wave of 1 m: no number, and soon */
static void more_waves_than_are_walked_are_no_count(void)
{
    const struct recipe recipe = {
        .kind = RD_CONTINUOUS,
        .elements = 1,
        .coordinates = "z",
        .length = 1e12,
        .tension = 1,
        .inertia = {[RD_Z] = 1},
        .left = "z",
        .right = "z",
    };
    struct rope rope = rope_make(&recipe);
    struct walked walked = walked_make(&rope.chain);
    static const double lambda[] = {0, 1e-24, 1e-20, 40, 1e60, INFINITY};
    double count;
    for (int k = 0; k < 6; k++) {
        rd_count(&walked.walk, 1, lambda + k, &count);
        if (k < 3)
            CHECK_EXACT(count, floor(1e12 * sqrt(lambda[k]) / PI));
        else
            CHECK(isnan(count));
    }
    walked_free(&walked);
    rope_free(&rope);
}

int main(void)
{
    static const enum rd_kind kinds[] = {RD_RIGID, RD_TENSED};
    for (size_t c = 0; c < sizeof coordinates / sizeof *coordinates; c++) {
        const bool bends = strchr(coordinates[c], 'z') && strchr(coordinates[c], 'b');
        chains_of_every_width_and_end(RD_DIFFERENCE, coordinates[c]);
        counts_far_away_are_none_and_all(RD_DIFFERENCE, coordinates[c], 3e-5, 1e60);
        counts_far_away_are_none_and_all(RD_DIFFERENCE, coordinates[c], 0, 1e20);
        for (size_t k = 0; k < 2 && bends; k++) {
            chains_of_every_width_and_end(kinds[k], coordinates[c]);
            counts_far_away_are_none_and_all(kinds[k], coordinates[c], 3e-5, 1e60);
            counts_far_away_are_none_and_all(kinds[k], coordinates[c], 0, 1e20);
            chains_with_parts(kinds[k], coordinates[c]);
            hinged_chains(kinds[k], coordinates[c], 0.02);
            hinged_chains(kinds[k], coordinates[c], INFINITY);
            compressed_chains(kinds[k], coordinates[c]);
        }
    }
    for (size_t k = 0; k < 2; k++)
        loads_above_eulers_are_counted_at_zero(kinds[k]);
    fixed_string_is_counted_as_its_closed_form();
    no_lambda_is_no_count();
    continuous_span_is_counted_as_its_closed_form("x", 0);
    continuous_span_is_counted_as_its_closed_form("z", 300);
    continuous_span_is_counted_as_its_closed_form("a", 0);
    continuous_span_is_counted_as_its_closed_form("zb", 0);
    continuous_span_is_counted_as_its_closed_form("zb", 300);
    continuous_span_is_counted_as_its_closed_form("zb", 3e6);
    continuous_span_is_hinged_as_a_pinned_one();
    more_waves_than_are_walked_are_no_count();
    return check_report("test_count");
}
