/* Modes under straight lines: changes whose states are known numbers. */
#include "base/recurrence.h"

#include <stdlib.h>

#include "check.h"

enum { MODES = 2 * RD_LANES, STEPS = 40 };

/* the mode's changes over all eight parts, for one length of a step */
static void put(double *change, size_t mode, const double part[RD_CHANGE])
{
    for (size_t i = 0; i < RD_CHANGE; i++)
        change[i * MODES + mode] = part[i];
}

/* free mass under f: q'' = f, S = h, P = h^2/2, R = h^3/6, numbers chosen exact */
static void lines_move_a_free_mass_as_cubics(void)
{
    const double h = 0.5;
    double change[RD_CHANGE * MODES] = {0}, seen[2 * 2 * MODES] = {0}, state[2 * MODES] = {0};
    double force[STEPS + 1], value[2 * STEPS];
    int32_t length[STEPS] = {0};
    put(change, 9, (double[]){0, h, h * h / 2, h * h / 6, 0, 0, h, h / 2});
    seen[9] = 6; /* of the first response: 6 q */
    seen[3 * MODES + 9] = 2;
    for (int n = 0; n <= STEPS; n++)
        force[n] = n * h;
    const struct rd_recurrence recurrence = {MODES, 2, change, seen};
    rd_recurrence_walk(&recurrence, STEPS, length, force, state, value);
    for (int n = 0; n < STEPS; n++) {
        const double t = (n + 1) * h;
        CHECK_REL(value[n], t * t * t, 40 * EPS, "h^2/6 rounds, and 40 sums");
        CHECK_EXACT(value[STEPS + n], t * t);
    }
    CHECK_EXACT(state[MODES + 9], value[2 * STEPS - 1] / 2);
    for (size_t k = 0; k < 2 * MODES; k++)
        CHECK(k % MODES == 9 || state[k] == 0);
}

/* every mode by itself, against the same sums one by one; steps of two lengths */
static void modes_do_not_meet_but_in_responses(void)
{
    double change[2 * RD_CHANGE * MODES], seen[2 * MODES], state[2 * MODES], alone[2 * MODES];
    double force[STEPS + 1], value[STEPS];
    int32_t length[STEPS];
    for (size_t i = 0; i < sizeof change / sizeof *change; i++)
        change[i] = check_random() / 8;
    for (size_t i = 0; i < 2 * MODES; i++) {
        seen[i] = check_random();
        state[i] = alone[i] = check_random();
    }
    for (size_t n = 0; n <= STEPS; n++)
        force[n] = check_random();
    for (int32_t n = 0; n < STEPS; n++)
        length[n] = n % 3 == 1;
    const struct rd_recurrence recurrence = {MODES, 1, change, seen};
    rd_recurrence_walk(&recurrence, STEPS, length, force, state, value);
    for (size_t n = 0; n < STEPS; n++) {
        const double *c = change + (size_t)length[n] * RD_CHANGE * MODES, f = force[n];
        const double d = force[n + 1] - f;
        double sum = 0, size = 0;
        for (size_t k = 0; k < MODES; k++) {
            double *q = alone + k, *v = alone + MODES + k;
            const double p[] = {
                c[k] * *q + c[MODES + k] * *v, c[2 * MODES + k] * f,
                c[3 * MODES + k] * d,          c[4 * MODES + k] * *q + c[5 * MODES + k] * *v,
                c[6 * MODES + k] * f,          c[7 * MODES + k] * d};
            *q += p[0] + (p[1] + p[2]);
            *v += p[3] + (p[4] + p[5]);
            sum += seen[k] * *q + seen[MODES + k] * *v;
            size += fabs(seen[k] * *q) + fabs(seen[MODES + k] * *v);
        }
        CHECK_ABS(value[n], sum, 2 * MODES * EPS * size, "the same terms in another order");
    }
    for (size_t k = 0; k < 2 * MODES; k++)
        CHECK_EXACT(state[k], alone[k]);
}

/* walked at once or in parts: the same bits */
static void walk_goes_on_where_it_stopped(void)
{
    double change[RD_CHANGE * MODES], seen[2 * MODES], whole[2 * MODES], parts[2 * MODES];
    double force[STEPS + 1], at_once[STEPS], value[STEPS];
    const int32_t length[STEPS] = {0};
    for (size_t i = 0; i < RD_CHANGE * MODES; i++)
        change[i] = check_random() / 8;
    for (size_t i = 0; i < 2 * MODES; i++) {
        seen[i] = check_random();
        whole[i] = parts[i] = check_random();
    }
    for (size_t n = 0; n <= STEPS; n++)
        force[n] = check_random();
    const struct rd_recurrence recurrence = {MODES, 1, change, seen};
    rd_recurrence_walk(&recurrence, STEPS, length, force, whole, at_once);
    rd_recurrence_walk(&recurrence, 7, length, force, parts, value);
    rd_recurrence_walk(&recurrence, 0, length + 7, force + 7, parts, NULL);
    rd_recurrence_walk(&recurrence, STEPS - 7, length + 7, force + 7, parts, value + 7);
    for (size_t n = 0; n < STEPS; n++)
        CHECK_EXACT(value[n], at_once[n]);
    for (size_t k = 0; k < 2 * MODES; k++)
        CHECK_EXACT(parts[k], whole[k]);
}

int main(void)
{
    lines_move_a_free_mass_as_cubics();
    modes_do_not_meet_but_in_responses();
    walk_goes_on_where_it_stopped();
    return check_report("test_recurrence");
}
