/* Structures that nodes carry: their energies in modes, and how their tips move. */
#include "py_glue.h"

#include "attached.h"

PyObject *py_carried(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *shapes = NULL, *motions = NULL, *lambdas = NULL;
    PyObject *object[4], *energy = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    if (py_chain_view(object[0], &parsed) < 0)
        goto done;
    const struct rd_chain *chain = &parsed.chain;
    const npy_intp nodes = (npy_intp)chain->nodes, width = (npy_intp)chain->width;
    shapes = py_array(object[1], NPY_DOUBLE, 3, (npy_intp[]){-1, nodes, width}, "shape");
    if (shapes == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(shapes, 0), carried = (npy_intp)chain->attached;
    motions = py_array(object[2], NPY_DOUBLE, 2, (npy_intp[]){count, carried}, "motion");
    if (motions == NULL)
        goto done;
    lambdas = py_array(object[3], NPY_DOUBLE, 1, &count, "eigenvalue");
    energy = lambdas == NULL ? NULL : py_new(NPY_DOUBLE, 2, (npy_intp[]){count, RD_CARRIED});
    if (energy == NULL)
        goto done;
    for (npy_intp i = 0; i < count; i++)
        rd_attached_energy(chain, ((const double *)PyArray_DATA(lambdas))[i],
                           (const double *)PyArray_DATA(shapes) + i * nodes * width,
                           (const double *)PyArray_DATA(motions) + i * carried,
                           (double *)PyArray_DATA((PyArrayObject *)energy) + i * RD_CARRIED);
    result = Py_NewRef(energy);
done:
    Py_XDECREF(energy);
    Py_XDECREF(lambdas);
    Py_XDECREF(motions);
    Py_XDECREF(shapes);
    py_chain_release(&parsed);
    return result;
}

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
