/* Many chains of uniform spans at once, in closed form. */
#include "glue/closed/rows.h"

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

/* what is asked of rows */
struct question {
    const struct py_chains *of;
    const struct rd_closed_modes *modes;
    const struct rd_workspace *workspace;
    double omega;
    int64_t *count;
};

static void solve_modes(const void *asked, size_t first, size_t last)
{
    const struct question *question = asked;
    (question->of->bent ? rd_bent_chain_modes : rd_plain_chain_modes)(
        &question->of->chains, first, last, question->modes, question->workspace);
}

static void solve_counts(const void *asked, size_t first, size_t last)
{
    const struct question *question = asked;
    (question->of->bent ? rd_bent_chain_count : rd_plain_chain_count)(
        &question->of->chains, first, last, question->omega, question->count, question->workspace);
}

PyObject *py_closed_chain_modes(PyObject *module, PyObject *arguments)
{
    struct py_chains parsed = {0};
    struct py_closed_modes made = {0};
    struct rd_workspace workspace = {0};
    const struct question question = {&parsed, &made.modes, &workspace, 0, NULL};
    const char *kind;
    Py_ssize_t number;
    PyObject *object[3], *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOOn", &kind, object, object + 1, object + 2, &number))
        return NULL;
    if (parse_chains(kind, object[0], object[1], object[2], &parsed) < 0)
        goto done;
    const size_t spans = parsed.chains.spans;
    if (py_closed_modes_make(parsed.rows, number, "number", parsed.chains.columns,
                             parsed.jacobian != NULL, &made) < 0)
        goto done;
    workspace.used = rd_chain_work(spans, made.modes.number);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    if (py_rows_solve(parsed.rows, spans * made.modes.number, solve_modes, &question) == 0)
        result = py_closed_modes_pack(&made);
done:
    PyMem_RawFree(workspace.base);
    py_closed_modes_release(&made);
    release_chains(&parsed);
    return result;
}

PyObject *py_closed_chain_count(PyObject *module, PyObject *arguments)
{
    struct py_chains parsed = {0};
    struct rd_workspace workspace = {0};
    struct question question = {.of = &parsed, .workspace = &workspace};
    const char *kind;
    PyObject *object[2], *count = NULL, *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOd", &kind, object, object + 1, &question.omega))
        return NULL;
    if (parse_chains(kind, object[0], object[1], Py_None, &parsed) < 0)
        goto done;
    workspace.used = rd_chain_work(parsed.chains.spans, 2);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    count = py_new(NPY_INT64, 1, (npy_intp[]){(npy_intp)parsed.rows});
    if (count == NULL)
        goto done;
    question.count = PyArray_DATA((PyArrayObject *)count);
    if (py_rows_solve(parsed.rows, 2 * parsed.chains.spans, solve_counts, &question) == 0)
        result = Py_NewRef(count);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(count);
    release_chains(&parsed);
    return result;
}
