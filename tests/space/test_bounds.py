"""What rounding does to answers of ropes on an axis, against numbers of eleven digits more."""

import math
from functools import partial

import numpy as np
import pytest
from support import random_axes, wide_space

import ropedyn as rd
from ropedyn.base import check
from ropedyn.chain.port import Point
from ropedyn.eigen.vectors import within
from ropedyn.space.assembly import assemble
from ropedyn.space.modes import SpaceShapes
from ropedyn.space.response import Request
from ropedyn.space.rope import ALL, unforced
from ropedyn.space.spectrum import Counter, lowest

pytestmark = pytest.mark.skipif(wide_space.DIGITS < 63, reason="wide numbers are no wider here")

WIDE = "the same equations in numbers of 64 binary digits, by parts that are divided elsewhere"
NONE_BEYOND = "of the bound that the answer states, and none may be beyond it"
WIDE_EPS = 2.0**-63
TIGHT = 1 / 16
"""Of 10^4 responses, 10^4 deflections and 10^3 modes errors are 1/8 to 1/12 of it in the median."""


def response_ratios(rng, lines=24):
    """Errors over their bounds: responses from far below the first mode on, six next to modes."""
    scene = random_axes.scene(rng, damped=True)
    model = scene.compile()
    first = math.sqrt(model.rope.unit) / (2 * math.pi)
    f = first * 10 ** rng.uniform(-3, rng.uniform(1, 3), lines)
    near = model.modes(6).frequency * (1 + 10 ** rng.uniform(-14, -3, 6) * rng.choice([-1, 1], 6))
    f[:6] = np.maximum(near, 1e-3 * first)
    points: list[Point] = [
        (str(rng.choice(model.coordinates)), rng.uniform(0, scene.rope.length)) for _ in range(3)
    ]
    try:
        frf = model.frf(np.sort(f), drive=points)
    except rd.SolveError:  # within rounding of a resonance, as some lines 1e-14 beside one are
        return np.zeros(0)
    asked = Request.of(scene, model.rope, frf.frequency, frf.drive, frf.response)
    exact = wide_space.receptance(asked)
    error = np.abs(frf.value - exact).astype(float)
    # what cannot move has in wide numbers what is left of those that do
    error[error <= 4 * WIDE_EPS * np.abs(exact).max(axis=(0, 1))] = 0.0
    assert (error[frf.rounding_limit == 0] == 0).all()
    return (error / np.where(frf.rounding_limit > 0, frf.rounding_limit, 1.0))[exact != 0]


def mode_ratios(rng, number=8, scene=random_axes.scene):
    """Errors over their bounds: eigenvalues that lie apart from others."""
    scene = scene(rng)
    rope = scene.compile().rope
    found = lowest(rope, number, math.inf)
    bound = SpaceShapes(scene, rope, found.eigenvalue, found, 1).unsure()
    ratios = []
    for k in range(len(rope.own)):
        own = np.flatnonzero(found.component == k)
        value = found.eigenvalue[own]
        gaps = np.concatenate([[math.inf], np.diff(value), [math.inf]])
        alone = np.minimum(gaps[:-1], gaps[1:]) > 1e-5 * np.abs(value)
        alone &= np.abs(value) > 1e-6 * rope.unit
        if alone.any():
            exact = wide_space.eigenvalues(rope, k, value[alone])
            error = np.abs(exact - value[alone]).astype(float)
            ratios.append(error / bound[own][alone])
    return np.concatenate(ratios) if ratios else np.zeros(0)


def static_ratios(rng, points=2):
    """Errors over their bounds: displacements, and forces of what is held and of what is not."""
    scene = random_axes.scene(rng)
    model, length = scene.compile(), scene.rope.length
    loads = {
        (str(rng.choice(model.coordinates)), rng.uniform(0, length)): rng.uniform(-1, 1)
        for _ in range(3)
    }
    try:
        found = model.static(loads, points=points)
    except rd.SolveError:  # a rigid motion is free, or it buckles
        return np.zeros(0)
    x = np.concatenate([within(model.rope.x, points), [at for _, at in loads]])
    cut, _ = model.rope.cut(x, check.NEAR * length)
    ratios = []
    for value, bound, exact in zip(
        (found.displacement, found.force),
        (found.rounding_error, found.force_rounding_error),
        wide_space.deflection(cut, loads),
    ):
        error = np.abs(value - exact[:, ~cut.absent]).astype(float)
        there = bound > 0
        assert (error[~there] == 0).all()
        ratios.append(error[there] / bound[there])
    return np.concatenate(ratios)


def some(ratios_of, number, seed):
    """So many ratios of scenes one after another."""
    rng, found = np.random.default_rng(seed), np.zeros(0)
    while len(found) < number:
        found = np.concatenate([found, ratios_of(rng)])
    return found


def test_bounds_of_responses_cover_what_rounding_does():
    found = some(response_ratios, 1000, 0)
    assert found.max() < 1
    assert np.median(found) > TIGHT


def test_bounds_of_modes_cover_what_rounding_does():
    found = some(mode_ratios, 60, 1)
    assert found.max() < 1
    assert np.median(found) > TIGHT


def test_bounds_of_deflections_cover_what_rounding_does():
    found = some(static_ratios, 1000, 4)
    assert found.max() < 1
    assert np.median(found[found > 0]) > TIGHT


