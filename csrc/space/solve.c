/* Band matrices of many lines, filled, factored and solved. */
#include "base/lapack.h"
#include "space/space.h"

#include <string.h>

enum { B = RD_SPACE_BAND, ROWS = RD_SPACE_ROWS, BLOCK = RD_SIX * RD_SIX };

struct filling {
    size_t numbers;       /* of one entry, 1 or 2 */
    const uint8_t *fixed; /* (size) */
    double *band;         /* (size, ROWS, numbers) */
};

/* a block or its transpose, or the unit matrix where there is none, at rows and columns from `row` and
   `column` on */
static void put(const struct filling *to, size_t row, size_t column, const double *block,
                int turned, double sign)
{
    for (size_t i = 0; i < RD_SIX; i++)
        for (size_t j = 0; j < RD_SIX; j++) {
            if (to->fixed[row + i] || to->fixed[column + j])
                continue;
            const size_t rows = 2 * B + row + i - column - j;
            double *at = to->band + ((column + j) * ROWS + rows) * to->numbers;
            if (block == NULL && i == j)
                at[0] += sign;
            for (size_t c = 0; block != NULL && c < to->numbers; c++)
                at[c] += sign * block[(turned ? j * RD_SIX + i : i * RD_SIX + j) * to->numbers + c];
        }
}

void rd_space_band(size_t lines, size_t parts, size_t numbers, const double *D, const double *G,
                   const double *Q, const double *N, const uint8_t *fixed, double *band)
{
    const size_t size = (2 * parts + 1) * RD_SIX, own = BLOCK * numbers;
    memset(band, 0, lines * size * ROWS * numbers * sizeof *band);
    for (size_t k = 0; k < lines; k++, band += size * ROWS * numbers) {
        const struct filling to = {numbers, fixed, band};
        for (size_t i = 0; i < size; i++)
            band[(i * ROWS + 2 * B) * numbers] = fixed[i] ? 1 : 0;
        for (size_t p = 0; p <= parts; p++) {
            const size_t u = 2 * p * RD_SIX, f = u + RD_SIX, at = (k * parts + p) * own;
            put(&to, u, u, N + (k * (parts + 1) + p) * own, 0, 1);
            if (p == parts)
                continue;
            put(&to, u, u, Q + at, 0, 1);
            put(&to, f, u, D + at, 0, -1);
            put(&to, f, u, NULL, 0, -1);
            put(&to, u, f, D + at, 1, -1);
            put(&to, u, f, NULL, 0, -1);
            put(&to, f, f, G + at, 0, -1);
            put(&to, f, f + RD_SIX, NULL, 0, 1);
            put(&to, f + RD_SIX, f, NULL, 0, 1);
        }
    }
}

size_t rd_space_factor(size_t lines, size_t size, double *band, int32_t *pivot)
{
    const lapack_int n = (lapack_int)size;
    for (size_t k = 0; k < lines; k++)
        if (LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, B, B, band + k * size * ROWS, ROWS,
                                pivot + k * size) != 0)
            return k;
    return lines;
}

size_t rd_space_factor_complex(size_t lines, size_t size, double _Complex *band, int32_t *pivot)
{
    const lapack_int n = (lapack_int)size;
    for (size_t k = 0; k < lines; k++)
        if (LAPACKE_zgbtrf_work(LAPACK_COL_MAJOR, n, n, B, B, band + k * size * ROWS, ROWS,
                                pivot + k * size) != 0)
            return k;
    return lines;
}

void rd_space_solve(size_t lines, size_t size, size_t columns, const double *band,
                    const int32_t *pivot, double *x)
{
    const lapack_int n = (lapack_int)size, m = (lapack_int)columns;
    for (size_t k = 0; k < lines; k++)
        LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', n, B, B, m, band + k * size * ROWS, ROWS,
                            pivot + k * size, x + k * size * columns, n);
}

void rd_space_solve_complex(size_t lines, size_t size, size_t columns, const double _Complex *band,
                            const int32_t *pivot, double _Complex *x)
{
    const lapack_int n = (lapack_int)size, m = (lapack_int)columns;
    for (size_t k = 0; k < lines; k++)
        LAPACKE_zgbtrs_work(LAPACK_COL_MAJOR, 'N', n, B, B, m, band + k * size * ROWS, ROWS,
                            pivot + k * size, x + k * size * columns, n);
}
