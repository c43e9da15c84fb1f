/* The extension module ropedyn._core: its table of entry points and its state. */
#define PY_GLUE_IMPORTS_ARRAY
#include "glue/glue.h"

#include "base/lapack.h"

static PyMethodDef methods[] = {
    {"section", py_section, METH_VARARGS, "section(axial, torsion, bending, coupling, slope)"},
    {"invert", py_invert, METH_VARARGS, "invert(matrix): inverse, positive definite only"},
    {"divide", py_divide, METH_VARARGS,
     "divide(station, elements, rope, rounding) -> length, span, which, within, first, element, "
     "term, x"},
    {"triples", py_triples, METH_VARARGS, "triples(chain) -> F, G, Q"},
    {"shape", py_shape, METH_VARARGS, "shape(chain, node, s) -> (width, 2, width)"},
    {"local", py_local, METH_VARARGS, "local(chain, node, s, p) -> (width, width)"},
    {"assemble", py_assemble, METH_VARARGS,
     "assemble(chain) -> elastic, its coupling, string, its coupling, springs, mass, dashpots"},
    {"deflection", py_deflection, METH_VARARGS,
     "deflection(chain, force) -> displacement, reciprocal condition"},
    {"modes", py_modes, METH_VARARGS,
     "modes(chain, wanted, below, scale) -> (eigenvalue, rounding, shape), finite"},
    {"frf", py_frf, METH_VARARGS,
     "frf(chain, factor, drives, responses) -> value, rounding, frequencies solved"},
    {"count", py_count, METH_VARARGS, "count(chain, lambda) -> counts"},
    {"certify", py_certify, METH_VARARGS,
     "certify(chain, wanted, upper, shaped) -> lambda, error, certified, shape, motion, found, "
     "sweeps, redone"},
    {"steps", py_steps, METH_VARARGS, "steps(chain, factor): of the longest walk"},
    {"scales", py_scales, METH_VARARGS, "scales(chain, factor) -> (width, f) of motion"},
    {"sweep", py_sweep, METH_VARARGS,
     "sweep(chain, factor, drives, responses, between=None) -> value, error, frequencies solved"},
    {"sweep_between", py_sweep_between, METH_VARARGS,
     "sweep_between(chain, nodes) -> values at these factors, between which others lie"},
    {"damped", py_damped, METH_VARARGS,
     "damped(chain, constant, linear, radius, edge, horizon, guess) -> value, error, count, "
     "radius, "
     "mirror, certified, sweeps"},
    {"mixed", py_mixed, METH_VARARGS,
     "mixed(chain, factor, drives, responses) -> value, error, frequencies solved"},
    {"mixed_deflection", py_mixed_deflection, METH_VARARGS,
     "mixed_deflection(chain, force) -> displacement, force on the right ends of elements"},
    {"triple", py_triple, METH_VARARGS, "triple(chain, element, factor) -> F, G, Q"},
    {"energy", py_energy, METH_VARARGS,
     "energy(chain, shape, eigenvalue) -> strain, kinetic, dragged"},
    {"carried", py_carried, METH_VARARGS,
     "carried(chain, shape, motion, eigenvalue) -> (k, 3) strain, kinetic, lost"},
    {"carried_slopes", py_carried_slopes, METH_VARARGS,
     "carried_slopes(chain, shape, motion, eigenvalue) -> slopes by m and k, by the row of the "
     "foot"},
    {"space_triples", py_space_triples, METH_VARARGS,
     "space_triples(rates, series, length, equal, halvings, doublings, gentle) -> triples, "
     "doublings, "
     "whole"},
    {"space_factor", py_space_factor, METH_VARARGS,
     "space_factor(D, G, Q, N, fixed, closed) -> factors, pivots, failed"},
    {"space_solve", py_space_solve, METH_VARARGS, "space_solve(factors, pivots, right) -> x"},
    {"space_respond", py_space_respond, METH_VARARGS,
     "space_respond(D, G, Q, N, fixed, closed, right) -> x"},
    {"space_apply", py_space_apply, METH_VARARGS,
     "space_apply(D, G, Q, N, fixed, closed, vectors) -> A x"},
    {"space_iterate", py_space_iterate, METH_VARARGS,
     "space_iterate(D, G, Q, N, fixed, closed, factors, pivots, vectors, times) -> vectors, forms"},
    {"space_count", py_space_count, METH_VARARGS,
     "space_count(rope, components, eigenvalues, scale) -> counts"},
    {"recurrence", py_recurrence, METH_VARARGS,
     "recurrence(change, gain, read, local, kind, sample, state) -> value, state"},
    {"eliminate", py_eliminate, METH_VARARGS, "eliminate(A, columns): in place"},
    {"substitute", py_substitute, METH_VARARGS, "substitute(A, x): in place"},
    {"tip", py_tip, METH_VARARGS, "tip(chain, k, factor) -> (3, 2, f)"},
    {"pair_slopes", py_pair_slopes, METH_VARARGS,
     "pair_slopes(chain, factor, field, pair, slip) -> slopes, jumps, dyads, places of stretches"},
    {"carried_pair_slopes", py_carried_pair_slopes, METH_VARARGS,
     "carried_pair_slopes(chain, factor, field, pair, slip) -> numbers, rows of structures"},
    {"sensitivity", py_sensitivity, METH_VARARGS,
     "sensitivity(chain, shape, motion, eigenvalue) -> slopes, squared jumps, dyads, places"},
    {"balance", py_balance, METH_VARARGS, "balance(transfer, by_u, by_v, omega) -> jacobians"},
    {"first_crossing", py_first_crossing, METH_VARARGS,
     "first_crossing(rate, c, d, a, scale, end) -> (time, which) or None"},
    {"stopped", py_stopped, METH_VARARGS,
     "stopped(stiffness, gap, side, step, u, v) -> force, by_u, by_v over periods"},
    {"collocate", py_collocate, METH_VARARGS,
     "collocate(step, laws, begin, known, force, state, size) -> force, state, motion, size, steps "
     "made, iterations, residual, failure"},
    {"volterra", py_volterra, METH_VARARGS,
     "volterra(laws, begin, h, kernel, linear, force, motion, size, first, until) -> steps made, "
     "residual, failure; force, motion and size go on in place"},
    {"modal_steps", py_modal_steps, METH_VARARGS,
     "modal_steps(step, laws, coupling, known, state, pushed, force, largest, size) -> steps made, "
     "residual, failure"},
    {"closed_modes", py_closed_modes, METH_VARARGS,
     "closed_modes(kind, number, jacobian, modes) -> omega, error, slope, certified"},
    {"closed_count", py_closed_count, METH_VARARGS,
     "closed_count(kind, number, omega) -> counts, -1 where not certain"},
    {"closed_response", py_closed_response, METH_VARARGS,
     "closed_response(number, factor, drag, drive, response) -> value, error, certain"},
    {"closed_chain_modes", py_closed_chain_modes, METH_VARARGS,
     "closed_chain_modes(kind, numbers, hinge, jacobian, number) -> omega, error, slope, "
     "certified"},
    {"closed_chain_count", py_closed_chain_count, METH_VARARGS,
     "closed_chain_count(kind, numbers, hinge, omega) -> counts, -1 where not certain"},
    {NULL, NULL, 0, NULL},
};

