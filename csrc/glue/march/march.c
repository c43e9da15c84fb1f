/* Implicit time steps. */
#include "glue/march/march.h"

#include "march/run.h"
#include "march/stage.h"

PyObject *py_march_factor(PyObject *module, PyObject *arguments)
{
    struct py_march march = {0};
    PyObject *object[3], *plan = NULL, *result = NULL;
    double theta, extra;
    if (!PyArg_ParseTuple(arguments, "OOOdd", object, object + 1, object + 2, &theta, &extra))
        return NULL;
    if (py_march_parse(object, "march_factor", &march) < 0)
        goto done;
    rd_march_prepare(&march.parsed.chain, &march.beside, &march.laws, &march.march,
                     &march.workspace);
    if (march.workspace.used > NPY_MAX_INTP) {
        PyErr_NoMemory();
        goto done;
    }
    plan = PyArray_ZEROS(1, (npy_intp[]){(npy_intp)march.workspace.used}, NPY_UINT8, 0);
    if (plan == NULL || py_march_open(plan, &march) < 0)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_march_prepare(&march.parsed.chain, &march.beside, &march.laws, &march.march,
                              &march.workspace);
    if (status == RD_OK)
        status = rd_march_factor(&march.march, theta, extra);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = Py_NewRef(plan);
    else
        py_raise(module, status);
done:
    Py_XDECREF(plan);
    py_march_release(&march);
    return result;
}

/* chain, beside, law, plan, g, h, state: up to a march that can go on */
static int open_march(PyObject *module, const char *entry, PyObject *const *object, double g,
                      double h, struct py_march *march)
{
    if (py_march_parse(object, entry, march) < 0 || py_march_open(object[3], march) < 0)
        return -1;
    const enum rd_status status = rd_march_prepare(&march->parsed.chain, &march->beside,
                                                   &march->laws, &march->march, &march->workspace);
    if (status != RD_OK) {
        py_raise(module, status);
        return -1;
    }
    return py_march_check(march, g, h) < 0 ? -1 : py_motion_parse(object[4], march);
}

/* the numbers of the steps and where their answers go */
static int parse_steps(PyObject *const *object, int energies, struct py_march *march,
                       struct rd_steps *steps, PyObject **read, PyObject **energy, PyObject **taken)
{
    PyObject *force = object[0], *speed = object[1], *extra = object[2];
    const npy_intp d = (npy_intp)march->drives.ports.count, k = (npy_intp)march->push.moved;
    steps->force = py_keep(&march->kept, force, NPY_DOUBLE, 3, (npy_intp[]){-1, 2, d}, "force");
    if (steps->force == NULL)
        return -1;
    const npy_intp count = py_kept_length(&march->kept, 0);
    const npy_intp rows = energies ? count : 0, m = (npy_intp)march->laws.ports.count;
    steps->count = (size_t)count;
    steps->speed = py_keep(&march->kept, speed, NPY_DOUBLE, 3, (npy_intp[]){count, 2, k}, "speed");
    if (steps->speed == NULL)
        return -1;
    if (extra != Py_None) {
        steps->extra = py_keep(&march->kept, extra, NPY_DOUBLE, 2, (npy_intp[]){count, 2}, "extra");
        if (steps->extra == NULL)
            return -1;
    }
    const npy_intp r = (npy_intp)march->responses.ports.count;
    *read = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, 3, r});
    *energy = py_new(NPY_DOUBLE, 2, (npy_intp[]){rows, RD_ENERGIES});
    *taken = py_new(NPY_DOUBLE, 2, (npy_intp[]){rows, m});
    if (*read == NULL || *energy == NULL || *taken == NULL)
        return -1;
    steps->read = PyArray_DATA((PyArrayObject *)*read);
    steps->energy = energies ? PyArray_DATA((PyArrayObject *)*energy) : NULL;
    steps->taken = energies ? PyArray_DATA((PyArrayObject *)*taken) : NULL;
    return 0;
}

PyObject *py_march(PyObject *module, PyObject *arguments)
{
    struct py_march march = {0};
    struct rd_steps steps = {0};
    PyObject *object[5], *drive, *moved, *number[3], *response;
    PyObject *read = NULL, *energy = NULL, *taken = NULL, *result = NULL;
    int energies, refined;
    if (!PyArg_ParseTuple(arguments, "OOOOddOOOOOOOpp", object, object + 1, object + 2, object + 3,
                          &steps.g, &steps.h, object + 4, &drive, number, &moved, number + 1,
                          number + 2, &response, &energies, &refined))
        return NULL;
    steps.refined = refined;
    if (open_march(module, "march", object, steps.g, steps.h, &march) < 0 ||
        py_push_parse(drive, moved, &march) < 0 ||
        py_ports_parse(response, &march.parsed.chain, "response", &march.responses) < 0 ||
        parse_steps(number, energies, &march, &steps, &read, &energy, &taken) < 0)
        goto done;
    enum rd_status status;
    size_t made;
    struct py_watch watch;
    const struct rd_stop stop = py_watch_begin(&watch);
    rd_march_load(&march.march, &march.motion);
    made = rd_march_run(&march.march, &march.push, &march.responses.ports, &steps, &stop, &status);
    rd_march_unload(&march.march, &march.motion);
    if (py_watch_end(&watch) < 0)
        goto done;
    if (status == RD_OK || status == RD_NO_CONVERGENCE)
        result = Py_BuildValue("OOOnd", read, energy, taken, (Py_ssize_t)made, steps.residual);
    else
        py_raise(module, status);
done:
    Py_XDECREF(taken);
    Py_XDECREF(energy);
    Py_XDECREF(read);
    py_march_release(&march);
    return result;
}

