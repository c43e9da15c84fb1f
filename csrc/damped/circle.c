/* The roots within a small circle, from moments of f'/f around it. */
#include "damped/circle.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

/* radius in distances to the next root: what lies outside shows as powers of it */
static const double CIRCLE = 0.03;
/* noise in units of the last quarter of a series, where nothing else is left */
static const double NOISE = 5;
/* the mean of the roots and each of them lie within these parts of the radius from the middle */
static const double CENTERED = 0.05, INNER = 0.7;
/* the argument of a value is believed to turn by less from one point to the next */
static const double TURN = 2;

enum { MOST_CIRCLES = 4 };

bool rd_circle_take(size_t roots, struct rd_workspace *workspace, struct rd_circle *c)
{
    const size_t most = RD_CIRCLE_SAMPLES * (roots < RD_POWERS_MOST ? roots : RD_POWERS_MOST);
    c->turn = rd_take(workspace, most, sizeof *c->turn);
    c->s = rd_take(workspace, most, sizeof *c->s);
    c->value = rd_take(workspace, most, sizeof *c->value);
    c->series = rd_take(workspace, most, sizeof *c->series);
    c->slope = rd_take(workspace, most, sizeof *c->slope);
    c->magnitude = rd_take(workspace, most, sizeof *c->magnitude);
    return rd_workspace_fits(workspace);
}

static double _Complex mean(size_t count, const double _Complex *z)
{
    double _Complex sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += z[k];
    return sum / (double)count;
}

static double largest(size_t count, const double _Complex *z)
{
    double most = 0;
    for (size_t k = 0; k < count; k++)
        most = fmax(most, cabs(z[k]));
    return most;
}

/* values on the circle over their largest; the least |value| before and after */
static enum rd_status sample(struct rd_circle *c, struct rd_function *f, size_t samples,
                             double _Complex center, double radius, double *least, double *smallest)
{
    for (size_t i = 0; i < samples; i++)
        c->s[i] = center + radius * c->turn[i];
    const enum rd_status status = rd_function_at(f, samples, c->s, c->value, c->magnitude);
    if (status != RD_OK)
        return status;
    double most = -INFINITY;
    *least = *smallest = INFINITY;
    for (size_t i = 0; i < samples; i++) {
        *least = fmin(*least, cabs(c->value[i]));
        most = fmax(most, c->magnitude[i]);
    }
    for (size_t i = 0; i < samples; i++) {
        c->value[i] *= exp(c->magnitude[i] - most);
        *smallest = fmin(*smallest, cabs(c->value[i]));
    }
    return RD_OK;
}

/* whether the argument turns so often on the way round */
static bool surrounds(const struct rd_circle *c, size_t samples, size_t count)
{
    double turned = 0;
    for (size_t i = 0; i < samples; i++) {
        const double change = carg(c->value[(i + 1) % samples] / c->value[i]);
        if (!(fabs(change) <= TURN))
            return false;
        turned += change;
    }
    return rint(turned / (2 * PI)) == (double)count;
}

/* the function's Taylor series on the unit circle, its slope there times t, and sums of powers
   1 .. count of the roots inside, the means of t^k t f'/f */
static void expand(struct rd_circle *c, size_t samples, size_t count)
{
    for (size_t k = 0; k < samples; k++) {
        double _Complex sum = 0;
        for (size_t i = 0; i < samples; i++)
            sum += c->value[i] * conj(c->turn[i * k % samples]);
        c->series[k] = sum / (double)samples;
    }
    for (size_t i = 0; i < samples; i++) {
        c->slope[i] = 0;
        for (size_t k = 1; k < samples; k++)
            c->slope[i] += (double)k * c->series[k] * c->turn[i * k % samples];
        c->slope[i] /= c->value[i];
    }
    for (size_t k = 1; k <= count; k++) {
        double _Complex sum = 0;
        for (size_t i = 0; i < samples; i++)
            sum += c->turn[i * k % samples] * c->slope[i];
        c->moment[k - 1] = sum / (double)samples;
    }
}

/* rms of the last quarter of the series */
static double tail(const struct rd_circle *c, size_t samples)
{
    double sum = 0;
    for (size_t k = samples - samples / 4; k < samples; k++)
        sum += creal(c->series[k] * conj(c->series[k]));
    return sqrt(sum / (double)(samples / 4));
}

/* How far roots move where all coefficients of their polynomial change by `noise`: each by noise over
   the product of distances d to the others, and never by more than the root of its order. */
static void spread(size_t count, const double _Complex *root, double noise, double *moved)
{
    const double most = pow(noise, 1 / (double)count);
    double before[RD_POWERS_MOST];
    for (size_t i = 0; i < count; i++)
        moved[i] = most;
    for (int round = 0; round < 3; round++) {
        for (size_t i = 0; i < count; i++)
            before[i] = moved[i];
        for (size_t i = 0; i < count; i++) {
            double product = 1;
            for (size_t j = 0; j < count; j++)
                if (j != i)
                    product *= fmax(cabs(root[i] - root[j]), before[i]);
            moved[i] = fmin(before[i], noise / product);
        }
    }
}

enum rd_status rd_circle_settle(struct rd_circle *c, struct rd_function *f, size_t count,
                                double gap, double _Complex *member, double *error, bool *settled)
{
    *settled = false;
    if (count > RD_POWERS_MOST)
        return RD_OK;
    const size_t samples = RD_CIRCLE_SAMPLES * count;
    for (size_t i = 0; i < samples; i++)
        c->turn[i] = cexp(CMPLX(0, 2 * PI * (double)i / (double)samples));
    for (int round = 0; round < MOST_CIRCLES; round++) {
        const double _Complex center = mean(count, member);
        const double radius = CIRCLE * fmin(gap, f->reach - cabs(center));
        double least, smallest;
        const enum rd_status status = sample(c, f, samples, center, radius, &least, &smallest);
        if (status != RD_OK || !surrounds(c, samples, count))
            return status;
        expand(c, samples, count);
        if (rd_powers_invert(count, c->moment, c->offset) != RD_OK)
            return RD_OK;
        for (size_t k = 0; k < count; k++)
            member[k] = center + radius * c->offset[k];
        if (!(cabs(mean(count, c->offset)) < CENTERED && largest(count, c->offset) < INNER))
            continue;
        spread(count, c->offset, fmax(NOISE * tail(c, samples) / smallest, f->rounding / least),
               error);
        for (size_t k = 0; k < count; k++)
            error[k] = radius * error[k] + 2.5 * DBL_EPSILON * cabs(member[k]);
        *settled = true;
        return RD_OK;
    }
    return RD_OK;
}
