/* Ropes on an axis in space: triples of their pieces, and counts. */
#include "glue/glue.h"

#include "space/space.h"

#include <string.h>

enum { MOST = 60 }; /* halvings and doublings */

static int check_power(int value, const char *name)
{
    if (value >= 0 && value <= MOST)
        return 0;
    PyErr_Format(PyExc_ValueError, "%s must be from 0 to %d, got %d", name, MOST, value);
    return -1;
}

PyObject *py_space_triples(PyObject *module, PyObject *arguments)
{
    (void)module;
    const npy_intp shape[] = {-1, 3, RD_SIX, RD_SIX};
    PyObject *object, *triple = NULL, *reached = NULL, *result = NULL;
    PyArrayObject *rates = NULL;
    double length, gentle;
    int halvings, doublings;
    if (!PyArg_ParseTuple(arguments, "Odiid", &object, &length, &halvings, &doublings, &gentle))
        return NULL;
    if (check_power(halvings, "halvings") < 0 || check_power(doublings, "doublings") < 0)
        return NULL;
    rates = py_array(object, NPY_CDOUBLE, 4, shape, "rates");
    if (rates == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(rates, 0);
    triple = py_new(NPY_CDOUBLE, 4, (npy_intp[]){count, 3, RD_SIX, RD_SIX});
    reached = py_new(NPY_INT32, 1, (npy_intp[]){count});
    if (triple == NULL || reached == NULL)
        goto done;
    const double _Complex *from = PyArray_DATA(rates);
    double _Complex *to = PyArray_DATA((PyArrayObject *)triple);
    int32_t *times = PyArray_DATA((PyArrayObject *)reached);
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp k = 0; k < count; k++)
        times[k] = rd_space_triple(from + k * RD_SPACE_TRIPLE, length, halvings, doublings, gentle,
                                   to + k * RD_SPACE_TRIPLE);
    Py_END_ALLOW_THREADS
    result = PyTuple_Pack(2, triple, reached);
done:
    Py_XDECREF(reached);
    Py_XDECREF(triple);
    Py_XDECREF(rates);
    return result;
}

/* a view of the tuple's arrays: 0, or -1 and an exception */
static int rope_parse(PyObject *object, struct py_kept *kept, struct rd_space *rope)
{
    PyObject *o[10];
    if (!PyArg_ParseTuple(object, "OOOOOOOOOO", o, o + 1, o + 2, o + 3, o + 4, o + 5, o + 6, o + 7,
                          o + 8, o + 9))
        return -1;
    if ((rope->length = py_keep(kept, o[0], NPY_DOUBLE, 1, (npy_intp[]){-1}, "length")) == NULL)
        return -1;
    const npy_intp n = py_kept_length(kept, 0);
    const npy_intp each[] = {n, RD_SIX, RD_SIX}, nodes[] = {n + 1, RD_SIX, RD_SIX};
    rope->pieces = (size_t)n;
    rope->halvings = py_keep(kept, o[1], NPY_INT32, 1, each, "halvings");
    const double **piecewise[] = {&rope->phi, &rope->soft, &rope->load, &rope->inertia,
                                  &rope->turn};
    static const char *const names[] = {"phi", "soft", "load", "inertia", "turn"};
    int found = rope->halvings != NULL;
    for (int k = 0; found && k < 5; k++)
        found = (*piecewise[k] = py_keep(kept, o[2 + k], NPY_DOUBLE, 3, each, names[k])) != NULL;
    found = found &&
            (rope->stiffness = py_keep(kept, o[7], NPY_DOUBLE, 3, nodes, "stiffness")) != NULL &&
            (rope->mass = py_keep(kept, o[8], NPY_DOUBLE, 3, nodes, "mass")) != NULL &&
            (rope->held = py_keep(kept, o[9], NPY_UINT8, 2, nodes, "held")) != NULL;
    for (npy_intp p = 0; found && p < n; p++)
        found = check_power(rope->halvings[p], "halvings") == 0;
    return found ? 0 : -1;
}

PyObject *py_space_count(PyObject *module, PyObject *arguments)
{
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space rope;
    PyObject *object, *lambda, *below = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O!O", &PyTuple_Type, &object, &lambda))
        return NULL;
    if (rope_parse(object, &kept, &rope) < 0)
        goto done;
    const double *at = py_keep(&kept, lambda, NPY_DOUBLE, 1, (npy_intp[]){-1}, "eigenvalue");
    if (at == NULL)
        goto done;
    const npy_intp count = py_kept_length(&kept, 0);
    below = py_new(NPY_DOUBLE, 1, &count);
    rd_space_count(&rope, 0, at, NULL, &workspace);
    if (below == NULL || py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status =
        rd_space_count(&rope, (size_t)count, at, PyArray_DATA((PyArrayObject *)below), &workspace);
    Py_END_ALLOW_THREADS
    if (status != RD_OK)
        py_raise(module, status);
    else
        Py_INCREF(result = below);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(below);
    py_kept_release(&kept);
    return result;
}
