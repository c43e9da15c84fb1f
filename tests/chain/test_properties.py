"""What holds for every scene: symmetry, definiteness, statics, rigid motion, reversal."""

import math

import numpy as np
import pytest
from conftest import EPS, dense, free
from hypothesis import assume, given
from hypothesis import strategies as st

import ropedyn as rd
from ropedyn.chain import matrices

LENGTH = 1.0
FREE = rd.End(x="free", z="free", alpha="free", beta="free")


def value(low, high):
    """Numbers spread evenly over decades."""
    return st.floats(math.log10(low), math.log10(high)).map(lambda e: round(10**e, 6))


@st.composite
def ropes(draw):
    bends, twists, stretches = draw(st.booleans()), draw(st.booleans()), draw(st.booleans())
    rope = {"length": LENGTH, "linear_density": draw(value(0.01, 1.0))}
    if bends:
        rope["bending_stiffness"] = draw(value(0.1, 50.0))
        rope["rotary_inertia"] = draw(st.none() | value(1e-5, 1e-3))
    if twists:
        rope["torsional_stiffness"] = draw(value(0.1, 50.0))
        rope["polar_inertia"] = draw(value(1e-5, 1e-3))
    if stretches:
        rope["axial_stiffness"] = draw(value(10.0, 1e4))
    if bends and twists:
        rope["lay_slope"] = draw(st.none() | st.floats(-1, 1).map(lambda h: round(h, 3)))
    if stretches and twists:
        part = draw(st.floats(-0.8, 0.8))
        most = math.sqrt(rope["axial_stiffness"] * rope["torsional_stiffness"])
        rope["lay_coupling"] = draw(st.sampled_from([None, part * most]))
    return rope


ends = st.sampled_from(
    ["clamped", "pinned", "free", rd.End(z="free"), rd.End(x="free", alpha="free")]
)
positions = st.sampled_from([0.0, 0.13, 0.25, 0.5, 0.77, 1.0])


UNDAMPED = st.none()


@st.composite
def scenes(draw, held=False, dampings=UNDAMPED):
    """A rope with parts, tension >= 0; `held`: its left end is clamped."""
    rope = rd.Rope(**draw(ropes()))
    tension = draw(st.sampled_from([0.0, 3.0, 200.0]))
    assume(tension > 0 or len(rd.Scene(rope, tension=1.0).coordinates) > 1)
    present = rd.Scene(rope, tension=tension or 0.0).coordinates
    parts = draw(
        st.lists(
            st.one_of(
                st.builds(rd.PointMass, positions, value(1e-3, 1.0)),
                st.builds(
                    rd.Spring, positions, value(0.1, 1e3), coordinate=st.sampled_from(present)
                ),
                st.builds(rd.Support, positions, coordinate=st.sampled_from(present)),
            ),
            max_size=3,
        )
    )
    left = "clamped" if held else draw(ends)
    return rd.Scene(
        rope, tension=tension, ends=(left, draw(ends)), parts=parts, damping=draw(dampings)
    )


@st.composite
def models(draw, **more):
    scene = draw(scenes(**more))
    model = scene.compile(elements=draw(st.integers(7, 12)), element="rigid")
    assume(model.size > 0)
    return model


DAMPED = st.sampled_from(
    [
        rd.StiffnessDamping(1e-3),
        rd.RayleighDamping(2.0, 1e-4),
        (rd.StiffnessDamping(1e-4), rd.RayleighDamping(1.0, 0.0)),
    ]
)


def scaled(K):
    """A matrix scaled to a diagonal of ones, and the scale."""
    size = np.sqrt(np.abs(np.diag(K)))
    size[size == 0] = 1.0
    return K / np.outer(size, size), size


# matrices ------------------------------------------------------------------------------------


@given(models(dampings=DAMPED))
def test_stiffness_mass_and_damping_are_symmetric(model):
    for A in dense(model):
        np.testing.assert_array_equal(A, A.T)


@given(models())
def test_stiffness_and_mass_are_positive_where_nothing_compresses(model):
    K, M, _ = dense(model)
    # rounding of a matrix with a unit diagonal: its size times a few eps
    assert np.linalg.eigvalsh(scaled(K)[0])[0] >= -10 * EPS * len(K)
    assert (np.diag(M) >= 0).all()
    assert (np.diag(np.diag(M)) == M).all()


