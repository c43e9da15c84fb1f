/* Two free masses of 1 under laws: their motion under a drag, a spring and none is known. */
#include "collocation/collocation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { STAGES = 3, MASSES = 2, MOST_STEPS = 64, ALL = STAGES * MASSES };

/* of Radau's method of fifth order */
static double node_of(size_t i)
{
    const double node[STAGES] = {(4 - sqrt(6)) / 10, (4 + sqrt(6)) / 10, 1};
    return node[i];
}

static double lagrange(size_t j, double t)
{
    double value = 1;
    for (size_t k = 0; k < STAGES; k++)
        value *= k == j ? 1 : (t - node_of(k)) / (node_of(j) - node_of(k));
    return value;
}

/* integral of L_j, or of (t - x) L_j, from 0 to t */
static double integral(size_t j, double t, bool once_more)
{
    const double at = sqrt(0.6) / 2, place[3] = {0.5 - at, 0.5, 0.5 + at};
    const double weight[3] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
    double sum = 0;
    for (size_t k = 0; k < 3; k++) {
        const double x = t * place[k];
        sum += t * weight[k] * (once_more ? t - x : 1) * lagrange(j, x);
    }
    return sum;
}

struct masses {
    double node[STAGES], change[4 * MASSES], push[STAGES * 2 * MASSES];
    double seen[MASSES * 2 * MASSES * STAGES * 2 * MASSES];
    double own[STAGES * 2 * MASSES * ALL], ahead[STAGES * STAGES];
    double begin[MOST_STEPS], known[MOST_STEPS * 2 * ALL], force[(MOST_STEPS + 1) * ALL];
    double state[(MOST_STEPS + 1) * MASSES * 2 * MASSES], motion[MOST_STEPS * 2 * ALL];
    double size[3 * MASSES];
    struct rd_collocation step;
    struct rd_collocated run;
};

/* each mass is a mode that its own law alone sees; both begin at 0 with velocity 1 */
static void begin(struct masses *m, size_t steps, double h)
{
    memset(m, 0, sizeof *m);
    for (size_t d = 0; d < MASSES; d++) {
        m->change[d] = m->change[3 * MASSES + d] = 1;
        m->change[MASSES + d] = h;
    }
    for (size_t i = 0; i < STAGES; i++) {
        const double t = node_of(i);
        m->node[i] = t;
        for (size_t j = 0; j < STAGES; j++) {
            m->ahead[i * STAGES + j] = lagrange(j, 1 + t);
            for (size_t d = 0; d < MASSES; d++) {
                double *row = m->own + 2 * i * MASSES * ALL + d * ALL + j * MASSES + d;
                row[0] = h * h * integral(j, t, true);
                row[MASSES * ALL] = h * integral(j, t, false);
            }
        }
        for (size_t d = 0; d < MASSES; d++) {
            m->push[2 * i * MASSES + d] = h * h * integral(i, 1, true);
            m->push[(2 * i + 1) * MASSES + d] = h * integral(i, 1, false);
            double *of_q = m->seen + ((2 * d) * MASSES + d) * 2 * ALL + 2 * i * MASSES + d;
            double *of_v = m->seen + ((2 * d + 1) * MASSES + d) * 2 * ALL + 2 * i * MASSES + d;
            of_q[0] = of_v[MASSES] = 1;
            of_v[0] = h * t;
        }
    }
    for (size_t k = 0; k < steps; k++) {
        m->begin[k] = h * (double)k;
        for (size_t i = 0; i < STAGES; i++)
            for (size_t d = 0; d < MASSES; d++) {
                double *known = m->known + (k * 2 * STAGES + 2 * i) * MASSES + d;
                known[0] = h * ((double)k + node_of(i));
                known[MASSES] = 1;
            }
    }
    m->step = (struct rd_collocation){.stages = STAGES,
                                      .laws = MASSES,
                                      .modes = MASSES,
                                      .h = h,
                                      .node = m->node,
                                      .change = m->change,
                                      .push = m->push,
                                      .seen = m->seen,
                                      .own = m->own,
                                      .ahead = m->ahead};
    m->run = (struct rd_collocated){.steps = steps,
                                    .begin = m->begin,
                                    .known = m->known,
                                    .force = m->force,
                                    .state = m->state,
                                    .motion = m->motion,
                                    .size = m->size};
}

