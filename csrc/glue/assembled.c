/* The assembled chain: its matrices for reading, static deflection, frequency response. */
#include "glue/response.h"

#include "assembled/assemble.h"
#include "assembled/deflection.h"
#include "assembled/frf.h"

enum { ARRAYS = 7 };

PyObject *py_assemble(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    PyObject *object, *array[ARRAYS] = {NULL}, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O", &object))
        return NULL;
    if (py_chain_parse(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "assemble") < 0)
        goto done;
    const npy_intp nodes = (npy_intp)parsed.chain.nodes;
    const npy_intp w = (npy_intp)parsed.chain.width;
    double *data[ARRAYS];
    for (int k = 0; k < ARRAYS; k++) {
        const npy_intp count = k == 1 || k == 3 ? nodes - 1 : nodes;
        array[k] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, w, w});
        if (array[k] == NULL)
            goto done;
        data[k] = PyArray_DATA((PyArrayObject *)array[k]);
    }
    struct rd_assembly assembly = {
        .elastic = {data[0], data[1]},
        .string = {data[2], data[3]},
        .springs = data[4],
        .mass = data[5],
        .dashpots = data[6],
    };
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_assemble(&parsed.chain, &assembly);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(ARRAYS, array[0], array[1], array[2], array[3], array[4], array[5],
                              array[6]);
    else
        py_raise(module, status);
done:
    for (int k = 0; k < ARRAYS; k++)
        Py_XDECREF(array[k]);
    py_chain_release(&parsed);
    return result;
}

PyObject *py_deflection(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_deflection deflection;
    PyArrayObject *force = NULL;
    PyObject *chain, *load, *displacement = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &load))
        return NULL;
    if (py_chain_parse(chain, &parsed) < 0 || py_chain_is_lumped(&parsed, "deflection") < 0)
        goto done;
    const npy_intp shape[] = {(npy_intp)parsed.chain.nodes, (npy_intp)parsed.chain.width};
    force = py_array(load, NPY_DOUBLE, 2, shape, "force");
    displacement = py_new(NPY_DOUBLE, 2, shape);
    if (force == NULL || displacement == NULL)
        goto done;
    rd_deflection_prepare(&parsed.chain, &deflection, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    double condition;
    Py_BEGIN_ALLOW_THREADS
    status = rd_deflection_prepare(&parsed.chain, &deflection, &workspace);
    if (status == RD_OK)
        status = rd_deflection_solve(&deflection, PyArray_DATA(force),
                                     PyArray_DATA((PyArrayObject *)displacement), &condition);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = Py_BuildValue("Od", displacement, condition);
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(displacement);
    Py_XDECREF(force);
    py_chain_release(&parsed);
    return result;
}

/* solves one frequency after the other; the index of the one that failed or was left, or count */
static npy_intp solve(struct rd_frf *frf, const struct py_response *response,
                      const struct rd_stop *stop, double *motion)
{
    const npy_intp drives = (npy_intp)frf->drives.count;
    const npy_intp size = drives * (npy_intp)frf->responses.count;
    const double _Complex *factor = PyArray_DATA(response->factor);
    double _Complex *value = PyArray_DATA((PyArrayObject *)response->value);
    double *rounding = PyArray_DATA((PyArrayObject *)response->error);
    npy_intp i = 0;
    while (i < response->count && !rd_stop_is_asked(stop) &&
           rd_frf_solve(frf, factor + i * RD_PARTS, stop, value + i * size, rounding + i * size,
                        motion + i * drives) == RD_OK)
        i++;
    return i;
}

/* how many frequencies were solved before one failed, or -1 and an exception */
static npy_intp solve_all(PyObject *module, const struct py_response *response, double *motion)
{
    const struct rd_chain *chain = &response->parsed.chain;
    const struct rd_ports *drives = &response->drives.ports;
    const struct rd_ports *responses = &response->responses.ports;
    struct rd_workspace workspace = {0};
    struct rd_frf frf;
    npy_intp solved = -1;
    rd_frf_prepare(chain, drives, responses, &frf, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    const enum rd_status status = rd_frf_prepare(chain, drives, responses, &frf, &workspace);
    if (status == RD_OK)
        solved = solve(&frf, response, &stop, motion);
    if (py_watch_end(&watch) < 0)
        solved = -1;
    else if (status != RD_OK)
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    return solved;
}

PyObject *py_frf(PyObject *module, PyObject *arguments)
{
    struct py_response response = {0};
    PyObject *motion = NULL, *result = NULL;
    if (py_response_parse(arguments, PY_FREQUENCY_FIRST, &response) < 0 ||
        py_chain_is_lumped(&response.parsed, "frf") < 0 || py_chain_expand(&response.parsed) < 0)
        goto done;
    motion =
        py_new(NPY_DOUBLE, 2, (npy_intp[]){response.count, (npy_intp)response.drives.ports.count});
    if (motion == NULL)
        goto done;
    const npy_intp solved = solve_all(module, &response, PyArray_DATA((PyArrayObject *)motion));
    if (solved >= 0)
        result = Py_BuildValue("OOOn", response.value, response.error, motion, (Py_ssize_t)solved);
done:
    Py_XDECREF(motion);
    py_response_release(&response);
    return result;
}
