/* Natural frequencies and shapes against closed forms, at every kind of edge. */
#include "assembled/modes.h"

#include "chains.h"
#include "check.h"

#include <stdint.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* the 2015 study's rope, its mass read as that of the whole rope */
static const double B = 54.626, C = 0.1485, L = 1.35, MU = 0.13725 / 1.35;

/* a chain and its modes */
struct solved {
    struct rope rope;
    struct rd_modes modes;
    struct rd_workspace workspace;
    size_t found;
    double *eigenvalue; /* (found) */
    double *rounding;   /* (found) */
    double *shape;      /* (found, nodes, width) */
};

static size_t measure(const struct rope *rope, size_t columns)
{
    struct rd_modes modes;
    struct rd_workspace workspace = {0};
    CHECK_INT(rd_modes_prepare(&rope->chain, columns, &modes, &workspace), RD_NO_MEMORY);
    return workspace.used;
}

static void reduce(struct rd_modes *modes, size_t slice)
{
    const size_t n = modes->system.free;
    for (int side = 0; side < 2; side++) {
        for (size_t start = 0; start < n; start += slice)
            rd_modes_reduce(modes, start, start + slice < n ? start + slice : n);
        if (side == 0)
            rd_modes_transpose(modes);
    }
}

static double *shape_of(const struct solved *solved, size_t k)
{
    return solved->shape + k * solved->rope.chain.nodes * solved->rope.chain.width;
}

/* the `wanted` lowest, or with wanted = 0 all below; the rope goes with the answer */
static enum rd_status solve(struct solved *solved, struct rope rope, size_t wanted, double below,
                            double scale, size_t slice)
{
    const size_t columns = wanted > 0 ? wanted : SIZE_MAX;
    memset(solved, 0, sizeof *solved);
    solved->rope = rope;
    solved->workspace = exact_workspace(measure(&rope, columns));
    CHECK_INT(rd_modes_prepare(&solved->rope.chain, columns, &solved->modes, &solved->workspace),
              RD_OK);
    enum rd_status status = rd_modes_factorise(&solved->modes, scale);
    if (status != RD_OK)
        return status;
    reduce(&solved->modes, slice);
    status = rd_modes_solve(&solved->modes, wanted, below, &solved->found);
    if (status != RD_OK)
        return status;
    solved->eigenvalue = zeros(solved->found);
    solved->rounding = zeros(solved->found);
    solved->shape = zeros(solved->found * rope.chain.nodes * rope.chain.width);
    for (size_t k = 0; k < solved->found; k++) {
        rd_modes_read(&solved->modes, k, solved->eigenvalue + k, solved->rounding + k,
                      shape_of(solved, k));
        CHECK(solved->rounding[k] >= 0);
        CHECK(k == 0 || solved->eigenvalue[k] >= solved->eigenvalue[k - 1]);
    }
    return RD_OK;
}

static void solved_free(struct solved *solved)
{
    free(solved->eigenvalue);
    free(solved->rounding);
    free(solved->shape);
    free(solved->workspace.base);
    rope_free(&solved->rope);
}

static const char estimate[] = "the error estimate reported with the mode";

/* ---- strings and torsion chains ---- */

/* m = 0.01715625 kg every 0.16875 m under 300 N */
static const struct recipe string = {
    .elements = 9,
    .coordinates = "z",
    .length = 0.16875,
    .tension = 300,
    .inertia = {[RD_Z] = 0.01715625},
    .left = "z",
    .right = "z",
};

/* omega_k = 2 sqrt(T/(m a)) sin(k pi/(2 (n + 1))) for n masses */
static double string_eigenvalue(size_t k)
{
    const double s = 2 * sin((double)k * PI / 18);
    return 300 / 0.16875 / 0.01715625 * s * s;
}

