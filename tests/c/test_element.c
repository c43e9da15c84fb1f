/* Elements: triples, stiffness, shapes and local flexibility against closed forms. */
#include "element/element.h"
#include "element/triple.h"

#include "base/dense.h"
#include "chain/elements.h"
#include "chains.h"
#include "check.h"
#include "element/stiffness.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, N = 2 * W };

/* a 2015 study element with axial stiffness and extension-twist coupling added */
static const double L = 0.16875;
static const struct rd_section full = {8.5e5, 0.1485, 54.626, 120, 0.3};

/* Unit-diagonal G of `full` has a condition of at most 624 for |H| <= 1 (computed with NumPy); what is
   compared went through an inverse or two products with one. */
static const double LOOSE = 4000 * 0x1p-52;
static const char condition[] = "condition 624 of unit-diagonal G, times a few roundings";

/* one element with arrays of its own */
struct piece {
    int32_t coordinate[W];
    double S[9];
    struct rd_element element;
};

static void piece_make(struct piece *piece, const char *coordinates, enum rd_kind kind,
                       double tension, const struct rd_section *section)
{
    const struct recipe recipe = {
        .kind = kind,
        .elements = 1,
        .coordinates = coordinates,
        .length = L,
        .tension = tension,
        .section = *section,
        .left = "",
        .right = "",
    };
    struct rope rope = rope_make(&recipe);
    memcpy(piece->coordinate, rope.coordinate, rope.chain.width * sizeof *rope.coordinate);
    memcpy(piece->S, rope.flexibility, sizeof piece->S);
    piece->element = rd_chain_element(&rope.chain, 0);
    piece->element.coordinate = piece->coordinate;
    piece->element.flexibility = piece->S;
    rope_free(&rope);
}

/* the cases every identity is checked for: each width, with and without each coupling */
struct example {
    const char *coordinates;
    enum rd_kind kind;
    double tension;
    double slope;
    double coupling;
};

static const struct example example[] = {
    {"x", RD_RIGID, 0, 0, 0},
    {"z", RD_RIGID, 300, 0, 0},
    {"z", RD_DIFFERENCE, 300, 0, 0},
    {"a", RD_DIFFERENCE, 0, 0, 0},
    {"xa", RD_RIGID, 0, 0, 120},
    {"za", RD_RIGID, 300, 0, 0},
    {"zb", RD_DIFFERENCE, 0, 0, 0},
    {"zb", RD_RIGID, 0, 0, 0},
    {"zb", RD_RIGID, 2830, 0, 0},
    {"zb", RD_RIGID, -300, 0, 0},
    {"xza", RD_RIGID, 300, 0, 120},
    {"zab", RD_DIFFERENCE, 0, 0.01, 0},
    {"zab", RD_RIGID, 0, 0.01, 0},
    {"zab", RD_RIGID, 300, 0.3, 0},
    {"zab", RD_RIGID, 300, -1, 0},
    {"xzb", RD_RIGID, 300, 0, 0},
    {"xzab", RD_DIFFERENCE, 0, 0.3, 120},
    {"xzab", RD_RIGID, 0, 0.3, 120},
    {"xzab", RD_RIGID, 300, 1, 120},
    {"xzab", RD_RIGID, -30, -0.3, -120},
};
enum { EXAMPLES = sizeof example / sizeof *example };

static void example_make(struct piece *piece, const struct example *of)
{
    struct rd_section section = full;
    section.slope = of->slope;
    section.coupling = of->coupling;
    piece_make(piece, of->coordinates, of->kind, of->tension, &section);
}

/* what compares: sqrt of the flexibility a coordinate has alone; 1 where it has none */
static void units(const struct rd_element *element, double *g)
{
    double F[W * W], G[W * W], Q[W * W];
    CHECK_INT(rd_triple_real(element, F, G, Q), RD_OK);
    for (size_t i = 0; i < element->width; i++) {
        const double own = fabs(G[i * element->width + i]);
        g[i] = own > 0 ? sqrt(own) : 1;
    }
}

