/* How the forms of modes change with the numbers of each stretch. */
#include "glue/glue.h"

#include "energy/sensitivity.h"

struct slopes {
    PyObject *element, *jump, *node;
};

/* mode after mode: slopes (stretches - 1, RD_PROPERTIES), jumps (stretches - 1, width), dyads
   (stretches, width, width) */
static enum rd_status fill(const struct rd_chain *chain, double lambda, const double *shape,
                           size_t mode, const struct slopes *slopes)
{
    const size_t w = chain->width, between = chain->stretches - 1;
    double *slope = PyArray_DATA((PyArrayObject *)slopes->element);
    double *jump = PyArray_DATA((PyArrayObject *)slopes->jump);
    double *dyad = PyArray_DATA((PyArrayObject *)slopes->node);
    enum rd_status status = RD_OK;
    struct rd_sensitivity sensitivity;
    rd_sensitivity_begin(chain, lambda, &sensitivity);
    for (size_t k = 0; k < chain->stretches; k++)
        rd_sensitivity_nodes(chain, k, shape, dyad + (mode * chain->stretches + k) * w * w);
    for (size_t k = 0; k < between && status == RD_OK; k++)
        status = rd_sensitivity_stretch(&sensitivity, k, shape,
                                        slope + (mode * between + k) * RD_PROPERTIES,
                                        jump + (mode * between + k) * w);
    return status;
}

PyObject *py_sensitivity(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    PyArrayObject *shapes = NULL, *lambdas = NULL;
    PyObject *chain, *object, *eigenvalues, *result = NULL;
    struct slopes slopes = {0};
    if (!PyArg_ParseTuple(arguments, "OOO", &chain, &object, &eigenvalues))
        return NULL;
    if (py_chain_parse(chain, &parsed) < 0)
        goto done;
    const npy_intp w = (npy_intp)parsed.chain.width;
    const npy_intp nodes = (npy_intp)parsed.chain.nodes;
    const npy_intp stretches = (npy_intp)parsed.chain.stretches;
    shapes = py_array(object, NPY_DOUBLE, 3, (npy_intp[]){-1, nodes, w}, "shape");
    if (shapes == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(shapes, 0);
    lambdas = py_array(eigenvalues, NPY_DOUBLE, 1, &count, "eigenvalue");
    if (lambdas == NULL)
        goto done;
    slopes.element = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, RD_PROPERTIES});
    slopes.jump = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, w});
    slopes.node = py_new(NPY_DOUBLE, 4, (npy_intp[]){count, stretches, w, w});
    if (slopes.element == NULL || slopes.jump == NULL || slopes.node == NULL)
        goto done;
    const double *u = PyArray_DATA(shapes), *lambda = PyArray_DATA(lambdas);
    enum rd_status status = RD_OK;
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp k = 0; k < count && status == RD_OK; k++)
        status = fill(&parsed.chain, lambda[k], u + k * nodes * w, (size_t)k, &slopes);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(3, slopes.element, slopes.jump, slopes.node);
    else
        py_raise(module, status);
done:
    Py_XDECREF(slopes.node);
    Py_XDECREF(slopes.jump);
    Py_XDECREF(slopes.element);
    Py_XDECREF(lambdas);
    Py_XDECREF(shapes);
    py_chain_release(&parsed);
    return result;
}
