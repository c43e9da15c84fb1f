/* The forces and the tension of a stage that depend on its own motion. */
#include "march/settle.h"

#include "march/stage.h"

#include <float.h>
#include <math.h>

enum { TRIALS = 60 };

static const double LAW_ENOUGH = 1e-11;
static const double ENOUGH = 8 * DBL_EPSILON;

double rd_march_lengthening(const struct rd_march *march, const double *u, const double *v)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, iz = march->iz;
    double sum = 0;
    for (size_t k = 0; iz < w && k + 1 < chain->stretches; k++) {
        const double reach = rd_joint_number(march, k)[RD_JOINT_REACH];
        const size_t from = (size_t)chain->first[k], to = (size_t)chain->first[k + 1];
        double part = 0;
        for (size_t n = from; n < to; n++)
            part += (u[(n + 1) * w + iz] - u[n * w + iz]) * (v[(n + 1) * w + iz] - v[n * w + iz]);
        sum += reach * part;
    }
    return sum / 2;
}

/* lean at a tension */
static enum rd_status try_tension(struct rd_march *march, const struct rd_push *push,
                                  double tension, double *residual)
{
    if (tension != march->number->extra) {
        const enum rd_status status = rd_march_tighten(march, tension);
        if (status != RD_OK)
            return status;
    }
    rd_march_lean(march, push);
    const struct rd_laws *laws = march->laws;
    for (size_t k = 0; k < laws->ports.count; k++)
        march->force[k] = 0;
    *residual = 0;
    if (laws->ports.count > 0) {
        double *start = march->law_work;
        for (size_t k = 0; k < laws->ports.count; k++)
            start[k] = rd_march_read(march, &laws->ports, k, march->star.u);
        *residual = rd_laws_solve(laws, march->number->theta, march->alone, march->compliance,
                                  start, march->force, start + laws->ports.count);
    }
    rd_march_add_laws(march);
    return *residual <= LAW_ENOUGH ? RD_OK : RD_NO_CONVERGENCE;
}

/* EA/L times the mean of the lengthening at both ends of the motion u, u + 2 d of which the stage
   is the middle: at g = 1/4 its work is exactly the change of EA/2L lengthening^2 */
static double made_by(const struct rd_march *march)
{
    const double *u = march->star.u, *d = march->lean.u;
    return march->beside->stretching *
           (rd_march_lengthening(march, u, u) +
            2 * (rd_march_lengthening(march, u, d) + rd_march_lengthening(march, d, d)));
}

/* The tension that makes itself, by secants that begin with the slope of the last stage and stay
   between tensions that made more and less. */
enum rd_status rd_march_settle(struct rd_march *march, const struct rd_push *push, double extra,
                               double *residual)
{
    struct rd_march_numbers *number = march->number;
    if (march->beside->stretching == 0)
        return try_tension(march, push, extra, residual);
    double low = -INFINITY, high = INFINITY, last = 0, last_gap = 0, gap = 0;
    double tension = extra + fmax(0, number->made + number->rise);
    for (int i = 0; i < TRIALS; i++) {
        const enum rd_status status = try_tension(march, push, tension, residual);
        if (status != RD_OK)
            return status;
        const double made = made_by(march);
        gap = extra + made - tension;
        if (fabs(gap) <= ENOUGH * (made + fabs(extra))) {
            number->rise = made - number->made;
            number->made = made;
            return RD_OK;
        }
        if (!isfinite(gap))
            break;
        if (gap > 0)
            low = tension;
        else
            high = tension;
        const double slope = (gap - last_gap) / (tension - last);
        if (i > 0 && slope < 0)
            number->slope = slope;
        last = tension;
        last_gap = gap;
        tension -= gap / number->slope;
        if (!(tension > low && tension < high))
            tension = isfinite(low) && isfinite(high) ? low + (high - low) / 2 : last + gap;
        if (tension == last) {
            number->rise = made - number->made;
            number->made = made;
            return RD_OK;
        }
    }
    *residual = fabs(gap) / fmax(fabs(tension), DBL_MIN);
    return RD_NO_CONVERGENCE;
}
