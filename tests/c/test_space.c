/* Ropes in space: triples of their pieces against closed forms, and counts. */
#include "space/space.h"

#include "check.h"

#include <stdlib.h>
#include <string.h>

enum { SIX = RD_SIX, FULL = RD_SIX * RD_SIX, TRIPLE = 3 * FULL, LINES = 9 };

static const double PI = 3.14159265358979323846;

/* A straight beam: B = 2 N m^2 in both planes, C = 1.5 N m^2, EA = 1e3 N, 0.5 kg/m. */
static void beam(double *phi, double *soft, double *load, double *inertia)
{
    const double flexibility[SIX] = {1e-3, 0, 0, 1 / 1.5, 0.5, 0.5};
    memset(phi, 0, FULL * sizeof *phi);
    memset(soft, 0, FULL * sizeof *soft);
    memset(load, 0, FULL * sizeof *load);
    memset(inertia, 0, FULL * sizeof *inertia);
    phi[1 * SIX + 5] = phi[2 * SIX + 4] = 1;
    for (int i = 0; i < SIX; i++) {
        soft[i * SIX + i] = flexibility[i];
        inertia[i * SIX + i] = i < 3 ? 0.5 : 0;
    }
}

/* Phi, S and q of it at the eigenvalue 3 */
static void beam_that_moves(double _Complex *rates)
{
    double phi[FULL], soft[FULL], load[FULL], inertia[FULL];
    beam(phi, soft, load, inertia);
    for (int i = 0; i < FULL; i++) {
        rates[i] = phi[i];
        rates[FULL + i] = soft[i];
        rates[2 * FULL + i] = -3 * inertia[i];
    }
}

/* at rest D has the length as the lever of beta and gamma, G is l^3/3B, l^2/2B, l/B, and Q = 0 */
static void test_triple_of_a_beam_at_rest(void)
{
    const double l = 3;
    double phi[FULL], soft[FULL], load[FULL], inertia[FULL];
    double _Complex rates[LINES * TRIPLE], triple[LINES * TRIPLE];
    const double series[RD_SPACE_ORDERS] = {1};
    struct rd_workspace workspace = {0};
    beam(phi, soft, load, inertia);
    for (int i = 0; i < LINES * FULL; i++) {
        double _Complex *at = rates + i / FULL * TRIPLE + i % FULL;
        at[0] = phi[i % FULL];
        at[FULL] = soft[i % FULL];
        at[2 * FULL] = load[i % FULL];
    }
    for (int doublings = 0; doublings <= 6; doublings += 3) {
        const struct rd_space_run run = {SIX, ldexp(l, 6 - doublings), 1, 6, 1, 1, series};
        int reached = -1, whole = 0;
        free(workspace.base);
        workspace = (struct rd_workspace){0};
        rd_space_triples(&run, 0, rates, doublings, 1e9, triple, &reached, &whole, &workspace);
        workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
        CHECK_INT(rd_space_triples(&run, LINES, rates, doublings, 1e9, triple, &reached, &whole,
                                   &workspace),
                  RD_OK);
        CHECK_INT(reached, doublings);
        CHECK(whole);
        /* of the last line, alone in its lanes */
        const double _Complex *last = triple + (LINES - 1) * TRIPLE;
        const double _Complex *G = last + FULL, *Q = G + FULL;
        CHECK_ABS(creal(last[2 * SIX + 4]), l, 8 * EPS * l, "roundings");
        CHECK_ABS(creal(G[2 * SIX + 2]), l * l * l / 6, 64 * EPS * l * l * l, "roundings");
        CHECK_ABS(creal(G[1 * SIX + 5]), l * l / 4, 64 * EPS * l * l, "roundings");
        CHECK_ABS(creal(G[4 * SIX + 4]), l / 2, 64 * EPS * l, "roundings");
        CHECK_ABS(creal(G[3 * SIX + 3]), l / 1.5, 64 * EPS * l, "roundings");
        for (int i = 0; i < FULL; i++)
            CHECK(Q[i] == 0);
    }
    free(workspace.base);
}

/* Clamped at both ends: sin kl = 0 of stretch and cos kl cosh kl = 1 of bending in both planes, whose roots
   are soon (n + 1/2) pi; twist has no inertia. */
