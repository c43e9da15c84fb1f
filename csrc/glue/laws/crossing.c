/* When laws change. */
#include "law/crossing.h"

#include <string.h>

#include "glue/glue.h"

struct py_search {
    struct rd_course guards;
    const double *rate, *c, *d, *a, *scale; /* complex numbers as pairs */
    struct py_kept kept;
};

/* 0, or -1 and an exception: rate, c, d, a, scale */
static int parse_search(PyObject *const *object, struct py_search *search)
{
    struct py_kept *kept = &search->kept;
    struct rd_course *guards = &search->guards;
    search->rate = py_keep(kept, object[0], NPY_CDOUBLE, 1, (npy_intp[]){-1}, "rate");
    if (search->rate == NULL)
        return -1;
    const npy_intp rates = py_kept_length(kept, 0);
    search->c = py_keep(kept, object[1], NPY_CDOUBLE, 2, (npy_intp[]){-1, rates}, "c");
    if (search->c == NULL)
        return -1;
    const npy_intp outputs = py_kept_length(kept, 0);
    search->d = py_keep(kept, object[2], NPY_CDOUBLE, 2, (npy_intp[]){outputs, -1}, "d");
    if (search->d == NULL)
        return -1;
    const npy_intp growing = py_kept_length(kept, 1);
    search->a = py_keep(kept, object[3], NPY_DOUBLE, 2, (npy_intp[]){outputs, -1}, "a");
    if (search->a == NULL)
        return -1;
    const npy_intp powers = py_kept_length(kept, 1);
    search->scale = py_keep(kept, object[4], NPY_DOUBLE, 1, (npy_intp[]){outputs}, "scale");
    if (search->scale == NULL)
        return -1;
    if (growing > rates || powers < 1) {
        PyErr_Format(PyExc_ValueError,
                     "d must have as many rates as rate at most, %zd, and a one power at least, "
                     "got %zd and %zd",
                     (Py_ssize_t)rates, (Py_ssize_t)growing, (Py_ssize_t)powers);
        return -1;
    }
    *guards = (struct rd_course){.outputs = (size_t)outputs,
                                 .rates = (size_t)rates,
                                 .growing = (size_t)growing,
                                 .powers = (size_t)powers};
    return 0;
}

/* lays out the guards with their parts apart, or counts that while the workspace measures */
static void lay_out(struct py_search *search, struct rd_workspace *workspace)
{
    struct rd_course *guards = &search->guards;
    const size_t outputs = guards->outputs;
    guards->rate = rd_take(workspace, 2 * rd_course_room(guards->rates), sizeof(double));
    rd_course_take(workspace, guards, guards);
    if (!rd_workspace_fits(workspace))
        return;
    rd_course_parts(1, guards->rates, search->rate, guards->rate);
    rd_course_parts(outputs, guards->rates, search->c, guards->c);
    rd_course_parts(outputs, guards->growing, search->d, guards->d);
    memcpy(guards->a, search->a, outputs * guards->powers * sizeof(double));
}

PyObject *py_first_crossing(PyObject *module, PyObject *arguments)
{
    struct py_search search = {0};
    struct rd_workspace workspace = {0};
    struct rd_crossing crossing;
    struct rd_stop stop = {0};
    struct py_watch watch;
    PyObject *object[5], *result = NULL;
    double end;
    if (!PyArg_ParseTuple(arguments, "OOOOOd", object, object + 1, object + 2, object + 3,
                          object + 4, &end))
        return NULL;
    if (parse_search(object, &search) < 0)
        goto done;
    lay_out(&search, &workspace);
    rd_crossing_first(&search.guards, search.scale, end, &stop, &workspace, &crossing);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    workspace.used = 0;
    lay_out(&search, &workspace);
    stop = py_watch_begin(&watch);
    const enum rd_status status =
        rd_crossing_first(&search.guards, search.scale, end, &stop, &workspace, &crossing);
    if (py_watch_end(&watch) < 0)
        goto done;
    if (status != RD_OK)
        py_raise(module, status);
    else
        result = crossing.found ? Py_BuildValue("dn", crossing.time, (Py_ssize_t)crossing.which)
                                : Py_NewRef(Py_None);
done:
    PyMem_RawFree(workspace.base);
    py_kept_release(&search.kept);
    return result;
}
