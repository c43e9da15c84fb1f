/* Forces of laws at points, from the step responses of these. */
#include "volterra/volterra.h"

#include <string.h>

#include "glue/glue.h"
#include "glue/laws/calls.h"

struct py_volterra {
    struct rd_volterra system;
    struct rd_volterra_run run;
    struct py_calls calls;
    struct py_kept kept;
};

/* laws: (kind, value, calls) */
static int parse_laws(PyObject *object, struct py_volterra *call)
{
    PyObject *kind, *value;
    if (!PyArg_ParseTuple(object, "OOO!;laws must be (kind, value, calls)", &kind, &value,
                          &PyTuple_Type, &call->calls.law))
        return -1;
    const npy_intp count = PyTuple_GET_SIZE(call->calls.law);
    const npy_intp shape[] = {count, RD_LAW_VALUES};
    struct rd_laws *laws = &call->system.laws;
    laws->ports.count = (size_t)count;
    laws->kind = py_keep(&call->kept, kind, NPY_INT32, 1, shape, "kind");
    laws->value = laws->kind ? py_keep(&call->kept, value, NPY_DOUBLE, 2, shape, "value") : NULL;
    if (laws->value == NULL)
        return -1;
    for (npy_intp d = 0; d < count; d++) {
        const int32_t one = laws->kind[d];
        const int is_called = PyCallable_Check(PyTuple_GET_ITEM(call->calls.law, d));
        if (one < 0 || one >= RD_LAW_KINDS || (one == RD_GIVEN && !is_called)) {
            PyErr_Format(PyExc_ValueError, "kind[%zd] must be 0, 1, or 2 of what is called, got %d",
                         (Py_ssize_t)d, (int)one);
            return -1;
        }
    }
    call->system.call = py_say;
    call->system.context = &call->calls;
    return 0;
}

/* an array that the caller goes on with: it must be what it is taken for, no copy is made */
static double *shared(struct py_volterra *call, PyObject *object, int dimensions,
                      const npy_intp *shape, const char *name)
{
    double *data = py_keep(&call->kept, object, NPY_DOUBLE, dimensions, shape, name);
    if (data == NULL)
        return NULL;
    PyArrayObject *array = call->kept.array[call->kept.count - 1];
    if ((PyObject *)array != object || !PyArray_ISWRITEABLE(array)) {
        PyErr_Format(PyExc_ValueError, "%s must be a writable array of float64 in C order", name);
        return NULL;
    }
    return data;
}

/* kernel, linear, force, motion, size */
static int parse_arrays(PyObject *const *object, struct py_volterra *call)
{
    const npy_intp m = (npy_intp)call->system.laws.ports.count;
    struct rd_volterra *system = &call->system;
    system->kernel =
        py_keep(&call->kept, object[0], NPY_DOUBLE, 3, (npy_intp[]){m, m, -1}, "kernel");
    if (system->kernel == NULL)
        return -1;
    const npy_intp steps = py_kept_length(&call->kept, 2);
    system->steps = (size_t)steps;
    const npy_intp during[] = {m, steps}, at[] = {m, steps + 1};
    system->linear = py_keep(&call->kept, object[1], NPY_DOUBLE, 2, at, "linear");
    if (system->linear != NULL)
        call->run.force = shared(call, object[2], 2, during, "force");
    if (call->run.force != NULL)
        call->run.motion = shared(call, object[3], 2, at, "motion");
    if (call->run.motion != NULL)
        call->run.size = shared(call, object[4], 1, during, "size");
    return call->run.size == NULL ? -1 : 0;
}

static enum rd_status run(struct py_volterra *call, size_t until,
                          const struct rd_volterra_work *work)
{
    enum rd_status status;
    for (size_t d = 0; d < call->system.laws.ports.count; d++)
        if (call->system.laws.kind[d] == RD_GIVEN)
            return rd_volterra_run(&call->system, until, work, &call->run);
    Py_BEGIN_ALLOW_THREADS
    status = rd_volterra_run(&call->system, until, work, &call->run);
    Py_END_ALLOW_THREADS
    return status;
}

PyObject *py_volterra(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_volterra call = {0};
    struct rd_workspace workspace = {0};
    struct rd_volterra_work work;
    PyObject *laws, *object[5], *failure = NULL, *result = NULL;
    Py_ssize_t first, until;
    if (!PyArg_ParseTuple(arguments, "OddOOOOOnn", &laws, &call.system.begin, &call.system.h,
                          object, object + 1, object + 2, object + 3, object + 4, &first, &until))
        return NULL;
    if (parse_laws(laws, &call) < 0 || parse_arrays(object, &call) < 0)
        goto done;
    if (first < 0 || until < first || until > (Py_ssize_t)call.system.steps) {
        PyErr_Format(PyExc_ValueError, "steps must lie in 0 ... %zd, got %zd to %zd",
                     (Py_ssize_t)call.system.steps, first, until);
        goto done;
    }
    call.run.made = (size_t)first;
    rd_volterra_work(call.system.laws.ports.count, &workspace, &work);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    workspace.used = 0;
    rd_volterra_work(call.system.laws.ports.count, &workspace, &work);
    failure = py_failure(&call.calls, run(&call, (size_t)until, &work));
    if (failure != NULL)
        result = Py_BuildValue("ndO", (Py_ssize_t)call.run.made, call.run.residual, failure);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(failure);
    Py_XDECREF(call.calls.error);
    py_kept_release(&call.kept);
    return result;
}
