/* What every entry point for a frequency response takes and gives. */
#ifndef PY_RESPONSE_H
#define PY_RESPONSE_H

#include "glue/glue.h"

enum py_order { PY_FREQUENCY_FIRST, PY_FREQUENCY_LAST };

/* The arguments (chain, factor, drives, responses) and room for the answer; the axis of the
   frequencies is the first or the last of factor, value and error. */
struct py_response {
    struct py_chain parsed;
    struct py_ports drives;
    struct py_ports responses;
    npy_intp count;        /* frequencies */
    PyArrayObject *factor; /* (RD_PARTS, count) complex */
    PyObject *value;       /* (drives, responses, count) complex */
    PyObject *error;       /* (drives, responses, count) */
};

/* 0, or -1 and an exception; to be released in both cases. The chain is viewed only. */
int py_response_parse(PyObject *arguments, enum py_order order, struct py_response *response);
void py_response_release(struct py_response *response);

#endif
