#include "volterra/volterra.h"

#include "base/dense.h"

/* how point i moves by the end of step n without the forces of it */
static double past(const struct rd_volterra *system, const double *force, size_t i, size_t n)
{
    const size_t m = system->laws.ports.count, steps = system->steps;
    double sum = system->linear[i * (steps + 1) + n + 1];
    for (size_t j = 0; j < m; j++)
        sum += rd_dense_inner(n, system->kernel + (i * m + j) * steps + steps - 1 - n,
                              force + j * steps);
    return sum;
}

enum rd_status rd_volterra_run(const struct rd_volterra *system, size_t until,
                               struct rd_law_step *step, struct rd_volterra_run *run)
{
    const size_t m = system->laws.ports.count, steps = system->steps;
    step->laws = system->laws;
    step->call = system->call;
    step->context = system->context;
    step->h = system->h;
    step->size = run->size;
    for (size_t i = 0; i < m * m; i++)
        step->C[i] = system->kernel[(i + 1) * steps - 1] / 2;
    for (; run->made < until; run->made++) {
        const size_t n = run->made;
        for (size_t i = 0; i < m; i++) {
            step->start[i] = run->motion[i * (steps + 1) + n];
            step->lean[i] = (past(system, run->force, i, n) - step->start[i]) / 2;
            step->force[i] = n > 0 ? run->force[i * steps + n - 1] : 0;
        }
        step->time = system->begin + ((double)n + 0.5) * system->h;
        const enum rd_status status = rd_law_step_solve(step, &run->residual);
        if (status != RD_OK)
            return status;
        for (size_t i = 0; i < m; i++) {
            double x = step->lean[i];
            for (size_t k = 0; k < m; k++)
                x += step->C[i * m + k] * step->force[k];
            run->force[i * steps + n] = step->force[i];
            run->motion[i * (steps + 1) + n + 1] = step->start[i] + 2 * x;
        }
    }
    return RD_OK;
}
