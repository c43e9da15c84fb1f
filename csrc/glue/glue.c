/* What every entry point of the extension shares. */
#include "glue/glue.h"

#include "base/fast.h"
#include "chain/attached.h"

#include <math.h>
#include <stdint.h>

static const char *text_of(enum rd_status status)
{
    switch (status) {
    case RD_NOT_POSITIVE_DEFINITE:
        return "a section flexibility is not positive definite to working precision";
    case RD_INDEFINITE_ELEMENT:
        return "the flexibility of an element is not positive definite to working precision: "
               "bending, twist and stretch are coupled too strongly, or it is longer than its "
               "first resonance";
    case RD_CRITICAL_ELEMENT:
        return "the compression is exactly the critical load of one element: no transfer exists; "
               "use other elements";
    case RD_SINGULAR:
        return "the stiffness is singular to working precision";
    case RD_UNSTABLE_MASSLESS:
        return "the stiffness is not positive definite on the coordinates without mass, or the "
               "mass is indefinite where the stiffness is: there are no lowest modes; give these "
               "coordinates an inertia or use more elements";
    case RD_NO_CONVERGENCE:
        return "the eigensolver did not converge";
    case RD_CLUSTER:
        return "512 modes or more lie within a relative 1e-8 of each other and are not told apart";
    case RD_SHORT_WAVES:
        return "a span has more than 10000000 pieces shorter than its waves, or numbers overflow: "
               "check the units";
    case RD_OVERFLOW:
        return "the numbers overflow: check the units and the times";
    default:
        return "unexpected status of the core";
    }
}

PyObject *py_raise(PyObject *module, enum rd_status status)
{
    const struct py_state *state = PyModule_GetState(module);
    if (status == RD_NO_MEMORY)
        return PyErr_NoMemory();
    PyObject *type = status == RD_NOT_POSITIVE_DEFINITE ? state->scene_error : state->solve_error;
    PyErr_SetString(type, text_of(status));
    return NULL;
}

PyArrayObject *py_array(PyObject *object, int type, int dimensions, const npy_intp *shape,
                        const char *name)
{
    PyArrayObject *array =
        (PyArrayObject *)PyArray_FROMANY(object, type, dimensions, dimensions, NPY_ARRAY_IN_ARRAY);
    if (array == NULL)
        return NULL;
    for (int k = 0; k < dimensions; k++) {
        if (shape[k] < 0 || PyArray_DIM(array, k) == shape[k])
            continue;
        PyErr_Format(PyExc_ValueError, "%s must have %zd entries along axis %d, got %zd", name,
                     (Py_ssize_t)shape[k], k, (Py_ssize_t)PyArray_DIM(array, k));
        Py_DECREF(array);
        return NULL;
    }
    return array;
}

/* every entry of an index array lies in 0 ... bound - 1; the loop never leaves early, so that the
   compiler takes many entries at once */
RD_VECTORS static int check_range(PyArrayObject *array, size_t bound, const char *name)
{
    const uint32_t *entry = PyArray_DATA(array);
    const npy_intp count = PyArray_SIZE(array);
    uint32_t largest = 0; /* a negative entry is a very large one */
    for (npy_intp i = 0; i < count; i++)
        largest = entry[i] > largest ? entry[i] : largest;
    if (count == 0 || largest < bound)
        return 0;
    npy_intp i = 0;
    while (entry[i] < bound)
        i++;
    PyErr_Format(PyExc_ValueError, "%s[%zd] must lie in 0 ... %zd, got %d", name, (Py_ssize_t)i,
                 (Py_ssize_t)bound - 1, (int)(int32_t)entry[i]);
    return -1;
}

enum field {
    COORDINATE,
    LENGTH,
    TENSION,
    FLEXIBILITY,
    FIRST,
    ELEMENT,
    MASS,
    STIFFNESS,
    HELD,
    TERM,
    HINGE, /* from here on NULL where None is given */
    INERTIA,
    DAMPING,
    DRAG,
    SAG,
    RISE,
    ATTACHED_KIND,
    ATTACHED_TERM,
    ATTACHED_ROW,
    ATTACHED_VALUE
};

/* how many entries an axis has: as many as the first array that has it, or one less */
enum axis { FREE, WIDTH, DISTINCT, STRETCHES, JOINTS, TERMS, ATTACHED, TWO, THREE, FOUR, AXES };

