/* The factors of frequencies, from an array. */
#ifndef PY_FACTORS_H
#define PY_FACTORS_H

#include "glue/glue.h"

#include "sweep/scale.h"

/* the factors (RD_PARTS, count) as views of an array's rows */
static inline struct rd_factors py_factors_of(PyArrayObject *factor)
{
    const size_t count = (size_t)PyArray_DIM(factor, 1);
    const double *row = PyArray_DATA(factor);
    return (struct rd_factors){
        .count = count,
        .section = row,
        .tension = row + 2 * count,
        .spring = row + 4 * count,
        .inertia = row + 6 * count,
        .dashpot = row + 8 * count,
    };
}

#endif
