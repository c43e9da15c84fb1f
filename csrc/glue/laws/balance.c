/* Harmonic balance of several motions, each at a frequency. */
#include "balance/balance.h"

#include <string.h>

#include "glue/glue.h"

/* 0, or -1 and an exception: what the Jacobian is made of */
static int parse_balance(PyObject *const *object, struct py_kept *kept, struct rd_balance *balance,
                         const double **omega)
{
    balance->transfer =
        py_keep(kept, object[0], NPY_CDOUBLE, 4, (npy_intp[]){-1, -1, -1, -1}, "transfer");
    if (balance->transfer == NULL)
        return -1;
    const npy_intp several = py_kept_length(kept, 0), orders = py_kept_length(kept, 1);
    const npy_intp m = py_kept_length(kept, 2), pitch = py_kept_length(kept, 3);
    if (orders < 1 || m < 1 || pitch < m) {
        PyErr_Format(PyExc_ValueError,
                     "transfer must hold harmonics of points by points and more, got %zd of %zd by "
                     "%zd",
                     (Py_ssize_t)orders, (Py_ssize_t)m, (Py_ssize_t)pitch);
        return -1;
    }
    const npy_intp slopes[] = {several, m, m, -1};
    balance->by_u = py_keep(kept, object[1], NPY_CDOUBLE, 4, slopes, "by_u");
    if (balance->by_u == NULL)
        return -1;
    const npy_intp given = py_kept_length(kept, 3);
    if (given < 2 * orders - 1) {
        PyErr_Format(PyExc_ValueError, "by_u must hold %zd coefficients at least, got %zd",
                     (Py_ssize_t)(2 * orders - 1), (Py_ssize_t)given);
        return -1;
    }
    if (object[2] != Py_None) {
        const npy_intp as_many[] = {several, m, m, given};
        balance->by_v = py_keep(kept, object[2], NPY_CDOUBLE, 4, as_many, "by_v");
        if (balance->by_v == NULL)
            return -1;
    }
    balance->points = (size_t)m;
    balance->harmonics = (size_t)orders - 1;
    balance->pitch = (size_t)pitch;
    balance->orders = (size_t)given;
    *omega = py_keep(kept, object[3], NPY_DOUBLE, 1, (npy_intp[]){several}, "omega");
    return *omega == NULL ? -1 : 0;
}

PyObject *py_balance(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_kept kept = {0};
    struct rd_balance balance = {0};
    const double *omega;
    double *work = NULL;
    PyObject *object[4], *jacobian = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return NULL;
    if (parse_balance(object, &kept, &balance, &omega) < 0)
        goto done;
    const size_t m = balance.points, n = m * (2 * balance.harmonics + 1);
    const npy_intp several = py_kept_length(&kept, 0);
    work = PyMem_RawMalloc(4 * m * m * sizeof *work);
    if (work == NULL) {
        PyErr_NoMemory();
        goto done;
    }
    jacobian = py_new(NPY_DOUBLE, 3, (npy_intp[]){several, (npy_intp)n, (npy_intp)n});
    if (jacobian == NULL)
        goto done;
    double *to = PyArray_DATA((PyArrayObject *)jacobian);
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp b = 0; b < several; b++) {
        balance.omega = omega[b];
        rd_balance_jacobian(&balance, work, to + (size_t)b * n * n);
        balance.transfer += (balance.harmonics + 1) * m * balance.pitch;
        balance.by_u += m * m * balance.orders;
        if (balance.by_v != NULL)
            balance.by_v += m * m * balance.orders;
    }
    Py_END_ALLOW_THREADS
done:
    PyMem_RawFree(work);
    py_kept_release(&kept);
    return jacobian;
}

PyObject *py_stopped(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_kept kept = {0};
    struct rd_balance_stop stop;
    PyObject *object[3], *felt = NULL;
    if (!PyArg_ParseTuple(arguments, "dddOOO", &stop.stiffness, &stop.gap, &stop.side, object,
                          object + 1, object + 2))
        return NULL;
    const double *u = py_keep(&kept, object[1], NPY_DOUBLE, 2, (npy_intp[]){-1, -1}, "u");
    if (u == NULL)
        goto done;
    const npy_intp several = py_kept_length(&kept, 0), samples = py_kept_length(&kept, 1);
    if (samples < 1) {
        PyErr_SetString(PyExc_ValueError, "u must hold a sample at least, got none");
        goto done;
    }
    const double *v = py_keep(&kept, object[2], NPY_DOUBLE, 2, (npy_intp[]){several, samples}, "v");
    const double *step =
        v == NULL ? NULL : py_keep(&kept, object[0], NPY_DOUBLE, 1, (npy_intp[]){several}, "step");
    if (step != NULL)
        felt = py_new(NPY_DOUBLE, 3, (npy_intp[]){3, several, samples});
    if (felt == NULL)
        goto done;
    const size_t all = (size_t)(several * samples);
    double *to = PyArray_DATA((PyArrayObject *)felt);
    memset(to, 0, 3 * all * sizeof *to);
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp b = 0; b < several; b++) {
        const size_t at = (size_t)(b * samples);
        stop.step = step[b];
        rd_balance_stopped(&stop, (size_t)samples, u + at, v + at, to + at, to + all + at,
                           to + 2 * all + at);
    }
    Py_END_ALLOW_THREADS
done:
    py_kept_release(&kept);
    return felt;
}
