/* Motions of the whole chain that nothing resists. */
#include "modes/certify/rigid.h"

#include "assembled/assemble.h"
#include "check.h"
#include "walked.h"

enum { W = RD_WIDTH_MAX, SPRING = MORE };

static const struct recipe beam = {
    .kind = RD_TENSED,
    .elements = 24,
    .coordinates = "zb",
    .length = 0.05,
    .section = {.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626, .slope = 0.3},
    .inertia = {0.005, 0.005, 2e-7, 1e-6},
    .left = "",
    .right = "",
    .more = 1,
};

static struct recipe recipe_of(enum rd_kind kind, const char *names, const char *left,
                               const char *right)
{
    struct recipe recipe = beam;
    recipe.kind = kind;
    recipe.coordinates = names;
    recipe.left = left;
    recipe.right = right;
    return recipe;
}

/* a^T A b, A (n, n) */
static double form(size_t n, const double *A, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            sum += a[i] * A[i * n + j] * b[j];
    return sum;
}

/* u^T M u = 1 for each and 0 between them */
static void check_orthonormal(const struct rd_chain *chain, size_t count, const double *u)
{
    static const double inertia[RD_PARTS] = {[RD_MASS] = 1};
    const size_t n = chain->nodes * chain->width;
    double *M = rope_dense(chain, inertia);
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b < count; b++)
            CHECK_ABS(form(n, M, u + a * n, u + b * n), a == b, 256 * EPS,
                      "sums over 25 nodes, shares of the motions before taken off");
    free(M);
}

