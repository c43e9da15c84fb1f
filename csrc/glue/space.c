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

/* the shape of `series` is (nodes, fields, RD_SPACE_ORDERS); 0, or -1 and an exception */
static int check_nodes(int nodes, int halvings, const char *name)
{
    if (nodes == 1 ||
        (nodes > 1 && nodes <= RD_SPACE_NODES && (halvings > 8 || nodes <= 1 << halvings)))
        return 0;
    PyErr_Format(PyExc_ValueError, "%s must be from 1 to %d and at most 2^halvings, got %d", name,
                 RD_SPACE_NODES, nodes);
    return -1;
}

PyObject *py_space_triples(PyObject *module, PyObject *arguments)
{
    PyObject *rates, *series, *triple = NULL, *result = NULL;
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space_run run;
    double gentle;
    int doublings, reached = 0;
    if (!PyArg_ParseTuple(arguments, "OOdiid", &rates, &series, &run.length, &run.halvings,
                          &doublings, &gentle))
        return NULL;
    if (check_power(run.halvings, "halvings") < 0 || check_power(doublings, "doublings") < 0)
        return NULL;
    const double _Complex *E =
        py_keep(&kept, rates, NPY_CDOUBLE, 5, (npy_intp[]){-1, -1, 3, RD_SIX, RD_SIX}, "rates");
    if (E == NULL)
        goto done;
    const npy_intp lines = py_kept_length(&kept, 0), fields = py_kept_length(&kept, 1);
    run.series =
        py_keep(&kept, series, NPY_DOUBLE, 3, (npy_intp[]){-1, fields, RD_SPACE_ORDERS}, "series");
    if (run.series == NULL)
        goto done;
    run.fields = (size_t)fields;
    run.nodes = (int)py_kept_length(&kept, 0);
    if (check_nodes(run.nodes, run.halvings, "series") < 0)
        goto done;
    if (doublings > run.halvings && run.nodes > 1)
        doublings = run.halvings;
    const npy_intp parts = run.nodes == 1 ? 1 : (npy_intp)1 << (run.halvings - doublings);
    triple = py_new(NPY_CDOUBLE, 5, (npy_intp[]){lines, parts, 3, RD_SIX, RD_SIX});
    if (triple == NULL)
        goto done;
    double _Complex *to = PyArray_DATA((PyArrayObject *)triple);
    rd_space_triples(&run, 0, E, doublings, gentle, to, &reached, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_space_triples(&run, (size_t)lines, E, doublings, gentle, to, &reached, &workspace);
    Py_END_ALLOW_THREADS
    if (status != RD_OK)
        py_raise(module, status);
    else
        result = Py_BuildValue("Oi", triple, reached);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(triple);
    py_kept_release(&kept);
    return result;
}

/* bands of D, G, Q, N and what is fixed, of the type of D; which line is singular, or how many there are */
PyObject *py_space_factor(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *o[5], *factor = NULL, *pivot = NULL, *result = NULL;
    struct py_kept kept = {0};
    const double *blocks[4];
    static const char *const names[] = {"D", "G", "Q", "N"};
    if (!PyArg_ParseTuple(arguments, "OOOOO", o, o + 1, o + 2, o + 3, o + 4))
        return NULL;
    const int real = PyArray_Check(o[0]) && PyArray_TYPE((PyArrayObject *)o[0]) == NPY_DOUBLE;
    const int type = real ? NPY_DOUBLE : NPY_CDOUBLE;
    npy_intp shape[] = {-1, -1, RD_SIX, RD_SIX};
    for (int k = 0; k < 4; k++) {
        if ((blocks[k] = py_keep(&kept, o[k], type, 4, shape, names[k])) == NULL)
            goto done;
        shape[0] = py_kept_length(&kept, 0);
        shape[1] = py_kept_length(&kept, 1) + (k == 2);
    }
    const npy_intp lines = shape[0], parts = shape[1] - 1, size = (2 * parts + 1) * RD_SIX;
    const uint8_t *fixed = py_keep(&kept, o[4], NPY_UINT8, 1, &size, "fixed");
    if (fixed == NULL)
        goto done;
    factor = py_new(type, 3, (npy_intp[]){lines, size, RD_SPACE_ROWS});
    pivot = py_new(NPY_INT32, 2, (npy_intp[]){lines, size});
    if (factor == NULL || pivot == NULL)
        goto done;
    void *at = PyArray_DATA((PyArrayObject *)factor);
    int32_t *rows = PyArray_DATA((PyArrayObject *)pivot);
    size_t failed;
    Py_BEGIN_ALLOW_THREADS
    rd_space_band((size_t)lines, (size_t)parts, real ? 1 : 2, blocks[0], blocks[1], blocks[2],
                  blocks[3], fixed, at);
    failed = real ? rd_space_factor((size_t)lines, (size_t)size, at, rows)
                  : rd_space_factor_complex((size_t)lines, (size_t)size, at, rows);
    Py_END_ALLOW_THREADS
    result = Py_BuildValue("OOn", factor, pivot, (Py_ssize_t)failed);
done:
    Py_XDECREF(factor);
    Py_XDECREF(pivot);
    py_kept_release(&kept);
    return result;
}

PyObject *py_space_solve(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *factor, *rows, *right, *result = NULL;
    struct py_kept kept = {0};
    if (!PyArg_ParseTuple(arguments, "OOO", &factor, &rows, &right))
        return NULL;
    const int real = PyArray_Check(factor) && PyArray_TYPE((PyArrayObject *)factor) == NPY_DOUBLE;
    const int type = real ? NPY_DOUBLE : NPY_CDOUBLE;
    const void *band = py_keep(&kept, factor, type, 3, (npy_intp[]){-1, -1, RD_SPACE_ROWS}, "band");
    if (band == NULL)
        goto done;
    const npy_intp lines = py_kept_length(&kept, 0), size = py_kept_length(&kept, 1);
    const int32_t *pivot = py_keep(&kept, rows, NPY_INT32, 2, (npy_intp[]){lines, size}, "pivot");
    PyArrayObject *x =
        pivot == NULL ? NULL : py_array(right, type, 3, (npy_intp[]){lines, -1, size}, "right");
    if (x == NULL)
        goto done;
    result = (PyObject *)PyArray_NewCopy(x, NPY_CORDER);
    const size_t columns = (size_t)PyArray_DIM(x, 1);
    Py_DECREF(x);
    if (result == NULL)
        goto done;
    void *to = PyArray_DATA((PyArrayObject *)result);
    Py_BEGIN_ALLOW_THREADS
    if (real)
        rd_space_solve((size_t)lines, (size_t)size, columns, band, pivot, to);
    else
        rd_space_solve_complex((size_t)lines, (size_t)size, columns, band, pivot, to);
    Py_END_ALLOW_THREADS
done:
    py_kept_release(&kept);
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
    rope->nodes = rope->halvings ? py_keep(kept, o[2], NPY_INT32, 1, each, "nodes") : NULL;
    npy_intp rows = 0;
    for (npy_intp p = 0; rope->nodes != NULL && p < n; p++) {
        if (check_power(rope->halvings[p], "halvings") < 0 ||
            check_nodes(rope->nodes[p], rope->halvings[p], "nodes") < 0)
            return -1;
        rows += rope->nodes[p];
    }
    if (rope->nodes == NULL ||
        (rope->rates = py_keep(kept, o[3], NPY_DOUBLE, 5, (npy_intp[]){n, -1, 3, RD_SIX, RD_SIX},
                               "rates")) == NULL)
        return -1;
    const npy_intp fields = py_kept_length(kept, 1);
    rope->fields = (size_t)fields;
    const int found =
        (rope->series = py_keep(kept, o[4], NPY_DOUBLE, 3,
                                (npy_intp[]){rows, fields, RD_SPACE_ORDERS}, "series")) != NULL &&
        (rope->inertia = py_keep(kept, o[5], NPY_DOUBLE, 3, each, "inertia")) != NULL &&
        (rope->turn = py_keep(kept, o[6], NPY_DOUBLE, 3, each, "turn")) != NULL &&
        (rope->stiffness = py_keep(kept, o[7], NPY_DOUBLE, 3, nodes, "stiffness")) != NULL &&
        (rope->mass = py_keep(kept, o[8], NPY_DOUBLE, 3, nodes, "mass")) != NULL &&
        (rope->held = py_keep(kept, o[9], NPY_UINT8, 2, nodes, "held")) != NULL;
    return found ? 0 : -1;
}

PyObject *py_space_count(PyObject *module, PyObject *arguments)
{
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space rope;
    PyObject *object, *lambda, *scale, *below = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O!OO", &PyTuple_Type, &object, &lambda, &scale))
        return NULL;
    if (rope_parse(object, &kept, &rope) < 0)
        goto done;
    const double *at = py_keep(&kept, lambda, NPY_DOUBLE, 1, (npy_intp[]){-1}, "eigenvalue");
    if (at == NULL)
        goto done;
    const npy_intp count = py_kept_length(&kept, 0);
    const double *z = py_keep(&kept, scale, NPY_DOUBLE, 2, (npy_intp[]){count, RD_SIX}, "scale");
    if (z == NULL)
        goto done;
    below = py_new(NPY_DOUBLE, 1, &count);
    rd_space_count(&rope, 0, at, z, NULL, &workspace);
    if (below == NULL || py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_space_count(&rope, (size_t)count, at, z, PyArray_DATA((PyArrayObject *)below),
                            &workspace);
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
