/* Chains that carry all that a scene can have: responses by the sweep against those of the mixed
   form and of the assembled system, and of continuous ones against themselves cut elsewhere. */
#include "assembled/frf.h"
#include "chain/runs.h"
#include "mixed/frf.h"
#include "sweep/sweep.h"

#include "chains.h"
#include "check.h"

#include <string.h>

typedef double _Complex complex_t;

enum { SPANS = 26, PORTS = 3, POINTS = 11, VALUES = PORTS * PORTS * POINTS, MOST = 4 * 4 };

/* node terms beside those of the recipe */
enum { HEAVY = MORE, LEANING, SPUN, TIED, OPEN, CARRYING, TERMS };

/* numbers that chains of recipes lack; one test at a time */
static double damping[TERMS * MOST], hinge[TERMS * 4], sag[2], structure_row[3 * 8];

/* a wire (mass, stiffness, length, damping), a resonator, and a damped one on the same node (mass,
   stiffness, their ratio, damping) */
static const int32_t structure[] = {RD_WIRE, RD_RESONATOR, RD_RESONATOR},
                     structure_term[] = {CARRYING, CARRYING, CARRYING};
static const double number[] = {3e-3, 40, 0.05, 0.01, 0.01, 150, 15000, 0, 0.02, 900, 45000, 0.05};

/* each of the spans cut into so many elements */
static struct rope plain_rope(enum rd_kind kind, const char *coordinates, double tension,
                              size_t cut)
{
    const double each = kind == RD_CONTINUOUS ? 0.1 : 5e-3; /* of a length, or of a node */
    const struct recipe recipe = {
        .kind = kind,
        .elements = SPANS * cut,
        .coordinates = coordinates,
        .length = 0.05 / (double)cut,
        .tension = tension,
        .section = {.axial = strchr(coordinates, 'x') ? 9e3 : 0,
                    .torsion = strchr(coordinates, 'a') ? 3 : 0,
                    .bending = strchr(coordinates, 'b') ? 20 : 0,
                    .coupling = strchr(coordinates, 'x') && strchr(coordinates, 'a') ? -40 : 0,
                    .slope = strchr(coordinates, 'a') && strchr(coordinates, 'b') ? 0.3 : 0},
        .inertia = {[RD_X] = each,
                    [RD_Z] = each,
                    [RD_ALPHA] = 4e-3 * each,
                    [RD_BETA] = 2e-3 * each},
        .left = coordinates,
        .right = "xz",
        .distinct = 2,
        .more = TERMS - MORE,
    };
    struct rope rope = rope_make(&recipe);
    rope.length[1] *= 0.8;
    rope.flexibility[17] *= 2; /* softer in bending */
    return rope;
}

/* an entry of a symmetric matrix of a node term */
static void couple(double *matrix, size_t w, size_t term, size_t i, size_t j, double value)
{
    matrix[term * w * w + i * w + j] = value;
    matrix[term * w * w + j * w + i] = value;
}

/* masses beside the axis, springs, dashpots, hinges: a term each, and structures on one more */
static void dress(struct rope *rope)
{
    struct rd_chain *chain = &rope->chain;
    const size_t w = chain->width, z = rope_find(chain, 'z') % w, last = w - 1;
    memset(damping, 0, sizeof damping);
    memset(hinge, 0, sizeof hinge);
    memset(structure_row, 0, sizeof structure_row);
    couple(rope->mass, w, HEAVY, z, z, 3.0);
    couple(damping, w, HEAVY, z, z, 2.0);
    if (last != z)
        couple(rope->mass, w, LEANING, z, last, 1e-4);
    couple(rope->stiffness, w, SPUN, z, z, 700);
    if (last != z) { /* indefinite: a pair of forces that turns what it moves */
        couple(rope->stiffness, w, SPUN, z, z, 0);
        couple(rope->stiffness, w, SPUN, z, last, 60);
    }
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j <= i; j++)
            couple(rope->stiffness, w, TIED, i, j, i == j ? 400 + 50 * (double)i : -30);
    rope->held[TIED * w + z] = w > 2;
    hinge[OPEN * w + last] = last == z ? 1e-4 : INFINITY;
    hinge[LEANING * w + last] = 0.01;
    for (size_t k = 0; k < 3; k++) {
        structure_row[2 * k * w + z] = 1;
        structure_row[(2 * k + 1) * w + last] = last != z;
    }
    chain->damping = damping;
    chain->hinge = hinge;
    chain->attached = 3;
    chain->attached_kind = structure;
    chain->attached_term = structure_term;
    chain->attached_row = structure_row;
    chain->attached_value = number;
}

