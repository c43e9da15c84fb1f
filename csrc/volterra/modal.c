/* With w half of the push and Q_m the mean of Q in a step,

       Q_m = lean + w F,     F = -(t form + 2/h drag) Q_m + 2/h drag Q_n + row^T f,

   solved mode by mode (Gauss-Seidel), with t of the sweep before, and the laws after each sweep. */
#include "volterra/modal.h"

#include <math.h>
#include <string.h>

#include "base/dense.h"

enum { SWEEPS = 400 };
static const double ENOUGH = 1e-15; /* a step holds where Q changes by this part of the largest, */
static const double LEAST = 1e-11;  /* or this one where rounding lets it change no less         */

void rd_modal_work(const struct rd_modal *system, struct rd_workspace *workspace,
                   struct rd_modal_work *work)
{
    rd_law_step_work(system->laws.ports.count, workspace, &work->step);
    double **array[] = {&work->mean, &work->base, &work->begun,   &work->lean,
                        &work->soft, &work->bent, &work->dragged, &work->kicked};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        *array[i] = rd_take(workspace, system->modes, sizeof(double));
}

/* row^T f */
static void kick(const struct rd_modal *system, struct rd_modal_work *work)
{
    memset(work->kicked, 0, system->modes * sizeof *work->kicked);
    for (size_t d = 0; d < system->laws.ports.count; d++)
        for (size_t k = 0; k < system->modes; k++)
            work->kicked[k] += system->row[d * system->modes + k] * work->step.force[d];
}

/* Q_m mode by mode under a tension t; the largest change, infinite where a mode has no answer */
static double sweep(const struct rd_modal *system, struct rd_modal_work *work, double t)
{
    const size_t m = system->modes;
    const double rate = 2 / system->h;
    double most = 0;
    for (size_t k = 0; k < m; k++) {
        const double w = system->push[k] / 2;
        double own = t * system->form[k * (m + 1)], other;
        work->bent[k] = rd_dense_inner(m, system->form + k * m, work->mean);
        other = t * work->bent[k];
        if (system->drag != NULL) {
            work->dragged[k] = rd_dense_inner(m, system->drag + k * m, work->mean);
            other +=
                rate * (work->dragged[k] - rd_dense_inner(m, system->drag + k * m, work->begun));
            own += rate * system->drag[k * (m + 1)];
        }
        const double stiff = 1 + w * own, before = work->mean[k];
        if (!(stiff > 0))
            return INFINITY;
        work->soft[k] = w / stiff;
        work->base[k] = (work->lean[k] - w * (other - own * before)) / stiff;
        work->mean[k] = work->base[k] + work->soft[k] * work->kicked[k];
        most = fmax(most, fabs(work->mean[k] - before));
    }
    return most;
}

/* forces of the laws beside those that modes have now, and what they move; the largest change */
static enum rd_status push_points(const struct rd_modal *system, struct rd_modal_work *work,
                                  double *most, double *residual)
{
    const size_t m = system->modes, n = system->laws.ports.count;
    for (size_t i = 0; i < n; i++) {
        const double *row = system->row + i * m;
        work->step.lean[i] = rd_dense_inner(m, row, work->base) - work->step.start[i];
        for (size_t j = 0; j <= i; j++) {
            const double *other = system->row + j * m;
            double sum = 0;
            for (size_t k = 0; k < m; k++)
                sum += row[k] * work->soft[k] * other[k];
            work->step.C[i * n + j] = work->step.C[j * n + i] = sum;
        }
    }
    const enum rd_status status = rd_law_step_solve(&work->step, residual);
    if (status != RD_OK)
        return status;
    kick(system, work);
    for (size_t k = 0; k < m; k++) {
        const double before = work->mean[k];
        work->mean[k] = work->base[k] + work->soft[k] * work->kicked[k];
        *most = fmax(*most, fabs(work->mean[k] - before));
    }
    return RD_OK;
}

/* half of how far Q^T form Q grows in half a step: the mean of both ends keeps energy */
static double rise(const struct rd_modal *system, const struct rd_modal_work *work)
{
    double sum = 0;
    for (size_t k = 0; k < system->modes && system->stretching > 0; k++)
        sum += (work->mean[k] - work->begun[k]) * work->bent[k];
    return sum;
}

