/* Band storage against dense assembly over the free coordinates. */
#include "assembled/band.h"

#include "assembled/system.h"
#include "chains.h"
#include "check.h"

static const struct rd_section section = {8.5e5, 0.1485, 54.626, 120, 0.3};

/* every kind of number in every part: tension, springs and masses with full blocks */
static struct rope held_rope(const char *coordinates, const char *left, const char *right)
{
    const struct recipe recipe = {
        .kind = RD_RIGID,
        .elements = 4,
        .coordinates = coordinates,
        .length = 0.16875,
        .tension = 300,
        .section = section,
        .inertia = {2, 2, 0.5, 0.25},
        .left = left,
        .right = right,
        .more = 1,
    };
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    rope.term_of[2] = MORE;
    rope.held[MORE * w] = 1; /* the first coordinate of an inner node */
    for (size_t k = 0; k < rope.chain.terms * w * w; k++)
        rope.stiffness[k] = 5 + (double)(k / w % w + k % w) / 8;
    return rope;
}

/* a prepared system: assembly, numbers and scale */
struct ready {
    struct rope rope;
    struct rd_system system;
    struct rd_workspace workspace;
};

static struct ready ready_make(const char *coordinates, const char *left, const char *right)
{
    struct ready ready = {.rope = held_rope(coordinates, left, right)};
    struct rd_workspace measure = {0};
    rd_system_prepare(&ready.rope.chain, &ready.system, &measure);
    ready.workspace = exact_workspace(measure.used);
    CHECK_INT(rd_system_prepare(&ready.rope.chain, &ready.system, &ready.workspace), RD_OK);
    return ready;
}

static void ready_free(struct ready *ready)
{
    free(ready->workspace.base);
    rope_free(&ready->rope);
}

static void free_coordinates_are_numbered_node_by_node(void)
{
    struct rope rope = held_rope("zb", "zb", "z");
    static const int32_t expected[10] = {-1, -1, 0, 1, -1, 2, 3, 4, -1, 5};
    int32_t number[10];
    CHECK_INT(rd_number_free(&rope.chain, number), 6);
    for (int k = 0; k < 10; k++)
        CHECK_INT(number[k], expected[k]);
    rope_free(&rope);
}

static void nothing_held_numbers_everything_and_all_held_nothing(void)
{
    struct rope rope = held_rope("xzab", "", "");
    int32_t number[20];
    rope.held[MORE * 4] = 0;
    CHECK_INT(rd_number_free(&rope.chain, number), 20);
    for (int k = 0; k < 20; k++)
        CHECK_INT(number[k], k);
    for (size_t k = 0; k < rope.chain.terms * 4; k++)
        rope.held[k] = 1;
    CHECK_INT(rd_number_free(&rope.chain, number), 0);
    for (int k = 0; k < 20; k++)
        CHECK_INT(number[k], -1);
    rope_free(&rope);
}

/* no two coordinates that meet are numbered farther apart, and some are that far */
static void reach_covers_what_meets(const char *coordinates)
{
    struct rope rope = held_rope(coordinates, "", "");
    const size_t w = rope.chain.width;
    CHECK_INT(rd_band_reach(&rope.chain), 2 * w - 1);
    rope_free(&rope);
}

/* factor times the parts, over the free coordinates, without scale: (free, free) */
static double *dense_free(const struct ready *ready, const double *factor)
{
    const struct rd_system *system = &ready->system;
    const size_t n = system->assembly.nodes * system->assembly.width;
    double *whole = rope_dense(&ready->rope.chain, factor);
    double *dense = zeros(system->free * system->free);
    for (size_t p = 0; p < n; p++)
        for (size_t q = 0; q < n; q++)
            if (system->number[p] >= 0 && system->number[q] >= 0)
                dense[(size_t)system->number[p] * system->free + (size_t)system->number[q]] =
                    whole[p * n + q];
    free(whole);
    return dense;
}

/* the band holds `dense` from `below` under to `above` over the diagonal, and nothing is missing */
static void check_layout(const struct ready *ready, const struct rd_band *band, size_t below,
                         size_t above, const double *dense)
{
    const size_t n = ready->system.free;
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            const double *s = band->scale;
            const double expected = dense[i * n + j] * s[i] * s[j];
            const bool stored = i <= j + below && j <= i + above;
            if (!stored) {
                CHECK(i < j || dense[i * n + j] == 0);
                continue;
            }
            const double value =
                band->matrix[band->stride * (band->row + i - j + j * band->leading)];
            CHECK_ABS(value, expected, 16 * EPS, "scaled to 1; parts added in another order");
        }
}

