"""Which mode each peak is: chances, evidence, and whole numberings of made ropes."""

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from numbered_ropes import BOTH, made, mixed, tally
from scipy.integrate import quad
from scipy.stats import multivariate_t
from tensed_beam import frequencies

import ropedyn as rd
from ropedyn.experiment.orders.chances import EXCITED, Chances, _seen
from ropedyn.experiment.orders.evidence import FREEDOM, Evidence
from ropedyn.experiment.orders.lattice import Lattice
from ropedyn.experiment.orders.numbering import Numbering, decided, numberings
from ropedyn.experiment.orders.search import SortedPeaks, _around
from ropedyn.experiment.orders.sensed import FAINT, Sensed
from ropedyn.experiment.orders.standardised import Standardised

LENGTH, DENSITY, TENSION, BENDING = 20.0, 5.0, 1e5, 2e3
"""T L^2/B = 2e4."""
ROPE = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
SCENE = rd.Scene(ROPE, tension=TENSION, ends=("pinned", "clamped"))
EXACT = 1e-12
"""Relative: some hundred rounded operations."""


def exact(count, springs=(0.0, math.inf)):
    return frequencies(
        count, length=LENGTH, density=DENSITY, tension=TENSION, bending=BENDING, springs=springs
    )


def noisy(frequency, noise=1e-3, seed=5):
    return frequency * (1 + noise * np.random.default_rng(seed).standard_normal(len(frequency)))


def numbered(peaks, scene=SCENE, unknown=BOTH, noise=1e-3, **more):
    peaks = np.asarray(peaks)
    return numberings(scene, unknown, peaks, noise * peaks, **more)


# --- the forward models -----------------------------------------------------------------------


@pytest.mark.parametrize("springs", [(0.0, 0.0), (math.inf, math.inf), (30.0, 5e3)])
def test_the_determinant_and_the_library_have_the_same_frequencies(springs):
    family = SCENE.family(["ends[0].spring.beta", "ends[1].spring.beta"])
    # the root of the determinant is found to 1e-11 of k L = 3
    np.testing.assert_allclose(
        family.modes([springs], 12).frequency[0], exact(12, springs), rtol=1e-11
    )


@pytest.mark.parametrize("any_ends", [True, False])
def test_a_common_factor_of_all_stiffness_moves_all_modes_alike(any_ends):
    standardised = Standardised.of(SCENE, BOTH, {}, any_ends=any_ends)
    along = standardised.common(10)
    here, there = standardised(np.array([0 * along, 0.7 * along]), 10)[0]
    np.testing.assert_allclose(there - here, 0.35, rtol=1e-9)


def test_known_stiffness_leaves_no_common_factor():
    """Neither does a rope on a known spring, but a mass does."""
    mass = SCENE.replace(parts=[rd.PointMass(3.0, 2.0)])
    spring = SCENE.replace(parts=[rd.Spring(3.0, 1e4)])
    for scene, unknown, there in (
        (SCENE, ("tension",), False),
        (spring, BOTH, False),
        (mass, BOTH, True),
    ):
        found = Standardised.of(scene, unknown, {}, any_ends=True).common(10)
        assert (found is not None) == there


def test_a_prior_is_log_normal_by_its_moments():
    standardised = Standardised.of(SCENE, BOTH, {"tension": (8e4, 4e4)}, any_ends=False)
    v = np.zeros((20001, 2))
    v[:, 0] = np.linspace(-10, 10, len(v))
    weight = np.exp(-0.5 * v[:, 0] ** 2) / np.sqrt(2 * np.pi) * 1e-3
    tension = standardised.value(v)[:, 0]
    # the trapezoidal rule is exact for a normal density; beyond 10 deviations there is 1e-19
    assert weight @ tension == pytest.approx(8e4, rel=1e-10)
    assert weight @ (tension - 8e4) ** 2 == pytest.approx(4e4**2, rel=1e-10)


def test_what_a_prior_says_of_numbers_together_is_said_in_the_search():
    std = np.array([4e4, 300.0])
    known = {"tension": (8e4, 4e4), "bending_stiffness": (2e3, 300.0)}
    prior = rd.Prior(known, covariance=[[1, 0.8], [0.8, 1]] * np.outer(std, std))
    standardised = Standardised.of(SCENE, BOTH, prior, any_ends=True)
    S = standardised.mixing @ standardised.mixing.T
    of_prior = prior.law.spread @ prior.law.spread.T
    np.testing.assert_allclose(S[:2, :2], of_prior, rtol=1e-12)
    # of springs c sqrt(T B) half of it
    np.testing.assert_allclose(S[2:, :2], [of_prior.sum(axis=0) / 2] * 2, rtol=1e-12)
    weight = np.random.default_rng(6).standard_normal((200_000, 4))
    rows = standardised.value(weight)
    # standard errors of 2e5 draws, 5 of them
    np.testing.assert_allclose(np.corrcoef(rows[:, :2].T)[0, 1], 0.8, atol=5 * 0.6 / 447)


