/* Slopes of the forms of elements against differences of high order of the forms themselves. */
#include "energy/sensitivity.h"

#include "base/dense.h"
#include "chain/elements.h"
#include "chains.h"
#include "check.h"
#include "element/stiffness.h"
#include "mode.h"
#include "sweep/kernel/transfer.h"

#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { W = RD_WIDTH_MAX, N = 2 * RD_WIDTH_MAX };

static const double LAMBDA = 4e3;

/* Of the difference: the seventh derivative of l^-3, which the steepest parts of the form follow, is
   181440 l^-10, times step^6/140; and rounding of the form over the step. Relative to the form. */
static const double STEP = 4e-3, ALLOWED = 1e-10;

static struct recipe recipe_of(enum rd_kind kind, const char *names, double tension)
{
    return (struct recipe){
        .kind = kind,
        .elements = 1,
        .coordinates = names,
        .length = 0.25,
        .tension = tension,
        .section = {.axial = 900, .torsion = 1, .bending = 5, .coupling = -12, .slope = 0.3},
        .inertia = {0.1, 0.1, 1e-4, 1e-4},
        .left = "",
        .right = "",
        .more = 1,
    };
}

/* K over (u_a, u_b) of the one element, without its hinge */
static void massless_matrix(const struct rd_chain *chain, double *K)
{
    const struct rd_element element = rd_chain_element(chain, 0);
    double _Complex complex_K[N * N];
    CHECK_INT(rd_element_matrix(&element, 1, 1, 1, complex_K), RD_OK);
    for (size_t i = 0; i < 4 * chain->width * chain->width; i++)
        K[i] = creal(complex_K[i]);
}

/* [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] */
static void continuous_matrix(const struct rd_chain *chain, double *K)
{
    const size_t w = chain->width;
    struct rd_transfer transfer;
    const cv part[RD_PARTS] = {
        [RD_ELASTIC] = c_real(1), [RD_STRING] = c_real(1), [RD_MASS] = c_real(-LAMBDA)};
    rd_transfer_fill(chain, 0, part, &transfer);
    double F[W * W], T[W * W], G[W * W], GF[W * W], FGF[W * W];
    for (size_t i = 0; i < w * w; i++) {
        F[i] = creal(transfer.F[0][i]);
        G[i] = creal(transfer.G[0][i]);
    }
    CHECK(rd_dense_invert(w, G));
    rd_dense_transpose(w, w, F, T);
    rd_dense_multiply(w, w, w, G, F, GF);
    rd_dense_multiply(w, w, w, T, GF, FGF);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            K[i * 2 * w + j] = creal(transfer.Q[0][i * w + j]) + FGF[i * w + j];
            K[i * 2 * w + w + j] = -GF[j * w + i];
            K[(w + i) * 2 * w + j] = -GF[i * w + j];
            K[(w + i) * 2 * w + w + j] = G[i * w + j];
        }
}

/* the coordinate of the left end in which a hinge opens, or the last */
static size_t hinged(const struct rd_chain *chain)
{
    size_t e = 0;
    while (e + 1 < chain->width && !(chain->hinge && chain->hinge[e] != 0))
        e++;
    return e;
}

/* Pi = u^T K u with the left hinge open; size <- |u|^T |K| |u| */
static double form(const struct rd_chain *chain, const double *u, double *size)
{
    const size_t n = 2 * chain->width, e = hinged(chain);
    double K[N * N], sum = 0;
    if (chain->kind == RD_CONTINUOUS)
        continuous_matrix(chain, K);
    else
        massless_matrix(chain, K);
    const double C = chain->hinge ? chain->hinge[e] : 0;
    const double kept = isinf(C) ? 1 / K[e * n + e] : C / (1 + C * K[e * n + e]);
    double k[N];
    memcpy(k, K + e * n, n * sizeof *k);
    *size = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            sum += u[i] * (K[i * n + j] - kept * k[i] * k[j]) * u[j];
            *size += fabs(u[i] * K[i * n + j] * u[j]);
        }
    return sum;
}

/* moves one number of the chain by `by`, both places of an entry of S */
static void move(struct rope *rope, size_t property, double by)
{
    static const size_t row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
    if (property < RD_OF_TENSION) {
        const size_t c = row[property], d = column[property];
        rope->flexibility[c * RD_CHANNELS + d] += by;
        rope->flexibility[d * RD_CHANNELS + c] += c == d ? 0 : by;
    } else if (property == RD_OF_TENSION) {
        rope->tension[0] += by;
    } else if (property == RD_OF_LENGTH) {
        rope->length[0] += by;
    } else {
        rope->inertia[property - RD_OF_INERTIA] += by;
    }
}

