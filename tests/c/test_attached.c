/* Structures that nodes carry: Krylov's functions, feet on both sides of their poles, held counts. */
#include "chain/attached.h"

#include "base/krylov.h"
#include "check.h"
#include "modes/certify/certify.h"
#include "modes/count/count.h"
#include "sweep/sweep.h"
#include "walked.h"

#include <string.h>

/* one structure on a node of z and beta, or of z, alpha and beta */
static const int32_t first[] = {0, 1}, wire_kind[] = {RD_WIRE}, resonator_kind[] = {RD_RESONATOR},
                     own_term[] = {0}, term[] = {0, 1};
static const double row[] = {1, 0, 0, 1};

static struct rd_chain carry(const int32_t *kind, const double *value)
{
    return (struct rd_chain){
        .width = 2,
        .stretches = 2,
        .first = first,
        .term = term,
        .attached = 1,
        .attached_kind = kind,
        .attached_term = own_term,
        .attached_row = row,
        .attached_value = value,
    };
}

/* mass, E I/l^3, length */
static const double wire[] = {3e-5, 0.03, 0.05, 0};
static const double resonator[] = {0.01, 150, 15000, 0};

/* c_j has p^n/(4n + j)!: c_0'''' = c_0 in P, so that c_0^2 - .. = 0 of cosh and cos */
static void test_krylovs_functions_keep_cosh_and_cos(void)
{
    const double size[] = {1e-8, 1, 60, 63.9, 64.1, 1e3, 1e5};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (int side = -1; side <= 1; side += 2) {
            const double p = side * size[i];
            const struct rd_krylov k = rd_krylov(p, 0);
            /* with C = c_0 + r c_2, c = c_0 - r c_2, S = P (c_1 + r c_3), s = P (c_1 - r c_3),
               r = P^2: C^2 - S^2 = 1 and c^2 + s^2 = 1, sum and difference */
            const double sum =
                creal(k.c[0] * k.c[0] + p * k.c[2] * k.c[2] - 2 * p * k.c[1] * k.c[3]);
            const double rest = creal(2 * k.c[0] * k.c[2] - k.c[1] * k.c[1] - p * k.c[3] * k.c[3]);
            const double large = pow(cabs(k.c[0]) + sqrt(size[i]) * cabs(k.c[2]), 2);
            CHECK_ABS(sum, 1, 64 * EPS * (1 + large), "rounding of the squares");
            CHECK_ABS(rest, 0, 64 * EPS * (1 + large), "rounding of the squares");
            CHECK_ABS(creal(k.c[4] * p), creal(k.c[0]) - 1, 8 * EPS * (1 + large),
                      "its definition");
        }
}

static void test_krylovs_functions_do_not_jump_where_series_end(void)
{
    for (int side = -1; side <= 1; side += 2) {
        const double at = side * 64.0;
        const struct rd_krylov a = rd_krylov(at, 0), b = rd_krylov(at * (1 + 4 * EPS), 0);
        for (int j = 0; j < 5; j++)
            CHECK_ABS(creal(b.c[j]), creal(a.c[j]), 64 * EPS, "a few roundings of numbers below 4");
    }
}

static void test_a_growth_leaves_all_of_them_finite(void)
{
    const double size[] = {1, 65, 1e8, 1e20, 1e60};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (int turn = 0; turn < 8; turn++) {
            const double _Complex p = size[i] * cpow(I, turn / 2.0);
            const struct rd_krylov k = rd_krylov(p, rd_krylov_growth(p));
            for (int j = 0; j < 5; j++)
                CHECK(isfinite(creal(k.c[j])) && isfinite(cimag(k.c[j])));
        }
}

