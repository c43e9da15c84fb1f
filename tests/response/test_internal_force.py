"""Internal forces are in equilibrium with loads, inertia and reactions along the rope."""

import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd

L, MU, B, T = 1.2, 0.1, 3.0, 40.0
ROPE = rd.Rope(L, MU, bending_stiffness=B)
DAMPING = rd.StiffnessDamping(1e-4)
N = 12
KINDS = pytest.mark.parametrize("element", ["rigid", "tensed"])
TOLERANCE = 1e-12
"""Relative to the largest term of a balance: 1e-13 times conditions below 10 (issue 4)."""


def balanced(*terms):
    """Whether terms add up to zero, relative to the largest."""
    terms = np.array([np.broadcast_to(term, np.shape(terms[0])) for term in terms])
    return (np.abs(terms.sum(axis=0)) <= TOLERANCE * np.abs(terms).max(axis=0)).all()


def node_mass(model):
    """Lumped mass of each node [kg]; end-corrected moments are not part of it."""
    z = model.coordinates.index("z")
    return model.chain.mass[model.chain.term_of][:, z, z]


def end_correction(model):
    """M_z,beta of each node [kg m]."""
    z, beta = model.coordinates.index("z"), model.coordinates.index("beta")
    return model.chain.mass[model.chain.term_of][:, z, beta]


FREQUENCY = np.array([0.5, 20.0, 150.0, 900.0])
OMEGA2 = (2 * np.pi * FREQUENCY) ** 2


# statics -----------------------------------------------------------------------------------------


@KINDS
@pytest.mark.parametrize("tension", [0.0, T])
@pytest.mark.parametrize("x", [0.0, 0.2, 0.5])
def test_shear_of_a_loaded_cantilever_is_the_load_up_to_it(element, tension, x):
    # F_z is the force of what is right of x on what is left: all of a load further right
    scene = rd.Scene(ROPE, tension=tension, ends=("clamped", "free"))
    model = scene.compile(elements=N, element=element)
    frf = model.frf(0.0, drive=("z", 0.7), response=[("F_z", x), ("F_z", 0.9)], solver="sweep")
    assert frf.value[0, 0] == pytest.approx(1.0, rel=TOLERANCE)
    assert abs(frf.value[1, 0]) <= TOLERANCE


@KINDS
@pytest.mark.parametrize("x", [0.0, 0.1, 0.6])
def test_moment_of_a_loaded_cantilever_grows_with_the_lever(element, x):
    # without tension: M = F (a - x), x = 0 is the root
    model = rd.Scene(ROPE, ends=("clamped", "free")).compile(elements=N, element=element)
    frf = model.frf(0.0, drive=("z", 0.7), response=("M_beta", x), solver="sweep")
    assert frf.value[0, 0] == pytest.approx(0.7 - x, rel=TOLERANCE)


@KINDS
def test_moment_at_the_root_of_a_tensed_cantilever_counts_the_deflection(element):
    # equilibrium of the whole: M(0) = F L - T w(L)
    scene = rd.Scene(ROPE, tension=T, ends=("clamped", "free"))
    model = scene.compile(elements=N, element=element)
    moment, tip = model.frf(
        0.0, drive=("z", L), response=[("M_beta", 0.0), ("z", L)], solver="sweep"
    ).value[:, 0]
    assert balanced(moment, -L, T * tip)


def test_root_moment_of_a_tensed_cantilever_is_that_of_the_continuum():
    # tensed elements are exact in statics: M(0) = F tanh(kappa L)/kappa
    scene = rd.Scene(ROPE, tension=T, ends=("clamped", "free"))
    frf = scene.compile(elements=N, element="tensed").frf(
        0.0, drive=("z", L), response=("M_beta", 0.0), solver="sweep"
    )
    kappa = math.sqrt(T / B)
    assert frf.value[0, 0] == pytest.approx(math.tanh(kappa * L) / kappa, rel=TOLERANCE)


def test_bending_moment_inside_a_tensed_element_is_that_of_the_continuum():
    # M(x) = F sinh(kappa (L - x))/(kappa cosh(kappa L)), at nodes and between them
    scene = rd.Scene(ROPE, tension=T, ends=("clamped", "free"))
    x = [0.0, 0.05, 0.1, 0.333, 0.71, 1.0, 1.15]
    frf = scene.compile(elements=N, element="tensed").frf(
        0.0, drive=("z", L), response=[("M_beta", s) for s in x], solver="sweep"
    )
    kappa = math.sqrt(T / B)
    exact = np.sinh(kappa * (L - np.array(x))) / (kappa * math.cosh(kappa * L))
    np.testing.assert_allclose(frf.value[:, 0], exact, rtol=TOLERANCE)


@KINDS
@pytest.mark.parametrize("solver", ["sweep", "lapack"])
def test_internal_forces_at_the_ends_are_the_reactions_of_the_static_solution(element, solver):
    model = rd.Scene(ROPE, tension=T).compile(elements=N, element=element)
    static = model.static({("z", 0.5): 3.0, ("beta", 0.8): 0.2}, solver=solver)
    points = [("F_z", 0.0), ("M_beta", 0.0), ("F_z", L), ("M_beta", L)]
    frf = model.frf(0.0, drive=[("z", 0.5), ("beta", 0.8)], response=points, solver="sweep")
    force = np.einsum("d,drf->r", [3.0, 0.2], frf.value).real
    # the left clamp holds against what the rope puts on it; at x = L the right part is the clamp.
    # assembled: its condition 50 (12/pi)^4 = 1e4 times eps
    tolerance = TOLERANCE if solver == "sweep" else 1e4 * EPS
    np.testing.assert_allclose(static.force[0], -force[:2], rtol=tolerance)
    np.testing.assert_allclose(static.force[-1], force[2:], rtol=tolerance)
    assert static.force[0, 0] + static.force[-1, 0] == pytest.approx(-3.0, rel=tolerance)


