/* Newton's method on the forces R of the laws at all stages of a step: R = law(t, u(R), v(R)).

   u and v are linear in R, so its matrix is 1 - D_u U - D_v V with the slopes D of the laws; it is
   kept as long as the gap falls fast. Nothing but the laws is called. */
#include "collocation/collocation.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/lapack.h"

enum { MOST = 60 };                   /* iterations of a step                                   */
static const double ENOUGH = 1e-13;   /* a step holds where gaps are this part of largest forces, */
static const double LEAST = 1e-10;    /* or this one where rounding lets them fall no more        */
static const double SHARE = 1e-3;     /* a Newton step is halved down to this part of it          */
static const double FALLS = 0.05;     /* the matrix is kept where a gap falls to this part of it  */
static const double SHIFT = 1e-7;     /* slopes are taken over this part of the largest motion    */
static const double NOTHING = 1e-200; /* where nothing has moved yet                              */

struct solver {
    const struct rd_collocation *step;
    const struct rd_smooth_laws *laws;
    const struct rd_collocation_work *work;
    const double *known; /* u and v without the forces of this step */
    double begin;
    double *size;  /* (3, laws) of the motion and the forces before */
    double *scale; /* (laws,) of the forces of this step            */
};

void rd_collocation_work(const struct rd_collocation *step, struct rd_workspace *workspace,
                         struct rd_collocation_work *work)
{
    const size_t s = step->stages, n = step->laws, all = s * n;
    *work = (struct rd_collocation_work){
        .point = rd_take(workspace, 2 * all, sizeof(double)),
        .wanted = rd_take(workspace, all, sizeof(double)),
        .slope = rd_take(workspace, 2 * all, sizeof(double)),
        .gap = rd_take(workspace, all, sizeof(double)),
        .tried = rd_take(workspace, all + n, sizeof(double)), /* and the scales of the laws */
        .further = rd_take(workspace, all, sizeof(double)),
        .jacobian = rd_take(workspace, all * all, sizeof(double)),
        .call = rd_take(workspace, 12 * s, sizeof(double)),
        .pivot = rd_take(workspace, all, sizeof(int32_t)),
    };
}

/* --- laws --------------------------------------------------------------------------------------*/

/* force = -c |v|^p sign(v) and its slope */
static void say_power(const struct solver *solver, size_t law, bool sloped)
{
    const size_t s = solver->step->stages, n = solver->step->laws;
    const double c = solver->laws->value[2 * law], p = solver->laws->value[2 * law + 1];
    const struct rd_collocation_work *work = solver->work;
    for (size_t i = 0; i < s; i++) {
        const double v = work->point[(2 * i + 1) * n + law];
        const double below = p == 1 ? 1 : pow(fabs(v), p - 1);
        work->wanted[i * n + law] = -c * below * v;
        if (sloped) {
            work->slope[2 * i * n + law] = 0;
            work->slope[(2 * i + 1) * n + law] = -c * p * below;
        }
    }
}

/* a law that is called: slopes are differences, all from one call */
static bool say_call(const struct solver *solver, size_t law, bool sloped)
{
    const size_t s = solver->step->stages, n = solver->step->laws, count = sloped ? 3 * s : s;
    const struct rd_collocation_work *work = solver->work;
    double *t = work->call, *u = t + 3 * s, *v = u + 3 * s, *force = v + 3 * s, shift[2];
    for (int k = 0; k < 2; k++)
        shift[k] = fmax(solver->size[(size_t)k * n + law], NOTHING);
    for (size_t i = 0; i < s; i++)
        for (int k = 0; k < 2; k++)
            shift[k] = fmax(shift[k], fabs(work->point[(2 * i + (size_t)k) * n + law]));
    for (size_t i = 0; i < count; i++) {
        const size_t at = i % s;
        t[i] = solver->begin + solver->step->h * solver->step->node[at];
        u[i] = work->point[2 * at * n + law] + (i / s == 1 ? SHIFT * shift[0] : 0);
        v[i] = work->point[(2 * at + 1) * n + law] + (i / s == 2 ? SHIFT * shift[1] : 0);
    }
    if (!solver->laws->call(solver->laws->context, law, count, t, u, v, force))
        return false;
    for (size_t i = 0; i < s; i++) {
        work->wanted[i * n + law] = force[i];
        if (!sloped)
            continue;
        const double du = u[s + i] - u[i], dv = v[2 * s + i] - v[i];
        work->slope[2 * i * n + law] = du > 0 ? (force[s + i] - force[i]) / du : 0;
        work->slope[(2 * i + 1) * n + law] = dv > 0 ? (force[2 * s + i] - force[i]) / dv : 0;
    }
    return true;
}

