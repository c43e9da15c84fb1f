/* A free mass of 1 under laws: its step response t^2/2 and what it does are known. */
#include "volterra/volterra.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { STEPS = 400 };

struct mass {
    double kernel[STEPS], linear[STEPS + 1], force[STEPS], motion[STEPS + 1], size[1];
    struct rd_volterra system;
    struct rd_volterra_run run;
};

/* it begins at 0 with velocity v */
static void begin(struct mass *mass, double h, double v, const int32_t *kind, const double *value)
{
    memset(mass, 0, sizeof *mass);
    for (size_t k = 0; k < STEPS; k++) /* the last is ((k + 1)^2 - k^2) h^2/2 of k = 0 */
        mass->kernel[STEPS - 1 - k] = (2 * (double)k + 1) * h * h / 2;
    for (size_t n = 0; n <= STEPS; n++)
        mass->linear[n] = v * h * (double)n;
    mass->system = (struct rd_volterra){.laws = {{.count = 1}, kind, value},
                                        .steps = STEPS,
                                        .h = h,
                                        .kernel = mass->kernel,
                                        .linear = mass->linear};
    mass->run =
        (struct rd_volterra_run){.force = mass->force, .motion = mass->motion, .size = mass->size};
}

static enum rd_status go(struct mass *mass, size_t until)
{
    struct rd_workspace workspace = {0};
    struct rd_law_step work;
    rd_law_step_work(1, &workspace, &work);
    workspace = (struct rd_workspace){malloc(workspace.used), workspace.used, 0};
    rd_law_step_work(1, &workspace, &work);
    const enum rd_status status = rd_volterra_run(&mass->system, until, &work, &mass->run);
    free(workspace.base);
    return status;
}

/* v^2/(2 F) from where it began, by friction F, and not further */
static void friction_holds_without_creeping(void)
{
    const int32_t kind[] = {RD_POWER};
    const double value[RD_LAW_VALUES] = {2, 0};
    struct mass mass;
    begin(&mass, 1.0 / 64, 1, kind, value); /* it stops after 0.5 s = 32 steps */
    CHECK(go(&mass, STEPS / 2) == RD_OK);
    CHECK(go(&mass, STEPS) == RD_OK); /* goes on where it was */
    CHECK(mass.run.made == STEPS);
    CHECK_REL(mass.motion[32], 0.25, 100 * EPS, "sums of 32 terms");
    for (size_t n = 33; n <= STEPS; n++)
        CHECK_REL(mass.motion[n], 0.25, 2000 * EPS, "the linear motion is 25 times as far");
}

/* u'' = -k u beyond a gap: half a swing at omega = sqrt k, with the square of h */
static double off(double h, enum rd_status *status)
{
    const int32_t kind[] = {RD_STOP};
    const double value[RD_LAW_VALUES] = {100, 0, 1, 0};
    struct mass mass;
    begin(&mass, h, 1, kind, value);
    *status = go(&mass, STEPS);
    const size_t n = (size_t)lround(0.25 / h);
    return fabs(mass.motion[n] - sin(10 * 0.25) / 10);
}

static void a_stop_is_of_second_order(void)
{
    enum rd_status one, two;
    const double coarse = off(1.0 / 64, &one), fine = off(1.0 / 128, &two);
    CHECK(one == RD_OK && two == RD_OK);
    CHECK(coarse < 1e-3 && fine > 0);
    CHECK(coarse / fine > 3.6 && coarse / fine < 4.4);
}

/* what the caller says: c and the number of calls */
struct said {
    double c;
    int calls;
    bool fails;
};

static bool drag(void *context, size_t law, size_t count, const double *t, const double *u,
                 const double *v, double *force)
{
    (void)law, (void)t, (void)u;
    struct said *said = context;
    said->calls++;
    for (size_t k = 0; k < count; k++)
        force[k] = -said->c * v[k];
    return !said->fails;
}

/* the midpoint rule's (1 - c h/2)/(1 + c h/2) for each step, also for a drag that no fixed point finds */
static void a_called_law_is_solved(void)
{
    const int32_t kind[] = {RD_GIVEN};
    const double value[RD_LAW_VALUES] = {0}, h = 1.0 / 64;
    for (int k = 0; k < 2; k++) {
        struct mass mass;
        struct said said = {.c = k ? 1e3 : 2};
        begin(&mass, h, 1, kind, value);
        mass.system.call = drag;
        mass.system.context = &said;
        CHECK(go(&mass, STEPS) == RD_OK);
        const double ratio = (1 - said.c * h / 2) / (1 + said.c * h / 2);
        double u = 0, v = 1;
        for (size_t n = 0; n < 40; n++) {
            u += h * (1 + ratio) / 2 * v;
            v *= ratio;
            CHECK_ABS(mass.motion[n + 1], u, 1e-10, "forces hold to 1e-12 of the largest");
        }
        CHECK(said.calls < 6 * STEPS);
        said.fails = true;
        mass.run.made = 0;
        CHECK(go(&mass, STEPS) == RD_INTERRUPTED);
        CHECK(mass.run.made == 0);
    }
}

int main(void)
{
    friction_holds_without_creeping();
    a_stop_is_of_second_order();
    a_called_law_is_solved();
    return check_report("test_volterra");
}
