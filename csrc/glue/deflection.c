/* Static deflection under forces at the nodes. */
#include "glue/glue.h"

#include "assembled/deflection.h"

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