/* D by q = lambda m/k: D_zz, D_zb, D_bb = -lambda m (c_1, l c_2, 2 l^2 c_3)/e */
static void test_the_foot_of_a_wire_is_the_same_by_either_pivot(void)
{
    const struct rd_chain chain = carry(wire_kind, wire);
    for (double q = -1e3; q < 2e3; q += 7.3) {
        const double lambda = q * wire[1] / wire[0], l = wire[2];
        const struct rd_krylov f = rd_krylov(-4 * q, 0);
        const double e = (1 + creal(f.c[0])) / 2, m = lambda * wire[0] / e;
        double _Complex D[4] = {0};
        rd_attached_add(&chain, 0, -lambda, 0, D);
        const double want[] = {-m * creal(f.c[1]), -m * l * creal(f.c[2]), -m * l * creal(f.c[2]),
                               -2 * m * l * l * creal(f.c[3])};
        const double unit[] = {1, l, l, l * l};
        const double near = 1 + 1 / fabs(e); /* of a pole */
        const double large = fabs(m) * (1 + pow(cabs(f.c[0]), 2) / (1 + cabs(f.c[0])));
        for (int i = 0; i < 4; i++)
            CHECK_ABS(creal(D[i]), want[i], 256 * EPS * near * large * unit[i],
                      "rounding of e and of the products");
    }
}

static void test_slow_structures_are_rigid_bodies(void)
{
    struct rd_chain chain = carry(wire_kind, wire);
    const double m = wire[0], l = wire[2];
    double M[4] = {0};
    rd_attached_inertia(&chain, 0, M);
    CHECK_ABS(M[0], m, 4 * EPS * m, "one product");
    CHECK_ABS(M[1], m * l / 2, 4 * EPS * m * l, "two products");
    CHECK_ABS(M[3], m * l * l / 3, 8 * EPS * m * l * l, "a few products");
    chain = carry(resonator_kind, resonator);
    memset(M, 0, sizeof M);
    rd_attached_inertia(&chain, 0, M);
    CHECK_EXACT(M[0], resonator[0]);
    CHECK_EXACT(M[3], 0);
}

/* the roots x of 1 + cos x cosh x, from tables */
static void test_counts_with_the_foot_held_change_at_the_roots(void)
{
    const double root[] = {1.8751040687119611, 4.6940911329741746, 7.8547574382376126,
                           10.995540734875467, 14.137168391046471};
    const struct rd_chain chain = carry(wire_kind, wire);
    struct rd_foot foot;
    for (int n = 0; n < 5; n++)
        for (int side = -1; side <= 1; side += 2) {
            const double q = pow(root[n] * (1 + side * 8 * EPS), 4);
            rd_attached_fill(&chain, 0, -q * wire[1] / wire[0], 0, &foot);
            CHECK_EXACT(foot.held, n + (side > 0));
        }
    for (int n = 1; n < 200;
         n++) { /* far up they are (n - 1/2) pi, and between n pi there is one */
        const double q = pow(n * 3.14159265358979323846, 4);
        rd_attached_fill(&chain, 0, -q * wire[1] / wire[0], 0, &foot);
        CHECK_EXACT(foot.held, n);
    }
    rd_attached_fill(&chain, 0, 1e6, 0, &foot);
    CHECK_EXACT(foot.held, 0);
}

static void test_a_resonator_is_finite_on_its_pole(void)
{
    const struct rd_chain chain = carry(resonator_kind, resonator);
    const double lambda = resonator[1] / resonator[0];
    struct rd_foot foot;
    rd_attached_fill(&chain, 0, -lambda, 0, &foot);
    CHECK(foot.gap != 0);
    CHECK_EXACT(foot.held, 0);
    rd_attached_fill(&chain, 0, -lambda * (1 + 2 * EPS), 0, &foot);
    CHECK_EXACT(foot.held, 1);
    CHECK_EXACT(rd_attached_highest(&chain), lambda);
}