/* general inverse with partial pivoting, A destroyed */
static void invert(size_t n, double *A, double *inverse)
{
    for (size_t k = 0; k < n * n; k++)
        inverse[k] = k % (n + 1) == 0;
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < n; i++)
            if (fabs(A[i * n + k]) > fabs(A[p * n + k]))
                p = i;
        for (size_t j = 0; j < n; j++) {
            const double a = A[k * n + j], b = inverse[k * n + j];
            A[k * n + j] = A[p * n + j];
            inverse[k * n + j] = inverse[p * n + j];
            A[p * n + j] = a;
            inverse[p * n + j] = b;
        }
        for (size_t i = 0; i < n; i++) {
            const double factor = i == k ? 1 - 1 / A[k * n + k] : A[i * n + k] / A[k * n + k];
            for (size_t j = n; j-- > 0;) {
                inverse[i * n + j] -= factor * inverse[k * n + j];
                A[i * n + j] -= factor * A[k * n + j];
            }
        }
    }
}

/* ---- the triple ---- */

/* /work/shared/reference/element_flexibility.json, closed form in 50 digits; the study does not
   divide by 1 + H^2, the section does: C/(1 + H^2) and B/(1 + H^2) undo it */
static void study_flexibility_to_the_last_digits(void)
{
    static const double slope[] = {0, 0.01};
    static const double zz[] = {0.00002932315455323472339, 0.000030401812223689268846};
    static const double za[] = {0, 0.0009562003155548639841833559};
    static const double zb[] = {0.00026065026269541976348, 0.000270238330877237945300};
    static const double aa[] = {1.1363636363636363636, 1.1363639452824662248746};
    static const double ab[] = {0, 0.011332744480650239812543};
    static const double bb[] = {0.0030891882986123823820, 0.0032028246622487460183};
    static const char reason[] = "a dozen roundings, no cancellation but in 1/C - 1/B";
    for (size_t k = 0; k < 2; k++) {
        const double H = slope[k], norm = 1 + H * H;
        const struct rd_section section = {0, 0.1485 / norm, 54.626 / norm, 0, H};
        struct piece piece;
        double F[9], G[9], Q[9];
        piece_make(&piece, "zab", RD_DIFFERENCE, 0, &section);
        CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
        const double expected[] = {zz[k], za[k], zb[k], za[k], aa[k], ab[k], zb[k], ab[k], bb[k]};
        for (int i = 0; i < 9; i++)
            CHECK_REL(G[i], expected[i], 16 * EPS, reason);
    }
}

/* the same file's K = G^-1 */
static void study_stiffness_to_its_condition(void)
{
    static const double expected[] = {
        131571.10407001253508,  0,
        -11101.311905907307648, 0,
        0.91218851613785023,    -3.2276507338730143,
        -11101.311905907307648, -3.2276507338730143,
        1260.3181774570296383,
    };
    const double H = 0.01, norm = 1 + H * H;
    const struct rd_section section = {0, 0.1485 / norm, 54.626 / norm, 0, H};
    struct piece piece;
    double K[36], tension[36];
    piece_make(&piece, "zab", RD_DIFFERENCE, 0, &section);
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_OK);
    for (int i = 0; i < 9; i++)
        CHECK_ABS(K[6 * (3 + i / 3) + 3 + i % 3], expected[i],
                  200 * EPS * sqrt(expected[i / 3 * 4] * expected[i % 3 * 4]),
                  "condition 15 of unit-diagonal G; relative to sqrt(K_ii K_jj)");
}

static void untensed_transfer_is_identity_or_a_lever(void)
{
    for (size_t k = 0; k < EXAMPLES; k++) {
        struct piece piece;
        double F[W * W], G[W * W], Q[W * W];
        struct example without = example[k];
        without.tension = strchr(without.coordinates, 'b') != NULL ? 0 : without.tension;
        example_make(&piece, &without);
        CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
        const size_t w = piece.element.width;
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++) {
                const bool lever = without.kind == RD_RIGID && piece.coordinate[i] == RD_Z &&
                                   piece.coordinate[j] == RD_BETA;
                CHECK_EXACT(F[i * w + j], i == j ? 1 : lever ? L : 0);
                CHECK_EXACT(Q[i * w + j], 0);
                CHECK_EXACT(G[i * w + j], G[j * w + i]);
            }
    }
}

