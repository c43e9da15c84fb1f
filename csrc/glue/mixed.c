/* Frequency response and static deflection by the mixed form. */
#include "glue/response.h"

#include "mixed/deflection.h"
#include "mixed/frf.h"
#include "mixed/gauss.h"

/* solves frequency after frequency; how many before one that has no answer */
static npy_intp solve_each(struct rd_mixed_frf *frf, const struct py_response *response,
                           const struct rd_stop *stop, enum rd_status *status)
{
    const npy_intp count = response->count;
    const double _Complex *parts = PyArray_DATA(response->factor);
    double _Complex *value = PyArray_DATA((PyArrayObject *)response->value);
    double *error = PyArray_DATA((PyArrayObject *)response->error);
    for (npy_intp i = 0; i < count; i++) {
        double _Complex factor[RD_PARTS];
        for (int k = 0; k < RD_PARTS; k++)
            factor[k] = parts[k * count + i];
        *status = rd_stop_is_asked(stop)
                      ? RD_INTERRUPTED
                      : rd_mixed_frf_solve(frf, factor, (size_t)count, value + i, error + i);
        if (*status != RD_OK)
            return i;
    }
    return count;
}

/* the same from the measuring of memory on; -1 and an exception */
static npy_intp solve_all(PyObject *module, const struct py_response *response)
{
    const struct rd_chain *chain = &response->parsed.chain;
    const struct rd_ports *drives = &response->drives.ports;
    const struct rd_ports *responses = &response->responses.ports;
    struct rd_workspace workspace = {0};
    struct rd_mixed_frf frf;
    npy_intp solved = -1;
    rd_mixed_frf_prepare(chain, drives, responses, &frf, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        return -1;
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    enum rd_status status = rd_mixed_frf_prepare(chain, drives, responses, &frf, &workspace);
    frf.mixed.lu.stop = stop;
    if (status == RD_OK)
        solved = solve_each(&frf, response, &stop, &status);
    PyMem_RawFree(workspace.base);
    if (py_watch_end(&watch) < 0)
        return -1;
    if (status == RD_OK || status == RD_SINGULAR)
        return solved;
    py_raise(module, status);
    return -1;
}

PyObject *py_mixed(PyObject *module, PyObject *arguments)
{
    struct py_response response = {0};
    PyObject *result = NULL;
    if (py_response_parse(arguments, PY_FREQUENCY_LAST, &response) < 0 ||
        py_chain_is_lumped(&response.parsed, "mixed") < 0 || py_chain_expand(&response.parsed) < 0)
        goto done;
    const npy_intp solved = solve_all(module, &response);
    if (solved >= 0)
        result = Py_BuildValue("OOn", response.value, response.error, (Py_ssize_t)solved);
done:
    py_response_release(&response);
    return result;
}

PyObject *py_mixed_deflection(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_mixed_deflection deflection;
    PyArrayObject *load = NULL;
    PyObject *chain, *object, *displacement = NULL, *force = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &object))
        return NULL;
    if (py_chain_parse(chain, &parsed) < 0 || py_chain_is_lumped(&parsed, "mixed_deflection") < 0)
        goto done;
    const npy_intp shape[] = {(npy_intp)parsed.chain.nodes, (npy_intp)parsed.chain.width};
    load = py_array(object, NPY_DOUBLE, 2, shape, "force");
    displacement = py_new(NPY_DOUBLE, 2, shape);
    force = py_new(NPY_DOUBLE, 2, (npy_intp[]){shape[0] - 1, shape[1]});
    if (load == NULL || displacement == NULL || force == NULL)
        goto done;
    rd_mixed_deflection_prepare(&parsed.chain, &deflection, &workspace);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    enum rd_status status = rd_mixed_deflection_prepare(&parsed.chain, &deflection, &workspace);
    deflection.mixed.lu.stop = stop;
    if (status == RD_OK)
        status = rd_mixed_deflection_solve(&deflection, PyArray_DATA(load),
                                           PyArray_DATA((PyArrayObject *)displacement),
                                           PyArray_DATA((PyArrayObject *)force));
    if (py_watch_end(&watch) < 0)
        goto done;
    if (status == RD_OK)
        result = PyTuple_Pack(2, displacement, force);
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(force);
    Py_XDECREF(displacement);
    Py_XDECREF(load);
    py_chain_release(&parsed);
    return result;
}

