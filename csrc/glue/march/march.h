/* What the entry points of a march parse alike. */
#ifndef PY_MARCH_H
#define PY_MARCH_H

#include "glue/glue.h"

#include "march/plan.h"

/* a march, what it views and the references that keep it alive */
struct py_march {
    struct py_chain parsed;
    struct py_ports points, drives, responses;
    struct rd_beside beside;
    struct rd_laws laws;
    struct rd_march march;
    struct rd_workspace workspace;
    struct rd_motion motion;
    struct rd_push push;
    struct py_kept kept;
};

/* laws without their places, from (kind, value) */
int py_law_numbers_parse(PyObject *object, struct py_march *march);

/* chain, beside, law (node, row, kind, value); then the arrays of the march in the plan, a uint8
   array of exactly their size */
int py_march_parse(PyObject *const *object, const char *entry, struct py_march *march);
int py_march_open(PyObject *plan, struct py_march *march);

/* g, h of the plan's theta; (u, v, f, y, w), writable */
int py_march_check(const struct py_march *march, double g, double h);
int py_motion_parse(PyObject *object, struct py_march *march);

/* drives and moved coordinates, their places alone */
int py_push_parse(PyObject *drive, PyObject *moved, struct py_march *march);

void py_march_release(struct py_march *march);

#endif
