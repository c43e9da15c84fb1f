/* Many chains of uniform spans at once, in closed form. */
#include "glue/glue.h"

#include "closed/chains.h"

/* chains and the arrays they view */
struct py_chains {
    _Bool bent;
    struct rd_chains chains;
    size_t rows;
    PyArrayObject *number, *hinge, *jacobian;
};

/* 0, or -1 and an exception; to be released in both cases. `jacobian` may be None */
static int parse_chains(const char *name, PyObject *number, PyObject *hinge, PyObject *jacobian,
                        struct py_chains *parsed)
{
    parsed->bent = strcmp(name, "bent") == 0;
    if (!parsed->bent && strcmp(name, "plain") != 0) {
        PyErr_Format(PyExc_ValueError, "kind must be \"bent\" or \"plain\", got \"%s\"", name);
        return -1;
    }
    parsed->hinge = py_array(hinge, NPY_UINT8, 1, (npy_intp[]){-1}, "hinge");
    if (parsed->hinge == NULL)
        return -1;
    const npy_intp stations = PyArray_DIM(parsed->hinge, 0);
    if (stations < 2) {
        PyErr_Format(PyExc_ValueError, "hinge must have at least 2 stations, got %zd",
                     (Py_ssize_t)stations);
        return -1;
    }
    struct rd_chains *chains = &parsed->chains;
    chains->spans = (size_t)stations - 1;
    const npy_intp numbers =
        (npy_intp)(parsed->bent ? rd_bent_numbers(chains->spans) : rd_plain_numbers(chains->spans));
    parsed->number = py_array(number, NPY_FLOAT64, 2, (npy_intp[]){-1, numbers}, "numbers");
    if (parsed->number == NULL)
        return -1;
    if (jacobian != Py_None) {
        parsed->jacobian =
            py_array(jacobian, NPY_FLOAT64, 2, (npy_intp[]){numbers, -1}, "jacobian");
        if (parsed->jacobian == NULL)
            return -1;
        chains->columns = (size_t)PyArray_DIM(parsed->jacobian, 1);
        chains->jacobian = PyArray_DATA(parsed->jacobian);
    }
    chains->number = PyArray_DATA(parsed->number);
    chains->hinge = PyArray_DATA(parsed->hinge);
    parsed->rows = (size_t)PyArray_DIM(parsed->number, 0);
    for (npy_intp s = 0; s < stations && !parsed->bent; s++)
        if (chains->hinge[s]) {
            PyErr_SetString(PyExc_ValueError, "hinge must be 0 where nothing bends");
            return -1;
        }
    return 0;
}

static void release_chains(struct py_chains *parsed)
{
    Py_XDECREF(parsed->number);
    Py_XDECREF(parsed->hinge);
    Py_XDECREF(parsed->jacobian);
}

/* rows between two looks for Ctrl-C, each about a microsecond a span and mode */
static size_t rows_at_once(const struct py_chains *parsed, size_t number)
{
    const size_t rows = 100000 / number / parsed->chains.spans;
    return rows < 1 ? 1 : rows;
}

/* 0, or -1 and an exception */
static int solve_chains(const struct py_chains *parsed, const struct rd_closed_modes *modes,
                        const struct rd_workspace *workspace)
{
    const size_t rows = rows_at_once(parsed, modes->number);
    for (size_t first = 0; first < parsed->rows; first += rows) {
        const size_t last = parsed->rows - first < rows ? parsed->rows : first + rows;
        Py_BEGIN_ALLOW_THREADS
        if (parsed->bent)
            rd_bent_chain_modes(&parsed->chains, first, last, modes, workspace);
        else
            rd_plain_chain_modes(&parsed->chains, first, last, modes, workspace);
        Py_END_ALLOW_THREADS
        if (PyErr_CheckSignals() < 0)
            return -1;
    }
    return 0;
}

PyObject *py_closed_chain_modes(PyObject *module, PyObject *arguments)
{
    struct py_chains parsed = {0};
    struct rd_workspace workspace = {0};
    const char *kind;
    Py_ssize_t number;
    PyObject *object[3], *omega = NULL, *error = NULL, *slope = NULL, *certified = NULL;
    PyObject *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOOn", &kind, object, object + 1, object + 2, &number))
        return NULL;
    if (parse_chains(kind, object[0], object[1], object[2], &parsed) < 0)
        goto done;
    if (number < 1) {
        PyErr_Format(PyExc_ValueError, "number must be at least 1, got %zd", number);
        goto done;
    }
    workspace.used = rd_chain_work(parsed.chains.spans, (size_t)number);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    const npy_intp shape[] = {(npy_intp)parsed.rows, number, (npy_intp)parsed.chains.columns};
    omega = py_new(NPY_FLOAT64, 2, shape);
    error = omega ? py_new(NPY_FLOAT64, 2, shape) : NULL;
    certified = error ? py_new(NPY_BOOL, 1, shape) : NULL;
    if (certified == NULL)
        goto done;
    slope = parsed.jacobian ? py_new(NPY_FLOAT64, 3, shape) : Py_NewRef(Py_None);
    if (slope == NULL)
        goto done;
    const struct rd_closed_modes modes = {
        .number = (size_t)number,
        .omega = PyArray_DATA((PyArrayObject *)omega),
        .error = PyArray_DATA((PyArrayObject *)error),
        .slope = parsed.jacobian ? PyArray_DATA((PyArrayObject *)slope) : NULL,
        .certified = PyArray_DATA((PyArrayObject *)certified),
    };
    if (solve_chains(&parsed, &modes, &workspace) == 0)
        result = PyTuple_Pack(4, omega, error, slope, certified);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(omega);
    Py_XDECREF(error);
    Py_XDECREF(slope);
    Py_XDECREF(certified);
    release_chains(&parsed);
    return result;
}

/* 0, or -1 and an exception */
static int count_chains(const struct py_chains *parsed, double omega, int64_t *count,
                        const struct rd_workspace *workspace)
{
    const size_t rows = rows_at_once(parsed, 2);
    for (size_t first = 0; first < parsed->rows; first += rows) {
        const size_t last = parsed->rows - first < rows ? parsed->rows : first + rows;
        Py_BEGIN_ALLOW_THREADS
        if (parsed->bent)
            rd_bent_chain_count(&parsed->chains, first, last, omega, count, workspace);
        else
            rd_plain_chain_count(&parsed->chains, first, last, omega, count, workspace);
        Py_END_ALLOW_THREADS
        if (PyErr_CheckSignals() < 0)
            return -1;
    }
    return 0;
}

PyObject *py_closed_chain_count(PyObject *module, PyObject *arguments)
{
    struct py_chains parsed = {0};
    struct rd_workspace workspace = {0};
    const char *kind;
    double omega;
    PyObject *object[2], *count = NULL, *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOd", &kind, object, object + 1, &omega))
        return NULL;
    if (parse_chains(kind, object[0], object[1], Py_None, &parsed) < 0)
        goto done;
    workspace.used = rd_chain_work(parsed.chains.spans, 2);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    count = py_new(NPY_INT64, 1, (npy_intp[]){(npy_intp)parsed.rows});
    if (count == NULL)
        goto done;
    if (count_chains(&parsed, omega, PyArray_DATA((PyArrayObject *)count), &workspace) == 0)
        result = Py_NewRef(count);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(count);
    release_chains(&parsed);
    return result;
}