# --- chances ----------------------------------------------------------------------------------


def test_what_can_be_seen_has_the_probability_one():
    """Over all subsets of six modes; more are excited with the probability g^6."""
    seen = np.array(list(itertools.product([False, True], repeat=6)))
    visible = np.array([0.9, 0.2, 1.0, 0.02, 0.7, 1.0])
    assert _seen(seen, visible).sum() == pytest.approx(1 - EXCITED**6, rel=EXACT)


def test_probabilities_of_all_that_is_seen_do_not_exceed_one():
    orders = [
        [*one, *[0] * (8 - size)]
        for size in range(9)
        for one in itertools.combinations(range(1, 9), size)
    ]
    chances = Chances(np.ones(8), 1.0, np.zeros((8, 8)))
    total = np.exp(chances.detection(np.array(orders))).sum()
    assert 1 - 2 * EXCITED**8 < total <= 1


@pytest.mark.parametrize("orders", [[1, 2, 3, 4, 0], [1, 2, 0, 0, 0]])
def test_strays_have_the_density_of_a_poisson_process_of_unknown_rate(orders):
    chances, m = Chances(np.ones(6), 1.7, np.zeros((5, 6))), orders.count(0)
    density, _ = quad(lambda r: np.exp(-2 * r) * (r / 1.7) ** m, 0, np.inf)
    rows = np.array([orders])
    found = chances(rows)[0] - chances.detection(rows)[0]
    # the rule of Gauss and Kronrod asks for 1.5e-8
    assert found == pytest.approx(np.log(density), abs=1.5e-8)


def test_a_mode_at_whose_node_all_sensors_are_is_rarely_seen():
    pinned = SCENE.replace(ends=("pinned", "pinned"))
    visible = Sensed.of(pinned, [("z", LENGTH / 2)], 6).visible
    np.testing.assert_allclose(visible, [1, FAINT] * 3, rtol=EXACT)


def test_shapes_are_those_of_modes_wherever_the_sensors_are():
    x = np.array([0.2, 0.35, 0.6]) * LENGTH
    sensed = Sensed.of(SCENE.replace(ends=("pinned", "pinned")), [("z", one) for one in x], 8)
    shape = -3.0 * np.sin(np.outer(np.arange(1, 9), np.pi * x / LENGTH))
    likeness = sensed.likeness(shape)
    assert (likeness.argmax(axis=1) == np.arange(8)).all()
    # 2 ln(1/(0.06 sqrt(2 pi))) + ln(2 pi), of a hundred 99
    best = -np.log(2 * np.pi * 0.06**2) + np.log(2 * np.pi) + np.log(0.99)
    np.testing.assert_allclose(np.diag(likeness), best, atol=1e-3)


# --- evidence ---------------------------------------------------------------------------------


@pytest.mark.parametrize("orders", [[1, 2, 3, 4, 5], [1, 2, 0, 4, 5]])
def test_evidence_is_the_integral_over_tension_and_stiffness(orders):
    """Ends given, by the trapezoidal rule along the axes of the maximum."""
    peaks, orders = noisy(exact(5)), np.array(orders)
    standardised = Standardised.of(SCENE, BOTH, {}, any_ends=False)
    std, rows = np.full(5, 1e-3), orders[None]
    found = Evidence.of(standardised, np.log(peaks), std, rows, np.zeros((1, 2)))
    used = orders > 0
    at, v = orders[used] - 1, found.v[0]
    slope = standardised(v[None], 5)[1][0, at] / 1e-3
    axes = np.linalg.cholesky(np.linalg.inv(np.eye(2) + slope.T @ slope))
    step = 0.1
    line = np.arange(-12, 12, step)
    there = v + np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2) @ axes.T
    off = standardised(there, 5)[0][:, at] - np.log(peaks[used])
    density = multivariate_t.pdf(off, shape=np.diag(std[used] ** 2), df=FREEDOM)
    known = np.exp(-0.5 * np.einsum("np,np->n", there, there)) / (2 * np.pi)
    integral = (density * known).sum() * step**2 * np.linalg.det(axes)
    # Student's tails beside the parabola of Laplace's method: 0.17 and 0.18
    assert found.likelihood[0] == pytest.approx(np.log(integral), abs=0.3)