/* linear systems of many lines in wide numbers */

/* 0, or -1 and an exception: a writable contiguous array of wide numbers with three axes */
static int check_wide(PyObject *object, const char *name)
{
    if (PyArray_Check(object)) {
        PyArrayObject *array = (PyArrayObject *)object;
        const int type = PyArray_TYPE(array);
        if ((type == NPY_LONGDOUBLE || type == NPY_CLONGDOUBLE) && PyArray_NDIM(array) == 3 &&
            PyArray_ISCARRAY(array))
            return 0;
    }
    PyErr_Format(PyExc_TypeError,
                 "%s must be a contiguous array of longdouble or clongdouble with three axes",
                 name);
    return -1;
}

PyObject *py_eliminate(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *object;
    Py_ssize_t own;
    if (!PyArg_ParseTuple(arguments, "On", &object, &own) || check_wide(object, "A") < 0)
        return NULL;
    PyArrayObject *A = (PyArrayObject *)object;
    const npy_intp lines = PyArray_DIM(A, 0), rows = PyArray_DIM(A, 1), columns = PyArray_DIM(A, 2);
    if (own < 0 || own > rows || own > columns)
        return PyErr_Format(PyExc_ValueError, "columns must be from 0 to %zd, got %zd",
                            (Py_ssize_t)(rows < columns ? rows : columns), own);
    const size_t all = (size_t)(rows * columns);
    void *data = PyArray_DATA(A);
    const int is_real = PyArray_TYPE(A) == NPY_LONGDOUBLE;
    Py_BEGIN_ALLOW_THREADS
    for (size_t k = 0; k < (size_t)lines; k++)
        if (is_real)
            rd_gauss_eliminate((long double *)data + k * all, (size_t)rows, (size_t)columns,
                               (size_t)own);
        else
            rd_gauss_eliminate_complex((long double _Complex *)data + k * all, (size_t)rows,
                                       (size_t)columns, (size_t)own);
    Py_END_ALLOW_THREADS
    Py_RETURN_NONE;
}

PyObject *py_substitute(PyObject *module, PyObject *arguments)
{
    (void)module;
    PyObject *object, *right;
    if (!PyArg_ParseTuple(arguments, "OO", &object, &right) || check_wide(object, "A") < 0 ||
        check_wide(right, "x") < 0)
        return NULL;
    PyArrayObject *A = (PyArrayObject *)object, *x = (PyArrayObject *)right;
    const npy_intp lines = PyArray_DIM(A, 0), rows = PyArray_DIM(A, 1), columns = PyArray_DIM(A, 2);
    const npy_intp own = PyArray_DIM(x, 1), loads = PyArray_DIM(x, 2);
    if (PyArray_DIM(x, 0) != lines || own > rows || own > columns ||
        PyArray_TYPE(A) != PyArray_TYPE(x))
        return PyErr_Format(PyExc_ValueError,
                            "x must have %zd lines of at most %zd rows and numbers as A",
                            (Py_ssize_t)lines, (Py_ssize_t)(rows < columns ? rows : columns));
    const size_t all = (size_t)(rows * columns), each = (size_t)(own * loads);
    const void *U = PyArray_DATA(A);
    void *data = PyArray_DATA(x);
    const int is_real = PyArray_TYPE(A) == NPY_LONGDOUBLE;
    Py_BEGIN_ALLOW_THREADS
    for (size_t k = 0; k < (size_t)lines; k++)
        if (is_real)
            rd_gauss_substitute((const long double *)U + k * all, (size_t)columns, (size_t)own,
                                (size_t)loads, (long double *)data + k * each);
        else
            rd_gauss_substitute_complex((const long double _Complex *)U + k * all, (size_t)columns,
                                        (size_t)own, (size_t)loads,
                                        (long double _Complex *)data + k * each);
    Py_END_ALLOW_THREADS
    Py_RETURN_NONE;
}
