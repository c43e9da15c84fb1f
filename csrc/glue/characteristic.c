/* The characteristic function. */
#include "glue/factors.h"

#include "sweep/characteristic.h"

PyObject *py_characteristic(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    PyArrayObject *factor = NULL, *bound = NULL;
    PyObject *object[3], *value = NULL, *magnitude = NULL, *result = NULL;
    size_t steps = 0;
    if (!PyArg_ParseTuple(arguments, "OOO", object, object + 1, object + 2))
        return NULL;
    if (py_chain_view(object[0], &parsed) < 0)
        goto done;
    factor = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    bound =
        factor ? py_array(object[2], NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, 1}, "bound") : NULL;
    if (bound == NULL)
        goto done;
    const struct rd_factors factors = py_factors_of(factor), most = py_factors_of(bound);
    const npy_intp count = (npy_intp)factors.count;
    value = py_new(NPY_COMPLEX128, 1, &count);
    magnitude = value ? py_new(NPY_FLOAT64, 1, &count) : NULL;
    if (magnitude == NULL)
        goto done;
    double *v = PyArray_DATA((PyArrayObject *)value), *m = PyArray_DATA((PyArrayObject *)magnitude);
    enum rd_status status =
        rd_characteristic(&parsed.chain, &factors, &most, &workspace, v, m, &steps);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    status = rd_characteristic(&parsed.chain, &factors, &most, &workspace, v, m, &steps);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = Py_BuildValue("OOn", value, magnitude, (Py_ssize_t)steps);
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(value);
    Py_XDECREF(magnitude);
    Py_XDECREF(factor);
    Py_XDECREF(bound);
    py_chain_release(&parsed);
    return result;
}
