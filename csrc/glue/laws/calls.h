/* Laws that Python knows. */
#ifndef PY_CALLS_H
#define PY_CALLS_H

#include "glue/glue.h"
#include "law/law.h"

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

/* laws: (kind, value, calls) of `rd_laws` and what is called; their ports stay the caller's */
int py_laws_parse(PyObject *object, struct py_kept *kept, struct py_calls *calls,
                  struct rd_laws *laws);

/* lets other threads run unless one of some laws is `given` by Python, until they are stopped again */
PyThreadState *py_let_others(size_t laws, const int32_t *kind, int32_t given);
void py_stop_others(PyThreadState *state);

/* an array that the caller goes on with: it must be what it is taken for, no copy is made */
double *py_shared(struct py_kept *kept, PyObject *object, int dimensions, const npy_intp *shape,
                  const char *name);

#endif