/* z without bending: G = l/T and nothing else */
static void string_element_is_its_tension(void)
{
    struct piece piece;
    double F[4], G[4], Q[4], elastic[16], tension[16];
    piece_make(&piece, "za", RD_RIGID, 300, &full);
    CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
    CHECK_EXACT(G[0], L / 300);
    CHECK_EXACT(G[1], 0);
    CHECK_EXACT(G[3], piece.S[4] * L);
    CHECK_EXACT(Q[0], 0);
    CHECK_INT(rd_element_stiffness(&piece.element, elastic, tension), RD_OK);
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < 4; j++) {
            CHECK_EXACT(tension[4 * i + j], i % 2 || j % 2 ? 0 : i == j ? 300 / L : -300 / L);
            if (i % 2 == 0 || j % 2 == 0)
                CHECK_EXACT(elastic[4 * i + j], 0);
        }
}

/* Q has one entry, T l/(1 + G_zz T/l) at (beta, beta) */
static void tension_resists_turning_with_one_entry(void)
{
    struct piece piece;
    double F[16], G[16], Q[16];
    piece_make(&piece, "xzab", RD_RIGID, 300, &full);
    const double Gzz = piece.S[8] * L * L * L / 3;
    CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
    for (size_t k = 0; k < 15; k++)
        CHECK_EXACT(Q[k], 0);
    CHECK_REL(Q[15], 300 * L / (1 + Gzz * 300 / L), 16 * EPS, "a dozen roundings");
    CHECK_REL(G[5], Gzz / (1 + Gzz * 300 / L), 16 * EPS, "a dozen roundings");
}

static double block(const double *K, size_t w, size_t a, size_t b, size_t i, size_t j)
{
    return K[(a * w + i) * 2 * w + b * w + j];
}

/* K_e = [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] is elastic + tension:
   K_bb G = I, K_ba = -K_bb F, K_aa = Q + F^T K_bb F */
static void triple_and_stiffness_agree(const struct example *of)
{
    struct piece piece;
    double F[W * W], G[W * W], Q[W * W], K[N * N], tension[N * N], g[W];
    example_make(&piece, of);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_OK);
    for (size_t k = 0; k < 4 * w * w; k++)
        K[k] += tension[k];
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            double one = 0, ba = 0, aa = Q[i * w + j];
            for (size_t p = 0; p < w; p++) {
                one += block(K, w, 1, 1, i, p) * G[p * w + j];
                ba -= block(K, w, 1, 1, i, p) * F[p * w + j];
                for (size_t q = 0; q < w; q++)
                    aa += F[p * w + i] * block(K, w, 1, 1, p, q) * F[q * w + j];
            }
            CHECK_ABS(one, i == j, LOOSE * g[j] / g[i], condition);
            CHECK_ABS(ba, block(K, w, 1, 0, i, j), LOOSE / (g[i] * g[j]), condition);
            CHECK_ABS(aa, block(K, w, 0, 0, i, j), LOOSE / (g[i] * g[j]), condition);
            CHECK_EXACT(block(K, w, 0, 1, j, i), block(K, w, 1, 0, i, j));
            CHECK_EXACT(block(K, w, 0, 0, i, j), block(K, w, 0, 0, j, i));
        }
}

/* the same for tensed elements, between critical loads too: the cantilever's are at
   |T| l^2/B = (pi/2)^2 = 2.5 and 22, those of the element held at both ends at 39 and 81 */
static void tensed_triple_and_stiffness_agree(void)
{
    static const double load[] = {-30, -10, -5, -2, -0.5, 0, 0.5, 3, 10};
    static const char *const coordinates[] = {"zb", "zab", "xzab"};
    for (size_t k = 0; k < 27; k++) {
        const double tension = load[k / 3] * full.bending / (L * L);
        const struct example of = {coordinates[k % 3], RD_TENSED, tension, 0.3, 120};
        triple_and_stiffness_agree(&of);
    }
}

