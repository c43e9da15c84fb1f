/* What the entry points of a march parse alike. */
#include "glue/march/march.h"

#include <math.h>
#include <string.h>

void py_march_release(struct py_march *march)
{
    py_kept_release(&march->kept);
    py_ports_release(&march->points);
    py_ports_release(&march->drives);
    py_ports_release(&march->responses);
    py_chain_release(&march->parsed);
}

static int parse_beside(PyObject *object, struct py_march *march)
{
    PyObject *rate, *string, *drag;
    struct rd_beside *beside = &march->beside;
    const npy_intp distinct[] = {(npy_intp)march->parsed.chain.distinct};
    if (!PyTuple_Check(object)) {
        PyErr_SetString(PyExc_TypeError, "beside must be a tuple");
        return -1;
    }
    if (!PyArg_ParseTuple(object, "OdOOdd", &rate, &beside->spring_rate, &string, &drag,
                          &beside->stretching, &beside->mass_rate))
        return -1;
    beside->rate = py_keep(&march->kept, rate, NPY_DOUBLE, 1, distinct, "rate");
    beside->string =
        beside->rate ? py_keep(&march->kept, string, NPY_DOUBLE, 1, distinct, "string") : NULL;
    beside->drag =
        beside->string ? py_keep(&march->kept, drag, NPY_DOUBLE, 1, distinct, "string_drag") : NULL;
    return beside->drag ? 0 : -1;
}

/* kinds and numbers of the laws, as many as there are points */
static int parse_kinds(PyObject *kind, PyObject *value, struct py_march *march)
{
    const npy_intp shape[] = {(npy_intp)march->laws.ports.count, RD_LAW_VALUES};
    march->laws.kind = py_keep(&march->kept, kind, NPY_INT32, 1, shape, "law kind");
    if (march->laws.kind == NULL)
        return -1;
    for (size_t k = 0; k < march->laws.ports.count; k++)
        if (march->laws.kind[k] < 0 || march->laws.kind[k] >= RD_LAW_KINDS) {
            PyErr_Format(PyExc_ValueError, "law kind[%zu] must lie in 0 ... %d, got %d", k,
                         RD_LAW_KINDS - 1, (int)march->laws.kind[k]);
            return -1;
        }
    march->laws.value = py_keep(&march->kept, value, NPY_DOUBLE, 2, shape, "law value");
    return march->laws.value ? 0 : -1;
}

int py_law_numbers_parse(PyObject *object, struct py_march *march)
{
    PyObject *kind, *value;
    const npy_intp any[] = {-1};
    if (!PyTuple_Check(object)) {
        PyErr_SetString(PyExc_TypeError, "law must be a tuple");
        return -1;
    }
    if (!PyArg_ParseTuple(object, "OO", &kind, &value))
        return -1;
    PyArrayObject *counted = py_array(kind, NPY_INT32, 1, any, "law kind");
    if (counted == NULL)
        return -1;
    march->laws.ports.count = (size_t)PyArray_DIM(counted, 0);
    Py_DECREF(counted);
    return parse_kinds(kind, value, march);
}

static int parse_laws(PyObject *object, const struct rd_chain *chain, struct py_march *march)
{
    PyObject *node, *row, *kind, *value;
    if (!PyTuple_Check(object)) {
        PyErr_SetString(PyExc_TypeError, "law must be a tuple");
        return -1;
    }
    if (!PyArg_ParseTuple(object, "OOOO", &node, &row, &kind, &value))
        return -1;
    PyObject *ports = PyTuple_GetSlice(object, 0, 2);
    const int parsed = ports ? py_ports_parse(ports, chain, "law", &march->points) : -1;
    Py_XDECREF(ports);
    if (parsed < 0)
        return -1;
    march->laws.ports = march->points.ports;
    return parse_kinds(kind, value, march);
}

int py_march_parse(PyObject *const *object, const char *entry, struct py_march *march)
{
    if (py_chain_parse(object[0], &march->parsed) < 0 ||
        py_chain_is_lumped(&march->parsed, entry) < 0 || parse_beside(object[1], march) < 0)
        return -1;
    return parse_laws(object[2], &march->parsed.chain, march);
}