static void fixed_string_has_its_discrete_frequencies(void)
{
    /* [Hz], lumped_chains_closed_form.json: 35 digits */
    static const double golden[] = {17.792948054658482, 35.045266386342316, 51.232752032637601,
                                    65.863556433444625, 78.493130000589121, 88.737729532105996,
                                    96.286078055247604, 100.90882281978694};
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&string), 8, 0, 1e4, 64), RD_OK);
    CHECK_INT(solved.found, 8);
    CHECK_INT(solved.modes.finite, 8);
    CHECK_EXACT(solved.modes.shift, 0);
    for (size_t k = 0; k < solved.found; k++) {
        const double expected = string_eigenvalue(k + 1);
        CHECK_REL(sqrt(solved.eigenvalue[k]) / (2 * PI), golden[k], 2e-14,
                  "eps of the largest of eight mu, 1/lambda: 32 eps, plus the assembly's");
        CHECK_ABS(solved.eigenvalue[k], expected, solved.rounding[k] + 8 * EPS * expected,
                  estimate);
        CHECK(solved.rounding[k] < 1e-13 * solved.eigenvalue[7]);
        const double *u = shape_of(&solved, k);
        const double peak = u[1] / sin((double)(k + 1) * PI / 9);
        CHECK_EXACT(u[0], 0);
        CHECK_EXACT(u[9], 0);
        for (size_t j = 1; j < 9; j++)
            CHECK_ABS(u[j] / peak, sin((double)((k + 1) * j) * PI / 9), 1e-12,
                      "eps over the relative gap of neighbouring mu, 0.02, times 100");
    }
    solved_free(&solved);
}

/* clamped-free with half a disc at the end: sin((2k - 1) pi/4n) */
static void torsion_chain_with_half_a_disc_at_its_end(void)
{
    static const double golden[] = {92.553637339444319, 274.10412764005591, 445.12095003482590,
                                    599.03202394646218, 729.92263311886524, 832.76272484583892,
                                    903.60021207570349, 939.71284990033578};
    const struct recipe recipe = {
        .elements = 8,
        .coordinates = "a",
        .length = 0.16875,
        .section = {.torsion = C},
        .inertia = {[RD_ALPHA] = 1e-7},
        .left = "a",
        .right = "",
    };
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 8, 0, 1e4, 64), RD_OK);
    for (size_t k = 0; k < 8; k++)
        CHECK_REL(sqrt(solved.eigenvalue[k]) / (2 * PI), golden[k], 4e-14,
                  "eps of the largest of eight mu, 1/lambda: 104 eps, plus the assembly's");
    solved_free(&solved);
}

/* halves at both ends, N nodes: 2 sqrt(k/m) sin(k pi/(2 (N - 1))), the first of them zero */
static void free_string_has_one_rigid_mode(void)
{
    struct recipe recipe = string;
    recipe.left = recipe.right = "";
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 10, 0, 1e4, 64), RD_OK);
    CHECK_INT(solved.modes.finite, 10);
    CHECK(solved.modes.shift > 0);
    CHECK_ABS(solved.eigenvalue[0], 0, solved.rounding[0], estimate);
    CHECK(solved.rounding[0] < 1e-11 * string_eigenvalue(1));
    for (size_t k = 1; k < 10; k++)
        CHECK_ABS(solved.eigenvalue[k], string_eigenvalue(k),
                  solved.rounding[k] + 8 * EPS * string_eigenvalue(k), estimate);
    const double *u = shape_of(&solved, 0);
    for (size_t j = 1; j < 10; j++)
        CHECK_REL(u[j], u[0], 1e-11, "rounding of the rigid eigenvalue against the second");
    solved_free(&solved);
}

/* a free chain's stiffness is singular: where rounding makes it positive definite it is shifted all
   the same, whatever the last bits of its elements */
static void free_chain_is_shifted_whatever_its_last_bits(void)
{
    for (size_t n = 1; n < 40; n++) {
        struct recipe recipe = string;
        recipe.left = recipe.right = "";
        recipe.elements = n;
        recipe.length = 0.1 + 0.01 * (double)n;
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&recipe), 1, 0, 1e4, 64), RD_OK);
        CHECK(solved.modes.shift > 0);
        CHECK_ABS(solved.eigenvalue[0], 0, solved.rounding[0], estimate);
        solved_free(&solved);
    }
}

