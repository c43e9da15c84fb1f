/* Laws that Python knows. */
#include "glue/laws/calls.h"

#include <math.h>
#include <string.h>

/* remembers where a law failed, and what it raised */
static bool fail(struct py_calls *calls, size_t law, double t, double u, double v)
{
    const double at[4] = {(double)law, t, u, v};
    memcpy(calls->failed, at, sizeof at);
    if (PyErr_Occurred()) {
        PyObject *type, *trace;
        PyErr_Fetch(&type, &calls->error, &trace);
        PyErr_NormalizeException(&type, &calls->error, &trace);
        if (trace != NULL)
            PyException_SetTraceback(calls->error, trace);
        Py_XDECREF(type);
        Py_XDECREF(trace);
    }
    return false;
}

/* drops what was raised; false of what ends everything, as Ctrl-C does, which stays */
static bool forget(void)
{
    if (PyErr_Occurred() && !PyErr_ExceptionMatches(PyExc_Exception))
        return false;
    PyErr_Clear();
    return true;
}

/* the number of an object, NAN of what is none; an exception of the law stays */
static double number_of(PyObject *value)
{
    if (value == NULL || PyFloat_CheckExact(value))
        return value == NULL ? NAN : PyFloat_AS_DOUBLE(value);
    const double number = PyBool_Check(value) ? NAN : PyFloat_AsDouble(value);
    if (PyErr_Occurred()) {
        forget();
        return NAN;
    }
    return number;
}

static bool say_one(struct py_calls *calls, size_t law, double t, double u, double v, double *force)
{
    PyObject *number[3] = {PyFloat_FromDouble(t), PyFloat_FromDouble(u), PyFloat_FromDouble(v)};
    PyObject *value = NULL, *function = PyTuple_GET_ITEM(calls->law, (Py_ssize_t)law);
    if (number[0] != NULL && number[1] != NULL && number[2] != NULL)
        value = PyObject_Vectorcall(function, number, 3, NULL);
    *force = number_of(value);
    Py_XDECREF(value);
    for (int k = 0; k < 3; k++)
        Py_XDECREF(number[k]);
    return isnan(*force) ? fail(calls, law, t, u, v) : true;
}

static PyObject *copied(size_t count, const double *from)
{
    PyObject *array = py_new(NPY_DOUBLE, 1, (npy_intp[]){(npy_intp)count});
    if (array != NULL)
        memcpy(PyArray_DATA((PyArrayObject *)array), from, count * sizeof *from);
    return array;
}

/* one call for all; what it raises or returns is looked for one by one by the caller */
static bool say_all(struct py_calls *calls, size_t law, size_t count, const double *t,
                    const double *u, const double *v, double *force)
{
    PyObject *number[3] = {copied(count, t), copied(count, u), copied(count, v)}, *value = NULL;
    PyArrayObject *array = NULL;
    if (number[0] != NULL && number[1] != NULL && number[2] != NULL)
        value = PyObject_Vectorcall(PyTuple_GET_ITEM(calls->law, (Py_ssize_t)law), number, 3, NULL);
    if (value != NULL)
        array = py_array(value, NPY_DOUBLE, 1, (npy_intp[]){(npy_intp)count}, "law");
    bool right = array != NULL;
    if (right)
        memcpy(force, PyArray_DATA(array), count * sizeof *force);
    for (size_t i = 0; right && i < count; i++)
        right = !isnan(force[i]);
    Py_XDECREF(array);
    Py_XDECREF(value);
    for (int k = 0; k < 3; k++)
        Py_XDECREF(number[k]);
    return right;
}

bool py_say(void *context, size_t law, size_t count, const double *t, const double *u,
            const double *v, double *force)
{
    struct py_calls *calls = context;
    if (PyErr_CheckSignals() < 0)
        return fail(calls, law, t[0], u[0], v[0]);
    if (calls->arrays != NULL && calls->arrays[law]) {
        if (say_all(calls, law, count, t, u, v, force))
            return true;
        if (!forget())
            return fail(calls, law, t[0], u[0], v[0]);
    }
    for (size_t i = 0; i < count; i++)
        if (!say_one(calls, law, t[i], u[i], v[i], force + i))
            return false;
    return true;
}

PyObject *py_failure(const struct py_calls *calls, enum rd_status status)
{
    if (status != RD_INTERRUPTED)
        return Py_NewRef(Py_None);
    PyObject *error = calls->error == NULL ? Py_None : calls->error;
    return Py_BuildValue("(Oiddd)", error, (int)calls->failed[0], calls->failed[1],
                         calls->failed[2], calls->failed[3]);
}

/* --- arguments ---------------------------------------------------------------------------------*/

int py_laws_parse(PyObject *object, struct py_kept *kept, struct py_calls *calls,
                  struct rd_laws *laws)
{
    PyObject *kind, *value;
    if (!PyArg_ParseTuple(object, "OOO!;laws must be (kind, value, calls)", &kind, &value,
                          &PyTuple_Type, &calls->law))
        return -1;
    const npy_intp count = PyTuple_GET_SIZE(calls->law);
    const npy_intp shape[] = {count, RD_LAW_VALUES};
    laws->ports.count = (size_t)count;
    laws->kind = py_keep(kept, kind, NPY_INT32, 1, shape, "kind");
    laws->value = laws->kind ? py_keep(kept, value, NPY_DOUBLE, 2, shape, "value") : NULL;
    if (laws->value == NULL)
        return -1;
    for (npy_intp d = 0; d < count; d++) {
        const int32_t one = laws->kind[d];
        const int is_called = PyCallable_Check(PyTuple_GET_ITEM(calls->law, d));
        if (one < 0 || one >= RD_LAW_KINDS || (one == RD_GIVEN && !is_called)) {
            PyErr_Format(PyExc_ValueError, "kind[%zd] must be 0, 1, or 2 of what is called, got %d",
                         (Py_ssize_t)d, (int)one);
            return -1;
        }
    }
    return 0;
}

PyThreadState *py_let_others(size_t laws, const int32_t *kind, int32_t given)
{
    for (size_t d = 0; d < laws; d++)
        if (kind[d] == given)
            return NULL;
    return PyEval_SaveThread();
}

void py_stop_others(PyThreadState *state)
{
    if (state != NULL)
        PyEval_RestoreThread(state);
}

double *py_shared(struct py_kept *kept, PyObject *object, int dimensions, const npy_intp *shape,
                  const char *name)
{
    double *data = py_keep(kept, object, NPY_DOUBLE, dimensions, shape, name);
    if (data == NULL)
        return NULL;
    PyArrayObject *array = kept->array[kept->count - 1];
    if ((PyObject *)array != object || !PyArray_ISWRITEABLE(array)) {
        PyErr_Format(PyExc_ValueError, "%s must be a writable array of float64 in C order", name);
        return NULL;
    }
    return data;
}
