/* A chain as a rigid body: its centre and its moment, from stretches as from single nodes. */
#include "chain/body.h"

#include "chains.h"
#include "check.h"

#include <string.h>

enum { MASS, SPRING };

static const struct recipe beam = {
    .kind = RD_TENSED,
    .elements = 60,
    .coordinates = "zb",
    .length = 0.0225,
    .tension = 300,
    .section = {.bending = 54.626},
    .inertia = {[RD_Z] = 0.0023, [RD_BETA] = 1e-6},
    .left = "",
    .right = "",
    .distinct = 2,
    .more = 3,
};

static double *of_term(double *matrix, size_t term, size_t i)
{
    return matrix + (term * 2 + i) * 2 + i;
}

/* two element lengths, heavy and light nodes, springs, in runs of every length */
static struct rope uneven_rope(void)
{
    struct rope rope = rope_make(&beam);
    rope.length[1] = 0.31;
    *of_term(rope.mass, MORE, 0) = 1e9;
    *of_term(rope.mass, MORE + 1, 0) = 1e-7;
    *of_term(rope.stiffness, MORE + 1, 0) = 2500;
    *of_term(rope.stiffness, MORE + 2, 0) = -40;
    *of_term(rope.stiffness, MORE + 2, 1) = 7;
    for (size_t i = 20; i < 43; i++)
        rope.element_of[i] = 1;
    rope.term_of[7] = MORE;
    for (size_t i = 30; i < 39; i++)
        rope.term_of[i] = MORE + 1;
    rope.term_of[50] = rope.term_of[51] = MORE + 2;
    return rope;
}

/* what the header says, node by node, in long double and two passes */
static struct rd_body by_nodes(const struct rd_chain *chain)
{
    struct rd_body body = {.length = 0};
    for (int k = 0; k < 2; k++) {
        const double *matrix = k == MASS ? chain->mass : chain->stiffness;
        long double weight = 0, first = 0, second = 0, x = 0;
        for (int pass = 0; pass < 2; pass++, x = 0)
            for (size_t i = 0; i < chain->nodes; i++) {
                const long double n = fabs(matrix[(size_t)chain->term_of[i] * 4]);
                const long double away = x - (pass > 0 ? first / weight : 0);
                weight += pass == 0 ? n : 0;
                first += pass == 0 ? n * x : 0;
                second += pass == 1 ? n * away * away : 0;
                if (i + 1 < chain->nodes)
                    x += chain->length[chain->element_of[i]];
                body.length = (double)x;
            }
        body.weight[k] = (double)weight;
        body.centre[k] = (double)(first / weight);
        body.moment[k] = (double)second;
    }
    return body;
}

static void check_body(const struct rd_body *body, const struct rd_body *expected)
{
    static const char reason[] = "a rounding of positive sums for each of 61 nodes";
    CHECK_REL(body->length, expected->length, 64 * EPS, reason);
    for (int k = 0; k < 2; k++) {
        CHECK_REL(body->weight[k], expected->weight[k], 64 * EPS, reason);
        CHECK_ABS(body->centre[k], expected->centre[k], 64 * EPS * expected->length, reason);
        /* a centre wrong by 64 EPS moves the arms of lengths near that of the chain by as much */
        CHECK_REL(body->moment[k], expected->moment[k], 512 * EPS, reason);
    }
}

static void stretches_weigh_what_their_nodes_weigh(void)
{
    struct rope rope = uneven_rope();
    struct rd_body single, gathered;
    const struct rd_body expected = by_nodes(&rope.chain);
    rd_body_find(&rope.chain, &single);
    rope_gather(&rope);
    CHECK(rope.chain.stretches < 20);
    rd_body_find(&rope.chain, &gathered);
    check_body(&single, &expected);
    check_body(&gathered, &expected);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 2; i++)
            CHECK_REL(gathered.sum[i][k], single.sum[i][k], 64 * EPS, "sums in another order");
    CHECK_EXACT(gathered.pins, 0);
    rope_free(&rope);
}

/* n equal masses m at x = 0, l, .., (n - 1) l: centre (n - 1) l/2, moment m l^2 n (n^2 - 1)/12 */
static void equal_masses_have_their_closed_form(void)
{
    struct recipe recipe = beam;
    recipe.length = 0.25;
    recipe.inertia[RD_Z] = 2;
    struct rope rope = rope_make(&recipe);
    struct rd_body body;
    *of_term(rope.mass, LEFT_END, 0) = *of_term(rope.mass, RIGHT_END, 0) = 2;
    rope_gather(&rope);
    rd_body_find(&rope.chain, &body);
    CHECK_INT(rope.chain.stretches, 3);
    CHECK_REL(body.weight[MASS], 2 * 61, 4 * EPS, "three exact terms");
    CHECK_REL(body.centre[MASS], 7.5, 8 * EPS, "three terms");
    CHECK_REL(body.moment[MASS], 2.0 / 16 * 61 * (61 * 61 - 1) / 12, 8 * EPS,
              "three positive terms");
    CHECK_EXACT(body.length, 15);
    CHECK_EXACT(body.weight[SPRING], 0);
    rope_free(&rope);
}

/* a mass H at one end: moment = S2 - S1^2/(H + N) about the end, S1 and S2 of the others */
static void heavy_node_costs_no_digit(double heavy)
{
    struct recipe recipe = beam;
    recipe.length = 1;
    recipe.inertia[RD_Z] = 1;
    struct rope rope = rope_make(&recipe);
    struct rd_body body;
    *of_term(rope.mass, LEFT_END, 0) = heavy;
    *of_term(rope.mass, RIGHT_END, 0) = 1;
    rope_gather(&rope);
    rd_body_find(&rope.chain, &body);
    const double s1 = 60 * 61 / 2.0, s2 = 60 * 61 * 121 / 6.0;
    CHECK_REL(body.centre[MASS], s1 / (heavy + 60), 16 * EPS, "three positive terms");
    CHECK_REL(body.moment[MASS], s2 - s1 * s1 / (heavy + 60), 32 * EPS, "no difference in ours");
    rope_free(&rope);
}

