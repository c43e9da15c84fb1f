/* Modes under a force of straight lines. */
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
    PyArrayObject *change = NULL, *seen = NULL, *length = NULL, *force = NULL, *before = NULL;
    PyObject *object[5], *state = NULL, *value = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOOO", object, object + 1, object + 2, object + 3,
                          object + 4))
        return NULL;
    change = py_array(object[0], NPY_DOUBLE, 3, (npy_intp[]){-1, RD_CHANGE, -1}, "change");
    if (change == NULL)
        goto done;
    const npy_intp modes = PyArray_DIM(change, 2);
    seen = py_array(object[1], NPY_DOUBLE, 3, (npy_intp[]){-1, 2, modes}, "seen");
    length = py_array(object[2], NPY_INT32, 1, (npy_intp[]){-1}, "length");
    if (seen == NULL || length == NULL || check_steps(length, PyArray_DIM(change, 0), modes) < 0)
        goto done;
    const npy_intp steps = PyArray_DIM(length, 0);
    force = py_array(object[3], NPY_DOUBLE, 1, (npy_intp[]){steps + 1}, "force");
    before = force ? py_array(object[4], NPY_DOUBLE, 2, (npy_intp[]){2, modes}, "state") : NULL;
    state = before ? py_new(NPY_DOUBLE, 2, (npy_intp[]){2, modes}) : NULL;
    value = state ? py_new(NPY_DOUBLE, 2, (npy_intp[]){PyArray_DIM(seen, 0), steps}) : NULL;
    if (value == NULL)
        goto done;
    const struct rd_recurrence recurrence = {
        .modes = (size_t)modes,
        .responses = (size_t)PyArray_DIM(seen, 0),
        .change = PyArray_DATA(change),
        .seen = PyArray_DATA(seen),
    };
    double *at = PyArray_DATA((PyArrayObject *)state);
    memcpy(at, PyArray_DATA(before), (size_t)PyArray_NBYTES(before));
    Py_BEGIN_ALLOW_THREADS
    rd_recurrence_walk(&recurrence, (size_t)steps, PyArray_DATA(length), PyArray_DATA(force), at,
                       PyArray_DATA((PyArrayObject *)value));
    Py_END_ALLOW_THREADS
    result = PyTuple_Pack(2, value, state);
done:
    Py_XDECREF(value);
    Py_XDECREF(state);
    Py_XDECREF(before);
    Py_XDECREF(force);
    Py_XDECREF(length);
    Py_XDECREF(seen);
    Py_XDECREF(change);
    return result;
}
