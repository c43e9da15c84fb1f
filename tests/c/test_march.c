/* Implicit time steps against closed forms. */
#include "march/run.h"

#include "chains.h"
#include "check.h"

#include <string.h>

static const double B = 2.5, L = 1.2;

/* midpoint steps, and those that forget fast motion at once */
static const double MIDPOINT = 0.25;
static const double DAMPED = 0.29289321881345254;

/* a march in memory of exactly its size, its state and what acts on it */
struct run {
    struct rope rope;
    struct rd_beside beside;
    struct rd_laws laws;
    struct rd_workspace workspace;
    struct rd_march march;
    struct rd_motion motion;
    double *zero; /* (distinct) */
};

static enum rd_status open_run(struct run *run, double theta)
{
    const struct rd_chain *chain = &run->rope.chain;
    struct rd_workspace measured = {0};
    run->zero = zeros(chain->distinct);
    if (run->beside.rate == NULL)
        run->beside.rate = run->zero;
    if (run->beside.string == NULL)
        run->beside.string = run->zero;
    if (run->beside.drag == NULL)
        run->beside.drag = run->zero;
    const enum rd_status unmeasured =
        rd_march_prepare(chain, &run->beside, &run->laws, &run->march, &measured);
    CHECK_INT(unmeasured, RD_NO_MEMORY);
    run->workspace = exact_workspace(measured.used);
    const size_t n = chain->nodes * chain->width;
    run->motion = (struct rd_motion){.u = zeros(n),
                                     .v = zeros(n),
                                     .f = zeros(n - chain->width),
                                     .y = zeros(chain->attached),
                                     .w = zeros(chain->attached)};
    const enum rd_status status =
        rd_march_prepare(chain, &run->beside, &run->laws, &run->march, &run->workspace);
    return status == RD_OK ? rd_march_factor(&run->march, theta, 0) : status;
}

static void close_run(struct run *run)
{
    free(run->motion.u);
    free(run->motion.v);
    free(run->motion.f);
    free(run->motion.y);
    free(run->motion.w);
    free(run->workspace.base);
    free(run->zero);
    rope_free(&run->rope);
}

/* what stands still where nothing is said */
static const struct rd_ports nowhere = {0};

/* steps->h is theta/g; the responses' answers and the state */
static enum rd_status go(struct run *run, const struct rd_push *push,
                         const struct rd_ports *responses, struct rd_steps *steps)
{
    enum rd_status status;
    steps->h = run->march.number->theta / steps->g;
    rd_march_load(&run->march, &run->motion);
    const size_t made =
        rd_march_run(&run->march, push, responses, steps, &(struct rd_stop){0}, &status);
    rd_march_unload(&run->march, &run->motion);
    CHECK((made == steps->count) == (status == RD_OK));
    return status;
}

static const struct recipe cantilever = {
    .kind = RD_RIGID,
    .elements = 8,
    .coordinates = "zb",
    .length = 0.15,
    .section = {.bending = 2.5},
    .inertia = {[RD_Z] = 0.02, [RD_BETA] = 1e-5},
    .left = "zb",
    .right = "",
    .more = 2,
};

/* long steps that forget: the tip of a cantilever at l^3/3B, l^2/2B under its load */
static void long_steps_end_at_rest(bool refined)
{
    struct run run = {.rope = rope_make(&cantilever)};
    rope_gather(&run.rope);
    CHECK_INT(open_run(&run, 1e4), RD_OK);
    const int32_t node[] = {7};
    const double row[] = {0, 0, 1, 0};
    const struct rd_ports tip = {.count = 1, .node = node, .row = row};
    enum { STEPS = 8 };
    double force[2 * STEPS], read[3 * STEPS];
    for (int i = 0; i < 2 * STEPS; i++)
        force[i] = 3;
    struct rd_steps steps = {
        .count = STEPS, .g = DAMPED, .force = force, .read = read, .refined = refined};
    const struct rd_push push = {.drives = &tip};
    CHECK_INT(go(&run, &push, &tip, &steps), RD_OK);
    static const char why[] = "eps times the growth of errors along eight elements";
    CHECK_REL(read[3 * (STEPS - 1)], 3 * L * L * L / (3 * B), 1e-12, why);
    CHECK_REL(run.motion.u[17], 3 * L * L / (2 * B), 1e-12, why);
    CHECK_REL(run.motion.f[14], 3, 1e-12, why);
    CHECK_REL(run.motion.f[1], 3 * L * 7 / 8, 1e-12, why);
    close_run(&run);
}

