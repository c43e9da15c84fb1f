/* The lowest modes, certified, against dense matrices and closed forms. */
#include "modes/certify/certify.h"

#include "assembled/assemble.h"
#include "check.h"
#include "modes/count/count.h"
#include "walked.h"

#include <string.h>

enum { HEAVY = MORE };

static const double PI = 3.14159265358979323846;

/* a chain and its modes */
struct solved {
    struct rope rope;
    struct walked walked;
    struct rd_certified modes;
    enum rd_status status;
};

/* one attempt with room for so many steps and pieces */
static enum rd_status solve_in(const struct rd_walk *walk, size_t steps, size_t pieces,
                               struct rd_certified *modes)
{
    struct rd_workspace workspace = {0};
    struct rd_refine refine;
    rd_refine_take(walk, steps, pieces, modes->blocks, &workspace, &refine);
    workspace = exact_workspace(workspace.used);
    rd_refine_take(walk, steps, pieces, modes->blocks, &workspace, &refine);
    CHECK(rd_workspace_fits(&workspace));
    const enum rd_status status = rd_certify(&refine, modes);
    free(workspace.base);
    return status;
}

/* the `wanted` lowest below upper; the rope goes with the answer */
static void solve_below(struct solved *solved, struct rope rope, size_t wanted, double upper)
{
    const size_t n = rope.chain.nodes * rope.chain.width;
    *solved = (struct solved){.rope = rope, .status = RD_NO_MEMORY};
    solved->walked = walked_make(&solved->rope.chain);
    solved->modes = (struct rd_certified){
        .wanted = wanted,
        .upper = upper,
        .blocks = 1,
        .lambda = zeros(wanted),
        .error = zeros(wanted),
        .certified = zeros(wanted),
        .bracket = zeros(4 * wanted),
        .shape = zeros(wanted * n),
    };
    bool most = false;
    for (size_t room = wanted; solved->status == RD_NO_MEMORY && !most;) {
        const size_t blocks = solved->modes.blocks;
        size_t steps, pieces;
        most = rd_certify_size(&solved->walked.walk, room, &steps, &pieces);
        solved->status = solve_in(&solved->walked.walk, steps, pieces, &solved->modes);
        if (solved->modes.blocks > blocks)
            most = false;
        else
            room = 4 * room + 4;
    }
}

static void solve(struct solved *solved, struct rope rope, size_t wanted)
{
    solve_below(solved, rope, wanted, INFINITY);
}

static void solved_free(struct solved *solved)
{
    free(solved->modes.lambda);
    free(solved->modes.error);
    free(solved->modes.certified);
    free(solved->modes.bracket);
    free(solved->modes.shape);
    walked_free(&solved->walked);
    rope_free(&solved->rope);
}

static double *shape_of(const struct solved *solved, size_t k)
{
    return solved->modes.shape + k * solved->rope.chain.nodes * solved->rope.chain.width;
}

/* increasing as far as the errors let them, certified and inside their brackets */
static void check_found(const struct solved *solved, size_t found)
{
    const struct rd_certified *modes = &solved->modes;
    CHECK_INT(solved->status, RD_OK);
    CHECK_INT(modes->found, found);
    for (size_t k = 0; k < modes->found; k++) {
        const double lambda = modes->lambda[k], error = modes->error[k];
        CHECK(k == 0 || lambda + error >= modes->lambda[k - 1] - modes->error[k - 1]);
        CHECK(error >= 0);
        CHECK_EXACT(modes->certified[k], 1);
        CHECK(modes->bracket[k] <= lambda && lambda <= modes->bracket[modes->wanted + k]);
    }
}

/* That, and each is between counts when these are taken again: two side by side share other pieces
   than the eight that made the bracket, so that their rounding, 1e-13 of lambda, is another one, and
   they are taken three times as far away and no nearer than twice that. */
static void check_certified(const struct solved *solved, size_t found)
{
    const struct rd_certified *modes = &solved->modes;
    check_found(solved, found);
    for (size_t k = 0; k < modes->found; k++) {
        const double lambda = modes->lambda[k];
        const double low = modes->bracket[k], high = modes->bracket[modes->wanted + k];
        const double least = 2e-13 * fabs(lambda);
        const double ends[] = {lambda - fmax(3 * (lambda - low), least),
                               lambda + fmax(3 * (high - lambda), least)};
        double count[2];
        rd_count(&solved->walked.walk, 2, ends, count);
        CHECK(count[0] <= (double)k && count[1] > (double)k);
    }
}