static const struct {
    const char *name;
    int type, dimensions;
    enum axis axis[3];
} field_of[PY_CHAIN_ARRAYS] = {
    [COORDINATE] = {"coordinate", NPY_INT32, 1, {WIDTH}},
    [LENGTH] = {"length", NPY_DOUBLE, 1, {DISTINCT}},
    [TENSION] = {"tension", NPY_DOUBLE, 1, {DISTINCT}},
    [FLEXIBILITY] = {"flexibility", NPY_DOUBLE, 3, {DISTINCT, THREE, THREE}},
    [FIRST] = {"first", NPY_INT32, 1, {STRETCHES}},
    [ELEMENT] = {"element", NPY_INT32, 1, {JOINTS}},
    [MASS] = {"mass", NPY_DOUBLE, 3, {TERMS, WIDTH, WIDTH}},
    [STIFFNESS] = {"stiffness", NPY_DOUBLE, 3, {TERMS, WIDTH, WIDTH}},
    [HELD] = {"held", NPY_UINT8, 2, {TERMS, WIDTH}},
    [TERM] = {"term", NPY_INT32, 1, {STRETCHES}},
    [HINGE] = {"hinge", NPY_DOUBLE, 2, {TERMS, WIDTH}},
    [INERTIA] = {"inertia", NPY_DOUBLE, 2, {DISTINCT, WIDTH}},
    [DAMPING] = {"damping", NPY_DOUBLE, 3, {TERMS, WIDTH, WIDTH}},
    [DRAG] = {"drag", NPY_DOUBLE, 2, {DISTINCT, WIDTH}},
    [SAG] = {"sag", NPY_DOUBLE, 1, {DISTINCT}},
    [RISE] = {"rise", NPY_DOUBLE, 1, {DISTINCT}},
    [ATTACHED_KIND] = {"attached_kind", NPY_INT32, 1, {ATTACHED}},
    [ATTACHED_TERM] = {"attached_term", NPY_INT32, 1, {ATTACHED}},
    [ATTACHED_ROW] = {"attached_row", NPY_DOUBLE, 3, {ATTACHED, TWO, WIDTH}},
    [ATTACHED_VALUE] = {"attached_value", NPY_DOUBLE, 2, {ATTACHED, FOUR}},
};

/* tension that grows is that of continuous strings, not under compression, and beams */
static int check_rise(const struct rd_chain *chain)
{
    const size_t w = chain->width, z = rd_coordinate_find(w, chain->coordinate, RD_Z);
    const bool bends = w == 2 && z == 0 && chain->coordinate[1] == RD_BETA;
    for (size_t k = 0; chain->rise && k < chain->distinct; k++) {
        const double least = chain->tension[k] - fabs(chain->rise[k]) / 2;
        if (chain->rise[k] == 0)
            continue;
        if (!(chain->inertia && (bends || (w == 1 && z == 0)))) {
            PyErr_SetString(PyExc_ValueError,
                            "rise needs continuous elements of the coordinates z, or z and beta");
            return -1;
        }
        if (!isfinite(chain->rise[k]) || (!bends && !(least >= 0))) {
            PyErr_Format(PyExc_ValueError, "rise[%zd] must leave a string tension >= 0",
                         (Py_ssize_t)k);
            return -1;
        }
    }
    for (size_t k = 0; chain->rise && k + 1 < chain->stretches; k++)
        if (chain->rise[chain->element[k]] != 0 &&
            (rd_stretch_nodes(chain, k) > 1 ||
             (k > 0 && chain->element[k - 1] == chain->element[k]))) {
            PyErr_SetString(PyExc_ValueError, "an element whose tension grows stands alone");
            return -1;
        }
    return 0;
}