/* stretching and twisting with the same ratio of stiffness and inertia: every eigenvalue twice */
static void repeated_eigenvalues_have_orthogonal_shapes(void)
{
    const struct recipe recipe = {
        .elements = 6,
        .coordinates = "xa",
        .length = 0.5,
        .section = {.axial = 64, .torsion = 4},
        .inertia = {[RD_X] = 1, [RD_ALPHA] = 0.0625},
        .left = "xa",
        .right = "xa",
    };
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 10, 0, 1, 64), RD_OK);
    CHECK_INT(solved.found, 10);
    for (size_t k = 0; k < 10; k++) {
        const double s = 2 * sin((double)(k / 2 + 1) * PI / 12);
        CHECK_REL(solved.eigenvalue[k], 128 * s * s, 100 * EPS,
                  "eps of the largest mu: 14 eps, plus the assembly's");
        for (size_t j = 0; j <= k; j++) {
            double kk = 0, jj = 0, jk = 0;
            for (size_t i = 0; i < 14; i++) {
                const double m = i % 2 ? 0.0625 : 1;
                kk += m * shape_of(&solved, k)[i] * shape_of(&solved, k)[i];
                jj += m * shape_of(&solved, j)[i] * shape_of(&solved, j)[i];
                jk += m * shape_of(&solved, j)[i] * shape_of(&solved, k)[i];
            }
            CHECK_ABS(jk / sqrt(jj * kk), j == k, 1e-13,
                      "LAPACK's vectors are orthogonal to n eps");
        }
    }
    solved_free(&solved);
}

/* ---- bending ---- */

static struct recipe beam(size_t n, double tension, const char *held)
{
    const double a = L / (double)n;
    return (struct recipe){
        .kind = RD_RIGID,
        .elements = n,
        .coordinates = "zb",
        .length = a,
        .tension = tension,
        .section = {.bending = B},
        .inertia = {[RD_Z] = MU * a, [RD_BETA] = MU * a * a * a / 12},
        .left = held,
        .right = held,
    };
}

/* omega^2 of rigid_chain_exact.json, 50 digits, certified there by Sturm counts */
static void beam_chain_has_its_exact_discrete_frequencies(void)
{
    static const struct {
        double tension;
        const char *held;
        double golden[5];
    } example[] = {
        {0,
         "zb",
         {79683.456578122885, 579715.82138946261, 2084854.9729278583, 5215304.9778829278,
          10443865.870825390}},
        {300,
         "zb",
         {98204.239572273187, 643162.47997481650, 2203150.7101093215, 5386231.2023662791,
          10655908.196607587}},
        {300,
         "z",
         {31132.398491230670, 297395.14561042023, 1255639.2085997383, 3490355.6590973689,
          7527408.3492224552}},
    };
    for (size_t e = 0; e < sizeof example / sizeof *example; e++) {
        const struct recipe recipe = beam(8, example[e].tension, example[e].held);
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&recipe), 5, 0, 1e5, 64), RD_OK);
        for (size_t k = 0; k < 5; k++) {
            CHECK_ABS(solved.eigenvalue[k], example[e].golden[k], solved.rounding[k], estimate);
            CHECK(solved.rounding[k] < 1e-11 * solved.eigenvalue[k]);
        }
        CHECK_REL(solved.eigenvalue[0], example[e].golden[0], 2e-13,
                  "condition of the assembled stiffness, n^4/10 = 400, times eps and 2");
        solved_free(&solved);
    }
}

/* assembled/modes.h promises 2e-11 of f1 at 64 elements: 4e-11 of its square */
static void sixty_four_elements_keep_eleven_digits(void)
{
    static const double golden[] = {80953.673541263911, 614704.73181502181, 2359875.8479322378,
                                    6439026.4704627847, 14341890.235551941};
    const struct recipe recipe = beam(64, 0, "zb");
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 5, 0, 1e5, 64), RD_OK);
    CHECK_REL(solved.eigenvalue[0], golden[0], 4e-11, "promised in assembled/modes.h");
    for (size_t k = 0; k < 5; k++)
        CHECK_ABS(solved.eigenvalue[k], golden[k], solved.rounding[k], estimate);
    solved_free(&solved);
}

