/* Modes under straight lines between samples. */
#include "glue/glue.h"

#include <string.h>

#include "base/recurrence.h"

/* arrays of a call */
struct arrays {
    PyArrayObject *change, *gain, *read, *local, *kind, *sample, *before;
};

/* 0, or -1 and an exception: every kind is one of those there are */
static int check_kinds(PyArrayObject *kind, npy_intp kinds)
{
    const int32_t *each = PyArray_DATA(kind);
    for (npy_intp n = 0; n < PyArray_DIM(kind, 0); n++)
        if (each[n] < 0 || each[n] >= kinds) {
            PyErr_Format(PyExc_ValueError, "kind[%zd] must be from 0 to %zd, got %d", (Py_ssize_t)n,
                         (Py_ssize_t)kinds - 1, (int)each[n]);
            return -1;
        }
    return 0;
}

/* 0, or -1 and an exception; to be released in both cases */
static int parse(PyObject *const *object, struct arrays *of)
{
    of->change =
        py_array(object[0], NPY_DOUBLE, 4, (npy_intp[]){-1, -1, RD_CHANGE, RD_QUAD}, "change");
    if (of->change == NULL)
        return -1;
    const npy_intp groups = PyArray_DIM(of->change, 0), kinds = PyArray_DIM(of->change, 1);
    of->read = py_array(object[2], NPY_DOUBLE, 5, (npy_intp[]){groups, -1, -1, 2, RD_QUAD}, "read");
    if (of->read == NULL)
        return -1;
    const npy_intp size = PyArray_DIM(of->read, 1), responses = PyArray_DIM(of->read, 2);
    if (size < 1 || size > RD_BLOCK_MOST) {
        PyErr_Format(PyExc_ValueError, "read must have from 1 to %d samples of a block, got %zd",
                     RD_BLOCK_MOST, (Py_ssize_t)size);
        return -1;
    }
    of->gain = py_array(object[1], NPY_DOUBLE, 5, (npy_intp[]){groups, kinds, size + 1, 2, RD_QUAD},
                        "gain");
    of->local =
        of->gain ? py_array(object[3], NPY_DOUBLE, 3, (npy_intp[]){size, responses, size}, "local")
                 : NULL;
    of->kind = of->local ? py_array(object[4], NPY_INT32, 1, (npy_intp[]){-1}, "kind") : NULL;
    if (of->kind == NULL || check_kinds(of->kind, kinds) < 0)
        return -1;
    const npy_intp samples = PyArray_DIM(of->kind, 0) * size + 1;
    of->sample = py_array(object[5], NPY_DOUBLE, 1, (npy_intp[]){samples}, "sample");
    of->before = of->sample
                     ? py_array(object[6], NPY_DOUBLE, 3, (npy_intp[]){groups, 2, RD_QUAD}, "state")
                     : NULL;
    return of->before ? 0 : -1;
}

static void release(struct arrays *of)
{
    Py_XDECREF(of->before);
    Py_XDECREF(of->sample);
    Py_XDECREF(of->kind);
    Py_XDECREF(of->local);
    Py_XDECREF(of->read);
    Py_XDECREF(of->gain);
    Py_XDECREF(of->change);
}

static half_lanes *take_work(struct rd_workspace *workspace, size_t responses)
{
    return rd_take_aligned(workspace, rd_recurrence_work(responses), sizeof(half_lanes),
                           sizeof(half_lanes));
}

PyObject *py_recurrence(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct arrays of = {0};
    struct rd_workspace workspace = {0};
    PyObject *object[7], *state = NULL, *value = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOOOOO", object, object + 1, object + 2, object + 3,
                          object + 4, object + 5, object + 6))
        return NULL;
    if (parse(object, &of) < 0)
        goto done;
    const struct rd_recurrence recurrence = {
        .groups = (size_t)PyArray_DIM(of.change, 0),
        .kinds = (size_t)PyArray_DIM(of.change, 1),
        .size = (size_t)PyArray_DIM(of.read, 1),
        .responses = (size_t)PyArray_DIM(of.read, 2),
        .change = PyArray_DATA(of.change),
        .gain = PyArray_DATA(of.gain),
        .read = PyArray_DATA(of.read),
        .local = PyArray_DATA(of.local),
    };
    const npy_intp blocks = PyArray_DIM(of.kind, 0);
    state = py_new(NPY_DOUBLE, 3, PyArray_DIMS(of.before));
    const npy_intp shape[] = {(npy_intp)recurrence.responses, blocks * (npy_intp)recurrence.size};
    value = state ? py_new(NPY_DOUBLE, 2, shape) : NULL;
    take_work(&workspace, recurrence.responses);
    if (value == NULL || py_workspace_allocate(&workspace) < 0)
        goto done;
    half_lanes *work = take_work(&workspace, recurrence.responses);
    double *at = PyArray_DATA((PyArrayObject *)state);
    memcpy(at, PyArray_DATA(of.before), (size_t)PyArray_NBYTES(of.before));
    Py_BEGIN_ALLOW_THREADS
    rd_recurrence_walk(&recurrence, (size_t)blocks, PyArray_DATA(of.kind), PyArray_DATA(of.sample),
                       at, work, PyArray_DATA((PyArrayObject *)value));
    Py_END_ALLOW_THREADS
    result = PyTuple_Pack(2, value, state);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(value);
    Py_XDECREF(state);
    release(&of);
    return result;
}
