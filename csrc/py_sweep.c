/* Frequency response by the sweep, and the runs it needs to know. */
#include "py_glue.h"

#include "sweep.h"

/* the tuple (run (count, 2), average) that py_runs made, as a view; the averages are length,
   tension, flexibility, mass (width) and the rigid body's sums */
struct py_runs {
    struct rd_runs runs;
    PyArrayObject *run;
    PyArrayObject *average;
};

enum { AVERAGES = 2 + RD_CHANNELS, BODY = sizeof(struct rd_body) / sizeof(double) };

static int runs_parse(PyObject *object, const struct rd_chain *chain, struct py_runs *parsed)
{
    PyObject *run, *average;
    if (!PyTuple_Check(object)) {
        PyErr_SetString(PyExc_TypeError, "runs must be a tuple");
        return -1;
    }
    if (!PyArg_ParseTuple(object, "OO", &run, &average))
        return -1;
    parsed->run = py_array(run, NPY_UINTP, 2, (npy_intp[]){-1, 2}, "run");
    if (parsed->run == NULL)
        return -1;
    parsed->average = py_array(average, NPY_DOUBLE, 1,
                               (npy_intp[]){AVERAGES + BODY + (npy_intp)chain->width}, "average");
    if (parsed->average == NULL)
        return -1;
    struct rd_runs *runs = &parsed->runs;
    const double *value = PyArray_DATA(parsed->average);
    runs->count = (size_t)PyArray_DIM(parsed->run, 0);
    runs->run = PyArray_DATA(parsed->run);
    runs->length = value[0];
    runs->tension = value[1];
    memcpy(runs->flexibility, value + 2, sizeof runs->flexibility);
    memcpy(runs->mass, value + AVERAGES, chain->width * sizeof *runs->mass);
    memcpy(&runs->body, value + AVERAGES + chain->width, sizeof runs->body);
    runs->longest = 0;
    size_t end = 0;
    for (size_t k = 0; k < runs->count; k++) {
        const struct rd_run run_k = runs->run[k];
        if (run_k.first < end || run_k.last <= run_k.first || run_k.last >= chain->nodes) {
            PyErr_SetString(PyExc_ValueError, "run must hold increasing stretches of the chain");
            return -1;
        }
        end = run_k.last;
        const size_t length = run_k.last - run_k.first;
        runs->longest = length > runs->longest ? length : runs->longest;
    }
    return 0;
}

PyObject *py_runs(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyObject *object, *run = NULL, *average = NULL, *result = NULL;
    struct rd_run *found = NULL;
    if (!PyArg_ParseTuple(arguments, "O", &object))
        return NULL;
    if (py_chain_parse(object, &parsed) < 0)
        goto done;
    found = PyMem_RawMalloc(rd_runs_capacity(&parsed.chain) * sizeof *found);
    if (found == NULL) {
        PyErr_NoMemory();
        goto done;
    }
    struct rd_runs runs;
    Py_BEGIN_ALLOW_THREADS
    rd_runs_find(&parsed.chain, found, &runs);
    Py_END_ALLOW_THREADS
    run = py_new(NPY_UINTP, 2, (npy_intp[]){(npy_intp)runs.count, 2});
    average = py_new(NPY_DOUBLE, 1, (npy_intp[]){AVERAGES + BODY + (npy_intp)parsed.chain.width});
    if (run == NULL || average == NULL)
        goto done;
    memcpy(PyArray_DATA((PyArrayObject *)run), found, runs.count * sizeof *found);
    double *value = PyArray_DATA((PyArrayObject *)average);
    value[0] = runs.length;
    value[1] = runs.tension;
    memcpy(value + 2, runs.flexibility, sizeof runs.flexibility);
    memcpy(value + AVERAGES, runs.mass, parsed.chain.width * sizeof *runs.mass);
    memcpy(value + AVERAGES + parsed.chain.width, &runs.body, sizeof runs.body);
    result = PyTuple_Pack(2, run, average);
done:
    PyMem_RawFree(found);
    Py_XDECREF(average);
    Py_XDECREF(run);
    py_chain_release(&parsed);
    return result;
}

struct sweep_task {
    const struct rd_chain *chain;
    const struct rd_runs *runs;
    const struct rd_ports *drives;
    const struct rd_ports *responses;
    struct rd_factors factors;
    double *value;
    double *error;
};

/* solves the task; the index of the frequency that has no answer, or the count of all; -1 and an
   exception */
static npy_intp solve(PyObject *module, const struct sweep_task *task)
{
    struct rd_workspace workspace = {0};
    size_t failed = 0;
    npy_intp solved = -1;
    enum rd_status status = rd_frf_sweep(task->chain, task->runs, &task->factors, task->drives,
                                         task->responses, &workspace, NULL, NULL, &failed);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    status = rd_frf_sweep(task->chain, task->runs, &task->factors, task->drives, task->responses,
                          &workspace, task->value, task->error, &failed);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        solved = (npy_intp)task->factors.count;
    else if (status == RD_SINGULAR)
        solved = (npy_intp)failed;
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    return solved;
}

PyObject *py_sweep(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct py_runs runs = {0};
    struct py_ports drives = {0}, responses = {0};
    PyArrayObject *factor = NULL;
    PyObject *object[5], *value = NULL, *error = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOOO", object, object + 1, object + 2, object + 3,
                          object + 4))
        return NULL;
    if (py_chain_parse(object[0], &parsed) < 0 || runs_parse(object[1], &parsed.chain, &runs) < 0 ||
        py_ports_parse(object[3], &parsed.chain, "drives", &drives) < 0 ||
        py_ports_parse(object[4], &parsed.chain, "responses", &responses) < 0)
        goto done;
    factor = py_array(object[2], NPY_COMPLEX128, 2, (npy_intp[]){4, -1}, "factor");
    if (factor == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(factor, 1);
    const npy_intp shape[] = {(npy_intp)drives.ports.count, (npy_intp)responses.ports.count, count};
    value = py_new(NPY_COMPLEX128, 3, shape);
    error = py_new(NPY_DOUBLE, 3, shape);
    if (value == NULL || error == NULL)
        goto done;
    const double *row = PyArray_DATA(factor);
    const struct sweep_task task = {
        .chain = &parsed.chain,
        .runs = &runs.runs,
        .drives = &drives.ports,
        .responses = &responses.ports,
        .factors = {(size_t)count, row, row + 2 * count, row + 4 * count, row + 6 * count},
        .value = PyArray_DATA((PyArrayObject *)value),
        .error = PyArray_DATA((PyArrayObject *)error),
    };
    const npy_intp solved = solve(module, &task);
    if (solved >= 0)
        result = Py_BuildValue("OOn", value, error, (Py_ssize_t)solved);
done:
    Py_XDECREF(error);
    Py_XDECREF(value);
    Py_XDECREF(factor);
    py_ports_release(&responses);
    py_ports_release(&drives);
    Py_XDECREF(runs.average);
    Py_XDECREF(runs.run);
    py_chain_release(&parsed);
    return result;
}