@given(models(held=True))
def test_stiffness_of_a_held_rope_is_positive_definite(model):
    # clamped untensed chain of twelve elements: 1/condition is (pi/12)^4/50 at least, 1e-4
    assert np.linalg.eigvalsh(scaled(dense(model)[0])[0])[0] > 1e-8


@given(models(dampings=DAMPED))
def test_components_are_blocks_of_the_whole(model):
    names = np.tile(model.coordinates, (len(model.x), 1))[free(model)]
    component = np.array([model.component_of(name)[0] for name in names])
    apart = component[:, None] != component[None, :]
    for A in dense(model):
        assert (A[apart] == 0).all()
    assert sorted(c for part in model.components for c in part) == sorted(model.coordinates)


@given(models(), st.sampled_from(["x", "z", "alpha", "beta"]))
def test_component_alone_has_its_part_of_the_matrices(model, coordinate):
    assume(coordinate in model.coordinates)
    component = model.component_of(coordinate)
    names = np.tile(model.coordinates, (len(model.x), 1))[free(model)]
    mine = np.isin(names, component)
    alone = model.chain.only(component)
    K, M, _ = dense(model)
    np.testing.assert_array_equal(matrices.mass(alone).toarray(), M[np.ix_(mine, mine)])
    # the flexibility of more coordinates is inverted together: same numbers to rounding
    part, size = scaled(K[np.ix_(mine, mine)])
    np.testing.assert_allclose(
        matrices.stiffness(alone).toarray() / np.outer(size, size), part, rtol=0, atol=1e-13
    )


# rigid motion --------------------------------------------------------------------------------


@given(ropes(), st.sampled_from([0.0, 200.0]), st.integers(1, 12))
def test_free_rope_resists_no_rigid_motion(rope, tension, elements):
    rope = rd.Rope(**rope)
    assume(tension > 0 or len(rd.Scene(rope, tension=1.0).coordinates) > 1)
    scene = rd.Scene(rope, tension=tension, ends=(FREE, FREE))
    model = scene.compile(elements=elements, element="rigid")
    K = model.stiffness_matrix().toarray()
    shape = (len(model.x), len(model.coordinates))
    for k, c in enumerate(model.coordinates):
        u = np.zeros(shape)
        u[:, k] = 1
        if c == "beta":
            # tension keeps its direction: it turns with nothing but a rope without tension
            if tension > 0:
                continue
            u[:, model.coordinates.index("z")] = model.x
        force, size = K @ u.ravel(), np.abs(K) @ np.abs(u).ravel()
        # sums that cancel; the flexibility's inverse errs by its condition, some 20
        assert (np.abs(force) <= 200 * EPS * size.max()).all()


# reversal ------------------------------------------------------------------------------------


def reversed_scene(scene):
    """Half a turn about z: what stood at x stands at L - x."""
    parts = []
    for part in scene.parts:
        changes = {"x": LENGTH - part.x}
        arguments = {k: v for k, v in vars(part).items() if k != "_"} | changes
        parts.append(type(part)(**arguments))
    return scene.replace(ends=scene.ends[::-1], parts=parts)


def both_ways(scene, elements):
    """The models of a scene and of the reversed one.

    Of spans that are as long the left one gets the odd element: only mirrored nodes compare.
    """
    one, other = (
        s.compile(elements=elements, element="rigid") for s in (scene, reversed_scene(scene))
    )
    assume(np.allclose(one.x, LENGTH - other.x[::-1], rtol=0, atol=1e-12))
    return one, other


SIGN = {"x": -1, "z": 1, "alpha": -1, "beta": -1}


@given(scenes(), st.integers(7, 12))
def test_reversed_scene_has_the_same_modes(scene, elements):
    one, other = both_ways(scene, elements)
    below = 1e4
    modes, back = one.modes(below=below), other.modes(below=below)
    # L - x is rounded too: bounds to first order count that, what is measured does not
    allowed = modes.rounding_bound[: len(back.frequency)] + back.rounding_bound
    assert len(modes.frequency) == len(back.frequency)
    assert (np.abs(modes.frequency - back.frequency) <= allowed).all()