def test_candidates_have_the_right_orders_with_strays_and_modes_missing():
    peaks, orders = [*exact(8)[[0, 1, 3, 4, 6, 7]], 1.6, 7.7], [1, 2, 4, 5, 7, 8, 0, 0]
    order = np.argsort(peaks)
    log_peaks = np.log(np.array(peaks)[order])
    standardised = Standardised.of(SCENE, BOTH, {}, any_ends=True)
    chances = Chances(np.ones(20), 2.0, np.zeros((8, 20)))
    lattice = Lattice.of(standardised, 20)
    found, _ = lattice.candidates(log_peaks, np.full(8, 1e-3), chances, 150)
    assert np.array(orders)[order].tolist() in found.tolist()


def test_near_a_numbering_are_the_nearest_modes_and_those_without_one_peak():
    standardised = Standardised.of(SCENE, BOTH, {}, any_ends=False)
    chances = Chances(np.ones(20), 2.0, np.zeros((3, 20)))
    peaks = SortedPeaks(np.log(exact(3)), np.full(3, 1e-3))
    best = SimpleNamespace(orders=np.array([[1, 3, 4]]), v=np.zeros((1, 2)))
    orders, v = _around(best, standardised, peaks, chances)
    assert orders.tolist() == [[1, 2, 3], [0, 3, 4], [1, 0, 4], [1, 3, 0]]
    np.testing.assert_array_equal(v, np.zeros((4, 2)))


# --- numberings -------------------------------------------------------------------------------


def test_a_stray_a_missing_mode_and_a_bad_guess():
    peaks = np.sort([*noisy(exact(7))[[0, 1, 2, 4, 5, 6]], 1.13 * exact(3)[2]])
    found = numbered(peaks, SCENE.replace(tension=1.7e5))
    assert decided(found) == "trusted"
    assert found[0].orders == (1, 2, 3, 0, 5, 6, 7)
    assert found[0].value[0] == pytest.approx(TENSION, rel=0.02)
    assert sum(one.probability for one in found) <= 1


def test_peaks_may_come_in_any_order_and_answers_are_the_same_bits():
    peaks, shuffled = noisy(exact(6)), [3, 0, 5, 1, 4]
    first, again = numbered(peaks[shuffled]), numbered(peaks[shuffled])
    assert first[0].orders == (4, 1, 6, 2, 5)
    assert [vars(one) for one in first] == [vars(one) for one in again]


@pytest.mark.parametrize("noise", [0.0, 5e-4, 0.01])
def test_orders_do_not_need_to_know_the_noise(noise):
    peaks = np.sort([*noisy(exact(8), noise)[[0, 1, 2, 4, 5, 7]], 0.5 * exact(4)[2:].sum()])
    found = numberings(SCENE, BOTH, peaks, None)
    assert found[0].probability > 0.9
    # with 1 % the last peak may be a stray, and is left out
    orders = (1, 2, 3, 0, 5, 6, 0 if noise == 0.01 else 8)
    assert found[0].orders == orders


@pytest.mark.parametrize("ends", [("pinned", "pinned"), ("clamped", "clamped"), SCENE.ends])
def test_wrong_ends_that_are_given_do_not_change_orders_of_a_slender_rope(ends):
    peaks = np.delete(noisy(exact(8)), 3)
    found = numbered(peaks, SCENE.replace(ends=ends), ends="given")
    assert found[0].orders == (1, 2, 3, 5, 6, 7, 8)


def other_scenes():
    """Scenes with what is unknown, their orders, and how often the guess is too large."""
    mass = SCENE.replace(parts=[rd.PointMass(6.0, 20.0)])
    spring = SCENE.replace(ends=(rd.End(z="free", beta="free", spring={"z": 3e5}), "pinned"))
    place = (*BOTH, "parts[0].mass", "parts[0].x")
    yield "tension alone", SCENE, ("tension",), {"tension": 1.7}
    yield "stiffness alone", SCENE, ("bending_stiffness",), {"bending_stiffness": 2.0}
    yield "a string", rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION), ("tension",), {}
    yield "a mass", mass, (*BOTH, "parts[0].mass"), {"tension": 2.0, "parts[0].mass": 0.5}
    yield "a mass somewhere", mass, place, {"tension": 2.0, "parts[0].x": 0.9}
    yield "a springy support", spring, BOTH, {"tension": 2.0}
    yield "an unknown support", spring, (*BOTH, "ends[0].spring.z"), {"tension": 2.0}


