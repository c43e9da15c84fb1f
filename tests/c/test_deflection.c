/* Static deflection against textbook beams and strings. */
#include "assembled/deflection.h"

#include "chains.h"
#include "check.h"

#include <float.h>

static const double L = 1.35, B = 54.626, C = 0.1485;

static size_t measure(const struct rope *rope)
{
    struct rd_deflection deflection;
    struct rd_workspace workspace = {0};
    CHECK_INT(rd_deflection_prepare(&rope->chain, &deflection, &workspace), RD_NO_MEMORY);
    return workspace.used;
}

/* displacement (nodes, width) under the force, solved twice with the same bits; the rope is freed */
static enum rd_status deflect(struct rope rope, const double *force, double *displacement,
                              double *condition)
{
    struct rd_deflection deflection;
    struct rd_workspace workspace = exact_workspace(measure(&rope));
    const size_t entries = rope.chain.nodes * rope.chain.width;
    double *again = zeros(entries);
    CHECK_INT(rd_deflection_prepare(&rope.chain, &deflection, &workspace), RD_OK);
    const enum rd_status status = rd_deflection_solve(&deflection, force, displacement, condition);
    CHECK_INT(rd_deflection_solve(&deflection, force, again, condition), status);
    for (size_t k = 0; status == RD_OK && k < entries; k++)
        CHECK_EXACT(again[k], displacement[k]);
    free(again);
    free(workspace.base);
    rope_free(&rope);
    return status;
}

static const char by_condition[] = "eps over the reciprocal condition reported, times 8";

/* rigid elements carry nodal forces exactly, whatever their number: l^3/192 B at the middle */
static void clamped_beam_gives_way_by_l3_over_192B(size_t elements)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = elements,
        .coordinates = "zb",
        .length = L / (double)elements,
        .section = {.bending = B},
        .left = "zb",
        .right = "zb",
    };
    const size_t middle = elements / 2;
    double *force = zeros(2 * (elements + 1)), *u = zeros(2 * (elements + 1));
    double condition;
    force[2 * middle] = 1;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
    const double expected = L * L * L / (192 * B);
    CHECK(condition > 0 && condition <= 1);
    CHECK_REL(u[2 * middle], expected, 8 * EPS / condition, by_condition);
    CHECK_ABS(u[2 * middle + 1], 0, 8 * EPS / condition * expected / L, by_condition);
    CHECK_EXACT(u[0], 0);
    CHECK_EXACT(u[1], 0);
    CHECK_EXACT(u[2 * elements], 0);
    CHECK_EXACT(u[2 * elements + 1], 0);
    free(force);
    free(u);
}

/* cantilever: z = l^3/3B, beta = l^2/2B; simply supported middle: l^3/48B */
static void cantilever_and_supported_beam(void)
{
    struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 4,
        .coordinates = "zb",
        .length = L / 4,
        .section = {.bending = B},
        .left = "zb",
        .right = "",
    };
    double force[10] = {[8] = 1}, u[10], condition;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
    CHECK_REL(u[8], L * L * L / (3 * B), 8 * EPS / condition, by_condition);
    CHECK_REL(u[9], L * L / (2 * B), 8 * EPS / condition, by_condition);
    recipe.left = recipe.right = "z";
    force[8] = 0;
    force[4] = 1;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
    CHECK_REL(u[4], L * L * L / (48 * B), 8 * EPS / condition, by_condition);
    CHECK_REL(u[1], L * L / (16 * B), 8 * EPS / condition, by_condition);
    CHECK_REL(u[9], -L * L / (16 * B), 8 * EPS / condition, by_condition);
}

/* the tip of a clamped rope moves by its cantilever flexibility, every coupling of S included:
   G = integral P^T S P over the whole length, here from a single element of that length */
static void laid_rope_in_pieces_is_the_laid_rope(double H, double D)
{
    struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 8,
        .coordinates = "xzab",
        .length = L / 8,
        .section = {8.5e5, C, B, D, H},
        .left = "xzab",
        .right = "",
    };
    double S[9], u[36], condition;
    rd_section_flexibility(&recipe.section, S);
    static const int channel[] = {0, 2, 1, 2};
    for (size_t push = 0; push < 4; push++) {
        double force[36] = {0};
        force[32 + push] = 1;
        CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
        for (size_t i = 0; i < 4; i++) {
            const int powers = (i == 1) + (push == 1);
            const double arm = powers == 0 ? L : powers == 1 ? L * L / 2 : L * L * L / 3;
            const double own = S[4 * channel[i]] * (i == 1 ? L * L * L / 3 : L);
            const double pushed = S[4 * channel[push]] * (push == 1 ? L * L * L / 3 : L);
            CHECK_ABS(u[32 + i], S[3 * channel[i] + channel[push]] * arm,
                      8 * EPS / condition * sqrt(own * pushed), by_condition);
        }
    }
}