/* a rope that nothing holds keeps its momentum, and its energy at midpoint steps */
static void nothing_is_lost_by_a_free_rope(void)
{
    struct recipe recipe = cantilever;
    recipe.left = "";
    struct run run = {.rope = rope_make(&recipe)};
    rope_gather(&run.rope);
    CHECK_INT(open_run(&run, 1e-3), RD_OK);
    run.motion.v[4] = 1;
    run.motion.v[9] = 20;
    enum { STEPS = 100 };
    double energy[STEPS * RD_ENERGIES];
    struct rd_steps steps = {.count = STEPS, .g = MIDPOINT, .energy = energy, .refined = true};
    double read[1] = {0};
    steps.read = read;
    const struct rd_push push = {.drives = &nowhere};
    CHECK_INT(go(&run, &push, &nowhere, &steps), RD_OK);
    double momentum = 0;
    for (size_t i = 0; i < 9; i++)
        momentum += (i == 0 || i == 8 ? 0.01 : 0.02) * run.motion.v[2 * i];
    CHECK_REL(momentum, 0.02, 1e-12, "100 steps");
    const double given = (0.02 + 1e-5 * 400) / 2;
    for (int i = 0; i < STEPS; i++) {
        const double *now = energy + i * RD_ENERGIES;
        CHECK_REL(now[RD_KINETIC] + now[RD_STRAIN], given, 1e-13, "100 steps of rounding");
        CHECK_EXACT(now[RD_INPUT], 0);
        CHECK_EXACT(now[RD_DISSIPATED], 0);
    }
    close_run(&run);
}

/* beyond a clamp inside the rope nothing moves at all */
static void a_clamp_inside_divides_the_rope(void)
{
    struct run run = {.rope = rope_make(&cantilever)};
    run.rope.term_of[4] = MORE;
    run.rope.held[2 * MORE] = run.rope.held[2 * MORE + 1] = 1;
    rope_gather(&run.rope);
    CHECK_INT(open_run(&run, 1e-3), RD_OK);
    run.motion.v[4] = 1;
    double read[1] = {0};
    struct rd_steps steps = {.count = 30, .g = MIDPOINT, .read = read, .refined = true};
    const struct rd_push push = {.drives = &nowhere};
    CHECK_INT(go(&run, &push, &nowhere, &steps), RD_OK);
    for (size_t i = 8; i < 18; i++) {
        CHECK_ABS(run.motion.u[i], 0, 1e-18, "rounding of the motion left of it");
        CHECK_ABS(run.motion.v[i], 0, 1e-15, "rounding of the motion left of it");
    }
    CHECK(fabs(run.motion.u[4]) > 1e-6);
    close_run(&run);
}

/* on a very stiff spring a resonator is a mass at its foot, inside the rope and on its first node */
static void a_stiff_resonator_is_a_mass(size_t node, bool refined)
{
    struct recipe recipe = cantilever;
    recipe.left = node > 0 ? "zb" : "";
    recipe.right = node > 0 ? "" : "zb";
    const int32_t kind[] = {RD_RESONATOR}, term[] = {MORE};
    const double foot[] = {1, 0, 0, 1}, value[] = {0.05, 1e9, 2e10, 0};
    double last[2][18];
    for (int resonates = 0; resonates < 2; resonates++) {
        struct run run = {.rope = rope_make(&recipe)};
        run.rope.term_of[node] = MORE;
        run.rope.mass[4 * MORE] += resonates ? 0 : value[0];
        rope_gather(&run.rope);
        if (resonates) {
            run.rope.chain.attached = 1;
            run.rope.chain.attached_kind = kind;
            run.rope.chain.attached_term = term;
            run.rope.chain.attached_row = foot;
            run.rope.chain.attached_value = value;
        }
        CHECK_INT(open_run(&run, 1e-3), RD_OK);
        run.motion.v[4] = 1;
        double read[1] = {0};
        struct rd_steps steps = {.count = 30, .g = DAMPED, .read = read, .refined = refined};
        const struct rd_push push = {.drives = &nowhere};
        CHECK_INT(go(&run, &push, &nowhere, &steps), RD_OK);
        memcpy(last[resonates], run.motion.u, sizeof last[0]);
        if (resonates)
            CHECK_REL(run.motion.y[0], run.motion.u[2 * node], 1e-3,
                      "the spring gives way by m a/k");
        close_run(&run);
    }
    for (size_t i = 0; i < 18; i++)
        CHECK_ABS(last[1][i], last[0][i], 1e-3 * fabs(last[0][node > 0 ? 16 : 0]),
                  "m/(k theta^2) = 5e-5");
}