@pytest.mark.parametrize(
    ("scene", "unknown", "guess"), [pytest.param(*one, id=name) for name, *one in other_scenes()]
)
def test_any_numbers_can_be_unknown(scene, unknown, guess):
    family = scene.family(unknown)
    value = np.array([family._template._value(path) for path in unknown])
    peaks = np.delete(noisy(scene.compile().modes(8).frequency), 3)
    start = family.scene_of(value * [guess.get(path, 1.0) for path in unknown])
    found = numbered(peaks, start, unknown)
    assert found[0].orders == (1, 2, 3, 5, 6, 7, 8)


@pytest.mark.slow
def test_a_sagging_rope_without_closed_form_is_numbered():
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING, axial_stiffness=4e7)
    scene = rd.Scene(rope, tension=TENSION, gravity=rd.Gravity())
    peaks = noisy(scene.compile().modes(8).frequency)
    found = numbered(peaks, scene.replace(tension=1.5 * TENSION))
    assert found[0].orders == (1, 2, 3, 4, 5, 6, 7, 8)


def test_modes_above_the_twentieth_are_ambiguous_rather_than_low():
    """Peaks 3 % apart are consecutive modes about the 35th; which, they hardly tell."""
    found = numbered(noisy(exact(40)[32:]))
    assert decided(found) == "ambiguous"
    assert min(found[0].orders) > 25
    known = numbered(noisy(exact(40)[32:]), prior={"tension": (TENSION, 0.01 * TENSION)})
    assert known[0].orders == tuple(range(33, 41))


# --- what decides, and what does not ----------------------------------------------------------


def test_every_second_mode_of_a_slender_rope_is_ambiguous():
    found = numbered(noisy(exact(8))[1::2])
    assert decided(found) == "ambiguous"
    assert {found[0].orders, found[1].orders} == {(1, 2, 3, 4), (2, 4, 6, 8)}


def test_shapes_of_three_channels_decide():
    x = np.array([3.0, 5.0, 9.0])
    shape = np.sin(np.outer([2, 4, 6, 8], np.pi * x / LENGTH)) * [[1], [-2], [0.1], [5]]
    found = numbered(
        noisy(exact(8))[1::2], sensors=[("z", one) for one in x], shape=shape.astype(complex)
    )
    assert decided(found) == "trusted"
    assert found[0].orders == (2, 4, 6, 8)


def test_a_prior_decides_as_in_the_fit():
    found = numbered(noisy(exact(8))[1::2], prior={"tension": (TENSION, 0.25 * TENSION)})
    assert decided(found) == "trusted"
    assert found[0].orders == (2, 4, 6, 8)


def test_a_prior_of_the_mass_is_in_the_number_of_the_tension():
    """Where tension and mass are known to 1 % each, orders are known too."""
    prior = {"tension": (TENSION, 0.01 * TENSION), "linear_density": (DENSITY, 0.01 * DENSITY)}
    found = numbered(noisy(exact(8))[1::2], prior=prior | {"torsional_stiffness": (3.0, 1.0)})
    assert found[0].orders == (2, 4, 6, 8)


@pytest.mark.parametrize("ends", ["unknown", "given"])
def test_a_known_stiffness_is_kept_where_the_tension_is_far_from_its_guess(ends):
    peaks, prior = np.delete(noisy(exact(8)), 3), {"bending_stiffness": (BENDING, 0.02 * BENDING)}
    found = numbered(peaks, SCENE.replace(tension=TENSION / 8), ends=ends, prior=prior)
    assert found[0].orders == (1, 2, 3, 5, 6, 7, 8)
    assert found[0].value[1] == pytest.approx(BENDING, rel=0.06)


@pytest.mark.parametrize("ends", ["unknown", "given"])
def test_a_known_tension_is_kept_where_the_stiffness_is_far_from_its_guess(ends):
    peaks, prior = np.delete(noisy(exact(8)), 3), {"tension": (TENSION, 0.02 * TENSION)}
    rope = ROPE.replace(bending_stiffness=8 * BENDING)
    found = numbered(peaks, SCENE.replace(rope=rope), ends=ends, prior=prior)
    assert found[0].orders == (1, 2, 3, 5, 6, 7, 8)
    assert found[0].value[0] == pytest.approx(TENSION, rel=0.06)


def test_a_sensor_at_midspan_explains_every_second_mode():
    found = numbered(noisy(exact(9))[::2], sensors=[("z", LENGTH / 2)])
    assert decided(found) == "trusted"
    assert found[0].orders == (1, 3, 5, 7, 9)