static enum rd_status solve(const struct rd_modal *system, struct rd_modal_work *work,
                            struct rd_modal_run *run, double *t)
{
    const size_t m = system->modes, n = system->laws.ports.count;
    const double given = system->tension[run->made];
    double before = INFINITY, first = 0;
    for (size_t k = 0; k < m && system->stretching > 0; k++) {
        first += work->begun[k] * rd_dense_inner(m, system->form + k * m, work->begun);
        work->bent[k] = rd_dense_inner(m, system->form + k * m, work->mean);
    }
    for (int i = 0; i < SWEEPS; i++) {
        *t = given + system->stretching / 2 * (first + 2 * rise(system, work));
        double change = sweep(system, work, *t);
        run->residual = change;
        if (!isfinite(change))
            return RD_NO_CONVERGENCE;
        if (n > 0) {
            const enum rd_status status = push_points(system, work, &change, &run->residual);
            if (status != RD_OK)
                return status;
        }
        for (size_t k = 0; k < m; k++)
            *run->largest = fmax(*run->largest, fabs(work->mean[k]));
        run->residual = *run->largest > 0 ? change / *run->largest : 0;
        if (run->residual <= ENOUGH || (run->residual <= LEAST && run->residual >= before / 2))
            return RD_OK;
        before = run->residual;
    }
    return RD_NO_CONVERGENCE;
}

/* what a step begins with */
static void begin(const struct rd_modal *system, struct rd_modal_work *work,
                  const struct rd_modal_run *run)
{
    const size_t m = system->modes, n = system->laws.ports.count, at = run->made;
    const double *q = run->state + at * 2 * m, *v = q + m, *known = system->known + at * m;
    for (size_t k = 0; k < m; k++) {
        const double free = system->change[k] * q[k] + system->change[m + k] * v[k];
        work->begun[k] = known[k] + q[k];
        work->lean[k] = (work->begun[k] + known[m + k] + free) / 2;
        work->mean[k] = work->lean[k] + system->push[k] / 2 * run->pushed[at * m + k];
    }
    memcpy(work->step.force, run->force + at * n, n * sizeof(double));
    for (size_t i = 0; i < n; i++)
        work->step.start[i] = rd_dense_inner(m, system->row + i * m, work->begun);
    kick(system, work);
    work->step.time = system->begin + ((double)at + 0.5) * system->h;
}

/* F of the means, and the state that it leads to */
static void carry(const struct rd_modal *system, const struct rd_modal_work *work,
                  struct rd_modal_run *run, double t)
{
    const size_t m = system->modes, n = system->laws.ports.count, at = run->made;
    const double *q = run->state + at * 2 * m, *v = q + m, *change = system->change;
    double *next = run->state + (at + 1) * 2 * m, *pushed = run->pushed + (at + 1) * m;
    for (size_t k = 0; k < m; k++) {
        pushed[k] = work->kicked[k] - t * rd_dense_inner(m, system->form + k * m, work->mean);
        if (system->drag != NULL)
            pushed[k] -= 2 / system->h *
                         (rd_dense_inner(m, system->drag + k * m, work->mean) -
                          rd_dense_inner(m, system->drag + k * m, work->begun));
        next[k] = change[k] * q[k] + change[m + k] * v[k] + system->push[k] * pushed[k];
        next[m + k] =
            change[2 * m + k] * q[k] + change[3 * m + k] * v[k] + system->push[m + k] * pushed[k];
    }
    memcpy(run->force + (at + 1) * n, work->step.force, n * sizeof(double));
}

enum rd_status rd_modal_run(const struct rd_modal *system, struct rd_modal_work *work,
                            struct rd_modal_run *run)
{
    work->step.laws = system->laws;
    work->step.call = system->call;
    work->step.context = system->context;
    work->step.h = system->h;
    work->step.size = run->size;
    for (run->made = 0; run->made < system->steps; run->made++) {
        double t;
        begin(system, work, run);
        const enum rd_status status = solve(system, work, run, &t);
        if (status != RD_OK)
            return status;
        carry(system, work, run, t);
    }
    return RD_OK;
}
