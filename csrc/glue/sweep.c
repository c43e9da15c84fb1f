/* What sweeps at complex factors: frequency response and its cost. */
#include "glue/response.h"

#include "sweep/sweep.h"

/* the factors (RD_PARTS, count) as views of an array's rows */
static struct rd_factors factors_of(PyArrayObject *factor)
{
    const size_t count = (size_t)PyArray_DIM(factor, 1);
    const double *row = PyArray_DATA(factor);
    return (struct rd_factors){
        .count = count,
        .section = row,
        .tension = row + 2 * count,
        .spring = row + 4 * count,
        .inertia = row + 6 * count,
        .dashpot = row + 8 * count,
    };
}

/* (chain, factor): 0, or -1 and an exception; both are to be released */
static int parse_factored(PyObject *arguments, struct py_chain *parsed, PyArrayObject **factor)
{
    PyObject *chain, *given;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &given) || py_chain_view(chain, parsed) < 0)
        return -1;
    *factor = py_array(given, NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    return *factor == NULL ? -1 : 0;
}

PyObject *py_steps(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *result = NULL;
    if (parse_factored(arguments, &parsed, &factor) < 0)
        goto done;
    const struct rd_factors factors = factors_of(factor);
    size_t most = 0;
    for (size_t i = 0; i < factors.count; i++) {
        const struct sweep_extent extent = rd_sweep_extent(&factors, i);
        const size_t steps = rd_sweep_steps(&parsed.chain, &extent);
        most = steps > most ? steps : most;
    }
    result = PyLong_FromSize_t(most);
done:
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}

/* z (width, count) of all frequencies; 0, or -1 and an exception */
static int scales_fill(const struct rd_chain *chain, const struct rd_factors *factors, double *z)
{
    struct rd_runs runs;
    struct rd_run *run = PyMem_RawMalloc((rd_runs_capacity(chain) + 1) * sizeof *run);
    if (run == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    rd_runs_find(chain, run, &runs);
    for (size_t i = 0; i < factors->count; i++) {
        const struct sweep_extent extent = rd_sweep_extent(factors, i);
        double own[RD_WIDTH_MAX];
        rd_sweep_receptance(chain, &runs, &extent, own);
        for (size_t c = 0; c < chain->width; c++)
            z[c * factors->count + i] = own[c];
    }
    PyMem_RawFree(run);
    return 0;
}

PyObject *py_scales(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *z = NULL, *result = NULL;
    if (parse_factored(arguments, &parsed, &factor) < 0)
        goto done;
    const struct rd_factors factors = factors_of(factor);
    z = py_new(NPY_DOUBLE, 2, (npy_intp[]){(npy_intp)parsed.chain.width, (npy_intp)factors.count});
    if (z != NULL && scales_fill(&parsed.chain, &factors, PyArray_DATA((PyArrayObject *)z)) == 0)
        result = Py_NewRef(z);
done:
    Py_XDECREF(z);
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}

/* the index of the frequency that has no answer, or the count of all; -1 and an exception */
static npy_intp solve(PyObject *module, const struct py_response *response)
{
    const struct rd_chain *chain = &response->parsed.chain;
    const struct rd_ports *drives = &response->drives.ports;
    const struct rd_ports *responses = &response->responses.ports;
    const struct rd_factors factors = factors_of(response->factor);
    double *value = PyArray_DATA((PyArrayObject *)response->value);
    double *error = PyArray_DATA((PyArrayObject *)response->error);
    struct rd_workspace workspace = {0};
    size_t failed = 0;
    npy_intp solved = -1;
    enum rd_status status =
        rd_frf_sweep(chain, &factors, drives, responses, &workspace, NULL, NULL, &failed);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    status = rd_frf_sweep(chain, &factors, drives, responses, &workspace, value, error, &failed);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        solved = response->count;
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
    struct py_response response = {0};
    PyObject *result = NULL;
    if (py_response_parse(arguments, PY_FREQUENCY_LAST, &response) < 0)
        goto done;
    const npy_intp solved = solve(module, &response);
    if (solved >= 0)
        result = Py_BuildValue("OOn", response.value, response.error, (Py_ssize_t)solved);
done:
    py_response_release(&response);
    return result;
}
