"""Derivatives of modes against closed forms, characteristic equations and differences."""

import dataclasses
import functools
import re

import mpmath
import numpy as np
import pytest
from conftest import EVERYTHING
from mpmath import mpf

import ropedyn as rd
from ropedyn.chain.compile import divided, stations_of

LENGTH, DENSITY, BENDING, TENSION = 1.3, 0.1, 2.0, 300.0
WAVE = np.arange(1, 6) * np.pi / LENGTH
EXACT = 1e-12
"""Relative: shapes have 1e-14, and forces are differences of neighbours half a radian apart."""


def near(value, expected, allowed=EXACT):
    """Each within so much of the largest."""
    np.testing.assert_allclose(value, expected, rtol=0, atol=allowed * np.abs(expected).max())


def error(value, expected):
    """Return the largest error in units of the largest expected."""
    return np.abs(value - expected).max() / np.abs(expected).max()


# --- closed forms -----------------------------------------------------------------------------


def test_string_frequencies_change_as_their_formula():
    modes = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION).compile().modes(5)
    f = WAVE / (2 * np.pi) * np.sqrt(TENSION / DENSITY)
    near(modes.derivative("tension"), f / (2 * TENSION))
    near(modes.derivative("linear_density"), -f / (2 * DENSITY))
    near(modes.derivative("length"), -f / LENGTH)
    near(modes.derivative("tension", of="eigenvalue"), WAVE**2 / DENSITY)


@pytest.mark.parametrize("tension", [0.0, 300.0, 3e5, -8.0])
def test_pinned_beam_changes_as_its_formula(tension):
    """Lambda = k^2 (B k^2 + T)/(mu + j k^2) with k = n pi/L."""
    j = 2e-5
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING, rotary_inertia=j)
    scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"))
    modes = scene.compile().modes(5)
    mass, k = DENSITY + j * WAVE**2, WAVE
    value = k**2 * (BENDING * k**2 + tension) / mass
    by_k = (4 * BENDING * k**3 + 2 * tension * k - 2 * j * k * value) / mass
    expected = {
        "bending_stiffness": k**4 / mass,
        "tension": k**2 / mass,
        "linear_density": -value / mass,
        "rotary_inertia": -value * k**2 / mass,
        "length": -by_k * k / LENGTH,
    }
    for path, slope in expected.items():
        near(modes.derivative(path, of="eigenvalue"), slope)
        near(modes.derivative(path), slope / (8 * np.pi**2 * modes.frequency))


def test_torsion_rod_changes_as_its_formula():
    """Held at one end: k = (n - 1/2) pi/L."""
    C, p = 0.4, 3e-6
    rope = rd.Rope(LENGTH, DENSITY, torsional_stiffness=C, polar_inertia=p)
    modes = rd.Scene(rope, ends=("clamped", "free")).compile().modes(5)
    f = (np.arange(5) + 0.5) / (2 * LENGTH) * np.sqrt(C / p)
    near(modes.derivative("torsional_stiffness"), f / (2 * C))
    near(modes.derivative("polar_inertia"), -f / (2 * p))
    near(modes.derivative("length"), -f / LENGTH)


# --- characteristic equations -----------------------------------------------------------------


def implicit(equation, omega, arguments, name):
    """d(omega)/dp of the root near omega of equation(omega, **arguments) = 0."""
    with mpmath.workdps(50):
        given = {key: mpf(value) for key, value in arguments.items()}
        root = mpf(omega)
        for _ in range(3):
            root -= equation(root, **given) / mpmath.diff(lambda w: equation(w, **given), root)
        by_p = mpmath.diff(lambda p: equation(root, **(given | {name: p})), given[name])
        by_omega = mpmath.diff(lambda w: equation(w, **given), root)
        return float(-by_p / by_omega)


def mass_on_string(omega, T, mu, L, m, a):
    """T k sin(k L) = m omega^2 sin(k a) sin(k (L - a))."""
    k = omega * mpmath.sqrt(mu / T)
    return T * k * mpmath.sin(k * L) - m * omega**2 * mpmath.sin(k * a) * mpmath.sin(k * (L - a))


