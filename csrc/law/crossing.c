/* Between two looks at h a distance w apart, with |h''| <= M,

       h >= min(h_a, h_a + h_a' w/2 - M w^2/8, h_b, h_b - h_b' w/2 - M w^2/8).

   Where that is not above zero Taylor's polynomials may tell: what no wave has reached moves as a high
   power of time, below rounding. Else the interval is divided, so that nothing is overlooked however
   short it is, but for what rounding hides. */
#include "law/crossing.h"

#include <math.h>
#include <string.h>

enum {
    LOOKS = 64,   /* so many intervals are looked at one after another, */
    PARTS = 8,    /* and one is divided into so many                    */
    DEEPEST = 24, /* divisions after which only rounding is left        */
    ORDER = 10,   /* of Taylor's polynomials                            */
    STEPS = 60,   /* of a root, at most                                 */
    ANEW = 8,     /* waves go on by products so often before they are made anew */
};
static const double ROUNDING = 64 * 0x1p-52; /* of the sum of the terms' magnitudes          */
static const double BEGUN = 1e-10; /* of the same: an event is rounded to so much, at most */
static const double SHARE = 0.2;   /* of a guard's size is what bends it between two looks */

/* a guard and its slope at the ends of an interval */
struct ends {
    double *h[2], *v[2];
};

/* intervals of one size */
struct depth {
    double *waves, *step; /* (2, room of rates) */
    double *bend;         /* (guards,) M        */
    struct ends at;
};

struct search {
    struct rd_course value, slope, bend, derived;
    double *floor; /* (guards,) what rounding cannot tell from 0 */
    double *waves; /* (2, room of rates)                         */
    double *size;  /* (2, guards)                                */
    struct depth depth[DEEPEST + 1];
    const struct rd_stop *stop;
};

static void lay_out(const struct rd_course *guards, struct rd_workspace *workspace,
                    struct search *search)
{
    const size_t n = guards->outputs, waves = 2 * rd_course_room(guards->rates);
    search->value = *guards;
    rd_course_take(workspace, guards, &search->slope);
    rd_course_take(workspace, guards, &search->bend);
    rd_course_take(workspace, guards, &search->derived);
    search->floor = rd_take(workspace, n, sizeof(double));
    search->waves = rd_take(workspace, waves, sizeof(double));
    search->size = rd_take(workspace, 2 * n, sizeof(double));
    for (int k = 0; k <= DEEPEST; k++) {
        struct depth *depth = search->depth + k;
        depth->waves = rd_take(workspace, waves, sizeof(double));
        depth->step = rd_take(workspace, waves, sizeof(double));
        depth->bend = rd_take(workspace, n, sizeof(double));
        for (int end = 0; end < 2; end++) {
            depth->at.h[end] = rd_take(workspace, n, sizeof(double));
            depth->at.v[end] = rd_take(workspace, n, sizeof(double));
        }
    }
}

/* --- an interval ------------------------------------------------------------------------------ */

/* what a guard is at least in an interval of this width */
static double above(const struct ends *at, size_t i, double width, double bend)
{
    const double sag = bend * width * width / 8;
    const double left = fmin(at->h[0][i], at->h[0][i] + at->v[0][i] * width / 2 - sag);
    return fmin(left, fmin(at->h[1][i], at->h[1][i] - at->v[1][i] * width / 2 - sag));
}

/* the guard that is the furthest below zero at the end of an interval, or as many as there are */
static size_t lowest(const struct search *search, const double *h)
{
    const size_t n = search->value.outputs;
    size_t which = n;
    double least = 0;
    for (size_t i = 0; i < n; i++)
        if (h[i] + search->floor[i] < least) {
            least = h[i] + search->floor[i];
            which = i;
        }
    return which;
}

