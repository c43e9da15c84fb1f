/* Steps under smooth laws, which Python may know. */
#include "glue/glue.h"

#include <math.h>
#include <string.h>

#include "collocation/collocation.h"

enum { KEPT = 12 }; /* arrays that a call holds */

struct py_collocation {
    struct rd_collocation step;
    struct rd_smooth_laws laws;
    struct rd_collocated run;
    PyObject *calls;       /* of laws that Python knows, None for others */
    const uint8_t *arrays; /* (laws,) whether a law takes arrays         */
    PyArrayObject *keep[KEPT];
    size_t kept;
    double failed[4]; /* law, time, u and v where one failed                          */
    PyObject *error;  /* what it raised; NULL where it returned what is no number, [N] */
};

/* an array that lives as long as the call; NULL and an exception */
static void *keep(struct py_collocation *call, PyObject *object, int type, int dimensions,
                  const npy_intp *shape, const char *name)
{
    PyArrayObject *array = py_array(object, type, dimensions, shape, name);
    if (array == NULL)
        return NULL;
    call->keep[call->kept++] = array;
    return PyArray_DATA(array);
}

static npy_intp length_of(const struct py_collocation *call, int axis)
{
    return PyArray_DIM(call->keep[call->kept - 1], axis);
}

/* --- laws --------------------------------------------------------------------------------------*/

/* remembers where a law failed, and what it raised */
static bool fail(struct py_collocation *call, size_t law, double t, double u, double v)
{
    const double at[4] = {(double)law, t, u, v};
    memcpy(call->failed, at, sizeof at);
    if (PyErr_Occurred()) {
        PyObject *type, *trace;
        PyErr_Fetch(&type, &call->error, &trace);
        PyErr_NormalizeException(&type, &call->error, &trace);
        if (trace != NULL)
            PyException_SetTraceback(call->error, trace);
        Py_XDECREF(type);
        Py_XDECREF(trace);
    }
    return false;
}

/* the number of an object, NAN of what is none; an exception of the law stays */
static double number_of(PyObject *value)
{
    if (value == NULL || PyFloat_CheckExact(value))
        return value == NULL ? NAN : PyFloat_AS_DOUBLE(value);
    const double number = PyBool_Check(value) ? NAN : PyFloat_AsDouble(value);
    if (PyErr_Occurred()) {
        PyErr_Clear();
        return NAN;
    }
    return number;
}

static bool say_one(struct py_collocation *call, size_t law, double t, double u, double v,
                    double *force)
{
    PyObject *number[3] = {PyFloat_FromDouble(t), PyFloat_FromDouble(u), PyFloat_FromDouble(v)};
    PyObject *value = NULL, *function = PyTuple_GET_ITEM(call->calls, (Py_ssize_t)law);
    if (number[0] != NULL && number[1] != NULL && number[2] != NULL)
        value = PyObject_Vectorcall(function, number, 3, NULL);
    *force = number_of(value);
    Py_XDECREF(value);
    for (int k = 0; k < 3; k++)
        Py_XDECREF(number[k]);
    return isnan(*force) ? fail(call, law, t, u, v) : true;
}

static PyObject *copied(size_t count, const double *from)
{
    PyObject *array = py_new(NPY_DOUBLE, 1, (npy_intp[]){(npy_intp)count});
    if (array != NULL)
        memcpy(PyArray_DATA((PyArrayObject *)array), from, count * sizeof *from);
    return array;
}

