/* Assembly of a chain against its elements and closed forms. */
#include "assembled/assemble.h"

#include "chains.h"
#include "check.h"

#include <string.h>

static const struct rd_section section = {8.5e5, 0.1485, 54.626, 120, 0.3};
static const double all[RD_PARTS] = {1, 1, 1, 1, 1};

/* an assembly with arrays of its own exact size */
static struct rd_assembly assembly_make(const struct rd_chain *chain)
{
    const size_t block = chain->width * chain->width;
    struct rd_assembly assembly = {
        .elastic = {zeros(chain->nodes * block), zeros((chain->nodes - 1) * block)},
        .string = {zeros(chain->nodes * block), zeros((chain->nodes - 1) * block)},
        .springs = zeros(chain->nodes * block),
        .mass = zeros(chain->nodes * block),
        .dashpots = zeros(chain->nodes * block),
    };
    /* what was there before is overwritten */
    for (size_t k = 0; k < chain->nodes * block; k++)
        assembly.elastic.diagonal[k] = assembly.string.diagonal[k] = assembly.springs[k] =
            assembly.mass[k] = assembly.dashpots[k] = (double)NAN;
    for (size_t k = 0; k < (chain->nodes - 1) * block; k++)
        assembly.elastic.coupling[k] = assembly.string.coupling[k] = (double)NAN;
    return assembly;
}

static void assembly_free(struct rd_assembly *assembly)
{
    free(assembly->elastic.diagonal);
    free(assembly->elastic.coupling);
    free(assembly->string.diagonal);
    free(assembly->string.coupling);
    free(assembly->springs);
    free(assembly->mass);
    free(assembly->dashpots);
}

/* two kinds of element in alternation, an own term with full matrices at one node */
static struct rope mixed_rope(const char *coordinates)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 6,
        .coordinates = coordinates,
        .length = 0.16875,
        .tension = 300,
        .section = section,
        .inertia = {2, 2, 0.5, 0.25},
        .left = "",
        .right = "",
        .distinct = 2,
        .more = 1,
    };
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    rope.length[1] = 0.25;
    rope.tension[1] = -20;
    rope.element_of[1] = rope.element_of[4] = 1;
    rope.term_of[3] = MORE;
    for (size_t a = 0; a < w; a++)
        for (size_t b = 0; b < w; b++) {
            rope.stiffness[(MORE * w + a) * w + b] = 10 + (double)(a + b);
            rope.mass[(MORE * w + a) * w + b] = a == b ? 3 : 0.5;
        }
    return rope;
}

/* entry of the assembled sum over coordinates a of node i and b of node j */
static double sum_of(const struct rd_assembly *of, size_t i, size_t j, size_t a, size_t b)
{
    const size_t w = of->width;
    if (i > j)
        return sum_of(of, j, i, b, a);
    const size_t at = (i * w + a) * w + b;
    if (i == j)
        return of->elastic.diagonal[at] + of->string.diagonal[at] + of->springs[at] + of->mass[at];
    return j == i + 1 ? of->elastic.coupling[at] + of->string.coupling[at] : 0;
}

static void assembly_is_the_sum_of_its_elements(const char *coordinates)
{
    struct rope rope = mixed_rope(coordinates);
    struct rd_assembly assembly = assembly_make(&rope.chain);
    CHECK_INT(rd_assemble(&rope.chain, &assembly), RD_OK);
    CHECK_INT(assembly.nodes, rope.chain.nodes);
    CHECK_INT(assembly.width, rope.chain.width);
    double *dense = rope_dense(&rope.chain, all);
    const size_t w = rope.chain.width;
    const size_t n = rope.chain.nodes * w;
    for (size_t p = 0; p < n; p++)
        for (size_t q = 0; q < n; q++) {
            const double size = sqrt(fabs(dense[p * n + p] * dense[q * n + q]));
            CHECK_ABS(sum_of(&assembly, p / w, q / w, p % w, q % w), dense[p * n + q],
                      8 * EPS * size, "the same numbers added in another order");
            CHECK_EXACT(sum_of(&assembly, p / w, q / w, p % w, q % w),
                        sum_of(&assembly, q / w, p / w, q % w, p % w));
        }
    free(dense);
    assembly_free(&assembly);
    rope_free(&rope);
}