/* Against LAPACK's, which know the largest eigenvalue to a few n EPS. */
static void check_dense(const struct solved *solved)
{
    size_t n;
    double *exact = dense_modes(&solved->rope.chain, &n);
    for (size_t k = 0; k < solved->modes.found; k++)
        CHECK_ABS(solved->modes.lambda[k], exact[k],
                  solved->modes.error[k] + 4 * (double)n * EPS * exact[n - 1],
                  "4 n EPS of the largest eigenvalue of the dense matrix, and our own error");
    free(exact);
}

/* x^T A y */
static double form(size_t n, const double *A, const double *x, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            sum += x[i] * A[i * n + j] * y[j];
    return sum;
}

/* The shapes are M-orthogonal: those of a cluster, within a relative 1e-8, are made so; the others
   have in them what 1e-13 of the gap in the last step leaves and, of each other, their errors over
   the gap between them. */
static void check_orthogonal(const struct solved *solved)
{
    static const double inertia[RD_PARTS] = {[RD_MASS] = 1};
    const struct rd_chain *chain = &solved->rope.chain;
    const struct rd_certified *modes = &solved->modes;
    const size_t n = chain->nodes * chain->width;
    double *M = rope_dense(chain, inertia);
    for (size_t a = 0; a < modes->found; a++)
        for (size_t b = 0; b < a; b++) {
            const double *x = shape_of(solved, a), *y = shape_of(solved, b);
            const double size = sqrt(form(n, M, x, x) * form(n, M, y, y));
            const double gap = modes->lambda[a] - modes->lambda[b];
            const double mixed = (modes->error[a] + modes->error[b]) / gap;
            const bool cluster = gap < 1e-8 * fabs(modes->lambda[a]);
            CHECK_ABS(form(n, M, x, y), 0, (cluster ? 1e-9 : 1e-9 + 2 * mixed) * size,
                      "errors over gaps, and none in clusters");
        }
    free(M);
}

/* every coupling that the coordinates can have, and a mass in each of them */
static const struct recipe beam = {
    .kind = RD_TENSED,
    .elements = 16,
    .coordinates = "zb",
    .length = 0.08,
    .tension = 300,
    .section =
        {.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626, .coupling = 120, .slope = 0.3},
    .inertia = {0.008, 0.008, 1e-6, 1e-6},
    .left = "xzab",
    .right = "xzab",
    .more = 1,
};

static struct recipe recipe_of(enum rd_kind kind, const char *names)
{
    struct recipe recipe = beam;
    recipe.kind = kind;
    recipe.coordinates = names;
    return recipe;
}

static void clamped_chain_has_the_modes_of_its_matrix(enum rd_kind kind, const char *names)
{
    for (int gathered = 0; gathered < 2; gathered++) {
        struct solved solved;
        const struct recipe recipe = recipe_of(kind, names);
        struct rope rope = rope_make(&recipe);
        if (gathered)
            rope_gather(&rope);
        solve(&solved, rope, 7);
        check_certified(&solved, 7);
        CHECK_INT(solved.modes.existing, 15 * strlen(names));
        CHECK_INT(solved.modes.rigid, 0);
        check_dense(&solved);
        check_orthogonal(&solved);
        solved_free(&solved);
    }
}

/* shapes sin(k pi i/n) */
static void string_has_its_closed_form(void)
{
    struct solved solved;
    struct rope rope = rope_make(&long_string);
    rope_gather(&rope);
    solve(&solved, rope, 10);
    check_certified(&solved, 10);
    CHECK_INT(solved.modes.existing, 999);
    for (size_t k = 0; k < solved.modes.found; k++) {
        const double x = (double)(k + 1) * PI / 1000;
        const double exact = long_string_eigenvalue(k + 1);
        const double *u = shape_of(&solved, k);
        CHECK_ABS(solved.modes.lambda[k], exact, solved.modes.error[k] + 8 * EPS * exact,
                  "the bound that is reported, and the closed form's own");
        CHECK(solved.modes.error[k] < 1e-12 * exact);
        const double peak = u[1] / sin(x);
        for (size_t i = 0; i <= 1000; i++)
            CHECK_ABS(u[i] / peak, sin((double)i * x), 1e-10,
                      "1e-13 of the gap in the last step, times the slope at the left end, 1000/3");
    }
    solved_free(&solved);
}

