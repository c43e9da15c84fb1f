/* Elements whose tension grows along them: their blocks, and the triples of those. */
#include "graded/between.h"
#include "graded/polynomial.h"

#include "check.h"

enum { Z = 0, BETA = 1 };

static const int32_t bent[] = {RD_Z, RD_BETA};

/* an element of a string, or of a beam where S is not 0, of length 8 and 2 kg/m */
struct one {
    double length, tension, rise, flexibility[9], inertia[2];
    struct rd_chain chain;
};

static void one_fill(struct one *one, double S, double left, double right)
{
    *one = (struct one){.length = 8, .tension = (left + right) / 2, .rise = right - left};
    one->flexibility[8] = S;
    one->inertia[Z] = 2;
    one->chain = (struct rd_chain){
        .nodes = 2,
        .width = S > 0 ? 2 : 1,
        .distinct = 1,
        .kind = RD_CONTINUOUS,
        .coordinate = bent,
        .length = &one->length,
        .tension = &one->tension,
        .flexibility = one->flexibility,
        .inertia = one->inertia,
        .rise = &one->rise,
    };
}

/* the whole element at lambda, from its left or its right end; re and im of a first lane */
static void whole(const struct one *one, double lambda, bool backward, double more, double *triple,
                  double *change)
{
    const struct rd_sizes sizes = {1, 1, fabs(lambda), 0};
    struct rd_block block[RD_BLOCKS_MOST];
    struct rate_matrix rate;
    const struct rd_field field = {
        .width = one->chain.width,
        .rate = &rate,
        .tension = one->tension,
        .pull = c_real(1),
        .more = more,
    };
    cv packed[RD_GRADED_TRIPLE] = {{{0}, {0}}};
    rd_rate_fill(&one->chain, 0, c_real(1), c_real(1), c_real(-lambda), c_zero(), &rate);
    rd_family_whole(&field, rd_blocks_of(&one->chain, 0, &sizes, backward, block), block, packed);
    for (int i = 0; i < RD_GRADED_TRIPLE; i++) {
        triple[i] = packed[i].re[0];
        if (change)
            change[i] = packed[i].im[0] / more;
    }
}

/* where nothing moves fast G = integral of 1/T = log(T_b/T_a)/T', F = 1 and Q = 0 */
static void string_at_rest_gives_by_a_logarithm(void)
{
    static const double right[] = {3.0, 80.0, 5e4};
    for (int i = 0; i < 3; i++) {
        struct one one;
        double triple[RD_GRADED_TRIPLE];
        one_fill(&one, 0, 2, right[i]);
        whole(&one, 0, false, 0, triple, NULL);
        CHECK_EXACT(triple[0], 0);
        CHECK_REL(triple[1], 8 / (right[i] - 2) * log(right[i] / 2), 64 * EPS,
                  "16 blocks, interpolated 5 times");
        CHECK_EXACT(triple[2], 0);
    }
}

/* G_bb of the element is (Q + F^T G^-1 F)^-1 of the reversed one, for a string (G/(G Q + F^2)) */
static void string_reversed_is_that_from_its_other_end(void)
{
    struct one one;
    double a[RD_GRADED_TRIPLE], b[RD_GRADED_TRIPLE];
    one_fill(&one, 0, 5, 40);
    whole(&one, 0.3, false, 0, a, NULL);
    whole(&one, 0.3, true, 0, b, NULL);
    const double F = 1 + a[0], G = a[1], Q = a[2];
    CHECK_REL(b[1], G / (G * Q + F * F), 256 * EPS, "a product, and two ways of rounding");
    CHECK_REL(1 + b[0], F / (G * Q + F * F), 256 * EPS, "a product, and two ways of rounding");
}

/* two halves joined */
static void element_is_its_halves_joined(void)
{
    static const double S[] = {0, 1e-3, 1e-1, 10};
    for (int k = 0; k < 4; k++) {
        struct one all, left, right;
        double a[RD_GRADED_TRIPLE], b[RD_GRADED_TRIPLE], c[RD_GRADED_TRIPLE];
        one_fill(&all, S[k], k > 1 ? -1 : 4, 30);
        one_fill(&left, S[k], all.tension - all.rise / 2, all.tension);
        one_fill(&right, S[k], all.tension, all.tension + all.rise / 2);
        left.length = right.length = 4;
        whole(&all, 0.05, false, 0, a, NULL);
        whole(&left, 0.05, false, 0, b, NULL);
        whole(&right, 0.05, false, 0, c, NULL);
        cv one[RD_GRADED_TRIPLE], two[RD_GRADED_TRIPLE];
        for (int i = 0; i < RD_GRADED_TRIPLE; i++) {
            one[i] = c_real(b[i]);
            two[i] = c_real(c[i]);
        }
        rd_family_join(all.chain.width, two, one);
        for (size_t i = 0; i < (S[k] > 0 ? 10 : 3); i++)
            CHECK_ABS(one[i].re[0], a[i], 1e-12 * (fabs(a[i]) + 1e-3),
                      "2e-14 of the largest entries is measured");
    }
}

/* d/dT by a step in the imaginary direction is the difference of two elements */
static void imaginary_parts_are_slopes(void)
{
    struct one one, less, more;
    double a[RD_GRADED_TRIPLE], b[RD_GRADED_TRIPLE], c[RD_GRADED_TRIPLE], slope[RD_GRADED_TRIPLE];
    const double h = 0x1p-10;
    one_fill(&one, 0.1, 2, 30);
    one_fill(&less, 0.1, 2 - h, 30 - h);
    one_fill(&more, 0.1, 2 + h, 30 + h);
    whole(&one, 0.05, false, 0x1p-200, a, slope);
    whole(&less, 0.05, false, 0, b, NULL);
    whole(&more, 0.05, false, 0, c, NULL);
    for (int i = 0; i < RD_GRADED_TRIPLE; i++)
        CHECK_ABS(slope[i], (c[i] - b[i]) / (2 * h), 1e-6 * (fabs(slope[i]) + 1e-3),
                  "of second order in the step, 1e-6");
}

