/* What bands do to vectors, and inverse iteration. */
#include "base/fast.h"
#include "space/space.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* numbers of one kind, every so many doubles */
struct strided {
    const double *at;
    size_t every;
};

/* y <- y + sign B x, B (width, width) or turned */
RD_INLINE void block_add(size_t width, struct strided block, int turned, double sign,
                         struct strided x, double *y)
{
    for (size_t i = 0; i < width; i++) {
        double sum = 0;
        for (size_t j = 0; j < width; j++)
            sum += block.at[block.every * (turned ? j * width + i : i * width + j)] *
                   x.at[x.every * j];
        y[x.every * i] += sign * sum;
    }
}

RD_INLINE void plain_add(size_t width, double sign, struct strided x, double *y)
{
    for (size_t i = 0; i < width; i++)
        y[x.every * i] += sign * x.at[x.every * i];
}

/* y <- y + sign A x of the real (part = 0) or the imaginary part of a line's A, fixed rows too */
RD_INLINE void product(const struct rd_space_band *band, size_t width, size_t line, size_t part,
                       double sign, struct strided x, double *y)
{
    const size_t own = width * width, parts = band->parts, each = band->numbers;
    const size_t node = line * (parts + 1) * own, piece = line * parts * own;
    for (size_t p = 0; p <= parts; p++) {
        const size_t at = 2 * p * width, next = at + width;
        const struct strided u = {x.at + x.every * at, x.every};
        double *const to_u = y + x.every * at, *const to_f = y + x.every * next;
        const struct strided N = {band->N + each * (node + p * own) + part, each};
        block_add(width, N, 0, sign, u, to_u);
        if (p == parts)
            continue;
        const size_t place = each * (piece + p * own) + part;
        const struct strided D = {band->D + place, each}, G = {band->G + place, each};
        const struct strided Q = {band->Q + place, each}, f = {x.at + x.every * next, x.every};
        block_add(width, Q, 0, sign, u, to_u);
        block_add(width, D, 1, -sign, f, to_u);
        block_add(width, D, 0, -sign, u, to_f);
        block_add(width, G, 0, -sign, f, to_f);
        if (part == 0) {
            const struct strided right = {f.at + x.every * width, x.every};
            plain_add(width, -sign, f, to_u);
            plain_add(width, -sign, u, to_f);
            plain_add(width, sign, right, to_f);
            plain_add(width, sign, f, to_f + x.every * width);
        }
    }
}

static size_t size_of(const struct rd_space_band *band)
{
    return (2 * band->parts + 1) * band->width;
}

static RD_VECTORS void times(const struct rd_space_band *band, size_t line, size_t part,
                             double sign, struct strided x, double *y)
{
    if (band->width == 3)
        product(band, 3, line, part, sign, x, y);
    else
        product(band, RD_SIX, line, part, sign, x, y);
    /* what the last u of a closed rope asks for the first does */
    for (size_t i = 0, last = size_of(band) - band->width; band->closed && i < band->width; i++) {
        y[x.every * i] += y[x.every * (last + i)];
        y[x.every * (last + i)] = 0;
    }
}

void rd_space_apply(const struct rd_space_band *band, size_t columns, const double _Complex *x,
                    double _Complex *y)
{
    const size_t size = size_of(band);
    assert(band->numbers == 2);
    memset(y, 0, band->lines * columns * size * sizeof *y);
    for (size_t k = 0; k < band->lines * columns; k++) {
        const size_t line = k / columns;
        const double *from = (const double *)(x + k * size);
        double *to = (double *)(y + k * size);
        for (size_t part = 0; part < 2; part++)
            for (size_t of = 0; of < 2; of++)
                times(band, line, part, part && of ? -1 : 1, (struct strided){from + of, 2},
                      to + (part + of) % 2);
        for (size_t i = 0; i < size; i++)
            if (band->fixed[line * size + i])
                y[k * size + i] = 0;
    }
}

static void of_fixed(const struct rd_space_band *band, size_t line, double *y)
{
    const size_t size = size_of(band);
    for (size_t i = 0; i < size; i++)
        y[i] = band->fixed[line * size + i] ? 0 : y[i];
}

/* the part of A x of a real vector */
static void part_of(const struct rd_space_band *band, size_t line, size_t part, const double *x,
                    double *y)
{
    memset(y, 0, size_of(band) * sizeof *y);
    times(band, line, part, 1, (struct strided){x, 1}, y);
    of_fixed(band, line, y);
}

RD_INLINE double dot(size_t n, const double *a, const double *b)
{
    double sum[4] = {0};
    size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (size_t k = 0; k < 4; k++)
            sum[k] += a[i + k] * b[i + k];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Gram and Schmidt, twice; a column of which nothing is left stays 0 */
static RD_VECTORS void orthonormalise(size_t n, size_t columns, double *x)
{
    for (size_t c = 0; c < columns; c++) {
        double *own = x + c * n;
        for (int again = 0; again < 2; again++) {
            for (size_t k = 0; k < c; k++) {
                const double *other = x + k * n, by = dot(n, other, own);
                for (size_t i = 0; i < n; i++)
                    own[i] -= by * other[i];
            }
            const double length = sqrt(dot(n, own, own));
            for (size_t i = 0; length > 0 && i < n; i++)
                own[i] /= length;
        }
    }
}

void rd_space_iterate(const struct rd_space_band *band, size_t columns, const double *factor,
                      const int32_t *pivot, size_t times, double *x, double *form, double *work)
{
    const size_t size = size_of(band), rows = rd_space_rows(band->width, band->closed);
    assert(band->numbers == 2);
    for (size_t line = 0; line < band->lines; line++) {
        double *own = x + line * columns * size;
        orthonormalise(size, columns, own);
        for (size_t i = 0; i < times; i++) {
            for (size_t c = 0; c < columns; c++)
                part_of(band, line, 1, own + c * size, work + c * size);
            rd_space_solve(band->width, band->closed, 1, size, columns, factor + line * size * rows,
                           pivot + line * size, work, work + columns * size);
            memcpy(own, work, columns * size * sizeof *own);
            orthonormalise(size, columns, own);
        }
        for (size_t part = 0; part < 2; part++)
            for (size_t c = 0; c < columns; c++) {
                part_of(band, line, part, own + c * size, work);
                for (size_t k = 0; k < columns; k++)
                    *form++ = dot(size, own + k * size, work);
            }
    }
}
