/* Band matrices of many lines, filled, factored and solved; and of which width what is asked for is. */
#include "base/lapack.h"
#include "space/width.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct filling {
    const struct rd_space_band *band;
    const uint8_t *fixed; /* (size) */
    size_t parts;         /* of a number that are taken: 1, the real one, or 2 */
    double *to;           /* (size, rows), of so many parts */
};

/* where a row stands: blocks of a closed band, but for the last, are folded 0, last, 1, last but one .. */
static size_t place_of(size_t width, size_t size, int closed, size_t row)
{
    const size_t block = row / width, all = size / width - 1;
    if (!closed || block == all)
        return row;
    return (2 * block < all ? 2 * block : 2 * (all - block) - 1) * width + row % width;
}

/* a block or its transpose, or the unit matrix where there is none, at rows and columns from `row` and
   `column` on */
static void put(const struct filling *f, size_t row, size_t column, const double *block, int turned,
                double sign)
{
    const struct rd_space_band *b = f->band;
    const size_t W = b->width, rows = rd_space_rows(W, b->closed), size = (2 * b->parts + 1) * W;
    const size_t diagonal = 2 * rd_space_beside(W, b->closed);
    const size_t first = place_of(W, size, b->closed, row);
    const size_t left = place_of(W, size, b->closed, column);
    for (size_t i = 0; i < W; i++)
        for (size_t j = 0; j < W; j++) {
            if (f->fixed[row + i] || f->fixed[column + j])
                continue;
            const size_t r = first + i, c = left + j;
            double *at = f->to + (c * rows + diagonal + r - c) * f->parts;
            if (block == NULL && i == j)
                at[0] += sign;
            for (size_t k = 0; block != NULL && k < f->parts; k++)
                at[k] += sign * block[b->numbers * (turned ? j * W + i : i * W + j) + k];
        }
}

static void fill(const struct rd_space_band *band, size_t line, size_t taken, double *to)
{
    const size_t W = band->width, own = band->numbers * W * W, parts = band->parts;
    const size_t size = (2 * parts + 1) * W, rows = rd_space_rows(W, band->closed);
    const struct filling f = {band, band->fixed + line * size, taken, to};
    memset(to, 0, size * rows * taken * sizeof *to);
    for (size_t i = 0; i < size; i++) {
        const size_t at = place_of(W, size, band->closed, i);
        to[(at * rows + 2 * rd_space_beside(W, band->closed)) * taken] = f.fixed[i] ? 1 : 0;
    }
    for (size_t p = 0; p <= parts; p++) {
        const size_t u = 2 * p * W, v = u + W, at = (line * parts + p) * own;
        put(&f, u, u, band->N + (line * (parts + 1) + p) * own, 0, 1);
        if (p == parts)
            continue;
        const size_t next = band->closed && p + 1 == parts ? 0 : v + W;
        put(&f, u, u, band->Q + at, 0, 1);
        put(&f, v, u, band->D + at, 0, -1);
        put(&f, v, u, NULL, 0, -1);
        put(&f, u, v, band->D + at, 1, -1);
        put(&f, u, v, NULL, 0, -1);
        put(&f, v, v, band->G + at, 0, -1);
        put(&f, v, next, NULL, 0, 1);
        put(&f, next, v, NULL, 0, 1);
    }
}

size_t rd_space_factor(const struct rd_space_band *band, double *factor, int32_t *pivot)
{
    const size_t size = (2 * band->parts + 1) * band->width;
    const size_t rows = rd_space_rows(band->width, band->closed);
    const lapack_int n = (lapack_int)size;
    const lapack_int beside = (lapack_int)rd_space_beside(band->width, band->closed);
    for (size_t k = 0; k < band->lines; k++) {
        double *own = factor + k * size * rows;
        fill(band, k, 1, own);
        if (LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, beside, beside, own, (lapack_int)rows,
                                pivot + k * size) != 0)
            return k;
    }
    return band->lines;
}

void rd_space_solve(size_t width, int closed, size_t lines, size_t size, size_t columns,
                    const double *factor, const int32_t *pivot, double *x, double *work)
{
    const lapack_int n = (lapack_int)size, m = (lapack_int)columns;
    const lapack_int beside = (lapack_int)rd_space_beside(width, closed);
    const size_t rows = rd_space_rows(width, closed), all = size * columns;
    for (size_t k = 0; k < lines; k++) {
        double *own = x + k * all, *solved = closed ? work : own;
        for (size_t i = 0; closed && i < all; i++)
            work[i / size * size + place_of(width, size, closed, i % size)] = own[i];
        LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', n, beside, beside, m, factor + k * size * rows,
                            (lapack_int)rows, pivot + k * size, solved, n);
        for (size_t i = 0; closed && i < all; i++) {
            const size_t from = i % size < size - width ? i % size : i % size + width - size;
            own[i] = work[i / size * size + place_of(width, size, closed, from)];
        }
    }
}

/* as rd_space_respond, of closed bands */
static enum rd_status respond_closed(const struct rd_space_band *band, size_t columns,
                                     double _Complex *x, struct rd_workspace *workspace)
{
    const size_t W = band->width, size = (2 * band->parts + 1) * W, rows = rd_space_rows(W, 1);
    const lapack_int n = (lapack_int)size, beside = (lapack_int)rd_space_beside(W, 1);
    double _Complex *A = rd_take(workspace, size * rows, sizeof *A);
    double _Complex *work = rd_take(workspace, size, sizeof *work);
    lapack_int *pivot = rd_take(workspace, size, sizeof *pivot);
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    for (size_t k = 0; workspace->base && k < band->lines; k++) {
        fill(band, k, 2, (double *)A);
        const int singular = LAPACKE_zgbtrf_work(LAPACK_COL_MAJOR, n, n, beside, beside, A,
                                                 (lapack_int)rows, pivot) != 0;
        for (size_t c = 0; c < columns; c++) {
            double _Complex *own = x + (k * columns + c) * size;
            for (size_t i = 0; i < size; i++)
                work[place_of(W, size, 1, i)] = own[i];
            LAPACKE_zgbtrs_work(LAPACK_COL_MAJOR, 'N', n, beside, beside, 1, A, (lapack_int)rows,
                                pivot, work, n);
            for (size_t i = 0; i < size; i++) {
                const size_t from = i < size - W ? i : i + W - size;
                own[i] = singular ? NAN : work[place_of(W, size, 1, from)];
            }
        }
    }
    return RD_OK;
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
    if (band->closed)
        return respond_closed(band, columns, x, workspace);
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
