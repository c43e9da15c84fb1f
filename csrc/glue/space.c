/* Ropes on an axis in space: triples of their pieces, bands and counts. */
#include "glue/glue.h"

#include "space/space.h"

#include <string.h>

enum {
    MOST = 60,            /* halvings and doublings */
    EQUAL_MOST = 1 << 17, /* parts of a piece */
};

static int check_power(int value, const char *name)
{
    if (value >= 0 && value <= MOST)
        return 0;
    PyErr_Format(PyExc_ValueError, "%s must be from 0 to %d, got %d", name, MOST, value);
    return -1;
}

/* the shape of `series` is (nodes, fields, RD_SPACE_ORDERS); 0, or -1 and an exception */
static int check_nodes(int nodes, int equal, int halvings, const char *name)
{
    if (nodes == 1 ||
        (nodes > 1 && nodes <= RD_SPACE_NODES && (halvings > 8 || nodes <= equal << halvings)))
        return 0;
    PyErr_Format(PyExc_ValueError,
                 "%s must be from 1 to %d and at most the parts of all halvings, got %d", name,
                 RD_SPACE_NODES, nodes);
    return -1;
}

/* matrices are those of three coordinates or of six */
static int check_width(npy_intp width, const char *name)
{
    if (width == 3 || width == RD_SIX)
        return 0;
    PyErr_Format(PyExc_ValueError, "%s must be matrices of 3 or 6 rows, got %zd", name,
                 (Py_ssize_t)width);
    return -1;
}

