/* Energies of shapes, and how the forms of modes and of pairs of motions change. */
#include "glue/glue.h"

#include "chain/attached.h"
#include "energy/energy.h"

#pragma GCC diagnostic ignored "-Wpsabi"

enum { RESULTS = 4 };

/* Motions as they are handed in, and what their slopes are asked with. */
struct asked {
    struct py_chain parsed;
    PyArrayObject *field, *line; /* shapes or motions; eigenvalues or factors */
    PyArrayObject *motion, *pair, *slip;
    struct rd_fields fields;
    struct rd_pairs pairs;
    npy_intp count, carried, width;
    PyObject *result[RESULTS];
};

static const int32_t OWN[2] = {0, 0};

static void release(struct asked *asked)
{
    for (int k = 0; k < RESULTS; k++)
        Py_XDECREF(asked->result[k]);
    Py_XDECREF(asked->slip);
    Py_XDECREF(asked->pair);
    Py_XDECREF(asked->motion);
    Py_XDECREF(asked->line);
    Py_XDECREF(asked->field);
    py_chain_release(&asked->parsed);
}

/* chain, shape, eigenvalue, and where structures are asked for motion before that; the chain is
   viewed only. -1 with an error set, to be released all the same */
static int parse_modes(PyObject *arguments, bool carrying, struct asked *modes)
{
    PyObject *object[4];
    *modes = (struct asked){0};
    if (!PyArg_ParseTuple(arguments, carrying ? "OOOO" : "OOO", object, object + 1, object + 2,
                          object + 3) ||
        py_chain_view(object[0], &modes->parsed) < 0)
        return -1;
    const struct rd_chain *chain = &modes->parsed.chain;
    modes->carried = (npy_intp)chain->attached;
    modes->width = (npy_intp)chain->width;
    const npy_intp of_shape[] = {-1, (npy_intp)chain->nodes, modes->width};
    modes->field = py_array(object[1], NPY_DOUBLE, 3, of_shape, "shape");
    if (modes->field == NULL)
        return -1;
    modes->count = PyArray_DIM(modes->field, 0);
    const npy_intp of_motion[] = {modes->count, modes->carried};
    if (carrying)
        modes->motion = py_array(object[2], NPY_DOUBLE, 2, of_motion, "motion");
    if (carrying && modes->motion == NULL)
        return -1;
    modes->line = py_array(object[carrying ? 3 : 2], NPY_DOUBLE, 1, &modes->count, "eigenvalue");
    modes->fields = (struct rd_fields){
        .value = PyArray_DATA(modes->field),
        .loads = 1,
        .line = chain->nodes * chain->width,
        .entry = 1,
        .parts = 1,
    };
    modes->fields.motion = carrying ? PyArray_DATA(modes->motion) : NULL;
    modes->pairs = (struct rd_pairs){.count = 1, .of = OWN};
    return modes->line == NULL ? -1 : 0;
}

static double lambda_of(const struct asked *modes, npy_intp i)
{
    return ((const double *)PyArray_DATA(modes->line))[i];
}

/* row i of an array of doubles, of so many each */
static double *row_of(PyObject *array, npy_intp i, npy_intp size)
{
    return (double *)PyArray_DATA((PyArrayObject *)array) + i * size;
}

/* factors 1 and inertia -lambda of the modes from `first` on */
static struct rd_lines lines_of_modes(const struct asked *modes, npy_intp first)
{
    const npy_intp left = modes->count - first, count = left < RD_LANES ? left : RD_LANES;
    struct rd_lines lines = {
        .first = (size_t)first,
        .count = (size_t)count,
        .section = c_real(1),
        .tension = c_real(1),
        .spring = c_real(1),
        .inertia = c_zero(),
        .dashpot = c_zero(),
    };
    for (npy_intp k = 0; k < RD_LANES; k++)
        lines.inertia.re[k] = -lambda_of(modes, first + (k < count ? k : count - 1));
    return lines;
}