/* at its nodes a polynomial has its values, and one of their degree has them everywhere */
static void polynomial_is_exact_to_its_degree(void)
{
    double node[RD_NODES_MOST], weight[RD_NODES_MOST];
    rd_nodes(7, node);
    for (int k = 0; k < 7; k++) {
        rd_nodes_weigh(7, node, node[k], weight);
        for (int j = 0; j < 7; j++)
            CHECK_EXACT(weight[j], j == k);
    }
    rd_nodes_weigh(7, node, 0.3, weight);
    double sum = 0;
    for (int j = 0; j < 7; j++)
        sum += weight[j] * pow(node[j], 6);
    CHECK_REL(sum, pow(0.3, 6), 1e-12, "a sum of numbers 1000 times as large");
}

/* halfway between nodes, whose weights are those of a polynomial of lambda, a family is that of its own
   lambda; of a motion of z alone to all digits where that is 1e-4 of the largest too */
static void families_lie_between_those_of_nodes(void)
{
    enum { N = 24 };
    static const double at[] = {2e-6, 3e-3, 0.0199};
    for (int way = 0; way < 2; way++) {
        struct one one;
        double node[N], weight[RD_LANES * N], ones[2 * N], inertia[2 * N], none[2 * N] = {0};
        size_t first[2], index[RD_LANES];
        static double values[2 * 2 * RD_NODES_MOST * RD_GRADED_TRIPLE * 2 * N];
        one_fill(&one, 1e-1, 4, 9);
        rd_nodes(N, node);
        for (int n = 0; n < N; n++) {
            ones[2 * n] = 1;
            ones[2 * n + 1] = inertia[2 * n + 1] = 0;
            inertia[2 * n] = -0.01 * (1 + node[n]);
        }
        for (size_t lane = 0; lane < RD_LANES; lane++) {
            index[lane] = lane;
            rd_nodes_weigh(N, node, at[lane % 3] / 0.01 - 1, weight + lane * N);
        }
        struct rd_between between = {
            .most = {1, 1, 0.02, 0}, .real = true, .nodes = N, .first = first, .weight = weight};
        const struct rd_between_factors factors = {ones, ones, inertia, none};
        const size_t places = rd_between_layout(&one.chain, &between.most, first);
        CHECK(places > 0 && 2 * N * places <= sizeof values / sizeof *values);
        rd_between_fill(&one.chain, &between, &factors, values);
        between.values = values;
        struct rd_block block[RD_BLOCKS_MOST];
        struct rate_matrix rate;
        struct rd_family known, own;
        struct rd_between_lines lines = {.z = {l_fill(2), l_fill(0.5)}};
        cv lambda = c_zero();
        for (size_t lane = 0; lane < RD_LANES; lane++)
            lambda.re[lane] = -at[lane % 3];
        rd_between_weigh(&between, index, lines.weight);
        lines.load = rd_between_load(&one.chain, 0, lambda, c_zero());
        rd_rate_fill(&one.chain, 0, c_real(1), c_real(1), lambda, c_zero(), &rate);
        const struct rd_field field = {
            .width = 2, .rate = &rate, .tension = one.tension, .pull = c_real(1)};
        const size_t blocks = rd_blocks_of(&one.chain, 0, &between.most, way, block);
        const double *from = values + 2 * N * first[way];
        for (size_t k = 0; k < blocks; k++) {
            cv a[RD_GRADED_TRIPLE], b[RD_GRADED_TRIPLE];
            from = rd_between_family(&between, &lines, from, 2, block + k, &known);
            rd_family_fill(&field, block + k, &own);
            rd_family_piece(&known, 0, a);
            rd_family_piece(&own, 0, b);
            /* D_zz, D_zb, D_bz, D_bb, G_zz, G_zb, G_bb, Q_zz, Q_zb, Q_bb of u = z u^, f = f^/z */
            static const double scale[] = {1, 0.25, 4, 1, 0.25, 1, 4, 4, 1, 0.25};
            for (int lane = 0; lane < 3; lane++)
                for (int i = 0; i < RD_GRADED_TRIPLE; i++)
                    CHECK_REL(a[i].re[lane], scale[i] * b[i].re[lane], 64 * EPS,
                              "roundings of nodes: 1.5e-15 is measured");
        }
    }
}

/* a string of more blocks than there is room for has none */
static void blocks_end(void)
{
    struct one one;
    struct rd_block block[RD_BLOCKS_MOST];
    const struct rd_sizes fast = {1, 1, 1e30, 0};
    one_fill(&one, 0, 0, 1);
    CHECK_EXACT((double)rd_blocks_of(&one.chain, 0, &fast, false, block), 0);
    one_fill(&one, 0, 1, 2);
    CHECK_EXACT((double)rd_blocks_of(&one.chain, 0, &fast, false, block), 0);
}

int main(void)
{
    string_at_rest_gives_by_a_logarithm();
    string_reversed_is_that_from_its_other_end();
    element_is_its_halves_joined();
    imaginary_parts_are_slopes();
    polynomial_is_exact_to_its_degree();
    families_lie_between_those_of_nodes();
    blocks_end();
    return check_report("test_graded");
}