static size_t expected(double lambda, double l)
{
    const double beams[] = {4.730040744862704, 7.853204624095838, 10.99560783800167,
                            14.13716549125746, 17.27875965739948};
    size_t count = 0;
    for (int n = 1; n < 100; n++)
        count += pow(n * PI / l, 2) * 1e3 / 0.5 < lambda;
    for (int n = 0; n < 100; n++)
        count += pow((n < 5 ? beams[n] : (n + 1.5) * PI) / l, 4) * 2 / 0.5 < lambda ? 2 : 0;
    return count;
}

static const int32_t whole_rope[8];

struct rope {
    double length[2], rates[2 * TRIPLE], inertia[2 * FULL];
    double turn[2 * FULL], none[3 * FULL], series[2 * RD_SPACE_ORDERS], scale[8 * SIX];
    int32_t halvings[2], nodes[2];
    uint8_t held[3 * SIX];
    struct rd_space space;
};

/* of one or two pieces, clamped at both ends */
static void rope_fill(struct rope *rope, size_t pieces, double l)
{
    memset(rope, 0, sizeof *rope);
    for (size_t p = 0; p < pieces; p++) {
        const size_t at = p * FULL;
        double *own = rope->rates + p * TRIPLE;
        beam(own, own + FULL, own + 2 * (size_t)FULL, rope->inertia + at);
        rope->nodes[p] = 1;
        rope->series[p * RD_SPACE_ORDERS] = 1;
        rope->length[p] = pieces == 1 ? l : p == 0 ? 0.3 * l : 0.7 * l;
        rope->halvings[p] = 8;
        for (int i = 0; i < SIX; i++)
            rope->turn[at + (size_t)(i * SIX + i)] = 1;
    }
    for (int i = 0; i < 8 * SIX; i++)
        rope->scale[i] = 1;
    memset(rope->held, 1, SIX);
    memset(rope->held + pieces * SIX, 1, SIX);
    rope->space = (struct rd_space){
        .components = 1,
        .width = SIX,
        .pieces = pieces,
        .length = rope->length,
        .halvings = rope->halvings,
        .nodes = rope->nodes,
        .fields = 1,
        .series = rope->series,
        .rates = rope->rates,
        .inertia = rope->inertia,
        .turn = rope->turn,
        .stiffness = rope->none,
        .mass = rope->none,
        .held = rope->held,
    };
}

static void test_counts_of_rods_and_beams(void)
{
    static struct rope rope;
    struct rd_workspace workspace = {0};
    const double lambda[] = {-10, 1, 30, 300, 3e3, 7e3, 2e4, 5e4};
    enum { COUNT = sizeof lambda / sizeof *lambda };
    double below[COUNT];
    rope_fill(&rope, 1, 4);
    CHECK_INT(rd_space_count(&rope.space, COUNT, whole_rope, lambda, rope.scale, below, &workspace),
              RD_NO_MEMORY);
    workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
    for (size_t pieces = 1; pieces <= 2; pieces++) {
        rope_fill(&rope, pieces, 4);
        workspace.used = 0;
        CHECK_INT(
            rd_space_count(&rope.space, COUNT, whole_rope, lambda, rope.scale, below, &workspace),
            RD_OK);
        for (size_t k = 0; k < COUNT; k++)
            CHECK_INT((long long)below[k], (long long)expected(lambda[k], 4));
    }
    workspace.size = workspace.used - 1;
    workspace.used = 0;
    CHECK_INT(rd_space_count(&rope.space, COUNT, whole_rope, lambda, rope.scale, below, &workspace),
              RD_NO_MEMORY);
    free(workspace.base);
}

/* a support in the middle of what is clamped at both ends */
static void test_a_held_node_within_is_counted(void)
{
    static struct rope rope;
    struct rd_workspace workspace = {0};
    double below;
    rope_fill(&rope, 2, 4);
    memset(rope.held + SIX, 1, SIX);
    const double lambda = 3e3;
    rd_space_count(&rope.space, 1, whole_rope, &lambda, rope.scale, &below, &workspace);
    workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
    CHECK_INT(rd_space_count(&rope.space, 1, whole_rope, &lambda, rope.scale, &below, &workspace),
              RD_OK);
    CHECK_INT((long long)below, (long long)(expected(lambda, 1.2) + expected(lambda, 2.8)));
    free(workspace.base);
}