/* sections times g and tension times g are the whole element times g; what is real stays real */
static void stiffness_is_homogeneous_in_its_factors(void)
{
    const double _Complex g = CMPLX(0.8, 0.3);
    const double hinge[] = {0, 0, 0, 0.02};
    for (size_t k = 0; k < 2 * EXAMPLES; k++) {
        struct piece piece;
        struct example of = example[k / 2];
        of.kind = k % 2 ? RD_TENSED : of.kind;
        example_make(&piece, &of);
        double g_own[W];
        double _Complex one[N * N], many[N * N];
        const size_t w = piece.element.width;
        units(&piece.element, g_own);
        piece.element.hinge = hinge + W - w;
        CHECK_INT(rd_element_matrix(&piece.element, 1, 1, 1, one), RD_OK);
        CHECK_INT(rd_element_matrix(&piece.element, g, g, g, many), RD_OK);
        for (size_t i = 0; i < 4 * w * w; i++) {
            const double scale = g_own[i / (2 * w) % w] * g_own[i % w];
            CHECK_EXACT(cimag(one[i]), 0);
            CHECK_ABS(cabs(many[i] - g * one[i]), 0, LOOSE / scale, condition);
        }
    }
}

/* the textbook beam element with the string in parallel */
static void bending_stiffness_is_the_textbook_one(void)
{
    const double B = 2, T = 8, l = L, t = T / l, k = B / (l * l * l);
    const double expected[16] = {
        12 * k + t, 6 * l * k,     -12 * k - t, 6 * l * k,     6 * l * k,  4 * l * l * k,
        -6 * l * k, 2 * l * l * k, -12 * k - t, -6 * l * k,    12 * k + t, -6 * l * k,
        6 * l * k,  2 * l * l * k, -6 * l * k,  4 * l * l * k,
    };
    const struct rd_section section = {.bending = B};
    struct piece piece;
    double K[16], tension[16];
    piece_make(&piece, "zb", RD_RIGID, T, &section);
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_OK);
    for (int i = 0; i < 16; i++)
        CHECK_ABS(K[i] + tension[i], expected[i], 64 * EPS * fabs(expected[i]),
                  "condition 14 of unit-diagonal G");
}

/* a rigid motion strains nothing: K (u_a, F u_a) = 0 and the rigid element turns about its node */
static void rigid_motion_gives_no_force(const struct example *of)
{
    struct piece piece;
    double F[W * W], G[W * W], Q[W * W], K[N * N], tension[N * N], g[W];
    struct example untensed = *of;
    untensed.tension = strchr(of->coordinates, 'b') != NULL ? 0 : of->tension;
    example_make(&piece, &untensed);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_OK);
    for (size_t motion = 0; motion < w; motion++)
        for (size_t i = 0; i < 2 * w; i++) {
            double force = 0;
            for (size_t j = 0; j < w; j++) {
                const double u = j == motion;
                const double v = F[j * w + motion];
                force += (K[i * 2 * w + j] + tension[i * 2 * w + j]) * u +
                         (K[i * 2 * w + w + j] + tension[i * 2 * w + w + j]) * v;
            }
            CHECK_ABS(force, 0, LOOSE / (g[i % w] * g[motion]), condition);
        }
}

/* reversed triple: G1 = F^-1 G F^-T, X = (I + G1 Q)^-1, F~ = X F^-1, G~ = X G1, Q~ = F^-T Q F~;
   half a turn about z makes it D (F, G, Q) D with D = diag(-1, 1, -1, -1) for (x, z, alpha, beta) */