/* a mass of so many kg stands: each half has the other's frequency, split by rope over mass */
static void cluster_about_a_heavy_mass(enum rd_kind kind, const char *names, double mass)
{
    struct recipe recipe = recipe_of(kind, names);
    struct solved solved;
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    for (size_t i = 0; i < w; i++)
        rope.mass[HEAVY * w * w + i * (w + 1)] = mass;
    rope.term_of[8] = HEAVY;
    rope_gather(&rope);
    solve(&solved, rope, w + 4);
    check_certified(&solved, w + 4);
    check_dense(&solved);
    for (size_t k = w; k + 1 < solved.modes.found; k += 2)
        CHECK_REL(solved.modes.lambda[k], solved.modes.lambda[k + 1], 10 / mass,
                  "ten times the share of 0.1 kg and 1e-5 kg m^2 in the mass");
    check_orthogonal(&solved);
    solved_free(&solved);
}

/* rigid motions are 0 to the last bit, come first and are M-orthonormal */
static void free_chain_begins_with_its_rigid_motions(enum rd_kind kind, const char *names,
                                                     double tension, size_t rigid)
{
    static const double inertia[RD_PARTS] = {[RD_MASS] = 1};
    struct recipe recipe = recipe_of(kind, names);
    struct solved solved;
    recipe.tension = tension;
    recipe.left = recipe.right = "";
    struct rope rope = rope_make(&recipe);
    const size_t n = rope.chain.nodes * rope.chain.width;
    double *M = rope_dense(&rope.chain, inertia);
    rope_gather(&rope);
    solve(&solved, rope, rigid + 5);
    check_certified(&solved, rigid + 5);
    check_dense(&solved);
    CHECK_INT(solved.modes.rigid, rigid);
    for (size_t k = 0; k < rigid && k < solved.modes.found; k++) {
        const double *u = shape_of(&solved, k);
        CHECK_EXACT(solved.modes.lambda[k], 0);
        CHECK_EXACT(solved.modes.error[k], 0);
        CHECK_REL(form(n, M, u, u), 1, 256 * EPS, "sums over 17 nodes");
    }
    CHECK(solved.modes.found > rigid && solved.modes.lambda[rigid] > 0);
    free(M);
    solved_free(&solved);
}

/* Two bodies joined by a free hinge: three motions, of which two are the rigid ones of the whole. The
   third is zero to EPS of the largest eigenvalue, and so are counts about it. */
static void free_hinge_adds_a_motion(enum rd_kind kind)
{
    double hinge[4 * 2] = {0};
    struct recipe recipe = recipe_of(kind, "zb");
    struct solved solved;
    recipe.tension = 0;
    recipe.left = recipe.right = "";
    struct rope rope = rope_make(&recipe);
    hinge[HEAVY * 2 + 1] = INFINITY;
    memcpy(rope.mass + HEAVY * 4, rope.mass + INNER * 4, 4 * sizeof *rope.mass);
    rope.term_of[6] = HEAVY;
    rope.chain.hinge = hinge;
    rope_gather(&rope);
    solve(&solved, rope, 6);
    check_found(&solved, 6);
    check_dense(&solved);
    solved_free(&solved);
}

/* pinned, under load of so many of Euler's: as many are negative */
static void buckled_chain_has_negative_eigenvalues(enum rd_kind kind, double loads)
{
    struct recipe recipe = recipe_of(kind, "zb");
    struct solved solved;
    const double length = 16 * recipe.length;
    recipe.left = recipe.right = "z";
    recipe.section = (struct rd_section){.bending = 54.626};
    recipe.tension = -loads * loads * PI * PI / length / length * 54.626;
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    solve(&solved, rope, 8);
    check_certified(&solved, 8);
    check_dense(&solved);
    size_t negative = 0;
    for (size_t k = 0; k < solved.modes.found; k++)
        negative += solved.modes.lambda[k] < 0;
    CHECK_INT(negative, (size_t)loads);
    solved_free(&solved);
}

static void no_more_are_found_than_exist(void)
{
    struct recipe recipe = long_string;
    struct solved solved;
    recipe.elements = 10;
    recipe.length = 0.1;
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    solve(&solved, rope, 30);
    check_certified(&solved, 9);
    CHECK_INT(solved.modes.existing, 9);
    check_dense(&solved);
    solved_free(&solved);
}

/* beta without inertia: as many modes as z */
static void massless_coordinates_have_no_modes(void)
{
    struct recipe recipe = recipe_of(RD_TENSED, "zb");
    struct solved solved;
    recipe.inertia[RD_BETA] = 0;
    recipe.elements = 8;
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    solve(&solved, rope, 20);
    check_certified(&solved, 7);
    CHECK_INT(solved.modes.existing, 7);
    check_orthogonal(&solved);
    solved_free(&solved);
}

