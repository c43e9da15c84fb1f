/* Steps one after another. */
#include "march/run.h"

#include "march/account.h"
#include "march/settle.h"
#include "march/stage.h"

#include <string.h>

enum { LOOK = 1 << 12 }; /* nodes times steps between two questions whether to stop */

/* stage values continued to the end of the step: second order */
static double continued(double g, double first, double second)
{
    return second + g / (1 - 2 * g) * (second - first);
}

/* internal force on the right end of an element at the end of a step, its damping continued */
static double internal_force(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                             double g, double tension)
{
    const size_t w = march->chain->width, node = (size_t)ports->node[k];
    const double *number = rd_joint_number(march, rd_stretch_of(march->chain, node, 0));
    const struct rd_scaled *start = &march->start;
    double sum = 0;
    for (size_t i = 0; i < w; i++) {
        const size_t at = node * w + i;
        double force = start->f[at] +
                       number[RD_JOINT_RATE] * continued(g, march->first.f[at], march->lean.f[at]);
        if (i == march->iz)
            force += number[RD_JOINT_REACH] *
                     ((number[RD_JOINT_STRING] + tension) * (start->u[at + w] - start->u[at]) +
                      number[RD_JOINT_DAMPED] * (start->v[at + w] - start->v[at]));
        sum += ports->force[k * w + i] * (force / march->number->z[i]);
    }
    return sum;
}

/* displacement, velocity, acceleration (3, responses) at the end of a step */
static void report(const struct rd_march *march, const struct rd_ports *ports, double g,
                   double tension, double *read)
{
    const size_t count = ports->count;
    const double theta = march->number->theta;
    for (size_t k = 0; k < count; k++) {
        read[k] = rd_march_read(march, ports, k, march->start.u);
        read[count + k] = rd_march_read(march, ports, k, march->start.v) / theta;
        const double first = rd_march_read(march, ports, k, march->first.v);
        const double second = rd_march_read(march, ports, k, march->lean.v);
        read[2 * count + k] = continued(g, first, second) / theta / theta;
        if (ports->force != NULL)
            read[k] += internal_force(march, ports, k, g, tension);
    }
}

/* one step; its tensions at both stages */
static enum rd_status take_step(struct rd_march *march, struct rd_push *push,
                                struct rd_steps *steps, size_t step, double *tension)
{
    double *energy = steps->energy ? steps->energy + step * RD_ENERGIES : NULL;
    double *taken = steps->taken ? steps->taken + step * march->laws->ports.count : NULL;
    if (energy != NULL)
        energy[RD_INPUT] = energy[RD_DISSIPATED] = 0;
    for (size_t k = 0; taken && k < march->laws->ports.count; k++)
        taken[k] = 0;
    for (int stage = 0; stage < 2; stage++) {
        const size_t row = 2 * step + (size_t)stage;
        const double extra = steps->extra ? steps->extra[row] : march->number->base;
        push->force = steps->force + row * push->drives->count;
        push->speed = steps->speed + row * push->moved;
        rd_march_begin(march, steps->g, stage, push);
        const enum rd_status status = rd_march_settle(march, push, extra, &steps->residual);
        if (status == RD_OK && energy != NULL)
            rd_march_account(march, steps->g, push, extra, energy, taken);
        rd_march_clear(march, push);
        if (status != RD_OK)
            return status;
        tension[stage] = march->number->extra;
        rd_march_take(march, steps->g, stage);
    }
    if (energy != NULL)
        rd_march_energy(march, energy);
    return RD_OK;
}

size_t rd_march_run(struct rd_march *march, const struct rd_push *push,
                    const struct rd_ports *responses, struct rd_steps *steps,
                    const struct rd_stop *stop, enum rd_status *status)
{
    const size_t often = 1 + LOOK / march->chain->nodes;
    struct rd_push now = *push;
    march->refined = steps->refined;
    *status = RD_OK;
    for (size_t step = 0; step < steps->count; step++) {
        double tension[2];
        *status = step % often == 0 && rd_stop_is_asked(stop) ? RD_INTERRUPTED : RD_OK;
        if (*status == RD_OK)
            *status = take_step(march, &now, steps, step, tension);
        if (*status != RD_OK)
            return step;
        report(march, responses, steps->g, continued(steps->g, tension[0], tension[1]),
               steps->read + step * 3 * responses->count);
    }
    return steps->count;
}