static void half_a_turn_reverses_the_element(const struct example *of)
{
    struct piece piece;
    double F[W * W], G[W * W], Q[W * W], g[W];
    double copy[W * W], Fi[W * W], Fit[W * W], half[W * W], G1[W * W], X[W * W];
    double Fr[W * W], Gr[W * W], Qr[W * W];
    example_make(&piece, of);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
    memcpy(copy, F, sizeof copy);
    invert(w, copy, Fi);
    rd_dense_transpose(w, w, Fi, Fit);
    rd_dense_multiply(w, w, w, Fi, G, half);
    rd_dense_multiply(w, w, w, half, Fit, G1);
    rd_dense_multiply(w, w, w, G1, Q, copy);
    for (size_t i = 0; i < w; i++)
        copy[i * (w + 1)] += 1;
    invert(w, copy, X);
    rd_dense_multiply(w, w, w, X, Fi, Fr);
    rd_dense_multiply(w, w, w, X, G1, Gr);
    rd_dense_multiply(w, w, w, Fit, Q, half);
    rd_dense_multiply(w, w, w, half, Fr, Qr);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            const size_t ij = i * w + j;
            const bool turn = (piece.coordinate[i] == RD_Z) != (piece.coordinate[j] == RD_Z);
            /* the study's element is its own reverse; it has no lever to turn */
            const double sign = turn && of->kind == RD_RIGID ? -1 : 1;
            CHECK_ABS(Fr[ij], sign * F[ij], LOOSE * g[i] / g[j], condition);
            CHECK_ABS(Gr[ij], sign * G[ij], LOOSE * g[i] * g[j], condition);
            CHECK_ABS(Qr[ij], sign * Q[ij], LOOSE / (g[i] * g[j]), condition);
        }
}

/* S_bb = 3, l = 1: G_zz = 1 exactly, so T = -1 makes 1 + G_zz T/l vanish; an ulp beside it a huge
   but finite triple exists */
static void exactly_critical_compression_is_refused(void)
{
    struct piece piece;
    double F[16], G[16], Q[16];
    const struct rd_section section = {.axial = 1, .torsion = 1, .bending = 1};
    static const char *const coordinates[] = {"zb", "zab", "xzab"};
    for (size_t k = 0; k < 3; k++) {
        piece_make(&piece, coordinates[k], RD_RIGID, -1, &section);
        piece.element.length = 1;
        piece.S[8] = 3;
        CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_CRITICAL_ELEMENT);
        for (int side = 0; side < 2; side++) {
            piece.element.tension = nextafter(-1, side == 0 ? 0 : -2);
            CHECK_INT(rd_triple_real(&piece.element, F, G, Q), RD_OK);
            for (size_t i = 0; i < piece.element.width * piece.element.width; i++)
                CHECK(isfinite(F[i]) && isfinite(G[i]) && isfinite(Q[i]));
        }
    }
}

/* ---- the hinge ---- */

/* a beam on a free hinge: 3 B/l^3, 3 B/l^2, 3 B/l, and no moment at the hinge */
static void free_hinge_leaves_the_propped_beam(void)
{
    const double B = 2, l = L, k = B / (l * l * l);
    const double expected[16] = {
        3 * k,  0, -3 * k, 3 * l * k,  0,         0, 0,          0,
        -3 * k, 0, 3 * k,  -3 * l * k, 3 * l * k, 0, -3 * l * k, 3 * l * l * k,
    };
    const struct rd_section section = {.bending = B};
    const double hinge[] = {0, INFINITY};
    struct piece piece;
    double K[16], tension[16];
    piece_make(&piece, "zb", RD_RIGID, 0, &section);
    piece.element.hinge = hinge;
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_OK);
    for (int i = 0; i < 16; i++)
        CHECK_ABS(K[i], expected[i], 16 * EPS * fabs(K[i / 4 * 5] + K[i % 4 * 5]),
                  "12 - 9 in units of k, a few roundings");
    for (int i = 0; i < 4; i++)
        CHECK_EXACT(K[4 + i], 0);
}

/* With compliances C in all coordinates: jump = -C times the force on the left node, and the open
   element is the closed one at u_a + jump, whatever C from rigid to free */
static void hinge_opens_by_what_it_carries(const struct example *of, double compliance)
{
    struct piece piece;
    double closed[N * N], open[N * N], tension[N * N], jump[W * N], g[W], hinge[W];
    example_make(&piece, of);
    const size_t w = piece.element.width, n = 2 * w;
    units(&piece.element, g);
    for (size_t i = 0; i < w; i++)
        hinge[i] = compliance * g[i] * g[i];
    CHECK_INT(rd_element_stiffness(&piece.element, closed, tension), RD_OK);
    for (size_t i = 0; i < n * n; i++)
        closed[i] += tension[i];
    piece.element.hinge = hinge;
    CHECK_INT(rd_element_stiffness(&piece.element, open, tension), RD_OK);
    for (size_t i = 0; i < n * n; i++)
        open[i] += tension[i];
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < n; j++)
            jump[i * n + j] = -hinge[i] * open[i * n + j];
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double force = closed[i * n + j];
            for (size_t k = 0; k < w; k++)
                force += closed[i * n + k] * jump[k * n + j];
            CHECK_ABS(open[i * n + j], force, LOOSE / (g[i % w] * g[j % w]), condition);
        }
}