/* pinned chain of n elements with point masses and no rotary inertia, c = cos(k pi/n):
   lambda mu a^4/B = 2 a11 (1 - c) - 4 a12^2 (1 - c^2)/(2 a22 + 2 a23 c),
   a11 = 12 + T a^2/B, a12 = 6, a22 = 4, a23 = 2 */
static double pinned_eigenvalue(size_t n, size_t k, double tension)
{
    const double a = L / (double)n, c = cos((double)k * PI / (double)n);
    const double a11 = 12 + tension * a * a / B;
    const double scaled = 2 * a11 * (1 - c) - 144 * (1 - c * c) / (8 + 4 * c);
    return scaled * B / (MU * a * a * a * a);
}

static const char massless_reason[] = "the error estimate reported, and cancellation of 24 in the "
                                      "closed form";

/* rotations without inertia give no modes of their own; beyond the critical load (for n = 8
   1.052 times Euler's) the lowest eigenvalue is negative */
static void massless_rotations_and_buckling(double load)
{
    const size_t n = 8;
    const double euler = PI * PI * B / (L * L), a = L / (double)n;
    const double own = 24 * 4 * EPS * B / (MU * a * a * a * a);
    struct recipe recipe = beam(n, -load * euler, "z");
    recipe.inertia[RD_BETA] = 0;
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 7, 0, 1e4, 64), RD_OK);
    CHECK_INT(solved.modes.finite, 7);
    CHECK_INT(solved.modes.system.free, 16);
    CHECK_INT(solved.found, 7);
    CHECK((solved.eigenvalue[0] < 0) == (load > 1.06));
    CHECK((solved.modes.shift > 0) == (load > 1.06));
    for (size_t k = 0; k < 7; k++)
        CHECK_ABS(solved.eigenvalue[k], pinned_eigenvalue(n, k + 1, -load * euler),
                  solved.rounding[k] + own, massless_reason);
    solved_free(&solved);
}

/* two rigid motions near zero, then what the clamped beam has: the continuum's frequencies are the
   same, the lumped chains' differ by 3 % */
static void free_beam_has_two_rigid_modes(void)
{
    const struct recipe recipe = beam(32, 0, "");
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 4, 0, 1e4, 64), RD_OK);
    for (size_t k = 0; k < 2; k++) {
        CHECK_ABS(solved.eigenvalue[k], 0, solved.rounding[k], estimate);
        CHECK(solved.rounding[k] < 1e-6 * solved.eigenvalue[2]);
    }
    CHECK_REL(solved.eigenvalue[2], pow(4.7300407448627040, 4) * B / (MU * L * L * L * L), 0.03,
              "second order in 1/32");
    solved_free(&solved);
}

/* |K x - lambda M x| in scaled coordinates, with every coupling of a laid rope */
static void shapes_satisfy_the_equations_of_motion(double tension, const char *left)
{
    static const double K_of[RD_PARTS] = {1, 1, 1, 0}, M_of[RD_PARTS] = {0, 0, 0, 1};
    struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 10,
        .coordinates = "xzab",
        .length = 0.135,
        .tension = tension,
        .section = {8.5e5, C, B, 120, 0.3},
        .inertia = {0.0114, 0.0114, 2.4e-8, 7.8e-5},
        .left = left,
        .right = "z",
        .more = 1,
    };
    struct rope rope = rope_make(&recipe);
    rope.term_of[4] = MORE; /* a heavy spot on a spring */
    rope.mass[MORE * 16 + 5] = 0.2;
    rope.stiffness[MORE * 16 + 5] = 5e3;
    struct solved solved;
    CHECK_INT(solve(&solved, rope, 12, 0, 1e4, 7), RD_OK);
    CHECK_INT(solved.found, 12);
    double *K = rope_dense(&solved.rope.chain, K_of), *M = rope_dense(&solved.rope.chain, M_of);
    const struct rd_system *system = &solved.modes.system;
    const double shift = solved.modes.shift, first = solved.eigenvalue[0] + shift;
    for (size_t k = 0; k < solved.found; k++) {
        const double *x = shape_of(&solved, k), lambda = solved.eigenvalue[k];
        double work = 0;
        for (size_t i = 0; i < 44; i++)
            for (size_t j = 0; j < 44; j++)
                work += x[i] * (K[44 * i + j] + shift * M[44 * i + j]) * x[j];
        for (size_t i = 0; i < 44; i++) {
            double force = 0;
            for (size_t j = 0; j < 44; j++)
                force += (K[44 * i + j] - lambda * M[44 * i + j]) * x[j];
            if (system->number[i] < 0)
                CHECK_EXACT(x[i], 0);
            else
                CHECK_ABS(force * system->scale[system->number[i]] / sqrt(work), 0,
                          1000 * EPS * (lambda + shift) / first,
                          "n eps of the largest mu, in scaled coordinates");
        }
    }
    free(K);
    free(M);
    solved_free(&solved);
}