@given(scenes(held=True, dampings=DAMPED), st.integers(7, 12), st.data())
def test_reversed_scene_responds_with_the_signs_of_the_turn(scene, elements, data):
    c, d = (data.draw(st.sampled_from(scene.coordinates)) for _ in "cd")
    at, there = (data.draw(st.sampled_from([0.2, 0.31, 0.5, 0.9])) for _ in "at")
    frequency = [0.0, 13.0, 150.0]
    one, other = both_ways(scene, elements)
    frf = one.frf(frequency, drive=(c, at), response=(d, there))
    back = other.frf(frequency, drive=(c, LENGTH - at), response=(d, LENGTH - there))
    own = [abs(one.frf(frequency, drive=p).value[0]) for p in ((c, at), (d, there))]
    error = np.abs(frf.value[0] - SIGN[c] * SIGN[d] * back.value[0])
    # twelve elements and springs, damped: 1e5 eps of what such a response can be
    assert (error <= 1e-9 * np.sqrt(own[0] * own[1])).all()


# responses -----------------------------------------------------------------------------------


@given(models(held=True, dampings=DAMPED), st.data())
def test_force_and_response_can_change_places(model, data):
    here, there = (
        (data.draw(st.sampled_from(model.coordinates)), data.draw(st.floats(0.01, 0.99)))
        for _ in "ab"
    )
    frequency = [0.0, 10.0, 120.0]
    both = model.frf(frequency, drive=[here, there]).value
    scale = np.sqrt(np.abs(both[0, 0] * both[1, 1]))
    # 1e5 eps of what such a response can be: twelve elements with springs and inertias
    assert (np.abs(both[0, 1] - both[1, 0]) <= 1e-9 * scale).all()


@given(models(held=True, dampings=DAMPED), st.floats(0.5, 300.0), st.data())
def test_frf_is_the_solution_of_the_assembled_equations(model, f, data):
    c = data.draw(st.sampled_from(model.coordinates))
    node = data.draw(st.integers(1, len(model.x) - 2))
    k = model.coordinates.index(c)
    assume(free(model)[node, k])
    K, M, C = dense(model)
    omega = 2 * math.pi * f
    D, size = scaled(K + 0j)
    size = size.real
    D = (K + 1j * omega * C - omega**2 * M) / np.outer(size, size)
    load = np.zeros((len(model.x), len(model.coordinates)))
    load[node, k] = 1
    u = np.zeros(load.shape, dtype=complex)
    u[free(model)] = np.linalg.solve(D, load[free(model)] / size) / size
    watched = [(d, float(x)) for x in model.x for d in model.coordinates]
    frf = model.frf(f, drive=(c, float(model.x[node])), response=watched)
    motion = frf.value[:, 0].reshape(u.shape)
    # in scaled coordinates relative to the whole motion: the condition of D, a few eps
    error = np.abs(motion - u)[free(model)] * size
    whole = np.linalg.norm(u[free(model)] * size)
    assert error.max() <= 20 * EPS * len(K) * np.linalg.cond(D) * whole
    assert (motion[~free(model)] == 0).all()


def static_rounding(model, displacement, points):
    """What two solutions for unit loads may differ by: the condition, at most 1e6 here, of each
    coordinate's largest; where that is 0 but for rounding, of sqrt(h_dd/K_ii), which is less than
    the bound sqrt(h_dd h_ii) of what a unit load can do.
    """
    own = sum(abs(model.frf(0.0, drive=point).value[0, 0]) for point in points)
    floor = np.zeros(displacement.shape)
    floor[free(model)] = np.sqrt(own / model.stiffness_matrix().diagonal())
    return 1e-9 * (np.abs(displacement).max(axis=0) + floor)


@given(models(held=True, dampings=DAMPED | st.none()), st.data())
def test_frf_without_frequency_is_the_static_deflection(model, data):
    c = data.draw(st.sampled_from(model.coordinates))
    at = data.draw(st.floats(0.01, 0.99))
    static = model.static({(c, at): 1.0})
    watched = [(d, float(x)) for x in model.x for d in model.coordinates]
    frf = model.frf(0.0, drive=(c, at), response=watched)
    u = frf.value[:, 0].reshape(static.displacement.shape)
    assert (u.imag == 0).all()
    assert (np.abs(u.real - static.displacement) <= static_rounding(model, u, [(c, at)])).all()