/* one at a time, with forces from outside, a stage does not find its own tension */
static int check_stage(int stage, const struct py_march *march)
{
    if ((stage == 0 || stage == 1) && march->beside.stretching == 0)
        return 0;
    PyErr_SetString(PyExc_ValueError, "stage must be 0 or 1 and stretching 0");
    return -1;
}

PyObject *py_march_stage(PyObject *module, PyObject *arguments)
{
    struct py_march march = {0};
    PyObject *object[5], *drive, *force, *moved, *speed, *result = NULL;
    PyObject *alone = NULL, *compliance = NULL, *start = NULL;
    double g, h;
    int stage;
    if (!PyArg_ParseTuple(arguments, "OOOOddOiOOOO", object, object + 1, object + 2, object + 3, &g,
                          &h, object + 4, &stage, &drive, &force, &moved, &speed))
        return NULL;
    if (open_march(module, "march_stage", object, g, h, &march) < 0 ||
        check_stage(stage, &march) < 0 || py_push_parse(drive, moved, &march) < 0)
        goto done;
    const npy_intp d = (npy_intp)march.push.drives->count, k = (npy_intp)march.push.moved;
    const npy_intp square[] = {(npy_intp)march.laws.ports.count, (npy_intp)march.laws.ports.count};
    march.push.force = py_keep(&march.kept, force, NPY_DOUBLE, 1, &d, "force");
    march.push.speed =
        march.push.force ? py_keep(&march.kept, speed, NPY_DOUBLE, 1, &k, "speed") : NULL;
    if (march.push.speed == NULL)
        goto done;
    alone = py_new(NPY_DOUBLE, 1, square);
    compliance = py_new(NPY_DOUBLE, 2, square);
    start = py_new(NPY_DOUBLE, 1, square);
    if (alone == NULL || compliance == NULL || start == NULL)
        goto done;
    const double base = march.march.number->base;
    const enum rd_status status =
        march.march.number->extra == base ? RD_OK : rd_march_tighten(&march.march, base);
    if (status != RD_OK) {
        py_raise(module, status);
        goto done;
    }
    march.march.refined = true;
    rd_march_load(&march.march, &march.motion);
    rd_march_begin(&march.march, g, stage, &march.push);
    rd_march_lean(&march.march, &march.push);
    rd_march_clear(&march.march, &march.push);
    rd_march_points(&march.march, PyArray_DATA((PyArrayObject *)alone),
                    PyArray_DATA((PyArrayObject *)compliance),
                    PyArray_DATA((PyArrayObject *)start));
    result = PyTuple_Pack(3, alone, compliance, start);
done:
    Py_XDECREF(start);
    Py_XDECREF(compliance);
    Py_XDECREF(alone);
    py_march_release(&march);
    return result;
}

PyObject *py_march_finish(PyObject *module, PyObject *arguments)
{
    struct py_march march = {0};
    PyObject *object[5], *force, *result = NULL;
    double g, h;
    int stage;
    if (!PyArg_ParseTuple(arguments, "OOOOddOiO", object, object + 1, object + 2, object + 3, &g,
                          &h, object + 4, &stage, &force))
        return NULL;
    if (open_march(module, "march_finish", object, g, h, &march) < 0 ||
        check_stage(stage, &march) < 0)
        goto done;
    const npy_intp m = (npy_intp)march.laws.ports.count;
    const double *given = py_keep(&march.kept, force, NPY_DOUBLE, 1, &m, "force");
    if (given == NULL)
        goto done;
    for (npy_intp k = 0; k < m; k++)
        march.march.force[k] = given[k];
    rd_march_load(&march.march, &march.motion);
    rd_march_choose(&march.march, stage);
    rd_march_add_laws(&march.march);
    rd_march_take(&march.march, g, stage);
    if (stage == 1)
        rd_march_unload(&march.march, &march.motion);
    result = Py_NewRef(Py_None);
done:
    py_march_release(&march);
    return result;
}

PyObject *py_march_laws(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_march march = {0};
    struct rd_workspace workspace = {0};
    PyObject *law, *number[4], *force = NULL, *result = NULL;
    double theta;
    if (!PyArg_ParseTuple(arguments, "OdOOOO", &law, &theta, number, number + 1, number + 2,
                          number + 3))
        return NULL;
    if (py_law_numbers_parse(law, &march) < 0)
        goto done;
    const npy_intp square[] = {(npy_intp)march.laws.ports.count, (npy_intp)march.laws.ports.count};
    const double *lean = py_keep(&march.kept, number[0], NPY_DOUBLE, 1, square, "increment");
    const double *C =
        lean ? py_keep(&march.kept, number[1], NPY_DOUBLE, 2, square, "compliance") : NULL;
    const double *start =
        C ? py_keep(&march.kept, number[2], NPY_DOUBLE, 1, square, "start") : NULL;
    const double *given =
        start ? py_keep(&march.kept, number[3], NPY_DOUBLE, 1, square, "force") : NULL;
    force = given ? py_new(NPY_DOUBLE, 1, square) : NULL;
    if (force == NULL)
        goto done;
    rd_take(&workspace, march.laws.ports.count * (march.laws.ports.count + 4), sizeof(double));
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    double *found = PyArray_DATA((PyArrayObject *)force);
    for (npy_intp k = 0; k < square[0]; k++)
        found[k] = march.laws.kind[k] == RD_GIVEN ? given[k] : 0;
    const double residual =
        rd_laws_solve(&march.laws, theta, lean, C, start, found, (double *)(void *)workspace.base);
    result = Py_BuildValue("Od", force, residual);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(force);
    py_march_release(&march);
    return result;
}
