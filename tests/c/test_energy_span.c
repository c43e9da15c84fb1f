/* Energies of continuous spans against the integrals of their waves. */
#include "mode.h"

#include "chains.h"
#include "check.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, HINGED = MORE };

static const double B = 54.626, MU = 0.1, J = 3e-5, LENGTH = 1.5;

/* int cos^2(p x + phase) dx and of sin^2 over the rope */
struct integrals {
    double cosine, sine;
};

static struct integrals integrate(double p, double phase)
{
    const double swing = (sin(2 * (p * LENGTH + phase)) - sin(2 * phase)) / (4 * p);
    return (struct integrals){LENGTH / 2 + swing, LENGTH / 2 - swing};
}

static struct recipe recipe_of(const char *names, size_t elements, double tension)
{
    return (struct recipe){
        .kind = RD_CONTINUOUS,
        .elements = elements,
        .coordinates = names,
        .length = LENGTH / (double)elements,
        .tension = tension,
        .section = {.axial = 8.5e5, .torsion = 0.1485, .bending = B},
        .inertia = {MU, MU, 2e-6, J},
        .left = "",
        .right = "",
        .more = 1,
    };
}

/* Elements, x = p l long, have F, G, Q to some 16 EPS, and their forces divide by G, which is smaller
   than what is subtracted in it by x^3 at the most. */
static double rounding(double p)
{
    const double x = p * LENGTH / 12;
    return 16 * EPS * (1 + 1 / (x * x * x));
}

/* u = cos(p x + phase), K p^2 = lambda m: all strain is K p^2 sin^2, all motion m cos^2 */
static void wave_of_one_coordinate_has_its_integrals(const char *names, enum rd_strain strain,
                                                     double stiffness, double inertia)
{
    const struct recipe recipe = recipe_of(names, 12, 300);
    struct rope rope = rope_make(&recipe);
    const double drag = 0.7, dashpot[] = {[LEFT_END] = 2, [INNER] = 0, [RIGHT_END] = 3, [MORE] = 0};
    rope.chain.drag = &drag;
    rope.chain.damping = dashpot;
    for (int k = 0; k < 6; k++) {
        const double p = 0.5 + 1.7 * k, phase = 0.4 * k;
        const struct integrals in = integrate(p, phase);
        double shape[13], stored[RD_STRAINS], kinetic[W], dragged;
        for (int i = 0; i < 13; i++)
            shape[i] = cos(p * i * recipe.length + phase);
        CHECK_INT(
            mode_energy(&rope.chain, stiffness * p * p / inertia, shape, stored, kinetic, &dragged),
            RD_OK);
        for (int s = 0; s < RD_STRAINS; s++)
            CHECK_ABS(stored[s], s == (int)strain ? stiffness * p * p * in.sine : 0,
                      rounding(p) * stiffness * p * p * LENGTH, "forces by differences");
        CHECK_ABS(kinetic[0], inertia * in.cosine, rounding(p) * inertia * LENGTH,
                  "forces by differences");
        const double ends = 2 * shape[0] * shape[0] + 3 * shape[12] * shape[12];
        CHECK_ABS(dragged, drag * in.cosine + ends, rounding(p) * (drag * LENGTH + 5),
                  "forces by differences");
    }
    rope_free(&rope);
}

/* The wave z = cos(p x + phase) of a tensed beam, (mu + j p^2) lambda = p^2 (B p^2 + T), with a hinge
   C at its left end: m = -B p^2 cos there, and the node turns C m less than the rope. */
static void wave_of_a_tensed_beam_has_its_integrals(double tension, double compliance,
                                                    const char *names)
{
    struct recipe recipe = recipe_of(names, 12, tension);
    recipe.inertia[RD_ALPHA] = 1e-9; /* elements shorter than a quarter of a wave of twist */
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width, beta = rope_find(&rope.chain, 'b');
    double *hinge = zeros(4 * w);
    hinge[HINGED * w + beta] = compliance;
    rope.chain.hinge = hinge;
    rope.term_of[0] = HINGED;
    const double spring = 40;
    rope.stiffness[RIGHT_END * w * w] = spring;
    for (int k = 0; k < 6; k++) {
        const double p = 0.5 + 1.7 * k, phase = 0.4 * k;
        const double lambda = p * p * (B * p * p + tension) / (MU + J * p * p);
        const struct integrals in = integrate(p, phase);
        double shape[13 * W] = {0}, stored[RD_STRAINS], kinetic[W], dragged, hinges = 0;
        for (size_t i = 0; i < 13; i++) {
            const double at = p * (double)i * recipe.length + phase;
            const double moment = -B * p * p * cos(at);
            const bool hinged = rope.term_of[i] == HINGED;
            shape[i * w] = cos(at);
            shape[i * w + beta] = -p * sin(at) - (hinged ? compliance * moment : 0);
            hinges += hinged ? compliance * moment * moment : 0;
        }
        const double end = shape[12 * w];
        CHECK_INT(mode_energy(&rope.chain, lambda, shape, stored, kinetic, &dragged), RD_OK);
        const double size =
            (fabs(lambda) * (MU + J * p * p) + fabs(tension) * p * p) * LENGTH + hinges + spring;
        const double expected[RD_STRAINS] = {
            [RD_STRAIN_BENDING] = B * p * p * p * p * in.cosine,
            [RD_STRAIN_TENSION] = tension * p * p * in.sine,
            [RD_STRAIN_SPRING] = hinges + spring * end * end,
        };
        for (int s = 0; s < RD_STRAINS; s++)
            CHECK_ABS(stored[s], expected[s], 4 * rounding(p) * size, "forces by differences");
        CHECK_ABS(kinetic[0], MU * in.cosine, 4 * rounding(p) * size / fabs(lambda), "the same");
        CHECK_ABS(kinetic[beta], J * p * p * in.sine, 4 * rounding(p) * size / fabs(lambda),
                  "the same");
    }
    free(hinge);
    rope_free(&rope);
}