/* the same tension all along, told by a straight line through its ends: parts about nodes, or as they
   are, are those of a uniform beam */
static void test_parts_of_what_only_seems_to_change(void)
{
    enum { FIELDS = 2, NODES = 14, HALVINGS = 6 };
    static double _Complex rates[FIELDS * TRIPLE], one[TRIPLE];
    static double _Complex many[NODES * TRIPLE];
    static double series[NODES * FIELDS * RD_SPACE_ORDERS];
    const double flat[RD_SPACE_ORDERS] = {1};
    struct rd_workspace workspace = {0};
    int reached, whole;
    beam_that_moves(rates);
    /* E = E_0 + x E_1 with E_1 = E_0/2, of which a series that takes it away is left */
    for (int i = 0; i < TRIPLE; i++)
        rates[TRIPLE + i] = 0.5 * rates[i];
    for (int node = 0; node < NODES; node++) {
        double *at = series + node * FIELDS * RD_SPACE_ORDERS;
        at[0] = 2;
        at[1] = 0.25;
        at[RD_SPACE_ORDERS] = -2;
        at[RD_SPACE_ORDERS + 1] = -0.5;
    }
    const struct rd_space_run plain = {SIX, 1, 1, HALVINGS, 1, 1, flat};
    const struct rd_space_run about = {SIX, 1, 1, HALVINGS, NODES, FIELDS, series};
    rd_space_triples(&about, 0, rates, 3, 0.9, many, &reached, &whole, &workspace);
    workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
    CHECK_INT(rd_space_triples(&plain, 1, rates, 3, 0.9, one, &reached, &whole, &workspace), RD_OK);
    workspace.used = 0;
    CHECK_INT(rd_space_triples(&about, 1, rates, 3, 0.9, many, &reached, &whole, &workspace),
              RD_OK);
    CHECK_INT(reached, 3);
    CHECK(whole);
    for (int part = 0; part < 8; part++)
        for (int i = 0; i < TRIPLE; i++)
            CHECK_ABS(creal(many[part * TRIPLE + i]), creal(one[i]),
                      256 * EPS * (1e-3 + fabs(creal(one[i]))), "roundings of nodes");
    workspace.used = 0;
    CHECK_INT(rd_space_triples(&about, 1, rates, 3, 1e-9, many, &reached, &whole, &workspace),
              RD_OK);
    CHECK(reached < 3 && whole);
    workspace.size--;
    workspace.used = 0;
    CHECK_INT(rd_space_triples(&about, 1, rates, 3, 0.9, many, &reached, &whole, &workspace),
              RD_NO_MEMORY);
    free(workspace.base);
}

/* three equal parts of a piece are each its third, which a uniform beam is doubled to */
static void test_equal_parts_are_those_of_the_whole(void)
{
    enum { NODES = 14, HALVINGS = 4, EQUAL = 3 };
    double _Complex rates[TRIPLE], one[TRIPLE];
    static double _Complex many[NODES * TRIPLE];
    static double flat[NODES * RD_SPACE_ORDERS];
    struct rd_workspace workspace = {0};
    int reached, whole;
    beam_that_moves(rates);
    for (int node = 0; node < NODES; node++)
        flat[node * RD_SPACE_ORDERS] = 1;
    const struct rd_space_run third = {SIX, 0.25, 1, HALVINGS, 1, 1, flat};
    const struct rd_space_run all = {SIX, 0.75, EQUAL, HALVINGS, NODES, 1, flat};
    rd_space_triples(&all, 0, rates, HALVINGS, 0.9, many, &reached, &whole, &workspace);
    workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
    CHECK_INT(rd_space_triples(&all, 1, rates, HALVINGS, 0.9, many, &reached, &whole, &workspace),
              RD_OK);
    CHECK(reached == HALVINGS && whole);
    workspace.used = 0;
    CHECK_INT(rd_space_triples(&third, 1, rates, HALVINGS, 0.9, one, &reached, &whole, &workspace),
              RD_OK);
    CHECK(reached == HALVINGS && whole);
    for (int part = 0; part < EQUAL; part++)
        for (int i = 0; i < TRIPLE; i++)
            CHECK_ABS(creal(many[part * TRIPLE + i]), creal(one[i]),
                      64 * EPS * (1e-3 + fabs(creal(one[i]))), "roundings of nodes");
    free(workspace.base);
}