static void held_nodes_are_pins_and_carry_no_weight(void)
{
    struct recipe recipe = beam;
    recipe.left = "zb";
    struct rope rope = rope_make(&recipe);
    struct rd_body body;
    rope.held[MORE * 2] = 1;
    rope.term_of[20] = rope.term_of[21] = rope.term_of[22] = MORE;
    rope_gather(&rope);
    rd_body_find(&rope.chain, &body);
    CHECK_EXACT(body.pins, 4);
    CHECK_REL(body.pin, 22 * beam.length, 8 * EPS, "two stretches");
    CHECK(isinf(body.sum[0][SPRING]));
    CHECK(isinf(body.sum[1][SPRING]));
    CHECK_REL(body.weight[MASS], beam.inertia[RD_Z] * (18 + 1 + 37 + 0.5 - 1 + 1), 64 * EPS,
              "one rounding for each of five stretches");
    CHECK_EXACT(rd_body_receptance(&body, &rope.chain, 0, 1, 1, 0), 0);
    CHECK_EXACT(rd_body_receptance(&body, &rope.chain, 1, 1, 1, 0), 0);
    rope_free(&rope);
}

/* free: 1/(lambda m) in translation, L^2/4 over the moment more at the ends, where z and beta go
   together; with nothing that resists 0 */
static void free_body_is_resisted_by_its_masses_alone(void)
{
    struct rope rope = rope_make(&beam);
    struct rd_body body;
    rope_gather(&rope);
    rd_body_find(&rope.chain, &body);
    const double L = body.length, lambda = 49;
    const double alone = 1 / (lambda * body.weight[MASS]);
    const double turned = 1 / (lambda * (body.sum[1][MASS] + body.moment[MASS]) + 300 * L);
    CHECK_REL(rd_body_receptance(&body, &rope.chain, 1, lambda, 1, 300), turned, 8 * EPS, "sums");
    CHECK_REL(rd_body_receptance(&body, &rope.chain, 0, lambda, 1, 300), alone + L * L / 4 * turned,
              8 * EPS, "sums");
    CHECK_EXACT(rd_body_receptance(&body, &rope.chain, 0, 0, 1, 0), 0);
    rope_free(&rope);
}

/* about one pin: the masses by their distance from it */
static void pinned_body_turns_about_its_pin(void)
{
    struct recipe recipe = beam;
    recipe.left = "z";
    struct rope rope = rope_make(&recipe);
    struct rd_body body;
    rope_gather(&rope);
    rd_body_find(&rope.chain, &body);
    const double m = beam.inertia[RD_Z], l = beam.length, j = 60 * beam.inertia[RD_BETA];
    /* nodes 1 .. 59 and half a mass at 60 */
    const double moment = m * l * l * (59 * 60 * 119 / 6.0 + 60 * 60 / 2.0);
    CHECK_REL(rd_body_receptance(&body, &rope.chain, 1, 1, 1, 0), 1 / (moment + j), 64 * EPS,
              "positive sums of three stretches");
    CHECK_INT(body.pins, 1);
    rope_free(&rope);
}

/* A bar of mass m: moment m L^2/12 about its middle, in one element as in many, and beside a point of
   mass n at its end m L^2/12 + m n/(m + n) L^2/4. */
static void continuous_span_is_a_bar(double point)
{
    struct recipe recipe = beam;
    recipe.kind = RD_CONTINUOUS;
    recipe.inertia[RD_Z] = 0.2;
    recipe.inertia[RD_BETA] = 3e-5;
    for (size_t n = 1; n < 100; n *= 4)
        for (int gathered = 0; gathered < 2; gathered++) {
            struct rd_body body;
            recipe.elements = n;
            recipe.length = 3.0 / (double)n;
            struct rope rope = rope_make(&recipe);
            *of_term(rope.mass, RIGHT_END, 0) = point;
            if (gathered)
                rope_gather(&rope);
            rd_body_find(&rope.chain, &body);
            const double m = 0.2 * 3, both = m + point;
            static const char reason[] = "a rounding of positive sums for each of 64 elements";
            CHECK_REL(body.weight[MASS], both, 64 * EPS, reason);
            CHECK_REL(body.sum[0][MASS], both, 64 * EPS, reason);
            CHECK_REL(body.sum[1][MASS], 3e-5 * 3, 64 * EPS, reason);
            CHECK_REL(body.centre[MASS], (m * 1.5 + point * 3) / both, 128 * EPS, reason);
            CHECK_REL(body.moment[MASS], m * 9 / 12 + m * (point / both) * 9 / 4, 512 * EPS,
                      "centres wrong by 64 EPS, as above");
            rope_free(&rope);
        }
}

int main(void)
{
    stretches_weigh_what_their_nodes_weigh();
    equal_masses_have_their_closed_form();
    for (double heavy = 1; heavy < 1e19; heavy *= 1e3)
        heavy_node_costs_no_digit(heavy);
    held_nodes_are_pins_and_carry_no_weight();
    free_body_is_resisted_by_its_masses_alone();
    pinned_body_turns_about_its_pin();
    continuous_span_is_a_bar(0);
    continuous_span_is_a_bar(0.3);
    continuous_span_is_a_bar(1e9);
    return check_report("test_body");
}