@pytest.mark.claim(
    "df/dp of a point mass on a string, p its mass, place, tension, density and length",
    reference="characteristic equation differentiated in 50 digits",
    accepted=4e-14,
)
@pytest.mark.parametrize("mass", [0.05, 0.0])
def test_mass_on_a_string_changes_as_its_characteristic_equation(mass, claim):
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "m": mass, "a": 0.4}
    scene = rd.Scene(
        rd.Rope(LENGTH, DENSITY), tension=TENSION, parts=[rd.PointMass(given["a"], mass)]
    )
    modes = scene.compile().modes(4)
    paths = {"T": "tension", "mu": "linear_density", "L": "length", "m": "parts[0].mass"}
    if mass > 0:
        paths["a"] = "parts[0].x"
    for name, path in paths.items():
        expected = [
            implicit(mass_on_string, 2 * np.pi * f, given, name) / (2 * np.pi)
            for f in modes.frequency
        ]
        claim(error(modes.derivative(path), np.array(expected)))


def tensed_cantilever(omega, B, T, mu, L):
    """No moment and no transverse force at L of what is clamped at 0."""
    h = T / (2 * B)
    r = mpmath.sqrt(h * h + mu * omega**2 / B)
    a, k = mpmath.sqrt(r + h), mpmath.sqrt(r - h)
    ch, sh, c, s = mpmath.cosh(a * L), mpmath.sinh(a * L), mpmath.cos(k * L), mpmath.sin(k * L)
    moment = a * a * ch + k * k * c, a * sh + k * s
    force = (
        B * (a**3 * sh - k**3 * s) - T * (a * sh + k * s),
        B * (a * a * ch + k * k * c) - T * (ch - c),
    )
    return (moment[0] * force[1] - moment[1] * force[0]) / (B * a**4 * ch)


@pytest.mark.claim(
    "df/dp of a tensed cantilever, p its bending stiffness, tension, density and length",
    reference="characteristic equation differentiated in 50 digits",
    accepted=EXACT,
)
@pytest.mark.parametrize("tension", [1e-3, 30.0, 3000.0])
def test_tensed_cantilever_changes_as_its_characteristic_equation(tension, claim):
    given = {"B": BENDING, "T": tension, "mu": DENSITY, "L": LENGTH}
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    modes = rd.Scene(rope, tension=tension, ends=("clamped", "free")).compile().modes(4)
    paths = {
        "B": "bending_stiffness",
        "T": "tension",
        "mu": "linear_density",
        "L": "length",
    }
    for name, path in paths.items():
        expected = [
            implicit(tensed_cantilever, 2 * np.pi * f, given, name) / (2 * np.pi)
            for f in modes.frequency
        ]
        claim(error(modes.derivative(path), np.array(expected)))


# --- differences ------------------------------------------------------------------------------

QUOTIENT = 1e-10
"""Relative error of the difference quotients, see `difference`."""

STRING = rd.Scene(
    rd.Rope(LENGTH, DENSITY, torsional_stiffness=0.4, polar_inertia=3e-6),
    tension=TENSION,
    parts=[rd.PointMass(0.4, 0.02)],
)
PATH = re.compile(r"(parts|ends)\[(\d+)\]\.(?:(spring|mass|dashpot)\.)?(\w+)")


def value_of(scene, path):
    """The number at a path."""
    found = PATH.fullmatch(path)
    if path.startswith("gravity."):
        return getattr(scene.gravity, path.removeprefix("gravity."))
    if found is None:
        return getattr(scene if path == "tension" else scene.rope, path)
    kind, i, of, name = found.groups()
    one = getattr(scene, kind)[int(i)]
    return getattr(one, of)[name] if of else getattr(one, name)


def changed(scene, path, value):
    """The scene with another number at a path."""
    found = PATH.fullmatch(path)
    if path == "tension":
        return scene.replace(tension=value)
    if path.startswith("gravity."):
        change = {path.removeprefix("gravity."): value}
        return scene.replace(gravity=dataclasses.replace(scene.gravity, **change))
    if found is None:
        return scene.replace(rope=scene.rope.replace(**{path: value}))
    kind, i, of, name = found.groups()
    change = {of: {name: value}} if of else {name: value}
    some = list(getattr(scene, kind))
    some[int(i)] = dataclasses.replace(some[int(i)], **change)
    return scene.replace(**{kind: tuple(some)})


