/* Frequency response of the assembled system by complex band LU. */
#include "assembled/frf.h"

#include "base/lapack.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum rd_status rd_frf_prepare(const struct rd_chain *chain, const struct rd_ports *drives,
                              const struct rd_ports *responses, struct rd_frf *frf,
                              struct rd_workspace *workspace)
{
    const enum rd_status status = rd_system_prepare(chain, &frf->system, workspace);
    const size_t n = chain->nodes * chain->width;
    const size_t columns = drives->count + responses->count;
    frf->chain = chain;
    frf->drives = *drives;
    frf->responses = *responses;
    frf->matrix = rd_take(workspace, n * (3 * frf->system.reach + 1), sizeof *frf->matrix);
    frf->solution = rd_take(workspace, n * columns, sizeof *frf->solution);
    frf->adjoint = rd_take(workspace, n, sizeof *frf->adjoint);
    frf->size = rd_take(workspace, n * (columns + 1), sizeof *frf->size);
    frf->pivot = rd_take(workspace, n, sizeof *frf->pivot);
    return rd_workspace_fits(workspace) ? status : RD_NO_MEMORY;
}

/* The elements are assembled again at each frequency, since sections and tension of a tensed element
   are one matrix: what is `elastic` elsewhere is their real part here, `string` the imaginary one.
   part: what of the five makes the real and the imaginary part of D */
static enum rd_status factorise(struct rd_frf *frf, const double _Complex *factor,
                                const struct rd_stop *stop)
{
    const struct rd_system *system = &frf->system;
    const size_t reach = system->reach;
    const size_t leading = 3 * reach + 1;
    const double part[2][RD_PARTS] = {
        {[RD_ELASTIC] = 1,
         [RD_SPRINGS] = creal(factor[RD_SPRINGS]),
         [RD_MASS] = creal(factor[RD_MASS]),
         [RD_DASHPOTS] = creal(factor[RD_DASHPOTS])},
        {[RD_STRING] = 1,
         [RD_SPRINGS] = cimag(factor[RD_SPRINGS]),
         [RD_MASS] = cimag(factor[RD_MASS]),
         [RD_DASHPOTS] = cimag(factor[RD_DASHPOTS])},
    };
    const enum rd_status status = rd_assemble_elements(frf->chain, factor, &frf->system.assembly);
    if (status != RD_OK)
        return status;
    memset(frf->matrix, 0, system->free * leading * sizeof *frf->matrix);
    for (size_t k = 0; k < 2; k++) {
        const struct rd_band band = {
            .matrix = (double *)frf->matrix + k,
            .stride = 2,
            .leading = leading,
            .row = 2 * reach,
            .scale = system->scale,
        };
        rd_band_fill(&system->assembly, part[k], system->number, &band);
    }
    if (rd_stop_is_asked(stop))
        return RD_INTERRUPTED;
    const int n = (int)system->free;
    const int info = LAPACKE_zgbtrf_work(LAPACK_COL_MAJOR, n, n, (int)reach, (int)reach,
                                         frf->matrix, (int)leading, frf->pivot);
    return info == 0 ? RD_OK : RD_SINGULAR;
}

/* columns of D^-1 at unit forces on every drive and every response */
static void solve(struct rd_frf *frf)
{
    const struct rd_system *system = &frf->system;
    const size_t n = system->free;
    const size_t drives = frf->drives.count;
    const size_t columns = drives + frf->responses.count;
    for (size_t c = 0; c < columns; c++) {
        const struct rd_ports *ports = c < drives ? &frf->drives : &frf->responses;
        double *load = (double *)(frf->solution + c * n);
        rd_port_load(system, ports, c < drives ? c : c - drives, 2, load);
    }
    const int reach = (int)system->reach;
    LAPACKE_zgbtrs_work(LAPACK_COL_MAJOR, 'N', (int)n, reach, reach, (int)columns, frf->matrix,
                        3 * reach + 1, frf->pivot, frf->solution, (int)n);
    for (size_t c = 0; c < columns; c++)
        for (size_t i = 0; i < n; i++)
            frf->size[c * n + i] = cabs(frf->solution[c * n + i]) * system->scale[i];
}

/* The entries of D carry relative errors of a few eps; to first order they change
   h = x_r^T D x_d by at most so many times |x_r|^T |D| |x_d|: two bound 99 of 100 random lines. */
static double rounding_of(const struct rd_frf *frf, const double *size, size_t drive,
                          size_t response)
{
    const size_t n = frf->system.free;
    const double *x = frf->size + drive * n;
    const double *y = frf->size + (frf->drives.count + response) * n;
    return 2 * DBL_EPSILON *
           rd_band_rounding(&frf->system.assembly, size, frf->system.number, x, y);
}

/* The same for the size of the whole motion, x^H x in the scaled coordinates: its adjoint is
   y = D^-1 conj(x), so that x^H x changes by at most 2 eps |y|^T |D| |x|. */
static double motion_of(struct rd_frf *frf, const double *size, size_t drive)
{
    const struct rd_system *system = &frf->system;
    const size_t n = system->free;
    const int reach = (int)system->reach;
    const double _Complex *x = frf->solution + drive * n;
    double sum = 0;
    if (n == 0)
        return 0;
    for (size_t i = 0; i < n; i++) {
        frf->adjoint[i] = conj(x[i]);
        sum += creal(x[i] * conj(x[i]));
    }
    LAPACKE_zgbtrs_work(LAPACK_COL_MAJOR, 'N', (int)n, reach, reach, 1, frf->matrix, 3 * reach + 1,
                        frf->pivot, frf->adjoint, (int)n);
    double *y = frf->size + (frf->drives.count + frf->responses.count) * n;
    for (size_t i = 0; i < n; i++)
        y[i] = cabs(frf->adjoint[i]) * system->scale[i];
    const double bound =
        rd_band_rounding(&system->assembly, size, system->number, frf->size + drive * n, y);
    return sum == 0 ? 0 : DBL_EPSILON * bound / sum;
}

enum rd_status rd_frf_solve(struct rd_frf *frf, const double _Complex *factor,
                            const struct rd_stop *stop, double _Complex *value, double *rounding,
                            double *motion)
{
    const enum rd_status status = frf->system.free > 0 ? factorise(frf, factor, stop) : RD_OK;
    if (status != RD_OK)
        return status;
    if (rd_stop_is_asked(stop))
        return RD_INTERRUPTED;
    if (frf->system.free > 0)
        solve(frf);
    const double size[RD_PARTS] = {
        [RD_ELASTIC] = 1,
        [RD_STRING] = 1,
        [RD_SPRINGS] = cabs(factor[RD_SPRINGS]),
        [RD_MASS] = cabs(factor[RD_MASS]),
        [RD_DASHPOTS] = cabs(factor[RD_DASHPOTS]),
    };
    const size_t responses = frf->responses.count;
    for (size_t d = 0; d < frf->drives.count; d++) {
        const double *u = (const double *)(frf->solution + d * frf->system.free);
        if (rd_stop_is_asked(stop))
            return RD_INTERRUPTED;
        motion[d] = motion_of(frf, size, d);
        for (size_t r = 0; r < responses; r++) {
            const double re = rd_port_read(&frf->system, &frf->responses, r, 2, u);
            const double im = rd_port_read(&frf->system, &frf->responses, r, 2, u + 1);
            value[d * responses + r] = CMPLX(re, im);
            rounding[d * responses + r] = rounding_of(frf, size, d, r);
        }
    }
    return RD_OK;
}
