/* One real mode, asked for slopes and energies. */
#include "mode.h"

#include <stdlib.h>

static const int32_t OWN[2] = {0, 0};

const struct rd_pairs MODE_PAIR = {.count = 1, .of = OWN};

struct mode *mode_ask(const struct rd_chain *chain, double lambda, const double *u)
{
    const size_t unit = sizeof(lanes), size = (sizeof(struct mode) + unit - 1) / unit * unit;
    struct mode *mode = aligned_alloc(unit, size);
    mode->lines = (struct rd_lines){
        .count = 1,
        .section = c_real(1),
        .tension = c_real(1),
        .spring = c_real(1),
        .inertia = c_real(-lambda),
        .dashpot = c_zero(),
    };
    mode->fields = (struct rd_fields){.value = u, .loads = 1, .entry = 1, .parts = 1};
    mode->workspace = (struct rd_workspace){0};
    rd_sensitivity_prepare(chain, &mode->fields, &mode->sensitivity, &mode->workspace);
    const size_t used = mode->workspace.used;
    mode->workspace = (struct rd_workspace){.base = malloc(used), .size = used};
    rd_sensitivity_prepare(chain, &mode->fields, &mode->sensitivity, &mode->workspace);
    rd_sensitivity_begin(&mode->sensitivity, &mode->lines);
    return mode;
}

void mode_forget(struct mode *mode)
{
    free(mode->workspace.base);
    free(mode);
}

enum rd_status mode_energy(const struct rd_chain *chain, double lambda, const double *u,
                           double *strain, double *kinetic, double *dragged)
{
    struct mode *mode = mode_ask(chain, lambda, u);
    struct rd_energy energy;
    const enum rd_status status = rd_energy_fill(&mode->sensitivity, &energy);
    for (size_t k = 0; k < RD_STRAINS; k++)
        strain[k] = energy.strain[k][0];
    for (size_t i = 0; i < chain->width; i++)
        kinetic[i] = energy.kinetic[i][0];
    *dragged = energy.dragged[0];
    mode_forget(mode);
    return status;
}
