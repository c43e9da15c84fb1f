/* Natural frequencies and shapes of the assembled system by LAPACK's dense symmetric solver. */
#include "assembled/modes.h"

#include "base/lapack.h"
#include "chain/inertia.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { ATTEMPTS = 64 };

enum rd_status rd_modes_prepare(const struct rd_chain *chain, size_t columns,
                                struct rd_modes *modes, struct rd_workspace *workspace)
{
    const enum rd_status status = rd_system_prepare(chain, &modes->system, workspace);
    const size_t n = modes->system.free;
    modes->columns = columns < n ? columns : n;
    modes->band = rd_take(workspace, n * (modes->system.reach + 1), sizeof *modes->band);
    modes->matrix = n == 0 ? NULL : rd_take(workspace, n, n * sizeof *modes->matrix);
    modes->value = rd_take(workspace, n, sizeof *modes->value);
    modes->vector = n == 0 ? NULL : rd_take(workspace, modes->columns, n * sizeof *modes->vector);
    modes->size = rd_take(workspace, n, sizeof *modes->size);
    modes->work = rd_take(workspace, n, 128 * sizeof *modes->work);
    modes->integers = rd_take(workspace, n, 10 * sizeof *modes->integers);
    modes->support = rd_take(workspace, n, 2 * sizeof *modes->support);
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    modes->finite = status == RD_OK ? rd_inertia_positive(chain) : 0;
    return status;
}

/* band Cholesky of K + shift M; false where that is not positive definite, or with `safely` where
   it is so only by rounding */
static bool cholesky(struct rd_modes *modes, double shift, bool safely)
{
    const struct rd_system *system = &modes->system;
    const int n = (int)system->free;
    const int reach = (int)system->reach;
    const double factor[RD_PARTS] = {
        [RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1, [RD_MASS] = shift};
    const struct rd_band band = {
        .matrix = modes->band,
        .stride = 1,
        .leading = (size_t)reach + 1,
        .row = 0,
        .lower = true,
        .scale = system->scale,
    };
    memset(band.matrix, 0, system->free * band.leading * sizeof *band.matrix);
    rd_band_fill(&system->assembly, factor, system->number, &band);
    if (LAPACKE_dpbtrf_work(LAPACK_COL_MAJOR, 'L', n, reach, modes->band, reach + 1) != 0)
        return false;
    if (!safely)
        return true;
    /* the scaled stiffness has a norm between 1 and 2 reach + 1 */
    double condition = 0;
    LAPACKE_dpbcon_work(LAPACK_COL_MAJOR, 'L', n, reach, modes->band, reach + 1, 1, &condition,
                        modes->work, modes->integers);
    return condition > 1e3 * DBL_EPSILON;
}

/* M, scaled, as a full matrix: a band with room for every entry */
static void fill_mass(struct rd_modes *modes)
{
    const struct rd_system *system = &modes->system;
    const double factor[RD_PARTS] = {[RD_MASS] = 1};
    const struct rd_band full = {
        .matrix = modes->matrix,
        .stride = 1,
        .leading = system->free + 1,
        .row = 0,
        .scale = system->scale,
    };
    memset(modes->matrix, 0, system->free * system->free * sizeof *modes->matrix);
    rd_band_fill(&system->assembly, factor, system->number, &full);
}

enum rd_status rd_modes_factorise(struct rd_modes *modes, double scale)
{
    modes->shift = 0;
    if (modes->system.free == 0)
        return RD_OK;
    fill_mass(modes);
    if (cholesky(modes, 0, true))
        return RD_OK;
    modes->shift = scale;
    for (int k = 0; k < ATTEMPTS; k++) {
        if (cholesky(modes, modes->shift, false))
            return RD_OK;
        modes->shift *= 4;
    }
    return RD_UNSTABLE_MASSLESS;
}

void rd_modes_reduce(struct rd_modes *modes, size_t start, size_t stop)
{
    const int n = (int)modes->system.free;
    const int reach = (int)modes->system.reach;
    if (n == 0)
        return;
    LAPACKE_dtbtrs_work(LAPACK_COL_MAJOR, 'L', 'N', 'N', n, reach, (int)(stop - start), modes->band,
                        reach + 1, modes->matrix + start * (size_t)n, n);
}

void rd_modes_transpose(struct rd_modes *modes)
{
    const size_t n = modes->system.free;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) {
            const double upper = modes->matrix[i * n + j];
            modes->matrix[i * n + j] = modes->matrix[j * n + i];
            modes->matrix[j * n + i] = upper;
        }
}

