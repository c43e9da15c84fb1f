/* Modes under straight lines between samples: changes whose states are known numbers. */
#include "base/recurrence.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { GROUPS = 2, SIZE = 3, KINDS = 2, SEEN = 2, BLOCKS = 120, SAMPLES = BLOCKS * SIZE };

struct tables {
    double change[GROUPS][KINDS][RD_CHANGE][RD_QUAD];
    double gain[GROUPS][KINDS][SIZE + 1][2][RD_QUAD];
    double read[GROUPS][SIZE][SEEN][2][RD_QUAD];
    double local[SIZE][SEEN][SIZE];
    double sample[SAMPLES + 1];
    double state[GROUPS][2][RD_QUAD];
    int32_t kind[BLOCKS];
};

static struct rd_recurrence view(const struct tables *t)
{
    return (struct rd_recurrence){
        .groups = GROUPS,
        .kinds = KINDS,
        .size = SIZE,
        .responses = SEEN,
        .change = &t->change[0][0][0][0],
        .gain = &t->gain[0][0][0][0][0],
        .read = &t->read[0][0][0][0][0],
        .local = &t->local[0][0][0],
    };
}

static void fill(double *x, size_t bytes, double most)
{
    for (size_t i = 0; i < bytes / sizeof *x; i++)
        x[i] = most * check_random();
}

static void fill_tables(struct tables *t)
{
    fill(&t->change[0][0][0][0], sizeof t->change, 0.1);
    fill(&t->gain[0][0][0][0][0], sizeof t->gain, 1.0);
    fill(&t->read[0][0][0][0][0], sizeof t->read, 1.0);
    fill(&t->local[0][0][0], sizeof t->local, 1.0);
    fill(t->sample, sizeof t->sample, 1.0);
    fill(&t->state[0][0][0], sizeof t->state, 1.0);
    for (int32_t b = 0; b < BLOCKS; b++)
        t->kind[b] = b % 3 == 1;
}

static void walk(const struct tables *t, size_t first, size_t blocks, double *state, double *value)
{
    const struct rd_recurrence recurrence = view(t);
    half_lanes *work = aligned_alloc(sizeof *work, rd_recurrence_work(SEEN) * sizeof *work);
    CHECK(work != NULL);
    rd_recurrence_walk(&recurrence, blocks, t->kind + first, t->sample + first * SIZE, state, work,
                       value);
    free(work);
}

/* free mass under f = t: q'' = f, blocks of one sample, S = h, P = h^2/2, R = h^3/6 */
static void line_moves_a_free_mass_as_a_cubic(void)
{
    enum { STEPS = 40 };
    const double h = 0.5;
    double change[RD_CHANGE][RD_QUAD] = {{0}}, gain[2][2][RD_QUAD] = {{{0}}};
    double read[1][2][2][RD_QUAD] = {{{{0}}}}, local[1][2][1] = {{{0}}}, sample[STEPS + 1];
    double state[2 * RD_QUAD] = {0}, value[2][STEPS];
    int32_t kind[STEPS] = {0};
    const size_t k = 2;
    change[1][k] = h;
    gain[0][0][k] = h * h / 2;
    gain[0][1][k] = h;
    gain[1][0][k] = h * h / 6;
    gain[1][1][k] = h / 2;
    read[0][0][0][k] = read[0][1][1][k] = 1;
    for (int n = 0; n <= STEPS; n++)
        sample[n] = n * h;
    const struct rd_recurrence recurrence = {
        1, 1, 1, 2, &change[0][0], &gain[0][0][0], &read[0][0][0][0], &local[0][0][0],
    };
    half_lanes *work = aligned_alloc(sizeof *work, rd_recurrence_work(2) * sizeof *work);
    CHECK(work != NULL);
    rd_recurrence_walk(&recurrence, STEPS, kind, sample, state, work, &value[0][0]);
    free(work);
    for (int n = 0; n < STEPS; n++) {
        const double t = n * h;
        CHECK_REL(6 * value[0][n], t * t * t, 40 * EPS, "h^3/6 rounds, and 40 sums");
        CHECK_EXACT(2 * value[1][n], t * t);
    }
    for (size_t i = 0; i < 2 * RD_QUAD; i++)
        CHECK(i % RD_QUAD == k || state[i] == 0);
}