/* one part held at its left: u_1 = G p of a force p at its right; of both widths, which say the same where
   each coordinate is alone */
static void test_bands_of_numbers_of_both_kinds(void)
{
    for (size_t w = 3; w <= SIX; w += 3) {
        double D[FULL] = {0}, G[FULL] = {0}, none[2 * FULL] = {0};
        double band[3 * SIX * (6 * SIX - 2)], x[3 * SIX] = {0};
        static double _Complex cD[LINES * FULL], cG[LINES * FULL], cnone[LINES * 2 * FULL];
        double _Complex cx[LINES * 3 * SIX] = {0};
        uint8_t fixed[LINES * 3 * SIX] = {0};
        int32_t pivot[3 * SIX];
        struct rd_workspace workspace = {0};
        memset(cG, 0, sizeof cG);
        for (size_t line = 0; line < LINES; line++)
            for (size_t i = 0; i < w; i++) {
                fixed[line * 3 * w + i] = 1;
                cG[line * w * w + i * w + i] = (double)(2 + i + line);
                cx[line * 3 * w + 2 * w + i] = CMPLX(0, 1);
            }
        for (size_t i = 0; i < w; i++) {
            G[i * w + i] = (double)(2 + i);
            x[2 * w + i] = 1;
        }
        const struct rd_space_band real = {w, 1, 1, 1, D, G, none, none, fixed, 0};
        const struct rd_space_band many = {
            w, LINES, 1, 2, (double *)cD, (double *)cG, (double *)cnone, (double *)cnone, fixed, 0};
        CHECK_INT((long long)rd_space_factor(&real, band, pivot), 1);
        rd_space_solve(w, 0, 1, 3 * w, 1, band, pivot, x, NULL);
        CHECK_INT(rd_space_respond(&many, 1, cx, &workspace), RD_NO_MEMORY);
        workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
        CHECK_INT(rd_space_respond(&many, 1, cx, &workspace), RD_OK);
        for (size_t i = 0; i < w; i++) {
            const double of = (double)(2 + i);
            CHECK_ABS(x[2 * w + i], of, 8 * EPS * of, "roundings");
            CHECK(x[i] == 0 && x[w + i] == 1);
            for (size_t line = 0; line < LINES; line++)
                CHECK_ABS(cimag(cx[line * 3 * w + 2 * w + i]), of + (double)line,
                          8 * EPS * (of + (double)line), "roundings");
        }
        /* nothing holds it */
        memset(fixed, 0, sizeof fixed);
        CHECK_INT((long long)rd_space_factor(&real, band, pivot), 0);
        workspace.used = 0;
        CHECK_INT(rd_space_respond(&many, 1, cx, &workspace), RD_OK);
        CHECK(!isfinite(creal(cx[2 * w])));
        free(workspace.base);
    }
}

/* one part held at its left, u_1 = G p, with i m in N at its right: of Re(A)^-1 Im(A) the largest
   eigenvalue is that of the largest G m, and A does to a solution what solving undid */