/* general band for LU: column j, row 2 reach + i - j of 3 reach + 1 */
static void general_band_is_the_dense_matrix(const char *coordinates)
{
    static const double factor[RD_PARTS] = {1, 0.75, 0.5, -0.25};
    struct ready ready = ready_make(coordinates, "z", "zb");
    const size_t reach = ready.system.reach, n = ready.system.free;
    const struct rd_band band = {
        .matrix = zeros(n * (3 * reach + 1)),
        .stride = 1,
        .leading = 3 * reach + 1,
        .row = 2 * reach,
        .scale = ready.system.scale,
    };
    rd_band_fill(&ready.system.assembly, factor, ready.system.number, &band);
    double *dense = dense_free(&ready, factor);
    check_layout(&ready, &band, reach, reach, dense);
    /* the rows for LU's fill-in stay as they were */
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < reach; i++)
            CHECK_EXACT(band.matrix[j * band.leading + i], 0);
    free(dense);
    free(band.matrix);
    ready_free(&ready);
}

/* lower band for Cholesky: column j, row i - j of reach + 1; nothing of it above the diagonal */
static void lower_band_is_the_dense_matrix(const char *coordinates)
{
    static const double factor[RD_PARTS] = {1, 1, 1, 0.125};
    struct ready ready = ready_make(coordinates, "zb", "z");
    const size_t reach = ready.system.reach, n = ready.system.free;
    const struct rd_band band = {
        .matrix = zeros(n * (reach + 1)),
        .stride = 1,
        .leading = reach + 1,
        .row = 0,
        .lower = true,
        .scale = ready.system.scale,
    };
    rd_band_fill(&ready.system.assembly, factor, ready.system.number, &band);
    double *dense = dense_free(&ready, factor);
    check_layout(&ready, &band, reach, 0, dense);
    free(dense);
    free(band.matrix);
    ready_free(&ready);
}

/* leading = free + 1 and row = 0 make the band a full matrix */
static void wide_band_is_a_full_matrix(const char *coordinates)
{
    static const double factor[RD_PARTS] = {[RD_MASS] = 1};
    struct ready ready = ready_make(coordinates, "", "");
    const size_t n = ready.system.free;
    const struct rd_band band = {
        .matrix = zeros(n * n),
        .stride = 1,
        .leading = n + 1,
        .row = 0,
        .scale = ready.system.scale,
    };
    rd_band_fill(&ready.system.assembly, factor, ready.system.number, &band);
    double *dense = dense_free(&ready, factor);
    check_layout(&ready, &band, n, n, dense);
    free(dense);
    free(band.matrix);
    ready_free(&ready);
}

/* real and imaginary parts of complex numbers, each without touching the other */
static void strided_bands_are_real_and_imaginary_parts(void)
{
    static const double re[RD_PARTS] = {1, 1, 1, -2};
    static const double im[RD_PARTS] = {0.5, 0, 0.25, 1};
    struct ready ready = ready_make("zab", "z", "");
    const size_t reach = ready.system.reach, n = ready.system.free;
    double *matrix = zeros(2 * n * (3 * reach + 1));
    struct rd_band band = {
        .matrix = matrix,
        .stride = 2,
        .leading = 3 * reach + 1,
        .row = 2 * reach,
        .scale = ready.system.scale,
    };
    rd_band_fill(&ready.system.assembly, re, ready.system.number, &band);
    for (size_t k = 0; k < n * (3 * reach + 1); k++)
        CHECK_EXACT(matrix[2 * k + 1], 0);
    struct rd_band other = band;
    other.matrix = matrix + 1;
    rd_band_fill(&ready.system.assembly, im, ready.system.number, &other);
    double *dense = dense_free(&ready, re);
    check_layout(&ready, &band, reach, reach, dense);
    free(dense);
    dense = dense_free(&ready, im);
    check_layout(&ready, &other, reach, reach, dense);
    free(dense);
    free(matrix);
    ready_free(&ready);
}

/* 1/sqrt of the stiffness, so that its diagonal becomes 1 */
static void scale_makes_the_stiffness_diagonal_one(void)
{
    static const double stiffness[RD_PARTS] = {1, 1, 1, 0};
    struct ready ready = ready_make("xzab", "z", "xa");
    const size_t n = ready.system.free;
    double *dense = dense_free(&ready, stiffness);
    for (size_t i = 0; i < n; i++)
        CHECK_REL(ready.system.scale[i] * ready.system.scale[i] * dense[i * n + i], 1, 8 * EPS,
                  "a square root and four roundings");
    free(dense);
    ready_free(&ready);
}