static void place(struct rope *rope, size_t cut)
{
    static const int32_t term[] = {HEAVY, LEANING, SPUN, TIED, OPEN, CARRYING};
    static const size_t at[] = {12, 13, 15, 17, 19, 14};
    for (size_t k = 0; k < sizeof term / sizeof *term; k++)
        rope->term_of[at[k] * cut] = term[k];
    for (size_t i = 12 * cut; i < 16 * cut; i++)
        rope->element_of[i] = 1;
    rope_gather(rope);
}

/* lossy factors: no resonance is sharp, so that both solvers keep their digits */
static void factors_at(double omega, complex_t *factor)
{
    factor[RD_ELASTIC] = CMPLX(1, 0.05);
    factor[RD_STRING] = CMPLX(1, 0.02);
    factor[RD_SPRINGS] = CMPLX(1, 0.03);
    factor[RD_MASS] = -omega * omega;
    factor[RD_DASHPOTS] = CMPLX(0, omega);
}

static double omega_of(size_t i)
{
    return 3 * exp(0.7 * (double)i);
}

/* where it is pushed and watched */
struct places {
    int32_t node[PORTS];
    double row[PORTS * 8], force[PORTS * 4];
};

/* at three nodes; between two of them and by a force too, where elements are not cut */
static struct places places_of(size_t w, size_t cut)
{
    struct places places = {.node = {5, 14, 22}};
    for (size_t i = 0; i < (cut > 0 ? w : 2 * w); i++)
        places.row[i] = 1.0 / (double)(i + 1);
    places.row[2 * w] = 1;
    places.row[4 * w] = 0.2;
    if (cut == 0) {
        places.force[2 * w] = 1e-4;
        places.force[3 * w - 1] = 1e-3;
    }
    for (size_t p = 0; p < PORTS; p++)
        places.node[p] *= cut > 0 ? (int32_t)cut : 1;
    return places;
}

/* value (POINTS, PORTS, PORTS) */
static void by_mixed_form(const struct rope *rope, const struct rd_ports *ports, complex_t *value)
{
    struct rd_mixed_frf frf;
    struct rd_workspace space = {0};
    double error[PORTS * PORTS];
    rd_mixed_frf_prepare(&rope->chain, ports, ports, &frf, &space);
    space = exact_workspace(space.used);
    CHECK_INT(rd_mixed_frf_prepare(&rope->chain, ports, ports, &frf, &space), RD_OK);
    for (size_t i = 0; i < POINTS; i++) {
        complex_t factor[RD_PARTS];
        factors_at(omega_of(i), factor);
        CHECK_INT(rd_mixed_frf_solve(&frf, factor, 1, value + i * PORTS * PORTS, error), RD_OK);
    }
    free(space.base);
}

/* the same of displacements alone */
static void by_assembled_system(const struct rope *rope, const struct rd_ports *ports,
                                complex_t *value)
{
    struct rd_frf frf;
    struct rd_workspace space = {0};
    double rounding[PORTS * PORTS], motion[PORTS];
    rd_frf_prepare(&rope->chain, ports, ports, &frf, &space);
    space = exact_workspace(space.used);
    CHECK_INT(rd_frf_prepare(&rope->chain, ports, ports, &frf, &space), RD_OK);
    for (size_t i = 0; i < POINTS; i++) {
        complex_t factor[RD_PARTS];
        factors_at(omega_of(i), factor);
        CHECK_INT(rd_frf_solve(&frf, factor, &(struct rd_stop){0}, value + i * PORTS * PORTS,
                               rounding, motion),
                  RD_OK);
    }
    free(space.base);
}

/* value (PORTS, PORTS, POINTS) */
static void by_sweep(const struct rope *rope, const struct rd_ports *ports, complex_t *value)
{
    double part[RD_PARTS][2 * POINTS], error[VALUES];
    for (size_t i = 0; i < POINTS; i++) {
        complex_t factor[RD_PARTS];
        factors_at(omega_of(i), factor);
        for (size_t k = 0; k < RD_PARTS; k++) {
            part[k][2 * i] = creal(factor[k]);
            part[k][2 * i + 1] = cimag(factor[k]);
        }
    }
    const struct rd_factors factors = {POINTS,
                                       part[RD_ELASTIC],
                                       part[RD_STRING],
                                       part[RD_SPRINGS],
                                       part[RD_MASS],
                                       part[RD_DASHPOTS],
                                       NULL};
    struct rd_workspace space = {0};
    size_t failed = 0;
    rd_frf_sweep(&rope->chain, &factors, ports, ports, &space, (double *)value, error, &failed);
    space = exact_workspace(space.used);
    CHECK_INT(
        rd_frf_sweep(&rope->chain, &factors, ports, ports, &space, (double *)value, error, &failed),
        RD_OK);
    free(space.base);
}