/* what the core asserts of the numbers */
static int check_values(const struct rd_chain *chain)
{
    const size_t w = chain->width;
    const bool string = rd_coordinate_find(w, chain->coordinate, RD_Z) < w &&
                        rd_coordinate_find(w, chain->coordinate, RD_BETA) == w;
    for (size_t k = 0; chain->hinge && k < chain->terms * chain->width; k++)
        if (!(chain->hinge[k] >= 0)) {
            PyErr_Format(PyExc_ValueError, "hinge[%zd, %zd] must be >= 0",
                         (Py_ssize_t)(k / chain->width), (Py_ssize_t)(k % chain->width));
            return -1;
        }
    for (size_t k = 0; chain->inertia && k < chain->distinct * chain->width; k++)
        if (!(chain->inertia[k] >= 0)) {
            PyErr_Format(PyExc_ValueError, "inertia[%zd, %zd] must be >= 0",
                         (Py_ssize_t)(k / chain->width), (Py_ssize_t)(k % chain->width));
            return -1;
        }
    for (size_t k = 0; k < chain->distinct; k++) {
        if (!(chain->length[k] > 0)) {
            PyErr_Format(PyExc_ValueError, "length[%zd] must be > 0", (Py_ssize_t)k);
            return -1;
        }
        if ((string || chain->sag) && !(chain->tension[k] > 0)) {
            PyErr_Format(PyExc_ValueError, "tension[%zd] must be > 0 %s", (Py_ssize_t)k,
                         string ? "without bending" : "with sag");
            return -1;
        }
    }
    return check_rise(chain);
}

/* stretches follow each other, the last node alone */
static int check_stretches(const struct rd_chain *chain)
{
    const int32_t *first = chain->first;
    bool increase = first[0] == 0;
    for (size_t k = 1; k < chain->stretches; k++)
        increase = increase && first[k] > first[k - 1];
    if (!increase) {
        PyErr_SetString(PyExc_ValueError, "first must increase from 0");
        return -1;
    }
    for (size_t k = 0; chain->inertia && k < chain->stretches; k++)
        if (rd_stretch_nodes(chain, k) > 1 && !rd_term_is_bare(chain, chain->term[k])) {
            PyErr_SetString(PyExc_ValueError, "nothing may stand inside continuous stretches");
            return -1;
        }
    return 0;
}

static int check_indices(const struct py_chain *parsed)
{
    const struct rd_chain *chain = &parsed->chain;
    if ((int)chain->kind < RD_DIFFERENCE || (int)chain->kind > RD_CONTINUOUS) {
        PyErr_Format(PyExc_ValueError, "kind must be 0, 1, 2 or 3, got %d", (int)chain->kind);
        return -1;
    }
    if (chain->drag != NULL && chain->inertia == NULL) {
        PyErr_SetString(PyExc_ValueError, "only continuous elements have drag");
        return -1;
    }
    if ((chain->kind == RD_CONTINUOUS) != (chain->inertia != NULL)) {
        PyErr_SetString(PyExc_ValueError, "continuous elements and no others have inertia");
        return -1;
    }
    for (size_t k = 1; k < chain->width; k++)
        if (chain->coordinate[k] <= chain->coordinate[k - 1]) {
            PyErr_SetString(PyExc_ValueError, "coordinate must increase");
            return -1;
        }
    if (chain->width < 1 || chain->width > RD_WIDTH_MAX || chain->nodes < 2 ||
        chain->nodes > INT32_MAX / (RD_WIDTH_MAX * 32)) {
        PyErr_SetString(PyExc_ValueError,
                        "a chain has 1 to 4 coordinates and at least one element");
        return -1;
    }
    if (check_range(parsed->array[COORDINATE], RD_WIDTH_MAX, "coordinate") < 0)
        return -1;
    if (chain->sag != NULL &&
        (chain->width < 2 || chain->coordinate[0] != RD_X || chain->coordinate[1] != RD_Z)) {
        PyErr_SetString(PyExc_ValueError, "sag needs the coordinates x and z");
        return -1;
    }
    if (check_range(parsed->array[ELEMENT], chain->distinct, "element") < 0)
        return -1;
    if (check_range(parsed->array[TERM], chain->terms, "term") < 0)
        return -1;
    return check_stretches(chain) < 0 ? -1 : check_values(chain);
}

/* the arrays of a chain, each as long as the others say; 0, or -1 and an exception */
static int take_arrays(PyObject *const *item, struct py_chain *parsed, npy_intp *entries)
{
    for (int k = 0; k < PY_CHAIN_ARRAYS; k++) {
        npy_intp shape[3];
        if (k >= HINGE && item[k] == Py_None)
            continue;
        for (int a = 0; a < field_of[k].dimensions; a++)
            shape[a] = entries[field_of[k].axis[a]];
        parsed->array[k] =
            py_array(item[k], field_of[k].type, field_of[k].dimensions, shape, field_of[k].name);
        if (parsed->array[k] == NULL)
            return -1;
        const npy_intp first = PyArray_DIM(parsed->array[k], 0);
        entries[field_of[k].axis[0]] = first;
        if (k == FIRST)
            entries[JOINTS] = first > 0 ? first - 1 : 0;
    }
    return 0;
}

