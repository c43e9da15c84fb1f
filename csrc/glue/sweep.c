/* What sweeps at complex factors: frequency response and its cost. */
#include "glue/response.h"

#include "sweep/sweep.h"

/* the factors (RD_PARTS, count) as views of an array's rows */
static struct rd_factors factors_of(PyArrayObject *factor)
{
    const size_t count = (size_t)PyArray_DIM(factor, 1);
    const double *row = PyArray_DATA(factor);
    return (struct rd_factors){
        .count = count,
        .section = row,
        .tension = row + 2 * count,
        .spring = row + 4 * count,
        .inertia = row + 6 * count,
        .dashpot = row + 8 * count,
    };
}

/* (chain, factor): 0, or -1 and an exception; both are to be released */
static int parse_factored(PyObject *arguments, struct py_chain *parsed, PyArrayObject **factor)
{
    PyObject *chain, *given;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &given) || py_chain_view(chain, parsed) < 0)
        return -1;
    *factor = py_array(given, NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    return *factor == NULL ? -1 : 0;
}

PyObject *py_steps(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *result = NULL;
    if (parse_factored(arguments, &parsed, &factor) < 0)
        goto done;
    const struct rd_factors factors = factors_of(factor);
    size_t most = 0;
    for (size_t i = 0; i < factors.count; i++) {
        const struct sweep_extent extent = rd_sweep_extent(&factors, i);
        const size_t steps = rd_sweep_steps(&parsed.chain, &extent);
        most = steps > most ? steps : most;
    }
    result = PyLong_FromSize_t(most);
done:
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}