/* the factors (RD_PARTS, count) of the lines from `first` on */
static struct rd_lines lines_of_factors(const struct asked *asked, npy_intp first)
{
    const npy_intp left = asked->count - first, count = left < RD_LANES ? left : RD_LANES;
    const double *factor = PyArray_DATA(asked->line);
    cv part[RD_PARTS];
    for (int p = 0; p < RD_PARTS; p++)
        for (npy_intp k = 0; k < RD_LANES; k++) {
            const double *x = factor + 2 * (p * asked->count + first + (k < count ? k : count - 1));
            part[p].re[k] = x[0];
            part[p].im[k] = x[1];
        }
    return (struct rd_lines){
        .first = (size_t)first,
        .count = (size_t)count,
        .section = part[RD_ELASTIC],
        .tension = part[RD_STRING],
        .spring = part[RD_SPRINGS],
        .inertia = part[RD_MASS],
        .dashpot = part[RD_DASHPOTS],
    };
}

/* the workspace of a sensitivity beside `more` complex lanes, NULL and an exception */
static cv *begin(const struct asked *asked, size_t more, struct rd_sensitivity *sensitivity,
                 struct rd_workspace *workspace)
{
    const struct rd_chain *chain = &asked->parsed.chain;
    rd_sensitivity_prepare(chain, &asked->fields, sensitivity, workspace);
    rd_take_aligned(workspace, more, sizeof(cv), sizeof(lanes));
    if (py_workspace_allocate(workspace) < 0)
        return NULL;
    rd_sensitivity_prepare(chain, &asked->fields, sensitivity, workspace);
    return rd_take_aligned(workspace, more, sizeof(cv), sizeof(lanes));
}

static void put_energy(struct asked *modes, const struct rd_lines *lines,
                       const struct rd_energy *energy)
{
    for (size_t k = 0; k < lines->count; k++) {
        const npy_intp i = (npy_intp)(lines->first + k);
        for (int n = 0; n < RD_STRAINS; n++)
            row_of(modes->result[0], i, RD_STRAINS)[n] = energy->strain[n][k];
        for (npy_intp n = 0; n < modes->width; n++)
            row_of(modes->result[1], i, modes->width)[n] = energy->kinetic[n][k];
        *row_of(modes->result[2], i, 1) = energy->dragged[k];
    }
}

static enum rd_status fill_energies(struct asked *modes, struct rd_sensitivity *sensitivity)
{
    enum rd_status status = RD_OK;
    for (npy_intp i = 0; i < modes->count && status == RD_OK; i += RD_LANES) {
        const struct rd_lines lines = lines_of_modes(modes, i);
        struct rd_energy energy;
        rd_sensitivity_begin(sensitivity, &lines);
        status = rd_energy_fill(sensitivity, &energy);
        put_energy(modes, &lines, &energy);
    }
    return status;
}

/* the arrays, new references; NULL and an exception unless the status is fine */
static PyObject *answer(PyObject *module, struct asked *asked, enum rd_status status)
{
    if (status != RD_OK)
        return py_raise(module, status);
    if (asked->result[3] == NULL)
        return PyTuple_Pack(3, asked->result[0], asked->result[1], asked->result[2]);
    return PyTuple_Pack(4, asked->result[0], asked->result[1], asked->result[2], asked->result[3]);
}

PyObject *py_energy(PyObject *module, PyObject *arguments)
{
    struct asked modes;
    struct rd_workspace workspace = {0};
    struct rd_sensitivity sensitivity;
    PyObject *result = NULL;
    if (parse_modes(arguments, false, &modes) < 0)
        goto done;
    modes.result[0] = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, RD_STRAINS});
    modes.result[1] = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, modes.width});
    modes.result[2] = py_new(NPY_DOUBLE, 1, &modes.count);
    if (modes.result[0] == NULL || modes.result[1] == NULL || modes.result[2] == NULL ||
        begin(&modes, 1, &sensitivity, &workspace) == NULL)
        goto done;
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = fill_energies(&modes, &sensitivity);
    Py_END_ALLOW_THREADS
    result = answer(module, &modes, status);
done:
    PyMem_RawFree(workspace.base);
    release(&modes);
    return result;
}

/* Where lane after lane of `rows` by `size` goes: entry n of row r at line i stands
   row[r] + n entry + i line doubles from the start. */
