/* Structures that nodes carry: their energies in modes, and how their tips move. */
#include "glue/glue.h"

#include "chain/attached.h"

/* Modes of what carries structures, as they are handed in. */
struct carrying {
    struct py_chain parsed;
    PyArrayObject *shapes, *motions, *lambdas;
    npy_intp count, carried, width;
};

static void release(struct carrying *modes)
{
    Py_XDECREF(modes->lambdas);
    Py_XDECREF(modes->motions);
    Py_XDECREF(modes->shapes);
    py_chain_release(&modes->parsed);
}

/* chain, shape, motion, eigenvalue; -1 with an error set, to be released all the same */
static int parse(PyObject *arguments, struct carrying *modes)
{
    PyObject *object[4];
    *modes = (struct carrying){0};
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3) ||
        py_chain_view(object[0], &modes->parsed) < 0)
        return -1;
    const struct rd_chain *chain = &modes->parsed.chain;
    modes->carried = (npy_intp)chain->attached;
    modes->width = (npy_intp)chain->width;
    const npy_intp of_shape[] = {-1, (npy_intp)chain->nodes, modes->width};
    modes->shapes = py_array(object[1], NPY_DOUBLE, 3, of_shape, "shape");
    if (modes->shapes == NULL)
        return -1;
    modes->count = PyArray_DIM(modes->shapes, 0);
    const npy_intp of_motion[] = {modes->count, modes->carried};
    modes->motions = py_array(object[2], NPY_DOUBLE, 2, of_motion, "motion");
    if (modes->motions == NULL)
        return -1;
    modes->lambdas = py_array(object[3], NPY_DOUBLE, 1, &modes->count, "eigenvalue");
    return modes->lambdas == NULL ? -1 : 0;
}

static double lambda_of(const struct carrying *modes, npy_intp i)
{
    return ((const double *)PyArray_DATA(modes->lambdas))[i];
}

static const double *shape_of(const struct carrying *modes, npy_intp i)
{
    return (const double *)PyArray_GETPTR1(modes->shapes, i);
}

static const double *motion_of(const struct carrying *modes, npy_intp i)
{
    return (const double *)PyArray_DATA(modes->motions) + i * modes->carried;
}

PyObject *py_carried(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct carrying modes;
    PyObject *energy = NULL;
    if (parse(arguments, &modes) == 0)
        energy = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, RD_CARRIED});
    for (npy_intp i = 0; energy != NULL && i < modes.count; i++)
        rd_attached_energy(&modes.parsed.chain, lambda_of(&modes, i), shape_of(&modes, i),
                           motion_of(&modes, i),
                           (double *)PyArray_DATA((PyArrayObject *)energy) + i * RD_CARRIED);
    release(&modes);
    return energy;
}

PyObject *py_carried_slopes(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct carrying modes;
    PyObject *number = NULL, *row = NULL, *result = NULL;
    if (parse(arguments, &modes) < 0)
        goto done;
    const npy_intp of_number = modes.carried * RD_CARRIED_NUMBERS;
    const npy_intp of_row = modes.carried * 2 * modes.width;
    number = py_new(NPY_DOUBLE, 3, (npy_intp[]){modes.count, modes.carried, RD_CARRIED_NUMBERS});
    row = py_new(NPY_DOUBLE, 4, (npy_intp[]){modes.count, modes.carried, 2, modes.width});
    if (number == NULL || row == NULL)
        goto done;
    for (npy_intp i = 0; i < modes.count; i++)
        rd_attached_slopes(&modes.parsed.chain, lambda_of(&modes, i), shape_of(&modes, i),
                           motion_of(&modes, i),
                           (double *)PyArray_DATA((PyArrayObject *)number) + i * of_number,
                           (double *)PyArray_DATA((PyArrayObject *)row) + i * of_row);
    result = PyTuple_Pack(2, number, row);
done:
    Py_XDECREF(row);
    Py_XDECREF(number);
    release(&modes);
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