/* upper between the fourth and the fifth of the string */
static void none_above_the_limit_is_found(void)
{
    struct solved solved;
    const double s = sin(4.5 * PI / 2000), upper = 4 * 300 / 1e-4 / 1e-3 * s * s;
    struct rope rope = rope_make(&long_string);
    rope_gather(&rope);
    solve_below(&solved, rope, 10, upper);
    check_certified(&solved, 4);
    CHECK_INT(solved.modes.existing, 4);
    solved_free(&solved);
    rope = rope_make(&long_string);
    rope_gather(&rope);
    solve_below(&solved, rope, 10, 1e-3);
    check_certified(&solved, 0);
    CHECK_INT(solved.modes.existing, 0);
    solved_free(&solved);
}

static void a_limit_that_is_no_number_is_refused(void)
{
    struct solved solved;
    solve_below(&solved, rope_make(&beam), 3, NAN);
    CHECK_INT(solved.status, RD_NO_CONVERGENCE);
    CHECK_INT(solved.modes.found, 0);
    solved_free(&solved);
}

static void nothing_wanted_is_nothing_found(void)
{
    struct solved solved;
    solve(&solved, rope_make(&beam), 0);
    check_certified(&solved, 0);
    solved_free(&solved);
}

/* room for one step and one piece, or for none */
static void too_little_room_is_no_memory(size_t room)
{
    struct solved solved;
    struct rope rope = rope_make(&long_string);
    rope_gather(&rope);
    solve(&solved, rope, 3);
    CHECK_INT(solve_in(&solved.walked.walk, room, room, &solved.modes), RD_NO_MEMORY);
    CHECK_INT(solved.modes.found, 0);
    CHECK_INT(solve_in(&solved.walked.walk, 1000, room, &solved.modes), RD_NO_MEMORY);
    CHECK_INT(solve_in(&solved.walked.walk, room, 12, &solved.modes), RD_NO_MEMORY);
    solved_free(&solved);
}

/* what rd_certify_size says is the most is enough for every mode there is */
static void largest_size_is_enough(void)
{
    struct recipe recipe = long_string;
    struct solved solved;
    size_t steps, pieces;
    recipe.elements = 40;
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    solve(&solved, rope, 39);
    CHECK(rd_certify_size(&solved.walked.walk, 39, &steps, &pieces));
    CHECK_INT(steps, 40);
    CHECK_INT(solve_in(&solved.walked.walk, steps, pieces, &solved.modes), RD_OK);
    check_certified(&solved, 39);
    check_dense(&solved);
    solved_free(&solved);
}

/* nine equal strings between eight masses of 1e12 kg have nine equal frequencies */
static void nine_modes_in_one_place_are_found_by_two_blocks(void)
{
    struct recipe recipe = long_string;
    struct solved solved;
    recipe.elements = 36;
    struct rope rope = rope_make(&recipe);
    rope.mass[HEAVY] = 1e12;
    for (size_t k = 4; k < 36; k += 4)
        rope.term_of[k] = HEAVY;
    rope_gather(&rope);
    solve(&solved, rope, 17);
    CHECK_INT(solved.modes.blocks, 2);
    check_certified(&solved, 17);
    for (size_t i = 9; i < 17; i++)
        CHECK_REL(solved.modes.lambda[i], solved.modes.lambda[8], 1e-11, "rope over masses, 1e-13");
    solved_free(&solved);
}

/* a spring of -1e6 N m where nothing has inertia: no K - lambda M is positive */
static void negative_stiffness_without_mass_is_refused(void)
{
    struct recipe recipe = recipe_of(RD_TENSED, "zb");
    struct solved solved;
    recipe.inertia[RD_BETA] = 0;
    struct rope rope = rope_make(&recipe);
    memcpy(rope.mass + HEAVY * 4, rope.mass + INNER * 4, 4 * sizeof *rope.mass);
    rope.stiffness[HEAVY * 4 + 3] = -1e6;
    rope.term_of[5] = HEAVY;
    rope_gather(&rope);
    solve(&solved, rope, 3);
    CHECK_INT(solved.status, RD_UNSTABLE_MASSLESS);
    CHECK_INT(solved.modes.found, 0);
    solved_free(&solved);
}