/* whether Taylor's polynomials and what they leave out are above zero in an interval */
static bool stays(struct search *search, double first, double width)
{
    const size_t n = search->value.outputs;
    struct rd_course *derived = &search->derived;
    double *least = search->size, *left = search->size + n, share = 1;
    rd_course_waves(&search->value, first, search->waves);
    const struct rd_course *course = &search->value;
    for (int order = 0; order < ORDER; order++) {
        for (size_t i = 0; i < n; i++) {
            const double value = rd_course_value(course, i, search->waves, first);
            least[i] = order == 0 ? value : least[i] + share * fmin(value, 0);
        }
        rd_course_derive(course, derived);
        course = derived;
        share *= width / (order + 1);
    }
    rd_course_size(derived, first, first + width, search->waves, left);
    for (size_t i = 0; i < n; i++)
        if (!(least[i] - share * left[i] >= -search->floor[i]))
            return false;
    return true;
}

/* where a guard that falls throughout is zero, by Newton's method between bounds */
static double root(struct search *search, size_t which, double lo, double hi)
{
    double at = (lo + hi) / 2;
    for (int k = 0; k < STEPS; k++) {
        rd_course_waves(&search->value, at, search->waves);
        const double value = rd_course_value(&search->value, which, search->waves, at);
        *(value > 0 ? &lo : &hi) = at;
        const double newton =
            at - value / rd_course_value(&search->slope, which, search->waves, at);
        const double next = lo < newton && newton < hi ? newton : (lo + hi) / 2;
        const double size = fmax(fabs(at), hi - lo);
        if (fabs(next - at) <= 2 * (nextafter(size, INFINITY) - size) || next == lo || next == hi)
            return next;
        at = next;
    }
    return at;
}

/* whether every guard falls throughout an interval or is certain to stay above zero */
static bool clear(const struct search *search, const struct depth *depth, double width)
{
    const struct ends *at = &depth->at;
    for (size_t i = 0; i < search->value.outputs; i++) {
        const double bend = depth->bend[i];
        const bool falls = fmax(at->v[0][i], at->v[1][i]) < -bend * width / 2;
        if (!falls && !(above(at, i, width, bend) >= -search->floor[i]))
            return false;
    }
    return true;
}

/* the first root of the guards that are below zero at the end of an interval */
static void first_root(struct search *search, const double *h, double lo, double hi,
                       struct rd_crossing *crossing)
{
    for (size_t i = 0; i < search->value.outputs; i++) {
        if (!(h[i] < -search->floor[i]))
            continue;
        const double time = root(search, i, lo, hi);
        if (!crossing->found || time < crossing->time)
            *crossing = (struct rd_crossing){true, time, i};
    }
}

/* --- intervals -------------------------------------------------------------------------------- */

static void look(const struct search *search, const struct depth *depth, double time, int end)
{
    for (size_t i = 0; i < search->value.outputs; i++) {
        depth->at.h[end][i] = rd_course_value(&search->value, i, depth->waves, time);
        depth->at.v[end][i] = rd_course_value(&search->slope, i, depth->waves, time);
    }
}

static void turn(struct ends *at)
{
    double *const h = at->h[0], *const v = at->v[0];
    at->h[0] = at->h[1];
    at->v[0] = at->v[1];
    at->h[1] = h;
    at->v[1] = v;
}

static bool is_safe(const struct search *search, const struct depth *depth, double width)
{
    for (size_t i = 0; i < search->value.outputs; i++)
        if (!(above(&depth->at, i, width, depth->bend[i]) >= -search->floor[i]))
            return false;
    return true;
}

static enum rd_status within(struct search *search, double first, double last, int parts, int deep,
                             struct rd_crossing *crossing);

/* looks closer at an interval that is not safe */
static enum rd_status closer(struct search *search, double lo, double hi, int deep,
                             struct rd_crossing *crossing)
{
    if (rd_stop_is_asked(search->stop))
        return RD_INTERRUPTED;
    const struct depth *depth = search->depth + deep;
    const double middle = (lo + hi) / 2, *h = depth->at.h[1];
    const size_t which = lowest(search, h);
    const bool below = which < search->value.outputs;
    if (deep == DEEPEST || !(lo < middle && middle < hi)) {
        if (below)
            *crossing = (struct rd_crossing){true, hi, which};
        return RD_OK;
    }
    if (!below && stays(search, lo, hi - lo))
        return RD_OK;
    if (!below || !clear(search, depth, hi - lo))
        return within(search, lo, hi, PARTS, deep + 1, crossing);
    first_root(search, h, lo, hi, crossing);
    return RD_OK;
}

