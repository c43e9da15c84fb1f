/* A chain made ready for the assembled solvers. */
#include "assembled/system.h"

#include <assert.h>
#include <string.h>

enum rd_status rd_system_prepare(const struct rd_chain *chain, struct rd_system *system,
                                 struct rd_workspace *workspace)
{
    const size_t block = chain->width * chain->width;
    const size_t entries = chain->nodes * chain->width;
    struct rd_assembly *assembly = &system->assembly;
    assembly->elastic.diagonal = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->elastic.coupling = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->string.diagonal = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->string.coupling = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->springs = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->mass = rd_take(workspace, chain->nodes * block, sizeof(double));
    assembly->dashpots = rd_take(workspace, chain->nodes * block, sizeof(double));
    system->number = rd_take(workspace, entries, sizeof *system->number);
    system->scale = rd_take(workspace, entries, sizeof *system->scale);
    system->reach = rd_band_reach(chain);
    system->free = entries;
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    system->free = rd_number_free(chain, system->number);
    const enum rd_status status = rd_assemble(chain, assembly);
    if (status == RD_OK)
        rd_band_scale(assembly, system->number, system->scale);
    return status;
}

void rd_port_load(const struct rd_system *system, const struct rd_ports *ports, size_t p,
                  size_t stride, double *load)
{
    assert(p < ports->count && (size_t)ports->node[p] + 1 < system->assembly.nodes);
    const size_t w = system->assembly.width;
    const int32_t *number = system->number + (size_t)ports->node[p] * w;
    const double *row = ports->row + p * 2 * w;
    memset(load, 0, system->free * stride * sizeof *load);
    for (size_t k = 0; k < 2 * w; k++)
        if (number[k] >= 0)
            load[stride * (size_t)number[k]] += row[k] * system->scale[number[k]];
}

double rd_port_read(const struct rd_system *system, const struct rd_ports *ports, size_t p,
                    size_t stride, const double *u)
{
    assert(p < ports->count && (size_t)ports->node[p] + 1 < system->assembly.nodes);
    const size_t w = system->assembly.width;
    const int32_t *number = system->number + (size_t)ports->node[p] * w;
    const double *row = ports->row + p * 2 * w;
    double sum = 0;
    for (size_t k = 0; k < 2 * w; k++)
        if (number[k] >= 0)
            sum += row[k] * system->scale[number[k]] * u[stride * (size_t)number[k]];
    return sum;
}