/* a size of the number that the form changes with; 0 where the element has none */
static double scale_of(const struct rope *rope, size_t property)
{
    static const size_t row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
    const struct rd_chain *chain = &rope->chain;
    const double *S = rope->flexibility, l = rope->length[0];
    if (property < RD_OF_TENSION) {
        bool has[RD_CHANNELS] = {false};
        for (size_t i = 0; i < chain->width; i++)
            if (chain->coordinate[i] != RD_Z)
                has[rd_channel_of(chain->coordinate[i])] = true;
        const size_t c = row[property], d = column[property];
        return has[c] && has[d] ? sqrt(S[c * 4] * S[d * 4]) : 0;
    }
    if (property == RD_OF_TENSION) {
        const size_t z = rope_find(chain, 'z');
        const bool string = chain->coordinate[chain->width - 1] != RD_BETA;
        return z == chain->width ? 0 : string ? rope->tension[0] : 1 / (S[8] * l * l);
    }
    if (property == RD_OF_LENGTH)
        return l;
    const size_t i = property - RD_OF_INERTIA;
    return chain->kind == RD_CONTINUOUS && i < chain->width ? rope->inertia[i] : 0;
}

/* sixth order */
static double difference(struct rope *rope, size_t property, double step, const double *u,
                         double *size)
{
    static const double weight[] = {0, 3.0 / 4, -3.0 / 20, 1.0 / 60};
    double sum = 0;
    for (int k = -3; k <= 3; k++) {
        if (k == 0)
            continue;
        move(rope, property, k * step);
        sum += (k < 0 ? -1 : 1) * weight[abs(k)] * form(&rope->chain, u, size);
        move(rope, property, -k * step);
    }
    return sum / step;
}

/* -dPi/d(lambda p) is a slope of its own: dPi/dp = -lambda times it */
static double factor_of(size_t property)
{
    return property >= RD_OF_INERTIA ? -LAMBDA : 1;
}

static enum rd_status stretch_of(struct mode *asked, size_t k, double *slope, double *jump)
{
    cv slopes[RD_PROPERTIES], jumps[W];
    const enum rd_status status =
        rd_sensitivity_stretch(&asked->sensitivity, k, &MODE_PAIR, slopes, jumps, NULL);
    for (size_t p = 0; p < RD_PROPERTIES; p++)
        slope[p] = slopes[p].re[0];
    for (size_t i = 0; i < asked->sensitivity.chain->width; i++)
        jump[i] = jumps[i].re[0];
    return status;
}

/* the hinge opens in coordinate e */
static void hinged_slopes_are_those_of_the_form(enum rd_kind kind, const char *names,
                                                double tension, double compliance, size_t e)
{
    const struct recipe recipe = recipe_of(kind, names, tension);
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    double hinge[4 * W] = {0}, u[N], slope[RD_PROPERTIES], jump[W];
    hinge[LEFT_END * w + e] = compliance;
    rope.chain.hinge = compliance != 0 ? hinge : NULL;
    for (size_t i = 0; i < 2 * w; i++)
        u[i] = check_random();
    struct mode *asked = mode_ask(&rope.chain, LAMBDA, u);
    CHECK_INT(stretch_of(asked, 0, slope, jump), RD_OK);
    mode_forget(asked);
    for (size_t property = 0; property < RD_PROPERTIES; property++) {
        const double scale = scale_of(&rope, property);
        if (scale == 0) {
            CHECK_EXACT(slope[property], 0);
            continue;
        }
        double size;
        const double expected = difference(&rope, property, STEP * scale, u, &size);
        CHECK_ABS(factor_of(property) * slope[property], expected, ALLOWED * size / scale,
                  "truncation and rounding of the difference");
    }
    rope_free(&rope);
}

static void slopes_are_those_of_the_form(enum rd_kind kind, const char *names, double tension,
                                         double compliance)
{
    hinged_slopes_are_those_of_the_form(kind, names, tension, compliance, strlen(names) - 1);
}