/* D_zz u_z^2 = strain - lambda kinetic, and -dD/dlambda is the kinetic part */
static void test_energies_are_those_of_the_foot(void)
{
    const double lambda = 5e3, shape[] = {1, 0, 0, 0};
    const int32_t *const kind[] = {resonator_kind, wire_kind};
    const double *const value[] = {resonator, wire};
    for (int i = 0; i < 2; i++) {
        const struct rd_chain chain = carry(kind[i], value[i]);
        double _Complex D[4] = {0}, after[4] = {0}, before[4] = {0};
        double energy[RD_CARRIED];
        struct rd_foot foot;
        const double h = 1e-4 * lambda;
        rd_attached_fill(&chain, 0, -lambda, 0, &foot);
        const double y = creal(foot.lever[0] / foot.gap);
        rd_attached_energy(&chain, lambda, shape, &y, energy);
        rd_attached_add(&chain, 0, -lambda, 0, D);
        rd_attached_add(&chain, 0, -lambda - h, 0, after);
        rd_attached_add(&chain, 0, -lambda + h, 0, before);
        const double slope = creal(after[0] - before[0]) / (2 * h);
        CHECK_ABS(energy[RD_CARRIED_STRAIN] - lambda * energy[RD_CARRIED_KINETIC], creal(D[0]),
                  16 * EPS * fabs(creal(D[0])), "a few products");
        CHECK_ABS(energy[RD_CARRIED_KINETIC], -slope, 1e-6 * fabs(slope),
                  "of the square of the step of a difference");
        CHECK_EXACT(energy[RD_CARRIED_LOST], 0);
    }
}

/* m d/dm + k d/dk = u^T D u, -lambda times the kinetic part being the first; the same by Euler's
   theorem of the motion of the foot, and without the sum's cancellation */
static void test_slopes_add_up_to_the_form(void)
{
    const double lambda = 5e3, shape[] = {1, -3, 0, 0};
    const int32_t *const kind[] = {resonator_kind, wire_kind};
    const double *const value[] = {resonator, wire};
    for (int i = 0; i < 2; i++) {
        const struct rd_chain chain = carry(kind[i], value[i]);
        double _Complex D[4] = {0};
        double _Complex number[RD_CARRIED_NUMBERS], slope[4];
        struct rd_foot foot;
        rd_attached_fill(&chain, 0, -lambda, 0, &foot);
        const double _Complex u[2] = {shape[0], shape[1]};
        rd_attached_slopes(&chain, 0, -lambda, 0, u, u, NULL, number, slope);
        rd_attached_add(&chain, 0, -lambda, 0, D);
        double form = 0, sum = 0;
        for (int j = 0; j < 4; j++) {
            form += creal(D[j]) * shape[j / 2] * shape[j % 2];
            sum += row[j] * creal(slope[j]) / 2;
        }
        const double mass = creal(number[RD_CARRIED_OF_MASS]);
        const double stiffness = creal(number[RD_CARRIED_OF_STIFFNESS]);
        const double size = lambda * mass + stiffness;
        CHECK_ABS(stiffness - lambda * mass, form, 16 * EPS * size, "a few products");
        CHECK_ABS(sum, form, 16 * EPS * fabs(form), "a few products");
    }
}

/* A string whose node 7 carries two equal resonators and a wire. */
struct carrying {
    struct rope rope;
    int32_t kind[3], term[3];
    double row[6], value[12];
};

enum { NODE = 7 };

static void carrying_make(struct carrying *c)
{
    struct recipe recipe = long_string;
    recipe.elements = 20;
    recipe.more = 1;
    *c = (struct carrying){
        .rope = rope_make(&recipe),
        .kind = {RD_RESONATOR, RD_RESONATOR, RD_WIRE},
        .term = {MORE, MORE, MORE},
        .row = {1, 0, 1, 0, 1, 0},
    };
    memcpy(c->value, resonator, sizeof resonator);
    memcpy(c->value + 4, resonator, sizeof resonator);
    memcpy(c->value + 8, wire, sizeof wire);
    c->rope.term_of[NODE] = MORE;
    rope_gather(&c->rope);
    c->rope.chain.attached = 3;
    c->rope.chain.attached_kind = c->kind;
    c->rope.chain.attached_term = c->term;
    c->rope.chain.attached_row = c->row;
    c->rope.chain.attached_value = c->value;
}

static struct rd_refine refine_make(const struct rd_walk *walk, struct rd_workspace *workspace)
{
    struct rd_refine refine;
    rd_refine_take(walk, 200, 50, 1, workspace, &refine);
    *workspace = exact_workspace(workspace->used);
    rd_refine_take(walk, 200, 50, 1, workspace, &refine);
    return refine;
}