/* point = known + own R */
static void move(const struct solver *solver, const double *R)
{
    const size_t all = solver->step->stages * solver->step->laws;
    for (size_t i = 0; i < 2 * all; i++) {
        double sum = solver->known[i];
        for (size_t j = 0; j < all; j++)
            sum += solver->step->own[i * all + j] * R[j];
        solver->work->point[i] = sum;
    }
}

/* what moves, and the forces there are: slopes and gaps are measured by the largest so far */
static void grow(const struct solver *solver, const double *R)
{
    const size_t s = solver->step->stages, n = solver->step->laws;
    const double *point = solver->work->point;
    for (size_t i = 0; i < s; i++)
        for (size_t d = 0; d < n; d++) {
            const double now[3] = {point[2 * i * n + d], point[(2 * i + 1) * n + d], R[i * n + d]};
            for (size_t k = 0; k < 3; k++)
                solver->size[k * n + d] = fmax(solver->size[k * n + d], fabs(now[k]));
        }
}

/* what the laws say where forces R move their points, and the gap to R; with false a law failed */
static bool say(const struct solver *solver, const double *R, bool sloped)
{
    const size_t n = solver->step->laws, all = solver->step->stages * n;
    move(solver, R);
    for (size_t d = 0; d < n; d++) {
        if (solver->laws->kind[d] == RD_SMOOTH_POWER)
            say_power(solver, d, sloped);
        else if (!say_call(solver, d, sloped))
            return false;
    }
    for (size_t i = 0; i < all; i++)
        solver->work->gap[i] = solver->work->wanted[i] - R[i];
    return true;
}

/* of the gap, beside the largest forces */
static double worst_of(const struct solver *solver)
{
    const size_t n = solver->step->laws, all = solver->step->stages * n;
    double worst = 0;
    for (size_t i = 0; i < all; i++) {
        const double gap = fabs(solver->work->gap[i]), scale = solver->scale[i % n];
        if (!isfinite(gap))
            return INFINITY;
        worst = scale > 0 ? fmax(worst, gap / scale) : worst;
    }
    return worst;
}

/* --- Newton's method ---------------------------------------------------------------------------*/

static bool factor(const struct solver *solver)
{
    const size_t n = solver->step->laws, all = solver->step->stages * n;
    const struct rd_collocation_work *work = solver->work;
    for (size_t i = 0; i < all; i++) {
        const size_t row = 2 * (i / n) * n + i % n;
        const double *U = solver->step->own + row * all, *V = U + n * all;
        for (size_t j = 0; j < all; j++)
            work->jacobian[j * all + i] =
                (i == j) - work->slope[row] * U[j] - work->slope[row + n] * V[j];
    }
    const int32_t size = (int32_t)all;
    return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, size, size, work->jacobian, size, work->pivot) ==
           0;
}

/* change = what closes the gap by the slopes there are */
static void close(const struct solver *solver, double *change)
{
    const struct rd_collocation_work *work = solver->work;
    const int32_t all = (int32_t)(solver->step->stages * solver->step->laws);
    memcpy(change, work->gap, (size_t)all * sizeof *change);
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', all, 1, work->jacobian, all, work->pivot, change,
                        all);
}

/* how far forces move the points, beside how far they have moved */
static double moved_by(const struct solver *solver, const double *force)
{
    const size_t n = solver->step->laws, all = solver->step->stages * n;
    double most = 0;
    for (size_t i = 0; i < 2 * all; i++) {
        double sum = 0;
        for (size_t j = 0; j < all; j++)
            sum += solver->step->own[i * all + j] * force[j];
        const double size = fmax(solver->size[(i / n % 2) * n + i % n], NOTHING);
        most = fmax(most, fabs(sum) / size);
    }
    return most;
}

/* whether points are nearer where a gap is larger: a force that is nothing beside others may
   become many times as large when these move its point (natural monotonicity: Deuflhard 2004) */
static bool nearer(const struct solver *solver)
{
    close(solver, solver->work->further);
    return moved_by(solver, solver->work->further) < moved_by(solver, solver->work->tried) / 2;
}

/* R + share change, halved until the gap is smaller or points are nearer; false: a law failed */
static bool advance(const struct solver *solver, double *R, double *worst)
{
    const size_t all = solver->step->stages * solver->step->laws;
    const struct rd_collocation_work *work = solver->work;
    const double before = *worst;
    close(solver, work->tried);
    for (double share = 1;; share /= 2) {
        for (size_t i = 0; i < all; i++)
            R[i] += (share == 1 ? 1 : -share) * work->tried[i];
        if (!say(solver, R, false))
            return false;
        *worst = worst_of(solver);
        if (*worst < before || share <= SHARE || before <= LEAST ||
            (isfinite(*worst) && nearer(solver)))
            return true;
    }
}

