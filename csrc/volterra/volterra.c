/* Laws of the core are solved together; those of the caller one after another, each by the secant
   method, until nothing changes. */
#include "volterra/volterra.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/lanes.h"

enum { SWEEPS = 200, SECANTS = 60 };
static const double ENOUGH = 1e-12; /* forces hold where they change by this part of the largest, */
static const double LEAST = 1e-9;   /* or this one where rounding lets them change no less        */

void rd_volterra_work(size_t laws, struct rd_workspace *workspace, struct rd_volterra_work *work)
{
    *work = (struct rd_volterra_work){
        .C = rd_take(workspace, laws * laws, sizeof(double)),
        .lean = rd_take(workspace, laws, sizeof(double)),
        .start = rd_take(workspace, laws, sizeof(double)),
        .force = rd_take(workspace, laws, sizeof(double)),
        .kept = rd_take(workspace, laws, sizeof(double)),
        .solve = rd_take(workspace, laws * (laws + 4), sizeof(double)),
    };
}

/* --- what has been -----------------------------------------------------------------------------*/

RD_CLONES static double inner(size_t count, const double *a, const double *b)
{
    lanes sum = {0};
    size_t k = 0;
    for (; k + RD_LANES <= count; k += RD_LANES) {
        lanes x, y;
        memcpy(&x, a + k, sizeof x);
        memcpy(&y, b + k, sizeof y);
        sum += x * y;
    }
    double all = 0;
    for (int i = 0; i < RD_LANES; i++)
        all += sum[i];
    for (; k < count; k++)
        all += a[k] * b[k];
    return all;
}

/* how point i moves by the end of step n without the forces of it */
static double past(const struct rd_volterra *system, const double *force, size_t i, size_t n)
{
    const size_t m = system->laws.ports.count, steps = system->steps;
    double sum = system->linear[i * (steps + 1) + n + 1];
    for (size_t j = 0; j < m; j++)
        sum += inner(n, system->kernel + (i * m + j) * steps + steps - 1 - n, force + j * steps);
    return sum;
}

/* --- one step ----------------------------------------------------------------------------------*/

struct step {
    const struct rd_volterra *system;
    const struct rd_volterra_work *work;
    double *size;
    double time; /* [s] of its middle */
};

/* what a law of the caller says where its own force is f; false: it failed */
static bool say(const struct step *step, size_t d, double f, double *said)
{
    const size_t m = step->system->laws.ports.count;
    const struct rd_volterra_work *work = step->work;
    double x = work->lean[d] + work->C[d * (m + 1)] * f;
    for (size_t k = 0; k < m; k++)
        x += k == d ? 0 : work->C[d * m + k] * work->force[k];
    const double u = work->start[d] + x, v = 2 * x / step->system->h;
    return step->system->call(step->system->context, d, 1, &step->time, &u, &v, said);
}

/* the force of a law of the caller beside those of all others */
static enum rd_status settle(const struct step *step, size_t d, double *left)
{
    double f = step->work->force[d], said, before = f, gap_before = 0;
    for (int i = 0; i < SECANTS; i++) {
        if (!say(step, d, f, &said))
            return RD_INTERRUPTED;
        const double gap = said - f;
        step->size[d] = fmax(step->size[d], fabs(said));
        *left = step->size[d] > 0 ? fabs(gap) / step->size[d] : 0;
        if (!isfinite(gap))
            return RD_NO_CONVERGENCE;
        step->work->force[d] = f;
        if (*left <= ENOUGH || (*left <= LEAST && i > 0 && fabs(gap) >= fabs(gap_before)))
            return RD_OK;
        const double slope = i > 0 ? (gap - gap_before) / (f - before) : -1;
        before = f;
        gap_before = gap;
        f -= slope == 0 ? -gap : gap / slope;
    }
    return RD_NO_CONVERGENCE;
}

/* all forces of a step */
static enum rd_status solve(const struct step *step, double *residual)
{
    const struct rd_volterra *system = step->system;
    const struct rd_volterra_work *work = step->work;
    const size_t m = system->laws.ports.count;
    for (int i = 0; i < SWEEPS; i++) {
        memcpy(work->kept, work->force, m * sizeof *work->kept);
        double left = rd_laws_solve(&system->laws, system->h / 2, work->lean, work->C, work->start,
                                    work->force, work->solve);
        for (size_t d = 0; d < m; d++) {
            double own = 0;
            if (system->laws.kind[d] != RD_GIVEN)
                continue;
            const enum rd_status status = settle(step, d, &own);
            if (status != RD_OK)
                return status;
            left = fmax(left, own);
        }
        double change = 0;
        for (size_t d = 0; d < m; d++) {
            step->size[d] = fmax(step->size[d], fabs(work->force[d]));
            if (system->laws.kind[d] == RD_GIVEN && step->size[d] > 0)
                change = fmax(change, fabs(work->force[d] - work->kept[d]) / step->size[d]);
        }
        *residual = fmax(left, change);
        if (!(left <= LEAST))
            return RD_NO_CONVERGENCE;
        if (m == 1 || change <= ENOUGH)
            return RD_OK;
    }
    return *residual <= LEAST ? RD_OK : RD_NO_CONVERGENCE;
}

enum rd_status rd_volterra_run(const struct rd_volterra *system, size_t until,
                               const struct rd_volterra_work *work, struct rd_volterra_run *run)
{
    const size_t m = system->laws.ports.count, steps = system->steps;
    for (size_t i = 0; i < m * m; i++)
        work->C[i] = system->kernel[(i + 1) * steps - 1] / 2;
    for (; run->made < until; run->made++) {
        const size_t n = run->made;
        for (size_t i = 0; i < m; i++) {
            work->start[i] = run->motion[i * (steps + 1) + n];
            work->lean[i] = (past(system, run->force, i, n) - work->start[i]) / 2;
            work->force[i] = n > 0 ? run->force[i * steps + n - 1] : 0;
        }
        const struct step step = {system, work, run->size,
                                  system->begin + ((double)n + 0.5) * system->h};
        const enum rd_status status = solve(&step, &run->residual);
        if (status != RD_OK)
            return status;
        for (size_t i = 0; i < m; i++) {
            double x = work->lean[i];
            for (size_t k = 0; k < m; k++)
                x += work->C[i * m + k] * work->force[k];
            run->force[i * steps + n] = work->force[i];
            run->motion[i * (steps + 1) + n + 1] = work->start[i] + 2 * x;
        }
    }
    return RD_OK;
}