static void test_equal_resonators_have_a_mode_of_their_own(void)
{
    enum { WANTED = 4 };
    struct carrying c;
    carrying_make(&c);
    struct walked walked = walked_make(&c.rope.chain);
    struct rd_workspace workspace = {0};
    struct rd_refine refine = refine_make(&walked.walk, &workspace);
    double *motion = zeros(3 * WANTED), *shape = zeros(WANTED * 21), *numbers = zeros(7 * WANTED);
    struct rd_certified modes = {
        .wanted = WANTED,
        .upper = INFINITY,
        .lambda = numbers,
        .error = numbers + WANTED,
        .certified = numbers + 2 * WANTED,
        .bracket = numbers + 3 * WANTED,
        .shape = shape,
        .motion = motion,
    };
    CHECK_INT(rd_certify(&refine, &modes), RD_OK);
    CHECK_INT(modes.found, WANTED);
    const double own = resonator[1] / resonator[0];
    int at = -1;
    for (int k = 0; k < WANTED; k++) {
        CHECK_EXACT(modes.certified[k], 1);
        at = fabs(modes.lambda[k] / own - 1) < 64 * EPS ? k : at;
    }
    CHECK(at >= 0);
    if (at >= 0) { /* against each other, and the string stands still */
        const double *y = motion + 3 * at;
        CHECK_ABS(y[0] + y[1], 0, 1e-9 * fabs(y[0]), "the square root of what a quotient sees");
        CHECK_ABS(shape[at * 21 + NODE], 0, 1e-9 * fabs(y[0]), "the same");
        const double lambda[] = {own * (1 - 1e-9), own, own * (1 + 1e-9)};
        double count[3];
        rd_count(&walked.walk, 3, lambda, count);
        CHECK_EXACT(count[0], at);
        CHECK_EXACT(count[2], at + 1);
        CHECK(count[1] == at || count[1] == at + 1);
    }
    free(motion);
    free(shape);
    free(numbers);
    free(workspace.base);
    walked_free(&walked);
    rope_free(&c.rope);
}

static void test_a_foot_stands_still_where_its_resonator_is_tuned(void)
{
    struct carrying c;
    carrying_make(&c);
    const double one[] = {1, 0, 1, 0}, own = resonator[1] / resonator[0];
    const double inertia[] = {-own, 0, -2 * own, 0};
    const double dashpot[] = {0, sqrt(own), 0, sqrt(2 * own)};
    const int32_t node[] = {NODE};
    const double at[] = {1, 0};
    const struct rd_factors factors = {2, one, one, one, inertia, dashpot, NULL};
    const struct rd_ports ports = {1, node, at, NULL};
    struct rd_workspace space = {0};
    double value[4], error[2];
    size_t failed = 0;
    rd_frf_sweep(&c.rope.chain, &factors, &ports, &ports, &space, value, error, &failed);
    space = exact_workspace(space.used);
    CHECK_INT(rd_frf_sweep(&c.rope.chain, &factors, &ports, &ports, &space, value, error, &failed),
              RD_OK);
    CHECK(hypot(value[0], value[1]) < EPS * hypot(value[2], value[3]));
    CHECK(hypot(value[2], value[3]) > 0);
    free(space.base);
    rope_free(&c.rope);
}

int main(void)
{
    test_equal_resonators_have_a_mode_of_their_own();
    test_a_foot_stands_still_where_its_resonator_is_tuned();
    test_krylovs_functions_keep_cosh_and_cos();
    test_krylovs_functions_do_not_jump_where_series_end();
    test_a_growth_leaves_all_of_them_finite();
    test_the_foot_of_a_wire_is_the_same_by_either_pivot();
    test_slow_structures_are_rigid_bodies();
    test_counts_with_the_foot_held_change_at_the_roots();
    test_a_resonator_is_finite_on_its_pole();
    test_energies_are_those_of_the_foot();
    test_slopes_add_up_to_the_form();
    return check_report("test_attached");
}
