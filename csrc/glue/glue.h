/* What every entry point of the extension shares. */
#ifndef PY_GLUE_H
#define PY_GLUE_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#define PY_ARRAY_UNIQUE_SYMBOL ropedyn_core_array_api
#ifndef PY_GLUE_IMPORTS_ARRAY
#define NO_IMPORT_ARRAY
#endif
#include <numpy/arrayobject.h>

#include "assembled/system.h"
#include "base/status.h"
#include "base/stop.h"
#include "base/workspace.h"
#include "chain/chain.h"

struct py_state {
    PyObject *scene_error;
    PyObject *solve_error;
};

/* raises what the status means and returns NULL */
PyObject *py_raise(PyObject *module, enum rd_status status);

/* a new reference to an array of this type with `dimensions` axes, aligned and contiguous; axis k
   has shape[k] entries unless that is negative. NULL and an exception that names the argument */
PyArrayObject *py_array(PyObject *object, int type, int dimensions, const npy_intp *shape,
                        const char *name);

enum { PY_KEPT = 16 };

/* arrays that live as long as a call */
struct py_kept {
    PyArrayObject *array[PY_KEPT];
    size_t count;
};

/* what py_array finds, kept: its numbers; NULL and an exception */
void *py_keep(struct py_kept *kept, PyObject *object, int type, int dimensions,
              const npy_intp *shape, const char *name);
/* how long an axis of the last of them is */
npy_intp py_kept_length(const struct py_kept *kept, int axis);
void py_kept_release(struct py_kept *kept);

enum { PY_CHAIN_ARRAYS = 20 };

/* a chain and the arrays it views */
struct py_chain {
    struct rd_chain chain;
    PyArrayObject *array[PY_CHAIN_ARRAYS]; /* NULL where the chain has none */
    int32_t *each;                         /* element_of and term_of */
};

/* 0, or -1 and an exception; to be released in both cases. py_chain_view leaves element_of and
   term_of NULL: its time grows with the stretches of the chain, not with its nodes. py_chain_expand
   fills them, py_chain_parse does both. */
int py_chain_view(PyObject *object, struct py_chain *parsed);
int py_chain_expand(struct py_chain *parsed);
int py_chain_parse(PyObject *object, struct py_chain *parsed);
void py_chain_release(struct py_chain *parsed);

/* For what has a meaning only where inertia is lumped at the nodes: 0, or -1 and ValueError where
   elements are continuous. */
int py_chain_is_lumped(const struct py_chain *parsed, const char *entry);

/* ports and the arrays they view, from the tuple (node (count), row (count, 2, width), force (count,
   width) or None) */
struct py_ports {
    struct rd_ports ports;
    PyArrayObject *node;
    PyArrayObject *row;
    PyArrayObject *force;
};

int py_ports_parse(PyObject *object, const struct rd_chain *chain, const char *name,
                   struct py_ports *parsed);
void py_ports_release(struct py_ports *parsed);

/* After a measuring pass: gives the workspace a block of what was counted.
   0, or -1 and MemoryError; the block is freed with PyMem_RawFree(workspace->base). */
int py_workspace_allocate(struct rd_workspace *workspace);

/* a thread that works without the GIL and looks for Ctrl-C now and then: glue/watch.c */
struct py_watch {
    PyThreadState *thread;
    double looked; /* [s] */
    bool stopped;
};

/* Releases the GIL; what the core asks from then on. */
struct rd_stop py_watch_begin(struct py_watch *watch);

/* Takes it again: 0, or -1 and the exception that Python had a reason to stop with. */
int py_watch_end(struct py_watch *watch);

/* a new uninitialised float64 array */
PyObject *py_new(int type, int dimensions, const npy_intp *shape);

/* the entry points, one file each */
PyObject *py_section(PyObject *module, PyObject *arguments);
PyObject *py_invert(PyObject *module, PyObject *arguments);
PyObject *py_divide(PyObject *module, PyObject *arguments);
PyObject *py_triples(PyObject *module, PyObject *arguments);
PyObject *py_shape(PyObject *module, PyObject *arguments);
PyObject *py_local(PyObject *module, PyObject *arguments);
PyObject *py_assemble(PyObject *module, PyObject *arguments);
PyObject *py_deflection(PyObject *module, PyObject *arguments);
PyObject *py_modes(PyObject *module, PyObject *arguments);
PyObject *py_frf(PyObject *module, PyObject *arguments);
PyObject *py_energy(PyObject *module, PyObject *arguments);
PyObject *py_sensitivity(PyObject *module, PyObject *arguments);
PyObject *py_count(PyObject *module, PyObject *arguments);
PyObject *py_certify(PyObject *module, PyObject *arguments);
PyObject *py_steps(PyObject *module, PyObject *arguments);
PyObject *py_damped(PyObject *module, PyObject *arguments);
PyObject *py_scales(PyObject *module, PyObject *arguments);
PyObject *py_sweep(PyObject *module, PyObject *arguments);
PyObject *py_sweep_between(PyObject *module, PyObject *arguments);
PyObject *py_triple(PyObject *module, PyObject *arguments);
PyObject *py_mixed(PyObject *module, PyObject *arguments);
PyObject *py_mixed_deflection(PyObject *module, PyObject *arguments);
PyObject *py_carried(PyObject *module, PyObject *arguments);
PyObject *py_carried_slopes(PyObject *module, PyObject *arguments);
PyObject *py_pair_slopes(PyObject *module, PyObject *arguments);
PyObject *py_carried_pair_slopes(PyObject *module, PyObject *arguments);
PyObject *py_tip(PyObject *module, PyObject *arguments);
PyObject *py_space_triples(PyObject *module, PyObject *arguments);
PyObject *py_space_count(PyObject *module, PyObject *arguments);
PyObject *py_space_factor(PyObject *module, PyObject *arguments);
PyObject *py_space_solve(PyObject *module, PyObject *arguments);
PyObject *py_space_respond(PyObject *module, PyObject *arguments);
PyObject *py_space_apply(PyObject *module, PyObject *arguments);
PyObject *py_space_iterate(PyObject *module, PyObject *arguments);
PyObject *py_recurrence(PyObject *module, PyObject *arguments);
PyObject *py_eliminate(PyObject *module, PyObject *arguments);
PyObject *py_substitute(PyObject *module, PyObject *arguments);
PyObject *py_balance(PyObject *module, PyObject *arguments);
PyObject *py_first_crossing(PyObject *module, PyObject *arguments);
PyObject *py_stopped(PyObject *module, PyObject *arguments);
PyObject *py_collocate(PyObject *module, PyObject *arguments);
PyObject *py_volterra(PyObject *module, PyObject *arguments);
PyObject *py_modal_steps(PyObject *module, PyObject *arguments);
PyObject *py_closed_modes(PyObject *module, PyObject *arguments);
PyObject *py_closed_count(PyObject *module, PyObject *arguments);
PyObject *py_closed_response(PyObject *module, PyObject *arguments);
PyObject *py_closed_chain_modes(PyObject *module, PyObject *arguments);
PyObject *py_closed_chain_count(PyObject *module, PyObject *arguments);

#endif
