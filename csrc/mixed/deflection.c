/* Static deflection of the mixed form by band LU. */
#include "mixed/deflection.h"

#include <string.h>

enum rd_status rd_mixed_deflection_prepare(const struct rd_chain *chain,
                                           struct rd_mixed_deflection *deflection,
                                           struct rd_workspace *workspace)
{
    const enum rd_status status = rd_mixed_prepare(chain, &deflection->mixed, workspace);
    const size_t n = deflection->mixed.size;
    deflection->load = rd_take(workspace, n, sizeof *deflection->load);
    deflection->solution = rd_take(workspace, n, sizeof *deflection->solution);
    deflection->scratch = rd_take(workspace, 2 * n, sizeof *deflection->scratch);
    deflection->spread = rd_take(workspace, n, sizeof *deflection->spread);
    return rd_workspace_fits(workspace) ? status : RD_NO_MEMORY;
}

static void fill_load(struct rd_mixed_deflection *deflection, const double *load)
{
    const struct rd_mixed *mixed = &deflection->mixed;
    const struct rd_chain *chain = mixed->chain;
    const size_t w = chain->width;
    memset(deflection->load, 0, mixed->size * sizeof *deflection->load);
    for (size_t i = 0; i < chain->nodes; i++)
        for (size_t a = 0; a < w; a++)
            if (!chain->held[(size_t)chain->term_of[i] * w + a])
                deflection->load[mixed->block[i] * w + a] = load[i * w + a] * mixed->z[a];
}

enum rd_status rd_mixed_deflection_solve(struct rd_mixed_deflection *deflection, const double *load,
                                         double *displacement, double *force)
{
    struct rd_mixed *mixed = &deflection->mixed;
    const size_t nodes = mixed->chain->nodes, w = mixed->chain->width;
    const double _Complex at_rest[RD_PARTS] = {[RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1};
    const enum rd_status status = rd_mixed_factorise(mixed, at_rest);
    if (status != RD_OK)
        return status;
    fill_load(deflection, load);
    rd_mixed_solve(mixed, 1, deflection->load, deflection->solution);
    rd_mixed_spread(mixed, deflection->solution, deflection->spread);
    const bool lost =
        rd_mixed_is_lost(mixed, deflection->solution, deflection->spread, deflection->scratch);
    if (rd_stop_is_asked(&mixed->lu.stop))
        return RD_INTERRUPTED;
    if (lost)
        return RD_SINGULAR;
    for (size_t i = 0; i < nodes; i++)
        for (size_t a = 0; a < w; a++) {
            const double _Complex *u = deflection->solution + mixed->block[i] * w;
            displacement[i * w + a] = creal(u[a]) * mixed->z[a];
            if (i > 0)
                force[(i - 1) * w + a] = creal(u[(ptrdiff_t)a - (ptrdiff_t)w]) / mixed->z[a];
        }
    return RD_OK;
}
