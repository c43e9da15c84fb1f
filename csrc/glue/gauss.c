/* Linear systems of many lines in wide numbers. */
#include "glue/glue.h"

#include "mixed/gauss.h"

/* 0, or -1 and an exception: a writable contiguous array of wide numbers with three axes */
static int check_wide(PyObject *object, const char *name)
{
    if (PyArray_Check(object)) {
        PyArrayObject *array = (PyArrayObject *)object;
        const int type = PyArray_TYPE(array);
        if ((type == NPY_LONGDOUBLE || type == NPY_CLONGDOUBLE) && PyArray_NDIM(array) == 3 &&
            PyArray_ISCARRAY(array))
            return 0;
    }
    PyErr_Format(PyExc_TypeError,
                 "%s must be a contiguous array of longdouble or clongdouble with three axes",
                 name);
    return -1;
}

PyObject *py_eliminate(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *object;
    Py_ssize_t own;
    if (!PyArg_ParseTuple(arguments, "On", &object, &own) || check_wide(object, "A") < 0)
        return NULL;
    PyArrayObject *A = (PyArrayObject *)object;
    const npy_intp lines = PyArray_DIM(A, 0), rows = PyArray_DIM(A, 1), columns = PyArray_DIM(A, 2);
    if (own < 0 || own > rows || own > columns)
        return PyErr_Format(PyExc_ValueError, "columns must be from 0 to %zd, got %zd",
                            (Py_ssize_t)(rows < columns ? rows : columns), own);
    const size_t all = (size_t)(rows * columns);
    void *data = PyArray_DATA(A);
    const int is_real = PyArray_TYPE(A) == NPY_LONGDOUBLE;
    Py_BEGIN_ALLOW_THREADS
    for (size_t k = 0; k < (size_t)lines; k++)
        if (is_real)
            rd_gauss_eliminate((long double *)data + k * all, (size_t)rows, (size_t)columns,
                               (size_t)own);
        else
            rd_gauss_eliminate_complex((long double _Complex *)data + k * all, (size_t)rows,
                                       (size_t)columns, (size_t)own);
    Py_END_ALLOW_THREADS
    Py_RETURN_NONE;
}

PyObject *py_substitute(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *object, *right;
    if (!PyArg_ParseTuple(arguments, "OO", &object, &right) || check_wide(object, "A") < 0 ||
        check_wide(right, "x") < 0)
        return NULL;
    PyArrayObject *A = (PyArrayObject *)object, *x = (PyArrayObject *)right;
    const npy_intp lines = PyArray_DIM(A, 0), rows = PyArray_DIM(A, 1), columns = PyArray_DIM(A, 2);
    const npy_intp own = PyArray_DIM(x, 1), loads = PyArray_DIM(x, 2);
    if (PyArray_DIM(x, 0) != lines || own > rows || own > columns ||
        PyArray_TYPE(A) != PyArray_TYPE(x))
        return PyErr_Format(PyExc_ValueError,
                            "x must have %zd lines of at most %zd rows and numbers as A",
                            (Py_ssize_t)lines, (Py_ssize_t)(rows < columns ? rows : columns));
    const size_t all = (size_t)(rows * columns), each = (size_t)(own * loads);
    const void *U = PyArray_DATA(A);
    void *data = PyArray_DATA(x);
    const int is_real = PyArray_TYPE(A) == NPY_LONGDOUBLE;
    Py_BEGIN_ALLOW_THREADS
    for (size_t k = 0; k < (size_t)lines; k++)
        if (is_real)
            rd_gauss_substitute((const long double *)U + k * all, (size_t)columns, (size_t)own,
                                (size_t)loads, (long double *)data + k * each);
        else
            rd_gauss_substitute_complex((const long double _Complex *)U + k * all, (size_t)columns,
                                        (size_t)own, (size_t)loads,
                                        (long double _Complex *)data + k * each);
    Py_END_ALLOW_THREADS
    Py_RETURN_NONE;
}