static void test_iteration_finds_what_gives_way_most(void)
{
    enum { COLUMNS = 2 };
    for (size_t w = 3; w <= SIX; w += 3) {
        double _Complex D[FULL] = {0}, G[FULL] = {0}, none[FULL] = {0}, N[2 * FULL] = {0};
        double _Complex given[3 * SIX], back[3 * SIX];
        double factor[3 * SIX * (6 * SIX - 2)], x[COLUMNS * 3 * SIX], work[2 * COLUMNS * 3 * SIX];
        double form[2 * COLUMNS * COLUMNS];
        uint8_t fixed[3 * SIX] = {0};
        int32_t pivot[3 * SIX];
        for (size_t i = 0; i < w; i++) {
            fixed[i] = 1;
            G[i * w + i] = (double)(2 + i);
            N[w * w + i * w + i] = CMPLX(0, 0.01);
            for (size_t j = 0; j < i; j++)
                D[i * w + j] = 0.1;
        }
        for (size_t i = 0; i < 3 * w; i++) {
            given[i] = i < w ? 0 : CMPLX((double)i, 1);
            x[i] = 1;
            x[3 * w + i] = (double)(i % w);
        }
        const struct rd_space_band band = {
            w, 1, 1, 2, (double *)D, (double *)G, (double *)none, (double *)N, fixed, 0};
        struct rd_workspace workspace = {0};
        rd_space_apply(&band, 1, given, back);
        rd_space_respond(&band, 1, back, &workspace);
        workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
        CHECK_INT(rd_space_respond(&band, 1, back, &workspace), RD_OK);
        for (size_t i = 0; i < 3 * w; i++)
            CHECK_ABS(cabs(back[i] - given[i]), 0, 1e3 * EPS, "roundings of up to 18");
        free(workspace.base);

        CHECK_INT((long long)rd_space_factor(&band, factor, pivot), 1);
        rd_space_iterate(&band, COLUMNS, factor, pivot, 200, x, form, work);
        const double most = (double)(1 + w);
        CHECK_ABS(form[0] / form[COLUMNS * COLUMNS], 1 / (0.01 * most), 1e-10,
                  "(5/6)^200 and less");
        double length = 0, across = 0;
        for (size_t i = 0; i < 3 * w; i++) {
            length += x[i] * x[i];
            across += x[i] * x[3 * w + i];
        }
        CHECK_ABS(length, 1, 16 * EPS, "roundings");
        CHECK_ABS(across, 0, 16 * EPS, "roundings");
    }
}

/* two parts of springs between the same two nodes, one of which a spring holds */
static void test_a_closed_band_is_two_springs_side_by_side(void)
{
    const double g[2] = {2, 3}, n = 0.5, p = 1;
    for (size_t w = 3; w <= SIX; w += 3) {
        double _Complex D[2 * FULL] = {0}, G[2 * FULL] = {0}, none[2 * FULL] = {0};
        double _Complex N[3 * FULL] = {0}, cx[5 * SIX] = {0};
        double x[5 * SIX] = {0}, work[5 * SIX], factor[5 * SIX * (9 * SIX - 2)];
        uint8_t fixed[5 * SIX] = {0};
        int32_t pivot[5 * SIX];
        struct rd_workspace workspace = {0};
        for (size_t i = 0; i < w; i++) {
            G[i * w + i] = g[0];
            G[(w + i) * w + i] = g[1];
            N[i * w + i] = n;
            fixed[4 * w + i] = 1;
            cx[2 * w + i] = x[2 * w + i] = p;
        }
        const struct rd_space_band band = {
            w, 1, 2, 2, (double *)D, (double *)G, (double *)none, (double *)N, fixed, 1};
        CHECK_INT((long long)rd_space_factor(&band, factor, pivot), 1);
        rd_space_solve(w, 1, 1, 5 * w, 1, factor, pivot, x, work);
        CHECK_INT(rd_space_respond(&band, 1, cx, &workspace), RD_NO_MEMORY);
        workspace = (struct rd_workspace){.base = malloc(workspace.used), .size = workspace.used};
        CHECK_INT(rd_space_respond(&band, 1, cx, &workspace), RD_OK);
        const double first = p / n, other = first + p / (1 / g[0] + 1 / g[1]);
        for (size_t i = 0; i < w; i++) {
            CHECK_ABS(x[i], first, 16 * EPS * other, "roundings");
            CHECK_ABS(x[2 * w + i], other, 16 * EPS * other, "roundings");
            CHECK(x[4 * w + i] == x[i]);
            CHECK_ABS(cabs(cx[2 * w + i] - other), 0, 16 * EPS * other, "roundings");
            CHECK(cx[4 * w + i] == cx[i]);
        }
        /* nothing holds it */
        memset(N, 0, sizeof N);
        workspace.used = 0;
        CHECK_INT(rd_space_respond(&band, 1, cx, &workspace), RD_OK);
        CHECK(!isfinite(creal(cx[0])));
        free(workspace.base);
    }
}

int main(void)
{
    test_triple_of_a_beam_at_rest();
    test_counts_of_rods_and_beams();
    test_a_held_node_within_is_counted();
    test_parts_of_what_only_seems_to_change();
    test_equal_parts_are_those_of_the_whole();
    test_bands_of_numbers_of_both_kinds();
    test_iteration_finds_what_gives_way_most();
    test_a_closed_band_is_two_springs_side_by_side();
    return check_report("space");
}
