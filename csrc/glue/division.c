/* The elements and nodes that spans between stations are divided into. */
#include "glue/glue.h"

#include "chain/division.h"

#include <string.h>

/* 0, or -1 and an exception: lengths above 0, whole elements, nodes that an index reaches */
static int check_spans(const struct rd_spans *spans)
{
    for (size_t s = 0; s < spans->count; s++)
        if (!(spans->station[s + 1] > spans->station[s]) || spans->elements[s] < 1) {
            PyErr_Format(PyExc_ValueError, "station and elements must make elements of span %zd",
                         (Py_ssize_t)s);
            return -1;
        }
    size_t nodes = 1;
    for (size_t s = 0; s < spans->count; s++) {
        if (spans->elements[s] > INT32_MAX - (int64_t)nodes) {
            PyErr_NoMemory();
            return -1;
        }
        nodes += (size_t)spans->elements[s];
    }
    return 0;
}

static void take(size_t count, struct rd_workspace *workspace, struct rd_division *division)
{
    division->key = rd_take(workspace, count, sizeof *division->key);
    division->group = rd_take(workspace, count, sizeof *division->group);
    division->total = rd_take(workspace, count, sizeof *division->total);
    division->number = rd_take(workspace, count, sizeof *division->number);
    division->head = rd_take(workspace, count, sizeof *division->head);
    division->which = rd_take(workspace, count, sizeof *division->which);
    division->span = rd_take(workspace, count, sizeof *division->span);
    division->length = rd_take(workspace, count, sizeof *division->length);
    division->term = rd_take(workspace, count, sizeof *division->term);
    division->within = rd_take(workspace, count, sizeof *division->within);
}

/* a new array with these entries, not filled where they are NULL */
static PyObject *array_of(int type, size_t entries, const void *data)
{
    PyObject *array = py_new(type, 1, (npy_intp[]){(npy_intp)entries});
    if (array != NULL && data != NULL)
        memcpy(PyArray_DATA((PyArrayObject *)array), data,
               (size_t)PyArray_NBYTES((PyArrayObject *)array));
    return array;
}

enum { LENGTH, SPAN, WHICH, WITHIN, FIRST, ELEMENT, TERM, X, ARRAYS };

/* what is told and what is to be filled; 0, or -1 and an exception */
static int make(const struct rd_spans *spans, const struct rd_division *division, PyObject **array)
{
    const size_t stretches = rd_division_stretches(spans);
    array[LENGTH] = array_of(NPY_DOUBLE, division->distinct, division->length);
    array[SPAN] = array_of(NPY_INT64, division->distinct, division->span);
    array[WHICH] = array_of(NPY_INT32, spans->count, division->which);
    array[WITHIN] = array_of(NPY_INT64, division->inside, division->within);
    array[FIRST] = array_of(NPY_INT32, stretches, NULL);
    array[ELEMENT] = array_of(NPY_INT32, stretches - 1, NULL);
    array[TERM] = array_of(NPY_INT32, stretches, NULL);
    array[X] = array_of(NPY_DOUBLE, rd_division_elements(spans) + 1, NULL);
    for (int k = 0; k < ARRAYS; k++)
        if (array[k] == NULL)
            return -1;
    return 0;
}

static void *data_of(PyObject *array)
{
    return PyArray_DATA((PyArrayObject *)array);
}

PyObject *py_divide(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyArrayObject *station = NULL, *elements = NULL, *rope = NULL;
    PyObject *object[3], *array[ARRAYS] = {NULL}, *result = NULL;
    struct rd_workspace workspace = {0};
    struct rd_division division;
    double rounding;
    if (!PyArg_ParseTuple(arguments, "OOOd", object, object + 1, object + 2, &rounding))
        return NULL;
    elements = py_array(object[1], NPY_INT64, 1, (npy_intp[]){-1}, "elements");
    if (elements == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(elements, 0);
    station = py_array(object[0], NPY_DOUBLE, 1, (npy_intp[]){count + 1}, "station");
    rope = station ? py_array(object[2], NPY_INT64, 1, (npy_intp[]){count}, "rope") : NULL;
    if (rope == NULL)
        goto done;
    const struct rd_spans spans = {(size_t)count, PyArray_DATA(station), PyArray_DATA(elements),
                                   PyArray_DATA(rope)};
    if (check_spans(&spans) < 0)
        goto done;
    take(spans.count, &workspace, &division);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    take(spans.count, &workspace, &division);
    Py_BEGIN_ALLOW_THREADS
    rd_division_tell(&spans, rounding, &division);
    Py_END_ALLOW_THREADS
    if (make(&spans, &division, array) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    rd_division_lay(&spans, &division, data_of(array[FIRST]), data_of(array[ELEMENT]),
                    data_of(array[TERM]), data_of(array[X]));
    Py_END_ALLOW_THREADS
    result = PyTuple_New(ARRAYS);
    for (int k = 0; result != NULL && k < ARRAYS; k++)
        PyTuple_SET_ITEM(result, k, Py_NewRef(array[k]));
done:
    for (int k = 0; k < ARRAYS; k++)
        Py_XDECREF(array[k]);
    PyMem_RawFree(workspace.base);
    Py_XDECREF(rope);
    Py_XDECREF(elements);
    Py_XDECREF(station);
    return result;
}
