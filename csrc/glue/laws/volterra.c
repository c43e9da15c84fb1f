/* Forces of laws at points, from the step responses of these. */
#include "volterra/volterra.h"

#include "glue/glue.h"
#include "glue/laws/calls.h"

struct py_volterra {
    struct rd_volterra system;
    struct rd_volterra_run run;
    struct py_calls calls;
    struct py_kept kept;
};

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
        call->run.force = py_shared(&call->kept, object[2], 2, during, "force");
    if (call->run.force != NULL)
        call->run.motion = py_shared(&call->kept, object[3], 2, at, "motion");
    if (call->run.motion != NULL)
        call->run.size = py_shared(&call->kept, object[4], 1, during, "size");
    return call->run.size == NULL ? -1 : 0;
}

PyObject *py_volterra(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_volterra call = {0};
    struct rd_workspace workspace = {0};
    struct rd_law_step work;
    PyObject *laws, *object[5], *failure = NULL, *result = NULL;
    Py_ssize_t first, until;
    if (!PyArg_ParseTuple(arguments, "OddOOOOOnn", &laws, &call.system.begin, &call.system.h,
                          object, object + 1, object + 2, object + 3, object + 4, &first, &until))
        return NULL;
    if (py_laws_parse(laws, &call.kept, &call.calls, &call.system.laws) < 0 ||
        parse_arrays(object, &call) < 0)
        goto done;
    if (first < 0 || until < first || until > (Py_ssize_t)call.system.steps) {
        PyErr_Format(PyExc_ValueError, "steps must lie in 0 ... %zd, got %zd to %zd",
                     (Py_ssize_t)call.system.steps, first, until);
        goto done;
    }
    call.system.call = py_say;
    call.system.context = &call.calls;
    call.run.made = (size_t)first;
    rd_law_step_work(call.system.laws.ports.count, &workspace, &work);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    workspace.used = 0;
    rd_law_step_work(call.system.laws.ports.count, &workspace, &work);
    const struct rd_laws *const acts = &call.system.laws;
    PyThreadState *const others = py_let_others(acts->ports.count, acts->kind, RD_GIVEN);
    const enum rd_status status = rd_volterra_run(&call.system, (size_t)until, &work, &call.run);
    py_stop_others(others);
    failure = py_failure(&call.calls, status);
    if (failure != NULL)
        result = Py_BuildValue("ndO", (Py_ssize_t)call.run.made, call.run.residual, failure);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(failure);
    Py_XDECREF(call.calls.error);
    py_kept_release(&call.kept);
    return result;
}