# harmonic ----------------------------------------------------------------------------------------


@KINDS
@pytest.mark.parametrize("damping", [None, DAMPING], ids=["undamped", "damped"])
@pytest.mark.parametrize("tension", [0.0, T])
def test_shear_jumps_at_a_drive_by_the_load_and_by_inertia(element, tension, damping):
    # a node: F_z right of it less F_z left of it + load + omega^2 (m z + c beta) = 0; F_z just
    # right of it is F_z at the next node, where nothing acts on the element between
    model = rd.Scene(ROPE, tension=tension, damping=damping).compile(elements=N, element=element)
    k = 5
    x = model.x.tolist()
    points = [("F_z", x[k]), ("F_z", x[k + 1]), ("z", x[k])]
    left, right, z = model.frf(FREQUENCY, drive=("z", x[k]), response=points, solver="sweep").value
    assert balanced(right, -left, np.ones(4), OMEGA2 * node_mass(model)[k] * z)


@KINDS
@pytest.mark.parametrize("damping", [None, DAMPING], ids=["undamped", "damped"])
@pytest.mark.parametrize("ends", [("clamped", "free"), ("clamped", "clamped"), ("pinned", "free")])
def test_reactions_balance_load_and_inertia_of_the_whole_rope(element, ends, damping):
    model = rd.Scene(ROPE, tension=T, ends=ends, damping=damping).compile(
        elements=N, element=element
    )
    x = model.x.tolist()
    points = [("F_z", 0.0), ("F_z", L), *[("z", s) for s in x], *[("beta", s) for s in x]]
    value = model.frf(FREQUENCY, drive=("z", 0.5), response=points, solver="sweep").value
    first, last, z, beta = value[0], value[1], value[2 : N + 3], value[N + 3 :]
    # nodes 0 .. N - 1 move between F_z at 0, right of the end node, and F_z at L, left of its node
    mass, correction = node_mass(model)[1:-1], end_correction(model)[1:-1]
    inertia = OMEGA2 * (mass @ z[1:-1] + correction @ beta[1:-1])
    assert balanced(last, -first, np.ones(4), inertia)


@KINDS
def test_internal_force_at_a_free_end_is_the_inertia_of_its_node(element):
    # nothing right of L: what the surroundings put on the last node is none of its own inertia
    model = rd.Scene(ROPE, tension=T, ends=("clamped", "free")).compile(elements=N, element=element)
    points = [("F_z", L), ("z", L), ("beta", L)]
    force, z, beta = model.frf(FREQUENCY, drive=("z", 0.5), response=points, solver="sweep").value
    inertia = OMEGA2 * (node_mass(model)[-1] * z + end_correction(model)[-1] * beta)
    # F_z acts on the element just left of the node, which passes its inertia on
    assert balanced(force, -inertia)


@KINDS
@pytest.mark.parametrize("damping", [None, DAMPING], ids=["undamped", "damped"])
def test_moment_changes_along_an_element_by_its_shear(element, damping):
    # element k: M at its left end = M at its right end + l F_z - T (z_b - z_a); the left one is
    # M at node k plus what node k adds, nothing in a uniform span without rotary inertia
    model = rd.Scene(ROPE, tension=T, damping=damping).compile(elements=N, element=element)
    x, k = model.x.tolist(), 7
    points = [
        *[("M_beta", x[k]), ("M_beta", x[k + 1]), ("F_z", x[k + 1])],
        *[("z", x[k]), ("z", x[k + 1])],
    ]
    here, there, shear, a, b = model.frf(
        FREQUENCY, drive=("z", 0.3), response=points, solver="sweep"
    ).value
    assert balanced(here, -there, -(L / N) * shear, T * (b - a))


@KINDS
def test_torque_and_axial_force_of_a_laid_rope_balance_their_loads(element):
    rope = rd.Rope(
        L, MU, axial_stiffness=9e4, torsional_stiffness=1.0, lay_coupling=-200.0, polar_inertia=1e-6
    )
    model = rd.Scene(rope, ends=("clamped", "free")).compile(elements=N, element=element)
    for drive, own, other in (("x", "F_x", "M_alpha"), ("alpha", "M_alpha", "F_x")):
        points = [(own, 0.0), (own, 0.4), (other, 0.0), (own, 0.9)]
        value = model.frf(0.0, drive=(drive, 0.8), response=points, solver="sweep").value[:, 0]
        np.testing.assert_allclose(value, [1, 1, 0, 0], rtol=TOLERANCE, atol=1e-10)


def test_force_between_nodes_of_rigid_elements_is_refused():
    model = rd.Scene(ROPE, tension=T).compile(elements=N, element="rigid")
    with pytest.raises(rd.SceneError, match="must stand at a node"):
        model.frf(1.0, drive=("z", 0.5), response=("F_z", 0.123), solver="sweep")


def test_assembled_solver_refuses_internal_forces():
    model = rd.Scene(ROPE, tension=T).compile(elements=N, element="tensed")
    with pytest.raises(rd.SceneError, match=r'solver must be "sweep"'):
        model.frf(1.0, drive=("z", 0.5), response=("F_z", 0.0), solver="lapack")


def test_label_names_the_internal_force_and_its_unit():
    model = rd.Scene(ROPE, tension=T).compile(elements=N, element="tensed")
    frf = model.frf(1.0, drive=("z", 0.5), response=("M_beta", 0.0), solver="sweep")
    assert frf.labels == ("M_beta at 0.000 m [N m/N]",)
