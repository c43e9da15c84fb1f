/* Laws of the core are solved together; those of the caller one after another, each by the secant
   method, until nothing changes. */
#include "law/step.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { SWEEPS = 200, SECANTS = 60 };
static const double ENOUGH = 1e-12; /* forces hold where they change by this part of the largest, */
static const double LEAST = 1e-9;   /* or this one where rounding lets them change no less        */

void rd_law_step_work(size_t laws, struct rd_workspace *workspace, struct rd_law_step *step)
{
    step->C = rd_take(workspace, laws * laws, sizeof(double));
    step->lean = rd_take(workspace, laws, sizeof(double));
    step->start = rd_take(workspace, laws, sizeof(double));
    step->force = rd_take(workspace, laws, sizeof(double));
    step->kept = rd_take(workspace, laws, sizeof(double));
    step->solve = rd_take(workspace, laws * (laws + 4), sizeof(double));
}

/* what a law of the caller says where its own force is f; false: it failed */
static bool say(const struct rd_law_step *step, size_t d, double f, double *said)
{
    const size_t m = step->laws.ports.count;
    double x = step->lean[d] + step->C[d * (m + 1)] * f;
    for (size_t k = 0; k < m; k++)
        x += k == d ? 0 : step->C[d * m + k] * step->force[k];
    const double u = step->start[d] + x, v = 2 * x / step->h;
    return step->call(step->context, d, 1, &step->time, &u, &v, said);
}

/* the force of a law of the caller beside those of all others */
static enum rd_status settle(const struct rd_law_step *step, size_t d, double *left)
{
    double f = step->force[d], said, before = f, gap_before = 0;
    for (int i = 0; i < SECANTS; i++) {
        if (!say(step, d, f, &said))
            return RD_INTERRUPTED;
        const double gap = said - f;
        step->size[d] = fmax(step->size[d], fabs(said));
        *left = step->size[d] > 0 ? fabs(gap) / step->size[d] : 0;
        if (!isfinite(gap))
            return RD_NO_CONVERGENCE;
        step->force[d] = f;
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
enum rd_status rd_law_step_solve(const struct rd_law_step *step, double *residual)
{
    const size_t m = step->laws.ports.count;
    for (int i = 0; i < SWEEPS; i++) {
        memcpy(step->kept, step->force, m * sizeof *step->kept);
        double left = rd_laws_solve(&step->laws, step->h / 2, step->lean, step->C, step->start,
                                    step->force, step->solve);
        for (size_t d = 0; d < m; d++) {
            double own = 0;
            if (step->laws.kind[d] != RD_GIVEN)
                continue;
            const enum rd_status status = settle(step, d, &own);
            if (status != RD_OK)
                return status;
            left = fmax(left, own);
        }
        double change = 0;
        for (size_t d = 0; d < m; d++) {
            step->size[d] = fmax(step->size[d], fabs(step->force[d]));
            if (step->laws.kind[d] == RD_GIVEN && step->size[d] > 0)
                change = fmax(change, fabs(step->force[d] - step->kept[d]) / step->size[d]);
        }
        *residual = fmax(left, change);
        if (!(left <= LEAST))
            return RD_NO_CONVERGENCE;
        if (m == 1 || change <= ENOUGH)
            return RD_OK;
    }
    return *residual <= LEAST ? RD_OK : RD_NO_CONVERGENCE;
}