def difference(model, path, number, step=1e-3):
    """Of sixth order, of eigenvalues, with the same elements in each span.

    With geometry the seventh derivative is that of waves, (k step)^6/140 = 1e-13 of the first for
    the highest; rounding is 1e-13/step.
    """
    scene = model.scene
    counts = np.diff(np.searchsorted(model.x, stations_of(scene)))
    size = value_of(scene, path)
    total = 0.0
    for k, weight in ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60)):
        for sign in (1, -1):
            other = changed(scene, path, size + sign * k * step * size)
            there = rd.Model(**vars(divided(other, model.element, stations_of(other), counts)))
            total = total + sign * weight * there.modes(number).eigenvalue
    return total / (step * size)


SMOOTH = (
    "bending_stiffness",
    "torsional_stiffness",
    "axial_stiffness",
    "lay_coupling",
    "lay_slope",
    "linear_density",
    "rotary_inertia",
    "polar_inertia",
    "tension",
    "parts[0].mass",
    "parts[0].rotary_inertia",
    "parts[0].polar_inertia",
    "parts[1].stiffness",
    "parts[2].stiffness",
    "parts[3].stiffness",
    "ends[0].spring.beta",
    "ends[1].spring.z",
)
PLACES = ("length", "parts[0].x", "parts[1].x", "parts[4].x")
MODELS = {
    "continuous": {},
    "tensed": {"elements": 12},
    "rigid": {"elements": 12, "element": "rigid"},
}


def is_limit_of_differences(model, modes, path, step):
    """Hold derivatives of eigenvalues against differences over a relative step."""
    slope = modes.derivative(path, of="eigenvalue")
    expected = difference(model, path, len(modes.eigenvalue), step)
    # 1e-13 of the eigenvalue over the step, and what the sixth order leaves
    floor = 3e-13 * modes.eigenvalue.max() / abs(step * value_of(model.scene, path))
    allowed = QUOTIENT * np.abs(expected).max() + floor
    np.testing.assert_allclose(slope, expected, rtol=0, atol=allowed)


@functools.cache
def everything(kind):
    """The model of EVERYTHING and its modes."""
    model = EVERYTHING.compile(**MODELS[kind])
    return model, model.modes(4)


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("path", SMOOTH + PLACES)
def test_derivative_is_what_differences_tend_to(kind, path):
    model, modes = everything(kind)
    is_limit_of_differences(model, modes, path, 1e-3 if path in PLACES else 3e-3)


@pytest.mark.parametrize("path", ["tension", "linear_density", "length", "parts[0].x"])
def test_derivative_of_a_string_with_lumped_masses(path):
    model = STRING.compile(elements=16)
    slope = model.modes(4).derivative(path, of="eigenvalue")
    near(slope, difference(model, path, 4, 1e-3), QUOTIENT)


