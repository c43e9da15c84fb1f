/* A uniform line for tests, its runs and one call of the sweep in memory of exactly its size. */
#include "line.h"

#include <stdio.h>
#include <stdlib.h>

void line_make(struct line *line, enum rd_kind kind, size_t width, size_t elements, double T,
               double B, double mu, int hold_beta)
{
    *line = (struct line){
        .chain = {.nodes = elements + 1, .width = width, .distinct = 1, .terms = 5, .kind = kind}};
    line->coordinate[0] = RD_Z;
    line->coordinate[1] = RD_BETA;
    line->length[0] = 1.0 / (double)elements;
    line->tension[0] = T;
    line->flexibility[8] = width == 2 ? 1.0 / B : 0.0;
    for (size_t i = 0; i <= elements; i++)
        line->term_of[i] = i == 0 ? LEFT : i < elements ? INNER : RIGHT;
    line->inertia[0] = mu;
    for (size_t t = 0; t < 5 && kind != RD_CONTINUOUS; t++)
        line->mass[t * width * width] = mu / (double)elements * (t == LEFT || t == RIGHT ? 0.5 : 1);
    for (size_t i = 0; i < width; i++)
        line->held[LEFT * width + i] = line->held[RIGHT * width + i] = i == 0 || hold_beta;
}

/* the numbers, if any is not 0 */
static const double *present(const double *x, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (x[i] != 0)
            return x;
    return NULL;
}

void line_find(struct line *line)
{
    struct rd_chain *chain = &line->chain;
    chain->coordinate = line->coordinate;
    chain->length = line->length;
    chain->tension = line->tension;
    chain->flexibility = line->flexibility;
    chain->inertia = chain->kind == RD_CONTINUOUS ? line->inertia : NULL;
    chain->mass = line->mass;
    chain->stiffness = line->stiffness;
    chain->damping = present(line->damping, 5 * 4);
    chain->drag = present(line->drag, 2);
    chain->held = line->held;
    chain->first = line->first;
    chain->element = line->element;
    chain->term = line->term;
    chain->stretches = 0;
    for (size_t i = 0; i < chain->nodes; i++)
        if (i == 0 || i + 1 == chain->nodes || line->term_of[i] != line->term_of[i - 1]) {
            line->first[chain->stretches] = (int32_t)i;
            line->term[chain->stretches++] = line->term_of[i];
        }
    chain->hinge = line->hinge;
    chain->element_of = line->element;
    chain->term_of = line->term_of;
    rd_runs_find(chain, line->run, &line->runs);
}

enum rd_status line_frf_less(const struct line *line, int32_t drive, int32_t response,
                             const double *omega, size_t count, double complex *value,
                             double *error, size_t less, size_t *failed)
{
    double one[2 * LINE_POINTS], inertia[2 * LINE_POINTS] = {0}, dashpot[2 * LINE_POINTS] = {0};
    for (size_t i = 0; i < count; i++) {
        one[2 * i] = 1.0;
        one[2 * i + 1] = 0.0;
        inertia[2 * i] = -omega[i] * omega[i];
        dashpot[2 * i + 1] = omega[i];
    }
    const double row[4] = {1.0};
    const struct rd_factors factors = {.count = count,
                                       .section = one,
                                       .tension = one,
                                       .spring = one,
                                       .inertia = inertia,
                                       .dashpot = dashpot};
    const struct rd_ports drives = {1, &drive, row, NULL};
    const struct rd_ports responses = {1, &response, row, NULL};
    struct rd_workspace space = {0};
    rd_frf_sweep(&line->chain, &factors, &drives, &responses, &space, (double *)value, error,
                 failed);
    const size_t size = space.used - less;
    space = (struct rd_workspace){.base = malloc(size), .size = size};
    if (!space.base)
        abort();
    const enum rd_status status = rd_frf_sweep(&line->chain, &factors, &drives, &responses, &space,
                                               (double *)value, error, failed);
    free(space.base);
    return status;
}

enum rd_status line_frf(const struct line *line, int32_t drive, int32_t response,
                        const double *omega, size_t count, double complex *value, double *error)
{
    size_t failed = 0;
    return line_frf_less(line, drive, response, omega, count, value, error, 0, &failed);
}