/* one call for all; what it raises or returns is looked for one by one by the caller */
static bool say_all(struct py_collocation *call, size_t law, size_t count, const double *t,
                    const double *u, const double *v, double *force)
{
    PyObject *number[3] = {copied(count, t), copied(count, u), copied(count, v)}, *value = NULL;
    PyArrayObject *array = NULL;
    if (number[0] != NULL && number[1] != NULL && number[2] != NULL)
        value =
            PyObject_Vectorcall(PyTuple_GET_ITEM(call->calls, (Py_ssize_t)law), number, 3, NULL);
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

static bool say(void *context, size_t law, size_t count, const double *t, const double *u,
                const double *v, double *force)
{
    struct py_collocation *call = context;
    if (PyErr_CheckSignals() < 0)
        return fail(call, law, t[0], u[0], v[0]);
    if (call->arrays[law]) {
        if (say_all(call, law, count, t, u, v, force))
            return true;
        PyErr_Clear();
    }
    for (size_t i = 0; i < count; i++)
        if (!say_one(call, law, t[i], u[i], v[i], force + i))
            return false;
    return true;
}

/* --- arguments ---------------------------------------------------------------------------------*/

/* laws: (kind, value, calls, arrays) */
static int parse_laws(PyObject *object, struct py_collocation *call)
{
    PyObject *kind, *value, *arrays;
    if (!PyArg_ParseTuple(object, "OOO!O;laws must be (kind, value, calls, arrays)", &kind, &value,
                          &PyTuple_Type, &call->calls, &arrays))
        return -1;
    const npy_intp count = PyTuple_GET_SIZE(call->calls);
    call->laws.count = (size_t)count;
    call->laws.kind = keep(call, kind, NPY_INT32, 1, (npy_intp[]){count}, "kind");
    if (call->laws.kind == NULL)
        return -1;
    for (npy_intp d = 0; d < count; d++) {
        const int32_t one = call->laws.kind[d];
        if ((one != RD_SMOOTH_POWER && one != RD_SMOOTH_CALL) ||
            (one == RD_SMOOTH_CALL && !PyCallable_Check(PyTuple_GET_ITEM(call->calls, d)))) {
            PyErr_Format(PyExc_ValueError, "kind[%zd] must be 0, or 1 of what is called, got %d",
                         (Py_ssize_t)d, (int)one);
            return -1;
        }
    }
    call->laws.value = keep(call, value, NPY_DOUBLE, 2, (npy_intp[]){count, 2}, "value");
    call->arrays = call->laws.value == NULL
                       ? NULL
                       : keep(call, arrays, NPY_UINT8, 1, (npy_intp[]){count}, "arrays");
    call->laws.call = say;
    call->laws.context = call;
    return call->arrays == NULL ? -1 : 0;
}

/* step: (h, node, change, push, seen, own, ahead) */
static int parse_step(PyObject *object, struct py_collocation *call)
{
    PyObject *node, *change, *push, *seen, *own, *ahead;
    struct rd_collocation *step = &call->step;
    if (!PyArg_ParseTuple(object, "dOOOOOO;step must be (h, node, change, push, seen, own, ahead)",
                          &step->h, &node, &change, &push, &seen, &own, &ahead))
        return -1;
    step->node = keep(call, node, NPY_DOUBLE, 1, (npy_intp[]){-1}, "node");
    if (step->node == NULL)
        return -1;
    const npy_intp s = length_of(call, 0), n = (npy_intp)call->laws.count;
    if (s < 1 || s > 64) {
        PyErr_Format(PyExc_ValueError, "node must hold 1 to 64 stages, got %zd", (Py_ssize_t)s);
        return -1;
    }
    step->change = keep(call, change, NPY_DOUBLE, 3, (npy_intp[]){2, 2, -1}, "change");
    if (step->change == NULL)
        return -1;
    const npy_intp m = length_of(call, 2);
    step->stages = (size_t)s;
    step->laws = (size_t)n;
    step->modes = (size_t)m;
    step->push = keep(call, push, NPY_DOUBLE, 3, (npy_intp[]){s, 2, m}, "push");
    if (step->push != NULL)
        step->seen = keep(call, seen, NPY_DOUBLE, 6, (npy_intp[]){n, 2, m, s, 2, n}, "seen");
    if (step->seen != NULL)
        step->own = keep(call, own, NPY_DOUBLE, 5, (npy_intp[]){s, 2, n, s, n}, "own");
    if (step->own != NULL)
        step->ahead = keep(call, ahead, NPY_DOUBLE, 2, (npy_intp[]){s, s}, "ahead");
    return step->ahead == NULL ? -1 : 0;
}

/* a new array whose first row, or all of which, is given */
static PyObject *begun(PyObject *object, int dimensions, const npy_intp *shape, const char *name)
{
    PyArrayObject *given = py_array(object, NPY_DOUBLE, dimensions - 1, shape + 1, name);
    PyObject *array = given == NULL ? NULL : PyArray_ZEROS(dimensions, shape, NPY_DOUBLE, 0);
    if (array != NULL)
        memcpy(PyArray_DATA((PyArrayObject *)array), PyArray_DATA(given),
               (size_t)PyArray_NBYTES(given));
    Py_XDECREF(given);
    return array;
}

/* begin, known, force, state, size; what is made: force, state, motion, size */
static int parse_run(PyObject *const *object, struct py_collocation *call, PyObject *made[4])
{
    struct rd_collocated *run = &call->run;
    const npy_intp s = (npy_intp)call->step.stages, n = (npy_intp)call->step.laws;
    const npy_intp m = (npy_intp)call->step.modes;
    run->begin = keep(call, object[0], NPY_DOUBLE, 1, (npy_intp[]){-1}, "begin");
    if (run->begin == NULL)
        return -1;
    const npy_intp steps = length_of(call, 0);
    run->steps = (size_t)steps;
    run->known = keep(call, object[1], NPY_DOUBLE, 4, (npy_intp[]){steps, s, 2, n}, "known");
    if (run->known == NULL)
        return -1;
    made[0] = begun(object[2], 3, (npy_intp[]){steps + 1, s, n}, "force");
    made[1] = made[0] ? begun(object[3], 4, (npy_intp[]){steps + 1, n, 2, m}, "state") : NULL;
    made[3] = made[1] ? begun(object[4], 3, (npy_intp[]){1, 3, n}, "size") : NULL;
    made[2] = made[3] ? py_new(NPY_DOUBLE, 4, (npy_intp[]){steps, s, 2, n}) : NULL;
    if (made[2] == NULL)
        return -1;
    run->force = PyArray_DATA((PyArrayObject *)made[0]);
    run->state = PyArray_DATA((PyArrayObject *)made[1]);
    run->motion = PyArray_DATA((PyArrayObject *)made[2]);
    run->size = PyArray_DATA((PyArrayObject *)made[3]);
    return 0;
}

/* --- the call ----------------------------------------------------------------------------------*/

static bool calls_python(const struct py_collocation *call)
{
    for (size_t d = 0; d < call->laws.count; d++)
        if (call->laws.kind[d] == RD_SMOOTH_CALL)
            return true;
    return false;
}

/* None, or where a law failed and what it raised, None of no number */
static PyObject *failure_of(const struct py_collocation *call, enum rd_status status)
{
    if (status != RD_INTERRUPTED)
        return Py_NewRef(Py_None);
    PyObject *error = call->error == NULL ? Py_None : call->error;
    return Py_BuildValue("(Oiddd)", error, (int)call->failed[0], call->failed[1], call->failed[2],
                         call->failed[3]);
}

PyObject *py_collocate(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_collocation call = {0};
    struct rd_workspace workspace = {0};
    struct rd_collocation_work work;
    PyObject *step, *laws, *object[5], *made[4] = {NULL}, *failure = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOOOOO", &step, &laws, object, object + 1, object + 2,
                          object + 3, object + 4))
        return NULL;
    if (parse_laws(laws, &call) < 0 || parse_step(step, &call) < 0 ||
        parse_run(object, &call, made) < 0)
        goto done;
    rd_collocation_work(&call.step, &workspace, &work);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    rd_collocation_work(&call.step, &workspace, &work);
    enum rd_status status;
    if (calls_python(&call)) {
        status = rd_collocation_run(&call.step, &call.laws, &work, &call.run);
    } else {
        Py_BEGIN_ALLOW_THREADS
        status = rd_collocation_run(&call.step, &call.laws, &work, &call.run);
        Py_END_ALLOW_THREADS
    }
    failure = failure_of(&call, status);
    if (failure != NULL)
        result =
            Py_BuildValue("OOOOnndO", made[0], made[1], made[2], made[3], (Py_ssize_t)call.run.made,
                          (Py_ssize_t)call.run.iterations, call.run.residual, failure);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(failure);
    Py_XDECREF(call.error);
    for (int k = 0; k < 4; k++)
        Py_XDECREF(made[k]);
    while (call.kept > 0)
        Py_DECREF(call.keep[--call.kept]);
    return result;
}