/* Everything at once, in memory of exactly its size; the same bits twice, and energy is kept. The
   `end` moves, a law stands on its element, a resonator on nodes of a term. */
static void the_same_steps_twice(int32_t end, int32_t law, int32_t carrier)
{
    struct recipe recipe = cantilever;
    recipe.left = end == 0 ? "zb" : "";
    recipe.right = end == 0 ? "" : "zb";
    const int32_t kind[] = {RD_RESONATOR}, term[] = {carrier};
    const double foot[] = {1, 0, 0, 1}, value[] = {0.05, 100, 2000, 0.1};
    const double rate[] = {1e-4}, string[] = {3}, drag[] = {0.01};
    const int32_t law_node[] = {law, 5, 7}, law_kind[] = {RD_POWER, RD_STOP, RD_POWER};
    const double law_row[] = {0.7, 0.01, 0.3, 0, 0.5, 0, 0.5, 0, 0, 0, 1, 0};
    const double law_value[] = {0.2, 0, 0, 0, 500, 1e-3, 1, 0.1, 0.3, 2, 0, 0};
    const double damping[MORE * 4 + 8] = {[4] = 0.1, [MORE * 4] = 0.2};
    double hinge[MORE * 2 + 4] = {[MORE * 2 + 3] = INFINITY};
    const int32_t moved[] = {end, 0, end, 1}, force_node[] = {3}, read_node[] = {7, 2};
    const double force_row[] = {0.25, 0, 0.75, 0};
    const double read_row[] = {0, 0, 1, 0, 0, 0, 0, 0}, read_force[] = {0, 0, 0, 1};
    enum { STEPS = 40 };
    double last[2][18], energy[2][STEPS * RD_ENERGIES], taken[STEPS * 3], read[STEPS * 6];
    double force[2 * STEPS], speed[4 * STEPS], extra[2 * STEPS];
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < 2; j++) {
            force[2 * i + j] = sin(i);
            speed[4 * i + 2 * j] = 0.01 * cos(i);
            speed[4 * i + 2 * j + 1] = 0.02 * sin(i);
            extra[2 * i + j] = sin(0.1 * i);
        }
    for (int again = 0; again < 2; again++) {
        struct run run = {
            .rope = rope_make(&recipe),
            .beside = {rate, string, drag, 1e-4, 0.5, 1e3},
            .laws = {{3, law_node, law_row, NULL}, law_kind, law_value},
        };
        run.rope.term_of[5] = MORE;
        run.rope.term_of[4] = MORE + 1;
        run.rope.chain.damping = damping;
        run.rope.chain.hinge = hinge;
        rope_gather(&run.rope);
        run.rope.chain.attached = 1;
        run.rope.chain.attached_kind = kind;
        run.rope.chain.attached_term = term;
        run.rope.chain.attached_row = foot;
        run.rope.chain.attached_value = value;
        const struct rd_ports drives = {1, force_node, force_row, NULL};
        const struct rd_ports responses = {2, read_node, read_row, read_force};
        CHECK_INT(open_run(&run, 1e-3), RD_OK);
        struct rd_steps steps = {
            .count = STEPS,
            .g = MIDPOINT,
            .force = force,
            .speed = speed,
            .extra = extra,
            .refined = true,
            .read = read,
            .energy = energy[again],
            .taken = taken,
        };
        const struct rd_push push = {.drives = &drives, .moved = 2, .place = moved};
        CHECK_INT(go(&run, &push, &responses, &steps), RD_OK);
        memcpy(last[again], run.motion.u, sizeof last[0]);
        close_run(&run);
    }
    for (size_t i = 0; i < 18; i++)
        CHECK_EXACT(last[1][i], last[0][i]);
    double most = 0;
    for (int i = 0; i < STEPS; i++)
        most = fmax(most, energy[0][i * RD_ENERGIES + RD_STRAIN]);
    for (int i = 1; i < STEPS; i++) {
        const double *now = energy[0] + i * RD_ENERGIES, *before = now - RD_ENERGIES;
        const double change =
            now[RD_KINETIC] + now[RD_STRAIN] - before[RD_KINETIC] - before[RD_STRAIN];
        double given = now[RD_INPUT] - now[RD_DISSIPATED];
        for (int k = 0; k < 3; k++)
            given -= taken[3 * i + k];
        CHECK_ABS(change, given, 1e-13 * most, "rounding of energies and of the tension found");
    }
}

