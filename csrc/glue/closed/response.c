/* Responses of many uniform ropes, in closed form. */
#include "glue/closed/rows.h"

#include "closed/response.h"

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

/* what is asked of rows */
struct question {
    const double *number;
    struct rd_closed_lines lines;
    struct rd_closed_response response;
};

static void solve_lines(const void *asked, size_t first, size_t last)
{
    const struct question *question = asked;
    rd_bent_response(question->number, first, last, &question->lines, &question->response);
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
    const struct question question = {
        .number = PyArray_DATA(of.number),
        .lines =
            {
                .lines = (size_t)PyArray_DIM(of.factor, 1),
                .factor = PyArray_DATA(of.factor),
                .drag = drag,
                .drives = (size_t)PyArray_DIM(of.drive, 0),
                .responses = (size_t)PyArray_DIM(of.response, 0),
                .drive = PyArray_DATA(of.drive),
                .response = PyArray_DATA(of.response),
            },
        .response =
            {
                .value = PyArray_DATA((PyArrayObject *)of.value),
                .error = PyArray_DATA((PyArrayObject *)of.error),
                .certain = PyArray_DATA((PyArrayObject *)of.certain),
            },
    };
    const size_t values = (size_t)PyArray_SIZE((PyArrayObject *)of.value);
    const size_t rows = (size_t)PyArray_DIM(of.number, 0);
    if (py_rows_solve(rows, rows > 0 ? values / rows / 10 : 0, solve_lines, &question) == 0)
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
