/* Frequency response and static deflection by the mixed form. */
#include "py_glue.h"

#include "mixed_deflection.h"
#include "mixed_frf.h"

struct task {
    struct rd_mixed_frf frf;
    const struct rd_chain *chain;
    const struct rd_ports *drives;
    const struct rd_ports *responses;
    npy_intp count;                /* frequencies */
    const double _Complex *factor; /* (RD_PARTS, count) */
    double _Complex *value;        /* (drives, responses, count) */
    double *error;
};

/* solves frequency after frequency; how many before one that has no answer */
static npy_intp solve_each(struct task *task, enum rd_status *status)
{
    for (npy_intp i = 0; i < task->count; i++) {
        double _Complex factor[RD_PARTS];
        for (int k = 0; k < RD_PARTS; k++)
            factor[k] = task->factor[k * task->count + i];
        *status = rd_mixed_frf_solve(&task->frf, factor, (size_t)task->count, task->value + i,
                                     task->error + i);
        if (*status != RD_OK)
            return i;
    }
    return task->count;
}

/* the same from the measuring of memory on; -1 and an exception */
static npy_intp solve_all(PyObject *module, struct task *task)
{
    struct rd_workspace workspace = {0};
    npy_intp solved = -1;
    rd_mixed_frf_prepare(task->chain, task->drives, task->responses, &task->frf, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        return -1;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status =
        rd_mixed_frf_prepare(task->chain, task->drives, task->responses, &task->frf, &workspace);
    if (status == RD_OK)
        solved = solve_each(task, &status);
    Py_END_ALLOW_THREADS
    PyMem_RawFree(workspace.base);
    if (status == RD_OK || status == RD_SINGULAR)
        return solved;
    py_raise(module, status);
    return -1;
}

PyObject *py_mixed(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct py_ports drives = {0}, responses = {0};
    PyArrayObject *factor = NULL;
    PyObject *object[4], *value = NULL, *error = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    if (py_chain_parse(object[0], &parsed) < 0 ||
        py_ports_parse(object[2], &parsed.chain, "drives", &drives) < 0 ||
        py_ports_parse(object[3], &parsed.chain, "responses", &responses) < 0)
        goto done;
    factor = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    if (factor == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(factor, 1);
    const npy_intp shape[] = {(npy_intp)drives.ports.count, (npy_intp)responses.ports.count, count};
    value = py_new(NPY_COMPLEX128, 3, shape);
    error = py_new(NPY_DOUBLE, 3, shape);
    if (value == NULL || error == NULL)
        goto done;
    struct task task = {
        .chain = &parsed.chain,
        .drives = &drives.ports,
        .responses = &responses.ports,
        .count = count,
        .factor = PyArray_DATA(factor),
        .value = PyArray_DATA((PyArrayObject *)value),
        .error = PyArray_DATA((PyArrayObject *)error),
    };
    const npy_intp solved = solve_all(module, &task);
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

PyObject *py_mixed_deflection(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_mixed_deflection deflection;
    PyArrayObject *load = NULL;
    PyObject *chain, *object, *displacement = NULL, *force = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &object))
        return NULL;
    if (py_chain_parse(chain, &parsed) < 0)
        goto done;
    const npy_intp shape[] = {(npy_intp)parsed.chain.nodes, (npy_intp)parsed.chain.width};
    load = py_array(object, NPY_DOUBLE, 2, shape, "force");
    displacement = py_new(NPY_DOUBLE, 2, shape);
    force = py_new(NPY_DOUBLE, 2, (npy_intp[]){shape[0] - 1, shape[1]});
    if (load == NULL || displacement == NULL || force == NULL)
        goto done;
    rd_mixed_deflection_prepare(&parsed.chain, &deflection, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_mixed_deflection_prepare(&parsed.chain, &deflection, &workspace);
    if (status == RD_OK)
        status = rd_mixed_deflection_solve(&deflection, PyArray_DATA(load),
                                           PyArray_DATA((PyArrayObject *)displacement),
                                           PyArray_DATA((PyArrayObject *)force));
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(2, displacement, force);
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(force);
    Py_XDECREF(displacement);
    Py_XDECREF(load);
    py_chain_release(&parsed);
    return result;
}
