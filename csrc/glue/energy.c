/* Energies of shapes, and how the forms of modes change with the numbers of each stretch. */
#include "glue/glue.h"

#include "chain/attached.h"
#include "energy/energy.h"
#include "energy/sensitivity.h"

/* Modes as they are handed in. */
struct modes {
    struct py_chain parsed;
    PyArrayObject *shapes, *motions, *lambdas;
    npy_intp count, carried, width;
};

static void release(struct modes *modes)
{
    Py_XDECREF(modes->lambdas);
    Py_XDECREF(modes->motions);
    Py_XDECREF(modes->shapes);
    py_chain_release(&modes->parsed);
}

/* chain, shape, eigenvalue, and where structures are asked for motion before that; the chain is
   viewed only. -1 with an error set, to be released all the same */
static int parse(PyObject *arguments, bool carrying, struct modes *modes)
{
    PyObject *object[4];
    *modes = (struct modes){0};
    if (!PyArg_ParseTuple(arguments, carrying ? "OOOO" : "OOO", object, object + 1, object + 2,
                          object + 3) ||
        py_chain_view(object[0], &modes->parsed) < 0)
        return -1;
    const struct rd_chain *chain = &modes->parsed.chain;
    modes->carried = (npy_intp)chain->attached;
    modes->width = (npy_intp)chain->width;
    const npy_intp of_shape[] = {-1, (npy_intp)chain->nodes, modes->width};
    modes->shapes = py_array(object[1], NPY_DOUBLE, 3, of_shape, "shape");
    if (modes->shapes == NULL)
        return -1;
    modes->count = PyArray_DIM(modes->shapes, 0);
    const npy_intp of_motion[] = {modes->count, modes->carried};
    if (carrying)
        modes->motions = py_array(object[2], NPY_DOUBLE, 2, of_motion, "motion");
    if (carrying && modes->motions == NULL)
        return -1;
    modes->lambdas = py_array(object[carrying ? 3 : 2], NPY_DOUBLE, 1, &modes->count, "eigenvalue");
    return modes->lambdas == NULL ? -1 : 0;
}

static double lambda_of(const struct modes *modes, npy_intp i)
{
    return ((const double *)PyArray_DATA(modes->lambdas))[i];
}

static const double *shape_of(const struct modes *modes, npy_intp i)
{
    return (const double *)PyArray_GETPTR1(modes->shapes, i);
}

static const double *motion_of(const struct modes *modes, npy_intp i)
{
    return (const double *)PyArray_DATA(modes->motions) + i * modes->carried;
}

/* row i of a new array of doubles, of so many each */
static double *row_of(PyObject *array, npy_intp i, npy_intp size)
{
    return (double *)PyArray_DATA((PyArrayObject *)array) + i * size;
}

PyObject *py_energy(PyObject *module, PyObject *arguments)
{
    struct modes modes;
    PyObject *strain = NULL, *kinetic = NULL, *dragged = NULL, *result = NULL;
    if (parse(arguments, false, &modes) < 0 || py_chain_expand(&modes.parsed) < 0)
        goto done;
    strain = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, RD_STRAINS});
    kinetic = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, modes.width});
    dragged = py_new(NPY_DOUBLE, 1, &modes.count);
    if (strain == NULL || kinetic == NULL || dragged == NULL)
        goto done;
    enum rd_status status = RD_OK;
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp i = 0; i < modes.count && status == RD_OK; i++)
        status = rd_energy(&modes.parsed.chain, lambda_of(&modes, i), shape_of(&modes, i),
                           row_of(strain, i, RD_STRAINS), row_of(kinetic, i, modes.width),
                           row_of(dragged, i, 1));
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(3, strain, kinetic, dragged);
    else
        py_raise(module, status);
done:
    Py_XDECREF(dragged);
    Py_XDECREF(kinetic);
    Py_XDECREF(strain);
    release(&modes);
    return result;
}

struct slopes {
    PyObject *element, *jump, *node;
};

/* mode after mode: slopes (stretches - 1, RD_PROPERTIES), jumps (stretches - 1, width), dyads
   (stretches, width, width) */
