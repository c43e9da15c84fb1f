/* Assembled matrices for reading: elastic and tension parts, block tridiagonal. */
#include "glue/glue.h"

#include "assembled/assemble.h"

enum { ARRAYS = 7 };

PyObject *py_assemble(PyObject *module, PyObject *arguments)
{
    struct py_chain parsed = {0};
    PyObject *object, *array[ARRAYS] = {NULL}, *result = NULL;
    if (!PyArg_ParseTuple(arguments, "O", &object))
        return NULL;
    if (py_chain_parse(object, &parsed) < 0 || py_chain_is_lumped(&parsed, "assemble") < 0)
        goto done;
    const npy_intp nodes = (npy_intp)parsed.chain.nodes;
    const npy_intp w = (npy_intp)parsed.chain.width;
    double *data[ARRAYS];
    for (int k = 0; k < ARRAYS; k++) {
        const npy_intp count = k == 1 || k == 3 ? nodes - 1 : nodes;
        array[k] = py_new(NPY_DOUBLE, 3, (npy_intp[]){count, w, w});
        if (array[k] == NULL)
            goto done;
        data[k] = PyArray_DATA((PyArrayObject *)array[k]);
    }
    struct rd_assembly assembly = {
        .elastic = {data[0], data[1]},
        .string = {data[2], data[3]},
        .springs = data[4],
        .mass = data[5],
        .dashpots = data[6],
    };
    enum rd_status status;
    Py_BEGIN_ALLOW_THREADS
    status = rd_assemble(&parsed.chain, &assembly);
    Py_END_ALLOW_THREADS
    if (status == RD_OK)
        result = PyTuple_Pack(ARRAYS, array[0], array[1], array[2], array[3], array[4], array[5],
                              array[6]);
    else
        py_raise(module, status);
done:
    for (int k = 0; k < ARRAYS; k++)
        Py_XDECREF(array[k]);
    py_chain_release(&parsed);
    return result;
}