/* shapes are not asked for: fewer iterations, the same eigenvalues within their errors */
static void eigenvalues_do_not_need_shapes(void)
{
    struct solved solved;
    size_t steps, pieces;
    double lambda[5];
    struct rope rope = rope_make(&beam);
    rope_gather(&rope);
    solve(&solved, rope, 5);
    memcpy(lambda, solved.modes.lambda, sizeof lambda);
    struct rd_certified bare = solved.modes;
    bare.shape = NULL;
    rd_certify_size(&solved.walked.walk, 100, &steps, &pieces);
    CHECK_INT(solve_in(&solved.walked.walk, steps, pieces, &bare), RD_OK);
    for (size_t k = 0; k < 5; k++)
        CHECK_ABS(bare.lambda[k], lambda[k], bare.error[k], "its own bound");
    solved_free(&solved);
}

static void both_kinds(enum rd_kind kind)
{
    static const char *const names[] = {"zb", "zab", "xzab"};
    for (size_t k = 0; k < 3; k++)
        clamped_chain_has_the_modes_of_its_matrix(kind, names[k]);
    for (double mass = 1e3; mass < 1e13; mass *= 1e3)
        cluster_about_a_heavy_mass(kind, "zb", mass);
    free_chain_begins_with_its_rigid_motions(kind, "zb", 0, 2);
    free_chain_begins_with_its_rigid_motions(kind, "zb", 300, 1);
    free_chain_begins_with_its_rigid_motions(kind, "xzab", 0, 4);
    free_hinge_adds_a_motion(kind);
    buckled_chain_has_negative_eigenvalues(kind, 1.5);
    buckled_chain_has_negative_eigenvalues(kind, 3.5);
}

static struct rope span_of(const char *names, size_t elements, double length, double tension,
                           const char *left, const char *right)
{
    const struct recipe recipe = {
        .kind = RD_CONTINUOUS,
        .elements = elements,
        .coordinates = names,
        .length = length / (double)elements,
        .tension = tension,
        .section = {.axial = 8.5e5, .torsion = 0.1485, .bending = 54.626},
        .inertia = {0.1, 0.1, 2e-6, 3e-5},
        .left = left,
        .right = right,
    };
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    return rope;
}

/* lambda_k = p^2 (B p^2 + T)/(mu + j p^2), z = sin(p x), beta = p cos(p x), p = k pi/L; without
   bending p^2 T/mu. There is no end of modes. */
static void continuous_span_has_the_modes_of_its_closed_form(const char *names, size_t elements)
{
    const double L = 1.5, j = names[1] ? 3e-5 : 0, B = names[1] ? 54.626 : 0;
    struct solved solved;
    solve(&solved, span_of(names, elements, L, 300, "z", "z"), 12);
    check_certified(&solved, 12);
    CHECK_INT(solved.modes.rigid, 0);
    const size_t w = solved.rope.chain.width;
    for (size_t k = 0; k < solved.modes.found; k++) {
        const double p = (double)(k + 1) * PI / L;
        const double exact = p * p * (B * p * p + 300) / (0.1 + j * p * p);
        const double *u = shape_of(&solved, k);
        CHECK_ABS(solved.modes.lambda[k], exact, solved.modes.error[k] + 8 * EPS * exact,
                  "the bound that is reported, and the closed form's own");
        CHECK(solved.modes.error[k] < 1e-12 * exact);
        if (w == 1)
            continue;
        for (size_t i = 0; i <= elements; i++) {
            const double x = (double)i / (double)elements * L;
            CHECK_ABS(u[i * w] * p, u[1] * sin(p * x), 1e-10 * fabs(u[1]),
                      "1e-13 of the gap in the last step, times the slope at the left end");
            CHECK_ABS(u[i * w + 1], u[1] * cos(p * x), 1e-10 * fabs(u[1]), "the same");
        }
    }
    solved_free(&solved);
}

