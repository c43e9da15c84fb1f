"""A laid rope at rest: pulled it turns, pushed aside it twists; closed forms of its section."""

import itertools
import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd

L, EA, C, D, B, H = 2.0, 900.0, 1.5, -20.0, 4.0, 0.3
PULL = 30.0
LAID = rd.Rope(L, 0.1, axial_stiffness=EA, torsional_stiffness=C, lay_coupling=D)
SLOPED = rd.Rope(L, 0.1, bending_stiffness=B, torsional_stiffness=C, lay_slope=H)
TURNS, SLIDES = rd.End(x="free", alpha="free"), rd.End(x="free")
ELEMENTS = [("rigid", 1), ("rigid", 12), ("tensed", 12), ("continuous", None)]
SOLVERS = ["sweep", "band", "lapack"]


def at_rest(scene, load, element, elements, **more):
    model = scene.compile(elements=elements, element=element)
    return model, model.static(load, **more)


def bound(static):
    """Sums of rounded numbers of one sign, node by node, over a section of condition 1 to 2."""
    return EPS * (50 + 2 * len(static.x))


@pytest.mark.parametrize(("element", "n"), ELEMENTS)
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.claim(
    "Stretch and twist of a laid rope that is pulled, free to turn or held: relative error",
    reference="closed form: inverse of [[EA, D], [D, C]]",
    # rods of the assembled solver lose some n^2 eps, with 64 elements 9e-13
    accepted=1e-12,
)
@pytest.mark.parametrize("end", [TURNS, SLIDES], ids=["turns", "held"])
def test_pulled_rope_stretches_and_turns_as_its_section(end, element, n, solver, claim):
    """(F, M) = [[EA, D], [D, C]] (strain, twist rate), with M = 0 or no twist."""
    model, static = at_rest(
        rd.Scene(LAID, ends=("clamped", end)), {("x", L): PULL}, element, n, solver=solver
    )
    assert model.components == (("x", "alpha"),)
    if end is TURNS:
        strain, rate, torque = PULL * C / (EA * C - D**2), -PULL * D / (EA * C - D**2), 0.0
    else:
        strain, rate, torque = PULL / EA, 0.0, D * PULL / EA
    exact = np.outer(static.x, [strain, rate])
    claim(np.abs(static.displacement - exact).max() / np.abs(exact).max())
    # what holds the left end pulls and turns the other way
    claim(np.abs(static.force[0] - [-PULL, -torque]).max() / PULL)
    if end is SLIDES:
        claim(abs(static.force[-1, 1] / torque - 1))
    # between the ends nothing is put on it
    # as the model itself says it: assembled, the sums of a fine chain are of large numbers
    between = np.abs(static.force[1:-1])
    assert (between <= np.maximum(bound(static) * PULL, static.force_rounding_error[1:-1])).all()


@pytest.mark.parametrize(("element", "n"), ELEMENTS)
@pytest.mark.parametrize("place", [0.0, L])
def test_torque_inside_a_pulled_rope_that_cannot_turn_is_that_of_its_lay(element, n, place):
    """M = D F/EA all along; at 0 Hz a response is a static one."""
    model = rd.Scene(LAID, ends=("clamped", SLIDES)).compile(elements=n, element=element)
    response = [("M_alpha", place), ("F_x", place)]
    value = model.frf([0.0], drive=("x", L), response=response).value[:, 0]
    # the sweep's forces are right to hundreds of eps
    np.testing.assert_allclose(value, [D / EA, 1.0], rtol=1e-13)


def test_tension_of_a_scene_is_a_load_like_any_other_for_stretch_and_twist():
    """Small motions about the tensed state do not know how far the tension has turned it."""
    slack, taut = (
        at_rest(
            rd.Scene(LAID.replace(bending_stiffness=B), tension=T, ends=("clamped", TURNS)),
            {("x", L): PULL},
            "tensed",
            4,
        )[1]
        for T in (0.0, PULL)
    )
    np.testing.assert_array_equal(slack.displacement, taut.displacement)


@pytest.mark.parametrize(("element", "n"), [("rigid", 8), ("tensed", 8), ("continuous", None)])
def test_rope_worn_over_a_stretch_turns_as_the_sum_of_its_sections(element, n):
    worn = rd.LocalChange(0.5, 1.25, torsion=0.7)
    scene = rd.Scene(LAID, ends=("clamped", TURNS), parts=[worn])
    _, static = at_rest(scene, {("x", L): PULL}, element, n)
    exact = np.zeros(2)
    for length, c in ((1.25, C), (0.75, 0.7 * C)):
        exact += length * PULL * np.array([c, -D]) / (EA * c - D**2)
    # EA c - D^2 of the worn stretch: 945 - 400
    np.testing.assert_allclose(static.displacement[-1], exact, rtol=2 * bound(static))