@pytest.mark.parametrize("tension", [-15.0, -40.0])
def test_derivative_of_elements_beyond_their_load_as_cantilevers(tension):
    """Two elements of T l^2/B = -3.2 and -8.5: a cantilever's critical load is -2.5."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    scene = rd.Scene(rope, tension=tension)
    model = scene.compile(elements=2)
    modes = model.modes(1)
    for path in ("tension", "bending_stiffness", "length"):
        near(modes.derivative(path, of="eigenvalue"), difference(model, path, 1, 3e-3), QUOTIENT)
    stored = BENDING * difference(model, "bending_stiffness", 1, 3e-3) / modes.eigenvalue
    near(modes.energy["bending"], stored, QUOTIENT)


def test_derivative_of_the_study_is_that_of_its_elements():
    model = rd.study2015.scene(mass="rope").compile(elements=8, element="difference")
    modes = model.modes(4)
    for path in ("bending_stiffness", "torsional_stiffness", "lay_slope", "length"):
        near(modes.derivative(path, of="eigenvalue"), difference(model, path, 4, 3e-3), QUOTIENT)


# --- modes that coincide, move rigidly or grow -------------------------------------------------


def test_coinciding_spans_part_when_their_support_moves():
    """f = sqrt(T/mu)/2 l of two halves: one goes up by f/l and one down."""
    scene = rd.Scene(
        rd.Rope(2.0, DENSITY), tension=TENSION, parts=[rd.Support(1.0), rd.Spring(0.5, 100.0)]
    )
    for parts in (scene.parts[:1], (*scene.parts, rd.Spring(1.5, 100.0))):
        modes = scene.replace(parts=parts).compile().modes(4)
        slope = modes.derivative("parts[0].x")
        near(slope[::2], -slope[1::2])
    bare = scene.replace(parts=scene.parts[:1]).compile()
    f = np.arange(1, 3) * np.sqrt(TENSION / DENSITY) / 2
    near(bare.modes(4).derivative("parts[0].x"), np.array([-f[0], f[0], -f[1], f[1]]))
    # the last mode asked for has a partner that was not
    near(bare.modes(3).derivative("parts[0].x"), np.array([-f[0], f[0], -f[1]]))


WAVES = 2 * np.pi
DOUBLE = rd.Scene(
    rd.Rope(1.0, DENSITY, bending_stiffness=BENDING),
    ends=("pinned", "pinned"),
    parts=[rd.Spring(0.5, 4 * BENDING * WAVES**3 / np.tanh(np.pi))],
)
"""A spring in the middle that lifts the first mode of a pinned beam to the second exactly: with
q = 2 pi/L the beam deflects under it by (tan q L/2 - tanh q L/2)/(4 B q^3)."""


def test_double_mode_parts_by_the_projected_derivative():
    """The second one does not feel the spring, the symmetric one does; moved, both mix."""
    modes = DOUBLE.compile().modes(3)
    assert modes.sensitivity.shapes.clusters[0].tolist() == [0, 1]
    stiffer = modes.derivative("parts[0].stiffness", of="eigenvalue")
    # the symmetric shape sin q x + sinh q x/cosh(pi) to the middle
    x, weight = np.polynomial.legendre.leggauss(40)
    x, weight = (x + 1) / 4, weight / 2
    shape = np.sin(WAVES * x) + np.sinh(WAVES * x) / np.cosh(np.pi)
    lifted = np.tanh(np.pi) ** 2 / (DENSITY * weight @ shape**2)
    near(stiffer[:2], np.array([0.0, lifted]))
    moved = modes.derivative("parts[0].x", of="eigenvalue")[:2]
    assert moved[0] == pytest.approx(-moved[1], rel=1e-10)
    # of +-c h + d h^2 + e h^3 .. at two distances: what the sixth order leaves of the split
    split = []
    for h in (1e-4, 2e-4, 3e-4):
        there = DOUBLE.replace(parts=[rd.Spring(0.5 + h, DOUBLE.parts[0].stiffness)])
        split.append(np.diff(there.compile().modes(2).eigenvalue)[0] / (2 * h))
    assert moved[1] == pytest.approx(1.5 * split[0] - 0.6 * split[1] + 0.1 * split[2], rel=1e-8)


def test_bending_and_torsion_that_coincide_part_with_the_lay():
    """dlambda/dH = +-(C^-1 - B^-1) int t m dx of the two, mass 1: S_tb = H (1/C - 1/B)."""
    C = 0.4
    turn, bend = np.pi / 2, np.pi
    p = turn**2 * C * DENSITY / (bend**4 * BENDING)
    rope = rd.Rope(1.0, DENSITY, bending_stiffness=BENDING, torsional_stiffness=C, polar_inertia=p)
    free = rd.End(alpha="free", beta="free")
    modes = rd.Scene(rope.replace(lay_slope=0.0), ends=("pinned", free)).compile().modes(2)
    # t = C turn cos(turn x) sqrt(2/p), m = -B bend^2 sin(bend x) sqrt(2/mu)
    overlap = bend / (bend**2 - turn**2)
    size = C * turn * BENDING * bend**2 * 2 / np.sqrt(p * DENSITY) * overlap
    c = abs(1 / C - 1 / BENDING) * size
    near(modes.derivative("lay_slope", of="eigenvalue"), np.array([-c, c]))


@pytest.mark.parametrize("more", [{}, {"elements": 64}])
def test_rigid_motions_keep_their_frequency(more):
    """But tension turns a free beam back: lambda = T/(mu L^3/12) L."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    modes = rd.Scene(rope, ends=("free", "free")).compile(**more).modes(3)
    for path in ("bending_stiffness", "linear_density", "length"):
        slope = modes.derivative(path)
        assert (slope[:2] == 0).all()
        assert slope[2] != 0
    turned = modes.derivative("tension", of="eigenvalue")
    # the shape of a turn is as exact as its nodes
    assert turned[0] == pytest.approx(0, abs=1e-12 * turned[1])
    assert turned[1] == pytest.approx(12 / (DENSITY * LENGTH**2), rel=EXACT)
    with pytest.raises(rd.SolveError, match=r'mode 2 has the eigenvalue 0.*of="eigenvalue"'):
        modes.derivative("tension")