/* every mode by itself, against the same sums one by one; blocks of two kinds */
static void modes_do_not_meet(void)
{
    struct tables t;
    double value[SEEN][SAMPLES], alone[SEEN][SAMPLES], state[GROUPS * 2 * RD_QUAD];
    fill_tables(&t);
    memcpy(state, t.state, sizeof state);
    walk(&t, 0, BLOCKS, state, &value[0][0]);
    for (size_t b = 0; b < BLOCKS; b++) {
        const double *f = t.sample + b * SIZE;
        const double push[] = {f[0], f[1] - f[0], (f[2] - f[1]) - (f[1] - f[0]),
                               (f[3] - f[2]) - (f[2] - f[1])};
        for (size_t p = 0; p < SEEN; p++)
            for (size_t m = 0; m < SIZE; m++) {
                double *total = &alone[p][b * SIZE + m];
                *total = 0;
                for (size_t i = 0; i <= m; i++)
                    *total += t.local[m][p][i] * push[i];
            }
        for (size_t g = 0; g < GROUPS; g++)
            for (size_t k = 0; k < RD_QUAD; k++) {
                double *q = &t.state[g][0][k], *v = &t.state[g][1][k];
                const size_t kind = (size_t)t.kind[b];
                double by[2] = {0, 0};
                for (size_t p = 0; p < SEEN; p++)
                    for (size_t m = 0; m < SIZE; m++)
                        alone[p][b * SIZE + m] +=
                            t.read[g][m][p][0][k] * *q + t.read[g][m][p][1][k] * *v;
                for (size_t i = 0; i <= SIZE; i++)
                    for (size_t n = 0; n < 2; n++)
                        by[n] += t.gain[g][kind][i][n][k] * push[i];
                const double *c = &t.change[g][kind][0][k];
                const double dq = (c[0] * *q + c[RD_QUAD] * *v) + by[0];
                const double dv = (c[2 * RD_QUAD] * *q + c[3 * RD_QUAD] * *v) + by[1];
                *q += dq;
                *v += dv;
            }
    }
    for (size_t i = 0; i < sizeof state / sizeof *state; i++)
        CHECK_EXACT(state[i], (&t.state[0][0][0])[i]);
    for (size_t p = 0; p < SEEN; p++)
        for (size_t n = 0; n < SAMPLES; n++)
            CHECK_ABS(value[p][n], alone[p][n], 500 * EPS, "sums of 100 in another order");
}

/* walked at once or in parts: the same bits */
static void walk_goes_on_where_it_stopped(void)
{
    struct tables t;
    double whole[SEEN][SAMPLES], first[SEEN][7 * SIZE], rest[SEEN][SAMPLES - 7 * SIZE];
    double once[GROUPS * 2 * RD_QUAD], twice[GROUPS * 2 * RD_QUAD];
    fill_tables(&t);
    memcpy(once, t.state, sizeof once);
    memcpy(twice, t.state, sizeof twice);
    walk(&t, 0, BLOCKS, once, &whole[0][0]);
    walk(&t, 0, 7, twice, &first[0][0]);
    walk(&t, 7, 0, twice, NULL);
    walk(&t, 7, BLOCKS - 7, twice, &rest[0][0]);
    for (size_t i = 0; i < sizeof once / sizeof *once; i++)
        CHECK_EXACT(twice[i], once[i]);
    for (size_t p = 0; p < SEEN; p++)
        for (size_t n = 0; n < SAMPLES; n++)
            CHECK_EXACT(n < 7 * SIZE ? first[p][n] : rest[p][n - 7 * SIZE], whole[p][n]);
}

int main(void)
{
    line_moves_a_free_mass_as_a_cubic();
    modes_do_not_meet();
    walk_goes_on_where_it_stopped();
    return check_report("test_recurrence");
}