/* all arrays of attached structures or none; 0, or -1 and an exception */
static int check_attached(const struct py_chain *parsed)
{
    const struct rd_chain *chain = &parsed->chain;
    for (int k = ATTACHED_KIND; k <= ATTACHED_VALUE; k++)
        if ((parsed->array[k] == NULL) != (parsed->array[ATTACHED_KIND] == NULL)) {
            PyErr_Format(PyExc_ValueError, "%s must be given with attached_kind", field_of[k].name);
            return -1;
        }
    if (chain->attached == 0)
        return 0;
    if (check_range(parsed->array[ATTACHED_KIND], RD_ATTACHED_KINDS, "attached_kind") < 0 ||
        check_range(parsed->array[ATTACHED_TERM], chain->terms, "attached_term") < 0)
        return -1;
    for (size_t k = 1; k < chain->attached; k++)
        if (chain->attached_term[k] < chain->attached_term[k - 1]) {
            PyErr_SetString(PyExc_ValueError, "attached_term must not decrease");
            return -1;
        }
    for (size_t k = 0; k < chain->stretches; k++) {
        const size_t of = rd_attached_first(chain, (size_t)chain->term[k]);
        if (rd_attached_is_of(chain, of, chain->term[k]) && rd_stretch_nodes(chain, k) > 1) {
            PyErr_Format(PyExc_ValueError, "attached_term[%zd] must be the term of a single node",
                         (Py_ssize_t)of);
            return -1;
        }
    }
    return 0;
}

static const void *data_of(const struct py_chain *parsed, enum field field)
{
    return parsed->array[field] == NULL ? NULL : PyArray_DATA(parsed->array[field]);
}

int py_chain_view(PyObject *object, struct py_chain *parsed)
{
    struct rd_chain *chain = &parsed->chain;
    PyObject *item[PY_CHAIN_ARRAYS];
    int kind;
    if (!PyTuple_Check(object)) {
        PyErr_SetString(PyExc_TypeError, "chain must be a tuple");
        return -1;
    }
    if (!PyArg_ParseTuple(object, "iOOOOOOOOOOOOOOOOOOOO", &kind, item, item + 1, item + 2,
                          item + 3, item + 4, item + 5, item + 6, item + 7, item + 8, item + 9,
                          item + 10, item + 11, item + 12, item + 13, item + 14, item + 15,
                          item + 16, item + 17, item + 18, item + 19))
        return -1;
    npy_intp entries[AXES] = {-1, -1, -1, -1, -1, -1, -1, 2, 3, 4};
    if (take_arrays(item, parsed, entries) < 0)
        return -1;
    *chain = (struct rd_chain){
        .stretches = (size_t)entries[STRETCHES],
        .width = (size_t)entries[WIDTH],
        .distinct = (size_t)entries[DISTINCT],
        .terms = (size_t)entries[TERMS],
        .attached = entries[ATTACHED] < 0 ? 0 : (size_t)entries[ATTACHED],
        .kind = (enum rd_kind)kind,
        .coordinate = data_of(parsed, COORDINATE),
        .length = data_of(parsed, LENGTH),
        .tension = data_of(parsed, TENSION),
        .flexibility = data_of(parsed, FLEXIBILITY),
        .first = data_of(parsed, FIRST),
        .element = data_of(parsed, ELEMENT),
        .mass = data_of(parsed, MASS),
        .stiffness = data_of(parsed, STIFFNESS),
        .held = data_of(parsed, HELD),
        .term = data_of(parsed, TERM),
        .hinge = data_of(parsed, HINGE),
        .inertia = data_of(parsed, INERTIA),
        .damping = data_of(parsed, DAMPING),
        .drag = data_of(parsed, DRAG),
        .sag = data_of(parsed, SAG),
        .rise = data_of(parsed, RISE),
        .attached_kind = data_of(parsed, ATTACHED_KIND),
        .attached_term = data_of(parsed, ATTACHED_TERM),
        .attached_row = data_of(parsed, ATTACHED_ROW),
        .attached_value = data_of(parsed, ATTACHED_VALUE),
    };
    chain->nodes =
        chain->stretches > 0 ? (size_t)(uint32_t)chain->first[chain->stretches - 1] + 1 : 0;
    return check_indices(parsed) < 0 ? -1 : check_attached(parsed);
}

