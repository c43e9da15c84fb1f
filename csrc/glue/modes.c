/* Natural frequencies and shapes, with looks for Ctrl-C between the steps. */
#include "glue/glue.h"

#include "assembled/modes.h"

enum { SLICE = 64 }; /* columns of a dense matrix between two looks */

/* prepare, factorise and reduce to the standard problem; 0, or -1 and an exception */
static int reduce(PyObject *module, struct rd_modes *modes, double scale)
{
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_modes_factorise(modes, scale);
    Py_END_ALLOW_THREADS
    if (status != RD_OK) {
        py_raise(module, status);
        return -1;
    }
    const size_t n = modes->system.free;
    for (int side = 0; side < 2; side++) {
        for (size_t start = 0; start < n; start += SLICE) {
            Py_BEGIN_ALLOW_THREADS
            rd_modes_reduce(modes, start, start + SLICE < n ? start + SLICE : n);
            Py_END_ALLOW_THREADS
            if (PyErr_CheckSignals() < 0)
                return -1;
        }
        if (side == 0)
            rd_modes_transpose(modes);
    }
    return 0;
}

/* (eigenvalue (k), rounding (k), shape (k, nodes, width)) of the modes found */
static PyObject *build(struct rd_modes *modes, size_t found)
{
    const npy_intp nodes = (npy_intp)modes->system.assembly.nodes;
    const npy_intp w = (npy_intp)modes->system.assembly.width;
    const npy_intp shape[] = {(npy_intp)found, nodes, w};
    PyObject *result = NULL;
    PyObject *eigenvalue = py_new(NPY_DOUBLE, 1, shape);
    PyObject *rounding = py_new(NPY_DOUBLE, 1, shape);
    PyObject *shapes = py_new(NPY_DOUBLE, 3, shape);
    if (eigenvalue != NULL && rounding != NULL && shapes != NULL) {
        double *value = PyArray_DATA((PyArrayObject *)eigenvalue);
        double *error = PyArray_DATA((PyArrayObject *)rounding);
        double *u = PyArray_DATA((PyArrayObject *)shapes);
        Py_BEGIN_ALLOW_THREADS
        for (size_t k = 0; k < found; k++)
            rd_modes_read(modes, k, value + k, error + k, u + k * (size_t)(nodes * w));
        Py_END_ALLOW_THREADS
        result = PyTuple_Pack(3, eigenvalue, rounding, shapes);
    }
    Py_XDECREF(shapes);
    Py_XDECREF(rounding);
    Py_XDECREF(eigenvalue);
    return result;
}

PyObject *py_modes(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_modes modes;
    PyObject *object, *result = NULL;
    Py_ssize_t wanted;
    double below, scale;
    if (!PyArg_ParseTuple(arguments, "Ondd", &object, &wanted, &below, &scale))
        return NULL;
    if (py_chain_parse(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "modes") < 0)
        goto done;
    if (wanted < 0) {
        PyErr_SetString(PyExc_ValueError, "wanted must be >= 0");
        goto done;
    }
    const size_t columns = wanted > 0 ? (size_t)wanted : SIZE_MAX;
    rd_modes_prepare(&parsed.chain, columns, &modes, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    enum rd_status status = rd_modes_prepare(&parsed.chain, columns, &modes, &workspace);
    if (status != RD_OK) {
        py_raise(module, status);
        goto done;
    }
    size_t found = 0;
    if (modes.finite > 0) {
        if (reduce(module, &modes, scale) < 0)
            goto done;
        Py_BEGIN_ALLOW_THREADS
        status = rd_modes_solve(&modes, (size_t)wanted, below, &found);
        Py_END_ALLOW_THREADS
        if (status != RD_OK) {
            py_raise(module, status);
            goto done;
        }
    }
    PyObject *answer = build(&modes, found);
    if (answer != NULL)
        result = Py_BuildValue("Nn", answer, (Py_ssize_t)modes.finite);
done:
    PyMem_RawFree(workspace.base);
    py_chain_release(&parsed);
    return result;
}