/* z (width, count) of all frequencies; 0, or -1 and an exception */
static int scales_fill(const struct rd_chain *chain, const struct rd_factors *factors, double *z)
{
    struct rd_runs runs;
    struct rd_run *run = PyMem_RawMalloc((rd_runs_capacity(chain) + 1) * sizeof *run);
    if (run == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    rd_runs_find(chain, run, &runs);
    for (size_t i = 0; i < factors->count; i++) {
        const struct sweep_extent extent = rd_sweep_extent(factors, i);
        double own[RD_WIDTH_MAX];
        rd_sweep_receptance(chain, &runs, &extent, own);
        for (size_t c = 0; c < chain->width; c++)
            z[c * factors->count + i] = own[c];
    }
    PyMem_RawFree(run);
    return 0;
}

PyObject *py_scales(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct py_chain parsed = {0};
    PyArrayObject *factor = NULL;
    PyObject *z = NULL, *result = NULL;
    if (parse_factored(arguments, &parsed, &factor) < 0)
        goto done;
    const struct rd_factors factors = factors_of(factor);
    z = py_new(NPY_DOUBLE, 2, (npy_intp[]){(npy_intp)parsed.chain.width, (npy_intp)factors.count});
    if (z != NULL && scales_fill(&parsed.chain, &factors, PyArray_DATA((PyArrayObject *)z)) == 0)
        result = Py_NewRef(z);
done:
    Py_XDECREF(z);
    Py_XDECREF(factor);
    py_chain_release(&parsed);
    return result;
}

/* what is known of elements whose tension grows, at nodes between which the frequencies lie */
struct py_between {
    struct py_kept kept;
    struct rd_between_factors nodes;
    struct rd_between between;
    size_t *first;
    npy_intp places;
};

static void between_release(struct py_between *parsed)
{
    PyMem_RawFree(parsed->first);
    py_kept_release(&parsed->kept);
}

static bool are_real(const struct rd_factors *factors)
{
    bool any = false;
    for (size_t i = 0; i < factors->count; i++)
        any |= factors->section[2 * i + 1] != 0 || factors->tension[2 * i + 1] != 0 ||
               factors->inertia[2 * i + 1] != 0;
    return !any;
}

/* of the factors at the nodes: 0, or -1 and an exception; to be released in both cases */
static int between_begin(PyObject *module, const struct rd_chain *chain, PyObject *factor,
                         struct py_between *parsed)
{
    const double *row =
        py_keep(&parsed->kept, factor, NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "nodes");
    if (row == NULL)
        return -1;
    const size_t nodes = (size_t)py_kept_length(&parsed->kept, 1);
    if (nodes == 0 || nodes > RD_BETWEEN_MOST || nodes % RD_LANES != 0) {
        PyErr_Format(PyExc_ValueError, "nodes must be a multiple of %d up to %d, got %zu", RD_LANES,
                     RD_BETWEEN_MOST, nodes);
        return -1;
    }
    const struct rd_factors factors = {
        nodes, row, row + 2 * nodes, row + 4 * nodes, row + 6 * nodes, row + 8 * nodes, NULL};
    struct sweep_extent extent[RD_BETWEEN_MOST];
    for (size_t i = 0; i < nodes; i++)
        extent[i] = rd_sweep_extent(&factors, i);
    const struct sweep_extent most = rd_sweep_most(extent, nodes);
    parsed->first = PyMem_RawMalloc((2 * chain->distinct + 1) * sizeof *parsed->first);
    if (parsed->first == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    parsed->nodes = (struct rd_between_factors){factors.section, factors.tension, factors.inertia,
                                                factors.dashpot};
    parsed->between = (struct rd_between){
        .most = rd_sweep_sizes(&most),
        .real = chain->drag == NULL && are_real(&factors),
        .nodes = nodes,
        .first = parsed->first,
    };
    const size_t places = rd_between_layout(chain, &parsed->between.most, parsed->first);
    parsed->places = (npy_intp)places;
    if (places != RD_BETWEEN_NONE)
        return 0;
    py_raise(module, RD_SHORT_WAVES);
    return -1;
}

PyObject *py_sweep_between(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    struct py_between own = {0};
    PyObject *chain, *factor, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OO", &chain, &factor))
        return NULL;
    if (py_chain_view(chain, &parsed) < 0 || between_begin(module, &parsed.chain, factor, &own) < 0)
        goto done;
    result = py_new(NPY_DOUBLE, 3, (npy_intp[]){own.places, 2, (npy_intp)own.between.nodes});
    if (result == NULL)
        goto done;
    double *values = PyArray_DATA((PyArrayObject *)result);
    Py_BEGIN_ALLOW_THREADS
    rd_between_fill(&parsed.chain, &own.between, &own.nodes, values);
    Py_END_ALLOW_THREADS
done:
    between_release(&own);
    py_chain_release(&parsed);
    return result;
}

/* (nodes, values, weights) of so many frequencies, or None */
static int between_parse(PyObject *module, PyObject *object, const struct rd_chain *chain,
                         npy_intp count, struct py_between *parsed)
{
    PyObject *factor, *values, *weight;
    if (object == Py_None)
        return 0;
    if (!PyArg_ParseTuple(object, "OOO", &factor, &values, &weight) ||
        between_begin(module, chain, factor, parsed) < 0)
        return -1;
    const npy_intp nodes = (npy_intp)parsed->between.nodes;
    const npy_intp shape[] = {parsed->places, 2, nodes};
    parsed->between.values = py_keep(&parsed->kept, values, NPY_DOUBLE, 3, shape, "values");
    if (parsed->between.values == NULL)
        return -1;
    parsed->between.weight =
        py_keep(&parsed->kept, weight, NPY_DOUBLE, 2, (npy_intp[]){count, nodes}, "weights");
    return parsed->between.weight == NULL ? -1 : 0;
}

/* the index of the frequency that has no answer, or the count of all; -1 and an exception */
static npy_intp solve(PyObject *module, const struct py_response *response,
                      const struct py_between *known)
{
    const struct rd_chain *chain = &response->parsed.chain;
    const struct rd_ports *drives = &response->drives.ports;
    const struct rd_ports *responses = &response->responses.ports;
    struct rd_factors factors = factors_of(response->factor);
    factors.between = known->first ? &known->between : NULL;
    double *value = PyArray_DATA((PyArrayObject *)response->value);
    double *error = PyArray_DATA((PyArrayObject *)response->error);
    struct rd_workspace workspace = {0};
    size_t failed = 0;
    npy_intp solved = -1;
    enum rd_status status =
        rd_frf_sweep(chain, &factors, drives, responses, &workspace, NULL, NULL, &failed);
    if (py_workspace_allocate(&workspace) < 0)
        goto done;
    Py_BEGIN_ALLOW_THREADS
    status = rd_frf_sweep(chain, &factors, drives, responses, &workspace, value, error, &failed);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        solved = response->count;
    else if (status == RD_SINGULAR)
        solved = (npy_intp)failed;
    else
        py_raise(module, status);
done:
    PyMem_RawFree(workspace.base);
    return solved;
}

PyObject *py_sweep(PyObject *module, PyObject *arguments)
{
    struct py_response response = {0};
    struct py_between known = {0};
    PyObject *o[4], *between = Py_None, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "OOOO|O", o, o + 1, o + 2, o + 3, &between))
        return NULL;
    PyObject *given = PyTuple_GetSlice(arguments, 0, 4);
    if (given == NULL || py_response_parse(given, PY_FREQUENCY_LAST, &response) < 0 ||
        between_parse(module, between, &response.parsed.chain, response.count, &known) < 0)
        goto done;
    const npy_intp solved = solve(module, &response, &known);
    if (solved >= 0)
        result = Py_BuildValue("OOn", response.value, response.error, (Py_ssize_t)solved);
done:
    Py_XDECREF(given);
    between_release(&known);
    py_response_release(&response);
    return result;
}
