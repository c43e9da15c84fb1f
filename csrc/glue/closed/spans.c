/* Many uniform ropes at once, in closed form. */
#include "glue/closed/rows.h"

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

/* what is asked of rows */
struct question {
    const struct py_ropes *of;
    const struct rd_closed_modes *modes;
    double omega;
    int64_t *count;
};

static void solve_modes(const void *asked, size_t first, size_t last)
{
    const struct question *question = asked;
    question->of->kind->modes(&question->of->ropes, first, last, question->modes);
}

static void solve_counts(const void *asked, size_t first, size_t last)
{
    const struct question *question = asked;
    question->of->kind->count(&question->of->ropes, first, last, question->omega, question->count);
}

PyObject *py_closed_modes(PyObject *module, PyObject *arguments)
{
    struct py_ropes parsed = {0};
    struct py_closed_modes made = {0};
    const struct question question = {.of = &parsed, .modes = &made.modes};
    const char *kind;
    Py_ssize_t number;
    PyObject *object[2], *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOOn", &kind, object, object + 1, &number))
        return NULL;
    if (parse(kind, object[0], object[1], &parsed) < 0)
        goto done;
    if (py_closed_modes_make(parsed.rows, number, "modes", parsed.ropes.values,
                             parsed.jacobian != NULL, &made) < 0)
        goto done;
    if (py_rows_solve(parsed.rows, made.modes.number, solve_modes, &question) == 0)
        result = py_closed_modes_pack(&made);
done:
    py_closed_modes_release(&made);
    release(&parsed);
    return result;
}

PyObject *py_closed_count(PyObject *module, PyObject *arguments)
{
    struct py_ropes parsed = {0};
    struct question question = {.of = &parsed};
    const char *kind;
    PyObject *object, *count = NULL, *result = NULL;
    (void)module;
    if (!PyArg_ParseTuple(arguments, "sOd", &kind, &object, &question.omega))
        return NULL;
    if (parse(kind, object, Py_None, &parsed) < 0)
        goto done;
    count = py_new(NPY_INT64, 1, (npy_intp[]){(npy_intp)parsed.rows});
    if (count == NULL)
        goto done;
    question.count = PyArray_DATA((PyArrayObject *)count);
    if (py_rows_solve(parsed.rows, 1, solve_counts, &question) == 0)
        result = Py_NewRef(count);
done:
    Py_XDECREF(count);
    release(&parsed);
    return result;
}