/* forces of this step are measured by the largest before it and at its first guess, and by what
   laws say of the largest motion: points that hardly move yet do so within its rounding */
static void measure(const struct solver *solver, const double *R)
{
    const size_t n = solver->step->laws, all = solver->step->stages * n;
    memcpy(solver->scale, solver->size + 2 * n, n * sizeof *R);
    for (size_t i = 0; i < all; i++) {
        const size_t d = i % n;
        const double *slope = solver->work->slope + 2 * (i - d) + d, *size = solver->size + d;
        const double most = fmax(fabs(R[i]), fabs(solver->work->wanted[i]));
        const double moved = fabs(slope[0]) * size[0] + fabs(slope[n]) * size[n];
        solver->scale[d] = fmax(solver->scale[d], fmax(most, isfinite(moved) ? moved : 0));
    }
}

static enum rd_status solve(const struct solver *solver, double *R, struct rd_collocated *run)
{
    double best = INFINITY;
    bool factored = false;
    if (!say(solver, R, true))
        return RD_INTERRUPTED;
    measure(solver, R);
    double worst = worst_of(solver);
    for (int k = 0; k < MOST; k++) {
        run->residual = worst;
        if (worst <= ENOUGH || (worst <= LEAST && worst >= best / 2)) {
            grow(solver, R);
            return RD_OK;
        }
        if (k > 0 && worst > FALLS * best && worst > LEAST) {
            if (!say(solver, R, true))
                return RD_INTERRUPTED;
            factored = false;
        }
        best = fmin(best, worst);
        if (!isfinite(worst) || (!factored && !factor(solver)))
            return RD_NO_CONVERGENCE;
        factored = true;
        run->iterations++;
        if (!advance(solver, R, &worst))
            return RD_INTERRUPTED;
    }
    return RD_NO_CONVERGENCE;
}

/* --- steps -------------------------------------------------------------------------------------*/

/* known + seen x */
static void look(const struct rd_collocation *step, const double *known, const double *x,
                 double *point)
{
    const size_t all = 2 * step->stages * step->laws, states = step->laws * 2 * step->modes;
    memcpy(point, known, all * sizeof *point);
    for (size_t k = 0; k < states; k++)
        for (size_t i = 0; i < all; i++)
            point[i] += step->seen[k * all + i] * x[k];
}

static void carry(const struct rd_collocation *step, const double *x, const double *R, double *next)
{
    const size_t m = step->modes, n = step->laws;
    for (size_t d = 0; d < n; d++) {
        const double *q = x + 2 * d * m, *v = q + m, *change = step->change;
        double *to = next + 2 * d * m;
        for (size_t k = 0; k < m; k++) {
            to[k] = change[k] * q[k] + change[m + k] * v[k];
            to[m + k] = change[2 * m + k] * q[k] + change[3 * m + k] * v[k];
        }
        for (size_t j = 0; j < step->stages; j++) {
            const double *push = step->push + 2 * j * m, force = R[j * n + d];
            for (size_t k = 0; k < 2 * m; k++)
                to[k] += push[k] * force;
        }
    }
}

static void guess(const struct rd_collocation *step, const double *before, double *R)
{
    const size_t s = step->stages, n = step->laws;
    for (size_t i = 0; i < s; i++)
        for (size_t d = 0; d < n; d++) {
            double sum = 0;
            for (size_t j = 0; j < s; j++)
                sum += step->ahead[i * s + j] * before[j * n + d];
            R[i * n + d] = sum;
        }
}

enum rd_status rd_collocation_run(const struct rd_collocation *step,
                                  const struct rd_smooth_laws *laws,
                                  const struct rd_collocation_work *work, struct rd_collocated *run)
{
    const size_t s = step->stages, n = step->laws, all = s * n, states = 2 * n * step->modes;
    for (run->made = 0; run->made < run->steps; run->made++) {
        const size_t k = run->made;
        double *point = run->motion + k * 2 * all, *R = run->force + (k + 1) * all;
        const double *x = run->state + k * states;
        look(step, run->known + k * 2 * all, x, point);
        guess(step, run->force + k * all, R);
        const struct solver solver = {
            step, laws, work, point, run->begin[k], run->size, work->tried + all};
        const enum rd_status status = solve(&solver, R, run);
        if (status != RD_OK)
            return status;
        memcpy(point, work->point, 2 * all * sizeof *point);
        carry(step, x, R, run->state + (k + 1) * states);
    }
    return RD_OK;
}