struct store {
    double *value;
    npy_intp line, row, entry;
    size_t parts;
};

/* of (lines, rows, ..) real of modes, of (rows, .., lines) complex of motions */
static struct store store_of(const struct asked *asked, int which, npy_intp size)
{
    double *value = PyArray_DATA((PyArrayObject *)asked->result[which]);
    if (asked->fields.parts == 1)
        return (struct store){.value = value, .line = size, .row = 0, .entry = 1, .parts = 1};
    const npy_intp count = asked->count;
    return (struct store){
        .value = value, .line = 2, .row = 2 * size * count, .entry = 2 * count, .parts = 2};
}

/* entries first .. first + size - 1 of every pair, from (pairs, size) lanes */
static void put(const struct store *store, const struct rd_lines *lines, npy_intp pairs,
                npy_intp first, npy_intp size, npy_intp stride, const cv *x)
{
    for (npy_intp p = 0; p < pairs; p++)
        for (npy_intp n = 0; n < size; n++) {
            double *at = store->value + p * store->row + (first + n) * store->entry;
            const cv *from = x + p * stride + n;
            for (size_t k = 0; k < lines->count; k++) {
                double *to = at + (npy_intp)(lines->first + k) * store->line;
                to[0] = from->re[k];
                if (store->parts == 2)
                    to[1] = from->im[k];
            }
        }
}

/* of a pair: slopes, jumps, dyads, and a place as it is and as it is handed out */
enum { SLOPES = RD_PROPERTIES + RD_WIDTH_MAX + RD_WIDTH_MAX * RD_WIDTH_MAX + 4 };

/* slope and size of the places of all pairs, stretch k's */
static void put_places(const struct store *store, const struct rd_lines *lines, npy_intp pairs,
                       npy_intp k, const struct rd_place *place, cv *room)
{
    for (npy_intp p = 0; p < pairs; p++) {
        room[2 * p] = place[p].slope;
        room[2 * p + 1] = (cv){place[p].size, (lanes){0}};
    }
    put(store, lines, pairs, 2 * k, 2, 2, room);
}

/* slopes (stretches - 1, RD_PROPERTIES), jumps (stretches - 1, width), dyads (stretches, width,
   width), places (stretches, 2) of all pairs at these lines; `room` (pairs, SLOPES) */
static enum rd_status fill(const struct asked *asked, struct rd_sensitivity *sensitivity,
                           const struct rd_lines *lines, cv *room)
{
    const npy_intp stretches = (npy_intp)asked->parsed.chain.stretches, w = asked->width;
    const npy_intp count = (npy_intp)asked->pairs.count;
    const struct store slope = store_of(asked, 0, (stretches - 1) * RD_PROPERTIES);
    const struct store jump = store_of(asked, 1, (stretches - 1) * w);
    const struct store node = store_of(asked, 2, stretches * w * w);
    const struct store where = store_of(asked, 3, stretches * 2);
    cv *slopes = room, *jumps = slopes + count * RD_PROPERTIES, *dyads = jumps + count * w;
    cv *both = dyads + count * w * w;
    struct rd_place *places = (struct rd_place *)(both + 2 * count);
    rd_sensitivity_begin(sensitivity, lines);
    for (npy_intp k = 0; k < stretches; k++) {
        rd_sensitivity_nodes(sensitivity, (size_t)k, &asked->pairs, dyads);
        put(&node, lines, count, k * w * w, w * w, w * w, dyads);
        if (k + 1 == stretches)
            break;
        const enum rd_status status =
            rd_sensitivity_stretch(sensitivity, (size_t)k, &asked->pairs, slopes, jumps, places);
        if (status != RD_OK)
            return status;
        put_places(&where, lines, count, k, places, both);
        put(&slope, lines, count, k * RD_PROPERTIES, RD_PROPERTIES, RD_PROPERTIES, slopes);
        put(&jump, lines, count, k * w, w, w, jumps);
    }
    rd_sensitivity_last(sensitivity, &asked->pairs, slopes, places);
    put_places(&where, lines, count, stretches - 1, places, both);
    return RD_OK;
}