static enum rd_status go(struct masses *m, const struct rd_smooth_laws *laws)
{
    struct rd_workspace workspace = {0};
    struct rd_collocation_work work;
    rd_collocation_work(&m->step, &workspace, &work);
    workspace = (struct rd_workspace){malloc(workspace.used), workspace.used, 0};
    rd_collocation_work(&m->step, &workspace, &work);
    const enum rd_status status = rd_collocation_run(&m->step, laws, &work, &m->run);
    free(workspace.base);
    return status;
}

/* u, or v, of a mass at the end of the last step */
static double last(const struct masses *m, size_t mass, bool rate)
{
    const size_t stage = (m->run.made - 1) * STAGES + STAGES - 1;
    return m->motion[(2 * stage + rate) * MASSES + mass];
}

/* what the caller says of the second mass, and after how many calls it fails or says nonsense */
struct said {
    int calls, fails, breaks;
};

static bool spring(void *context, size_t law, size_t count, const double *t, const double *u,
                   const double *v, double *force)
{
    struct said *said = context;
    (void)v;
    CHECK(law == 1 && t[0] >= 0);
    said->calls++;
    for (size_t k = 0; k < count; k++)
        force[k] = said->breaks && said->calls > said->breaks ? (double)NAN : -4 * u[k];
    return !said->fails || said->calls <= said->fails;
}

static const int32_t KIND[MASSES] = {RD_SMOOTH_POWER, RD_SMOOTH_CALL};
static const double VALUE[2 * MASSES] = {3, 2};

/* -3 v |v|: u = ln(1 + 3 t)/3; -4 u: u = sin(2 t)/2; until 1 s */
static void off(size_t steps, double error[MASSES])
{
    struct masses m;
    struct said said = {0};
    const struct rd_smooth_laws laws = {MASSES, KIND, VALUE, spring, &said};
    begin(&m, steps, 1 / (double)steps);
    CHECK(go(&m, &laws) == RD_OK);
    CHECK(m.run.made == steps);
    CHECK(m.run.iterations < 8 * steps);
    error[0] = fabs(last(&m, 0, false) - log(4) / 3);
    error[1] = fabs(last(&m, 1, false) - sin(2) / 2);
    CHECK_ABS(last(&m, 0, true), 0.25, 1e-3, "Radau's method, five steps at least");
    CHECK_ABS(last(&m, 1, true), cos(2), 1e-3, "Radau's method, five steps at least");
    CHECK_REL(m.size[0], last(&m, 0, false), 0, "it moves on and on");
    CHECK(m.size[2 * MASSES] > 0 && m.size[2 * MASSES] <= 3);
}

static void it_is_of_fifth_order(void)
{
    double coarse[MASSES], fine[MASSES];
    off(8, coarse);
    off(16, fine);
    for (size_t d = 0; d < MASSES; d++) {
        CHECK(coarse[d] < 1e-4);
        CHECK(coarse[d] / fine[d] > 20 && coarse[d] / fine[d] < 80);
    }
}

static void what_fails_ends_the_run_before_its_step(void)
{
    struct masses m;
    struct said said = {.fails = 20};
    const struct rd_smooth_laws laws = {MASSES, KIND, VALUE, spring, &said};
    begin(&m, 32, 1 / 32.0);
    CHECK(go(&m, &laws) == RD_INTERRUPTED);
    CHECK(m.run.made > 0 && m.run.made < 32);
    said = (struct said){.fails = 0, .breaks = 20};
    begin(&m, 32, 1 / 32.0);
    CHECK(go(&m, &laws) == RD_NO_CONVERGENCE);
    CHECK(m.run.made > 0 && m.run.made < 32);
}

/* the masses stand still where nothing begins to move */
static void rest_is_kept(void)
{
    struct masses m;
    struct said said = {0};
    const struct rd_smooth_laws laws = {MASSES, KIND, VALUE, spring, &said};
    begin(&m, 4, 0.25);
    memset(m.known, 0, sizeof m.known);
    CHECK(go(&m, &laws) == RD_OK);
    for (size_t d = 0; d < MASSES; d++)
        CHECK(last(&m, d, false) == 0 && last(&m, d, true) == 0);
}

int main(void)
{
    it_is_of_fifth_order();
    what_fails_ends_the_run_before_its_step();
    rest_is_kept();
    return check_report("test_collocation");
}
