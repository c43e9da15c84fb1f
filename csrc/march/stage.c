/* One implicit stage: where it begins, its linear answer, its share of the step. */
#include "march/stage.h"

#include "base/fast.h"
#include "march/form/resonator.h"

#include <string.h>

/* y = x + a d */
RD_VECTORS static void advance(size_t count, const double *x, double a, const double *d, double *y)
{
    for (size_t i = 0; i < count; i++)
        y[i] = x[i] + a * d[i];
}

/* y = x - d */
RD_VECTORS static void subtract(size_t count, const double *x, const double *d, double *y)
{
    for (size_t i = 0; i < count; i++)
        y[i] = x[i] - d[i];
}

/* y += a (x + d) */
RD_VECTORS static void gather(size_t count, double a, const double *x, const double *d, double *y)
{
    for (size_t i = 0; i < count; i++)
        y[i] += a * (x[i] + d[i]);
}

/* later = start + (1 - 2g) h k_1, the change of the first stage being g h k_1 */
static void set_out(struct rd_march *march, double g)
{
    const size_t n = march->chain->nodes * march->chain->width, w = march->chain->width;
    const size_t a = march->chain->attached;
    const struct rd_scaled *from = &march->start, *d = &march->first, *to = &march->later;
    const double on = (1 - 2 * g) / g;
    advance(n, from->u, on, d->u, to->u);
    advance(n, from->v, on, d->v, to->v);
    advance(n - w, from->f, on, d->f, to->f);
    advance(a, from->y, on, d->y, to->y);
    advance(a, from->w, on, d->w, to->w);
}

void rd_march_choose(struct rd_march *march, int stage)
{
    march->star = stage == 0 ? march->start : march->later;
    march->lean = stage == 0 ? march->first : march->second;
}

void rd_march_begin(struct rd_march *march, double g, int stage, const struct rd_push *push)
{
    rd_march_choose(march, stage);
    if (stage == 1)
        set_out(march, g);
    for (size_t k = 0; k < push->drives->count; k++)
        rd_march_push(march, push->drives, k, push->force[k], march->load);
}

void rd_march_clear(struct rd_march *march, const struct rd_push *push)
{
    const size_t w = march->chain->width;
    for (size_t k = 0; k < push->drives->count; k++)
        memset(march->load + (size_t)push->drives->node[k] * w, 0, 2 * w * sizeof *march->load);
}

/* A held coordinate at d: with u = u~ + d e and s~ = u~ + f the equations of a node are those of a
   coordinate held at zero with p - (W + I) d, c - (I - U) d and, on the next, c + B d. */
static void move_held(struct rd_march *march, const struct rd_push *push)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, ww = w * w;
    size_t stretch = 0;
    memset(march->kick, 0, chain->nodes * w * sizeof *march->kick);
    memset(march->shift, 0, chain->nodes * w * sizeof *march->shift);
    for (size_t k = 0; k < push->moved; k++) {
        const size_t node = (size_t)push->place[2 * k], i = (size_t)push->place[2 * k + 1];
        const double d = march->number->theta * push->speed[k] / march->number->z[i];
        march->shift[node * w + i] = d;
        stretch = rd_stretch_of(chain, node, stretch);
        const double *joint = rd_joint_of(march, stretch);
        const double *U = march->map + (node * RD_MAP_BLOCKS + RD_MAP_U) * ww;
        for (size_t j = 0; j < w; j++) {
            const size_t at = j * w + i;
            march->p[node * w + j] -= (joint[RD_JOINT_W * ww + at] + (i == j)) * d;
            if (node > 0)
                march->kick[node * w + j] -= ((i == j) - U[at]) * d;
            if (node + 1 < chain->nodes)
                march->kick[(node + 1) * w + j] += joint[RD_JOINT_B * ww + at] * d;
        }
    }
}

/* lean += what its residuals, from the triples themselves, ask for: the rounding of the maps is
   the same in every step and would add up */
static void correct(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    const struct rd_march_kernel *kernel = rd_march_kernel_of(march);
    const size_t n = chain->nodes * chain->width;
    const struct rd_scaled *lean = &march->lean, *more = &march->correction;
    kernel->residual(march);
    for (size_t k = 0; k < chain->attached; k++)
        if (march->carrier[k] >= 0) {
            rd_resonator_follow(march, k);
            rd_resonator_pull(march, k);
        }
    memset(march->shift, 0, n * sizeof *march->shift);
    kernel->solve(march, march->p, true, more->u, more->f);
    advance(n, lean->u, 1, more->u, lean->u);
    advance(n - chain->width, lean->f, 1, more->f, lean->f);
}

void rd_march_lean(struct rd_march *march, const struct rd_push *push)
{
    const struct rd_chain *chain = march->chain;
    const struct rd_march_kernel *kernel = rd_march_kernel_of(march);
    const struct rd_ports *points = &march->laws->ports;
    kernel->rest(march);
    for (size_t k = 0; k < chain->attached; k++)
        if (march->carrier[k] >= 0)
            rd_resonator_load(march, k);
    if (push->moved > 0)
        move_held(march, push);
    kernel->solve(march, march->p, push->moved > 0, march->lean.u, march->lean.f);
    if (march->refined)
        correct(march);
    for (size_t k = 0; k < points->count; k++)
        march->alone[k] = rd_march_read(march, points, k, march->lean.u);
}

void rd_march_points(const struct rd_march *march, double *alone, double *compliance, double *start)
{
    const size_t m = march->laws->ports.count;
    memcpy(alone, march->alone, m * sizeof *alone);
    memcpy(compliance, march->compliance, m * m * sizeof *compliance);
    for (size_t k = 0; k < m; k++)
        start[k] = rd_march_read(march, &march->laws->ports, k, march->star.u);
}

void rd_march_add_laws(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    const size_t n = chain->nodes * chain->width;
    for (size_t k = 0; k < march->laws->ports.count; k++) {
        const double *u = march->column + k * 2 * n, force = march->force[k];
        if (force == 0)
            continue;
        advance(n, march->lean.u, force, u, march->lean.u);
        advance(n - chain->width, march->lean.f, force, u + n, march->lean.f);
    }
    for (size_t k = 0; k < chain->attached; k++) {
        march->lean.y[k] = 0;
        if (march->carrier[k] >= 0)
            rd_resonator_follow(march, k);
    }
}

/* y_1 = y_0 + h/2 (k_1 + k_2), changes being g h k */
void rd_march_take(struct rd_march *march, double g, int stage)
{
    const size_t w = march->chain->width, n = march->chain->nodes * w;
    const size_t a = march->chain->attached;
    const struct rd_scaled *lean = &march->lean, *first = &march->first, *start = &march->start;
    const double part = 1 / (2 * g);
    subtract(n, lean->u, march->star.v, lean->v);
    subtract(a, lean->y, march->star.w, lean->w);
    if (stage == 0)
        return;
    gather(n, part, first->u, lean->u, start->u);
    gather(n, part, first->v, lean->v, start->v);
    gather(n - w, part, first->f, lean->f, start->f);
    gather(a, part, first->y, lean->y, start->y);
    gather(a, part, first->w, lean->w, start->w);
}
