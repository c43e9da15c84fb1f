/* Laws that Python knows. */
#ifndef PY_CALLS_H
#define PY_CALLS_H

#include "glue/glue.h"

#include <stdbool.h>

struct py_calls {
    PyObject *law;         /* a tuple of them, None for others                               */
    const uint8_t *arrays; /* (laws,) whether one takes arrays; NULL: none does              */
    double failed[4];      /* law, time, u and v where one failed                            */
    PyObject *error;       /* what it raised; NULL where it returned what is no number, [N] */
};

/* a `rd_law_call` whose context are the calls; with the GIL */
bool py_say(void *context, size_t law, size_t count, const double *t, const double *u,
            const double *v, double *force);

/* None, or where a law failed and what it raised, None of no number */
PyObject *py_failure(const struct py_calls *calls, enum rd_status status);

#endif