PyObject *py_space_triples(PyObject *module, PyObject *arguments)
{
    PyObject *rates, *series, *triple = NULL, *result = NULL;
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space_run run;
    double gentle;
    int doublings, reached = 0, whole = 0;
    if (!PyArg_ParseTuple(arguments, "OOdiiid", &rates, &series, &run.length, &run.equal,
                          &run.halvings, &doublings, &gentle))
        return NULL;
    if (run.equal < 1 || run.equal > EQUAL_MOST) {
        PyErr_Format(PyExc_ValueError, "equal must be from 1 to %d, got %d", EQUAL_MOST, run.equal);
        return NULL;
    }
    if (check_power(run.halvings, "halvings") < 0 || check_power(doublings, "doublings") < 0)
        return NULL;
    const double _Complex *E =
        py_keep(&kept, rates, NPY_CDOUBLE, 5, (npy_intp[]){-1, -1, 3, -1, -1}, "rates");
    if (E == NULL)
        goto done;
    const npy_intp lines = py_kept_length(&kept, 0), fields = py_kept_length(&kept, 1);
    const npy_intp width = py_kept_length(&kept, 3);
    if (check_width(width, "rates") < 0 || check_width(py_kept_length(&kept, 4), "rates") < 0)
        goto done;
    run.series =
        py_keep(&kept, series, NPY_DOUBLE, 3, (npy_intp[]){-1, fields, RD_SPACE_ORDERS}, "series");
    if (run.series == NULL)
        goto done;
    run.width = (size_t)width;
    run.fields = (size_t)fields;
    run.nodes = (int)py_kept_length(&kept, 0);
    if (check_nodes(run.nodes, run.equal, run.halvings, "series") < 0)
        goto done;
    if (doublings > run.halvings && run.nodes > 1)
        doublings = run.halvings;
    triple = py_new(NPY_CDOUBLE, 5, (npy_intp[]){lines, run.nodes, 3, width, width});
    if (triple == NULL)
        goto done;
    double _Complex *to = PyArray_DATA((PyArrayObject *)triple);
    rd_space_triples(&run, 0, E, doublings, gentle, to, &reached, &whole, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_space_triples(&run, (size_t)lines, E, doublings, gentle, to, &reached, &whole,
                              &workspace);
    Py_END_ALLOW_THREADS
    if (status != RD_OK)
        py_raise(module, status);
    else
        result = Py_BuildValue("OiN", triple, reached, PyBool_FromLong(whole));
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(triple);
    py_kept_release(&kept);
    return result;
}

/* a view of D, G, Q, N and what is fixed: 0, or -1 and an exception */
static int band_parse(PyObject *const o[5], int closed, struct py_kept *kept,
                      struct rd_space_band *band)
{
    static const char *const names[] = {"D", "G", "Q", "N"};
    const double *blocks[4];
    npy_intp shape[] = {-1, -1, -1, -1};
    for (int k = 0; k < 4; k++) {
        if ((blocks[k] = py_keep(kept, o[k], NPY_CDOUBLE, 4, shape, names[k])) == NULL)
            return -1;
        shape[0] = py_kept_length(kept, 0);
        shape[1] = py_kept_length(kept, 1) + (k == 2);
        shape[2] = shape[3] = py_kept_length(kept, 2);
        if (check_width(shape[2], names[k]) < 0 ||
            check_width(py_kept_length(kept, 3), names[k]) < 0)
            return -1;
    }
    const npy_intp parts = shape[1] - 1;
    const npy_intp rows[] = {shape[0], (2 * parts + 1) * shape[2]};
    *band = (struct rd_space_band){
        .width = (size_t)shape[2],
        .lines = (size_t)shape[0],
        .parts = (size_t)parts,
        .numbers = 2,
        .D = blocks[0],
        .G = blocks[1],
        .Q = blocks[2],
        .N = blocks[3],
        .fixed = py_keep(kept, o[4], NPY_UINT8, 2, rows, "fixed"),
        .closed = closed,
    };
    return band->fixed == NULL ? -1 : 0;
}

/* the real parts of bands, factored, their pivots, and which line is singular, or how many there are */
PyObject *py_space_factor(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *o[5], *factor = NULL, *pivot = NULL, *result = NULL;
    struct py_kept kept = {0};
    struct rd_space_band band;
    int closed;
    if (!PyArg_ParseTuple(arguments, "OOOOOp", o, o + 1, o + 2, o + 3, o + 4, &closed))
        return NULL;
    if (band_parse(o, closed, &kept, &band) < 0)
        goto done;
    const npy_intp lines = (npy_intp)band.lines;
    const npy_intp size = (npy_intp)((2 * band.parts + 1) * band.width);
    factor = py_new(NPY_DOUBLE, 3,
                    (npy_intp[]){lines, size, (npy_intp)rd_space_rows(band.width, closed)});
    pivot = py_new(NPY_INT32, 2, (npy_intp[]){lines, size});
    if (factor == NULL || pivot == NULL)
        goto done;
    double *at = PyArray_DATA((PyArrayObject *)factor);
    int32_t *rows = PyArray_DATA((PyArrayObject *)pivot);
    size_t failed;
    Py_BEGIN_ALLOW_THREADS
    failed = rd_space_factor(&band, at, rows);
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
    double *work = NULL;
    struct py_kept kept = {0};
    if (!PyArg_ParseTuple(arguments, "OOO", &factor, &rows, &right))
        return NULL;
    const double *band = py_keep(&kept, factor, NPY_DOUBLE, 3, (npy_intp[]){-1, -1, -1}, "factors");
    if (band == NULL)
        goto done;
    const npy_intp lines = py_kept_length(&kept, 0), size = py_kept_length(&kept, 1);
    const size_t wide = (size_t)py_kept_length(&kept, 2);
    const int closed = wide == rd_space_rows(3, 1) || wide == rd_space_rows(RD_SIX, 1);
    const npy_intp width = wide == rd_space_rows(3, closed) ? 3 : RD_SIX;
    if (wide != rd_space_rows((size_t)width, closed)) {
        PyErr_SetString(PyExc_ValueError, "factors must be those of 3 or 6 coordinates");
        goto done;
    }
    const int32_t *pivot = py_keep(&kept, rows, NPY_INT32, 2, (npy_intp[]){lines, size}, "pivot");
    PyArrayObject *x = pivot == NULL
                           ? NULL
                           : py_array(right, NPY_DOUBLE, 3, (npy_intp[]){lines, -1, size}, "right");
    if (x == NULL)
        goto done;
    result = (PyObject *)PyArray_NewCopy(x, NPY_CORDER);
    const size_t columns = (size_t)PyArray_DIM(x, 1);
    Py_DECREF(x);
    if (result == NULL)
        goto done;
    double *to = PyArray_DATA((PyArrayObject *)result);
    work = PyMem_RawMalloc((columns * (size_t)size + 1) * sizeof *work);
    if (work == NULL) {
        Py_CLEAR(result);
        PyErr_NoMemory();
        goto done;
    }
    Py_BEGIN_ALLOW_THREADS
    rd_space_solve((size_t)width, closed, (size_t)lines, (size_t)size, columns, band, pivot, to,
                   work);
    Py_END_ALLOW_THREADS
done:
    PyMem_RawFree(work);
    py_kept_release(&kept);
    return result;
}

PyObject *py_space_apply(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *o[5], *given, *result = NULL;
    struct py_kept kept = {0};
    struct rd_space_band band;
    int closed;
    if (!PyArg_ParseTuple(arguments, "OOOOOpO", o, o + 1, o + 2, o + 3, o + 4, &closed, &given))
        return NULL;
    if (band_parse(o, closed, &kept, &band) < 0)
        goto done;
    const npy_intp size = (npy_intp)((2 * band.parts + 1) * band.width);
    const npy_intp shape[] = {(npy_intp)band.lines, -1, size};
    const double _Complex *x = py_keep(&kept, given, NPY_CDOUBLE, 3, shape, "vectors");
    if (x == NULL)
        goto done;
    const npy_intp columns = py_kept_length(&kept, 1);
    result = py_new(NPY_CDOUBLE, 3, (npy_intp[]){(npy_intp)band.lines, columns, size});
    if (result == NULL)
        goto done;
    double _Complex *to = PyArray_DATA((PyArrayObject *)result);
    Py_BEGIN_ALLOW_THREADS
    rd_space_apply(&band, (size_t)columns, x, to);
    Py_END_ALLOW_THREADS
done:
    py_kept_release(&kept);
    return result;
}

/* vectors that were iterated, and their forms */
PyObject *py_space_iterate(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *o[5], *factor, *rows, *given, *form = NULL, *result = NULL;
    PyArrayObject *x = NULL;
    double *work = NULL;
    int times;
    struct py_kept kept = {0};
    struct rd_space_band band;
    int closed;
    if (!PyArg_ParseTuple(arguments, "OOOOOpOOOi", o, o + 1, o + 2, o + 3, o + 4, &closed, &factor,
                          &rows, &given, &times))
        return NULL;
    if (check_power(times, "times") < 0 || band_parse(o, closed, &kept, &band) < 0)
        goto done;
    const npy_intp lines = (npy_intp)band.lines;
    const npy_intp size = (npy_intp)((2 * band.parts + 1) * band.width);
    const npy_intp wide = (npy_intp)rd_space_rows(band.width, closed);
    const double *lu =
        py_keep(&kept, factor, NPY_DOUBLE, 3, (npy_intp[]){lines, size, wide}, "factors");
    const int32_t *pivot =
        lu == NULL ? NULL : py_keep(&kept, rows, NPY_INT32, 2, (npy_intp[]){lines, size}, "pivot");
    PyArrayObject *vectors =
        pivot == NULL ? NULL
                      : py_array(given, NPY_DOUBLE, 3, (npy_intp[]){lines, -1, size}, "vectors");
    if (vectors == NULL)
        goto done;
    x = (PyArrayObject *)PyArray_NewCopy(vectors, NPY_CORDER);
    Py_DECREF(vectors);
    if (x == NULL)
        goto done;
    const npy_intp columns = PyArray_DIM(x, 1);
    form = py_new(NPY_DOUBLE, 4, (npy_intp[]){lines, 2, columns, columns});
    work = PyMem_RawMalloc((size_t)(2 * columns * size + 1) * sizeof *work);
    if (form == NULL || work == NULL) {
        if (work == NULL)
            PyErr_NoMemory();
        goto done;
    }
    double *to = PyArray_DATA(x), *forms = PyArray_DATA((PyArrayObject *)form);
    Py_BEGIN_ALLOW_THREADS
    rd_space_iterate(&band, (size_t)columns, lu, pivot, (size_t)times, to, forms, work);
    Py_END_ALLOW_THREADS
    result = Py_BuildValue("OO", x, form);
done:
    PyMem_RawFree(work);
    Py_XDECREF(form);
    Py_XDECREF(x);
    py_kept_release(&kept);
    return result;
}

PyObject *py_space_respond(PyObject *module, PyObject *arguments)
{
    PyObject *o[5], *right, *result = NULL;
    PyArrayObject *x = NULL;
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space_band band;
    int closed;
    if (!PyArg_ParseTuple(arguments, "OOOOOpO", o, o + 1, o + 2, o + 3, o + 4, &closed, &right))
        return NULL;
    if (band_parse(o, closed, &kept, &band) < 0)
        goto done;
    const npy_intp size = (npy_intp)((2 * band.parts + 1) * band.width);
    const npy_intp shape[] = {(npy_intp)band.lines, -1, size};
    PyArrayObject *given = py_array(right, NPY_CDOUBLE, 3, shape, "right");
    if (given == NULL)
        goto done;
    x = (PyArrayObject *)PyArray_NewCopy(given, NPY_CORDER);
    Py_DECREF(given);
    if (x == NULL)
        goto done;
    const size_t columns = (size_t)PyArray_DIM(x, 1);
    double _Complex *to = PyArray_DATA(x);
    rd_space_respond(&band, columns, to, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_space_respond(&band, columns, to, &workspace);
    Py_END_ALLOW_THREADS
    if (status != RD_OK)
        py_raise(module, status);
    else
        Py_INCREF(result = (PyObject *)x);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(x);
    py_kept_release(&kept);
    return result;
}

/* a view of the tuple's arrays: 0, or -1 and an exception */
static int rope_parse(PyObject *object, struct py_kept *kept, struct rd_space *rope)
{
    PyObject *o[10];
    if (!PyArg_ParseTuple(object, "OOOOOOOOOOp", o, o + 1, o + 2, o + 3, o + 4, o + 5, o + 6, o + 7,
                          o + 8, o + 9, &rope->closed))
        return -1;
    if ((rope->length = py_keep(kept, o[0], NPY_DOUBLE, 1, (npy_intp[]){-1}, "length")) == NULL)
        return -1;
    const npy_intp n = py_kept_length(kept, 0);
    rope->pieces = (size_t)n;
    rope->halvings = py_keep(kept, o[1], NPY_INT32, 1, &n, "halvings");
    rope->nodes = rope->halvings ? py_keep(kept, o[2], NPY_INT32, 1, &n, "nodes") : NULL;
    npy_intp rows = 0;
    for (npy_intp p = 0; rope->nodes != NULL && p < n; p++) {
        if (check_power(rope->halvings[p], "halvings") < 0 ||
            check_nodes(rope->nodes[p], 1, rope->halvings[p], "nodes") < 0)
            return -1;
        rows += rope->nodes[p];
    }
    if (rope->nodes == NULL ||
        (rope->rates = py_keep(kept, o[3], NPY_DOUBLE, 6, (npy_intp[]){-1, n, -1, 3, -1, -1},
                               "rates")) == NULL ||
        check_width(py_kept_length(kept, 4), "rates") < 0 ||
        check_width(py_kept_length(kept, 5), "rates") < 0)
        return -1;
    const npy_intp components = py_kept_length(kept, 0), fields = py_kept_length(kept, 2);
    const npy_intp width = py_kept_length(kept, 4);
    const npy_intp each[] = {components, n, width, width};
    const npy_intp nodes[] = {components, n + 1, width, width};
    rope->components = (size_t)components;
    rope->width = (size_t)width;
    rope->fields = (size_t)fields;
    const int found =
        (rope->series = py_keep(kept, o[4], NPY_DOUBLE, 3,
                                (npy_intp[]){rows, fields, RD_SPACE_ORDERS}, "series")) != NULL &&
        (rope->inertia = py_keep(kept, o[5], NPY_DOUBLE, 4, each, "inertia")) != NULL &&
        (rope->turn = py_keep(kept, o[6], NPY_DOUBLE, 4, each, "turn")) != NULL &&
        (rope->stiffness = py_keep(kept, o[7], NPY_DOUBLE, 4, nodes, "stiffness")) != NULL &&
        (rope->mass = py_keep(kept, o[8], NPY_DOUBLE, 4, nodes, "mass")) != NULL &&
        (rope->held = py_keep(kept, o[9], NPY_UINT8, 3, nodes, "held")) != NULL;
    return found ? 0 : -1;
}

PyObject *py_space_count(PyObject *module, PyObject *arguments)
{
    struct py_kept kept = {0};
    struct rd_workspace workspace = {0};
    struct rd_space rope;
    PyObject *object, *which, *lambda, *scale, *below = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O!OOO", &PyTuple_Type, &object, &which, &lambda, &scale))
        return NULL;
    if (rope_parse(object, &kept, &rope) < 0)
        goto done;
    const double *at = py_keep(&kept, lambda, NPY_DOUBLE, 1, (npy_intp[]){-1}, "eigenvalue");
    if (at == NULL)
        goto done;
    const npy_intp count = py_kept_length(&kept, 0);
    const int32_t *component = py_keep(&kept, which, NPY_INT32, 1, &count, "component");
    if (component == NULL)
        goto done;
    for (npy_intp k = 0; k < count; k++)
        if (component[k] < 0 || (size_t)component[k] >= rope.components) {
            PyErr_Format(PyExc_ValueError, "component must lie in 0 ... %zu, got %d",
                         rope.components - 1, (int)component[k]);
            goto done;
        }
    const npy_intp shape[] = {count, (npy_intp)rope.width};
    const double *z = py_keep(&kept, scale, NPY_DOUBLE, 2, shape, "scale");
    if (z == NULL)
        goto done;
    below = py_new(NPY_DOUBLE, 1, &count);
    rd_space_count(&rope, 0, component, at, z, NULL, &workspace);
    if (below == NULL || py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_space_count(&rope, (size_t)count, component, at, z,
                            PyArray_DATA((PyArrayObject *)below), &workspace);
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
