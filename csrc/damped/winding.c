/* How many roots a circle surrounds, by the argument principle.

   The argument of the function turns 2 pi times the number of roots on the way round. The walk
   begins with arcs along which waves on the rope turn by a radian or so. Each is halved until its
   two halves turn as much as the whole does, and the logarithm changes little along both: what
   turns once more in between would show in one of them. */
#include "damped/winding.h"

#include "base/lanes.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

enum {
    FIRST = 16, /* half a circle begins with so many arcs at least */
    MOST_HALVINGS = 40,
    MOST_ARCS = 10000, /* more arcs beside the first ones are those that rounding makes */
    OPEN = 16 * (MOST_HALVINGS + 1), /* halves that wait: those of a block at each depth */
};

static const double LARGEST =
    0.8; /* a change of the logarithm along half an arc is believed below */
static const double CLEAR = 1.6e3; /* a value so many times its rounding has a known argument */
static const double RADIANS = 1.2; /* that an arc turns it by at first, or less */
static const double MOST_FIRST = 1e9;

struct point {
    double angle, magnitude;
    double _Complex value;
};

struct rd_arc {
    struct point end[2];
    int halvings;
};

/* How many radians structures alone turn the function by on half a circle, and more: as many times
   pi as they have modes there with their feet held: a resonator one, a broken wire x/pi where
   x^4 = m radius^2/k (chain/attached.h). */
static double turning(const struct rd_chain *chain, double radius)
{
    double sum = 0;
    for (size_t k = 0; k < chain->attached; k++) {
        const double *value = chain->attached_value + k * RD_ATTACHED_VALUES;
        const double x = sqrt(sqrt(radius * radius * value[0] / value[1]));
        sum += ceil(2 * PI * (1 + x / PI));
    }
    return sum;
}

enum rd_status rd_winding_take(const struct rd_function *f, double middle, double radius,
                               struct rd_workspace *workspace, struct rd_winding *w)
{
    /* waves turn the function twice as far between s and -s */
    double arcs = 2 * (double)f->chain->width * rd_function_turning(f, middle + radius) / RADIANS;
    arcs = ceil(fmax(FIRST, arcs)) + turning(f->chain, middle + radius);
    if (!(arcs < MOST_FIRST))
        return RD_SHORT_WAVES;
    const size_t begin = (size_t)arcs * (f->mirror == RD_NO_MIRROR ? 2 : 1);
    const size_t most = 4 * begin + 2 * MOST_ARCS;
    *w = (struct rd_winding){
        .middle = middle,
        .radius = radius,
        .mirror = f->mirror,
        .begin = begin,
        .most = most,
        .end = rd_take(workspace, 2 * most, sizeof *w->end),
        .change = rd_take(workspace, most, sizeof *w->change),
        .arc = rd_take(workspace, begin + OPEN, sizeof *w->arc),
    };
    return rd_workspace_fits(workspace) ? RD_OK : RD_NO_MEMORY;
}

/* values at so many angles, RD_LANES at most */
static enum rd_status ask(struct rd_function *f, const struct rd_winding *w, size_t count,
                          struct point *point, bool *clear)
{
    double _Complex s[RD_LANES] = {0}, value[RD_LANES];
    double magnitude[RD_LANES];
    for (size_t i = 0; i < count; i++)
        s[i] = w->middle + w->radius * cexp(CMPLX(0, point[i].angle));
    const enum rd_status status = rd_function_at(f, count, s, value, magnitude);
    for (size_t i = 0; status == RD_OK && i < count; i++) {
        point[i].value = value[i];
        point[i].magnitude = magnitude[i];
        *clear = *clear && cabs(value[i]) > CLEAR * f->rounding;
    }
    return status;
}

/* the arcs that the walk begins with, the first one last */
static enum rd_status begin(struct rd_function *f, struct rd_winding *w, bool *clear)
{
    const double whole = w->mirror == RD_NO_MIRROR ? 2 * PI : PI;
    const size_t n = w->begin;
    for (size_t first = 0; first <= n; first += RD_LANES) {
        struct point point[RD_LANES];
        const size_t count = n + 1 - first < RD_LANES ? n + 1 - first : RD_LANES;
        for (size_t i = 0; i < count; i++)
            point[i].angle = whole * (double)(first + i) / (double)n;
        const enum rd_status status = ask(f, w, count, point, clear);
        if (status != RD_OK || !*clear)
            return status;
        for (size_t i = 0, k = first; i < count; i++, k++) {
            if (k < n)
                w->arc[n - 1 - k] = (struct rd_arc){.end[0] = point[i]};
            if (k > 0)
                w->arc[n - k].end[1] = point[i];
        }
    }
    return RD_OK;
}

