/* A chain prepared for walking: its legs, its triples and its memory. */
#include "modes/walk/walk.h"

#include "chain/elements.h"
#include "check.h"
#include "element/element.h"
#include "element/stiffness.h"
#include "walked.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, HEAVY = MORE, SECOND };

static const struct recipe beam = {
    .kind = RD_TENSED,
    .elements = 100,
    .coordinates = "zb",
    .length = 0.0135,
    .tension = 300,
    .section = {.bending = 54.626},
    .inertia = {[RD_Z] = 0.0013, [RD_BETA] = 1e-8},
    .left = "zb",
    .right = "z",
    .distinct = 2,
    .more = 2,
};

static void check_leg(const struct rd_leg *leg, size_t node, size_t count, int element, int before,
                      int first, int term)
{
    CHECK_INT(leg->node, node);
    CHECK_INT(leg->count, count);
    CHECK_INT(leg->element, element);
    CHECK_INT(leg->before, before);
    CHECK_INT(leg->first, first);
    CHECK_INT(leg->term, term);
}

/* the legs are the elements of the chain, each with its node on the left, behind its hinge */
static void check_cover(const struct walked *walked)
{
    const struct rd_walk *walk = &walked->walk;
    const struct rd_chain *chain = walk->chain;
    size_t node = 0;
    int before = -1;
    for (size_t r = 0; r < walk->legs; r++) {
        const struct rd_leg *leg = walk->leg + r;
        CHECK_INT(leg->node, node);
        CHECK_INT(leg->before, before);
        before = leg->element;
        if (leg->element >= (int)chain->distinct) {
            CHECK_INT(leg->count, 1);
            CHECK_INT(leg->first, chain->term_of[node]);
            CHECK_INT(leg->element, (int)chain->distinct + chain->term_of[node]);
            continue;
        }
        for (size_t i = 0; i < leg->count; i++) {
            const int32_t term = chain->term_of[node + i];
            CHECK_INT(chain->element_of[node + i], leg->element);
            CHECK_INT(i == 0 ? leg->first : leg->term,
                      rd_chain_is_hinged(chain, term) ? RD_NO_TERM : term);
        }
        node += leg->count;
    }
    CHECK_INT(node, chain->nodes - 1);
    CHECK_INT(walk->behind, before);
    CHECK_INT(walk->last, chain->term_of[chain->nodes - 1]);
}

static void uniform_rope_is_one_leg(void)
{
    struct rope rope = rope_make(&beam);
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    CHECK_INT(walked.walk.legs, 1);
    check_leg(walked.walk.leg, 0, 100, 0, -1, LEFT_END, INNER);
    check_cover(&walked);
    walked_free(&walked);
    rope_free(&rope);
}

static void a_node_of_its_own_begins_a_leg(void)
{
    struct rope rope = rope_make(&beam);
    rope.term_of[40] = HEAVY;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    CHECK_INT(walked.walk.legs, 2);
    check_leg(walked.walk.leg, 0, 40, 0, -1, LEFT_END, INNER);
    check_leg(walked.walk.leg + 1, 40, 60, 0, 0, HEAVY, INNER);
    check_cover(&walked);
    walked_free(&walked);
    rope_free(&rope);
}

static void another_element_begins_a_leg(void)
{
    struct rope rope = rope_make(&beam);
    for (size_t i = 70; i < 100; i++)
        rope.element_of[i] = 1;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    CHECK_INT(walked.walk.legs, 2);
    check_leg(walked.walk.leg, 0, 70, 0, -1, LEFT_END, INNER);
    check_leg(walked.walk.leg + 1, 70, 30, 1, 0, INNER, INNER);
    check_cover(&walked);
    walked_free(&walked);
    rope_free(&rope);
}

