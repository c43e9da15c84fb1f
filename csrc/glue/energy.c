/* Energies of shapes. */
#include "glue/glue.h"

#include "energy/energy.h"

PyObject *py_energy(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    PyArrayObject *shapes = NULL, *lambdas = NULL;
    PyObject *chain, *object, *eigenvalues, *strain = NULL, *kinetic = NULL, *dragged = NULL;
    PyObject *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOO", &chain, &object, &eigenvalues))
        return NULL;
    if (py_chain_parse(chain, &parsed) < 0)
        goto done;
    const size_t w = parsed.chain.width;
    const size_t entries = parsed.chain.nodes * w;
    shapes = py_array(object, NPY_DOUBLE, 3,
                      (npy_intp[]){-1, (npy_intp)parsed.chain.nodes, (npy_intp)w}, "shape");
    if (shapes == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(shapes, 0);
    lambdas = py_array(eigenvalues, NPY_DOUBLE, 1, &count, "eigenvalue");
    if (lambdas == NULL)
        goto done;
    strain = py_new(NPY_DOUBLE, 2, (npy_intp[]){count, RD_STRAINS});
    kinetic = py_new(NPY_DOUBLE, 2, (npy_intp[]){count, (npy_intp)w});
    dragged = py_new(NPY_DOUBLE, 1, (npy_intp[]){count});
    if (strain == NULL || kinetic == NULL || dragged == NULL)
        goto done;
    const double *u = PyArray_DATA(shapes), *lambda = PyArray_DATA(lambdas);
    double *stored = PyArray_DATA((PyArrayObject *)strain);
    double *moving = PyArray_DATA((PyArrayObject *)kinetic);
    double *lost = PyArray_DATA((PyArrayObject *)dragged);
    enum rd_status status = RD_OK;
    Py_BEGIN_ALLOW_THREADS
    for (size_t k = 0; k < (size_t)count && status == RD_OK; k++)
        status = rd_energy(&parsed.chain, lambda[k], u + k * entries, stored + k * RD_STRAINS,
                           moving + k * w, lost + k);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(3, strain, kinetic, dragged);
    else
        py_raise(module, status);
done:
    Py_XDECREF(dragged);
    Py_XDECREF(kinetic);
    Py_XDECREF(strain);
    Py_XDECREF(lambdas);
    Py_XDECREF(shapes);
    py_chain_release(&parsed);
    return result;
}