enum rd_status rd_modes_solve(struct rd_modes *modes, size_t wanted, double below, size_t *found)
{
    assert(wanted > 0 ? wanted <= modes->columns || modes->columns == modes->system.free
                      : modes->columns == modes->system.free);
    const int n = (int)modes->system.free;
    const int most = (int)(wanted < modes->finite ? wanted : modes->finite);
    *found = 0;
    /* lambda < below is mu > 1/(below + shift); at or under -shift there is nothing */
    const double limit = wanted > 0 ? 1 : 1 / (below + modes->shift);
    if (modes->finite == 0 || !(limit > 0 && limit <= DBL_MAX))
        return RD_OK;
    int count = 0;
    const int info = LAPACKE_dsyevr_work(
        LAPACK_COL_MAJOR, 'V', wanted > 0 ? 'I' : 'V', 'L', n, modes->matrix, n, limit, DBL_MAX,
        wanted > 0 ? n - most + 1 : 1, n, 0, &count, modes->value, modes->vector, n, modes->support,
        modes->work, 128 * n, modes->integers, 10 * n);
    if (info != 0)
        return RD_NO_CONVERGENCE;
    /* below those there are, a tiny mu is a coordinate without mass that rounding moved off 0 */
    *found = (size_t)count < modes->finite ? (size_t)count : modes->finite;
    modes->computed = (size_t)count;
    return RD_OK;
}

/* x^T M x */
static double modal_mass(const struct rd_assembly *assembly, const double *shape)
{
    const size_t w = assembly->width;
    double sum = 0;
    for (size_t p = 0; p < assembly->nodes; p++)
        for (size_t a = 0; a < w; a++)
            for (size_t b = 0; b < w; b++)
                sum += shape[p * w + a] * assembly->mass[(p * w + a) * w + b] * shape[p * w + b];
    return sum;
}

/* Relative errors eps in the entries of K + s M change lambda by at most
   eps |x|^T |K + s M| |x| / x^T M x, and the dense solver errs by eps of the largest mu; where that
   leaves no digit, as far above a very heavy mass, nothing is known. */
static double rounding_of(const struct rd_modes *modes, double eigenvalue, double largest,
                          double mass)
{
    const struct rd_system *system = &modes->system;
    const double size[RD_PARTS] = {
        [RD_ELASTIC] = 1, [RD_STRING] = 1, [RD_SPRINGS] = 1, [RD_MASS] = modes->shift};
    const double entries =
        rd_band_rounding(&system->assembly, size, system->number, modes->size, modes->size);
    const double shifted = eigenvalue + modes->shift;
    const double lost = DBL_EPSILON * shifted * largest;
    return lost < 0.1 ? DBL_EPSILON * entries / fabs(mass) + lost * shifted : INFINITY;
}

void rd_modes_read(struct rd_modes *modes, size_t k, double *eigenvalue, double *rounding,
                   double *shape)
{
    const struct rd_system *system = &modes->system;
    const size_t n = system->free;
    const size_t entries = system->assembly.nodes * system->assembly.width;
    const int reach = (int)system->reach;
    const size_t at = modes->computed - 1 - k; /* mu ascends */
    double *y = modes->vector + at * n;
    LAPACKE_dtbtrs_work(LAPACK_COL_MAJOR, 'L', 'T', 'N', (int)n, reach, 1, modes->band, reach + 1,
                        y, (int)n);
    for (size_t i = 0; i < entries; i++) {
        const int32_t free = system->number[i];
        shape[i] = free < 0 ? 0 : y[free] * system->scale[free];
        if (free >= 0)
            modes->size[free] = fabs(shape[i]);
    }
    *eigenvalue = 1 / modes->value[at] - modes->shift;
    const double mass = modal_mass(&system->assembly, shape);
    *rounding = rounding_of(modes, *eigenvalue, modes->value[modes->computed - 1], mass);
}
