/* Sections and elements for reading. */
#include "glue/glue.h"

#include "assembled/assemble.h"
#include "base/dense.h"
#include "chain/elements.h"
#include "element/element.h"
#include "element/section.h"
#include "element/stiffness.h"
#include "element/triple.h"
#include "sweep/kernel/transfer.h"

#include <string.h>

PyObject *py_section(PyObject *module, PyObject *arguments)
{
    struct rd_section section;
    if (!PyArg_ParseTuple(arguments, "ddddd", &section.axial, &section.torsion, &section.bending,
                          &section.coupling, &section.slope))
        return NULL;
    PyObject *flexibility = py_new(NPY_DOUBLE, 2, (npy_intp[]){3, 3});
    if (flexibility == NULL)
        return NULL;
    const enum rd_status status =
        rd_section_flexibility(&section, PyArray_DATA((PyArrayObject *)flexibility));
    if (status == RD_OK)
        return flexibility;
    Py_DECREF(flexibility);
    return py_raise(module, status);
}

PyObject *py_invert(PyObject *module, PyObject *arguments)
{
    PyObject *object;
    if (!PyArg_ParseTuple(arguments, "O", &object))
        return NULL;
    PyArrayObject *inverse = (PyArrayObject *)PyArray_FROMANY(
        object, NPY_DOUBLE, 2, 2, NPY_ARRAY_CARRAY | NPY_ARRAY_ENSURECOPY);
    if (inverse == NULL)
        return NULL;
    const npy_intp n = PyArray_DIM(inverse, 0);
    if (n != PyArray_DIM(inverse, 1))
        PyErr_SetString(PyExc_ValueError, "matrix must be square");
    else if (rd_dense_invert((size_t)n, PyArray_DATA(inverse)))
        return (PyObject *)inverse;
    else
        py_raise(module, RD_NOT_POSITIVE_DEFINITE);
    Py_DECREF(inverse);
    return NULL;
}

PyObject *py_triples(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    PyObject *object, *F = NULL, *G = NULL, *Q = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O", &object))
        return NULL;
    if (py_chain_view(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "triples") < 0)
        goto done;
    const size_t w = parsed.chain.width;
    const npy_intp shape[] = {(npy_intp)parsed.chain.distinct, (npy_intp)w, (npy_intp)w};
    F = py_new(NPY_DOUBLE, 3, shape);
    G = py_new(NPY_DOUBLE, 3, shape);
    Q = py_new(NPY_DOUBLE, 3, shape);
    if (F == NULL || G == NULL || Q == NULL)
        goto done;
    double *f = PyArray_DATA((PyArrayObject *)F);
    double *g = PyArray_DATA((PyArrayObject *)G);
    double *q = PyArray_DATA((PyArrayObject *)Q);
    for (size_t i = 0; i < parsed.chain.distinct; i++) {
        const struct rd_element element = rd_chain_element(&parsed.chain, i);
        const enum rd_status status =
            rd_triple_real(&element, f + i * w * w, g + i * w * w, q + i * w * w);
        if (status != RD_OK) {
            py_raise(module, status);
            goto done;
        }
    }
    result = PyTuple_Pack(3, F, G, Q);
done:
    Py_XDECREF(F);
    Py_XDECREF(G);
    Py_XDECREF(Q);
    py_chain_release(&parsed);
    return result;
}

/* the distinct element of a number, checked */
static int element_at(const struct rd_chain *chain, Py_ssize_t index, struct rd_element *element)
{
    if (index < 0 || (size_t)index >= chain->distinct) {
        PyErr_Format(PyExc_ValueError, "element must lie in 0 ... %zd, got %zd",
                     (Py_ssize_t)chain->distinct - 1, index);
        return -1;
    }
    *element = rd_chain_element(chain, (size_t)index);
    return 0;
}

/* the element on the right of a node and the hinge between them, checked */
static int span_at(const struct rd_chain *chain, Py_ssize_t node, struct rd_element *element)
{
    if (node < 0 || (size_t)node + 1 >= chain->nodes) {
        PyErr_Format(PyExc_ValueError, "node must lie in 0 ... %zd, got %zd",
                     (Py_ssize_t)chain->nodes - 2, node);
        return -1;
    }
    *element = rd_chain_span(chain, rd_stretch_of(chain, (size_t)node, 0));
    return 0;
}

static int check_distance(const struct rd_element *element, double s, const char *name)
{
    if (0 <= s && s <= element->length)
        return 0;
    PyErr_Format(PyExc_ValueError, "%s must lie between 0 and the length of the element", name);
    return -1;
}

