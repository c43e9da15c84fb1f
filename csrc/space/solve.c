/* Band matrices of many lines, factored and solved. */
#include "base/lapack.h"
#include "space/space.h"

enum { B = RD_SPACE_BAND, ROWS = RD_SPACE_ROWS };

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
