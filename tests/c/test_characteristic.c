/* The characteristic function against closed forms. */
#include "base/complex.h"
#include "chains.h"
#include "check.h"
#include "sweep/characteristic.h"

#include <string.h>

enum { POINTS = 11 }; /* more than one block of lanes */

static const double PI = 3.14159265358979323846;

struct answer {
    double complex value[POINTS];
    double magnitude[POINTS];
    size_t steps;
};

/* undamped but for dashpots, |s| < reach, in memory of exactly its size less so many bytes */
static enum rd_status ask_less(const struct rd_chain *chain, const double complex *s, size_t count,
                               double reach, size_t less, struct answer *answer)
{
    double one[2 * POINTS] = {0}, inertia[2 * POINTS], dashpot[2 * POINTS];
    for (size_t i = 0; i < count; i++) {
        one[2 * i] = 1;
        memcpy(inertia + 2 * i, &(double complex){s[i] * s[i]}, sizeof *s);
        memcpy(dashpot + 2 * i, s + i, sizeof *s);
    }
    const double square[2] = {reach * reach, 0}, line[2] = {reach, 0};
    const struct rd_factors bound = {1, one, one, one, square, line, NULL};
    struct rd_workspace space = {0};
    CHECK(rd_characteristic_take(chain, &bound, &space) == NULL);
    space = exact_workspace(space.used - less);
    struct rd_characteristic *of = rd_characteristic_take(chain, &bound, &space);
    enum rd_status status = of ? RD_OK : RD_NO_MEMORY;
    for (size_t i = 0; i < count && status == RD_OK; i += RD_LANES) {
        const size_t some = count - i < RD_LANES ? count - i : RD_LANES;
        const struct rd_factors factors = {some, one, one, one, inertia + 2 * i, dashpot + 2 * i,
                                           NULL};
        status = rd_characteristic_at(of, &factors, (double *)(answer->value + i),
                                      answer->magnitude + i);
        answer->steps = rd_characteristic_steps(of);
    }
    free(space.base);
    return status;
}

static void ask(const struct rd_chain *chain, const double complex *s, size_t count, double reach,
                struct answer *answer)
{
    CHECK_INT(ask_less(chain, s, count, reach, 0, answer), RD_OK);
}

/* points within |s| < reach, away from both axes, and one on each */
static void scatter(double reach, double complex *s)
{
    for (size_t i = 0; i < POINTS; i++)
        s[i] = reach * (0.1 + 0.8 * (double)i / POINTS) * cexp(I * (0.3 + 0.5 * (double)i));
    s[0] = -0.37 * reach;
    s[1] = 0.53 * I * reach;
}

/* Delta over `exact` is one positive or negative number */
static void check_ratio(const struct answer *answer, const double complex *exact, double tolerance,
                        const char *reason)
{
    const double complex first = answer->value[0] / exact[0];
    for (size_t i = 0; i < POINTS; i++) {
        const double complex ratio =
            answer->value[i] / exact[i] * exp(answer->magnitude[i] - answer->magnitude[0]) / first;
        CHECK_REL(creal(ratio), 1, tolerance, reason);
        CHECK_ABS(cimag(ratio), 0, tolerance, reason);
        CHECK(cabs(answer->value[i]) <= 1 + 4 * EPS);
    }
    CHECK_ABS(cimag(answer->value[0]), 0, 4 * EPS, "real on the real axis");
}

/* n elements of a string, not enough for a run, a dashpot c at the free right end. With
   cosh theta = 1 + m s^2 l/2T and half a mass at the end

       Delta ~ (T/l) sinh theta cosh(n theta)/sinh theta + c s sinh(n theta)/sinh theta  */
static void test_string_of_masses_before_a_dashpot(void)
{
    enum { N = 6 };
    const double T = 300, m = 0.02, l = 0.1, c = 1.7, reach = 1.6 * sqrt(T / (m * l));
    struct rope rope = rope_make(&(struct recipe){.kind = RD_RIGID,
                                                  .elements = N,
                                                  .coordinates = "z",
                                                  .length = l,
                                                  .tension = T,
                                                  .inertia = {[RD_Z] = m},
                                                  .left = "z",
                                                  .right = ""});
    double damping[MORE] = {[RIGHT_END] = c};
    rope.chain.damping = damping;
    double complex s[POINTS], exact[POINTS];
    scatter(reach, s);
    for (size_t i = 0; i < POINTS; i++) {
        const double complex theta = cacosh(1 + m * s[i] * s[i] * l / (2 * T));
        exact[i] = T / l * csinh(theta) * ccosh(N * theta) + c * s[i] * csinh(N * theta);
        exact[i] /= csinh(theta);
    }
    struct answer answer;
    ask(&rope.chain, s, POINTS, reach, &answer);
    CHECK_INT(answer.steps, N);
    check_ratio(&answer, exact, 1e-12, "the closed form's own arguments");
    CHECK_INT(ask_less(&rope.chain, s, POINTS, reach, 1, &answer), RD_NO_MEMORY);
    rope_free(&rope);
}

/* A continuous string held at both ends, Delta cosh^n(s l/c n) ~ sinh(s l/c)/s over n pieces: what
   each piece takes out is that of its own cantilever. */