/* K u = 0 in each row, and u = 0 where held */
static void check_unresisted(const struct rd_chain *chain, const double *u)
{
    static const double stiffness[RD_PARTS] = {[RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1};
    const size_t w = chain->width, n = chain->nodes * w;
    double *K = rope_dense(chain, stiffness);
    for (size_t i = 0; i < n; i++) {
        double sum = 0, size = 0;
        const bool held = chain->held[(size_t)chain->term_of[i / w] * w + i % w];
        for (size_t j = 0; j < n; j++) {
            sum += K[i * n + j] * u[j];
            size += fabs(K[i * n + j] * u[j]);
        }
        if (held)
            CHECK_EXACT(u[i], 0);
        else
            CHECK_ABS(sum, 0, 64 * EPS * size, "cancellation of the row's terms");
    }
    free(K);
}

/* as many rigid motions as expected, unresisted and orthonormal, gathered or not */
static void check_motions(struct rope *rope, size_t expected)
{
    const size_t n = rope->chain.nodes * rope->chain.width;
    for (int gathered = 0; gathered < 2; gathered++) {
        struct walked walked = walked_make(&rope->chain);
        struct rd_rigid rigid;
        CHECK_INT(rd_rigid_fill(&walked.walk, &rigid), RD_OK);
        CHECK_INT(rigid.count, expected);
        double *u = zeros(W * n);
        for (size_t k = 0; k < rigid.count; k++) {
            rd_rigid_shape(&walked.walk, &rigid, k, u + k * n, NULL);
            check_unresisted(&rope->chain, u + k * n);
        }
        check_orthonormal(&rope->chain, rigid.count, u);
        free(u);
        walked_free(&walked);
        rope_gather(rope);
    }
}

static void recipe_has(struct recipe recipe, size_t expected)
{
    struct rope rope = rope_make(&recipe);
    check_motions(&rope, expected);
    rope_free(&rope);
}

static void untensed_beam_has_what_its_ends_leave(enum rd_kind kind)
{
    recipe_has(recipe_of(kind, "zb", "", ""), 2);
    recipe_has(recipe_of(kind, "zb", "z", ""), 1);
    recipe_has(recipe_of(kind, "zb", "b", ""), 1);
    recipe_has(recipe_of(kind, "zb", "b", "b"), 1);
    recipe_has(recipe_of(kind, "zb", "b", "z"), 0);
    recipe_has(recipe_of(kind, "zb", "z", "z"), 0);
    recipe_has(recipe_of(kind, "zb", "zb", ""), 0);
    recipe_has(recipe_of(kind, "xzab", "", ""), 4);
    recipe_has(recipe_of(kind, "xzab", "", "x"), 3);
    recipe_has(recipe_of(kind, "xzab", "a", "xz"), 1);
    recipe_has(recipe_of(kind, "zab", "zb", ""), 1);
    recipe_has(recipe_of(kind, "zab", "zab", ""), 0);
}

/* tension of either sign resists a rotation, not a translation */
static void tension_resists_a_rotation(enum rd_kind kind, double tension)
{
    struct recipe recipe = recipe_of(kind, "zb", "", "");
    recipe.tension = tension;
    recipe_has(recipe, 1);
    recipe.left = "z";
    recipe_has(recipe, 0);
}

/* in the study's kinematics beta is no slope: turning all nodes moves none */
static void differences_translate_and_turn_apart(void)
{
    recipe_has(recipe_of(RD_DIFFERENCE, "zb", "", ""), 2);
    recipe_has(recipe_of(RD_DIFFERENCE, "zb", "z", "z"), 1);
    recipe_has(recipe_of(RD_DIFFERENCE, "zb", "b", ""), 1);
    recipe_has(recipe_of(RD_DIFFERENCE, "zb", "z", "b"), 0);
}

static void strings_and_rods_slide_whole(void)
{
    struct recipe recipe = recipe_of(RD_TENSED, "z", "", "");
    recipe.tension = 300;
    recipe_has(recipe, 1);
    recipe.right = "z";
    recipe_has(recipe, 0);
    recipe_has(recipe_of(RD_TENSED, "xa", "", ""), 2);
    recipe_has(recipe_of(RD_TENSED, "xa", "x", ""), 1);
}

/* one spring in z leaves a rotation about it, two leave nothing, one that turns leaves z */
static void springs_take_motions_away(enum rd_kind kind)
{
    const struct recipe recipe = recipe_of(kind, "zb", "", "");
    struct rope rope = rope_make(&recipe);
    rope.stiffness[SPRING * 4] = 1000;
    rope.term_of[7] = SPRING;
    check_motions(&rope, 1);
    rope_free(&rope);
    rope = rope_make(&recipe);
    rope.stiffness[SPRING * 4] = 1e-3;
    rope.term_of[7] = rope.term_of[19] = SPRING;
    check_motions(&rope, 0);
    rope_free(&rope);
    rope = rope_make(&recipe);
    rope.stiffness[SPRING * 4 + 3] = 1000;
    rope.term_of[7] = SPRING;
    check_motions(&rope, 1);
    rope_free(&rope);
}

/* a weak spring is a spring: 1e-300 N/m beside EA of 1e6 N */
static void any_spring_is_one(void)
{
    struct recipe recipe = recipe_of(RD_RIGID, "z", "", "");
    recipe.tension = 300;
    struct rope rope = rope_make(&recipe);
    rope.stiffness[SPRING] = 1e-300;
    rope.term_of[12] = SPRING;
    check_motions(&rope, 0);
    rope_free(&rope);
}

static void support_between_is_a_pin(enum rd_kind kind)
{
    const struct recipe recipe = recipe_of(kind, "zb", "", "");
    struct rope rope = rope_make(&recipe);
    rope.held[SPRING * 2] = 1;
    rope.term_of[9] = SPRING;
    check_motions(&rope, 1);
    rope.term_of[15] = SPRING;
    rope_gather(&rope);
    check_motions(&rope, 0);
    rope_free(&rope);
}

/* the shorter the lever between them, the less two pins resist; here it is 1/20000 of the beam */
static void two_pins_hold_however_near(void)
{
    struct recipe recipe = recipe_of(RD_TENSED, "zb", "z", "");
    recipe.elements = 20000;
    struct rope rope = rope_make(&recipe);
    struct rd_rigid rigid;
    rope.held[SPRING * 2] = 1;
    rope.term_of[1] = SPRING;
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    CHECK_INT(rd_rigid_fill(&walked.walk, &rigid), RD_OK);
    CHECK_INT(rigid.count, 0);
    walked_free(&walked);
    rope_free(&rope);
}

/* pinned at the left: z = beta x, and beta everywhere the same, with M of the body about its pin */
static void pinned_beam_turns_about_its_pin(void)
{
    const struct recipe recipe = recipe_of(RD_TENSED, "zb", "z", "");
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    struct rd_rigid rigid;
    double u[25 * 2];
    CHECK_INT(rd_rigid_fill(&walked.walk, &rigid), RD_OK);
    rd_rigid_shape(&walked.walk, &rigid, 0, u, NULL);
    const double l = beam.length;
    const double moment = 0.005 * l * l * (23 * 24 * 47 / 6.0 + 24 * 24 / 2.0) + 24 * 1e-6;
    CHECK_REL(fabs(u[1]), 1 / sqrt(moment), 64 * EPS, "positive sums");
    for (size_t i = 0; i < 25; i++) {
        CHECK_EXACT(u[2 * i + 1], u[1]);
        CHECK_ABS(u[2 * i], (double)i * l * u[1], 16 * EPS * 24 * l * fabs(u[1]), "one lever");
    }
    walked_free(&walked);
    rope_free(&rope);
}

/* an elastic hinge leaves the motions of the whole */
static void elastic_hinges_move_along(void)
{
    double hinge[4 * 2] = {0};
    const struct recipe recipe = recipe_of(RD_TENSED, "zb", "z", "");
    struct rope rope = rope_make(&recipe);
    hinge[SPRING * 2 + 1] = 0.02;
    rope.chain.hinge = hinge;
    rope.term_of[9] = SPRING;
    check_motions(&rope, 1);
    rope_free(&rope);
}

static void motion_without_mass_has_no_frequency(void)
{
    struct recipe recipe = recipe_of(RD_TENSED, "zab", "zb", "");
    recipe.inertia[RD_ALPHA] = 0;
    struct rope rope = rope_make(&recipe);
    struct walked walked = walked_make(&rope.chain);
    struct rd_rigid rigid;
    CHECK_INT(rd_rigid_fill(&walked.walk, &rigid), RD_UNSTABLE_MASSLESS);
    walked_free(&walked);
    rope_free(&rope);
}

/* int u^T m u' dx, u linear between the nodes in z: int z z' = l (2 a a' + a b' + b a' + 2 b b')/6 */
static double carried(const struct rd_chain *chain, const double *u, const double *v)
{
    const size_t w = chain->width;
    double sum = 0;
    for (size_t i = 0; i + 1 < chain->nodes; i++)
        for (size_t c = 0; c < w; c++) {
            const double *a = u + i * w + c, *b = v + i * w + c;
            sum += chain->length[0] * chain->inertia[c] *
                   (2 * a[0] * b[0] + a[0] * b[w] + a[w] * b[0] + 2 * a[w] * b[w]) / 6;
        }
    return sum;
}

/* as many as expected, M-orthonormal by the rope's own mass and nowhere bent or twisted */
static void continuous_span_moves_as_a_bar(const char *names, double tension, const char *left,
                                           size_t expected)
{
    static const size_t elements[] = {1, 2, 30};
    for (int n = 0; n < 3; n++)
        for (int gathered = 0; gathered < 2; gathered++) {
            struct recipe recipe = recipe_of(RD_CONTINUOUS, names, left, "");
            struct rd_rigid rigid;
            recipe.tension = tension;
            recipe.elements = elements[n];
            recipe.length = 1.2 / (double)elements[n];
            struct rope rope = rope_make(&recipe);
            if (gathered)
                rope_gather(&rope);
            struct walked walked = walked_make(&rope.chain);
            const size_t w = rope.chain.width, size = rope.chain.nodes * w;
            double *u = zeros(W * size);
            CHECK_INT(rd_rigid_fill(&walked.walk, &rigid), RD_OK);
            CHECK_INT(rigid.count, expected);
            for (size_t k = 0; k < rigid.count; k++)
                rd_rigid_shape(&walked.walk, &rigid, k, u + k * size, NULL);
            for (size_t a = 0; a < rigid.count; a++)
                for (size_t b = 0; b < rigid.count; b++)
                    CHECK_ABS(carried(&rope.chain, u + a * size, u + b * size), a == b, 512 * EPS,
                              "sums over 30 elements, shares of the motions before taken off");
            const size_t z = rope_find(&rope.chain, 'z'), beta = rope_find(&rope.chain, 'b');
            for (size_t k = 0; k < rigid.count; k++)
                for (size_t i = 0; i + 1 < rope.chain.nodes; i++)
                    for (size_t c = 0; c < w; c++) {
                        const double *at = u + k * size + i * w;
                        const bool rises = c == z && beta < w;
                        CHECK_ABS(at[w + c] - at[c], rises ? recipe.length * at[beta] : 0,
                                  64 * EPS * (fabs(at[c]) + fabs(at[w + c])), "n F^n of a lever");
                    }
            free(u);
            walked_free(&walked);
            rope_free(&rope);
        }
}

int main(void)
{
    static const enum rd_kind kinds[] = {RD_RIGID, RD_TENSED};
    for (size_t k = 0; k < 2; k++) {
        untensed_beam_has_what_its_ends_leave(kinds[k]);
        tension_resists_a_rotation(kinds[k], 300);
        tension_resists_a_rotation(kinds[k], -5);
        springs_take_motions_away(kinds[k]);
        support_between_is_a_pin(kinds[k]);
    }
    differences_translate_and_turn_apart();
    strings_and_rods_slide_whole();
    any_spring_is_one();
    two_pins_hold_however_near();
    pinned_beam_turns_about_its_pin();
    elastic_hinges_move_along();
    motion_without_mass_has_no_frequency();
    continuous_span_moves_as_a_bar("z", 300, "", 1);
    continuous_span_moves_as_a_bar("xa", 300, "", 2);
    continuous_span_moves_as_a_bar("zb", 0, "", 2);
    continuous_span_moves_as_a_bar("zb", 0, "z", 1);
    continuous_span_moves_as_a_bar("zb", 300, "", 1);
    continuous_span_moves_as_a_bar("xzab", 0, "", 4);
    continuous_span_moves_as_a_bar("xzab", 300, "x", 2);
    continuous_span_moves_as_a_bar("xzab", 300, "xza", 0);
    return check_report("test_rigid");
}