static enum rd_status fill(const struct modes *modes, npy_intp mode, const struct slopes *slopes)
{
    const struct rd_chain *chain = &modes->parsed.chain;
    const double *shape = shape_of(modes, mode);
    const size_t i = (size_t)mode, w = chain->width, between = chain->stretches - 1;
    double *slope = PyArray_DATA((PyArrayObject *)slopes->element);
    double *jump = PyArray_DATA((PyArrayObject *)slopes->jump);
    double *dyad = PyArray_DATA((PyArrayObject *)slopes->node);
    enum rd_status status = RD_OK;
    struct rd_sensitivity sensitivity;
    rd_sensitivity_begin(chain, lambda_of(modes, mode), &sensitivity);
    for (size_t k = 0; k < chain->stretches; k++)
        rd_sensitivity_nodes(chain, k, shape, dyad + (i * chain->stretches + k) * w * w);
    for (size_t k = 0; k < between && status == RD_OK; k++)
        status = rd_sensitivity_stretch(&sensitivity, k, shape,
                                        slope + (i * between + k) * RD_PROPERTIES,
                                        jump + (i * between + k) * w);
    return status;
}

PyObject *py_sensitivity(PyObject *module, PyObject *arguments)
{
    struct modes modes;
    struct slopes slopes = {0};
    PyObject *result = NULL;
    if (parse(arguments, false, &modes) < 0 || py_chain_expand(&modes.parsed) < 0)
        goto done;
    const npy_intp count = modes.count, w = modes.width;
    const npy_intp stretches = (npy_intp)modes.parsed.chain.stretches;
    slopes.element = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, RD_PROPERTIES});
    slopes.jump = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, stretches - 1, w});
    slopes.node = py_new(NPY_DOUBLE, 4, (npy_intp[]){count, stretches, w, w});
    if (slopes.element == NULL || slopes.jump == NULL || slopes.node == NULL)
        goto done;
    enum rd_status status = RD_OK;
    Py_BEGIN_ALLOW_THREADS
    for (npy_intp i = 0; i < count && status == RD_OK; i++)
        status = fill(&modes, i, &slopes);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(3, slopes.element, slopes.jump, slopes.node);
    else
        py_raise(module, status);
done:
    Py_XDECREF(slopes.node);
    Py_XDECREF(slopes.jump);
    Py_XDECREF(slopes.element);
    release(&modes);
    return result;
}

PyObject *py_carried(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct modes modes;
    PyObject *energy = NULL;
    if (parse(arguments, true, &modes) == 0)
        energy = py_new(NPY_DOUBLE, 2, (npy_intp[]){modes.count, RD_CARRIED});
    for (npy_intp i = 0; energy != NULL && i < modes.count; i++)
        rd_attached_energy(&modes.parsed.chain, lambda_of(&modes, i), shape_of(&modes, i),
                           motion_of(&modes, i), row_of(energy, i, RD_CARRIED));
    release(&modes);
    return energy;
}

PyObject *py_carried_slopes(PyObject *module, PyObject *arguments)
{
    (void)module;
    struct modes modes;
    PyObject *number = NULL, *row = NULL, *result = NULL;
    if (parse(arguments, true, &modes) < 0)
        goto done;
    const npy_intp of_number = modes.carried * RD_CARRIED_NUMBERS;
    const npy_intp of_row = modes.carried * 2 * modes.width;
    number = py_new(NPY_DOUBLE, 3, (npy_intp[]){modes.count, modes.carried, RD_CARRIED_NUMBERS});
    row = py_new(NPY_DOUBLE, 4, (npy_intp[]){modes.count, modes.carried, 2, modes.width});
    if (number == NULL || row == NULL)
        goto done;
    for (npy_intp i = 0; i < modes.count; i++)
        rd_attached_slopes(&modes.parsed.chain, lambda_of(&modes, i), shape_of(&modes, i),
                           motion_of(&modes, i), row_of(number, i, of_number),
                           row_of(row, i, of_row));
    result = PyTuple_Pack(2, number, row);
done:
    Py_XDECREF(row);
    Py_XDECREF(number);
    release(&modes);
    return result;
}
