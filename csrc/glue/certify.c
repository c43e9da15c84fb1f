/* Certified modes and counts by sweeps along the chain. */
#include "glue/glue.h"

#include "modes/certify/certify.h"
#include "modes/count/count.h"

#include <math.h>

/* fills the walk; the workspace then owns its arrays. 0, or -1 and an exception */
static int prepare(PyObject *module, const struct rd_chain *chain, struct rd_workspace *workspace,
                   struct rd_walk *walk)
{
    rd_walk_fill(chain, workspace, walk);
    if (py_workspace_allocate(workspace) < 0)
        return -1;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_walk_fill(chain, workspace, walk);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        return 0;
    py_raise(module, status);
    return -1;
}

PyObject *py_count(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_walk walk;
    PyArrayObject *lambda = NULL;
    PyObject *chain, *object, *counts = NULL, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &object))
        return NULL;
    if (py_chain_view(chain, &parsed) < 0)
        goto done;
    lambda = py_array(object, NPY_DOUBLE, 1, (npy_intp[]){-1}, "lambda");
    if (lambda == NULL)
        goto done;
    counts = py_new(NPY_DOUBLE, 1, PyArray_DIMS(lambda));
    if (counts == NULL || prepare(module, &parsed.chain, &workspace, &walk) < 0)
        goto done;
    struct py_watch watch;
    walk.stop = py_watch_begin(&watch);
    rd_count(&walk, (size_t)PyArray_SIZE(lambda), PyArray_DATA(lambda),
             PyArray_DATA((PyArrayObject *)counts));
    if (py_watch_end(&watch) < 0)
        goto done;
    const double *count = PyArray_DATA((PyArrayObject *)counts);
    for (npy_intp i = 0; i < PyArray_SIZE(lambda); i++)
        if (isnan(count[i])) {
            py_raise(module, RD_SHORT_WAVES);
            goto done;
        }
    result = Py_NewRef(counts);
done:
    PyMem_RawFree(workspace.base);
    Py_XDECREF(counts);
    Py_XDECREF(lambda);
    py_chain_release(&parsed);
    return result;
}

enum { LAMBDA, ERROR, CERTIFIED, BRACKET, SHAPE, MOTION, ARRAYS };

/* once with so much room; RD_NO_MEMORY where it is too little or, with an exception, there is none */
static enum rd_status solve_in(struct rd_walk *walk, size_t steps, size_t pieces,
                               struct rd_certified *modes)
{
    struct rd_workspace workspace = {0};
    struct rd_refine refine;
    enum rd_status status = RD_NO_MEMORY;
    rd_refine_take(walk, steps, pieces, modes->blocks, &workspace, &refine);
    if (py_workspace_allocate(&workspace) == 0) {
        struct py_watch watch;
        walk->stop = py_watch_begin(&watch);
        rd_refine_take(walk, steps, pieces, modes->blocks, &workspace, &refine);
        status = rd_certify(&refine, modes);
        if (py_watch_end(&watch) < 0)
            status = RD_INTERRUPTED;
    }
    PyMem_RawFree(workspace.base);
    return status;
}

/* solves for the modes; 0, or -1 and an exception */
static int solve(PyObject *module, struct rd_walk *walk, struct rd_certified *modes)
{
    enum rd_status status = RD_NO_MEMORY;
    size_t steps, pieces, wanted = modes->wanted;
    for (bool most = false; status == RD_NO_MEMORY && !most && !PyErr_Occurred();) {
        const size_t blocks = modes->blocks;
        most = rd_certify_size(walk, wanted, &steps, &pieces);
        status = solve_in(walk, steps, pieces, modes);
        if (modes->blocks > blocks)
            most = false;
        else
            wanted = 4 * wanted + 4;
    }
    if (PyErr_Occurred())
        return -1;
    if (status != RD_OK)
        py_raise(module, status);
    return status == RD_OK ? 0 : -1;
}

/* the arrays that are filled; 0, or -1 and an exception where one has no memory */
static int arrays_make(const struct rd_chain *chain, npy_intp wanted, npy_intp shaped,
                       PyObject **array, double **data)
{
    static const int dimensions[ARRAYS] = {1, 1, 1, 2, 3, 2};
    const npy_intp size[ARRAYS][3] = {
        [LAMBDA] = {wanted},
        [ERROR] = {wanted},
        [CERTIFIED] = {wanted},
        [BRACKET] = {4, wanted},
        [SHAPE] = {shaped, (npy_intp)chain->nodes, (npy_intp)chain->width},
        [MOTION] = {shaped, (npy_intp)chain->attached},
    };
    for (int k = 0; k < ARRAYS; k++) {
        array[k] = py_new(NPY_DOUBLE, dimensions[k], size[k]);
        if (array[k] == NULL)
            return -1;
        data[k] = PyArray_DATA((PyArrayObject *)array[k]);
    }
    return 0;
}

PyObject *py_certify(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct rd_workspace workspace = {0};
    struct rd_walk walk;
    PyObject *object, *array[ARRAYS] = {NULL}, *result = NULL;
    Py_ssize_t wanted;
    double upper;
    int shaped;
    if (!PyArg_ParseTuple(arguments, "Ondp", &object, &wanted, &upper, &shaped))
        return NULL;
    if (wanted < 0) {
        PyErr_SetString(PyExc_ValueError, "wanted must be >= 0");
        return NULL;
    }
    if (py_chain_view(object, &parsed) < 0)
        goto done;
    double *data[ARRAYS] = {NULL};
    if (arrays_make(&parsed.chain, wanted, shaped ? wanted : 0, array, data) < 0)
        goto done;
    if (prepare(module, &parsed.chain, &workspace, &walk) < 0)
        goto done;
    struct rd_certified modes = {
        .wanted = (size_t)wanted,
        .upper = upper,
        .blocks = 1,
        .lambda = data[LAMBDA],
        .error = data[ERROR],
        .certified = data[CERTIFIED],
        .bracket = data[BRACKET],
        .shape = shaped ? data[SHAPE] : NULL,
        .motion = data[MOTION],
    };
    if (solve(module, &walk, &modes) < 0)
        goto done;
    result = Py_BuildValue("OOOOOnnn", array[LAMBDA], array[ERROR], array[CERTIFIED], array[SHAPE],
                           array[MOTION], (Py_ssize_t)modes.found,
                           (Py_ssize_t)(modes.counts + 2 * RD_LANES * modes.iterations),
                           (Py_ssize_t)modes.redone);
done:
    PyMem_RawFree(workspace.base);
    for (int k = 0; k < ARRAYS; k++)
        Py_XDECREF(array[k]);
    py_chain_release(&parsed);
    return result;
}