/* a point force at the middle of a string: l/4T; straight flanks */
static void string_makes_a_triangle(void)
{
    const struct recipe recipe = {
        .elements = 4,
        .coordinates = "z",
        .length = 0.5,
        .tension = 8,
        .left = "z",
        .right = "z",
    };
    const double force[5] = {0, 0, 1, 0, 0};
    static const double expected[] = {0, 1.0 / 32, 1.0 / 16, 1.0 / 32, 0};
    double u[5], condition;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
    for (int k = 0; k < 5; k++)
        CHECK_REL(u[k], expected[k], 16 * EPS, "three unknowns");
    /* scaled stiffness tridiag(-1/2, 1, -1/2): norm 2, its inverse's largest column sum 4 */
    CHECK_REL(condition, 1.0 / 8, 16 * EPS, "closed form; LAPACK's estimate is exact here");
}

/* springs at the ends are in series with the rope: 1/(k1 + k2) and half of what they differ */
static void springs_at_the_ends_carry(void)
{
    const struct recipe recipe = {
        .elements = 2,
        .coordinates = "x",
        .length = 1,
        .section = {.axial = 4},
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    rope.stiffness[LEFT_END] = 2;
    rope.stiffness[RIGHT_END] = 2;
    const double force[3] = {0, 1, 0};
    double u[3], condition;
    CHECK_INT(deflect(rope, force, u, &condition), RD_OK);
    CHECK_REL(u[0], 0.25, 16 * EPS, "three unknowns");
    CHECK_REL(u[1], 0.375, 16 * EPS, "three unknowns");
    CHECK_REL(u[2], 0.25, 16 * EPS, "three unknowns");
}

/* nothing holds it: exactly singular, or singular to rounding */
static void free_rope_is_singular(const char *coordinates, size_t elements, double length)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = elements,
        .coordinates = coordinates,
        .length = length,
        .tension = coordinates[0] == 'z' ? 300 : 0,
        .section = {8.5e5, C, B, 120, 0},
        .inertia = {1, 1, 1, 1},
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    double *force = zeros(rope.chain.nodes * rope.chain.width);
    double *u = zeros(rope.chain.nodes * rope.chain.width);
    double condition;
    force[0] = 1;
    CHECK_INT(deflect(rope, force, u, &condition), RD_SINGULAR);
    free(force);
    free(u);
}

/* a rope that does not resist: zero stiffness */
static void slack_string_is_singular(void)
{
    const struct recipe recipe = {
        .elements = 2,
        .coordinates = "z",
        .length = 1,
        .inertia = {1, 1, 1, 1},
        .left = "z",
        .right = "z",
    };
    const double force[3] = {0, 1, 0};
    double u[3], condition;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_SINGULAR);
}

static void held_chain_does_not_move(void)
{
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "za",
        .length = 1,
        .tension = 1,
        .section = {.torsion = 1},
        .left = "za",
        .right = "za",
    };
    const double force[4] = {1, 2, 3, 4};
    double u[4] = {1, 1, 1, 1}, condition;
    CHECK_INT(deflect(rope_make(&recipe), force, u, &condition), RD_OK);
    for (int k = 0; k < 4; k++)
        CHECK_EXACT(u[k], 0);
    CHECK_EXACT(condition, 1);
}

/* every size that is too small: refused, and nothing is written outside the block */
static void short_memory_is_refused_at_every_size(void)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 2,
        .coordinates = "zb",
        .length = 1,
        .tension = 4,
        .section = {.bending = 1},
        .left = "z",
        .right = "zb",
    };
    struct rope rope = rope_make(&recipe);
    const size_t needed = measure(&rope);
    for (size_t bytes = 0; bytes < needed; bytes += bytes + 8 < needed ? 8 : 1) {
        struct rd_deflection deflection;
        struct rd_workspace workspace = exact_workspace(bytes);
        CHECK_INT(rd_deflection_prepare(&rope.chain, &deflection, &workspace), RD_NO_MEMORY);
        CHECK_INT(workspace.used, needed);
        free(workspace.base);
    }
    rope.flexibility[8] = -1;
    struct rd_deflection deflection;
    struct rd_workspace workspace = exact_workspace(needed);
    CHECK_INT(rd_deflection_prepare(&rope.chain, &deflection, &workspace),
              RD_NOT_POSITIVE_DEFINITE);
    free(workspace.base);
    rope_free(&rope);
}

int main(void)
{
    clamped_beam_gives_way_by_l3_over_192B(2);
    clamped_beam_gives_way_by_l3_over_192B(4);
    clamped_beam_gives_way_by_l3_over_192B(8);
    clamped_beam_gives_way_by_l3_over_192B(64);
    cantilever_and_supported_beam();
    laid_rope_in_pieces_is_the_laid_rope(0, 0);
    laid_rope_in_pieces_is_the_laid_rope(0.01, 0);
    laid_rope_in_pieces_is_the_laid_rope(0.3, 120);
    laid_rope_in_pieces_is_the_laid_rope(-1, -120);
    string_makes_a_triangle();
    springs_at_the_ends_carry();
    free_rope_is_singular("z", 1, 1);
    free_rope_is_singular("z", 8, 0.16875);
    free_rope_is_singular("zb", 8, 0.16875);
    free_rope_is_singular("a", 3, 0.7);
    free_rope_is_singular("xa", 5, 0.3);
    slack_string_is_singular();
    held_chain_does_not_move();
    short_memory_is_refused_at_every_size();
    return check_report("test_deflection");
}
