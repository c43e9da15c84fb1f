/* Steps under smooth laws, which Python may know. */
#include "glue/glue.h"

#include <string.h>

#include "collocation/collocation.h"
#include "glue/laws/calls.h"

struct py_collocation {
    struct rd_collocation step;
    struct rd_smooth_laws laws;
    struct rd_collocated run;
    struct py_calls calls;
    struct py_kept kept;
};

/* --- arguments ---------------------------------------------------------------------------------*/

/* laws: (kind, value, calls, arrays) */
static int parse_laws(PyObject *object, struct py_collocation *call)
{
    PyObject *kind, *value, *arrays;
    if (!PyArg_ParseTuple(object, "OOO!O;laws must be (kind, value, calls, arrays)", &kind, &value,
                          &PyTuple_Type, &call->calls.law, &arrays))
        return -1;
    const npy_intp count = PyTuple_GET_SIZE(call->calls.law);
    call->laws.count = (size_t)count;
    call->laws.kind = py_keep(&call->kept, kind, NPY_INT32, 1, (npy_intp[]){count}, "kind");
    if (call->laws.kind == NULL)
        return -1;
    for (npy_intp d = 0; d < count; d++) {
        const int32_t one = call->laws.kind[d];
        if ((one != RD_SMOOTH_POWER && one != RD_SMOOTH_CALL) ||
            (one == RD_SMOOTH_CALL && !PyCallable_Check(PyTuple_GET_ITEM(call->calls.law, d)))) {
            PyErr_Format(PyExc_ValueError, "kind[%zd] must be 0, or 1 of what is called, got %d",
                         (Py_ssize_t)d, (int)one);
            return -1;
        }
    }
    call->laws.value = py_keep(&call->kept, value, NPY_DOUBLE, 2, (npy_intp[]){count, 2}, "value");
    call->calls.arrays = call->laws.value == NULL ? NULL
                                                  : py_keep(&call->kept, arrays, NPY_UINT8, 1,
                                                            (npy_intp[]){count}, "arrays");
    call->laws.call = py_say;
    call->laws.context = &call->calls;
    return call->calls.arrays == NULL ? -1 : 0;
}

/* step: (h, node, change, push, seen, own, ahead) */
static int parse_step(PyObject *object, struct py_collocation *call)
{
    PyObject *node, *change, *push, *seen, *own, *ahead;
    struct rd_collocation *step = &call->step;
    if (!PyArg_ParseTuple(object, "dOOOOOO;step must be (h, node, change, push, seen, own, ahead)",
                          &step->h, &node, &change, &push, &seen, &own, &ahead))
        return -1;
    step->node = py_keep(&call->kept, node, NPY_DOUBLE, 1, (npy_intp[]){-1}, "node");
    if (step->node == NULL)
        return -1;
    const npy_intp s = py_kept_length(&call->kept, 0), n = (npy_intp)call->laws.count;
    if (s < 1 || s > 64) {
        PyErr_Format(PyExc_ValueError, "node must hold 1 to 64 stages, got %zd", (Py_ssize_t)s);
        return -1;
    }
    step->change = py_keep(&call->kept, change, NPY_DOUBLE, 3, (npy_intp[]){2, 2, -1}, "change");
    if (step->change == NULL)
        return -1;
    const npy_intp m = py_kept_length(&call->kept, 2);
    step->stages = (size_t)s;
    step->laws = (size_t)n;
    step->modes = (size_t)m;
    step->push = py_keep(&call->kept, push, NPY_DOUBLE, 3, (npy_intp[]){s, 2, m}, "push");
    if (step->push != NULL)
        step->seen =
            py_keep(&call->kept, seen, NPY_DOUBLE, 6, (npy_intp[]){n, 2, m, s, 2, n}, "seen");
    if (step->seen != NULL)
        step->own = py_keep(&call->kept, own, NPY_DOUBLE, 5, (npy_intp[]){s, 2, n, s, n}, "own");
    if (step->own != NULL)
        step->ahead = py_keep(&call->kept, ahead, NPY_DOUBLE, 2, (npy_intp[]){s, s}, "ahead");
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
    run->begin = py_keep(&call->kept, object[0], NPY_DOUBLE, 1, (npy_intp[]){-1}, "begin");
    if (run->begin == NULL)
        return -1;
    const npy_intp steps = py_kept_length(&call->kept, 0);
    run->steps = (size_t)steps;
    run->known =
        py_keep(&call->kept, object[1], NPY_DOUBLE, 4, (npy_intp[]){steps, s, 2, n}, "known");
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
    PyThreadState *const others = py_let_others(call.laws.count, call.laws.kind, RD_SMOOTH_CALL);
    const enum rd_status status = rd_collocation_run(&call.step, &call.laws, &work, &call.run);
    py_stop_others(others);
    failure = py_failure(&call.calls, status);
    if (failure != NULL)
        result =
            Py_BuildValue("OOOOnndO", made[0], made[1], made[2], made[3], (Py_ssize_t)call.run.made,
                          (Py_ssize_t)call.run.iterations, call.run.residual, failure);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(failure);
    Py_XDECREF(call.calls.error);
    for (int k = 0; k < 4; k++)
        Py_XDECREF(made[k]);
    py_kept_release(&call.kept);
    return result;
}