/* ---- what is asked for ---- */

static void all_below_a_limit_are_found_and_no_others(void)
{
    for (size_t k = 0; k <= 8; k++) {
        const double between =
            k == 0 ? string_eigenvalue(1) / 2
                   : (string_eigenvalue(k) + (k < 8 ? string_eigenvalue(k + 1) : 1e9)) / 2;
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&string), 0, between, 1e4, 64), RD_OK);
        CHECK_INT(solved.found, k);
        for (size_t j = 0; j < solved.found; j++)
            CHECK_ABS(solved.eigenvalue[j], string_eigenvalue(j + 1),
                      solved.rounding[j] + 8 * EPS * string_eigenvalue(8), estimate);
        solved_free(&solved);
    }
}

/* nothing lies under -shift, and nothing under zero where the stiffness is positive definite */
static void nothing_is_below_zero_or_the_shift(void)
{
    struct recipe recipe = string;
    struct solved solved;
    CHECK_INT(solve(&solved, rope_make(&recipe), 0, 0, 1e4, 64), RD_OK);
    CHECK_INT(solved.found, 0);
    solved_free(&solved);
    CHECK_INT(solve(&solved, rope_make(&recipe), 0, -1e9, 1e4, 64), RD_OK);
    CHECK_INT(solved.found, 0);
    solved_free(&solved);
    /* a compressed chain: all of it is below zero */
    recipe.tension = -300;
    CHECK_INT(solve(&solved, rope_make(&recipe), 0, 0, 1e4, 64), RD_OK);
    CHECK_INT(solved.found, 8);
    for (size_t k = 0; k < solved.found; k++)
        CHECK_ABS(solved.eigenvalue[k], -string_eigenvalue(8 - k),
                  solved.rounding[k] + 8 * EPS * string_eigenvalue(8), estimate);
    CHECK_INT(solved.modes.finite, 8);
    const double shift = solved.modes.shift;
    solved_free(&solved);
    CHECK_INT(solve(&solved, rope_make(&recipe), 0, -2 * shift, 1e4, 64), RD_OK);
    CHECK_INT(solved.found, 0);
    solved_free(&solved);
}

/* the smallest limits there are: 1/below overflows */
static void nothing_is_below_the_smallest_limit(void)
{
    static const double below[] = {0x1p-1022, 0x1p-1030, 0x1p-1074};
    for (size_t k = 0; k < sizeof below / sizeof *below; k++) {
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&string), 0, below[k], 1e4, 64), RD_OK);
        CHECK_INT(solved.found, 0);
        solved_free(&solved);
    }
}

/* massless rotations are not counted as modes below any limit */
static void massless_coordinates_are_below_no_limit(void)
{
    const double highest = pinned_eigenvalue(8, 7, 0);
    const double below[] = {2 * highest, 1e6 * highest, 1e12 * highest, 1e30 * highest};
    struct recipe recipe = beam(8, 0, "z");
    recipe.inertia[RD_BETA] = 0;
    for (size_t k = 0; k < sizeof below / sizeof *below; k++) {
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&recipe), 0, below[k], 1e4, 64), RD_OK);
        CHECK_INT(solved.found, 7);
        solved_free(&solved);
    }
}

