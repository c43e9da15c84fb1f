/* Frequency response by the sweep, and what it costs. */
#include "py_glue.h"

#include "sweep.h"

/* the factors (4, count) as views of an array's rows */
static struct rd_factors factors_of(PyArrayObject *factor)
{
    const size_t count = (size_t)PyArray_DIM(factor, 1);
    const double *row = PyArray_DATA(factor);
    return (struct rd_factors){count, row, row + 2 * count, row + 4 * count, row + 6 * count};
}

PyObject *py_steps(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *object[2], *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", object, object + 1))
        return NULL;
    if (py_chain_view(object[0], &parsed) < 0)
        goto done;
    factor = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){4, -1}, "factor");
    if (factor == NULL)
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

struct sweep_task {
    const struct rd_chain *chain;
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
    enum rd_status status = rd_frf_sweep(task->chain, &task->factors, task->drives, task->responses,
                                         &workspace, NULL, NULL, &failed);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    status = rd_frf_sweep(task->chain, &task->factors, task->drives, task->responses, &workspace,
                          task->value, task->error, &failed);
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
    struct py_ports drives = {0}, responses = {0};
    PyArrayObject *factor = NULL;
    PyObject *object[4], *value = NULL, *error = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    if (py_chain_view(object[0], &parsed) < 0 ||
        py_ports_parse(object[2], &parsed.chain, "drives", &drives) < 0 ||
        py_ports_parse(object[3], &parsed.chain, "responses", &responses) < 0)
        goto done;
    factor = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){4, -1}, "factor");
    if (factor == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(factor, 1);
    const npy_intp shape[] = {(npy_intp)drives.ports.count, (npy_intp)responses.ports.count, count};
    value = py_new(NPY_COMPLEX128, 3, shape);
    error = py_new(NPY_DOUBLE, 3, shape);
    if (value == NULL || error == NULL)
        goto done;
    const struct sweep_task task = {
        .chain = &parsed.chain,
        .drives = &drives.ports,
        .responses = &responses.ports,
        .factors = factors_of(factor),
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
    py_chain_release(&parsed);
    return result;
}
