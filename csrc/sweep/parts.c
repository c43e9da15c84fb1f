/* Left and right parts and where they meet. */
#include "sweep/parts.h"
#include "closed/lane_trig.h"
#include "sweep/cross.h"
#include "sweep/foot.h"
#include "sweep/plan.h"

#include <float.h>
#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

/* rounding of U, E and the element coefficients, in units of eps sqrt(steps); calibrated by 10^4
   random lines: tests/response/test_rounding_error.py */
static const double ROUNDING = 16.0;

static void listen(struct sweep *s, int way, const struct tap *tap)
{
    s->kernel->listen(&s->walk[way], tap->motion, tap->force, &s->state,
                      s->rows + 2 * tap->rank * s->chain->width);
}

/* A heavy node moves by the small difference of what the parts beside it do: rounding counts for so
   much more there, 1 + |N| z^2 of the watched coordinates. */
static lanes weight(const struct sweep *s, const struct tap *tap)
{
    const size_t w = s->chain->width;
    const lanes spring = c_size(s->block.spring), inertia = c_size(s->block.inertia);
    lanes most = l_fill(1.0);
    for (size_t i = 0; tap->motion && i < w; i++) {
        const size_t at = (tap->term * w + i) * w + i;
        if (tap->motion[i] == 0.0)
            continue;
        lanes N = spring * fabs(s->chain->stiffness[at]) + inertia * fabs(s->chain->mass[at]);
        if (s->chain->damping)
            N += c_size(s->block.dashpot) * fabs(s->chain->damping[at]);
        N += rd_sweep_foot_size(s->chain, s->foot, tap->term, i);
        const lanes own = 1.0 + N * s->block.z[i] * s->block.z[i];
        most = l_select(own > most, own, most);
    }
    return most;
}

/* the largest among all taps of each carried port */
static void weigh(struct sweep *s)
{
    for (size_t port = 0; port < s->carried; port++)
        s->weight[port] = l_fill(1.0);
    for (size_t c = 0; c < s->carry.count; c++) {
        const lanes own = weight(s, s->carry.tap + c);
        lanes *most = s->weight + s->carry.tap[c].port;
        *most = l_select(own > *most, own, *most);
    }
}

/* the left parts at the nodes where parts will meet, with the rows carried so far */
void rd_sweep_left(struct sweep *s)
{
    const size_t w = s->chain->width, size = 2 * s->sym + 2 * s->carried * w;
    size_t c = 0, m = 0, node = 0, run = 0;
    rd_sweep_begin(s);
    weigh(s);
    for (size_t record = 0; record < s->records; record++) {
        const size_t stop = s->meet.tap[m].node;
        for (; c < s->carry.count && s->carry.tap[c].node <= stop; c++) {
            const struct tap *tap = s->carry.tap + c;
            rd_sweep_forward(s, node, tap->node, &run);
            node = tap->node;
            listen(s, 0, tap);
            if (s->state.rows < 2 * (tap->rank + 1))
                s->state.rows = 2 * (tap->rank + 1);
        }
        rd_sweep_forward(s, node, stop, &run);
        node = stop;
        cv *to = s->record + record * size;
        memcpy(to, s->state.U, s->sym * sizeof *to);
        for (size_t i = 0; i < s->sym; i++)
            to[s->sym + i] = (cv){s->state.A[i], (lanes){0}};
        memcpy(to + 2 * s->sym, s->rows, 2 * s->carried * w * sizeof *to);
        while (m < s->meet.count && s->meet.tap[m].node == stop)
            m++;
    }
}

/* row of the result that a meeting port and carried port p make */
static size_t row_of(const struct sweep *s, const struct tap *tap, size_t p, size_t all)
{
    return s->swapped ? p * all + tap->port : tap->port * s->carried + p;
}

static void add(const struct sweep *s, size_t rank, lanes c, double *value, double *error)
{
    for (size_t lane = 0; lane < s->used; lane++) {
        const size_t i = s->index[lane];
        value[2 * i] += s->value[rank].re[lane];
        value[2 * i + 1] += s->value[rank].im[lane];
        error[i] += c[lane] * s->error[rank][lane];
    }
}

/* no digit is left where the estimated relative error of the meeting itself is 1 */
static void fail(struct sweep *s, const lanes *singular, lanes c)
{
    for (size_t lane = 0; lane < s->used; lane++)
        if (!((*singular)[lane] * c[lane] < 1.0) && s->index[lane] < s->failed)
            s->failed = s->index[lane];
}

/* A dislocation lies to the left of its node, whose motion was counted with the left part:
   the node itself moves by the dislocation more. before: carried taps up to the node */
static void dislocate(struct sweep *s, const struct tap *tap, size_t before)
{
    for (size_t c = before; tap->force && c > 0 && s->carry.tap[c - 1].node == tap->node; c--) {
        const struct tap *at = s->carry.tap + c - 1;
        for (size_t i = 0; at->motion && i < s->chain->width; i++)
            s->value[at->rank].re += at->motion[i] * tap->force[i];
    }
}

/* one drive or response meets all carried ports */
static void meet(struct sweep *s, const struct tap *tap, size_t record, size_t before, size_t count,
                 size_t all, double *value, double *error)
{
    const size_t size = 2 * s->sym + 2 * s->carried * s->chain->width;
    const lanes c = ROUNDING * DBL_EPSILON * l_root(s->steps);
    lanes singular;
    s->kernel->meet(&s->walk[1], tap->motion, tap->force, s->record + record * size, &s->state,
                    s->carried, s->value, s->error, &singular);
    dislocate(s, tap, before);
    const lanes heavy = weight(s, tap);
    fail(s, &singular, c);
    for (size_t p = 0; p < s->carried; p++) {
        const size_t at = row_of(s, tap, p, all) * count;
        const lanes most = l_select(heavy > s->weight[p], heavy, s->weight[p]);
        add(s, s->rank[p], c * most, value + 2 * at, error + at);
    }
}

void rd_sweep_right(struct sweep *s, size_t count, size_t all, double *value, double *error)
{
    const size_t w = s->chain->width;
    size_t c = s->carry.count, m = s->meet.count, node = s->chain->nodes - 1;
    size_t run = s->runs.count;
    rd_sweep_begin(s);
    s->state.E = s->rows + 2 * s->carried * w;
    for (size_t record = s->records; record-- > 0;) {
        const size_t stop = s->meet.tap[m - 1].node;
        for (; c > 0 && s->carry.tap[c - 1].node > stop; c--) {
            const struct tap *tap = s->carry.tap + c - 1;
            const size_t begun = (size_t)(s->state.E - s->rows) / (2 * w);
            const size_t from = tap->rank < begun ? tap->rank : begun;
            rd_sweep_backward(s, node, tap->node, &run);
            node = tap->node;
            rd_sweep_absorb(s, 1, node);
            listen(s, 1, tap);
            s->state.E = s->rows + 2 * from * w;
            s->state.rows = 2 * (s->carried - from);
        }
        rd_sweep_backward(s, node, stop, &run);
        node = stop;
        rd_sweep_absorb(s, 1, node);
        for (; m > 0 && s->meet.tap[m - 1].node == stop; m--)
            meet(s, s->meet.tap + m - 1, record, c, count, all, value, error);
    }
}
