/* Band matrices over the free coordinates of an assembly, as LAPACK stores them. */
#ifndef RD_BAND_H
#define RD_BAND_H

#include "assembled/assemble.h"

#include <stdbool.h>

/* Numbers the coordinates that are not held, node by node: number (nodes, width), -1 where held.
   Returns how many are free. */
size_t rd_number_free(const struct rd_chain *chain, int32_t *number);

/* Where a matrix over the free coordinates is stored: column by column, entry (i, j) at
   matrix[stride (row + i - j + j leading)]; every entry within `reach` of the diagonal, or only
   the lower triangle. Rows and columns are multiplied by scale. */
struct rd_band {
    double *matrix;
    size_t stride;       /* 1 for real, 2 for the real or imaginary parts of complex */
    size_t leading;      /* entries of a column */
    size_t row;          /* of the diagonal */
    bool lower;          /* only i >= j */
    const double *scale; /* (free) */
};

/* the largest |i - j| of two free coordinates that meet */
size_t rd_band_reach(const struct rd_chain *chain);

/* band <- sum of factor[part] times part; what is not stored is left as it was */
void rd_band_fill(const struct rd_assembly *assembly, const double *factor, const int32_t *number,
                  const struct rd_band *band);

/* scale (free): 1/sqrt of the stiffness on the diagonal (of the mass where there is none), so that
   coordinates of different units compare */
void rd_band_scale(const struct rd_assembly *assembly, const int32_t *number, double *scale);

/* x^T |D| y with |D| = sum size[part] |part| and x, y (free) not negative: what relative errors of
   the entries of D change in a product whose vectors have the sizes x and y */
double rd_band_rounding(const struct rd_assembly *assembly, const double *size,
                        const int32_t *number, const double *x, const double *y);

#endif