static void test_continuous_string(void)
{
    const double T = 300, mu = 0.2, l = 1.5, wave = sqrt(T / mu);
    struct rope rope = rope_make(&(struct recipe){.kind = RD_CONTINUOUS,
                                                  .elements = 1,
                                                  .coordinates = "z",
                                                  .length = l,
                                                  .tension = T,
                                                  .inertia = {[RD_Z] = mu},
                                                  .left = "z",
                                                  .right = "z"});
    double complex s[POINTS], exact[POINTS];
    const double reach = 9.5 * PI * wave / l;
    scatter(reach, s);
    struct answer answer;
    ask(&rope.chain, s, POINTS, reach, &answer);
    for (size_t i = 0; i < POINTS; i++) {
        const double complex x = s[i] * l / wave;
        const double n = (double)answer.steps;
        exact[i] = csinh(x) / x * cpow(1 / ccosh(x / n), n);
    }
    check_ratio(&answer, exact, 1e-12, "the closed form's own arguments, up to 30");
    for (size_t k = 0; k < 9; k++)
        s[k] = I * PI * (double)(k + 1) * wave / l;
    ask(&rope.chain, s, 9, reach, &answer);
    for (size_t k = 0; k < 9; k++)
        CHECK_ABS(cabs(answer.value[k]), 0, 100 * EPS, "eps sqrt(steps) and that of s l/c, 28");
    rope_free(&rope);
}

/* A clamp with a free hinge, or a pin: one positive number apart, whatever s. */
static void test_free_hinges_at_clamps_are_pins(enum rd_kind kind)
{
    struct recipe recipe = {.kind = kind,
                            .elements = 20,
                            .coordinates = "zb",
                            .length = 0.05,
                            .tension = 50,
                            .section = {.bending = 2},
                            .inertia = {[RD_Z] = 0.1},
                            .left = "zb",
                            .right = "zb"};
    struct rope clamped = rope_make(&recipe);
    recipe.left = recipe.right = "z";
    struct rope pinned = rope_make(&recipe);
    /* a hinge is on the right of its node: the right end is pinned in both */
    double hinge[2 * MORE] = {[2 * LEFT_END + 1] = INFINITY};
    clamped.chain.hinge = hinge;
    clamped.held[2 * RIGHT_END + 1] = 0;
    rope_gather(&clamped);
    rope_gather(&pinned);
    double complex s[POINTS], exact[POINTS];
    scatter(300, s);
    struct answer a, b;
    ask(&clamped.chain, s, POINTS, 300, &a);
    ask(&pinned.chain, s, POINTS, 300, &b);
    for (size_t i = 0; i < POINTS; i++)
        exact[i] = b.value[i] * exp(b.magnitude[i] - b.magnitude[0]);
    check_ratio(&a, exact, 1e-12, "two walks of 20 steps");
    rope_free(&clamped);
    rope_free(&pinned);
}

/* Two rigid elements under so much compression that they are struts, z and beta of the middle node
   free, have Delta ~ det(K + s^2 M),

       K = 2 (k_zz, 0; 0, k_bb),  k_zz = 12 B/l^3 + T/l,  k_bb = 4 B/l  */
static void test_struts(void)
{
    const double B = 2, l = 0.5, T = -30, m = 0.3, j = 0.02, reach = 40;
    struct rope rope = rope_make(&(struct recipe){.kind = RD_RIGID,
                                                  .elements = 2,
                                                  .coordinates = "zb",
                                                  .length = l,
                                                  .tension = T,
                                                  .section = {.bending = B},
                                                  .inertia = {[RD_Z] = m, [RD_BETA] = j},
                                                  .left = "zb",
                                                  .right = "zb"});
    double complex s[POINTS], exact[POINTS];
    scatter(reach, s);
    struct answer answer;
    ask(&rope.chain, s, POINTS, reach, &answer);
    for (size_t i = 0; i < POINTS; i++)
        exact[i] = (2 * (12 * B / (l * l * l) + T / l) + m * s[i] * s[i]) *
                   (2 * 4 * B / l + j * s[i] * s[i]);
    check_ratio(&answer, exact, 1e-12, "a dozen operations, 10 where z nearly buckles");
    rope_free(&rope);
}

/* what overflows in pieces is refused */
static void test_waves_too_short(void)
{
    struct rope rope = rope_make(&(struct recipe){.kind = RD_CONTINUOUS,
                                                  .elements = 1,
                                                  .coordinates = "z",
                                                  .length = 1,
                                                  .tension = 1,
                                                  .inertia = {[RD_Z] = 1},
                                                  .left = "z",
                                                  .right = "z"});
    const double complex s = I;
    struct answer answer;
    CHECK_INT(ask_less(&rope.chain, &s, 1, 1e9, 0, &answer), RD_SHORT_WAVES);
    rope_free(&rope);
}

int main(void)
{
    test_string_of_masses_before_a_dashpot();
    test_continuous_string();
    test_free_hinges_at_clamps_are_pins(RD_RIGID);
    test_free_hinges_at_clamps_are_pins(RD_CONTINUOUS);
    test_struts();
    test_waves_too_short();
    return check_report("characteristic");
}
