/* Energies of a march. */
#include "march/account.h"

#include "march/form/resonator.h"
#include "march/settle.h"

/* The force that holds coordinate i of a node at the stage: what inertia, dampers, springs and the
   elements on both sides need there beyond the loads. */
static double reaction(const struct rd_march *march, size_t node, size_t i)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, ww = w * w, at = node * w;
    const struct rd_scaled *star = &march->star, *lean = &march->lean;
    const size_t stretch = rd_stretch_of(chain, node, 0);
    const double *joint = rd_joint_of(march, stretch), *M = joint + RD_JOINT_MASS * ww;
    const double *C = joint + RD_JOINT_DRAG * ww, *K = joint + RD_JOINT_SPRING * ww;
    const double damped = 1 + march->beside->spring_rate / march->number->theta;
    double force = -march->load[at + i];
    for (size_t j = 0; j < w; j++) {
        const double d = lean->u[at + j];
        force += M[i * w + j] * (d - star->v[at + j]) + C[i * w + j] * d +
                 K[i * w + j] * (star->u[at + j] + damped * d);
    }
    for (size_t side = 0; side < 2; side++) {
        const size_t left = node - 1 + side;
        if ((side == 0 && node == 0) || left + 1 >= chain->nodes)
            continue;
        const size_t span = rd_stretch_of(chain, left, stretch);
        const double *blocks = rd_joint_of(march, span), *number = rd_joint_number(march, span);
        const double r = 1 + number[RD_JOINT_RATE];
        const double *D = blocks + RD_JOINT_D * ww, *Q = blocks + RD_JOINT_Q * ww;
        double end = star->f[left * w + i] + r * lean->f[left * w + i];
        for (size_t j = 0; side == 1 && j < w; j++)
            end += D[j * w + i] * (star->f[left * w + j] + r * lean->f[left * w + j]) -
                   Q[i * w + j] * (star->u[at + j] + r * lean->u[at + j]);
        if (i == march->iz) {
            const double *u = star->u + left * w + i, *d = lean->u + left * w + i;
            const double tension = number[RD_JOINT_STRING] + march->number->extra;
            end += number[RD_JOINT_REACH] * tension * (u[w] - u[0]) +
                   number[RD_JOINT_STIFF] * (d[w] - d[0]);
        }
        force += side == 0 ? end : -end;
    }
    for (size_t k = 0; k < march->laws->ports.count; k++) {
        const struct rd_ports *points = &march->laws->ports;
        const size_t from = (size_t)points->node[k];
        if (node == from || node == from + 1)
            force -= march->force[k] * points->row[(k * 2 + (node - from)) * w + i] *
                     march->number->z[i];
    }
    for (size_t k = 0; k < chain->attached; k++) {
        if (march->carrier[k] != (int32_t)node)
            continue;
        const struct rd_resonator one = rd_resonator_of(march, k);
        force -= one.row[i] * rd_resonator_force(march, &one, k);
    }
    return force;
}

/* forces times what they move in the stage: theta times their power */
static double worked(const struct rd_march *march, const struct rd_push *push, double extra)
{
    const double *u = march->star.u, *d = march->lean.u;
    double sum = 0;
    for (size_t k = 0; k < push->drives->count; k++)
        sum += push->force[k] * rd_march_read(march, push->drives, k, d);
    for (size_t k = 0; k < push->moved; k++) {
        const size_t node = (size_t)push->place[2 * k], i = (size_t)push->place[2 * k + 1];
        sum += reaction(march, node, i) * d[node * march->chain->width + i];
    }
    const double more = extra - march->number->base;
    if (more != 0)
        sum -= 2 * more * (rd_march_lengthening(march, u, d) + rd_march_lengthening(march, d, d));
    return sum;
}

/* h/2 of power is 1/2g times theta of it */
void rd_march_account(const struct rd_march *march, double g, const struct rd_push *push,
                      double extra, double *energy, double *taken)
{
    const double part = 1 / (2 * g);
    double lost = rd_march_kernel_of(march)->dissipate(march);
    for (size_t k = 0; k < march->chain->attached; k++) {
        if (march->carrier[k] < 0)
            continue;
        const struct rd_resonator one = rd_resonator_of(march, k);
        const double open = march->lean.y[k] - rd_resonator_foot(march, &one, k, march->lean.u);
        lost += one.c * open * open + one.drag * march->lean.y[k] * march->lean.y[k];
    }
    energy[RD_INPUT] += part * worked(march, push, extra);
    energy[RD_DISSIPATED] += part * lost;
    for (size_t k = 0; k < march->laws->ports.count; k++)
        taken[k] -=
            part * march->force[k] * rd_march_read(march, &march->laws->ports, k, march->lean.u);
}

void rd_march_energy(const struct rd_march *march, double *energy)
{
    const double *u = march->start.u;
    rd_march_kernel_of(march)->energy(march, energy);
    for (size_t k = 0; k < march->chain->attached; k++) {
        if (march->carrier[k] < 0)
            continue;
        const struct rd_resonator one = rd_resonator_of(march, k);
        const double open = march->start.y[k] - rd_resonator_foot(march, &one, k, u);
        energy[RD_KINETIC] += one.m * march->start.w[k] * march->start.w[k];
        energy[RD_STRAIN] += one.k * open * open;
    }
    if (march->beside->stretching != 0) {
        const double longer = rd_march_lengthening(march, u, u);
        energy[RD_STRAIN] += march->beside->stretching * longer * longer;
    }
    energy[RD_KINETIC] /= 2;
    energy[RD_STRAIN] /= 2;
}
