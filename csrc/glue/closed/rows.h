/* Rows that are solved in closed form, with looks for Ctrl-C between them. */
#ifndef PY_CLOSED_ROWS_H
#define PY_CLOSED_ROWS_H

#include "glue/glue.h"

#include "closed/closed.h"

/* Rows first <= i < last of a question, without the GIL. */
typedef void py_solve_rows(const void *question, size_t first, size_t last);

/* All rows, each of so many microseconds by their order; 0, or -1 and an exception. */
int py_rows_solve(size_t rows, size_t microseconds, py_solve_rows *solve, const void *question);

/* modes and the arrays that they fill */
struct py_closed_modes {
    struct rd_closed_modes modes;
    PyObject *omega, *error, *slope, *certified;
};

/* 0, or -1 and an exception; to be released in both cases. `name` is that of the
   number; slopes by `values` where `sloped`. */
int py_closed_modes_make(size_t rows, Py_ssize_t number, const char *name, size_t values,
                         bool sloped, struct py_closed_modes *made);
/* (omega, error, slope or None, certified) */
PyObject *py_closed_modes_pack(const struct py_closed_modes *made);
void py_closed_modes_release(struct py_closed_modes *made);

#endif
