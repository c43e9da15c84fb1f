/* Forces that depend on the motion of single points. */
#include "law/law.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { NEWTON = 50, SWEEPS = 10000 };

static const double ENOUGH = 16 * DBL_EPSILON;

/* the root t >= 0 of a t + b t^p = y >= 0, a and b >= 0, p >= 1: convex, so that Newton's method
   comes down from where either term alone is y */
static double convex_root(double a, double b, double p, double y)
{
    double t = fmin(y / a, pow(y / b, 1 / p));
    if (!(t > 0) || !isfinite(t))
        return 0;
    for (int i = 0; i < NEWTON; i++) {
        const double power = b * pow(t, p);
        const double step = (a * t + power - y) / (a + p * power / t);
        t -= step;
        if (!(step > DBL_EPSILON * t))
            break;
    }
    return t;
}

/* |x| + C c (|x|/theta)^p = |lean|; below p = 1 for the force y: theta (y/c)^(1/p) + C y = |lean| */
static double power_force(const double *value, double theta, double lean, double C)
{
    const double c = value[0], p = value[1], most = fabs(lean);
    double force;
    if (c == 0)
        return 0;
    if (p == 0)
        force = C > 0 ? fmin(c, most / C) : lean == 0 ? 0 : c;
    else if (p == 1)
        force = c / theta * most / (1 + C * c / theta);
    else if (p > 1)
        force = c * pow(convex_root(theta, C * c, p, most), p);
    else
        force = c * convex_root(C * c, theta, 1 / p, most);
    return -copysign(force, lean);
}

/* With y = side x from the start, contact at y > y0 = gap - side start: none, at once both (a
   dashpot begins with a jump), or F = k (y - y0) + c y/theta */
static double stop_force(const double *value, double theta, double lean, double C, double start)
{
    const double k = value[0], side = value[2], c = value[3] / theta;
    const double first = value[1] - side * start, y = side * lean;
    if (y <= first)
        return 0;
    const double jump = fmax(0, c * first);
    if (y - C * jump <= first)
        return -side * (y - first) / C;
    return -side * fmax(0, (k * (y - first) + c * y) / (1 + C * (k + c)));
}

double rd_law_force(const struct rd_laws *laws, size_t j, double theta, double lean, double C,
                    double start)
{
    const double *value = laws->value + j * RD_LAW_VALUES;
    return laws->kind[j] == RD_POWER ? power_force(value, theta, lean, C)
                                     : stop_force(value, theta, lean, C, start);
}

/* lean of law j beside the forces of all others, and the size of its terms */
static double lean_of(size_t count, size_t j, const double *lean, const double *C,
                      const double *force, double *size)
{
    double sum = lean[j];
    *size = fabs(lean[j]);
    for (size_t k = 0; k < count; k++) {
        const double one = C[j * count + k] * force[k];
        *size += fabs(one);
        if (k != j)
            sum += one;
    }
    return sum;
}

/* one force after another with those before it; the largest change of x, relative */
static double sweep(const struct rd_laws *laws, double theta, const double *lean, const double *C,
                    const double *start, double *force)
{
    const size_t m = laws->ports.count;
    double most = 0;
    for (size_t j = 0; j < m; j++) {
        double size;
        const double alone = lean_of(m, j, lean, C, force, &size);
        if (laws->kind[j] == RD_GIVEN)
            continue;
        const double Cjj = C[j * (m + 1)];
        const double next = rd_law_force(laws, j, theta, alone, Cjj, start[j]);
        const double change = Cjj * fabs(next - force[j]);
        if (change > 0)
            most = fmax(most, change / (size + Cjj * fabs(next)));
        force[j] = next;
    }
    return most;
}

/* x <- A^-1 x, A (n, n) destroyed; false where singular */
static bool eliminate(size_t n, double *A, double *x)
{
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < n; i++)
            p = fabs(A[i * n + k]) > fabs(A[p * n + k]) ? i : p;
        if (!(fabs(A[p * n + k]) > 0))
            return false;
        for (size_t j = 0; j < n; j++) {
            const double kept = A[k * n + j];
            A[k * n + j] = A[p * n + j];
            A[p * n + j] = kept;
        }
        const double kept = x[k];
        x[k] = x[p];
        x[p] = kept;
        for (size_t i = k + 1; i < n; i++) {
            const double factor = A[i * n + k] / A[k * n + k];
            for (size_t j = k + 1; j < n; j++)
                A[i * n + j] -= factor * A[k * n + j];
            x[i] -= factor * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            x[k] -= A[k * n + j] * x[j];
        x[k] /= A[k * n + k];
    }
    return true;
}

/* Force j alone is S_j(lean_j + sum C_jk f_k, k not j), with the slope S_j' in -1/C_jj ... 0, here
   by a difference: Newton's method on f - S(f) with the matrix I - S' (C - diag C). The largest
   change of x, relative, before the step; -1 where it is singular. */
static double newton(const struct rd_laws *laws, double theta, const double *lean, const double *C,
                     const double *start, double *force, double *work)
{
    const size_t m = laws->ports.count;
    double *step = work, *A = work + m, most = 0;
    for (size_t j = 0; j < m; j++) {
        double size, slope = 0;
        const double alone = lean_of(m, j, lean, C, force, &size), Cjj = C[j * (m + 1)];
        step[j] = 0;
        if (laws->kind[j] != RD_GIVEN) {
            const double near = 1e-7 * size;
            const double own = rd_law_force(laws, j, theta, alone, Cjj, start[j]);
            const double beside = rd_law_force(laws, j, theta, alone + near, Cjj, start[j]);
            step[j] = own - force[j];
            slope = near > 0 ? (beside - own) / near : 0;
            const double change = Cjj * fabs(step[j]);
            if (change > 0)
                most = fmax(most, change / (size + Cjj * fabs(own)));
        }
        for (size_t k = 0; k < m; k++)
            A[j * m + k] = k == j ? 1 : -slope * C[j * m + k];
    }
    if (!eliminate(m, A, step))
        return -1;
    for (size_t j = 0; j < m; j++)
        force[j] += laws->kind[j] == RD_GIVEN ? 0 : step[j];
    return most;
}

double rd_laws_solve(const struct rd_laws *laws, double theta, const double *lean, const double *C,
                     const double *start, double *force, double *work)
{
    const size_t m = laws->ports.count;
    double left = sweep(laws, theta, lean, C, start, force);
    if (m < 2)
        return m == 0 || isfinite(force[0]) ? 0 : INFINITY;
    double *kept = work, best = left;
    for (int i = 0; i < NEWTON && left > ENOUGH; i++) {
        memcpy(kept, force, m * sizeof *kept);
        left = newton(laws, theta, lean, C, start, force, work + m);
        if (!(left >= 0 && left <= 2 * best)) {
            memcpy(force, kept, m * sizeof *kept);
            break;
        }
        best = fmin(best, left);
        left = sweep(laws, theta, lean, C, start, force);
    }
    for (int i = 0; i < SWEEPS && !(left <= ENOUGH); i++)
        left = sweep(laws, theta, lean, C, start, force);
    return left;
}