/* ---- between the nodes ---- */

static void shape_ends_at_the_nodes(const struct example *of)
{
    struct piece piece;
    double shape[W * N], g[W];
    example_make(&piece, of);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    for (size_t end = 0; end < 2; end++) {
        CHECK_INT(rd_element_shape(&piece.element, end == 0 ? 0 : L, shape), RD_OK);
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < 2 * w; j++)
                CHECK_ABS(shape[i * 2 * w + j], j == end * w + i,
                          end == 0 ? 0 : LOOSE * g[i] / g[j % w],
                          end == 0 ? "G(0, l) = 0" : condition);
    }
}

/* Hermite's cubic */
static void bending_shape_is_the_cubic(void)
{
    struct piece piece;
    double shape[8];
    const struct rd_section section = {.bending = 54.626};
    piece_make(&piece, "zb", RD_RIGID, 300, &section);
    for (int k = 0; k <= 8; k++) {
        const double t = k / 8.0;
        const double expected[8] = {
            1 - 3 * t * t + 2 * t * t * t, L * t * (1 - t) * (1 - t), t * t * (3 - 2 * t),
            L * t * t * (t - 1),           -6 * t * (1 - t) / L,      (1 - t) * (1 - 3 * t),
            6 * t * (1 - t) / L,           t * (3 * t - 2),
        };
        CHECK_INT(rd_element_shape(&piece.element, t * L, shape), RD_OK);
        for (int i = 0; i < 8; i++)
            CHECK_ABS(shape[i], expected[i],
                      256 * EPS *
                          (i < 4   ? i % 2 ? L : 1
                           : i % 2 ? 1
                                   : 1 / L),
                      "condition 14 of unit-diagonal G, twice");
    }
}

static void string_and_twist_shapes_are_straight(void)
{
    struct piece piece;
    double shape[8];
    piece_make(&piece, "za", RD_RIGID, 300, &full);
    for (int k = 0; k <= 4; k++) {
        const double t = k / 4.0;
        const double expected[8] = {1 - t, 0, t, 0, 0, 1 - t, 0, t};
        CHECK_INT(rd_element_shape(&piece.element, t * L, shape), RD_OK);
        for (int i = 0; i < 8; i++)
            CHECK_ABS(shape[i], expected[i], 4 * EPS, "three roundings of numbers up to 1");
    }
}

/* 1, s, cosh and sinh of k s, k^2 = T/B: B z'''' = T z'' */
static void tensed_bending_shape_is_hyperbolic(void)
{
    struct piece piece;
    double shape[8];
    const struct rd_section section = {.bending = 5};
    piece_make(&piece, "zb", RD_TENSED, 2000, &section);
    const double k = 20, C = cosh(k * L), S = sinh(k * L);
    const double node[4][4] = {{1, 0, 1, 0}, {0, 1, L, 1}, {1, 0, C, k * S}, {0, k, S, k * C}};
    for (int i = 0; i <= 16; i++) {
        const double s = i < 8 ? L * i / 8 : L * (1 - pow(10, 7 - i)), c = cosh(k * s);
        const double z[4] = {1, s, c, sinh(k * s)}, beta[4] = {0, 1, k * z[3], k * c};
        CHECK_INT(rd_element_shape(&piece.element, s, shape), RD_OK);
        for (int f = 0; f < 4; f++) {
            double sum[2] = {0};
            for (int j = 0; j < 8; j++)
                sum[j / 4] += shape[j] * node[f][j % 4];
            const double near = fmin(s, L - s), loss = near > 0 ? L / near : 1;
            CHECK_ABS(sum[0], z[f], 1e-14 * C, condition);
            CHECK_ABS(sum[1], beta[f], 1e-14 * C * k * loss, condition);
        }
    }
}

