/* Frequency response of the mixed form by complex band LU. */
#include "mixed/frf.h"

enum rd_status rd_mixed_frf_prepare(const struct rd_chain *chain, const struct rd_ports *drives,
                                    const struct rd_ports *responses, struct rd_mixed_frf *frf,
                                    struct rd_workspace *workspace)
{
    const enum rd_status status = rd_mixed_prepare(chain, &frf->mixed, workspace);
    const size_t n = frf->mixed.size, columns = drives->count + responses->count;
    frf->drives = *drives;
    frf->responses = *responses;
    frf->load = rd_take(workspace, n * columns, sizeof *frf->load);
    frf->solution = rd_take(workspace, n * columns, sizeof *frf->solution);
    frf->scratch = rd_take(workspace, 2 * n, sizeof *frf->scratch);
    frf->spread = rd_take(workspace, n, sizeof *frf->spread);
    return rd_workspace_fits(workspace) ? status : RD_NO_MEMORY;
}

enum rd_status rd_mixed_frf_solve(struct rd_mixed_frf *frf, const double _Complex *factor,
                                  size_t stride, double _Complex *value, double *error)
{
    const size_t n = frf->mixed.size;
    const size_t drives = frf->drives.count, responses = frf->responses.count;
    const enum rd_status status = rd_mixed_factorise(&frf->mixed, factor);
    if (status != RD_OK)
        return status;
    for (size_t d = 0; d < drives; d++)
        rd_mixed_load(&frf->mixed, &frf->drives, d, frf->load + d * n);
    for (size_t r = 0; r < responses; r++)
        rd_mixed_load(&frf->mixed, &frf->responses, r, frf->load + (drives + r) * n);
    rd_mixed_solve(&frf->mixed, drives + responses, frf->load, frf->solution);
    if (rd_stop_is_asked(&frf->mixed.lu.stop))
        return RD_INTERRUPTED;
    for (size_t d = 0; d < drives; d++) {
        const double _Complex *x = frf->solution + d * n;
        rd_mixed_spread(&frf->mixed, x, frf->spread);
        const bool lost = rd_mixed_is_lost(&frf->mixed, x, frf->spread, frf->scratch);
        if (rd_stop_is_asked(&frf->mixed.lu.stop))
            return RD_INTERRUPTED;
        if (lost)
            return RD_SINGULAR;
        for (size_t r = 0; r < responses; r++) {
            const size_t at = stride * (d * responses + r);
            value[at] = rd_mixed_read(&frf->mixed, &frf->responses, r, x);
            error[at] = rd_mixed_error(&frf->mixed, frf->solution + (drives + r) * n, frf->spread);
        }
    }
    return RD_OK;
}