/* clamped by its node and freely hinged, it moves as a pinned one: z = sin(p x), the node at rest */
static void free_hinge_stores_nothing(void)
{
    const struct recipe recipe = recipe_of("zb", 12, 300);
    struct rope rope = rope_make(&recipe);
    double hinge[4 * 2] = {0}, shape[13 * 2], stored[RD_STRAINS], kinetic[W], dragged;
    hinge[LEFT_END * 2 + 1] = INFINITY;
    rope.chain.hinge = hinge;
    const double p = 2 * 3.14159265358979323846 / LENGTH;
    const double lambda = p * p * (B * p * p + 300) / (MU + J * p * p);
    for (int i = 0; i < 13; i++) {
        shape[2 * i] = sin(p * i * recipe.length);
        shape[2 * i + 1] = i == 0 ? 0 : p * cos(p * i * recipe.length);
    }
    CHECK_INT(mode_energy(&rope.chain, lambda, shape, stored, kinetic, &dragged), RD_OK);
    const double half = LENGTH / 2, allowed = 4 * rounding(p);
    CHECK_EXACT(stored[RD_STRAIN_SPRING], 0);
    CHECK_REL(stored[RD_STRAIN_BENDING], B * p * p * p * p * half, allowed, "as above");
    CHECK_REL(stored[RD_STRAIN_TENSION], 300 * p * p * half, allowed * B * p * p / 300, "as above");
    CHECK_REL(kinetic[0], MU * half, allowed, "as above");
    CHECK_REL(kinetic[1], J * p * p * half, allowed * MU / (J * p * p), "as above");
    rope_free(&rope);
}

/* Stretch, twist and what they share: u = v cos(k x) has f = -k S^-1 v sin(k x), and S M v = v k^2/lambda */
static void laid_wave_shares_its_strain(void)
{
    struct recipe recipe = recipe_of("xa", 12, 300);
    recipe.section.coupling = 120;
    struct rope rope = rope_make(&recipe);
    const double *S = rope.flexibility, det = S[0] * S[4] - S[1] * S[1];
    const double a = S[0] * MU, b = S[1] * 2e-6, c = S[1] * MU, d = S[4] * 2e-6;
    for (int which = 0; which < 2; which++) {
        const double root = hypot(a - d, 2 * sqrt(b * c));
        const double theta = (a + d + (which ? root : -root)) / 2, k = 5;
        const bool first = fabs(a - theta) > fabs(d - theta);
        const double v[] = {first ? b : theta - d, first ? theta - a : c};
        const double f[] = {k * (S[4] * v[0] - S[1] * v[1]) / det,
                            k * (S[0] * v[1] - S[1] * v[0]) / det};
        const struct integrals in = integrate(k, 0);
        double shape[13 * 2], stored[RD_STRAINS], kinetic[W], dragged;
        for (int i = 0; i < 13; i++)
            for (int j = 0; j < 2; j++)
                shape[2 * i + j] = v[j] * cos(k * i * recipe.length);
        CHECK_INT(mode_energy(&rope.chain, k * k / theta, shape, stored, kinetic, &dragged), RD_OK);
        const double whole = fabs(f[0] * f[0] * S[0]) + fabs(f[1] * f[1] * S[4]);
        const double allowed = 8 * rounding(k) * whole * LENGTH * S[0] * S[4] / det;
        CHECK_ABS(stored[RD_STRAIN_STRETCH], S[0] * f[0] * f[0] * in.sine, allowed, "as above");
        CHECK_ABS(stored[RD_STRAIN_TWIST], S[4] * f[1] * f[1] * in.sine, allowed, "as above");
        CHECK_ABS(stored[RD_STRAIN_LAY], 2 * S[1] * f[0] * f[1] * in.sine, allowed, "as above");
        for (int j = 0; j < 2; j++)
            CHECK_ABS(kinetic[j], rope.inertia[j] * v[j] * v[j] * in.cosine,
                      allowed * theta / (k * k), "as above");
    }
    rope_free(&rope);
}

/* longer than a quarter of a wave, the right end held by its force alone */
static void element_beyond_its_resonance_is_refused(void)
{
    const struct recipe recipe = recipe_of("z", 1, 300);
    struct rope rope = rope_make(&recipe);
    const double k = 2 / LENGTH, shape[2] = {0, 1};
    double stored[RD_STRAINS], kinetic[W], dragged;
    CHECK_INT(mode_energy(&rope.chain, 300 * k * k / MU, shape, stored, kinetic, &dragged),
              RD_INDEFINITE_ELEMENT);
    rope_free(&rope);
}

int main(void)
{
    wave_of_one_coordinate_has_its_integrals("z", RD_STRAIN_TENSION, 300, MU);
    wave_of_one_coordinate_has_its_integrals("x", RD_STRAIN_STRETCH, 8.5e5, MU);
    wave_of_one_coordinate_has_its_integrals("a", RD_STRAIN_TWIST, 0.1485, 2e-6);
    static const double tension[] = {0, 300, 3e4, -100};
    for (int k = 0; k < 4; k++) {
        wave_of_a_tensed_beam_has_its_integrals(tension[k], 0, "zb");
        wave_of_a_tensed_beam_has_its_integrals(tension[k], 0.02, "zb");
        wave_of_a_tensed_beam_has_its_integrals(tension[k], 0.02, "zab");
    }
    free_hinge_stores_nothing();
    laid_wave_shares_its_strain();
    element_beyond_its_resonance_is_refused();
    return check_report("test_energy_span");
}
