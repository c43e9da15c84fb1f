/* Frequency response, in slices of frequencies. */
#include "py_glue.h"

#include "frf.h"

enum { SLICE = 1 << 16 }; /* nodes times frequencies between two looks for Ctrl-C */

struct answer {
    double _Complex *value; /* (frequencies, drives, responses) */
    double *rounding;       /* (frequencies, drives, responses) */
    double *motion;         /* (frequencies, drives) */
};

/* solves frequencies start ... stop - 1; the index of the one that failed, or stop */
static npy_intp solve(struct rd_frf *frf, const double _Complex *factor, npy_intp start,
                      npy_intp stop, const struct answer *answer)
{
    const npy_intp drives = (npy_intp)frf->drives.count;
    const npy_intp size = drives * (npy_intp)frf->responses.count;
    for (npy_intp i = start; i < stop; i++)
        if (rd_frf_solve(frf, factor + i * RD_PARTS, answer->value + i * size,
                         answer->rounding + i * size, answer->motion + i * drives) != RD_OK)
            return i;
    return stop;
}

/* how many frequencies were solved before one failed, or -1 and an exception */
static npy_intp solve_all(PyObject *module, const struct rd_chain *chain,
                          const struct rd_ports *drives, const struct rd_ports *responses,
                          PyArrayObject *factor, const struct answer *answer)
{
    struct rd_workspace workspace = {0};
    struct rd_frf frf;
    const npy_intp count = PyArray_DIM(factor, 0);
    const npy_intp slice = 1 + SLICE / (npy_intp)chain->nodes;
    npy_intp solved = -1;
    rd_frf_prepare(chain, drives, responses, &frf, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_frf_prepare(chain, drives, responses, &frf, &workspace);
    Py_END_ALLOW_THREADS
    if (status != RD_OK) {
        py_raise(module, status);
        goto done;
    }
    solved = 0;
    for (npy_intp start = 0; start < count; start = solved) {
        const npy_intp stop = start + slice < count ? start + slice : count;
        Py_BEGIN_ALLOW_THREADS
        solved = solve(&frf, PyArray_DATA(factor), start, stop, answer);
        Py_END_ALLOW_THREADS
        if (PyErr_CheckSignals() < 0)
            solved = -1;
        if (solved < stop)
            break;
    }
done:
    PyMem_RawFree(workspace.base);
    return solved;
}

PyObject *py_frf(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct py_ports drives = {0}, responses = {0};
    PyArrayObject *factor = NULL;
    PyObject *object[4], *value = NULL, *rounding = NULL, *motion = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    if (py_chain_parse(object[0], &parsed) < 0 ||
        py_ports_parse(object[2], &parsed.chain, "drives", &drives) < 0 ||
        py_ports_parse(object[3], &parsed.chain, "responses", &responses) < 0)
        goto done;
    factor = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){-1, RD_PARTS}, "factor");
    if (factor == NULL)
        goto done;
    const npy_intp shape[] = {PyArray_DIM(factor, 0), (npy_intp)drives.ports.count,
                              (npy_intp)responses.ports.count};
    value = py_new(NPY_COMPLEX128, 3, shape);
    rounding = py_new(NPY_DOUBLE, 3, shape);
    motion = py_new(NPY_DOUBLE, 2, shape);
    if (value == NULL || rounding == NULL || motion == NULL)
        goto done;
    const struct answer answer = {
        .value = PyArray_DATA((PyArrayObject *)value),
        .rounding = PyArray_DATA((PyArrayObject *)rounding),
        .motion = PyArray_DATA((PyArrayObject *)motion),
    };
    const npy_intp solved =
        solve_all(module, &parsed.chain, &drives.ports, &responses.ports, factor, &answer);
    if (solved >= 0)
        result = Py_BuildValue("OOOn", value, rounding, motion, (Py_ssize_t)solved);
done:
    Py_XDECREF(motion);
    Py_XDECREF(rounding);
    Py_XDECREF(value);
    Py_XDECREF(factor);
    py_ports_release(&responses);
    py_ports_release(&drives);
    py_chain_release(&parsed);
    return result;
}