/* where the stiffness is zero, of the mass; where that is zero too, 1. Compression counts by size */
static void scale_without_stiffness_is_of_the_mass(void)
{
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "xz",
        .length = 0.25,
        .tension = -4,
        .inertia = {8, 2},
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    struct rd_workspace measure = {0};
    struct rd_system system;
    rope.mass[RIGHT_END * 4] = 0;
    rd_system_prepare(&rope.chain, &system, &measure);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_system_prepare(&rope.chain, &system, &workspace), RD_OK);
    CHECK_EXACT(system.scale[0], 0.5);
    CHECK_EXACT(system.scale[1], 0.25);
    CHECK_EXACT(system.scale[2], 1);
    CHECK_EXACT(system.scale[3], 0.25);
    free(workspace.base);
    rope_free(&rope);
}

/* x^T |D| y over the dense parts, each with its own size: the sum of magnitudes of the parts */
static void rounding_bound_is_the_sum_by_hand(const char *coordinates)
{
    static const double size[RD_PARTS] = {1, 2, 0.5, 7};
    struct ready ready = ready_make(coordinates, "z", "b");
    const size_t n = ready.system.free;
    double *x = zeros(n), *y = zeros(n);
    for (size_t i = 0; i < n; i++) {
        x[i] = fabs(check_random());
        y[i] = fabs(check_random());
    }
    double expected = 0;
    for (int part = 0; part < RD_PARTS; part++) {
        double factor[RD_PARTS] = {0};
        factor[part] = 1;
        double *dense = dense_free(&ready, factor);
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                expected += x[i] * size[part] * fabs(dense[i * n + j]) * y[j];
        free(dense);
    }
    const struct rd_assembly *assembly = &ready.system.assembly;
    const double bound = rd_band_rounding(assembly, size, ready.system.number, x, y);
    CHECK(bound > 0);
    CHECK_REL(bound, expected, 400 * EPS, "a sum of a few hundred positive terms");
    /* symmetric, and nothing for nothing */
    CHECK_EXACT(rd_band_rounding(assembly, size, ready.system.number, y, x), bound);
    static const double none[RD_PARTS] = {0};
    CHECK_EXACT(rd_band_rounding(assembly, none, ready.system.number, x, y), 0);
    free(x);
    free(y);
    ready_free(&ready);
}

/* one spring and one mass: 3 |k| + 5 |m| */
static void rounding_bound_of_one_coordinate(void)
{
    const struct recipe recipe = {
        .elements = 1,
        .coordinates = "z",
        .length = 0.5,
        .tension = 2,
        .inertia = {0, 16},
        .left = "z",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    struct rd_workspace measure = {0};
    struct rd_system system;
    rd_system_prepare(&rope.chain, &system, &measure);
    struct rd_workspace workspace = exact_workspace(measure.used);
    CHECK_INT(rd_system_prepare(&rope.chain, &system, &workspace), RD_OK);
    static const double size[RD_PARTS] = {[RD_STRING] = 3, [RD_MASS] = 5};
    const double x = 2, y = 0.5;
    CHECK_EXACT(rd_band_rounding(&system.assembly, size, system.number, &x, &y), 3 * 4 + 5 * 8);
    free(workspace.base);
    rope_free(&rope);
}

int main(void)
{
    static const char *const coordinates[] = {"x", "z", "za", "zb", "zab", "xzab"};
    free_coordinates_are_numbered_node_by_node();
    nothing_held_numbers_everything_and_all_held_nothing();
    for (size_t k = 0; k < sizeof coordinates / sizeof *coordinates; k++) {
        reach_covers_what_meets(coordinates[k]);
        general_band_is_the_dense_matrix(coordinates[k]);
        lower_band_is_the_dense_matrix(coordinates[k]);
        wide_band_is_a_full_matrix(coordinates[k]);
        rounding_bound_is_the_sum_by_hand(coordinates[k]);
    }
    strided_bands_are_real_and_imaginary_parts();
    scale_makes_the_stiffness_diagonal_one();
    scale_without_stiffness_is_of_the_mass();
    rounding_bound_of_one_coordinate();
    return check_report("test_band");
}