static void slices_do_not_change_a_bit(void)
{
    const struct recipe recipe = beam(8, 300, "z");
    struct solved whole, sliced;
    CHECK_INT(solve(&whole, rope_make(&recipe), 5, 0, 1e5, 1000), RD_OK);
    CHECK_INT(solve(&sliced, rope_make(&recipe), 5, 0, 1e5, 3), RD_OK);
    for (size_t k = 0; k < 5; k++) {
        CHECK_EXACT(sliced.eigenvalue[k], whole.eigenvalue[k]);
        CHECK_EXACT(sliced.rounding[k], whole.rounding[k]);
        for (size_t i = 0; i < 18; i++)
            CHECK_EXACT(shape_of(&sliced, k)[i], shape_of(&whole, k)[i]);
    }
    solved_free(&whole);
    solved_free(&sliced);
}

static void held_chain_has_no_modes(void)
{
    struct recipe recipe = string;
    recipe.elements = 1;
    for (size_t wanted = 0; wanted < 2; wanted++) {
        struct solved solved;
        CHECK_INT(solve(&solved, rope_make(&recipe), wanted, 1e9, 1e4, 64), RD_OK);
        CHECK_INT(solved.found, 0);
        CHECK_INT(solved.modes.finite, 0);
        solved_free(&solved);
    }
}

/* ---- inertia ---- */

/* one clamped element with this inertia (2, 2) at its free end */
static struct rope tip(const double *mass)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 1,
        .coordinates = "zb",
        .length = 1,
        .section = {.bending = 1},
        .left = "zb",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    memcpy(rope.mass + 4 * RIGHT_END, mass, 4 * sizeof *mass);
    return rope;
}

/* as many modes as the inertia has positive eigenvalues, whatever its units and ratios */
static void positive_eigenvalues_of_the_inertia_are_the_number_of_modes(void)
{
    static const struct {
        double mass[4];
        size_t positive;
    } example[] = {
        {{0, 0, 0, 0}, 0},      {{1, 0, 0, 0}, 1},         {{0, 0, 0, 1}, 1},
        {{1, 0, 0, 1}, 2},      {{1, 1, 1, 1}, 1},         {{0.1, 0.3, 0.3, 0.9}, 1},
        {{1e6, 0, 0, 1e-6}, 2}, {{1e-12, 0, 0, 1e12}, 2},  {{4, 2e-6, 2e-6, 1e-12}, 1},
        {{1, 0.5, 0.5, 1}, 2},  {{3, -0.01, -0.01, 0}, 1}, {{0, 0.01, 0.01, 3}, 1},
        {{1, 0, 0, 1e-300}, 2}, {{0, 2, 2, 0}, 1},
    };
    for (size_t e = 0; e < sizeof example / sizeof *example; e++) {
        struct rope rope = tip(example[e].mass);
        struct rd_modes modes;
        struct rd_workspace workspace = exact_workspace(measure(&rope, 2));
        CHECK_INT(rd_modes_prepare(&rope.chain, 2, &modes, &workspace), RD_OK);
        CHECK_INT(modes.finite, example[e].positive);
        free(workspace.base);
        rope_free(&rope);
    }
}

/* K = [12, -6; -6, 4] and M = [m, c; c, 0]: one positive root and a spurious negative one, of
   -c^2 lambda^2 - (4 m + 12 c) lambda + 12 = 0 */
static void indefinite_inertia_gives_the_positive_root_first(void)
{
    const double m = 0.5, c = -0.02, b = 4 * m + 12 * c;
    const double positive = 24 / (b + sqrt(b * b + 48 * c * c));
    const double mass[4] = {m, c, c, 0};
    struct solved solved;
    CHECK_INT(solve(&solved, tip(mass), 1, 0, 1, 64), RD_OK);
    CHECK_INT(solved.modes.finite, 1);
    CHECK_INT(solved.found, 1);
    CHECK_REL(solved.eigenvalue[0], positive, 200 * EPS, "condition 14 of the scaled stiffness");
    solved_free(&solved);
}

/* ---- refusals ---- */

