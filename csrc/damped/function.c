/* The characteristic function of a chain at rates s of damped motion. */
#include "damped/function.h"

#include "base/lanes.h"
#include "sweep/characteristic.h"

#include <float.h>
#include <math.h>

static const double ROUNDING = 2.5; /* of a value, in units of eps sqrt(steps) */

/* whether any part of what nodes of the chain carry has damping of its own */
static bool resists(const struct rd_chain *chain, enum rd_attached_kind kind)
{
    for (size_t k = 0; k < chain->stretches; k++) {
        const int32_t term = chain->term[k];
        for (size_t i = rd_attached_first(chain, (size_t)term); rd_attached_is_of(chain, i, term);
             i++)
            if (chain->attached_kind[i] == (int32_t)kind &&
                chain->attached_value[i * RD_ATTACHED_VALUES + 3] != 0)
                return true;
    }
    return false;
}

/* a complex modulus is that of a wire, whose rest depends on s^2 (chain/attached.h) */
static enum rd_mirror mirror_of(const struct rd_chain *chain, const struct rd_damping *damping)
{
    bool real = !resists(chain, RD_WIRE);
    bool even = !rd_chain_is_dragged(chain) && !resists(chain, RD_RESONATOR);
    for (int p = 0; p < RD_PARTS; p++) {
        real = real && cimag(damping->constant[p]) == 0 && cimag(damping->linear[p]) == 0;
        even = even && (p == RD_DASHPOTS || damping->linear[p] == 0);
    }
    return real ? RD_CONJUGATE : even ? RD_OPPOSITE : RD_NO_MIRROR;
}

/* the five factors of up to RD_LANES rates */
struct table {
    double _Complex factor[RD_PARTS][RD_LANES];
};

static struct rd_factors view(const struct table *t, size_t count)
{
    return (struct rd_factors){
        .count = count,
        .section = (const double *)t->factor[RD_ELASTIC],
        .tension = (const double *)t->factor[RD_STRING],
        .spring = (const double *)t->factor[RD_SPRINGS],
        .inertia = (const double *)t->factor[RD_MASS],
        .dashpot = (const double *)t->factor[RD_DASHPOTS],
    };
}

/* the least |section| and the largest of the others where |s| <= reach */
static struct table bound_of(const struct rd_damping *damping, double reach)
{
    struct table t;
    for (int p = 0; p < RD_PARTS; p++)
        t.factor[p][0] = cabs(damping->constant[p]) + cabs(damping->linear[p]) * reach;
    t.factor[RD_MASS][0] += reach * reach;
    t.factor[RD_ELASTIC][0] =
        cabs(damping->constant[RD_ELASTIC]) - cabs(damping->linear[RD_ELASTIC]) * reach;
    return t;
}

static struct sweep_extent extent_of(const struct table *t)
{
    const struct rd_factors factors = view(t, 1);
    return rd_sweep_extent(&factors, 0);
}

bool rd_function_take(const struct rd_chain *chain, const struct rd_damping *damping,
                      struct rd_stop stop, double reach, struct rd_workspace *workspace,
                      struct rd_function *f)
{
    const struct table most = bound_of(damping, reach);
    const struct rd_factors bound = view(&most, 1);
    const struct sweep_extent extent = extent_of(&most);
    const size_t steps = rd_sweep_steps(chain, &extent);
    *f = (struct rd_function){
        .chain = chain,
        .damping = *damping,
        .stop = stop,
        .reach = reach,
        .rounding = ROUNDING * DBL_EPSILON * sqrt((double)steps),
        .steps = steps,
        .mirror = mirror_of(chain, damping),
        .of = rd_characteristic_take(chain, &bound, workspace),
    };
    return f->of != NULL;
}

static enum rd_status ask(struct rd_function *f, size_t count, const double _Complex *s,
                          double _Complex *value, double *magnitude)
{
    struct table t;
    for (int p = 0; p < RD_PARTS; p++)
        for (size_t i = 0; i < count; i++)
            t.factor[p][i] = f->damping.constant[p] + f->damping.linear[p] * s[i];
    for (size_t i = 0; i < count; i++)
        t.factor[RD_MASS][i] += s[i] * s[i];
    const struct rd_factors factors = view(&t, count);
    f->sweeps += count;
    return rd_characteristic_at(f->of, &factors, (double *)value, magnitude);
}

enum rd_status rd_function_at(struct rd_function *f, size_t count, const double _Complex *s,
                              double _Complex *value, double *magnitude)
{
    enum rd_status status = RD_OK;
    for (size_t first = 0; first < count && status == RD_OK; first += RD_LANES) {
        const size_t some = count - first < RD_LANES ? count - first : RD_LANES;
        if (rd_stop_is_asked(&f->stop))
            return RD_INTERRUPTED;
        status = ask(f, some, s + first, value + first, magnitude + first);
    }
    return status;
}

double rd_function_turning(const struct rd_function *f, double radius)
{
    const struct table most = bound_of(&f->damping, radius);
    const struct sweep_extent extent = extent_of(&most);
    return rd_sweep_turning(f->chain, &extent);
}