static int execute(PyObject *module)
{
    struct py_state *state = PyModule_GetState(module);
    import_array1(-1);
    if (openblas_set_num_threads != NULL)
        openblas_set_num_threads(1);
    PyObject *errors = PyImport_ImportModule("ropedyn.base.errors");
    if (errors == NULL)
        return -1;
    state->scene_error = PyObject_GetAttrString(errors, "SceneError");
    state->solve_error = PyObject_GetAttrString(errors, "SolveError");
    Py_DECREF(errors);
    return state->scene_error == NULL || state->solve_error == NULL ? -1 : 0;
}

static int traverse(PyObject *module, visitproc visit, void *arg)
{
    struct py_state *state = PyModule_GetState(module);
    Py_VISIT(state->scene_error);
    Py_VISIT(state->solve_error);
    return 0;
}

static int clear(PyObject *module)
{
    struct py_state *state = PyModule_GetState(module);
    Py_CLEAR(state->scene_error);
    Py_CLEAR(state->solve_error);
    return 0;
}

static PyModuleDef_Slot slots[] = {
    {Py_mod_exec, (void *)execute},
#ifdef Py_mod_multiple_interpreters
    {Py_mod_multiple_interpreters, Py_MOD_MULTIPLE_INTERPRETERS_NOT_SUPPORTED},
#endif
#ifdef Py_mod_gil
    {Py_mod_gil, Py_MOD_GIL_NOT_USED},
#endif
    {0, NULL},
};

static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT,
    .m_name = "ropedyn._core",
    .m_doc = "The C core of ropedyn over NumPy arrays.",
    .m_size = sizeof(struct py_state),
    .m_methods = methods,
    .m_slots = slots,
    .m_traverse = traverse,
    .m_clear = clear,
};

PyMODINIT_FUNC PyInit__core(void)
{
    return PyModuleDef_Init(&definition);
}