def tip(rope):
    """Flexibility of a cantilever's tip over (z, alpha, beta).

    The matrix of the 2015 study, its misprinted sign put right, its section divided by 1 + H^2.
    """
    c, length = 1 / (1 + H**2), rope.length
    bend, twist = c * (H**2 / C + 1 / B), c * (1 / C + H**2 / B)
    both = c * H * (1 / C - 1 / B)
    return np.array(
        [
            [bend * length**3 / 3, both * length**2 / 2, bend * length**2 / 2],
            [both * length**2 / 2, twist * length, both * length],
            [bend * length**2 / 2, both * length, bend * length],
        ]
    )


@pytest.mark.parametrize(("element", "n"), ELEMENTS)
@pytest.mark.claim(
    "Motion of the tip of a cantilever with lay slope under a force across it: relative error",
    reference="closed form: the tip flexibility of the 2015 study",
    # sums of some tens of rounded numbers of one sign
    accepted=1e-14,
)
def test_force_across_a_cantilever_with_lay_slope_twists_it(element, n, claim):
    scene = rd.Scene(SLOPED, ends=("clamped", "free"))
    _, static = at_rest(scene, {("z", L): PULL}, element, n)
    exact = PULL * tip(SLOPED)[:, 0]
    claim(np.abs(static.displacement[-1] / exact - 1).max())
    assert np.sign(static.displacement[-1, 1]) == np.sign(1 / C - 1 / B)
    # no torque: nothing turns the tip
    np.testing.assert_allclose(
        static.force[0], [-PULL, 0.0, -PULL * L], rtol=bound(static), atol=bound(static) * PULL * L
    )


@pytest.mark.parametrize(("element", "n"), ELEMENTS)
def test_cantilever_with_lay_slope_held_from_turning_puts_a_torque_on_its_clamp(element, n):
    """alpha = G_az F + G_aa M = 0: M = -G_az/G_aa F all along."""
    scene = rd.Scene(SLOPED, ends=("clamped", rd.End(z="free", beta="free")))
    model, static = at_rest(scene, {("z", L): PULL}, element, n)
    G = tip(SLOPED)
    torque = -G[1, 0] / G[1, 1] * PULL
    deflection = (G[0, 0] - G[0, 1] ** 2 / G[1, 1]) * PULL
    assert math.isclose(static.displacement[-1, 0], deflection, rel_tol=bound(static))
    np.testing.assert_allclose(static.force[[0, -1], 1], [-torque, torque], rtol=2 * bound(static))
    response = model.frf([0.0], drive=("z", L), response=("M_alpha", 0.0)).value[0, 0]
    # the sweep's forces are right to hundreds of eps
    assert response.real * PULL == pytest.approx(torque, rel=1e-13)


@pytest.mark.parametrize("torsional", [1e-1, 1e-3, 1e-5])
@pytest.mark.parametrize("slope", [0.1, 0.9])
def test_rounding_error_covers_what_a_pulled_rope_that_twists_softly_loses(slope, torsional):
    """Tension lets the rope hardly bend, and the section gives nearly all that way."""
    rope = rd.Rope(
        1.0,
        0.1,
        bending_stiffness=1.0,
        torsional_stiffness=torsional,
        polar_inertia=1e-6,
        lay_slope=slope,
    )
    scene = rd.Scene(rope, tension=1e6)
    cuts = [scene.compile(elements=n, element="continuous").modes(6) for n in (1, 2, 5, 8)]
    for one, other in itertools.combinations(cuts, 2):
        apart = np.abs(one.frequency - other.frequency)
        assert (apart <= one.rounding_error + other.rounding_error).all()


def test_uncoupled_sections_lose_nothing():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=1e-9, polar_inertia=1e-6)
    assert rd.Scene(rope, tension=1.0).compile().chain.section_loss == 1.0
    laid = rd.Scene(rope.replace(lay_slope=1.0), tension=1.0).compile().chain
    # S = c (1/B, 1/C) turned by 45 degrees: 1/det = (1/B + 1/C)^2/(4/B C)
    assert laid.section_loss == pytest.approx((1 + 1e9) ** 2 / 4e9, rel=1e-6)
