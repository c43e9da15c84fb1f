/* Modes from step to step. */
#include "glue/glue.h"

#include <string.h>

#include "base/recurrence.h"

/* 0, or -1 and an exception: every length is one of those there are, and modes fill the lanes */
static int check_steps(PyArrayObject *length, npy_intp lengths, npy_intp modes)
{
    const int32_t *each = PyArray_DATA(length);
    if (modes % RD_LANES != 0) {
        PyErr_Format(PyExc_ValueError, "change must have a multiple of %d modes, got %zd", RD_LANES,
                     (Py_ssize_t)modes);
        return -1;
    }
    for (npy_intp n = 0; n < PyArray_DIM(length, 0); n++)
        if (each[n] < 0 || each[n] >= lengths) {
            PyErr_Format(PyExc_ValueError, "length[%zd] must be from 0 to %zd, got %d",
                         (Py_ssize_t)n, (Py_ssize_t)lengths - 1, (int)each[n]);
            return -1;
        }
    return 0;
}

PyObject *py_recurrence(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyArrayObject *change = NULL, *length = NULL, *push = NULL, *before = NULL;
    PyObject *object[4], *states = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    change = py_array(object[0], NPY_DOUBLE, 3, (npy_intp[]){-1, RD_CHANGE, -1}, "change");
    if (change == NULL)
        goto done;
    const npy_intp modes = PyArray_DIM(change, 2);
    length = py_array(object[1], NPY_INT32, 1, (npy_intp[]){-1}, "length");
    if (length == NULL || check_steps(length, PyArray_DIM(change, 0), modes) < 0)
        goto done;
    const npy_intp steps = PyArray_DIM(length, 0);
    push = py_array(object[2], NPY_DOUBLE, 3, (npy_intp[]){steps, 2, modes}, "push");
    before = push ? py_array(object[3], NPY_DOUBLE, 2, (npy_intp[]){2, modes}, "state") : NULL;
    states = before ? py_new(NPY_DOUBLE, 3, (npy_intp[]){steps + 1, 2, modes}) : NULL;
    if (states == NULL)
        goto done;
    const struct rd_recurrence recurrence = {(size_t)modes, PyArray_DATA(change)};
    double *at = PyArray_DATA((PyArrayObject *)states);
    memcpy(at, PyArray_DATA(before), (size_t)PyArray_NBYTES(before));
    Py_BEGIN_ALLOW_THREADS
    rd_recurrence_walk(&recurrence, (size_t)steps, PyArray_DATA(length), PyArray_DATA(push), at);
    Py_END_ALLOW_THREADS
done:
    Py_XDECREF(before);
    Py_XDECREF(push);
    Py_XDECREF(length);
    Py_XDECREF(change);
    return states;
}
