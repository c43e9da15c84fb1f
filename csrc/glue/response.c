/* What every entry point for a frequency response takes and gives. */
#include "glue/response.h"

int py_response_parse(PyObject *arguments, enum py_order order, struct py_response *response)
{
    const struct rd_chain *chain = &response->parsed.chain;
    PyObject *object[4];
    if (!PyArg_ParseTuple(arguments, "OOOO", object, object + 1, object + 2, object + 3))
        return -1;
    if (py_chain_view(object[0], &response->parsed) < 0 ||
        py_ports_parse(object[2], chain, "drives", &response->drives) < 0 ||
        py_ports_parse(object[3], chain, "responses", &response->responses) < 0)
        return -1;
    const bool last = order == PY_FREQUENCY_LAST;
    const npy_intp factors[] = {last ? RD_PARTS : -1, last ? -1 : RD_PARTS};
    response->factor = py_array(object[1], NPY_COMPLEX128, 2, factors, "factor");
    if (response->factor == NULL)
        return -1;
    response->count = PyArray_DIM(response->factor, last);
    const npy_intp drives = (npy_intp)response->drives.ports.count;
    const npy_intp responses = (npy_intp)response->responses.ports.count;
    const npy_intp shape[] = {response->count, drives, responses, response->count};
    response->value = py_new(NPY_COMPLEX128, 3, shape + last);
    response->error = py_new(NPY_DOUBLE, 3, shape + last);
    return response->value != NULL && response->error != NULL ? 0 : -1;
}

void py_response_release(struct py_response *response)
{
    Py_XDECREF(response->error);
    Py_XDECREF(response->value);
    Py_XDECREF(response->factor);
    py_ports_release(&response->responses);
    py_ports_release(&response->drives);
    py_chain_release(&response->parsed);
}
