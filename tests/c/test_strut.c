/* The transfer of a strongly compressed element against the matrix of the same element. */
#include "element/strut.h"

#include "base/dense.h"
#include "check.h"
#include "element/section.h"
#include "element/stiffness.h"
#include "element/triple.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, E = 2 * W };

static const double L = 0.17;

/* every coupling that the coordinates can have */
static const struct rd_section section = {
    .axial = 8.5e5, .torsion = 0.1485, .bending = 54.626, .coupling = 120, .slope = 0.3};

static const int32_t both[] = {RD_Z, RD_BETA}, three[] = {RD_Z, RD_ALPHA, RD_BETA},
                     four[] = {RD_X, RD_Z, RD_ALPHA, RD_BETA};
static const int32_t *const coordinates[] = {both, three, four};

/* the element whose -T S_bb l^2 is `compression` */
static struct rd_element make(enum rd_kind kind, size_t width, double compression, double *S)
{
    rd_section_flexibility(&section, S);
    return (struct rd_element){
        .kind = kind,
        .width = width,
        .coordinate = coordinates[width - 2],
        .length = L,
        .tension = -compression / (S[8] * L * L),
        .flexibility = S,
    };
}

/* K = [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1 + P]], F = I + D; (2 w, 2 w) */
static void assemble(size_t w, const double *D, const double *G, const double *Q, const double *P,
                     double *K)
{
    double F[W * W], transposed[W * W], inverse[W * W], GF[W * W], FGF[W * W];
    memcpy(F, D, w * w * sizeof *F);
    for (size_t i = 0; i < w; i++)
        F[i * (w + 1)] += 1;
    memcpy(inverse, G, w * w * sizeof *inverse);
    CHECK(rd_dense_invert(w, inverse));
    rd_dense_transpose(w, w, F, transposed);
    rd_dense_multiply(w, w, w, inverse, F, GF);
    rd_dense_multiply(w, w, w, transposed, GF, FGF);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t at = i * w + j;
            K[i * 2 * w + j] = Q[at] + FGF[at];
            K[(i + w) * 2 * w + j] = -GF[at];
            K[j * 2 * w + i + w] = -GF[at];
            K[(i + w) * 2 * w + j + w] = inverse[at] + P[at];
        }
}

static void strut_matrix(const struct rd_element *element, double *K)
{
    double D[W * W], G[W * W], Q[W * W], P[W * W];
    CHECK_INT(rd_strut_fill(element, D, G, Q, P), RD_OK);
    assemble(element->width, D, G, Q, P, K);
}

static void exact_matrix(const struct rd_element *element, double *K)
{
    const size_t n = 2 * element->width;
    double _Complex matrix[E * E];
    CHECK_INT(rd_element_matrix(element, 1, 1, 1, matrix), RD_OK);
    for (size_t i = 0; i < n * n; i++)
        K[i] = creal(matrix[i]);
}

/* Entries of size sqrt(K_ii K_jj) of the untensed element, which every term of a sum here has. */
static void check_same(const struct rd_element *element, const double *K, const double *expected,
                       double tolerance, const char *reason)
{
    const size_t n = 2 * element->width;
    double size[E * E];
    struct rd_element untensed = *element;
    untensed.tension = 0;
    exact_matrix(&untensed, size);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double own = sqrt(size[i * (n + 1)] * size[j * (n + 1)]);
            const double loaded = sqrt(fabs(expected[i * (n + 1)] * expected[j * (n + 1)]));
            CHECK_ABS(K[i * n + j], expected[i * n + j], tolerance * fmax(own, loaded), reason);
        }
}

/* G scaled to a diagonal of 1 has the condition 14 in z and beta, and S_tt S_bb/(S_tt S_bb - S_tb^2)
   is 28 in alpha and beta */
static double tolerance_of(size_t width)
{
    return (width == 2 ? 8 * 14 : 4 * 14 * 28) * EPS;
}

/* the poles of the cantilever, 2.47 of the tensed and 3 of the rigid element, are among them */
static void it_assembles_to_the_matrix_of_the_element(enum rd_kind kind, size_t width)
{
    static const double compression[] = {1.001, 1.5, 2.4674, 2.46741, 3, 5, 9.87, 15, 30, 36};
    for (size_t k = 0; k < sizeof compression / sizeof *compression; k++) {
        double S[9], K[E * E], expected[E * E];
        const struct rd_element element = make(kind, width, compression[k], S);
        CHECK(rd_element_is_strut(&element));
        strut_matrix(&element, K);
        exact_matrix(&element, expected);
        check_same(&element, K, expected, tolerance_of(width),
                   "G of that condition inverted, d of a column that cancels by 12");
    }
}