/* no shift helps what has neither stiffness nor inertia, or negative stiffness without inertia */
static void unstable_coordinate_without_mass_is_refused(void)
{
    struct recipe recipe = string;
    struct solved solved;
    recipe.elements = 3;
    recipe.more = 1;
    struct rope rope = rope_make(&recipe);
    rope.term_of[1] = MORE;
    rope.mass[MORE] = 0;
    rope.stiffness[MORE] = -1e5; /* more than the string holds */
    CHECK_INT(solve(&solved, rope, 1, 0, 1e4, 64), RD_UNSTABLE_MASSLESS);
    solved_free(&solved);
    recipe.tension = 0;
    rope = rope_make(&recipe);
    rope.term_of[1] = MORE;
    rope.mass[MORE] = 0;
    CHECK_INT(solve(&solved, rope, 1, 0, 1e4, 64), RD_UNSTABLE_MASSLESS);
    solved_free(&solved);
}

/* a rotation without inertia, turned away by more than the beam turns it back */
static void buckled_massless_rotation_is_refused(void)
{
    struct recipe recipe = beam(8, 0, "zb");
    recipe.inertia[RD_BETA] = 0;
    recipe.more = 1;
    struct rope rope = rope_make(&recipe);
    rope.term_of[4] = MORE;
    rope.stiffness[MORE * 4 + 3] = -1e6;
    struct solved solved;
    CHECK_INT(solve(&solved, rope, 1, 0, 1e4, 64), RD_UNSTABLE_MASSLESS);
    solved_free(&solved);
}

/* every size that is too small: refused, and nothing is written outside the block. What is held is
   known only after the system's own arrays fit; the rest then needs less than was measured */
static void short_memory_is_refused_at_every_size(const char *held, size_t columns)
{
    struct recipe recipe = beam(2, 0, held);
    struct rope rope = rope_make(&recipe);
    struct rd_modes modes;
    struct rd_workspace workspace = exact_workspace(measure(&rope, columns));
    CHECK_INT(rd_modes_prepare(&rope.chain, columns, &modes, &workspace), RD_OK);
    const size_t needed = workspace.used;
    CHECK(needed <= workspace.size);
    CHECK(held[0] != '\0' || needed == workspace.size);
    free(workspace.base);
    for (size_t bytes = 0; bytes < needed; bytes += bytes + 8 < needed ? 8 : 1) {
        workspace = exact_workspace(bytes);
        CHECK_INT(rd_modes_prepare(&rope.chain, columns, &modes, &workspace), RD_NO_MEMORY);
        free(workspace.base);
    }
    rope.flexibility[8] = -1;
    workspace = exact_workspace(measure(&rope, columns));
    CHECK_INT(rd_modes_prepare(&rope.chain, columns, &modes, &workspace), RD_NOT_POSITIVE_DEFINITE);
    free(workspace.base);
    rope_free(&rope);
}

int main(void)
{
    fixed_string_has_its_discrete_frequencies();
    torsion_chain_with_half_a_disc_at_its_end();
    free_string_has_one_rigid_mode();
    free_chain_is_shifted_whatever_its_last_bits();
    repeated_eigenvalues_have_orthogonal_shapes();
    beam_chain_has_its_exact_discrete_frequencies();
    sixty_four_elements_keep_eleven_digits();
    massless_rotations_and_buckling(0);
    massless_rotations_and_buckling(0.9);
    massless_rotations_and_buckling(1.5);
    massless_rotations_and_buckling(5);
    free_beam_has_two_rigid_modes();
    shapes_satisfy_the_equations_of_motion(300, "xzab");
    shapes_satisfy_the_equations_of_motion(0, "xza");
    shapes_satisfy_the_equations_of_motion(-50, "xza");
    all_below_a_limit_are_found_and_no_others();
    nothing_is_below_zero_or_the_shift();
    nothing_is_below_the_smallest_limit();
    massless_coordinates_are_below_no_limit();
    slices_do_not_change_a_bit();
    held_chain_has_no_modes();
    positive_eigenvalues_of_the_inertia_are_the_number_of_modes();
    indefinite_inertia_gives_the_positive_root_first();
    unstable_coordinate_without_mass_is_refused();
    buckled_massless_rotation_is_refused();
    short_memory_is_refused_at_every_size("", SIZE_MAX);
    short_memory_is_refused_at_every_size("zb", 1);
    short_memory_is_refused_at_every_size("z", 2);
    return check_report("test_modes");
}
