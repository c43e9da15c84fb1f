/* Band matrices of many lines, filled, factored and solved; and of which width what is asked for is. */
#include "base/lapack.h"
#include "space/width.h"

#include <assert.h>
#include <string.h>

struct filling {
    const struct rd_space_band *band;
    const uint8_t *fixed; /* (size) */
    double *to;           /* (size, rows) */
};

/* a block or its transpose, or the unit matrix where there is none, at rows and columns from `row` and
   `column` on */
static void put(const struct filling *f, size_t row, size_t column, const double *block, int turned,
                double sign)
{
    const size_t W = f->band->width, rows = rd_space_rows(W), diagonal = 2 * rd_space_beside(W);
    for (size_t i = 0; i < W; i++)
        for (size_t j = 0; j < W; j++) {
            if (f->fixed[row + i] || f->fixed[column + j])
                continue;
            double *at = f->to + (column + j) * rows + diagonal + row + i - column - j;
            if (block == NULL && i == j)
                *at += sign;
            if (block != NULL)
                *at += sign * block[f->band->numbers * (turned ? j * W + i : i * W + j)];
        }
}

static void fill(const struct rd_space_band *band, size_t line, double *to)
{
    const size_t W = band->width, own = band->numbers * W * W, parts = band->parts;
    const size_t size = (2 * parts + 1) * W;
    const size_t rows = rd_space_rows(W);
    const struct filling f = {band, band->fixed + line * size, to};
    memset(to, 0, size * rows * sizeof *to);
    for (size_t i = 0; i < size; i++)
        to[i * rows + 2 * rd_space_beside(W)] = f.fixed[i] ? 1 : 0;
    for (size_t p = 0; p <= parts; p++) {
        const size_t u = 2 * p * W, v = u + W, at = (line * parts + p) * own;
        put(&f, u, u, band->N + (line * (parts + 1) + p) * own, 0, 1);
        if (p == parts)
            continue;
        put(&f, u, u, band->Q + at, 0, 1);
        put(&f, v, u, band->D + at, 0, -1);
        put(&f, v, u, NULL, 0, -1);
        put(&f, u, v, band->D + at, 1, -1);
        put(&f, u, v, NULL, 0, -1);
        put(&f, v, v, band->G + at, 0, -1);
        put(&f, v, v + W, NULL, 0, 1);
        put(&f, v + W, v, NULL, 0, 1);
    }
}

size_t rd_space_factor(const struct rd_space_band *band, double *factor, int32_t *pivot)
{
    const size_t size = (2 * band->parts + 1) * band->width, rows = rd_space_rows(band->width);
    const lapack_int n = (lapack_int)size, beside = (lapack_int)rd_space_beside(band->width);
    for (size_t k = 0; k < band->lines; k++) {
        double *own = factor + k * size * rows;
        fill(band, k, own);
        if (LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, beside, beside, own, (lapack_int)rows,
                                pivot + k * size) != 0)
            return k;
    }
    return band->lines;
}

void rd_space_solve(size_t width, size_t lines, size_t size, size_t columns, const double *factor,
                    const int32_t *pivot, double *x)
{
    const lapack_int n = (lapack_int)size, m = (lapack_int)columns;
    const lapack_int beside = (lapack_int)rd_space_beside(width);
    const size_t rows = rd_space_rows(width);
    for (size_t k = 0; k < lines; k++)
        LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', n, beside, beside, m, factor + k * size * rows,
                            (lapack_int)rows, pivot + k * size, x + k * size * columns, n);
}

enum rd_status rd_space_triples(const struct rd_space_run *run, size_t lines,
                                const double _Complex *rates, int doublings, double gentle,
                                double _Complex *triple, int *reached, int *whole,
                                struct rd_workspace *workspace)
{
    assert(run->width == 3 || run->width == RD_SIX);
    rd_space_triples_of *const own = run->width == 3 ? rd_space_triples_3 : rd_space_triples_6;
    return own(run, lines, rates, doublings, gentle, triple, reached, whole, workspace);
}

enum rd_status rd_space_respond(const struct rd_space_band *band, size_t columns,
                                double _Complex *x, struct rd_workspace *workspace)
{
    assert((band->width == 3 || band->width == RD_SIX) && band->numbers == 2);
    rd_space_respond_of *const own = band->width == 3 ? rd_space_respond_3 : rd_space_respond_6;
    return own(band, columns, x, workspace);
}

enum rd_status rd_space_count(const struct rd_space *rope, size_t count, const int32_t *component,
                              const double *lambda, const double *z, double *below,
                              struct rd_workspace *workspace)
{
    assert(rope->width == 3 || rope->width == RD_SIX);
    rd_space_count_of *const own = rope->width == 3 ? rd_space_count_3 : rd_space_count_6;
    return own(rope, count, component, lambda, z, below, workspace);
}