static void it_begins_where_the_cantilever_ends(enum rd_kind kind, size_t width)
{
    double S[9], D[W * W], G[W * W], Q[W * W], K[E * E], before[E * E];
    const double P[W * W] = {0};
    struct rd_element element = make(kind, width, 1 - 4 * EPS, S);
    CHECK(!rd_element_is_strut(&element));
    CHECK_INT(rd_triple_change(&element, D, G, Q), RD_OK);
    assemble(width, D, G, Q, P, before);
    element = make(kind, width, 1 + 4 * EPS, S);
    CHECK(rd_element_is_strut(&element));
    strut_matrix(&element, K);
    check_same(&element, K, before, tolerance_of(width),
               "8 EPS of load, and as both matrices against that of the element");
}

/* z beside beta follows Q and P; the others are left alone */
static void only_bending_is_left_to_the_nodes(enum rd_kind kind, size_t width)
{
    double S[9], D[W * W], G[W * W], Q[W * W], P[W * W];
    const struct rd_element element = make(kind, width, 5, S);
    CHECK_INT(rd_strut_fill(&element, D, G, Q, P), RD_OK);
    for (size_t i = 0; i < width; i++)
        for (size_t j = 0; j < width; j++) {
            CHECK_EXACT(Q[i * width + j], Q[j * width + i]);
            CHECK_EXACT(P[i * width + j], P[j * width + i]);
            CHECK_EXACT(G[i * width + j], G[j * width + i]);
            const int32_t a = element.coordinate[i], b = element.coordinate[j];
            const bool bends = (a == RD_Z || a == RD_BETA) && (b == RD_Z || b == RD_BETA);
            CHECK(bends || (Q[i * width + j] == 0 && P[i * width + j] == 0));
            CHECK(b == RD_Z || b == RD_BETA || D[i * width + j] == 0);
        }
}

static void a_tensed_element_or_one_that_does_not_bend_is_none(void)
{
    double S[9];
    struct rd_element element = make(RD_TENSED, 2, -5, S);
    CHECK(!rd_element_is_strut(&element));
    element = make(RD_TENSED, 2, 0, S);
    CHECK(!rd_element_is_strut(&element));
    element = make(RD_DIFFERENCE, 2, 5, S);
    CHECK(!rd_element_is_strut(&element));
    element = make(RD_TENSED, 2, 5, S);
    element.width = 1;
    CHECK(!rd_element_is_strut(&element));
}

/* -T S_bb l^2 = 1, in numbers that are exact */
static void the_threshold_itself_is_none(void)
{
    const double S[9] = {[8] = 0.5};
    struct rd_element element = {.kind = RD_RIGID,
                                 .width = 2,
                                 .coordinate = both,
                                 .length = 2,
                                 .tension = -0.5,
                                 .flexibility = S};
    CHECK(!rd_element_is_strut(&element));
    element.tension = nextafter(-0.5, -1);
    CHECK(rd_element_is_strut(&element));
}

/* clamped at both ends it buckles at 4 pi^2: beyond, its matrix is that of rd_element_matrix still */
static void beyond_its_own_critical_load(void)
{
    static const double compression[] = {39.4, 39.5, 45, 60};
    for (size_t k = 0; k < sizeof compression / sizeof *compression; k++) {
        double S[9], K[E * E], expected[E * E];
        const struct rd_element element = make(RD_TENSED, 2, compression[k], S);
        strut_matrix(&element, K);
        exact_matrix(&element, expected);
        const double apart = fabs(sqrt(compression[k]) / (2 * 3.14159265358979323846) - 1);
        check_same(&element, K, expected, 32 * EPS / apart + 128 * EPS,
                   "EPS over the relative distance of t from the pole at 2 pi");
    }
}

int main(void)
{
    static const enum rd_kind kinds[] = {RD_RIGID, RD_TENSED};
    for (size_t k = 0; k < 2; k++)
        for (size_t width = 2; width <= W; width++) {
            it_assembles_to_the_matrix_of_the_element(kinds[k], width);
            it_begins_where_the_cantilever_ends(kinds[k], width);
            only_bending_is_left_to_the_nodes(kinds[k], width);
        }
    a_tensed_element_or_one_that_does_not_bend_is_none();
    the_threshold_itself_is_none();
    beyond_its_own_critical_load();
    return check_report("test_strut");
}
