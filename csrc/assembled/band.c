/* Band matrices over the free coordinates of an assembly, as LAPACK stores them. */
#include "assembled/band.h"

#include <assert.h>
#include <math.h>

size_t rd_number_free(const struct rd_chain *chain, int32_t *number)
{
    const size_t w = chain->width;
    int32_t free = 0;
    for (size_t i = 0; i < chain->nodes; i++)
        for (size_t a = 0; a < w; a++) {
            const bool held = chain->held[(size_t)chain->term_of[i] * w + a];
            number[i * w + a] = held ? -1 : free++;
        }
    return (size_t)free;
}

size_t rd_band_reach(const struct rd_chain *chain)
{
    return 2 * chain->width - 1;
}

/* One entry of the assembly over two coordinates of one node or of neighbours. */
struct entry {
    int32_t i, j; /* free numbers, i <= j */
    double part[RD_PARTS];
};

/* entry k of the block of node p with itself; false where it is held or below the diagonal */
static bool diagonal_entry(const struct rd_assembly *assembly, const int32_t *number, size_t p,
                           size_t k, struct entry *entry)
{
    const size_t w = assembly->width;
    const size_t at = p * w * w + k;
    entry->i = number[p * w + k / w];
    entry->j = number[p * w + k % w];
    entry->part[RD_ELASTIC] = assembly->elastic.diagonal[at];
    entry->part[RD_STRING] = assembly->string.diagonal[at];
    entry->part[RD_SPRINGS] = assembly->springs[at];
    entry->part[RD_MASS] = assembly->mass[at];
    entry->part[RD_DASHPOTS] = assembly->dashpots[at];
    return entry->i >= 0 && entry->j >= entry->i;
}

/* entry k of the block of node p with node p + 1; false where it is held */
static bool coupling_entry(const struct rd_assembly *assembly, const int32_t *number, size_t p,
                           size_t k, struct entry *entry)
{
    const size_t w = assembly->width;
    const size_t at = p * w * w + k;
    entry->i = number[p * w + k / w];
    entry->j = number[(p + 1) * w + k % w];
    entry->part[RD_ELASTIC] = assembly->elastic.coupling[at];
    entry->part[RD_STRING] = assembly->string.coupling[at];
    entry->part[RD_SPRINGS] = 0;
    entry->part[RD_MASS] = 0;
    entry->part[RD_DASHPOTS] = 0;
    return entry->i >= 0 && entry->j >= 0;
}

static void store(const struct rd_band *band, const double *factor, const struct entry *entry)
{
    assert(entry->j - entry->i < (int32_t)band->leading);
    const size_t i = (size_t)entry->i;
    const size_t j = (size_t)entry->j;
    double sum = 0;
    for (int p = 0; p < RD_PARTS; p++)
        sum += factor[p] * entry->part[p];
    sum *= band->scale[i] * band->scale[j];
    band->matrix[band->stride * (band->row + j - i + i * band->leading)] = sum;
    if (!band->lower)
        band->matrix[band->stride * (band->row + i - j + j * band->leading)] = sum;
}

void rd_band_fill(const struct rd_assembly *assembly, const double *factor, const int32_t *number,
                  const struct rd_band *band)
{
    const size_t block = assembly->width * assembly->width;
    struct entry entry;
    for (size_t p = 0; p < assembly->nodes; p++)
        for (size_t k = 0; k < block; k++) {
            if (diagonal_entry(assembly, number, p, k, &entry))
                store(band, factor, &entry);
            if (p + 1 < assembly->nodes && coupling_entry(assembly, number, p, k, &entry))
                store(band, factor, &entry);
        }
}

void rd_band_scale(const struct rd_assembly *assembly, const int32_t *number, double *scale)
{
    const size_t w = assembly->width;
    struct entry entry;
    for (size_t p = 0; p < assembly->nodes; p++)
        for (size_t a = 0; a < w; a++) {
            if (!diagonal_entry(assembly, number, p, a * (w + 1), &entry))
                continue;
            const double stiffness = fabs(entry.part[RD_ELASTIC]) + fabs(entry.part[RD_STRING]) +
                                     fabs(entry.part[RD_SPRINGS]);
            const double size = stiffness > 0 ? stiffness : fabs(entry.part[RD_MASS]);
            scale[entry.i] = size > 0 ? 1 / sqrt(size) : 1;
        }
}

/* what one stored entry adds, both triangles */
static double rounding_of(const double *size, const struct entry *entry, const double *x,
                          const double *y)
{
    const size_t i = (size_t)entry->i;
    const size_t j = (size_t)entry->j;
    double sum = 0;
    for (int p = 0; p < RD_PARTS; p++)
        sum += size[p] * fabs(entry->part[p]);
    return sum * (i == j ? x[i] * y[i] : x[i] * y[j] + x[j] * y[i]);
}

double rd_band_rounding(const struct rd_assembly *assembly, const double *size,
                        const int32_t *number, const double *x, const double *y)
{
    const size_t block = assembly->width * assembly->width;
    double sum = 0;
    struct entry entry;
    for (size_t p = 0; p < assembly->nodes; p++)
        for (size_t k = 0; k < block; k++) {
            if (diagonal_entry(assembly, number, p, k, &entry))
                sum += rounding_of(size, &entry, x, y);
            if (p + 1 < assembly->nodes && coupling_entry(assembly, number, p, k, &entry))
                sum += rounding_of(size, &entry, x, y);
        }
    return sum;
}