/* an array of the caller that is written to; NULL and an exception */
static void *writable(struct py_march *march, PyObject *object, int type, int dimensions,
                      const npy_intp *shape, const char *name)
{
    PyArrayObject *array = (PyArrayObject *)object;
    bool fits = PyArray_Check(object) && PyArray_TYPE(array) == type &&
                PyArray_NDIM(array) == dimensions && PyArray_ISCARRAY(array);
    for (int k = 0; fits && k < dimensions; k++)
        fits = PyArray_DIM(array, k) == shape[k];
    if (!fits) {
        PyErr_Format(PyExc_ValueError,
                     "%s must be a contiguous writable array of the march's type and shape", name);
        return NULL;
    }
    return py_keep(&march->kept, object, type, dimensions, shape, name);
}

int py_march_open(PyObject *plan, struct py_march *march)
{
    struct rd_workspace *workspace = &march->workspace;
    *workspace = (struct rd_workspace){0};
    rd_march_prepare(&march->parsed.chain, &march->beside, &march->laws, &march->march, workspace);
    const npy_intp bytes[] = {(npy_intp)workspace->used};
    char *base = writable(march, plan, NPY_UINT8, 1, bytes, "plan");
    if (base == NULL)
        return -1;
    *workspace = (struct rd_workspace){.base = base, .size = (size_t)bytes[0]};
    return 0;
}

int py_march_check(const struct py_march *march, double g, double h)
{
    const double theta = march->march.number->theta;
    if (g > 0 && g < 0.5 && fabs(g * h - theta) <= 1e-12 * theta)
        return 0;
    PyErr_SetString(PyExc_ValueError,
                    "the plan must have been factored for theta = g h, 0 < g < 1/2");
    return -1;
}

int py_motion_parse(PyObject *object, struct py_march *march)
{
    static const char *const name[] = {"u", "v", "f", "y", "w"};
    const struct rd_chain *chain = &march->parsed.chain;
    const npy_intp nodes[] = {(npy_intp)chain->nodes, (npy_intp)chain->width};
    const npy_intp elements[] = {nodes[0] - 1, nodes[1]};
    const npy_intp attached[] = {(npy_intp)chain->attached};
    const npy_intp *const shape[] = {nodes, nodes, elements, attached, attached};
    double **const place[] = {&march->motion.u, &march->motion.v, &march->motion.f,
                              &march->motion.y, &march->motion.w};
    if (!PyTuple_Check(object) || PyTuple_GET_SIZE(object) != 5) {
        PyErr_SetString(PyExc_TypeError, "state must be a tuple of five arrays");
        return -1;
    }
    for (int k = 0; k < 5; k++) {
        *place[k] = writable(march, PyTuple_GET_ITEM(object, k), NPY_DOUBLE, k < 3 ? 2 : 1,
                             shape[k], name[k]);
        if (*place[k] == NULL)
            return -1;
    }
    return 0;
}

static int check_moved(const struct py_march *march)
{
    const struct rd_chain *chain = &march->parsed.chain;
    for (size_t k = 0; k < march->push.moved; k++) {
        const size_t node = (size_t)march->push.place[2 * k];
        const size_t i = (size_t)march->push.place[2 * k + 1];
        if (node < chain->nodes && i < chain->width &&
            chain->held[(size_t)chain->term_of[node] * chain->width + i])
            continue;
        PyErr_Format(PyExc_ValueError, "moved[%zu] must be a held coordinate", k);
        return -1;
    }
    return 0;
}

int py_push_parse(PyObject *drive, PyObject *moved, struct py_march *march)
{
    const npy_intp pairs[] = {-1, 2};
    if (py_ports_parse(drive, &march->parsed.chain, "drive", &march->drives) < 0)
        return -1;
    march->push.place = py_keep(&march->kept, moved, NPY_INT32, 2, pairs, "moved");
    if (march->push.place == NULL)
        return -1;
    march->push.drives = &march->drives.ports;
    march->push.moved = (size_t)py_kept_length(&march->kept, 0);
    return check_moved(march);
}
