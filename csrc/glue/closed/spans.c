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
    PyArrayObject *number, *jacobian; /* the last is NULL where None is given */
};

/* 0, or -1 and an exception; to be released in both cases */
static int parse(const char *name, PyObject *number, PyObject *jacobian, struct py_ropes *parsed)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(name, kinds[i].name) == 0)
            parsed->kind = kinds + i;
    if (parsed->kind == NULL) {
        PyErr_Format(PyExc_ValueError, "kind must be \"bent\" or \"plain\", got \"%s\"", name);
        return -1;
    }
    const npy_intp numbers = parsed->kind->numbers;
    parsed->number = py_array(number, NPY_FLOAT64, 2, (npy_intp[]){-1, numbers}, "number");
    if (parsed->number == NULL)
        return -1;
    parsed->rows = (size_t)PyArray_DIM(parsed->number, 0);
    parsed->ropes.number = PyArray_DATA(parsed->number);
    if (jacobian == Py_None)
        return 0;
    parsed->jacobian = py_array(jacobian, NPY_FLOAT64, 2, (npy_intp[]){numbers, -1}, "jacobian");
    if (parsed->jacobian == NULL)
        return -1;
    parsed->ropes.values = (size_t)PyArray_DIM(parsed->jacobian, 1);
    parsed->ropes.jacobian = PyArray_DATA(parsed->jacobian);
    return 0;
}

static void release(struct py_ropes *parsed)
{
    Py_XDECREF(parsed->number);
    Py_XDECREF(parsed->jacobian);
}

PyObject *py_closed_modes(PyObject *module, PyObject *arguments)
{
    struct py_ropes parsed = {0};
    const char *kind;
    Py_ssize_t number;
    PyObject *object[2], *omega = NULL, *error = NULL, *slope = NULL, *certified = NULL;
    PyObject *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOn", &kind, object, object + 1, &number))
        return NULL;
    if (parse(kind, object[0], object[1], &parsed) < 0)
        goto done;
    if (number < 1) {
        PyErr_Format(PyExc_ValueError, "modes must be at least 1, got %zd", number);
        goto done;
    }
    const npy_intp shape[] = {(npy_intp)parsed.rows, number, (npy_intp)parsed.ropes.values};
    omega = py_new(NPY_FLOAT64, 2, shape);
    error = omega ? py_new(NPY_FLOAT64, 2, shape) : NULL;
    certified = error ? py_new(NPY_BOOL, 1, shape) : NULL;
    if (certified == NULL)
        goto done;
    slope = parsed.jacobian ? py_new(NPY_FLOAT64, 3, shape) : Py_NewRef(Py_None);
    if (slope == NULL)
        goto done;
    const struct rd_closed_modes modes = {
        .number = (size_t)number,
        .omega = PyArray_DATA((PyArrayObject *)omega),
        .error = PyArray_DATA((PyArrayObject *)error),
        .slope = parsed.jacobian ? PyArray_DATA((PyArrayObject *)slope) : NULL,
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
    PyObject *object, *count = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOd", &kind, &object, &omega))
        return NULL;
    if (parse(kind, object, Py_None, &parsed) < 0)
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
