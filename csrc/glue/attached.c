/* How the tips of the wires move that nodes carry. */
#include "glue/glue.h"

#include "chain/attached.h"

enum { TIPS = 3 }; /* itself, by stiffness, by damping ratio */

PyObject *py_tip(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *object, *factors, *tips = NULL, *result = NULL;
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
    const size_t count = (size_t)PyArray_DIM(factor, 1);
    tips = py_new(NPY_COMPLEX128, 3, (npy_intp[]){TIPS, 2, (npy_intp)count});
    if (tips == NULL)
        goto done;
    const double _Complex *of = PyArray_DATA(factor);
    double _Complex *to = PyArray_DATA((PyArrayObject *)tips);
    for (size_t i = 0; i < count; i++) {
        double _Complex tip[2 * TIPS];
        rd_attached_tip(&parsed.chain, (size_t)k, of[RD_MASS * count + i],
                        of[RD_DASHPOTS * count + i], tip);
        for (size_t n = 0; n < 2 * TIPS; n++)
            to[n * count + i] = tip[n];
    }
    result = Py_NewRef(tips);
done:
    Py_XDECREF(tips);
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}