/* stiffness of an element of this length, T = 0 but for strings; in w x w blocks */
static void part_stiffness(const struct piece *of, double length, double *K)
{
    double tension[N * N];
    struct rd_element part = of->element;
    part.length = length;
    CHECK_INT(rd_element_stiffness(&part, K, tension), RD_OK);
    for (size_t k = 0; k < 4 * part.width * part.width; k++)
        K[k] += tension[k];
}

/* A node put at s moves as the shape says and yields as the local flexibility says: with K' and K"
   of the two parts, (K'_bb + K"_aa) u(s) + K'_ba u_a + K"_ab u_b = 0, (K'_bb + K"_aa) local = I */
static void node_between_moves_as_the_shape_says(const struct example *of, double s)
{
    struct piece piece;
    double left[N * N], right[N * N], shape[W * N], local[W * W], g[W];
    struct example untensed = *of;
    if (strchr(of->coordinates, 'b') != NULL && of->kind != RD_TENSED)
        untensed.tension = 0;
    example_make(&piece, &untensed);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    part_stiffness(&piece, s, left);
    part_stiffness(&piece, L - s, right);
    CHECK_INT(rd_element_shape(&piece.element, s, shape), RD_OK);
    CHECK_INT(rd_element_local(&piece.element, s, s, local), RD_OK);
    /* parts of a quarter of the length are up to 4^3 stiffer */
    const double tolerance = 64 * LOOSE;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            double a = block(left, w, 1, 0, i, j), b = block(right, w, 0, 1, i, j), one = 0;
            for (size_t p = 0; p < w; p++) {
                const double K = block(left, w, 1, 1, i, p) + block(right, w, 0, 0, i, p);
                a += K * shape[p * 2 * w + j];
                b += K * shape[p * 2 * w + w + j];
                one += K * local[p * w + j];
            }
            CHECK_ABS(a, 0, tolerance / (g[i] * g[j]), condition);
            CHECK_ABS(b, 0, tolerance / (g[i] * g[j]), condition);
            CHECK_ABS(one, i == j, tolerance * g[j] / g[i], condition);
        }
}

/* Maxwell: what a force at p moves at s, the same force at s moves at p; zero with s at a node */
static void local_flexibility_is_symmetric(const struct example *of)
{
    struct piece piece;
    double sp[W * W], ps[W * W], g[W];
    example_make(&piece, of);
    const size_t w = piece.element.width;
    units(&piece.element, g);
    static const double at[] = {0, 0.1, 0.25, 0.5, 0.8, 1};
    for (size_t k = 0; k < 36; k++) {
        const double s = at[k / 6], p = at[k % 6];
        CHECK_INT(rd_element_local(&piece.element, s * L, p * L, sp), RD_OK);
        CHECK_INT(rd_element_local(&piece.element, p * L, s * L, ps), RD_OK);
        const bool node = s == 0 || p == 0 || s == 1 || p == 1;
        for (size_t i = 0; i < w; i++)
            for (size_t j = 0; j < w; j++) {
                CHECK_ABS(sp[i * w + j], ps[j * w + i], LOOSE * g[i] * g[j], condition);
                if (node)
                    CHECK_ABS(sp[i * w + j], 0, LOOSE * g[i] * g[j], condition);
            }
    }
}

/* z(s) of a clamped-clamped beam per force at p, s <= p: q^2 s^2 (3 p l - s (3 p + q))/(6 B l^3)
   with q = l - p; for s > p turned end for end */
static double clamped_beam(double s, double p, double B)
{
    if (s > p)
        return clamped_beam(L - s, L - p, B);
    const double q = L - p;
    return q * q * s * s * (3 * p * L - s * (3 * p + q)) / (6 * B * L * L * L);
}

/* its derivative with respect to p: z(s) per moment at p */
static double clamped_beam_moment(double s, double p, double B)
{
    if (s > p)
        return -clamped_beam_moment(L - s, L - p, B);
    const double q = L - p;
    const double slope = q * (3 * L - 2 * s) - 2 * (3 * p * L - s * (3 * p + q));
    return q * s * s * slope / (6 * B * L * L * L);
}