def test_growth_changes_where_the_frequency_is_zero():
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    tension = -1.5 * BENDING * WAVE[0] ** 2
    modes = rd.Scene(rope, tension=tension, ends=("pinned", "pinned")).compile().modes(2)
    growth = modes.growth[0]
    slope = WAVE[:2] ** 2 / DENSITY
    near(modes.derivative("tension", of="eigenvalue"), slope)
    near(modes.derivative("tension", of="growth"), np.array([-slope[0] / (2 * growth), 0.0]))
    assert modes.derivative("tension")[0] == 0
    assert modes.derivative("tension")[1] > 0


def test_free_hinge_has_the_derivative_of_a_soft_one():
    """The jump is squared, whatever the spring."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    slopes = []
    for stiffness in (0.0, 1e-7):
        scene = rd.Scene(rope, parts=[rd.Hinge(0.4, stiffness=stiffness)])
        slopes.append(scene.compile().modes(3).derivative("parts[0].stiffness"))
    np.testing.assert_allclose(slopes[0], slopes[1], rtol=1e-6)
    scene = scene.replace(parts=[rd.Hinge(0.4), rd.Hinge(0.4)])
    assert (scene.compile().modes(3).derivative("parts[0].stiffness") == 0).all()


def test_no_modes_have_no_derivatives():
    modes = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile().modes(below=1.0)
    assert modes.derivative("tension").shape == (0,)


def test_all_modes_of_a_chain_have_derivatives():
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
    modes = model.modes(7)
    near(modes.derivative("tension"), modes.frequency / 200.0)
    lapack = model.modes(7, solver="lapack")
    near(lapack.derivative("tension"), modes.frequency / 200.0, 1e-11)


# --- what cannot be asked ---------------------------------------------------------------------

MODES = EVERYTHING.compile().modes(2)
LISTED = '"tension", .*"parts\\[0\\].mass".*"ends\\[1\\].spring.z"'


@pytest.mark.parametrize(
    "path",
    [
        "rope.bending_stiffness",
        "bending",
        "",
        "parts",
        "parts[0]",
        "parts[9].mass",
        "parts[4].stiffness",
        "parts[1].coordinate",
        "ends[0].spring.z",
        "ends[0].beta",
        "damping",
    ],
)
def test_unknown_path_names_those_there_are(path):
    with pytest.raises(rd.SceneError, match=LISTED) as refusal:
        MODES.derivative(path)
    assert repr(path) in str(refusal.value)


@pytest.mark.parametrize(
    "path", ["bending_stiffness", "rotary_inertia", "lay_slope", "parts[0].rotary_inertia"]
)
def test_number_that_does_not_act_is_refused(path):
    with pytest.raises(rd.SceneError, match='one of "tension", "torsional_stiffness"'):
        STRING.compile().modes(1).derivative(path)


@pytest.mark.parametrize("path", [None, 1, ("tension",), b"tension"])
def test_path_of_another_type_is_refused(path):
    with pytest.raises(TypeError, match="path must be a string"):
        MODES.derivative(path)


def test_another_quantity_is_refused():
    with pytest.raises(rd.SceneError, match='of must be one of "frequency"'):
        MODES.derivative("tension", of="damping")
    with pytest.raises(TypeError, match="of must be"):
        MODES.derivative("tension", of=None)


@pytest.mark.parametrize("path", ["parts[2].x", "parts[3].x"])
def test_place_of_two_parts_has_no_derivative(path):
    with pytest.raises(rd.SceneError, match=re.escape(path) + " must be a place of its own"):
        MODES.derivative(path)


def test_place_at_an_end_has_no_derivative():
    scene = rd.Scene(
        rd.Rope(1.0, 0.1), tension=100.0, ends=("clamped", "free"), parts=[rd.PointMass(1.0, 0.1)]
    )
    modes = scene.compile().modes(1)
    assert modes.derivative("parts[0].mass")[0] < 0
    with pytest.raises(rd.SceneError, match="at an end of the rope"):
        modes.derivative("parts[0].x")


def test_modes_without_their_model_have_none():
    """As they are when read from a file, which keeps numbers only."""
    with pytest.raises(rd.SceneError, match="compile the scene again"):
        dataclasses.replace(MODES, solve_shapes=None).derivative("tension")