/* d Pi/d(1/C) = jump^2, by the form at neighbouring compliances */
static void jump_is_the_slope_of_the_hinge(enum rd_kind kind)
{
    const struct recipe recipe = recipe_of(kind, "zab", 30);
    struct rope rope = rope_make(&recipe);
    static const double weight[] = {0, 3.0 / 4, -3.0 / 20, 1.0 / 60};
    const double stiffness = 25, u[6] = {0.3, -0.2, 0.7, -0.4, 0.9, 0.1};
    double hinge[4 * 3] = {0}, slope[RD_PROPERTIES], jump[3], expected = 0, size = 0;
    rope.chain.hinge = hinge;
    for (int k = -3; k <= 3; k++) {
        hinge[LEFT_END * 3 + 2] = 1 / (stiffness * (1 + k * STEP));
        expected += (k < 0 ? -1 : 1) * weight[abs(k)] * form(&rope.chain, u, &size);
    }
    expected /= stiffness * STEP;
    hinge[LEFT_END * 3 + 2] = 1 / stiffness;
    struct mode *asked = mode_ask(&rope.chain, LAMBDA, u);
    CHECK_INT(stretch_of(asked, 0, slope, jump), RD_OK);
    mode_forget(asked);
    CHECK_ABS(jump[2], expected, ALLOWED * size / stiffness, "as above");
    CHECK_EXACT(jump[0], 0);
    CHECK_EXACT(jump[1], 0);
    rope_free(&rope);
}

/* Two equal stretches have the slopes of one with both elements: a continuous element is kept. */
static void stretches_add_up(enum rd_kind kind)
{
    struct recipe recipe = recipe_of(kind, "zb", 30);
    recipe.elements = 4;
    struct rope rope = rope_make(&recipe);
    rope.term_of[2] = MORE;
    rope_gather(&rope);
    CHECK_INT(rope.chain.stretches, 5);
    double u[5 * 2], slope[4][RD_PROPERTIES], all[RD_PROPERTIES] = {0}, jump[2],
                                              whole[RD_PROPERTIES];
    for (size_t i = 0; i < 10; i++)
        u[i] = check_random();
    struct mode *asked = mode_ask(&rope.chain, LAMBDA, u);
    for (size_t k = 0; k < 4; k++) {
        CHECK_INT(stretch_of(asked, k, slope[k], jump), RD_OK);
        for (size_t p = 0; p < RD_PROPERTIES; p++)
            all[p] += slope[k][p];
    }
    mode_forget(asked);
    rope.term_of[0] = rope.term_of[1] = rope.term_of[2] = rope.term_of[3] = INNER;
    rope_gather(&rope);
    CHECK_INT(rope.chain.stretches, 2);
    asked = mode_ask(&rope.chain, LAMBDA, u);
    CHECK_INT(stretch_of(asked, 0, whole, jump), RD_OK);
    for (size_t p = 0; p < RD_PROPERTIES; p++)
        CHECK_REL(whole[p], all[p], 4 * EPS, "sums in another order");
    double expected = 0;
    cv dyad[4];
    rd_sensitivity_nodes(&asked->sensitivity, 0, &MODE_PAIR, dyad);
    /* inside a span nothing stands */
    for (size_t i = 0; i < 4 && kind != RD_CONTINUOUS; i++)
        expected += u[2 * i] * u[2 * i + 1];
    CHECK_EXACT(dyad[1].re[0], expected);
    CHECK_EXACT(dyad[2].re[0], expected);
    mode_forget(asked);
    rope_free(&rope);
}

/* f_b = G^-1 (u_b - F u_a) of the one element */
static void force_at_the_right(const struct rd_chain *chain, const double *u, double *f)
{
    const size_t w = chain->width;
    double K[N * N];
    continuous_matrix(chain, K);
    for (size_t i = 0; i < w; i++) {
        f[i] = 0;
        for (size_t j = 0; j < 2 * w; j++)
            f[i] += K[(w + i) * 2 * w + j] * u[j];
    }
}