/* looks at parts of an interval, in order */
static enum rd_status within(struct search *search, double first, double last, int parts, int deep,
                             struct rd_crossing *crossing)
{
    struct depth *depth = search->depth + deep;
    const struct rd_course *value = &search->value;
    const double width = (last - first) / parts;
    rd_course_size(&search->bend, first, last, search->waves, depth->bend);
    rd_course_waves(value, width, depth->step);
    rd_course_waves(value, first, depth->waves);
    look(search, depth, first, 0);
    enum rd_status status = RD_OK;
    for (int k = 1; k <= parts && status == RD_OK && !crossing->found; k++) {
        const double lo = first + (k - 1) * width, hi = k == parts ? last : first + k * width;
        if (k % ANEW == 0)
            rd_course_waves(value, hi, depth->waves);
        else
            rd_course_later(value, depth->step, depth->waves);
        look(search, depth, hi, 1);
        if (!is_safe(search, depth, width))
            status = closer(search, lo, hi, deep, crossing);
        turn(&depth->at);
    }
    return status;
}

/* up to where looks tell the most, and how many it takes */
static int reach(struct search *search, double first, double end, double *last)
{
    const size_t n = search->value.outputs;
    double *size = search->size, *bend = size + n, least = INFINITY;
    rd_course_size(&search->value, first, first, search->waves, size);
    rd_course_size(&search->bend, first, first, search->waves, bend);
    for (size_t i = 0; i < n; i++)
        if (!(bend[i] == 0 || size[i] / bend[i] >= least))
            least = size[i] / bend[i];
    double width = sqrt(SHARE * least);
    if (!(first + width > first))
        width = (end - first) / LOOKS;
    *last = fmin(first + LOOKS * width, end);
    return *last < end ? LOOKS : (int)fmin(fmax(1, ceil((end - first) / width)), LOOKS);
}

/* what begins a little below zero was zero before rounding, and its slope may have been too */
static enum rd_status begin(struct search *search, const double *scale, double *start)
{
    const size_t n = search->value.outputs;
    double *size = search->size, *bend = size + n;
    rd_course_derive(&search->value, &search->slope);
    rd_course_derive(&search->slope, &search->bend);
    rd_course_size(&search->value, 0, 0, search->waves, size);
    rd_course_size(&search->bend, 0, 0, search->waves, bend);
    rd_course_waves(&search->value, 0, search->waves);
    for (size_t i = 0; i < n; i++) {
        start[i] = rd_course_value(&search->value, i, search->waves, 0);
        const double most = fmax(scale[i], size[i]);
        if (!isfinite(start[i]) || !isfinite(most) || !isfinite(bend[i]))
            return RD_OVERFLOW;
        const bool begun = start[i] < 0 && -start[i] < BEGUN * most;
        search->floor[i] = fmax(ROUNDING * most, begun ? -2 * start[i] : 0);
    }
    return RD_OK;
}

enum rd_status rd_crossing_first(const struct rd_course *guards, const double *scale, double end,
                                 const struct rd_stop *stop, struct rd_workspace *workspace,
                                 struct rd_crossing *crossing)
{
    struct search search = {.stop = stop};
    lay_out(guards, workspace, &search);
    *crossing = (struct rd_crossing){false};
    if (workspace->base == NULL)
        return RD_OK;
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    double *const start = search.depth[0].at.h[0];
    enum rd_status status = begin(&search, scale, start);
    const size_t which = status == RD_OK ? lowest(&search, start) : guards->outputs;
    if (which < guards->outputs)
        *crossing = (struct rd_crossing){true, 0, which};
    for (double first = 0, last; status == RD_OK && !crossing->found && first < end; first = last) {
        const int looks = reach(&search, first, end, &last);
        if (rd_stop_is_asked(stop))
            return RD_INTERRUPTED;
        status = within(&search, first, last, looks, 0, crossing);
    }
    return status;
}