def test_modes_of_the_supports_are_strays():
    """Six modes of a deck below, between and above those of the rope."""
    deck = np.array([0.61, 1.55, 2.9, 4.7, 7.9, 13.0])
    peaks = np.concatenate([noisy(exact(7)), deck])
    found = numbered(peaks)
    assert found[0].orders == (*range(1, 8), *[0] * 6)


def test_a_line_at_the_place_of_a_missing_mode_is_no_mode():
    peaks = exact(6)
    kind = ["mode", "mode", "line", "mode", "double", "mode"]
    assert numbered(noisy(peaks))[0].orders == (1, 2, 3, 4, 5, 6)
    found = numbered(noisy(peaks) * [1, 1, 1.004, 1, 1.004, 1], kind=kind)
    assert found[0].orders == (1, 2, 0, 4, 5, 6)


def test_peaks_anywhere_are_refused():
    peaks = np.sort(np.random.default_rng(8).uniform(1, 12, 6))
    assert decided(numbered(peaks, noise=2e-3)) != "trusted"
    assert decided(numbered([3.0])) == "refused"


def test_two_peaks_are_never_trusted():
    assert decided(numbered(noisy(exact(2)))) == "ambiguous"


def one(orders, probability):
    return Numbering(orders, probability, 0.0, (1.0,))


@pytest.mark.parametrize(
    ("found", "status"),
    [
        ([], "refused"),
        ([one((0, 1, 0), 0.99)], "refused"),
        ([one((1, 2, 0), 0.999)], "ambiguous"),
        ([one((1, 2, 3), 0.95)], "ambiguous"),
        ([one((1, 2, 3), 0.96), one((2, 4, 6), 0.04)], "trusted"),
        ([one((1, 2, 3), 0.951), one((2, 4, 6), 0.049)], "ambiguous"),
    ],
)
def test_what_is_trusted_has_no_rival(found, status):
    assert decided(found) == status


# --- bad input --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"ends": "free"}, 'ends must be one of "unknown", "given", got'),
        ({"kind": ["mode", "mode", "tone"]}, r'kind\[2\] must be one of "mode"'),
        ({"shape": np.ones((3, 2))}, "shape must have a row for each of 3 peaks and a column"),
        ({"prior": {"tensoin": (1e5, 1e4)}}, "path must be that of a number .* got 'tensoin'"),
        ({"prior": {"tension": (-1.0, 1.0)}}, r"prior\['tension'\] must have a mean of the sign"),
    ],
)
def test_bad_input_is_named(more, message):
    with pytest.raises(rd.SceneError, match=message):
        numbered(exact(3), **more)


# --- many ropes -------------------------------------------------------------------------------


def test_no_order_of_some_ropes_is_silently_wrong():
    rng = np.random.default_rng(20)
    assert tally([mixed(rng) for _ in range(16)]).wrong == 0
    assert tally([made(rng, step=2) for _ in range(8)]).wrong == 0


MIXED = (
    "orders of 2000 ropes, T L^2/B 50 to 1e7, any ends, noise 0.05 to 1 %, 4 to 10 modes, 0 to 3 "
    "strays, hum, 0 to 3 modes missing, tension guessed within a factor of 3: "
)


@pytest.fixture(scope="module")
def ropes():
    rng = np.random.default_rng(41)
    return [mixed(rng) for _ in range(2000)]


@pytest.mark.slow
@pytest.mark.claim(
    MIXED + "trusted and an order wrong that could be told, share",
    reference="the modes the peaks were made of",
    accepted=0.005,
)
def test_orders_are_rarely_silently_wrong(claim, ropes):
    claim(tally(ropes).wrong)


@pytest.mark.slow
@pytest.mark.claim(
    MIXED + "ambiguous though at most one mode is missing, share",
    reference="the modes the peaks were made of",
    accepted=0.13,
    limit=True,
)
def test_orders_are_seldom_ambiguous_where_one_mode_is_missing_at_most(claim, ropes):
    claim(tally([one for one in ropes if one.missing <= 1]).ambiguous)


@pytest.mark.slow
@pytest.mark.claim(
    "orders of ropes of which every second mode is seen, tension known to a factor of 3: trusted "
    "and wrong, share of 500",
    reference="the modes the peaks were made of",
    accepted=0.02,
)
def test_every_second_mode_is_rarely_trusted_to_be_every_mode(claim):
    rng = np.random.default_rng(42)
    claim(tally([made(rng, step=2) for _ in range(500)]).wrong)