/* an element of no length between its node and the one on its right, which has no term left */
static void a_hinge_is_a_leg_alone(double compliance)
{
    double hinge[5 * 2] = {0};
    struct rope rope = rope_make(&beam);
    hinge[HEAVY * 2 + 1] = compliance;
    rope.chain.hinge = hinge;
    rope.term_of[40] = HEAVY;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    const struct rd_walk *walk = &walked.walk;
    const int element = 2 + HEAVY;
    CHECK_INT(walk->legs, 4);
    check_leg(walk->leg, 0, 40, 0, -1, LEFT_END, INNER);
    check_leg(walk->leg + 1, 40, 1, element, 0, HEAVY, HEAVY);
    check_leg(walk->leg + 2, 40, 1, 0, element, RD_NO_TERM, RD_NO_TERM);
    check_leg(walk->leg + 3, 41, 59, 0, 0, INNER, INNER);
    check_cover(&walked);
    const double *D = walk->triple + (size_t)element * 16;
    for (size_t i = 0; i < 4; i++) {
        const bool turns = i == 3, is_free = turns && isinf(compliance);
        CHECK_EXACT(D[i], is_free ? -1 : 0);
        CHECK_EXACT(D[8 + i], 0);
        if (is_free) /* G and P cancel */
            CHECK_EXACT(D[4 + i] * D[12 + i], -1);
        else
            CHECK_EXACT(D[4 + i], turns ? compliance : 0);
    }
    CHECK_INT(walk->strut[element], isinf(compliance));
    walked_free(&walked);
    rope_free(&rope);
}

static void hinges_next_to_each_other_and_at_the_left_end(void)
{
    double hinge[5 * 2] = {0};
    struct rope rope = rope_make(&beam);
    hinge[LEFT_END * 2 + 1] = 0.1;
    hinge[HEAVY * 2 + 1] = 0.2;
    rope.chain.hinge = hinge;
    rope.term_of[40] = rope.term_of[41] = rope.term_of[42] = rope.term_of[99] = HEAVY;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    /* (hinge, element) at 0, 40, 41, 42, 99, and the rope between */
    CHECK_INT(walked.walk.legs, 12);
    check_leg(walked.walk.leg, 0, 1, 2 + LEFT_END, -1, LEFT_END, LEFT_END);
    check_leg(walked.walk.leg + 5, 41, 1, 2 + HEAVY, 0, HEAVY, HEAVY);
    check_cover(&walked);
    walked_free(&walked);
    rope_free(&rope);
}

static void chain_of_any_stretches_is_covered(bool hinged)
{
    double hinge[5 * 2] = {0};
    hinge[HEAVY * 2 + 1] = 0.2;
    for (int k = 0; k < 30; k++) {
        struct rope rope = rope_make(&beam);
        rope.chain.hinge = hinged ? hinge : NULL;
        for (size_t i = 0; i < 100; i++) {
            rope.element_of[i] = check_random() > 0.8;
            if (i > 0)
                rope.term_of[i] = check_random() > 0.6 ? INNER
                                  : check_random() > 0 ? HEAVY
                                                       : SECOND;
        }
        if (k % 2)
            rope_gather(&rope);
        struct walked walked = walked_make(&rope.chain);
        check_cover(&walked);
        walked_free(&walked);
        rope_free(&rope);
    }
}

/* length, mean tension, sum of l S_bb and of masses */
static void the_walk_knows_the_sums_of_its_chain(void)
{
    static const char reason[] = "one rounding for each of two legs and the last node";
    struct rope rope = rope_make(&beam);
    rope.tension[1] = 100;
    rope.length[1] = 0.05;
    for (size_t i = 70; i < 100; i++)
        rope.element_of[i] = 1;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    const struct rd_walk *walk = &walked.walk;
    const double first = 70 * 0.0135, second = 30 * 0.05;
    CHECK_REL(walk->length, first + second, 8 * EPS, reason);
    CHECK_REL(walk->tension, (300 * first + 100 * second) / (first + second), 8 * EPS, reason);
    CHECK_REL(walk->bend, (first + second) / 54.626, 8 * EPS, reason);
    CHECK_REL(walk->mass[0], 100 * 0.0013, 8 * EPS, reason);
    CHECK_REL(walk->mass[1], 100 * 1e-8, 8 * EPS, reason);
    walked_free(&walked);
    rope_free(&rope);
}

static void memory_is_exactly_what_was_measured(bool hinged)
{
    const double hinge[5 * 2] = {0};
    struct rope rope = rope_make(&beam);
    struct rd_walk walk;
    rope.chain.hinge = hinged ? hinge : NULL;
    for (int gathered = 0; gathered < 2; gathered++) {
        struct rd_workspace workspace = {0};
        CHECK_INT(rd_walk_fill(&rope.chain, &workspace, &walk), RD_NO_MEMORY);
        const size_t size = workspace.used;
        for (size_t less = 0; less < 2; less++) {
            workspace = exact_workspace(size - less);
            CHECK_INT(rd_walk_fill(&rope.chain, &workspace, &walk), less ? RD_NO_MEMORY : RD_OK);
            free(workspace.base);
        }
        rope_gather(&rope);
    }
    rope_free(&rope);
}

