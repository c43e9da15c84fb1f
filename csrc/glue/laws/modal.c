/* Modes under laws of points and a tension that varies, step by step. */
#include "volterra/modal.h"

#include "glue/glue.h"
#include "glue/laws/calls.h"

struct py_modal {
    struct rd_modal system;
    struct rd_modal_run run;
    struct py_calls calls;
    struct py_kept kept;
};

/* step: (begin, h, change, push) */
static int parse_step(PyObject *object, struct py_modal *call)
{
    PyObject *change, *push;
    struct rd_modal *system = &call->system;
    if (!PyArg_ParseTuple(object, "ddOO;step must be (begin, h, change, push)", &system->begin,
                          &system->h, &change, &push))
        return -1;
    system->change = py_keep(&call->kept, change, NPY_DOUBLE, 3, (npy_intp[]){2, 2, -1}, "change");
    if (system->change == NULL)
        return -1;
    const npy_intp m = py_kept_length(&call->kept, 2);
    system->modes = (size_t)m;
    system->push = py_keep(&call->kept, push, NPY_DOUBLE, 2, (npy_intp[]){2, m}, "push");
    return system->push == NULL ? -1 : 0;
}

/* coupling: (row, form, drag or None, tension, stretching) */
static int parse_coupling(PyObject *object, struct py_modal *call)
{
    PyObject *row, *form, *drag, *tension;
    struct rd_modal *system = &call->system;
    const npy_intp m = (npy_intp)system->modes, n = (npy_intp)system->laws.ports.count;
    const npy_intp square[] = {m, m};
    if (!PyArg_ParseTuple(object, "OOOOd;coupling must be (row, form, drag, tension, stretching)",
                          &row, &form, &drag, &tension, &system->stretching))
        return -1;
    system->tension = py_keep(&call->kept, tension, NPY_DOUBLE, 1, (npy_intp[]){-1}, "tension");
    if (system->tension == NULL)
        return -1;
    system->steps = (size_t)py_kept_length(&call->kept, 0);
    system->row = py_keep(&call->kept, row, NPY_DOUBLE, 2, (npy_intp[]){n, m}, "row");
    if (system->row != NULL)
        system->form = py_keep(&call->kept, form, NPY_DOUBLE, 2, square, "form");
    if (system->form == NULL)
        return -1;
    if (drag != Py_None)
        system->drag = py_keep(&call->kept, drag, NPY_DOUBLE, 2, square, "drag");
    return drag != Py_None && system->drag == NULL ? -1 : 0;
}

/* known, state, pushed, force, largest, size */
static int parse_arrays(PyObject *const *object, struct py_modal *call)
{
    struct rd_modal_run *run = &call->run;
    const npy_intp m = (npy_intp)call->system.modes, n = (npy_intp)call->system.laws.ports.count;
    const npy_intp at = (npy_intp)call->system.steps + 1;
    call->system.known =
        py_keep(&call->kept, object[0], NPY_DOUBLE, 2, (npy_intp[]){at, m}, "known");
    if (call->system.known != NULL)
        run->state = py_shared(&call->kept, object[1], 3, (npy_intp[]){at, 2, m}, "state");
    if (run->state != NULL)
        run->pushed = py_shared(&call->kept, object[2], 2, (npy_intp[]){at, m}, "pushed");
    if (run->pushed != NULL)
        run->force = py_shared(&call->kept, object[3], 2, (npy_intp[]){at, n}, "force");
    if (run->force != NULL)
        run->largest = py_shared(&call->kept, object[4], 1, (npy_intp[]){1}, "largest");
    if (run->largest != NULL)
        run->size = py_shared(&call->kept, object[5], 1, (npy_intp[]){n}, "size");
    return run->size == NULL ? -1 : 0;
}

PyObject *py_modal_steps(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_modal call = {0};
    struct rd_workspace workspace = {0};
    struct rd_modal_work work;
    PyObject *step, *laws, *coupling, *object[6], *failure = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O!O!O!OOOOOO", &PyTuple_Type, &step, &PyTuple_Type, &laws,
                          &PyTuple_Type, &coupling, object, object + 1, object + 2, object + 3,
                          object + 4, object + 5))
        return NULL;
    if (parse_step(step, &call) < 0 ||
        py_laws_parse(laws, &call.kept, &call.calls, &call.system.laws) < 0 ||
        parse_coupling(coupling, &call) < 0 || parse_arrays(object, &call) < 0)
        goto done;
    call.system.call = py_say;
    call.system.context = &call.calls;
    rd_modal_work(&call.system, &workspace, &work);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    rd_modal_work(&call.system, &workspace, &work);
    const struct rd_laws *const acts = &call.system.laws;
    PyThreadState *const others = py_let_others(acts->ports.count, acts->kind, RD_GIVEN);
    const enum rd_status status = rd_modal_run(&call.system, &work, &call.run);
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