@given(models(held=True), st.data())
def test_static_loads_superpose_over_components(model, data):
    loads = {(c, data.draw(st.floats(0.01, 0.99))): 1.0 for c in model.coordinates}
    together = model.static(loads).displacement
    apart = sum(model.static({point: 1.0}).displacement for point in loads)
    assert (np.abs(together - apart) <= static_rounding(model, together, loads)).all()


@given(models(held=True, dampings=DAMPED), st.data())
def test_no_rope_gives_power_at_its_drive_point(model, data):
    c = data.draw(st.sampled_from(model.coordinates))
    frf = model.frf([1.0, 30.0, 400.0], drive=(c, data.draw(st.floats(0.01, 0.99))))
    slack = frf.rounding_bound * np.abs(frf.value)
    assert (frf.value.imag <= slack).all()


# modes ---------------------------------------------------------------------------------------


def followed(model, omega):
    """How much faster a twist is by itself than a mode of the rope that it follows, at least 1.

    Motions are right relative to the scale 1/(omega sqrt(p C)) of their coordinate.
    """
    rope = model.scene.rope
    if rope.lay_coupling is None or rope.polar_inertia is None or omega == 0:
        return 1.0
    alone = np.pi / rope.length * np.sqrt(rope.torsional_stiffness / rope.polar_inertia)
    return max(1.0, alone / omega)


@given(models())
def test_eigenpairs_solve_the_assembled_problem(model):
    K, M, _ = dense(model)
    modes = model.modes(below=2e3)
    unit, size = scaled(K)
    inertia = M / np.outer(size, size)
    for k, lam in enumerate(modes.eigenvalue):
        x = modes.shape[k][free(model)] * size
        x /= np.linalg.norm(x)
        residual = np.linalg.norm(unit @ x - lam * (inertia @ x))
        # a backward stable solution errs by eps of the norms of both sides; the factor L of K
        # adds the ratio of this eigenvalue to the lowest elastic one
        elastic = modes.eigenvalue[modes.eigenvalue > 0]
        ratio = lam / elastic.min() if elastic.size else 1.0
        norm = np.linalg.norm(unit) + lam * np.linalg.norm(inertia)
        assert residual <= 1e3 * EPS * norm * (1 + ratio) * followed(model, np.sqrt(abs(lam)))


@given(models())
def test_modes_are_orthogonal(model):
    _, M, _ = dense(model)
    modes = model.modes(below=2e3)
    u = modes.shape.reshape(len(modes.frequency), -1)[:, free(model).ravel()]
    u = u / np.sqrt(modes.modal_mass)[:, None]
    gram = u @ M @ u.T
    # vectors L^-T y: the orthogonality of y is to eps, L costs the square root of K's condition
    ratio = modes.eigenvalue.max(initial=0) / min(modes.eigenvalue[modes.eigenvalue > 0], default=1)
    np.testing.assert_allclose(gram, np.eye(len(gram)), rtol=0, atol=1e3 * EPS * (1 + ratio))


@given(models())
def test_every_finite_mode_is_found_and_none_more(model):
    _, M, _ = dense(model)
    finite = int((np.diag(M) > 0).sum())
    assume(finite > 0)
    modes = model.modes(finite)
    assert len(modes.frequency) == finite
    assert (np.diff(modes.eigenvalue) >= 0).all()
    # where nothing compresses nothing grows
    assert (modes.growth == 0).all()
    with pytest.raises(rd.SolveError, match=rf"at most {finite}\b"):
        model.modes(finite + 1)


@given(models())
def test_more_tension_never_lowers_a_frequency(model):
    scene = model.scene
    assume("z" in model.coordinates and scene.tension > 0)
    elements = len(model.x) - 1
    tighter = scene.replace(tension=1.1 * scene.tension).compile(elements=elements, element="rigid")
    one, other = model.modes(below=1e3), tighter.modes(below=1e3)
    k = len(other.frequency)
    slack = one.rounding_bound[:k] + other.rounding_bound
    assert (other.frequency >= one.frequency[:k] - slack).all()