static double largest(const complex_t *value)
{
    double most = 0;
    for (size_t i = 0; i < POINTS; i++)
        most = fmax(most, cabs(value[i]));
    return most;
}

static struct rope dressed(enum rd_kind kind, const char *coordinates, double tension, double slack,
                           size_t cut)
{
    struct rope rope = plain_rope(kind, coordinates, tension, cut);
    dress(&rope);
    place(&rope, cut);
    sag[0] = sag[1] = slack;
    rope.chain.sag = slack != 0 ? sag : NULL;
    return rope;
}

/* value (PORTS, PORTS, POINTS) against other (POINTS, PORTS, PORTS) */
static void compare(const complex_t *value, const complex_t *other, double tolerance,
                    const char *reason)
{
    for (size_t p = 0; p < PORTS * PORTS; p++)
        for (size_t i = 0; i < POINTS; i++)
            CHECK_ABS(cabs(value[p * POINTS + i] - other[i * PORTS * PORTS + p]), 0,
                      tolerance * largest(value + p * POINTS), reason);
}

/* other formulas, other rounding, the same physics */
static void solvers_agree(enum rd_kind kind, const char *coordinates, double tension, double slack)
{
    struct rope rope = dressed(kind, coordinates, tension, slack, 1);
    const struct places all = places_of(rope.chain.width, 0), own = places_of(rope.chain.width, 1);
    const struct rd_ports ports = {PORTS, all.node, all.row, all.force};
    const struct rd_ports displacements = {PORTS, own.node, own.row, NULL};
    complex_t value[VALUES], other[VALUES];
    by_sweep(&rope, &ports, value);
    by_mixed_form(&rope, &ports, other);
    compare(value, other, 1e-12, "measured 2e-13");
    by_sweep(&rope, &displacements, value);
    by_assembled_system(&rope, &displacements, other);
    compare(value, other, 1e-11, "measured 1e-12");
    rope_free(&rope);
}

/* a span is the same in three pieces, which are no longer crossed at once */
static void spans_may_be_cut(const char *coordinates, double tension, double slack)
{
    complex_t value[2][VALUES];
    for (size_t k = 0; k < 2; k++) {
        const size_t cut = 1 + 2 * k;
        struct rope rope = dressed(RD_CONTINUOUS, coordinates, tension, slack, cut);
        const struct places places = places_of(rope.chain.width, cut);
        const struct rd_ports ports = {PORTS, places.node, places.row, places.force};
        by_sweep(&rope, &ports, value[k]);
        rope_free(&rope);
    }
    for (size_t p = 0; p < PORTS * PORTS; p++)
        for (size_t i = 0; i < POINTS; i++)
            CHECK_ABS(cabs(value[0][p * POINTS + i] - value[1][p * POINTS + i]), 0,
                      1e-12 * largest(value[0] + p * POINTS), "measured 4e-14");
}

int main(void)
{
    static const char *const coordinates[] = {"z", "zb", "xz", "zab", "xzb", "xzab", "xza"};
    for (size_t c = 0; c < sizeof coordinates / sizeof *coordinates; c++) {
        const char *names = coordinates[c];
        const bool bends = strchr(names, 'b');
        const double slack = strncmp(names, "xz", 2) == 0 ? 0.03 : 0;
        solvers_agree(RD_DIFFERENCE, names, bends ? 0 : 300, 0);
        solvers_agree(RD_RIGID, names, 300, slack);
        solvers_agree(RD_TENSED, names, 300, slack);
        solvers_agree(RD_TENSED, names, 1e5, slack);
        spans_may_be_cut(names, 300, slack);
        if (bends) { /* pushed: a string cannot be */
            solvers_agree(RD_RIGID, names, -40, 0);
            solvers_agree(RD_TENSED, names, -40, 0);
            solvers_agree(RD_RIGID, names, -3e4, 0); /* a strut, beyond 3 B/l^2 */
            spans_may_be_cut(names, -40, 0);
        }
    }
    return check_report("test_dressed");
}
