/* Real and imaginary parts lie apart, so that sums take many rates at once. */
#include "law/course.h"

#include <math.h>
#include <string.h>

#include "base/lanes.h"

RD_INLINE lanes load(const double *from)
{
    lanes x;
    memcpy(&x, from, sizeof x);
    return x;
}

size_t rd_course_room(size_t rates)
{
    return (rates + RD_LANES - 1) / RD_LANES * RD_LANES;
}

void rd_course_take(struct rd_workspace *workspace, const struct rd_course *like,
                    struct rd_course *course)
{
    *course = *like;
    const size_t c = 2 * rd_course_room(like->rates), d = 2 * rd_course_room(like->growing);
    course->c = rd_take(workspace, like->outputs * c, sizeof *course->c);
    course->d = rd_take(workspace, like->outputs * d, sizeof *course->d);
    course->a = rd_take(workspace, like->outputs * like->powers, sizeof *course->a);
}

void rd_course_parts(size_t count, size_t n, const double *pairs, double *parts)
{
    const size_t room = rd_course_room(n);
    memset(parts, 0, count * 2 * room * sizeof *parts);
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < n; j++)
            for (size_t part = 0; part < 2; part++)
                parts[(2 * i + part) * room + j] = pairs[2 * (i * n + j) + part];
}

/* x times the rates, both (2, room) */
static void times_rates(const struct rd_course *course, size_t n, size_t room, const double *x,
                        double *product)
{
    const double *re = course->rate, *im = re + rd_course_room(course->rates);
    for (size_t j = 0; j < n; j++) {
        const double real = x[j] * re[j] - x[room + j] * im[j];
        product[room + j] = x[j] * im[j] + x[room + j] * re[j];
        product[j] = real;
    }
    for (size_t j = n; j < room; j++)
        product[j] = product[room + j] = 0;
}

void rd_course_derive(const struct rd_course *course, struct rd_course *to)
{
    const size_t many = rd_course_room(course->rates), some = rd_course_room(course->growing);
    for (size_t i = 0; i < course->outputs; i++) {
        double *c = to->c + i * 2 * many;
        const double *d = course->d + i * 2 * some, *a = course->a + i * course->powers;
        times_rates(course, course->rates, many, course->c + i * 2 * many, c);
        for (size_t j = 0; j < course->growing; j++) {
            c[j] += d[j];
            c[many + j] += d[some + j];
        }
        times_rates(course, course->growing, some, d, to->d + i * 2 * some);
        double *slope = to->a + i * course->powers;
        for (size_t m = 1; m < course->powers; m++)
            slope[m - 1] = (double)m * a[m];
        slope[course->powers - 1] = 0;
    }
}

void rd_course_waves(const struct rd_course *course, double t, double *waves)
{
    const size_t room = rd_course_room(course->rates);
    for (size_t j = 0; j < room; j++) {
        const double size = exp(course->rate[j] * t), angle = course->rate[room + j] * t;
        waves[j] = size * cos(angle);
        waves[room + j] = angle == 0 ? 0 : size * sin(angle);
    }
}

void rd_course_later(const struct rd_course *course, const double *step, double *waves)
{
    const size_t room = rd_course_room(course->rates);
    for (size_t j = 0; j < room; j++) {
        const double re = waves[j], im = waves[room + j];
        waves[j] = re * step[j] - im * step[room + j];
        waves[room + j] = re * step[room + j] + im * step[j];
    }
}

/* Re sum of x times the waves */
RD_CLONES static double summed(size_t room, size_t wide, const double *x, const double *waves)
{
    lanes sum = l_fill(0);
    for (size_t j = 0; j < room; j += RD_LANES)
        sum += load(x + j) * load(waves + j) - load(x + room + j) * load(waves + wide + j);
    double each[RD_LANES], total = 0;
    memcpy(each, &sum, sizeof sum);
    for (int k = 0; k < RD_LANES; k++)
        total += each[k];
    return total;
}

double rd_course_value(const struct rd_course *course, size_t output, const double *waves, double t)
{
    const size_t many = rd_course_room(course->rates), some = rd_course_room(course->growing);
    const double *a = course->a + output * course->powers;
    double polynomial = 0;
    for (size_t m = course->powers; m-- > 0;)
        polynomial = polynomial * t + a[m];
    double value = summed(many, many, course->c + output * 2 * many, waves);
    if (some > 0)
        value += t * summed(some, many, course->d + output * 2 * some, waves);
    return value + polynomial;
}

/* sum of |x| times growth */
static double bounded(size_t n, size_t room, const double *x, const double *growth)
{
    double sum = 0;
    for (size_t j = 0; j < n; j++)
        sum += sqrt(x[j] * x[j] + x[room + j] * x[room + j]) * growth[j];
    return sum;
}

void rd_course_size(const struct rd_course *course, double first, double last, double *growth,
                    double *size)
{
    const size_t many = rd_course_room(course->rates), some = rd_course_room(course->growing);
    for (size_t j = 0; j < course->rates; j++)
        growth[j] = exp(fmax(course->rate[j] * first, course->rate[j] * last));
    for (size_t i = 0; i < course->outputs; i++) {
        const double *a = course->a + i * course->powers;
        double polynomial = 0;
        for (size_t m = course->powers; m-- > 0;)
            polynomial = polynomial * last + fabs(a[m]);
        size[i] = bounded(course->rates, many, course->c + i * 2 * many, growth) + polynomial;
        if (some > 0)
            size[i] += last * bounded(course->growing, some, course->d + i * 2 * some, growth);
    }
}