/* all lines, block by block */
static PyObject *fill_all(PyObject *module, struct asked *asked,
                          struct rd_lines (*lines_from)(const struct asked *, npy_intp))
{
    struct rd_workspace workspace = {0};
    struct rd_sensitivity sensitivity;
    cv *room = begin(asked, asked->pairs.count * SLOPES, &sensitivity, &workspace);
    enum rd_status status = RD_OK;
    if (room == NULL)
        return NULL;
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp i = 0; i < asked->count && status == RD_OK; i += RD_LANES) {
        const struct rd_lines lines = lines_from(asked, i);
        status = fill(asked, &sensitivity, &lines, room);
    }
    Py_END_ALLOW_THREADS
    PyMem_RawFree(workspace.base);
    return answer(module, asked, status);
}

PyObject *py_sensitivity(PyObject *module, PyObject *arguments)
{
    struct asked modes;
    PyObject *result = NULL;
    if (parse_modes(arguments, true, &modes) < 0)
        goto done;
    const npy_intp count = modes.count, w = modes.width;
    const npy_intp stretches = (npy_intp)modes.parsed.chain.stretches;
    modes.result[0] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, RD_PROPERTIES});
    modes.result[1] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, w});
    modes.result[2] = py_new(NPY_DOUBLE, 4, (npy_intp[]){count, stretches, w, w});
    modes.result[3] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches, 2});
    if (modes.result[0] != NULL && modes.result[1] != NULL && modes.result[2] != NULL &&
        modes.result[3] != NULL)
        result = fill_all(module, &modes, lines_of_modes);
done:
    release(&modes);
    return result;
}

PyObject *py_carried(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct asked modes;
    PyObject *energy = NULL;
    if (parse_modes(arguments, true, &modes) == 0)
        energy = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, RD_CARRIED});
    for (npy_intp i = 0; energy != NULL && i < modes.count; i++)
        rd_attached_energy(&modes.parsed.chain, lambda_of(&modes, i),
                           (const double *)PyArray_GETPTR1(modes.field, i),
                           (const double *)PyArray_DATA(modes.motion) + i * modes.carried,
                           row_of(energy, i, RD_CARRIED));
    release(&modes);
    return energy;
}

/* motion (width) of the node that carries structure k at line i, by a load */
static void foot_motion(const struct asked *asked, npy_intp k, npy_intp i, npy_intp load,
                        double _Complex *u)
{
    const struct rd_fields *fields = &asked->fields;
    const size_t node = rd_attached_node(&asked->parsed.chain, (size_t)k);
    for (npy_intp n = 0; n < asked->width; n++) {
        const size_t entry = node * rd_field_rows(fields, (size_t)asked->width) + (size_t)n;
        const double *at = fields->value + (size_t)load * fields->load + entry * fields->entry +
                           (size_t)i * fields->line;
        u[n] = CMPLX(at[0], fields->parts == 2 ? at[1] : 0);
    }
}

/* the structures of a mode */
static void fill_carried(const struct asked *modes, npy_intp i)
{
    const struct rd_chain *chain = &modes->parsed.chain;
    const npy_intp w = modes->width;
    for (npy_intp k = 0; k < modes->carried; k++) {
        double _Complex u[RD_WIDTH_MAX], number[RD_CARRIED_NUMBERS], row[2 * RD_WIDTH_MAX];
        double *numbers = row_of(modes->result[0], i * modes->carried + k, RD_CARRIED_NUMBERS);
        double *rows = row_of(modes->result[1], i * modes->carried + k, 2 * w);
        const double y = ((const double *)PyArray_DATA(modes->motion))[i * modes->carried + k];
        memset(numbers, 0, RD_CARRIED_NUMBERS * sizeof *numbers);
        memset(rows, 0, (size_t)(2 * w) * sizeof *rows);
        if (rd_attached_node(chain, (size_t)k) == chain->nodes)
            continue;
        foot_motion(modes, k, i, 0, u);
        rd_attached_slopes(chain, (size_t)k, -lambda_of(modes, i), 0, u, u,
                           (const double _Complex[]){y, y}, number, row);
        for (int n = 0; n < RD_CARRIED_NUMBERS; n++)
            numbers[n] = creal(number[n]);
        for (npy_intp n = 0; n < 2 * w; n++)
            rows[n] = creal(row[n]);
    }
}

