/* Bands of WIDE coordinates and complex numbers, solved for several lines side by side: included by one
   source file each.

   Gauss with exchanges of rows, each lane its own. Row i has its columns i - BESIDE .. i + 2 BESIDE. */
#include "base/lanes.h"
#include "space/width.h"

#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

enum { BESIDE = 2 * WIDE - 1, ROW = 3 * BESIDE + 1, BLOCK = WIDE * WIDE };

struct solving {
    const struct rd_space_band *band;
    size_t first, here; /* lines side by side; beyond the last it is that once more */
    size_t size, columns;
    lanes *moves; /* (size) 0: fixed, 1 */
    cv *A;        /* (size, ROW) */
    cv *x;        /* (size, columns) */
};

RD_INLINE cv *entry(const struct solving *s, size_t row, size_t column)
{
    return s->A + row * ROW + column + BESIDE - row;
}

RD_INLINE size_t line_of(const struct solving *s, size_t lane)
{
    return s->first + (lane < s->here ? lane : s->here - 1);
}

RD_INLINE cv loaded(const struct solving *s, const double *from, size_t each, size_t at)
{
    cv all = c_zero();
    for (size_t lane = 0; lane < RD_LANES; lane++) {
        const double *own = from + 2 * (line_of(s, lane) * each + at);
        all.re[lane] = own[0];
        all.im[lane] = own[1];
    }
    return all;
}

RD_INLINE void put(const struct solving *s, size_t row, size_t column, cv value)
{
    cv *at = entry(s, row, column);
    *at = c_add(*at, c_scale_lanes(value, s->moves[row] * s->moves[column]));
}

/* at (row, column) and at (column, row), where nothing is */
RD_INLINE void put_both(const struct solving *s, size_t row, size_t column, cv value)
{
    const cv own = c_scale_lanes(value, s->moves[row] * s->moves[column]);
    *entry(s, row, column) = *entry(s, column, row) = own;
}

static RD_CLONES void fill(const struct solving *s)
{
    const struct rd_space_band *b = s->band;
    const size_t each = b->parts * BLOCK;
    memset(s->A, 0, s->size * ROW * sizeof *s->A);
    for (size_t i = 0; i < s->size; i++) {
        for (size_t lane = 0; lane < RD_LANES; lane++)
            s->moves[i][lane] = !b->fixed[line_of(s, lane) * s->size + i];
        entry(s, i, i)->re = 1.0 - s->moves[i];
    }
    for (size_t p = 0; p <= b->parts; p++) {
        const size_t u = 2 * p * WIDE, f = u + WIDE;
        for (size_t i = 0; i < WIDE; i++)
            for (size_t j = 0; j < WIDE; j++) {
                const size_t at = p * BLOCK + i * WIDE + j;
                const cv N = loaded(s, b->N, each + BLOCK, at);
                if (p == b->parts) {
                    put(s, u + i, u + j, N);
                    continue;
                }
                const cv unit = c_real(i == j ? -1 : 0);
                put(s, u + i, u + j, c_add(N, loaded(s, b->Q, each, at)));
                put_both(s, f + i, u + j, c_sub(unit, loaded(s, b->D, each, at)));
                put(s, f + i, f + j, c_neg(loaded(s, b->G, each, at)));
                if (i == j)
                    put_both(s, f + i, f + WIDE + i, c_real(1));
            }
    }
}

RD_INLINE void exchange(cv *a, cv *b, lane_mask m)
{
    const cv x = *a;
    *a = (cv){l_select(m, b->re, x.re), l_select(m, b->im, x.im)};
    *b = (cv){l_select(m, x.re, b->re), l_select(m, x.im, b->im)};
}

/* column k is eliminated from the rows below */
RD_INLINE void eliminate(const struct solving *s, size_t k)
{
    const size_t last = k + BESIDE < s->size ? k + BESIDE : s->size - 1;
    const size_t end = k + 2 * BESIDE < s->size ? k + 2 * BESIDE : s->size - 1, m = s->columns;
    cv *own = entry(s, k, k);
    for (size_t i = k + 1; i <= last; i++) {
        cv *row = entry(s, i, k);
        const lane_mask swap = l_above(c_size(row[0]), c_size(own[0]));
        if (!l_any(swap))
            continue;
        for (size_t j = 0; j <= end - k; j++)
            exchange(own + j, row + j, swap);
        for (size_t j = 0; j < m; j++)
            exchange(s->x + k * m + j, s->x + i * m + j, swap);
    }
    own[0] = c_inverse(own[0]);
    for (size_t i = k + 1; i <= last; i++) {
        cv *row = entry(s, i, k);
        if (c_is_zero(row[0]))
            continue;
        const cv by = c_mul(row[0], own[0]);
        for (size_t j = 1; j <= end - k; j++)
            row[j] = c_sub(row[j], c_mul(by, own[j]));
        for (size_t j = 0; j < m; j++)
            s->x[i * m + j] = c_sub(s->x[i * m + j], c_mul(by, s->x[k * m + j]));
    }
}

static RD_CLONES void solve(const struct solving *s)
{
    const size_t m = s->columns;
    for (size_t k = 0; k < s->size; k++)
        eliminate(s, k);
    for (size_t k = s->size; k-- > 0;) {
        const size_t end = k + 2 * BESIDE < s->size ? k + 2 * BESIDE : s->size - 1;
        const cv *own = entry(s, k, k);
        for (size_t j = 0; j < m; j++) {
            cv sum = s->x[k * m + j];
            for (size_t i = k + 1; i <= end; i++)
                sum = c_sub(sum, c_mul(own[i - k], s->x[i * m + j]));
            s->x[k * m + j] = c_mul(sum, own[0]);
        }
    }
}

static RD_CLONES void unload(const struct solving *s, double _Complex *x)
{
    for (size_t lane = 0; lane < s->here; lane++)
        for (size_t j = 0; j < s->columns; j++)
            for (size_t i = 0; i < s->size; i++) {
                const cv *at = s->x + i * s->columns + j;
                x[((s->first + lane) * s->columns + j) * s->size + i] =
                    CMPLX(at->re[lane], at->im[lane]);
            }
}

enum rd_status RD_SPACE_(respond)(const struct rd_space_band *band, size_t columns,
                                  double _Complex *x, struct rd_workspace *workspace)
{
    struct solving s = {band, 0, 0, (2 * band->parts + 1) * WIDE, columns, NULL, NULL, NULL};
    s.moves = rd_take_aligned(workspace, s.size, sizeof *s.moves, sizeof(lanes));
    s.A = rd_take_aligned(workspace, s.size * ROW, sizeof *s.A, sizeof(lanes));
    s.x = rd_take_aligned(workspace, s.size * columns, sizeof *s.x, sizeof(lanes));
    if (!rd_workspace_fits(workspace))
        return RD_NO_MEMORY;
    for (; workspace->base && s.first < band->lines; s.first += RD_LANES) {
        s.here = band->lines - s.first < RD_LANES ? band->lines - s.first : RD_LANES;
        fill(&s);
        for (size_t i = 0; i < s.size; i++)
            for (size_t j = 0; j < columns; j++)
                s.x[i * columns + j] =
                    loaded(&s, (const double *)x, columns * s.size, j * s.size + i);
        solve(&s);
        unload(&s, x);
    }
    return RD_OK;
}