static void local_flexibility_is_the_clamped_beam(void)
{
    const double B = 54.626;
    const struct rd_section section = {.bending = B};
    struct piece piece;
    double local[4];
    piece_make(&piece, "zb", RD_RIGID, 300, &section);
    const double unit = L * L * L / B;
    for (int k = 0; k < 81; k++) {
        const double s = L * (k / 9) / 8, p = L * (k % 9) / 8;
        CHECK_INT(rd_element_local(&piece.element, s, p, local), RD_OK);
        CHECK_ABS(local[0], clamped_beam(s, p, B), 256 * EPS * unit,
                  "cancellation from the cantilever's l^3/3B");
        CHECK_ABS(local[1], clamped_beam_moment(s, p, B), 256 * EPS * unit / L,
                  "cancellation from the cantilever's l^2/2B");
    }
    CHECK_INT(rd_element_local(&piece.element, L / 2, L / 2, local), RD_OK);
    CHECK_ABS(local[0], unit / 192, 64 * EPS * unit, "cancellation from l^3/3B");
    CHECK_ABS(local[1], 0, 64 * EPS * unit / L, "cancellation from l^2/2B");
    CHECK_ABS(local[3], unit / (L * L) / 16, 64 * EPS * unit / (L * L), "cancellation from l/B");
}

static void local_flexibility_of_a_string_is_a_triangle(void)
{
    struct piece piece;
    double local[1];
    piece_make(&piece, "z", RD_DIFFERENCE, 300, &full);
    for (int k = 0; k < 25; k++) {
        const double s = L * (k / 5) / 4, p = L * (k % 5) / 4;
        CHECK_INT(rd_element_local(&piece.element, s, p, local), RD_OK);
        CHECK_ABS(local[0], fmin(s, p) * (L - fmax(s, p)) / (L * 300), 4 * EPS * L / 300,
                  "three roundings of numbers up to l/T");
    }
}

/* ---- refusals ---- */

static void flexibility_that_creates_energy_is_refused(void)
{
    struct piece piece;
    double K[N * N], tension[N * N];
    piece_make(&piece, "xzab", RD_RIGID, 300, &full);
    piece.S[8] = -1;
    CHECK_INT(rd_element_stiffness(&piece.element, K, tension), RD_NOT_POSITIVE_DEFINITE);
    CHECK_INT(rd_element_shape(&piece.element, L / 2, K), RD_NOT_POSITIVE_DEFINITE);
    CHECK_INT(rd_element_local(&piece.element, L / 2, L / 2, K), RD_NOT_POSITIVE_DEFINITE);
}

int main(void)
{
    study_flexibility_to_the_last_digits();
    study_stiffness_to_its_condition();
    untensed_transfer_is_identity_or_a_lever();
    string_element_is_its_tension();
    tension_resists_turning_with_one_entry();
    bending_stiffness_is_the_textbook_one();
    for (size_t k = 0; k < EXAMPLES; k++) {
        triple_and_stiffness_agree(example + k);
        rigid_motion_gives_no_force(example + k);
        half_a_turn_reverses_the_element(example + k);
        shape_ends_at_the_nodes(example + k);
        local_flexibility_is_symmetric(example + k);
        for (double c = 1e-12; c < 1e2; c *= 100)
            hinge_opens_by_what_it_carries(example + k, c);
        /* the study's element, cut in two, is not the study's element */
        if (example[k].kind == RD_RIGID || strchr(example[k].coordinates, 'b') == NULL)
            for (int part = 1; part < 4; part++)
                node_between_moves_as_the_shape_says(example + k, part * L / 4);
    }
    tensed_triple_and_stiffness_agree();
    stiffness_is_homogeneous_in_its_factors();
    free_hinge_leaves_the_propped_beam();
    exactly_critical_compression_is_refused();
    bending_shape_is_the_cubic();
    tensed_bending_shape_is_hyperbolic();
    string_and_twist_shapes_are_straight();
    local_flexibility_is_the_clamped_beam();
    local_flexibility_of_a_string_is_a_triangle();
    flexibility_that_creates_energy_is_refused();
    return check_report("test_element");
}
