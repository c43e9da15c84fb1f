/* Many uniform ropes at once, in closed form. */
#include "glue/glue.h"

#include "closed/closed.h"
#include "closed/response.h"

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

/* room for what rd_bent_response answers */
struct py_lines {
    PyArrayObject *number, *factor, *drive, *response;
    PyObject *value, *error, *certain;
};

static int lines_parse(PyObject *const *object, struct py_lines *of)
{
    of->number = py_array(object[0], NPY_FLOAT64, 2, (npy_intp[]){-1, RD_BENT_NUMBERS}, "number");
    of->factor =
        of->number ? py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){5, -1}, "factor") : NULL;
    of->drive = of->factor ? py_array(object[2], NPY_FLOAT64, 1, (npy_intp[]){-1}, "drive") : NULL;
    of->response =
        of->drive ? py_array(object[3], NPY_FLOAT64, 1, (npy_intp[]){-1}, "response") : NULL;
    if (of->response == NULL)
        return -1;
    const npy_intp lines = PyArray_DIM(of->factor, 1), rows = PyArray_DIM(of->number, 0);
    const npy_intp shape[] = {rows, PyArray_DIM(of->drive, 0), PyArray_DIM(of->response, 0), lines};
    of->value = py_new(NPY_COMPLEX128, 4, shape);
    of->error = of->value ? py_new(NPY_FLOAT64, 4, shape) : NULL;
    of->certain = of->error ? py_new(NPY_BOOL, 2, (npy_intp[]){rows, lines}) : NULL;
    return of->certain ? 0 : -1;
}

PyObject *py_closed_response(PyObject *module, PyObject *arguments)
{
    struct py_lines of = {0};
    PyObject *object[4], *result = NULL;
    double drag;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "OOdOO", object, object + 1, &drag, object + 2, object + 3))
        return NULL;
    if (lines_parse(object, &of) < 0)
        goto done;
    const struct rd_closed_lines lines = {
        .lines = (size_t)PyArray_DIM(of.factor, 1),
        .factor = PyArray_DATA(of.factor),
        .drag = drag,
        .drives = (size_t)PyArray_DIM(of.drive, 0),
        .responses = (size_t)PyArray_DIM(of.response, 0),
        .drive = PyArray_DATA(of.drive),
        .response = PyArray_DATA(of.response),
    };
    const struct rd_closed_response response = {
        .value = PyArray_DATA((PyArrayObject *)of.value),
        .error = PyArray_DATA((PyArrayObject *)of.error),
        .certain = PyArray_DATA((PyArrayObject *)of.certain),
    };
    const size_t rows = (size_t)PyArray_DIM(of.number, 0);
    Py_BEGIN_ALLOW_THREADS
    rd_bent_response(PyArray_DATA(of.number), 0, rows, &lines, &response);
    Py_END_ALLOW_THREADS
    result = PyTuple_Pack(3, of.value, of.error, of.certain);
done:
    Py_XDECREF(of.certain);
    Py_XDECREF(of.error);
    Py_XDECREF(of.value);
    Py_XDECREF(of.response);
    Py_XDECREF(of.drive);
    Py_XDECREF(of.factor);
    Py_XDECREF(of.number);
    return result;
}
