/* Modes from step to step: changes whose states are known numbers. */
#include "base/recurrence.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { MODES = 2 * RD_LANES, STEPS = 40 };

/* free mass under f = t: q'' = f, S = h, P = h^2/2, R = h^3/6, numbers chosen exact */
static void line_moves_a_free_mass_as_a_cubic(void)
{
    const double h = 0.5;
    double change[RD_CHANGE * MODES] = {0}, push[STEPS * 2 * MODES] = {0};
    double states[(STEPS + 1) * 2 * MODES] = {0};
    const int32_t length[STEPS] = {0};
    change[MODES + 9] = h;
    for (int n = 0; n < STEPS; n++) {
        push[2 * n * MODES + 9] = n * h * h * h / 2 + h * h * h / 6;
        push[(2 * n + 1) * MODES + 9] = n * h * h + h * h / 2;
    }
    const struct rd_recurrence recurrence = {MODES, change};
    rd_recurrence_walk(&recurrence, STEPS, length, push, states);
    for (int n = 0; n <= STEPS; n++) {
        const double t = n * h, *q = states + 2 * n * MODES;
        CHECK_REL(6 * q[9], t * t * t, 40 * EPS, "h^3/6 rounds, and 40 sums");
        CHECK_EXACT(2 * q[MODES + 9], t * t);
        for (size_t k = 0; k < 2 * MODES; k++)
            CHECK(k % MODES == 9 || q[k] == 0);
    }
}

/* every mode by itself, against the same sums one by one; steps of two lengths */
static void modes_do_not_meet(void)
{
    double change[2 * RD_CHANGE * MODES], push[STEPS * 2 * MODES], alone[2 * MODES];
    double states[(STEPS + 1) * 2 * MODES];
    int32_t length[STEPS];
    for (size_t i = 0; i < sizeof change / sizeof *change; i++)
        change[i] = check_random() / 8;
    for (size_t i = 0; i < sizeof push / sizeof *push; i++)
        push[i] = check_random();
    for (size_t i = 0; i < 2 * MODES; i++)
        states[i] = alone[i] = check_random();
    for (int32_t n = 0; n < STEPS; n++)
        length[n] = n % 3 == 1;
    const struct rd_recurrence recurrence = {MODES, change};
    rd_recurrence_walk(&recurrence, STEPS, length, push, states);
    for (size_t n = 0; n < STEPS; n++) {
        const double *c = change + (size_t)length[n] * RD_CHANGE * MODES;
        for (size_t k = 0; k < MODES; k++) {
            double *q = alone + k, *v = alone + MODES + k;
            const double more[] = {(c[k] * *q + c[MODES + k] * *v) + push[2 * n * MODES + k],
                                   (c[2 * MODES + k] * *q + c[3 * MODES + k] * *v) +
                                       push[(2 * n + 1) * MODES + k]};
            *q += more[0];
            *v += more[1];
            CHECK_EXACT(states[2 * (n + 1) * MODES + k], *q);
            CHECK_EXACT(states[(2 * (n + 1) + 1) * MODES + k], *v);
        }
    }
}

/* walked at once or in parts: the same bits */
static void walk_goes_on_where_it_stopped(void)
{
    double change[RD_CHANGE * MODES], push[STEPS * 2 * MODES];
    double whole[(STEPS + 1) * 2 * MODES], parts[(STEPS + 1) * 2 * MODES];
    const int32_t length[STEPS] = {0};
    for (size_t i = 0; i < RD_CHANGE * MODES; i++)
        change[i] = check_random() / 8;
    for (size_t i = 0; i < sizeof push / sizeof *push; i++)
        push[i] = check_random();
    for (size_t i = 0; i < 2 * MODES; i++)
        whole[i] = parts[i] = check_random();
    const struct rd_recurrence recurrence = {MODES, change};
    rd_recurrence_walk(&recurrence, STEPS, length, push, whole);
    rd_recurrence_walk(&recurrence, 7, length, push, parts);
    rd_recurrence_walk(&recurrence, 0, length, NULL, parts + 14 * MODES);
    rd_recurrence_walk(&recurrence, STEPS - 7, length, push + 14 * MODES, parts + 14 * MODES);
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        CHECK_EXACT(parts[i], whole[i]);
}

int main(void)
{
    line_moves_a_free_mass_as_a_cubic();
    modes_do_not_meet();
    walk_goes_on_where_it_stopped();
    return check_report("test_recurrence");
}
