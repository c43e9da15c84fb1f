/* Rows that are solved in closed form, with looks for Ctrl-C between them. */
#include "glue/closed/rows.h"

enum { MICROSECONDS = 100000 }; /* between two looks */

int py_rows_solve(size_t rows, size_t microseconds, py_solve_rows *solve, const void *question)
{
    const size_t most = MICROSECONDS / (microseconds > 0 ? microseconds : 1);
    const size_t at_once = most > 0 ? most : 1;
    for (size_t first = 0; first < rows; first += at_once) {
        const size_t last = rows - first < at_once ? rows : first + at_once;
        Py_BEGIN_ALLOW_THREADS
        solve(question, first, last);
        Py_END_ALLOW_THREADS
        if (PyErr_CheckSignals() < 0)
            return -1;
    }
    return 0;
}

int py_closed_modes_make(size_t rows, Py_ssize_t number, const char *name, size_t values,
                         bool sloped, struct py_closed_modes *made)
{
    if (number < 1) {
        PyErr_Format(PyExc_ValueError, "%s must be at least 1, got %zd", name, number);
        return -1;
    }
    const npy_intp shape[] = {(npy_intp)rows, number, (npy_intp)values};
    made->omega = py_new(NPY_FLOAT64, 2, shape);
    made->error = made->omega ? py_new(NPY_FLOAT64, 2, shape) : NULL;
    made->certified = made->error ? py_new(NPY_BOOL, 1, shape) : NULL;
    if (made->certified == NULL)
        return -1;
    made->slope = sloped ? py_new(NPY_FLOAT64, 3, shape) : Py_NewRef(Py_None);
    if (made->slope == NULL)
        return -1;
    made->modes = (struct rd_closed_modes){
        .number = (size_t)number,
        .omega = PyArray_DATA((PyArrayObject *)made->omega),
        .error = PyArray_DATA((PyArrayObject *)made->error),
        .slope = sloped ? PyArray_DATA((PyArrayObject *)made->slope) : NULL,
        .certified = PyArray_DATA((PyArrayObject *)made->certified),
    };
    return 0;
}

PyObject *py_closed_modes_pack(const struct py_closed_modes *made)
{
    return PyTuple_Pack(4, made->omega, made->error, made->slope, made->certified);
}

void py_closed_modes_release(struct py_closed_modes *made)
{
    Py_XDECREF(made->omega);
    Py_XDECREF(made->error);
    Py_XDECREF(made->slope);
    Py_XDECREF(made->certified);
}
