"""Hinges: Gerber beams, springs in series, and the same answer from every solver."""

import dataclasses
import math

import exact_mixed
import mpmath
import numpy as np
import pytest
from conftest import EPS, slow
from mpmath import mpf

import ropedyn as rd
from ropedyn import _core

L, B, MU = 2.0, 4.0, 0.3
ROPE = rd.Rope(L, MU, bending_stiffness=B)
SOLVERS = ["sweep", "band", "lapack"]
ELEMENTS = ["difference", "rigid", "tensed"]
BEAMS = ["rigid", "tensed"]


def hinged(x=L / 2, stiffness=0.0, *, rope=ROPE, parts=(), **more):
    return rd.Scene(rope, parts=[rd.Hinge(x, stiffness=stiffness), *parts], **more)


def digits(elements):
    """Relative error of an assembled beam: 50 (n/pi)^4 times a few eps."""
    return 200 * EPS * max(elements / math.pi, 1) ** 4


# textbook ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("element", BEAMS)
@pytest.mark.parametrize("n", [2, 8, 30])
def test_two_cantilevers_meet_at_a_free_hinge(n, element, solver):
    # each carries half: z = (F/2) (L/2)^3/3B, tips turn by -+ (F/2) (L/2)^2/2B
    static = (
        hinged().compile(elements=n, element=element).static({("z", L / 2): 1.0}, solver=solver)
    )
    middle = static.displacement[n // 2]
    assert middle[0] == pytest.approx(L**3 / (48 * B), rel=digits(n))
    # the node is on the left
    assert middle[1] == pytest.approx(L**2 / (16 * B), rel=digits(n))
    # moments at the clamps F L/4, forces F/2
    np.testing.assert_allclose(static.force[0], [-0.5, -L / 4], rtol=4 * digits(n))
    np.testing.assert_allclose(static.force[-1], [-0.5, L / 4], rtol=4 * digits(n))
    # nothing from outside between, but the load
    expected = np.zeros((n - 1, 2))
    expected[n // 2 - 1, 0] = 1.0
    np.testing.assert_allclose(static.force[1:-1], expected, atol=n * digits(n))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("element", BEAMS)
@pytest.mark.parametrize("k", [1e-9, 0.3, 7.0, 1e6, 1e15, 1e300])
def test_spring_across_the_hinge_of_a_pinned_beam_adds_its_compliance(k, element, solver):
    # moment F L/4 at the middle: z = F L^3/48B + (L/4)^2 F/k; tension 0
    scene = hinged(stiffness=k, ends=("pinned", "pinned"))
    static = scene.compile(elements=6, element=element).static({("z", L / 2): 1.0}, solver=solver)
    exact = L**3 / (48 * B) + (L / 4) ** 2 / k
    # a soft hinge leaves a mechanism, and its stiffness is small beside 3 B/l = 36: the mixed form
    # alone holds the compliance itself
    bound = digits(6) * (1 + 36 / k if solver != "band" else 1)
    assert static.displacement[3, 0] == pytest.approx(exact, rel=bound)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("element", ELEMENTS)
def test_stiff_hinge_is_none(element, solver):
    # 1e20 N m beside B/l = 20: a change of 1e-19
    scene = rd.Scene(ROPE, tension=0.0, ends=("clamped", "pinned"))
    stiff = scene.replace(parts=[rd.Hinge(0.75, stiffness=1e20)])
    # a station where the hinge stands, with nothing there
    none = scene.replace(parts=[rd.PointMass(0.75, 0.0)])
    f = [0.0, 3.0, 40.0]
    points = [("z", 0.75), ("beta", 0.4), ("z", 1.6)]
    one, other = (
        s.compile(elements=8, element=element).frf(f, drive=points, solver=solver).value
        for s in (stiff, none)
    )
    # condition of the response at 40 Hz, a few tens, times n^4/10 where assembled
    np.testing.assert_allclose(one, other, rtol=3e-11)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("T", [3.0, 50.0, 5000.0])
def test_tensed_hinge_is_two_tensed_cantilevers(T, solver):
    # each half: z = (F/2) (l - tanh(kl)/k)/T, l = L/2, k = sqrt(T/B): exact in tensed elements
    static = hinged(tension=T).compile(elements=4, element="tensed")
    z = static.static({("z", L / 2): 2.0}, solver=solver).displacement[2, 0]
    k, half = math.sqrt(T / B), L / 2
    assert z == pytest.approx((half - math.tanh(k * half) / k) / T, rel=digits(4))


# internal forces ---------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", ["sweep", "band"])
@pytest.mark.parametrize("element", BEAMS)
@pytest.mark.parametrize("tension", [0.0, 60.0])
def test_free_hinge_carries_no_moment(tension, element, solver):
    scene = hinged(0.5, tension=tension, ends=("clamped", "clamped"))
    model = scene.compile(elements=8, element=element)
    f = [0.0, 2.0, 25.0]
    frf = model.frf(f, drive=("z", 1.0), response=[("M_beta", 0.5), ("M_beta", 0.0)], solver=solver)
    moment, clamp = np.abs(frf.value)
    # the largest moment is the scale: absolute rounding of a force that is a sum of such
    assert (moment <= 1e-12 * clamp).all()


@pytest.mark.parametrize("solver", ["sweep", "band"])
def test_moment_of_the_spring_is_its_stiffness_times_the_jump(solver):
    # right side of the hinge from the right part: with T = 0 and no mass between, statically
    # beta_right = beta_left + M/k; a pinned beam loaded at 3/4 L has M = F (L/4) x/L at x
    k = 5.0
    model = hinged(stiffness=k, ends=("pinned", "pinned")).compile(elements=4, element="rigid")
    points = [("M_beta", L / 2), ("beta", L / 2), ("beta", L / 2 + 1e-6 * L), ("z", L)]
    frf = model.frf(0.0, drive=("z", 0.75 * L), response=points, solver=solver)
    moment, left, right, _ = frf.value[:, 0].real
    assert abs(moment) == pytest.approx(L / 8, rel=1e-13)
    # beta just right of it, in the element's own shape, 1e-6 of curvature away
    assert abs(right - left) == pytest.approx(L / 8 / k, rel=1e-5)


# every solver against the exact discrete system --------------------------------------------------

WIDE = rd.Rope(
    L, MU, bending_stiffness=B, torsional_stiffness=1.5, lay_slope=0.3, polar_inertia=1e-3
)


@pytest.mark.parametrize("damping", [*slow(None), 1e-4], ids=["undamped", "damped"])
@pytest.mark.parametrize("stiffness", [0.0, 2.0])
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("rope", [ROPE, WIDE], ids=["plane", "laid"])
def test_hinged_chain_responds_as_the_exact_discrete_one(rope, element, stiffness, damping):
    tension = 0.0 if element == "difference" else 25.0
    parts = [
        rd.Hinge(1.5),
        rd.PointMass(1.5, 0.4, rotary_inertia=0.01),
        rd.Spring(0.6, 4.0, coordinate="beta"),
        rd.Support(1.1),
    ]
    scene = hinged(0.6, stiffness, rope=rope, parts=parts, tension=tension)
    if damping:
        scene = scene.replace(damping=rd.StiffnessDamping(damping))
    model = scene.compile(elements=8, element=element)
    x, f = model.x.tolist(), 17.0
    component = model.component_of("z")
    left, right = (int(np.abs(model.x - at).argmin()) for at in (0.6, 1.5))
    places = [("z", left), ("beta", left), ("z", right), ("beta", right), ("z", 2)]
    points = [(c, x[node]) for c, node in places]
    with mpmath.workdps(40):
        omega = 2 * mpmath.pi * mpf(f)
        g = 1 + 1j * omega * mpf(damping or 0)
        exact = exact_mixed.Exact(model, component, omega, (g, 1, g)).solve(left, "z")
        for solver in SOLVERS:
            frf = model.frf(f, drive=("z", x[left]), response=points, solver=solver)
            for k, (c, node) in enumerate(places):
                h = exact.motion(node, c)
                if h == 0:
                    # a free hinge of the study's kinematics, which has no lever, passes nothing on
                    assert abs(frf.value[k, 0]) < 1e-15 * abs(complex(exact.motion(left, "z")))
                    continue
                error = float(abs(mpmath.mpmathify(complex(frf.value[k, 0])) / h - 1))
                assert error <= frf.rounding_error[k, 0], (solver, points[k])
                # the condition of these answers is below 1e3, a useful bound within 1e4 of that
                assert frf.rounding_error[k, 0] <= 1e7 * EPS


@pytest.mark.parametrize("element", ELEMENTS)
def test_points_inside_a_hinged_element_agree(element):
    # the element right of the hinge is pushed and watched between its nodes
    tension = 0.0 if element == "difference" else 25.0
    model = hinged(0.5, 1.5, tension=tension).compile(elements=4, element=element)
    points = [("z", 0.5), ("z", 0.7), ("beta", 0.9), ("z", 1.2), ("beta", 0.2)]
    f = [0.0, 5.0, 33.0]
    values = [model.frf(f, drive=points, response=points, solver=s).value for s in SOLVERS]
    for value in values:
        # reciprocity
        np.testing.assert_allclose(
            value, value.transpose(1, 0, 2), atol=1e-11 * np.abs(value).max()
        )
        np.testing.assert_allclose(value, values[0], atol=1e-11 * np.abs(value).max())


@pytest.mark.parametrize("element", BEAMS)
@pytest.mark.parametrize("stiffness", [0.0, 1.5])
def test_static_point_inside_a_hinged_element_is_as_the_node_there(element, stiffness):
    # rigid and tensed elements without tension are exact: a node there changes nothing
    coarse = hinged(0.5, stiffness)
    fine = coarse.replace(parts=[*coarse.parts, rd.PointMass(0.7, 0.0), rd.PointMass(0.9, 0.0)])
    points = [("z", 0.7), ("beta", 0.9), ("z", 0.5), ("beta", 0.7)]
    one, other = (
        s.compile(elements=n, element=element).frf(0.0, drive=points, solver="band").value
        for s, n in ((coarse, 4), (fine, 6))
    )
    np.testing.assert_allclose(one, other, atol=1e-12 * np.abs(other).max())


def test_long_runs_stop_at_a_hinge():
    # 4000 elements: pieces are joined by doubling on both sides of the hinge, not across
    model = hinged(0.8, 3.0, tension=30.0).compile(elements=4000, element="tensed")
    factor = np.array(
        [[1.0], [1.0], [1.0], [-((2 * np.pi * 90.0) ** 2)], [180j * np.pi]], dtype=complex
    )
    assert _core.steps(model.chain, factor) < 100
    f = [1.0, 20.0, 90.0]
    drive, response = ("z", 0.4), [("z", 0.4), ("beta", 1.5), ("M_beta", 1.2)]
    sweep, band = (
        model.frf(f, drive=drive, response=response, solver=s) for s in ("sweep", "band")
    )
    allowed = (sweep.rounding_error + band.rounding_error) * np.abs(sweep.value)
    assert (np.abs(sweep.value - band.value) <= allowed).all()
    assert sweep.rounding_error.max() < 1e-9


# modes -------------------------------------------------------------------------------------------


def gerber(n, element):
    ends = ("clamped", "clamped")
    return hinged(ends=ends).compile(elements=n, element=element)


def test_modes_of_a_free_middle_hinge_are_those_of_cantilevers():
    # symmetric: two clamped-free halves, symmetric; antisymmetric: two clamped-pinned
    roots = np.array([1.8751040687119611, 3.9266023120479186, 4.6940911329741745])
    exact = roots**2 * math.sqrt(B / (MU * (L / 2) ** 4)) / (2 * math.pi)
    previous = None
    for n in (16, 32):
        frequency = gerber(n, "rigid").modes(3).frequency
        error = np.abs(frequency / exact - 1)
        # second order: about (k l)^2 times 1/10
        assert error.max() < 5 * (2 / n) ** 2
        if previous is not None:
            assert (error < 0.3 * previous).all()
        previous = error


@pytest.mark.parametrize(
    ("support", "order", "root"), [(True, 4, 3.9266023120479186), (False, 2, 1.8751040687119611)]
)
def test_tensed_lumping_is_of_fourth_order_only_where_the_hinge_is_held(support, order, root):
    # held: two clamped-pinned spans. Moving: the slope right of it is no coordinate of the node,
    # and its share mu h^2/12 of the Euler-Maclaurin correction is missing
    exact = root**2 * math.sqrt(B / (MU * (L / 2) ** 4)) / (2 * math.pi)
    parts = [rd.Support(L / 2)] if support else []
    error = [
        abs(
            hinged(parts=parts).compile(elements=n, element="tensed").modes(1).frequency[0] / exact
            - 1
        )
        for n in (16, 32)
    ]
    # the next order's share is a few (k l)^2 = 1/16
    assert math.log2(error[0] / error[1]) == pytest.approx(order, abs=0.2)


@pytest.mark.parametrize("stiffness", [0.5, 6.0])
@pytest.mark.parametrize("element", ELEMENTS)
def test_energies_sum_to_one_and_the_spring_has_its_share(element, stiffness):
    tension = 0.0 if element == "difference" else 25.0
    model = hinged(0.6, stiffness, tension=tension).compile(elements=10, element=element)
    modes = model.modes(4)
    strain = [modes.energy[k] for k in ("bending", "tension", "spring") if k in modes.energy]
    np.testing.assert_allclose(np.sum(strain, axis=0), 1, rtol=1e-9)
    # d ln lambda/d ln k by Hellmann and Feynman, differences of 1e-4: their square and cube
    step = 1e-4
    moved = [
        hinged(0.6, stiffness * math.exp(s), tension=tension)
        .compile(elements=10, element=element)
        .modes(4)
        .eigenvalue
        for s in (-step, step)
    ]
    share = np.log(moved[1] / moved[0]) / (2 * step)
    np.testing.assert_allclose(modes.energy["spring"], share, atol=1e-6)


def test_free_hinge_has_no_energy():
    energy = gerber(8, "tensed").modes(3).energy
    assert "spring" not in energy or (energy["spring"] == 0).all()


# what stands with it -----------------------------------------------------------------------------


def test_two_hinges_at_one_place_are_springs_in_series():
    two = rd.Scene(ROPE, parts=[rd.Hinge(0.5, stiffness=3.0), rd.Hinge(0.5, stiffness=6.0)])
    one = hinged(0.5, 2.0)
    a, b = (s.compile(elements=4).frf(7.0, drive=("z", 0.5), solver="sweep") for s in (two, one))
    assert a.value == pytest.approx(b.value, rel=16 * EPS)
    free = rd.Scene(ROPE, parts=[rd.Hinge(0.5, stiffness=3.0), rd.Hinge(0.5)])
    assert np.isinf(free.compile(elements=4).chain.hinge).sum() == 1


@pytest.mark.parametrize("solver", SOLVERS)
def test_support_of_the_rotation_holds_the_left_side(solver):
    # left of it a clamped-clamped half, right of it pinned: z held too
    parts = [rd.Support(L / 2), rd.Support(L / 2, coordinate="beta")]
    model = hinged(parts=parts).compile(elements=8, element="rigid")
    half = L / 2
    value = model.frf(0.0, drive=[("z", L / 4), ("z", 3 * L / 4)], solver=solver).value[..., 0].real
    assert value[0, 0] == pytest.approx(half**3 / (192 * B), rel=digits(8))
    # clamped-pinned: 7 F l^3/768 B
    assert value[1, 1] == pytest.approx(7 * half**3 / (768 * B), rel=digits(8))
    assert value[0, 1] == pytest.approx(0, abs=1e-14)


# description -------------------------------------------------------------------------------------


def test_scene_without_hinge_has_no_hinge_array():
    scene = hinged()
    assert scene.effects == ("bending", "hinge")
    assert scene.compile(elements=4).chain.hinge is not None
    bare = scene.without("hinge")
    assert bare.effects == ("bending",)
    assert bare.compile(elements=4).chain.hinge is None
    # it goes with what it stands on
    twisting = scene.replace(rope=WIDE, tension=5.0).without("bending")
    assert twisting.parts == ()


def test_component_that_does_not_bend_has_no_hinge():
    model = hinged(rope=WIDE.replace(lay_slope=None)).compile(elements=4)
    assert model.components == (("z", "beta"), ("alpha",))
    assert model.chain.only(("alpha",)).hinge is None
    assert model.chain.only(("z", "beta")).hinge is not None


def test_hinge_comes_back_from_its_file(tmp_path):
    scene = rd.Scene(ROPE, parts=[rd.Hinge(0.5), rd.Hinge(1.0, stiffness=2.5)])
    scene.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == scene


@pytest.mark.parametrize("x", [0.0, L, 1e-10, L - 1e-10])
def test_hinge_at_an_end_is_refused_with_what_to_say(x):
    with pytest.raises(rd.SceneError, match=r'parts\[0\]\.x must lie between .* End\(beta="free"'):
        hinged(x)


def test_hinge_of_a_string_is_refused():
    with pytest.raises(rd.SceneError, match="coordinate of a hinge must be one the scene has"):
        hinged(rope=rd.Rope(L, MU), tension=3.0)


@pytest.mark.parametrize("stiffness", [-1.0, math.nan, math.inf])
def test_stiffness_that_is_no_stiffness_is_refused(stiffness):
    with pytest.raises(rd.SceneError, match=r"stiffness must be .*\[N m\], got"):
        rd.Hinge(0.5, stiffness=stiffness)


def test_hinge_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        rd.Hinge(0.5).stiffness = 3.0
