/* An oscillator whose stiffness changes with its motion keeps its energy; friction holds it. */
#include "volterra/modal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { STEPS = 1000 };

struct oscillator {
    double change[4], push[2], row[1], form[1], tension[STEPS], known[STEPS + 1];
    double state[2 * (STEPS + 1)], pushed[STEPS + 1], force[STEPS + 1], largest[1], size[1];
    struct rd_modal system;
    struct rd_modal_run run;
};

/* q'' + q = F from q = 1, at rest, in steps of h */
static void begin(struct oscillator *one, double h, size_t laws, const int32_t *kind,
                  const double *value)
{
    memset(one, 0, sizeof *one);
    const double change[4] = {cos(h), sin(h), -sin(h), cos(h)};
    memcpy(one->change, change, sizeof change);
    one->push[0] = 1 - cos(h);
    one->push[1] = sin(h);
    one->row[0] = one->form[0] = one->state[0] = 1;
    one->system = (struct rd_modal){.laws = {{.count = laws}, kind, value},
                                    .modes = 1,
                                    .steps = STEPS,
                                    .h = h,
                                    .change = one->change,
                                    .push = one->push,
                                    .row = one->row,
                                    .form = one->form,
                                    .tension = one->tension,
                                    .known = one->known};
    one->run = (struct rd_modal_run){.state = one->state,
                                     .pushed = one->pushed,
                                     .force = one->force,
                                     .largest = one->largest,
                                     .size = one->size};
}

static enum rd_status go(struct oscillator *one)
{
    struct rd_workspace workspace = {0};
    struct rd_modal_work work;
    rd_modal_work(&one->system, &workspace, &work);
    workspace = (struct rd_workspace){malloc(workspace.used), workspace.used, 0};
    rd_modal_work(&one->system, &workspace, &work);
    const enum rd_status status = rd_modal_run(&one->system, &work, &one->run);
    free(workspace.base);
    return status;
}

static double energy(const struct oscillator *one, size_t n, double stretching)
{
    const double q = one->state[2 * n], v = one->state[2 * n + 1];
    return (v * v + q * q) / 2 + stretching / 8 * q * q * q * q;
}

static void stretching_keeps_energy(void)
{
    struct oscillator *one = malloc(sizeof *one);
    begin(one, 0.1, 0, NULL, NULL);
    one->system.stretching = 6;
    CHECK(go(one) == RD_OK);
    for (size_t n = 1; n <= STEPS; n++)
        CHECK_REL(energy(one, n, 6), energy(one, 0, 6), 1e-12, "rounding of 1000 steps");
    free(one);
}

/* q'' + (1 + t) q = 0 turns as a mean force of the step lets it, of second order */
static void tension_turns_faster(void)
{
    double apart[2];
    struct oscillator *one = malloc(sizeof *one);
    for (int k = 0; k < 2; k++) {
        const double h = k ? 0.005 : 0.01;
        begin(one, h, 0, NULL, NULL);
        for (size_t n = 0; n < STEPS; n++)
            one->tension[n] = 3;
        CHECK(go(one) == RD_OK);
        const size_t n = k ? STEPS : STEPS / 2;
        apart[k] = fabs(one->state[2 * n] - cos(2 * h * (double)n));
    }
    CHECK_REL(apart[0] / apart[1], 4, 1e-2, "the next order is h^2 smaller");
    free(one);
}

static void friction_takes_the_same_each_half_period_and_holds(void)
{
    const int32_t kind[] = {RD_POWER};
    const double value[RD_LAW_VALUES] = {0.13, 0};
    struct oscillator *one = malloc(sizeof *one);
    begin(one, acos(-1.0) / 50, 1, kind, value);
    CHECK(go(one) == RD_OK);
    const double left[] = {1, 0.74, 0.48, 0.22, 0.04, 0.04, 0.04};
    for (size_t half = 1; half <= 6; half++)
        CHECK_REL(fabs(one->state[100 * half]), left[half], 1e-12, "turns are at ends of steps");
    CHECK_REL(one->state[2 * STEPS], one->state[600], 1e-13, "it holds");
    free(one);
}

static void compression_beyond_a_step_is_said(void)
{
    struct oscillator *one = malloc(sizeof *one);
    begin(one, 1.0, 0, NULL, NULL);
    one->tension[0] = -1e3;
    CHECK(go(one) == RD_NO_CONVERGENCE);
    CHECK(one->run.made == 0);
    free(one);
}

int main(void)
{
    stretching_keeps_energy();
    tension_turns_faster();
    friction_takes_the_same_each_half_period_and_holds();
    compression_beyond_a_step_is_said();
    return check_report("test_modal_steps");
}