@pytest.mark.parametrize("aside", [3e-4, 1e-7])
def test_a_corner_passes_on_the_little_that_it_leaves(aside):
    # 1 + D of a turn that is nearly right has roundings of 1, the same however numbers are moved
    axis = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1 + aside, 0.2, 1]])
    rope = rd.Rope(axis, 0.2, bending_stiffness=40.0, torsional_stiffness=10.0, axial_stiffness=1e7)
    model = rd.Scene(rope, planes="both", ends=("free", "clamped")).compile()
    loads: dict[Point, float] = {("z", 1.3): -0.4, ("y", 0.2): 1.0}
    found = model.static(loads, points=2)
    cut, _ = model.rope.cut(found.x, check.NEAR * rope.length)
    exact = wide_space.deflection(cut, loads)[0][:, ~cut.absent]
    assert (np.abs(found.displacement - exact) <= found.rounding_error).all()


def test_a_line_within_what_rounding_does_to_a_mode_is_refused_or_infinite():
    rope = rd.Rope(rd.Axis.arc(2.0, 4.0), 0.5, bending_stiffness=2.0, torsional_stiffness=1.0)
    model = rd.Scene(rope, planes="both").compile()
    modes = model.modes(6)
    for f, off in zip(modes.frequency, modes.rounding_error):
        drive = ("z" if modes.plane[modes.frequency == f] == "z" else "y", 2.3)
        assert 0 < model.frf([f + 20 * off], drive=drive).rounding_error < 0.1
        try:
            frf = model.frf([0.5 * f, f + 5 * off], drive=drive)
        except rd.SolveError:
            continue
        assert np.isfinite(frf.rounding_limit).tolist() == [[True, False]]


def test_bounds_of_ropes_under_torque_cover_what_rounding_does():
    found = some(partial(mode_ratios, scene=random_axes.twisted), 60, 3)
    assert found.max() < 1


def test_no_part_is_longer_than_a_quarter_wave():
    # beyond its own resonance entries of a part lose the digits that the bounds say they have
    rope = rd.Rope(rd.Axis.arc(1e9, 2e-9), 0.5, axial_stiffness=1e9)
    own = rd.Scene(rope, planes="both", tension=100.0).compile().rope
    which, radians = np.array([1]), np.geomspace(1.0, 300.0, 200)  # across: a string of 2 m
    for value in (radians / 2) ** 2 * 100.0 / 0.5:
        lines = unforced([value])
        parts = assemble(own, which, lines, own.scale(which, [value])).parts
        assert math.sqrt(value * 0.5 / 100.0) * 2 / parts < math.pi / 2


@pytest.mark.slow
@pytest.mark.claim(
    "10^4 responses of random ropes on an axis, a quarter next to modes: error over its bound",
    reference=WIDE,
    accepted=1.0,
    wide=NONE_BEYOND,
)
def test_bounds_of_many_responses_cover_what_rounding_does(claim):
    found = some(response_ratios, 10_000, 100)
    assert np.median(found) > TIGHT
    claim(found.max())


@pytest.mark.slow
@pytest.mark.claim(
    "10^4 displacements and forces of deflections of random ropes on an axis: error over its bound",
    reference=WIDE,
    accepted=1.0,
    wide=NONE_BEYOND,
)
def test_bounds_of_many_deflections_cover_what_rounding_does(claim):
    found = some(static_ratios, 10_000, 102)
    assert np.median(found[found > 0]) > TIGHT
    claim(found.max())


@pytest.mark.slow
@pytest.mark.claim(
    "1000 modes of random ropes on an axis: largest error over its bound",
    reference=WIDE,
    accepted=1.0,
    wide=NONE_BEYOND,
)
def test_bounds_of_many_modes_cover_what_rounding_does(claim):
    found = some(mode_ratios, 1000, 101)
    assert np.median(found) > TIGHT
    claim(found.max())


def counts_contradict(rng):
    """How many of four counts are not those of the rope cut elsewhere, or of six coordinates."""
    scene = random_axes.scene(rng)
    rope, length = scene.compile().rope, scene.rope.length
    value = rope.unit * 10 ** rng.uniform(-1, 7, 4) * rng.choice([1.0, 1.0, 1.0, -1e-3], 4)
    cut, _ = rope.cut(length * rng.uniform(0, 1, rng.integers(1, 4)), 1e-9 * length)
    whole = scene.compile().rope
    vars(whole)["own"] = ALL
    wanted, *others = (Counter(one).total(value.tolist()) for one in (rope, cut, whole))
    return sum(a != b for other in others for a, b in zip(other, wanted))


def test_counts_are_those_of_other_cuts_and_of_all_coordinates():
    rng = np.random.default_rng(2)
    assert sum(counts_contradict(rng) for _ in range(60)) == 0


@pytest.mark.slow
@pytest.mark.claim(
    "10^4 counts of 2500 random ropes on an axis, pulled, pushed and twisted, up to some 10^3 "
    "modes: how many are not those of the same rope cut elsewhere, or of all six coordinates",
    reference="parts of other lengths, joints elsewhere, matrices of the other width",
    accepted=0.0,
)
def test_many_counts_are_those_of_other_cuts_and_of_all_coordinates(claim):
    rng = np.random.default_rng(7)
    claim(sum(counts_contradict(rng) for _ in range(2500)))


def test_a_rigid_motion_has_a_bound_that_says_how_much_is_left():
    # 0.001 of the first mode of a free rope, where its stiffness is a millionth of roundings of 1
    rope = rd.Rope(
        rd.Axis.points([[0, 0, 0], [1, 0, 0.3], [1, 0, 1], [0.4, 0, 2]]),
        0.7,
        bending_stiffness=7.0,
        torsional_stiffness=3.0,
    )
    model = rd.Scene(rope, planes="both", ends=("free", "free")).compile()
    frf = model.frf([1e-3, 1e-2], drive=("z", 0.5))
    asked = Request.of(model.scene, model.rope, frf.frequency, frf.drive, frf.response)
    error = np.abs(frf.value - wide_space.receptance(asked)[0]).astype(float)
    assert (error < frf.rounding_limit).all()
    assert (frf.rounding_error < 1e-3).all()
