/* All rates of damped motion within a circle. */
#include "glue/glue.h"

#include "damped/search.h"

/* with as much room as it takes; 0, or -1 and an exception */
static int solve(PyObject *module, struct rd_search *search, PyObject **value, PyObject **error)
{
    struct py_watch watch;
    enum rd_status status = RD_NO_MEMORY;
    while (status == RD_NO_MEMORY) {
        struct rd_workspace workspace = {0};
        const npy_intp room = (npy_intp)search->room;
        Py_XSETREF(*value, py_new(NPY_COMPLEX128, 1, &room));
        Py_XSETREF(*error, py_new(NPY_DOUBLE, 1, &room));
        if (*value == NULL || *error == NULL)
            return -1;
        search->value = PyArray_DATA((PyArrayObject *)*value);
        search->error = PyArray_DATA((PyArrayObject *)*error);
        status = rd_search(search, &workspace);
        if (status != RD_NO_MEMORY)
            break;
        if (py_workspace_allocate(&workspace) < 0)
            return -1;
        search->stop = py_watch_begin(&watch);
        status = rd_search(search, &workspace);
        PyMem_RawFree(workspace.base);
        if (py_watch_end(&watch) < 0)
            return -1;
        if (status == RD_NO_MEMORY && search->count <= search->room)
            break;
        search->room = search->count;
    }
    if (status != RD_OK)
        py_raise(module, status);
    return status == RD_OK ? 0 : -1;
}

static void damping_of(PyArrayObject *constant, PyArrayObject *linear, struct rd_damping *damping)
{
    const double _Complex *c = PyArray_DATA(constant), *l = PyArray_DATA(linear);
    for (int p = 0; p < RD_PARTS; p++) {
        damping->constant[p] = c[p];
        damping->linear[p] = l[p];
    }
}

PyObject *py_damped(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_search search = {0};
    PyArrayObject *constant = NULL, *linear = NULL, *guess = NULL;
    PyObject *object[4], *value = NULL, *error = NULL, *found[2] = {NULL}, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOddddO", object, object + 1, object + 2, &search.middle,
                          &search.radius, &search.edge, &search.horizon, object + 3))
        return NULL;
    if (py_chain_view(object[0], &parsed) < 0)
        goto done;
    constant = py_array(object[1], NPY_COMPLEX128, 1, (npy_intp[]){RD_PARTS}, "constant");
    linear =
        constant ? py_array(object[2], NPY_COMPLEX128, 1, (npy_intp[]){RD_PARTS}, "linear") : NULL;
    guess = linear ? py_array(object[3], NPY_COMPLEX128, 1, (npy_intp[]){-1}, "guess") : NULL;
    if (guess == NULL)
        goto done;
    search.chain = &parsed.chain;
    damping_of(constant, linear, &search.damping);
    search.guesses = (size_t)PyArray_DIM(guess, 0);
    search.guess = PyArray_DATA(guess);
    search.room = search.guesses + 16;
    if (solve(module, &search, &value, &error) < 0)
        goto done;
    found[0] = PySequence_GetSlice(value, 0, (Py_ssize_t)search.found);
    found[1] = found[0] ? PySequence_GetSlice(error, 0, (Py_ssize_t)search.found) : NULL;
    if (found[1] != NULL)
        result = Py_BuildValue("OOndiOn", found[0], found[1], (Py_ssize_t)search.count, search.wide,
                               (int)search.mirror, search.certified ? Py_True : Py_False,
                               (Py_ssize_t)search.sweeps);
done:
    Py_XDECREF(found[1]);
    Py_XDECREF(found[0]);
    Py_XDECREF(error);
    Py_XDECREF(value);
    Py_XDECREF(guess);
    Py_XDECREF(linear);
    Py_XDECREF(constant);
    py_chain_release(&parsed);
    return result;
}
