/* Many uniform ropes at once, in closed form. */
#include "glue/glue.h"

#include "closed/closed.h"

struct kind {
    const char *name;
    npy_intp numbers;
    void (*modes)(const struct rd_ropes *, size_t, size_t, const struct rd_closed_modes *);
    void (*count)(const struct rd_ropes *, size_t, size_t, double, int64_t *);
};

static const struct kind kinds[] = {
    {"bent", RD_BENT_NUMBERS, rd_bent_modes, rd_bent_count},
    {"plain", RD_PLAIN_NUMBERS, rd_plain_modes, rd_plain_count},
};

/* ropes and the arrays they view */
struct py_ropes {
    const struct kind *kind;
    struct rd_ropes ropes;
    size_t rows;
    PyArrayObject *values, *fixed, *column;
};

/* 0, or -1 and an exception; to be released in both cases */
static int parse(const char *name, PyObject *values, PyObject *fixed, PyObject *column,
                 struct py_ropes *parsed)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(name, kinds[i].name) == 0)
            parsed->kind = kinds + i;
    if (parsed->kind == NULL) {
        PyErr_Format(PyExc_ValueError, "kind must be \"bent\" or \"plain\", got \"%s\"", name);
        return -1;
    }
    const npy_intp numbers = parsed->kind->numbers;
    parsed->values = py_array(values, NPY_FLOAT64, 2, (npy_intp[]){-1, -1}, "values");
    parsed->fixed = parsed->values ? py_array(fixed, NPY_FLOAT64, 1, &numbers, "fixed") : NULL;
    parsed->column = parsed->fixed ? py_array(column, NPY_INT32, 1, &numbers, "column") : NULL;
    if (parsed->column == NULL)
        return -1;
    const npy_intp columns = PyArray_DIM(parsed->values, 1);
    parsed->rows = (size_t)PyArray_DIM(parsed->values, 0);
    parsed->ropes = (struct rd_ropes){(size_t)columns, PyArray_DATA(parsed->values),
                                      PyArray_DATA(parsed->fixed), PyArray_DATA(parsed->column)};
    for (npy_intp j = 0; j < numbers; j++)
        if (parsed->ropes.column[j] >= columns) {
            PyErr_Format(PyExc_ValueError, "column must be less than %zd, got %d",
                         (Py_ssize_t)columns, (int)parsed->ropes.column[j]);
            return -1;
        }
    return 0;
}

static void release(struct py_ropes *parsed)
{
    Py_XDECREF(parsed->values);
    Py_XDECREF(parsed->fixed);
    Py_XDECREF(parsed->column);
}

PyObject *py_closed_modes(PyObject *module, PyObject *arguments)
{
    struct py_ropes parsed = {0};
    const char *kind;
    Py_ssize_t number;
    int sloped;
    PyObject *object[3], *omega = NULL, *error = NULL, *slope = NULL, *certified = NULL;
    PyObject *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOOnp", &kind, object, object + 1, object + 2, &number,
                          &sloped))
        return NULL;
    if (parse(kind, object[0], object[1], object[2], &parsed) < 0)
        goto done;
    if (number < 1) {
        PyErr_Format(PyExc_ValueError, "number must be at least 1, got %zd", number);
        goto done;
    }
    const npy_intp shape[] = {(npy_intp)parsed.rows, number, (npy_intp)parsed.ropes.columns};
    omega = py_new(NPY_FLOAT64, 2, shape);
    error = omega ? py_new(NPY_FLOAT64, 2, shape) : NULL;
    certified = error ? py_new(NPY_BOOL, 1, shape) : NULL;
    if (certified == NULL)
        goto done;
    slope = sloped ? PyArray_ZEROS(3, shape, NPY_FLOAT64, 0) : Py_NewRef(Py_None);
    if (slope == NULL)
        goto done;
    const struct rd_closed_modes modes = {
        .number = (size_t)number,
        .omega = PyArray_DATA((PyArrayObject *)omega),
        .error = PyArray_DATA((PyArrayObject *)error),
        .slope = sloped ? PyArray_DATA((PyArrayObject *)slope) : NULL,
        .certified = PyArray_DATA((PyArrayObject *)certified),
    };
    Py_BEGIN_ALLOW_THREADS
    parsed.kind->modes(&parsed.ropes, 0, parsed.rows, &modes);
    Py_END_ALLOW_THREADS
    result = PyTuple_Pack(4, omega, error, slope, certified);
done:
    Py_XDECREF(omega);
    Py_XDECREF(error);
    Py_XDECREF(slope);
    Py_XDECREF(certified);
    release(&parsed);
    return result;
}

PyObject *py_closed_count(PyObject *module, PyObject *arguments)
{
    struct py_ropes parsed = {0};
    const char *kind;
    double omega;
    PyObject *object[3], *count = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOOd", &kind, object, object + 1, object + 2, &omega))
        return NULL;
    if (parse(kind, object[0], object[1], object[2], &parsed) < 0)
        goto done;
    count = py_new(NPY_INT64, 1, (npy_intp[]){(npy_intp)parsed.rows});
    if (count == NULL)
        goto done;
    int64_t *each = PyArray_DATA((PyArrayObject *)count);
    Py_BEGIN_ALLOW_THREADS
    parsed.kind->count(&parsed.ropes, 0, parsed.rows, omega, each);
    Py_END_ALLOW_THREADS
done:
    release(&parsed);
    return count;
}
