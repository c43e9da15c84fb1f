/* How the tips of the structures move that nodes carry. */
#include "glue/glue.h"

#include "chain/attached.h"

PyObject *py_tip(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *object, *factors, *rows = NULL, *result = NULL;
    Py_ssize_t k;
    if (!PyArg_ParseTuple(arguments, "OnO", &object, &k, &factors))
        return NULL;
    if (py_chain_view(object, &parsed) < 0)
        goto done;
    if (k < 0 || (size_t)k >= parsed.chain.attached) {
        PyErr_Format(PyExc_ValueError, "k must lie in 0 ... %zd, got %zd",
                     (Py_ssize_t)parsed.chain.attached - 1, k);
        goto done;
    }
    factor = py_array(factors, NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    if (factor == NULL)
        goto done;
    const size_t count = (size_t)PyArray_DIM(factor, 1), w = parsed.chain.width;
    rows = PyArray_SimpleNew(2, ((npy_intp[]){(npy_intp)w, (npy_intp)count}), NPY_COMPLEX128);
    if (rows == NULL)
        goto done;
    const double _Complex *of = PyArray_DATA(factor);
    double _Complex *to = PyArray_DATA((PyArrayObject *)rows);
    for (size_t i = 0; i < count; i++) {
        double _Complex row[RD_WIDTH_MAX];
        rd_attached_tip(&parsed.chain, (size_t)k, of[RD_MASS * count + i],
                        of[RD_DASHPOTS * count + i], row);
        for (size_t c = 0; c < w; c++)
            to[c * count + i] = row[c];
    }
    result = Py_NewRef(rows);
done:
    Py_XDECREF(rows);
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}