static void numbers_that_are_none_are_refused(double bad)
{
    for (int k = 0; k < 5; k++) {
        struct rope rope = rope_make(&beam);
        double *const array[] = {rope.length, rope.tension, rope.flexibility + 8,
                                 rope.mass + 4 * INNER, rope.stiffness + 4 * INNER + 3};
        *array[k] = bad;
        struct rd_walk walk;
        struct rd_workspace workspace = {0};
        rd_walk_fill(&rope.chain, &workspace, &walk);
        workspace = exact_workspace(workspace.used);
        CHECK_INT(rd_walk_fill(&rope.chain, &workspace, &walk), RD_NOT_POSITIVE_DEFINITE);
        free(workspace.base);
        rope_free(&rope);
    }
}

/* the larger of the two diagonal entries of the element's own matrix; compressed, where these are
   differences, the sum of what they are differences of */
static void stiffness_is_that_of_the_element(double tension)
{
    struct recipe recipe = beam;
    recipe.coordinates = "zab";
    recipe.section = (struct rd_section){.torsion = 0.1485, .bending = 54.626, .slope = 0.3};
    recipe.tension = tension;
    struct rope rope = rope_make(&recipe);
    struct walked walked = walked_make(&rope.chain);
    const struct rd_element element = rd_chain_element(&rope.chain, 0);
    CHECK_INT(walked.walk.strut[0], tension < -10000);
    double elastic[4 * W * W], string[4 * W * W];
    CHECK_INT(rd_element_stiffness(&element, elastic, string), RD_OK);
    for (size_t i = 0; i < 3; i++) {
        const double left = fabs(elastic[i * 7] + string[i * 7]);
        const double right = fabs(elastic[(i + 3) * 7] + string[(i + 3) * 7]);
        const double ours = rd_walk_stiffness(&walked.walk, 0, i), tolerance = 14 * 28 * 4 * EPS;
        if (tension >= 0)
            CHECK_REL(ours, fmax(left, right), tolerance,
                      "G of condition 14 in z and beta, 28 in alpha and beta, inverted");
        else
            CHECK(ours >= fmax(left, right) * (1 - tolerance));
    }
    walked_free(&walked);
    rope_free(&rope);
}

/* finite and positive whatever lambda is, the same for both signs, never growing with |lambda| */
static void scales_exist_at_any_lambda(const char *coordinates, double tension)
{
    struct recipe recipe = beam;
    recipe.coordinates = coordinates;
    recipe.tension = tension;
    recipe.section = (struct rd_section){.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626};
    recipe.inertia[RD_X] = recipe.inertia[RD_Z];
    recipe.inertia[RD_ALPHA] = recipe.inertia[RD_BETA];
    struct rope rope = rope_make(&recipe);
    struct walked walked = walked_make(&rope.chain);
    double z[W], opposite[W], before[W] = {INFINITY, INFINITY, INFINITY, INFINITY};
    rd_walk_scale(&walked.walk, 0, z);
    for (size_t i = 0; i < rope.chain.width; i++)
        CHECK(isfinite(z[i]) && z[i] > 0);
    for (double lambda = 1e-30; lambda < 1e100; lambda *= 1e3) {
        rd_walk_scale(&walked.walk, lambda, z);
        rd_walk_scale(&walked.walk, -lambda, opposite);
        for (size_t i = 0; i < rope.chain.width; i++) {
            CHECK(isfinite(z[i]) && z[i] > 0);
            CHECK_EXACT(opposite[i], z[i]);
            CHECK(z[i] <= before[i] * (1 + 64 * EPS));
        }
        memcpy(before, z, sizeof z);
    }
    walked_free(&walked);
    rope_free(&rope);
}

static struct recipe continuous_recipe(void)
{
    struct recipe recipe = beam;
    recipe.kind = RD_CONTINUOUS;
    recipe.inertia[RD_Z] = 0.1;
    recipe.inertia[RD_BETA] = 3e-5;
    return recipe;
}