PyObject *py_carried_slopes(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct asked modes;
    PyObject *result = NULL;
    if (parse_modes(arguments, true, &modes) < 0)
        goto done;
    const npy_intp count = modes.count, carried = modes.carried;
    modes.result[0] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, carried, RD_CARRIED_NUMBERS});
    modes.result[1] = py_new(NPY_DOUBLE, 4, (npy_intp[]){count, carried, 2, modes.width});
    if (modes.result[0] == NULL || modes.result[1] == NULL)
        goto done;
    for (npy_intp i = 0; i < count; i++)
        fill_carried(&modes, i);
    result = PyTuple_Pack(2, modes.result[0], modes.result[1]);
done:
    release(&modes);
    return result;
}

static bool pairs_are_loads(const struct asked *asked)
{
    for (size_t k = 0; k < 2 * asked->pairs.count; k++)
        if (asked->pairs.of[k] < 0 || (size_t)asked->pairs.of[k] >= asked->fields.loads)
            return false;
    return true;
}

static bool slips_are_places(const struct asked *asked)
{
    const struct rd_chain *chain = &asked->parsed.chain;
    for (size_t k = 0; k < asked->fields.loads; k++) {
        const int32_t *slip = asked->fields.slip + 3 * k;
        const int32_t last = (int32_t)chain->nodes - (slip[1] == RD_PUSHED ? 1 : 2);
        if (slip[0] > last || slip[1] < 0 || slip[1] > RD_PUSHED || slip[2] < 0 ||
            slip[2] >= (int32_t)chain->width)
            return false;
    }
    return true;
}

/* chain, factor, field, pair, slip; the chain is viewed only. -1 with an error set, to be released
   all the same */
static int parse_pairs(PyObject *arguments, struct asked *asked)
{
    PyObject *object[5];
    *asked = (struct asked){0};
    if (!PyArg_ParseTuple(arguments, "OOOOO", object, object + 1, object + 2, object + 3,
                          object + 4) ||
        py_chain_view(object[0], &asked->parsed) < 0)
        return -1;
    const struct rd_chain *chain = &asked->parsed.chain;
    asked->carried = (npy_intp)chain->attached;
    asked->width = (npy_intp)chain->width;
    asked->line = py_array(object[1], NPY_COMPLEX128, 2, (npy_intp[]){RD_PARTS, -1}, "factor");
    if (asked->line == NULL)
        return -1;
    asked->count = PyArray_DIM(asked->line, 1);
    const bool forces = chain->kind == RD_CONTINUOUS;
    const npy_intp entries = (npy_intp)(chain->nodes * chain->width) * (forces ? 2 : 1);
    asked->field =
        py_array(object[2], NPY_COMPLEX128, 3, (npy_intp[]){-1, entries, asked->count}, "field");
    asked->pair = py_array(object[3], NPY_INT32, 2, (npy_intp[]){-1, 2}, "pair");
    if (asked->field == NULL || asked->pair == NULL)
        return -1;
    const npy_intp loads = PyArray_DIM(asked->field, 0);
    asked->slip = py_array(object[4], NPY_INT32, 2, (npy_intp[]){loads, 3}, "slip");
    if (asked->slip == NULL)
        return -1;
    asked->fields = (struct rd_fields){
        .value = PyArray_DATA(asked->field),
        .loads = (size_t)loads,
        .line = 2,
        .load = 2 * (size_t)(entries * asked->count),
        .entry = 2 * (size_t)asked->count,
        .parts = 2,
        .forces = forces,
        .slip = PyArray_DATA(asked->slip),
    };
    asked->pairs = (struct rd_pairs){
        .count = (size_t)PyArray_DIM(asked->pair, 0),
        .of = PyArray_DATA(asked->pair),
    };
    if (pairs_are_loads(asked) && slips_are_places(asked))
        return 0;
    PyErr_SetString(PyExc_ValueError, "pair and slip must name loads and elements of the chain");
    return -1;
}