int py_chain_expand(struct py_chain *parsed)
{
    struct rd_chain *chain = &parsed->chain;
    parsed->each = PyMem_RawMalloc(2 * chain->nodes * sizeof *parsed->each);
    if (parsed->each == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    int32_t *element = parsed->each, *term = element + chain->nodes;
    for (size_t k = 0; k + 1 < chain->stretches; k++)
        for (size_t i = (size_t)chain->first[k]; i < (size_t)chain->first[k + 1]; i++) {
            element[i] = chain->element[k];
            term[i] = chain->term[k];
        }
    term[chain->nodes - 1] = chain->term[chain->stretches - 1];
    chain->element_of = element;
    chain->term_of = term;
    return 0;
}

int py_chain_parse(PyObject *object, struct py_chain *parsed)
{
    return py_chain_view(object, parsed) < 0 ? -1 : py_chain_expand(parsed);
}

int py_chain_is_lumped(const struct py_chain *parsed, const char *entry)
{
    if (parsed->chain.kind != RD_CONTINUOUS)
        return 0;
    PyErr_Format(PyExc_ValueError,
                 "%s needs inertia lumped at the nodes: continuous elements have their own", entry);
    return -1;
}

void py_chain_release(struct py_chain *parsed)
{
    PyMem_RawFree(parsed->each);
    for (int k = 0; k < PY_CHAIN_ARRAYS; k++)
        Py_XDECREF(parsed->array[k]);
}

int py_ports_parse(PyObject *object, const struct rd_chain *chain, const char *name,
                   struct py_ports *parsed)
{
    PyObject *node, *row, *force = Py_None;
    if (!PyTuple_Check(object)) {
        PyErr_Format(PyExc_TypeError, "%s must be a tuple", name);
        return -1;
    }
    if (!PyArg_ParseTuple(object, "OO|O", &node, &row, &force))
        return -1;
    const npy_intp any[] = {-1};
    parsed->node = py_array(node, NPY_INT32, 1, any, name);
    if (parsed->node == NULL)
        return -1;
    const npy_intp shape[] = {PyArray_DIM(parsed->node, 0), 2, (npy_intp)chain->width};
    parsed->row = py_array(row, NPY_DOUBLE, 3, shape, name);
    if (parsed->row == NULL || check_range(parsed->node, chain->nodes - 1, name) < 0)
        return -1;
    const npy_intp rows[] = {shape[0], shape[2]};
    parsed->force = force == Py_None ? NULL : py_array(force, NPY_DOUBLE, 2, rows, name);
    if (force != Py_None && parsed->force == NULL)
        return -1;
    parsed->ports = (struct rd_ports){
        .count = (size_t)shape[0],
        .node = PyArray_DATA(parsed->node),
        .row = PyArray_DATA(parsed->row),
        .force = parsed->force == NULL ? NULL : PyArray_DATA(parsed->force),
    };
    return 0;
}

void py_ports_release(struct py_ports *parsed)
{
    Py_XDECREF(parsed->node);
    Py_XDECREF(parsed->row);
    Py_XDECREF(parsed->force);
}

int py_workspace_allocate(struct rd_workspace *workspace)
{
    workspace->size = workspace->used;
    workspace->used = 0;
    workspace->base = workspace->size == SIZE_MAX ? NULL : PyMem_RawMalloc(workspace->size);
    if (workspace->base != NULL)
        return 0;
    PyErr_NoMemory();
    return -1;
}

void *py_keep(struct py_kept *kept, PyObject *object, int type, int dimensions,
              const npy_intp *shape, const char *name)
{
    PyArrayObject *array = py_array(object, type, dimensions, shape, name);
    if (array == NULL)
        return NULL;
    kept->array[kept->count++] = array;
    return PyArray_DATA(array);
}

npy_intp py_kept_length(const struct py_kept *kept, int axis)
{
    return PyArray_DIM(kept->array[kept->count - 1], axis);
}

void py_kept_release(struct py_kept *kept)
{
    while (kept->count > 0)
        Py_DECREF(kept->array[--kept->count]);
}

PyObject *py_new(int type, int dimensions, const npy_intp *shape)
{
    return PyArray_SimpleNew(dimensions, shape, type);
}