/* compression that grows by more than a step, nothing that holds a massless string, a broken wire,
   and numbers that are none */
static void what_cannot_be_marched_is_named(void)
{
    struct recipe recipe = cantilever;
    const double pushed[] = {-4 * B};
    struct run run = {.rope = rope_make(&recipe), .beside = {.string = pushed}};
    CHECK_INT(open_run(&run, 1e-4), RD_OK);
    CHECK_INT(rd_march_factor(&run.march, 10, 0), RD_FAST_GROWTH);
    CHECK_INT(rd_march_tighten(&run.march, -1e6), RD_FAST_GROWTH);
    close_run(&run);

    recipe = (struct recipe){
        .elements = 3, .coordinates = "z", .length = 1, .tension = 5, .left = "", .right = ""};
    run = (struct run){.rope = rope_make(&recipe)};
    CHECK_INT(open_run(&run, 1), RD_SINGULAR);
    close_run(&run);

    const int32_t kind[] = {RD_WIRE}, term[] = {INNER};
    const double foot[] = {1, 0, 0, 1}, value[] = {1, 1, 1, 0};
    recipe = cantilever;
    recipe.elements = 2;
    run = (struct run){.rope = rope_make(&recipe)};
    run.rope.chain.attached = 1;
    run.rope.chain.attached_kind = kind;
    run.rope.chain.attached_term = term;
    run.rope.chain.attached_row = foot;
    run.rope.chain.attached_value = value;
    CHECK_INT(open_run(&run, 1e-3), RD_SPREAD_INERTIA);
    close_run(&run);

    const int32_t node[] = {2}, law_kind[] = {RD_POWER};
    const double row[] = {1, 0, 0, 0}, law[] = {1, 2, 0, 0}, nan[] = {NAN, NAN};
    run = (struct run){
        .rope = rope_make(&cantilever),
        .laws = {{1, node, row, NULL}, law_kind, law},
        .beside = {.stretching = 1},
    };
    CHECK_INT(open_run(&run, 1e-3), RD_OK);
    const struct rd_ports drives = {1, node, row, NULL};
    double read[1] = {0};
    struct rd_steps steps = {.count = 1, .g = MIDPOINT, .force = nan, .read = read};
    const struct rd_push push = {.drives = &drives};
    CHECK_INT(go(&run, &push, &nowhere, &steps), RD_NO_CONVERGENCE);
    for (size_t i = 0; i < 18; i++)
        CHECK_EXACT(run.motion.v[i], 0);
    close_run(&run);
}

int main(void)
{
    long_steps_end_at_rest(false);
    long_steps_end_at_rest(true);
    nothing_is_lost_by_a_free_rope();
    a_clamp_inside_divides_the_rope();
    a_stiff_resonator_is_a_mass(5, true);
    a_stiff_resonator_is_a_mass(0, true);
    a_stiff_resonator_is_a_mass(0, false);
    the_same_steps_twice(0, 2, MORE);
    the_same_steps_twice(0, 0, LEFT_END);
    the_same_steps_twice(8, 7, RIGHT_END);
    what_cannot_be_marched_is_named();
    return check_report("test_march");
}