/* change of the logarithm, its imaginary part within -pi .. pi */
static double _Complex change(const struct point *from, const struct point *to)
{
    return clog(to->value / from->value) + (to->magnitude - from->magnitude);
}

static void close_half(struct rd_winding *w, const struct point *from, const struct point *to,
                       double _Complex turned)
{
    w->end[2 * w->arcs] = from->angle;
    w->end[2 * w->arcs + 1] = to->angle;
    w->change[w->arcs++] = turned;
}

/* Up to RD_LANES arcs of `open` are halved; what is not known of them is open again. False where too
   many are. */
static bool halve(struct rd_winding *w, const struct rd_arc *arc, const struct point *middle,
                  size_t count, size_t *open)
{
    for (size_t i = count; i-- > 0;) {
        const struct point *from = arc[i].end, *to = from + 1, *at = middle + i;
        const double _Complex first = change(from, at), second = change(at, to);
        const double apart = cabs(first + second - change(from, to));
        if (fmax(cabs(first), cabs(second)) < LARGEST && apart < 1) {
            if (w->arcs + 2 > w->most)
                return false;
            close_half(w, from, at, first);
            close_half(w, at, to, second);
            continue;
        }
        if (arc[i].halvings + 1 >= MOST_HALVINGS || *open + 2 > w->begin + OPEN)
            return false;
        w->arc[(*open)++] = (struct rd_arc){{*at, *to}, arc[i].halvings + 1};
        w->arc[(*open)++] = (struct rd_arc){{*from, *at}, arc[i].halvings + 1};
    }
    return true;
}

enum rd_status rd_winding_walk(struct rd_function *f, struct rd_winding *w, bool *known)
{
    bool clear = true;
    enum rd_status status = begin(f, w, &clear);
    size_t open = w->begin;
    w->arcs = 0;
    *known = false;
    while (status == RD_OK && clear && open > 0) {
        struct rd_arc arc[RD_LANES];
        struct point middle[RD_LANES];
        const size_t count = open < RD_LANES ? open : RD_LANES;
        open -= count;
        for (size_t i = 0; i < count; i++) {
            arc[i] = w->arc[open + i];
            middle[i].angle = (arc[i].end[0].angle + arc[i].end[1].angle) / 2;
        }
        status = ask(f, w, count, middle, &clear);
        if (status == RD_OK && !halve(w, arc, middle, count, &open))
            return RD_OK;
    }
    if (status != RD_OK || !clear)
        return status;
    double turned = 0;
    for (size_t i = 0; i < w->arcs; i++)
        turned += cimag(w->change[i]);
    turned /= w->mirror == RD_NO_MIRROR ? 2 * PI : PI;
    *known = fabs(turned - rint(turned)) <= 1e-3 && turned > -0.5;
    w->count = *known ? (size_t)rint(turned) : 0;
    return RD_OK;
}

/* With the factors s - s_j of the known roots taken out little is left that changes along an arc:
   2 pi i sum s^k is the integral of s^k over the change of the logarithm. The other half of a circle
   has minus its conjugate there, or (-1)^k times it. */
void rd_winding_moments(const struct rd_winding *w, size_t count, const double _Complex *known,
                        size_t number, double _Complex *moment)
{
    for (size_t k = 0; k < number; k++)
        moment[k] = 0;
    for (size_t i = 0; i < w->arcs; i++) {
        const double _Complex from = cexp(CMPLX(0, w->end[2 * i]));
        const double _Complex to = cexp(CMPLX(0, w->end[2 * i + 1]));
        double _Complex left = w->change[i], first = 1, last = 1;
        for (size_t j = 0; j < count; j++) {
            const double _Complex at = (known[j] - w->middle) / w->radius;
            left -= clog((to - at) / (from - at));
        }
        for (size_t k = 0; k < number; k++) {
            first *= from;
            last *= to;
            moment[k] += left * (first + last) / 2;
        }
    }
    for (size_t k = 0; k < number; k++) {
        if (w->mirror == RD_CONJUGATE)
            moment[k] = cimag(moment[k]) / PI;
        else if (w->mirror == RD_OPPOSITE)
            moment[k] = k % 2 == 0 ? 0 : moment[k] / CMPLX(0, PI);
        else
            moment[k] /= CMPLX(0, 2 * PI);
    }
}