/* cosh(x) cos(x) = -1 of the cantilever, +1 free, where two are rigid: lambda = B (x/L)^4/mu */
static void continuous_cantilever_and_free_beam_have_their_classical_modes(void)
{
    for (size_t rigid = 0; rigid <= 2; rigid += 2) {
        struct solved solved;
        struct rope rope = span_of("zb", 3, 1.5, 0, rigid ? "" : "zb", "");
        rope.inertia[1] = 0;
        solve(&solved, rope, 8);
        check_certified(&solved, 8);
        CHECK_INT(solved.modes.rigid, rigid);
        for (size_t k = rigid; k < solved.modes.found; k++) {
            double x = ((double)(k - rigid) + (rigid ? 1.5 : 0.5)) * PI;
            for (int i = 0; i < 20; i++) {
                const double f = cos(x) - (rigid ? 1 : -1) / cosh(x);
                x += f / (sin(x) - (rigid ? 1 : -1) * tanh(x) / cosh(x));
            }
            const double k4 = pow(x / 1.5, 4);
            CHECK_ABS(solved.modes.lambda[k], 54.626 * k4 / 0.1,
                      solved.modes.error[k] + 64 * EPS * 546.26 * k4,
                      "the bound that is reported, and four times the root's own");
        }
        solved_free(&solved);
    }
}

/* Without inertia of its own a span is a spring, however many boundary layers it has: between two of
   length a that are clamped outside, xi = a sqrt(T/B), a mass m has lambda = K/m with
   K = 2 T/(a - 2 tanh(xi/2)/sqrt(T/B)), symmetric, and a rotation without mass none. */
static void massless_span_is_a_spring(double tension)
{
    struct solved solved;
    struct rope rope = span_of("zb", 2, 3, tension, "zb", "zb");
    const double r = sqrt(tension / 54.626), mass = 0.7;
    rope.inertia[0] = rope.inertia[1] = 0;
    rope.mass[INNER * 4] = mass;
    solve(&solved, rope, 3);
    check_certified(&solved, 1);
    CHECK_INT(solved.modes.existing, 1);
    const double exact = 2 * tension / (1.5 - 2 * tanh(1.5 * r / 2) / r) / mass;
    CHECK_ABS(solved.modes.lambda[0], exact, solved.modes.error[0] + 64 * EPS * exact,
              "the bound that is reported, and tanh(xi/2), which takes at most 3/4 of xi/2 away");
    solved_free(&solved);
}

/* 1e25 boundary layers of a plain rope are its stiffness, and a string is left: L^2 lambda = k^2 pi^2 T/mu */
static void boundary_layers_beyond_number_leave_a_string(void)
{
    struct solved solved;
    solve(&solved, span_of("zb", 2, 1e12, 1e30, "zb", "zb"), 3);
    check_certified(&solved, 3);
    for (size_t k = 0; k < 3; k++) {
        const double p = (double)(k + 1) * PI / 1e12, exact = p * p * 1e30 / (0.1 + 3e-5 * p * p);
        CHECK_REL(solved.modes.lambda[k], exact, 64 * EPS, "four times the root's own");
    }
    solved_free(&solved);
}

/* one that twists as it bends has as many pieces, which is more than are walked */
static void more_waves_than_are_walked_have_no_modes(void)
{
    struct solved solved;
    struct rope rope = span_of("zab", 2, 1e12, 1e40, "zab", "zab");
    for (size_t e = 0; e < rope.chain.distinct; e++)
        rope.flexibility[9 * e + 5] = rope.flexibility[9 * e + 7] = 1e-3;
    solve(&solved, rope, 3);
    CHECK_INT(solved.status, RD_SHORT_WAVES);
    CHECK_INT(solved.modes.found, 0);
    solved_free(&solved);
}

int main(void)
{
    both_kinds(RD_RIGID);
    both_kinds(RD_TENSED);
    clamped_chain_has_the_modes_of_its_matrix(RD_TENSED, "x");
    clamped_chain_has_the_modes_of_its_matrix(RD_TENSED, "za");
    string_has_its_closed_form();
    no_more_are_found_than_exist();
    massless_coordinates_have_no_modes();
    none_above_the_limit_is_found();
    a_limit_that_is_no_number_is_refused();
    nothing_wanted_is_nothing_found();
    too_little_room_is_no_memory(0);
    too_little_room_is_no_memory(1);
    largest_size_is_enough();
    nine_modes_in_one_place_are_found_by_two_blocks();
    negative_stiffness_without_mass_is_refused();
    eigenvalues_do_not_need_shapes();
    for (size_t elements = 1; elements < 30; elements *= 5) {
        continuous_span_has_the_modes_of_its_closed_form("z", elements);
        continuous_span_has_the_modes_of_its_closed_form("zb", elements);
    }
    continuous_cantilever_and_free_beam_have_their_classical_modes();
    for (double tension = 300; tension < 1e9; tension *= 100)
        massless_span_is_a_spring(tension);
    boundary_layers_beyond_number_leave_a_string();
    more_waves_than_are_walked_have_no_modes();
    return check_report("test_certify");
}
