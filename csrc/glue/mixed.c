/* Frequency response and static deflection by the mixed form. */
#include "glue/response.h"

#include "mixed/deflection.h"
#include "mixed/frf.h"

/* solves frequency after frequency; how many before one that has no answer */
static npy_intp solve_each(struct rd_mixed_frf *frf, const struct py_response *response,
                           const struct rd_stop *stop, enum rd_status *status)
{
    const npy_intp count = response->count;
    const double _Complex *parts = PyArray_DATA(response->factor);
    double _Complex *value = PyArray_DATA((PyArrayObject *)response->value);
    double *error = PyArray_DATA((PyArrayObject *)response->error);
    for (npy_intp i = 0; i < count; i++) {
        double _Complex factor[RD_PARTS];
        for (int k = 0; k < RD_PARTS; k++)
            factor[k] = parts[k * count + i];
        *status = rd_stop_is_asked(stop)
                      ? RD_INTERRUPTED
                      : rd_mixed_frf_solve(frf, factor, (size_t)count, value + i, error + i);
        if (*status != RD_OK)
            return i;
    }
    return count;
}

/* the same from the measuring of memory on; -1 and an exception */
static npy_intp solve_all(PyObject *module, const struct py_response *response)
{
    const struct rd_chain *chain = &response->parsed.chain;
    const struct rd_ports *drives = &response->drives.ports;
    const struct rd_ports *responses = &response->responses.ports;
    struct rd_workspace workspace = {0};
    struct rd_mixed_frf frf;
    npy_intp solved = -1;
    rd_mixed_frf_prepare(chain, drives, responses, &frf, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        return -1;
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    enum rd_status status = rd_mixed_frf_prepare(chain, drives, responses, &frf, &workspace);
    frf.mixed.lu.stop = stop;
    if (status == RD_OK)
        solved = solve_each(&frf, response, &stop, &status);
    PyMem_RawFree(workspace.base);
    if (py_watch_end(&watch) < 0)
        return -1;
    if (status == RD_OK || status == RD_SINGULAR)
        return solved;
    py_raise(module, status);
    return -1;
}

PyObject *py_mixed(PyObject *module, PyObject *arguments)
{
    struct py_response response = {0};
    PyObject *result = NULL;
    if (py_response_parse(arguments, PY_FREQUENCY_LAST, &response) < 0 ||
        py_chain_is_lumped(&response.parsed, "mixed") < 0 || py_chain_expand(&response.parsed) < 0)
        goto done;
    const npy_intp solved = solve_all(module, &response);
    if (solved >= 0)
        result = Py_BuildValue("OOn", response.value, response.error, (Py_ssize_t)solved);
done:
    py_response_release(&response);
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
    if (py_chain_parse(chain, &parsed) < 0 || py_chain_is_lumped(&parsed, "mixed_deflection") < 0)
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
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    enum rd_status status = rd_mixed_deflection_prepare(&parsed.chain, &deflection, &workspace);
    deflection.mixed.lu.stop = stop;
    if (status == RD_OK)
        status = rd_mixed_deflection_solve(&deflection, PyArray_DATA(load),
                                           PyArray_DATA((PyArrayObject *)displacement),
                                           PyArray_DATA((PyArrayObject *)force));
    if (py_watch_end(&watch) < 0)
        goto done;
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