/* The force on the right end told, an element has the slopes that it has by the motion of its ends. */
static void waves_have_the_slopes_of_motion(const char *names, double tension, double compliance)
{
    const struct recipe recipe = recipe_of(RD_CONTINUOUS, names, tension);
    struct rope rope = rope_make(&recipe);
    const size_t w = rope.chain.width;
    double hinge[4 * W] = {0}, u[N], told[2 * N] = {0}, opened[N];
    double slope[RD_PROPERTIES], jump[W], other[RD_PROPERTIES], jumps[W];
    hinge[LEFT_END * w + w - 1] = compliance;
    rope.chain.hinge = compliance != 0 ? hinge : NULL;
    for (size_t i = 0; i < 2 * w; i++)
        opened[i] = u[i] = check_random();
    struct mode *asked = mode_ask(&rope.chain, LAMBDA, u);
    CHECK_INT(stretch_of(asked, 0, slope, jump), RD_OK);
    opened[w - 1] += asked->sensitivity.moved->opens[w - 1].re[0];
    memcpy(told, u, w * sizeof *u);
    memcpy(told + 2 * w, u + w, w * sizeof *u);
    force_at_the_right(&rope.chain, opened, told + 3 * w);
    asked->fields.value = told;
    asked->fields.forces = true;
    rd_sensitivity_begin(&asked->sensitivity, &asked->lines);
    CHECK_INT(stretch_of(asked, 0, other, jumps), RD_OK);
    for (size_t p = 0; p < RD_PROPERTIES; p++)
        CHECK_ABS(other[p], slope[p], 1e-11 * fabs(slope[p]), "condition of the element");
    CHECK_ABS(jumps[w - 1], jump[w - 1], 1e-11 * jump[w - 1], "condition of the element");
    mode_forget(asked);
    rope_free(&rope);
}

static void impossible_elements_are_refused(void)
{
    const struct recipe recipe = recipe_of(RD_TENSED, "zb", 30);
    struct rope rope = rope_make(&recipe);
    static const double u[4] = {0};
    double slope[RD_PROPERTIES], jump[2];
    rope.flexibility[8] = -1;
    struct mode *asked = mode_ask(&rope.chain, LAMBDA, u);
    CHECK_INT(stretch_of(asked, 0, slope, jump), RD_NOT_POSITIVE_DEFINITE);
    mode_forget(asked);
    rope_free(&rope);
    struct recipe wave = recipe_of(RD_CONTINUOUS, "z", 30);
    wave.length = 6; /* beyond a quarter of a wave */
    rope = rope_make(&wave);
    asked = mode_ask(&rope.chain, LAMBDA / 1e2, u);
    CHECK_INT(stretch_of(asked, 0, slope, jump), RD_INDEFINITE_ELEMENT);
    mode_forget(asked);
    rope_free(&rope);
}

int main(void)
{
    /* T S_bb l^2 = 0, 0.5, 830, -1.7, and -3.3 and -12, beyond its critical load as a cantilever */
    static const double tension[] = {0, 30, 5e4, -100, -200, -700};
    for (size_t k = 0; k < sizeof tension / sizeof *tension; k++) {
        slopes_are_those_of_the_form(RD_TENSED, "zb", tension[k], 0);
        slopes_are_those_of_the_form(RD_TENSED, "xzab", tension[k], 0);
        slopes_are_those_of_the_form(RD_TENSED, "zab", tension[k], 0.04);
        slopes_are_those_of_the_form(RD_RIGID, "xzab", tension[k], INFINITY);
    }
    slopes_are_those_of_the_form(RD_RIGID, "zab", 30, 0.04);
    /* an element may come off its node in each coordinate */
    for (size_t e = 0; e < 4; e++) {
        hinged_slopes_are_those_of_the_form(RD_TENSED, "xzab", 30, 0.01, e);
        hinged_slopes_are_those_of_the_form(RD_RIGID, "xzab", 30, INFINITY, e);
    }
    slopes_are_those_of_the_form(RD_DIFFERENCE, "xzab", 0, 0);
    slopes_are_those_of_the_form(RD_TENSED, "xza", 30, 0);
    for (size_t k = 0; k < 4; k++) {
        slopes_are_those_of_the_form(RD_CONTINUOUS, "zb", tension[k], 0);
        slopes_are_those_of_the_form(RD_CONTINUOUS, "xzab", tension[k], 0.04);
        slopes_are_those_of_the_form(RD_CONTINUOUS, "zb", tension[k], INFINITY);
    }
    slopes_are_those_of_the_form(RD_CONTINUOUS, "xza", 600, 0);
    for (size_t k = 0; k < 4; k++) {
        waves_have_the_slopes_of_motion("zb", tension[k], 0);
        waves_have_the_slopes_of_motion("zb", tension[k], INFINITY);
        waves_have_the_slopes_of_motion("xzab", tension[k], 0.04);
    }
    waves_have_the_slopes_of_motion("z", 600, 0);
    jump_is_the_slope_of_the_hinge(RD_TENSED);
    jump_is_the_slope_of_the_hinge(RD_CONTINUOUS);
    stretches_add_up(RD_TENSED);
    stretches_add_up(RD_CONTINUOUS);
    impossible_elements_are_refused();
    return check_report("test_sensitivity");
}