PyObject *py_pair_slopes(PyObject *module, PyObject *arguments)
{
    struct asked asked;
    PyObject *result = NULL;
    if (parse_pairs(arguments, &asked) < 0)
        goto done;
    const npy_intp pairs = (npy_intp)asked.pairs.count, count = asked.count, w = asked.width;
    const npy_intp stretches = (npy_intp)asked.parsed.chain.stretches;
    asked.result[0] =
        py_new(NPY_COMPLEX128, 4, (npy_intp[]){pairs, stretches - 1, RD_PROPERTIES, count});
    asked.result[1] = py_new(NPY_COMPLEX128, 4, (npy_intp[]){pairs, stretches - 1, w, count});
    asked.result[2] = py_new(NPY_COMPLEX128, 5, (npy_intp[]){pairs, stretches, w, w, count});
    asked.result[3] = py_new(NPY_COMPLEX128, 4, (npy_intp[]){pairs, stretches, 2, count});
    if (asked.result[0] != NULL && asked.result[1] != NULL && asked.result[2] != NULL &&
        asked.result[3] != NULL)
        result = fill_all(module, &asked, lines_of_factors);
done:
    release(&asked);
    return result;
}

/* the structures of a pair at a line: numbers (RD_CARRIED_NUMBERS) and rows (2, width), lines last */
static void fill_pair(const struct asked *asked, npy_intp pair, npy_intp k, npy_intp i)
{
    const npy_intp w = asked->width, count = asked->count, at = pair * asked->carried + k;
    const double _Complex *factor = PyArray_DATA(asked->line);
    double _Complex a[RD_WIDTH_MAX], b[RD_WIDTH_MAX];
    double _Complex number[RD_CARRIED_NUMBERS], row[2 * RD_WIDTH_MAX];
    double _Complex *numbers = PyArray_DATA((PyArrayObject *)asked->result[0]);
    double _Complex *rows = PyArray_DATA((PyArrayObject *)asked->result[1]);
    foot_motion(asked, k, i, asked->pairs.of[2 * pair], a);
    foot_motion(asked, k, i, asked->pairs.of[2 * pair + 1], b);
    rd_attached_slopes(&asked->parsed.chain, (size_t)k, factor[RD_MASS * count + i],
                       factor[RD_DASHPOTS * count + i], a, b, NULL, number, row);
    for (int n = 0; n < RD_CARRIED_NUMBERS; n++)
        numbers[(at * RD_CARRIED_NUMBERS + n) * count + i] = number[n];
    for (npy_intp n = 0; n < 2 * w; n++)
        rows[(at * 2 * w + n) * count + i] = row[n];
}

PyObject *py_carried_pair_slopes(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct asked asked;
    PyObject *result = NULL;
    if (parse_pairs(arguments, &asked) < 0)
        goto done;
    const npy_intp pairs = (npy_intp)asked.pairs.count, count = asked.count, w = asked.width;
    const npy_intp carried = asked.carried, nodes = (npy_intp)asked.parsed.chain.nodes;
    asked.result[0] =
        py_new(NPY_COMPLEX128, 4, (npy_intp[]){pairs, carried, RD_CARRIED_NUMBERS, count});
    asked.result[1] = py_new(NPY_COMPLEX128, 5, (npy_intp[]){pairs, carried, 2, w, count});
    if (asked.result[0] == NULL || asked.result[1] == NULL)
        goto done;
    for (int n = 0; n < 2; n++) {
        PyArrayObject *all = (PyArrayObject *)asked.result[n];
        memset(PyArray_DATA(all), 0, (size_t)PyArray_NBYTES(all));
    }
    for (npy_intp k = 0; k < carried; k++)
        for (npy_intp p = 0; p < pairs; p++)
            for (npy_intp i = 0; i < count; i++)
                if ((npy_intp)rd_attached_node(&asked.parsed.chain, (size_t)k) < nodes)
                    fill_pair(&asked, p, k, i);
    result = PyTuple_Pack(2, asked.result[0], asked.result[1]);
done:
    release(&asked);
    return result;
}