/* of bare nodes there is nothing in a leg; a part begins another one */
static void continuous_elements_go_on_across_bare_nodes(void)
{
    const struct recipe recipe = continuous_recipe();
    struct rope rope = rope_make(&recipe);
    rope.stiffness[4 * HEAVY] = 100;
    rope.term_of[40] = HEAVY;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    CHECK_INT(walked.walk.legs, 2);
    check_leg(walked.walk.leg, 0, 40, 0, -1, LEFT_END, RD_NO_TERM);
    check_leg(walked.walk.leg + 1, 40, 60, 0, 0, HEAVY, RD_NO_TERM);
    walked_free(&walked);
    rope_free(&rope);
}

/* the rope's own mass, no end of eigenvalues, and radians of the shortest wave, a l, where
   a^2 = h + sqrt(h^2 + lambda mu/B), h = (T + lambda j)/2B; of a hinge there are none */
static void continuous_walk_knows_its_mass_and_its_waves(void)
{
    struct recipe recipe = continuous_recipe();
    double hinge[5 * 2] = {0};
    recipe.elements = 3;
    struct rope rope = rope_make(&recipe);
    rope.mass[4 * HEAVY] = 7;
    rope.term_of[1] = HEAVY;
    hinge[2 * HEAVY + 1] = 0.1;
    rope.chain.hinge = hinge;
    struct walked walked = walked_make(&rope.chain);
    const double L = 3 * 0.0135, lambda = 5e4, B = 54.626;
    const double h = (300 + lambda * 3e-5) / (2 * B);
    CHECK_REL(walked.walk.mass[0], 0.1 * L + 7, 8 * EPS, "a sum of four");
    CHECK_REL(walked.walk.carried[0], 0.1 * L, 8 * EPS, "a sum of three");
    CHECK_REL(walked.walk.carried[1], 3e-5 * L, 8 * EPS, "a sum of three");
    CHECK(isinf(rd_walk_ceiling(&walked.walk)));
    for (size_t r = 0; r < walked.walk.legs; r++) {
        const struct rd_leg *leg = walked.walk.leg + r;
        const double radians = rd_walk_radians(&walked.walk, leg, -lambda);
        if (leg->element >= 2)
            CHECK_EXACT(radians, 0);
        else
            CHECK_REL(radians, 0.0135 * sqrt(h + sqrt(h * h + lambda * 0.1 / B)), 8 * EPS,
                      "a few operations");
    }
    walked_free(&walked);
    rope_free(&rope);
}

static void inertia_that_is_none_is_refused(double bad)
{
    const struct recipe recipe = continuous_recipe();
    struct rope rope = rope_make(&recipe);
    struct rd_walk walk;
    struct rd_workspace workspace = {0};
    rope.inertia[3] = bad;
    rd_walk_fill(&rope.chain, &workspace, &walk);
    workspace = exact_workspace(workspace.used);
    CHECK_INT(rd_walk_fill(&rope.chain, &workspace, &walk), RD_NOT_POSITIVE_DEFINITE);
    free(workspace.base);
    rope_free(&rope);
}

int main(void)
{
    uniform_rope_is_one_leg();
    a_node_of_its_own_begins_a_leg();
    another_element_begins_a_leg();
    a_hinge_is_a_leg_alone(0.01);
    a_hinge_is_a_leg_alone(INFINITY);
    hinges_next_to_each_other_and_at_the_left_end();
    chain_of_any_stretches_is_covered(false);
    chain_of_any_stretches_is_covered(true);
    the_walk_knows_the_sums_of_its_chain();
    memory_is_exactly_what_was_measured(false);
    memory_is_exactly_what_was_measured(true);
    numbers_that_are_none_are_refused(NAN);
    numbers_that_are_none_are_refused(INFINITY);
    numbers_that_are_none_are_refused(-INFINITY);
    /* the last is a strut: -T S_bb l^2 = 1.6 */
    static const double tension[] = {300, 0, -100, -15000};
    for (size_t k = 0; k < sizeof tension / sizeof *tension; k++)
        stiffness_is_that_of_the_element(tension[k]);
    static const char *const coordinates[] = {"z", "a", "zb", "zab", "xzab"};
    for (size_t k = 0; k < sizeof coordinates / sizeof *coordinates; k++) {
        scales_exist_at_any_lambda(coordinates[k], 300);
        scales_exist_at_any_lambda(coordinates[k], 1e-3);
    }
    continuous_elements_go_on_across_bare_nodes();
    continuous_walk_knows_its_mass_and_its_waves();
    inertia_that_is_none_is_refused(NAN);
    inertia_that_is_none_is_refused(INFINITY);
    return check_report("test_walk");
}
