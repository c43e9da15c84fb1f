/* Static deflection of the assembled system by band LU. */
#include "assembled/deflection.h"

#include "base/lapack.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum rd_status rd_deflection_prepare(const struct rd_chain *chain, struct rd_deflection *deflection,
                                     struct rd_workspace *workspace)
{
    const enum rd_status status = rd_system_prepare(chain, &deflection->system, workspace);
    const size_t n = chain->nodes * chain->width;
    const size_t leading = 3 * deflection->system.reach + 1;
    deflection->matrix = rd_take(workspace, n * leading, sizeof *deflection->matrix);
    deflection->load = rd_take(workspace, n, sizeof *deflection->load);
    deflection->work = rd_take(workspace, 3 * n, sizeof *deflection->work);
    deflection->pivot = rd_take(workspace, n, sizeof *deflection->pivot);
    deflection->integers = rd_take(workspace, n, sizeof *deflection->integers);
    return rd_workspace_fits(workspace) ? status : RD_NO_MEMORY;
}

/* LU of the scaled stiffness and its reciprocal condition number */
static enum rd_status factorise(struct rd_deflection *deflection, double *condition)
{
    const struct rd_system *system = &deflection->system;
    const int n = (int)system->free;
    const int reach = (int)system->reach;
    const int leading = 3 * reach + 1;
    const double static_factor[RD_PARTS] = {
        [RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1, [RD_MASS] = 0};
    const struct rd_band band = {
        .matrix = deflection->matrix,
        .stride = 1,
        .leading = (size_t)leading,
        .row = (size_t)(2 * reach),
        .scale = system->scale,
    };
    memset(band.matrix, 0, system->free * band.leading * sizeof *band.matrix);
    rd_band_fill(&system->assembly, static_factor, system->number, &band);
    double norm = 0;
    for (size_t j = 0; j < system->free; j++) {
        double column = 0;
        for (size_t i = 0; i < band.leading; i++)
            column += fabs(band.matrix[j * band.leading + i]);
        norm = fmax(norm, column);
    }
    if (LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, reach, reach, deflection->matrix, leading,
                            deflection->pivot) != 0) {
        *condition = 0;
        return RD_SINGULAR;
    }
    LAPACKE_dgbcon_work(LAPACK_COL_MAJOR, '1', n, reach, reach, deflection->matrix, leading,
                        deflection->pivot, norm, condition, deflection->work, deflection->integers);
    return *condition > DBL_EPSILON ? RD_OK : RD_SINGULAR;
}

enum rd_status rd_deflection_solve(struct rd_deflection *deflection, const double *force,
                                   double *displacement, double *condition)
{
    const struct rd_system *system = &deflection->system;
    const size_t entries = system->assembly.nodes * system->assembly.width;
    *condition = 1;
    if (system->free > 0) {
        const enum rd_status status = factorise(deflection, condition);
        if (status != RD_OK)
            return status;
    }
    for (size_t k = 0; k < entries; k++)
        if (system->number[k] >= 0)
            deflection->load[system->number[k]] = force[k] * system->scale[system->number[k]];
    const int reach = (int)system->reach;
    if (system->free > 0)
        LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', (int)system->free, reach, reach, 1,
                            deflection->matrix, 3 * reach + 1, deflection->pivot, deflection->load,
                            (int)system->free);
    for (size_t k = 0; k < entries; k++) {
        const int32_t i = system->number[k];
        displacement[k] = i < 0 ? 0 : deflection->load[i] * system->scale[i];
    }
    return RD_OK;
}