/* node terms are copied as they are, each to its node */
static void node_terms_land_on_their_nodes(void)
{
    struct rope rope = mixed_rope("zab");
    struct rd_assembly assembly = assembly_make(&rope.chain);
    CHECK_INT(rd_assemble(&rope.chain, &assembly), RD_OK);
    for (size_t i = 0; i < rope.chain.nodes; i++) {
        const size_t term = (size_t)rope.term_of[i];
        CHECK(memcmp(assembly.mass + 9 * i, rope.mass + 9 * term, 9 * sizeof(double)) == 0);
        CHECK(memcmp(assembly.springs + 9 * i, rope.stiffness + 9 * term, 9 * sizeof(double)) == 0);
    }
    assembly_free(&assembly);
    rope_free(&rope);
}

/* second difference T/l (-1, 2, -1); powers of two: exact */
static void string_assembles_to_the_second_difference(void)
{
    const struct recipe recipe = {
        .elements = 5,
        .coordinates = "z",
        .length = 0.25,
        .tension = 8,
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    struct rd_assembly assembly = assembly_make(&rope.chain);
    CHECK_INT(rd_assemble(&rope.chain, &assembly), RD_OK);
    for (size_t i = 0; i < 6; i++) {
        CHECK_EXACT(assembly.string.diagonal[i], i == 0 || i == 5 ? 32 : 64);
        CHECK_EXACT(assembly.elastic.diagonal[i], 0);
        if (i < 5)
            CHECK_EXACT(assembly.string.coupling[i], -32);
    }
    assembly_free(&assembly);
    rope_free(&rope);
}

/* moved without turning, shifted along and twisted as a whole, the chain stores nothing; turned
   about its left end, z = x beta, it stores nothing but tension */
static void rigid_motion_of_the_whole_chain_is_free(void)
{
    struct rope rope = mixed_rope("xzab");
    static const double elastic[RD_PARTS] = {[RD_ELASTIC] = 1};
    double *K = rope_dense(&rope.chain, elastic);
    const size_t n = rope.chain.nodes * 4;
    for (size_t motion = 0; motion < 4; motion++) {
        double *u = zeros(n);
        double at = 0;
        for (size_t i = 0; i < rope.chain.nodes; i++) {
            u[4 * i + motion] = 1;
            u[4 * i + 1] += motion == 3 ? at : 0;
            at += i + 1 < rope.chain.nodes ? rope.length[rope.element_of[i]] : 0;
        }
        for (size_t p = 0; p < n; p++) {
            double force = 0, size = 0;
            for (size_t q = 0; q < n; q++) {
                force += K[p * n + q] * u[q];
                size += fabs(K[p * n + q] * u[q]);
            }
            CHECK_ABS(force, 0, 2000 * EPS * size, "condition 200 of unit-diagonal G at H = 0.3");
        }
        free(u);
    }
    free(K);
    rope_free(&rope);
}

static void section_that_creates_energy_is_refused(void)
{
    struct rope rope = mixed_rope("xzab");
    struct rd_assembly assembly = assembly_make(&rope.chain);
    rope.flexibility[9 + 8] = -1;
    CHECK_INT(rd_assemble(&rope.chain, &assembly), RD_NOT_POSITIVE_DEFINITE);
    assembly_free(&assembly);
    rope_free(&rope);
}

int main(void)
{
    static const char *const coordinates[] = {"x", "z", "a", "xa", "za", "zb", "zab", "xzab"};
    for (size_t k = 0; k < sizeof coordinates / sizeof *coordinates; k++)
        assembly_is_the_sum_of_its_elements(coordinates[k]);
    node_terms_land_on_their_nodes();
    string_assembles_to_the_second_difference();
    rigid_motion_of_the_whole_chain_is_free();
    section_that_creates_energy_is_refused();
    return check_report("test_assemble");
}