/* F, G, Q (count, width, width) of a massless element at many factors */
static enum rd_status massless(const struct rd_chain *chain, size_t e, size_t count,
                               const double _Complex *factor, double _Complex *const *triple)
{
    const struct rd_element element = rd_chain_element(chain, e);
    const size_t block = chain->width * chain->width;
    enum rd_status status = RD_OK;
    for (size_t i = 0; i < count && status == RD_OK; i++)
        status = rd_triple(&element, factor[i], factor[count + i], triple[0] + i * block,
                           triple[1] + i * block, triple[2] + i * block);
    return status;
}

/* the same of continuous ones, RD_LANES at a time */
static void continuous(const struct rd_chain *chain, size_t e, size_t count,
                       const double _Complex *factor, double _Complex *const *triple)
{
    const size_t block = chain->width * chain->width;
    for (size_t i = 0; i < count; i += RD_LANES) {
        struct rd_transfer transfer;
        cv part[RD_PARTS];
        for (size_t k = 0; k < RD_LANES; k++)
            for (size_t p = 0; p < RD_PARTS; p++) {
                const double _Complex x = factor[p * count + (i + k < count ? i + k : count - 1)];
                part[p].re[k] = creal(x);
                part[p].im[k] = cimag(x);
            }
        rd_transfer_fill(chain, e, part, &transfer);
        for (size_t k = 0; k < RD_LANES && i + k < count; k++) {
            memcpy(triple[0] + (i + k) * block, transfer.F[k], block * sizeof **triple);
            memcpy(triple[1] + (i + k) * block, transfer.G[k], block * sizeof **triple);
            memcpy(triple[2] + (i + k) * block, transfer.Q[k], block * sizeof **triple);
        }
    }
}

PyObject *py_triple(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_element element;
    PyArrayObject *factor = NULL;
    PyObject *object, *factors, *array[3] = {NULL}, *result = NULL;
    Py_ssize_t index;
    if (!PyArg_ParseTuple(arguments, "OnO", &object, &index, &factors))
        return NULL;
    if (py_chain_view(object, &parsed) < 0 || element_at(&parsed.chain, index, &element) < 0)
        goto done;
    factor = py_array(factors, NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    if (factor == NULL)
        goto done;
    const npy_intp count = PyArray_DIM(factor, 1);
    const npy_intp w = (npy_intp)element.width;
    double _Complex *data[3];
    for (int k = 0; k < 3; k++) {
        array[k] = py_new(NPY_COMPLEX128, 3, (npy_intp[]){count, w, w});
        if (array[k] == NULL)
            goto done;
        data[k] = PyArray_DATA((PyArrayObject *)array[k]);
    }
    enum rd_status status = RD_OK;
    if (parsed.chain.inertia)
        continuous(&parsed.chain, (size_t)index, (size_t)count, PyArray_DATA(factor), data);
    else
        status = massless(&parsed.chain, (size_t)index, (size_t)count, PyArray_DATA(factor), data);
    if (status == RD_OK)
        result = PyTuple_Pack(3, array[0], array[1], array[2]);
    else
        py_raise(module, status);
done:
    for (int k = 0; k < 3; k++)
        Py_XDECREF(array[k]);
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}

PyObject *py_shape(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_element element;
    PyObject *object, *shape = NULL;
    Py_ssize_t node;
    double s;
    if (!PyArg_ParseTuple(arguments, "Ond", &object, &node, &s))
        return NULL;
    if (py_chain_view(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "shape") < 0 ||
        span_at(&parsed.chain, node, &element) < 0 || check_distance(&element, s, "s") < 0)
        goto done;
    const npy_intp w = (npy_intp)element.width;
    shape = py_new(NPY_DOUBLE, 3, (npy_intp[]){w, 2, w});
    if (shape == NULL)
        goto done;
    const enum rd_status status =
        rd_element_shape(&element, s, PyArray_DATA((PyArrayObject *)shape));
    if (status != RD_OK) {
        Py_CLEAR(shape);
        py_raise(module, status);
    }
done:
    py_chain_release(&parsed);
    return shape;
}

PyObject *py_local(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_element element;
    PyObject *object, *local = NULL;
    Py_ssize_t node;
    double s, p;
    if (!PyArg_ParseTuple(arguments, "Ondd", &object, &node, &s, &p))
        return NULL;
    if (py_chain_view(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "local") < 0 ||
        span_at(&parsed.chain, node, &element) < 0 || check_distance(&element, s, "s") < 0 ||
        check_distance(&element, p, "p") < 0)
        goto done;
    const npy_intp w = (npy_intp)element.width;
    local = py_new(NPY_DOUBLE, 2, (npy_intp[]){w, w});
    if (local == NULL)
        goto done;
    const enum rd_status status =
        rd_element_local(&element, s, p, PyArray_DATA((PyArrayObject *)local));
    if (status != RD_OK) {
        Py_CLEAR(local);
        py_raise(module, status);
    }
done:
    py_chain_release(&parsed);
    return local;
}
