"""Peaks: measured ones, their pairs among the calculated, and those that a response shows."""

import itertools
import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd

TENSION, DENSITY, LENGTH = 100.0, 0.1, 1.0
STRING = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION).compile(elements=8, element="rigid")
# modes of the string of beads, in closed form: omega_k = 2 sqrt(T/(mu a^2)) sin(k pi/2n)
BEADS = 16 * math.sqrt(TENSION / DENSITY) * np.sin(np.arange(1, 8) * math.pi / 16) / (2 * math.pi)


def test_the_string_of_beads_has_the_peaks_of_the_closed_form():
    # the lowest of 7 eigenvalues is 26 times below the highest: its error is 26 n eps, halved
    np.testing.assert_allclose(STRING.modes(7).frequency, BEADS, rtol=100 * EPS)


# measured peaks


@pytest.mark.parametrize("given", [64, 64.0, [64.0], (64,), np.array([64.0]), np.float32(64)])
def test_one_peak_may_be_given_as_a_number_or_array(given):
    assert rd.Peaks(given).frequency.tolist() == [64.0]


@pytest.mark.parametrize(
    ("std", "expected"), [(0.5, (0.5, 0.5)), ([0.5, 1], (0.5, 1.0)), (0, (0.0, 0.0)), (None, None)]
)
def test_one_uncertainty_holds_for_every_peak(std, expected):
    assert rd.Peaks([64.0, 130.0], std=std).std == expected


@pytest.mark.parametrize("order", [[2, 1], (2, 1), np.array([2, 1]), np.array([2, 1], np.uint8)])
def test_orders_are_kept_as_whole_numbers(order):
    kept = rd.Peaks([130.0, 64.0], order=order).order
    assert kept == (2, 1)
    assert [type(k) for k in kept] == [int, int]


def test_table_of_peaks_shows_what_is_known():
    whole = rd.Peaks([64.0, 130.0], std=0.5, order=[1, 3]).table()
    assert whole.columns == ("frequency [Hz]", "std [Hz]", "order")
    assert whole.rows == ((64.0, 0.5, 1), (130.0, 0.5, 3))
    assert rd.Peaks([64.0]).table().columns == ("frequency [Hz]",)


# pairs


def best_pairs(peaks, found):
    """Try every assignment of at most one calculated peak to each: the sum of log^2 that is least.

    With fewer calculated than measured peaks, each calculated one is used.
    """
    padded = [*range(len(found)), *[None] * max(0, len(peaks) - len(found))]

    def cost(chosen):
        used = [(p, found[k]) for p, k in zip(peaks, chosen) if k is not None]
        return sum(math.log(p / f) ** 2 for p, f in used)

    best = min(set(itertools.permutations(padded, len(peaks))), key=cost)
    return [0 if k is None else k + 1 for k in best]


# Hz; the beads have 15.7, 30.8, 44.7, 56.9, 67.0, 74.4, 79.0
MEASURED = {
    "as calculated": BEADS[:3],
    "all low": [14.5, 28.0, 40.0],
    "one missed": [16.0, 45.0],
    "close together": [15.0, 17.0],
    "three around the first": [15.0, 16.0, 17.0],
    "far below the first": [3.0],
    "far above the last": [1000.0],
    "not in order": [45.0, 16.0, 31.0],
    "the same twice": [16.0, 16.0],
}


@pytest.mark.parametrize("what", MEASURED)
def test_pairs_without_orders_have_the_least_sum_of_squared_logarithms(what):
    modes = STRING.modes(5)
    comparison = rd.compare(modes, rd.Peaks(MEASURED[what]))
    log = np.log(comparison.calculated / comparison.measured)
    best = [modes.frequency[k - 1] for k in best_pairs(MEASURED[what], modes.frequency)]
    least = np.sum(np.log(np.array(best) / MEASURED[what]) ** 2)
    # equal pairs have the same sum up to the order of their terms
    assert np.sum(log**2) == pytest.approx(least, rel=20 * EPS, abs=EPS**2)
    assert len(set(comparison.order.tolist())) == len(comparison.order)


@pytest.mark.parametrize("what", MEASURED)
def test_a_model_is_compared_like_all_of_its_modes(what):
    peaks = rd.Peaks(MEASURED[what])
    model, modes = rd.compare(STRING, peaks), rd.compare(STRING.modes(7), peaks)
    assert sorted(model.order) == sorted(modes.order)
    np.testing.assert_allclose(np.sort(model.calculated), np.sort(modes.calculated), rtol=100 * EPS)


@pytest.mark.parametrize("order", [(1, 2, 3), (3, 1, 2), (2, 4, 7)])
def test_orders_decide_the_pairs(order):
    measured = [20.0, 50.0, 90.0]
    for calculated in (STRING, STRING.modes(7)):
        comparison = rd.compare(calculated, rd.Peaks(measured, order=order))
        assert comparison.order.tolist() == list(order)
        expected = BEADS[np.array(order) - 1]
        np.testing.assert_allclose(comparison.calculated, expected, rtol=100 * EPS)


def test_difference_is_the_per_cent_of_the_measured_frequency():
    comparison = rd.compare(STRING.modes(2), rd.Peaks([16.0, 40.0]))
    expected = 100 * (BEADS[:2] / [16.0, 40.0] - 1)
    # a difference of nearly equal numbers, 0.02 of them at least, with the error of the modes
    np.testing.assert_allclose(comparison.difference, expected, rtol=100 * EPS / 0.02)
    assert comparison.measured.tolist() == [16.0, 40.0]


@pytest.mark.parametrize("count", [1, 2, 6])
def test_more_peaks_than_modes_leaves_the_rest_without_partner(count):
    measured = np.linspace(10.0, 120.0, 8)
    comparison = rd.compare(STRING.modes(count), rd.Peaks(measured))
    alone = comparison.order == 0
    assert alone.sum() == 8 - count
    assert sorted(comparison.order[~alone]) == list(range(1, count + 1))
    assert (comparison.calculated[alone] == 0).all()
    assert (comparison.difference[alone] == -100).all()
    assert comparison.order.tolist() == best_pairs(measured, comparison.all_calculated)


def test_more_peaks_than_the_model_has_modes_leaves_the_rest_without_partner():
    two = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=3, element="rigid")
    comparison = rd.compare(two, rd.Peaks([14.0, 30.0, 70.0]))
    assert sorted(comparison.order.tolist()) == [0, 1, 2]


@pytest.mark.parametrize("calculated", ["model", "modes"])
def test_an_order_beyond_the_modes_is_refused(calculated):
    # the model has 7
    given = STRING if calculated == "model" else STRING.modes(7)
    with pytest.raises(rd.SceneError, match=r"order must be at most 7, .* got 9"):
        rd.compare(given, rd.Peaks([20.0, 90.0], order=[1, 9]))


@pytest.mark.parametrize("orders", [None, [1]], ids=["without_orders", "with_orders"])
@pytest.mark.parametrize("calculated", ["model", "modes"])
def test_rigid_motion_is_no_peak(calculated, orders):
    # a free rope: two rigid motions in front of its first vibration
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
    model = rd.Scene(rope, ends=("free", "free")).compile(elements=16, element="rigid")
    modes = model.modes(4)
    assert (modes.frequency[:2] == 0).all()
    given = model if calculated == "model" else modes
    comparison = rd.compare(given, rd.Peaks([modes.frequency[2] * 1.01], order=orders))
    assert comparison.order.tolist() == [1]
    # the same mode computed among others, or alone: the estimated rounding error of both
    assert comparison.calculated[0] == pytest.approx(
        modes.frequency[2], abs=2 * modes.rounding_error[2]
    )


def test_modes_that_only_grow_are_no_peaks():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
    modes = rd.Scene(rope, tension=-50.0).compile(elements=16, element="rigid").modes(1)
    assert modes.growth[0] > 0
    with pytest.raises(rd.SceneError, match="calculated must have at least one peak, got none"):
        rd.compare(modes, rd.Peaks([20.0]))


def test_a_response_without_peaks_has_nothing_to_compare():
    frf = STRING.frf([1.0, 2.0, 3.0], drive=("z", 0.5))
    with pytest.raises(rd.SceneError, match="calculated must have at least one peak, got none"):
        rd.compare(frf, rd.Peaks([20.0]))


def test_a_response_is_compared_by_its_peaks():
    scene = STRING.scene.replace(damping=rd.RayleighDamping(0.5, 0.0))
    frf = scene.compile(elements=8, element="rigid").frf(
        np.linspace(1, 60, 4000), drive=("z", 0.125)
    )
    comparison = rd.compare(frf, rd.Peaks([31.0, 16.0, 45.0]))
    assert comparison.order.tolist() == [2, 1, 3]
    np.testing.assert_array_equal(comparison.calculated, frf.peaks()[0].frequency[[1, 0, 2]])


# peaks of a response: one bead on a string, k = 4 T/L, m = mu L/2

NATURAL = math.sqrt(4 * TENSION / LENGTH / (DENSITY * LENGTH / 2)) / (2 * math.pi)


def one_bead(ratio):
    """Return one mass on a string with this share of critical damping, C = 2 zeta omega M."""
    damping = rd.RayleighDamping(4 * math.pi * NATURAL * ratio, 0.0)
    return rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=damping).compile(
        elements=2, element="rigid"
    )


def grid(step):
    """Frequencies around the peak with this relative step; the peak lies between two."""
    return NATURAL * (1 + step * (np.arange(-40, 40) + 0.37))


QUANTITIES = ("receptance", "mobility", "accelerance")


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("ratio", [1e-4, 1e-3, 1e-2, 0.05])
def test_peak_of_one_mode_recovers_frequency_and_damping_ratio(ratio, quantity):
    step = 0.2 * ratio
    frf = one_bead(ratio).frf(grid(step), drive=("z", 0.5), quantity=quantity)
    (found,) = frf.peaks()
    # 1/receptance = m (omega_0^2 - omega^2 + 2 i zeta omega_0 omega). The line in omega^2 through
    # the points beside omega has the slope -m (1 - i zeta omega_0/omega), so that its zero is at
    # omega_0^2 - 2 zeta^2 omega_0^2 + i 2 zeta omega_0^2, each to a factor 1 + O(zeta^2 + delta^2)
    # with delta, the distance of the point from omega_0, at most a step and zeta^2 of omega_0:
    # frequency low by zeta^2, ratio high by some 2 zeta^2. The slope is a difference over a
    # step: eps/step of 1/receptance, which at the peak is 2 zeta of its terms
    noise = 20 * EPS / step
    assert found.frequency == pytest.approx([NATURAL], rel=1.5 * ratio**2 + noise * ratio)
    assert found.damping_ratio == pytest.approx([ratio], rel=4 * ratio**2 + noise)


@pytest.mark.parametrize("ratio", [1e-3, 1e-2])
def test_amplitude_of_the_peak_is_that_of_one_mode(ratio):
    step = 0.02 * ratio
    (found,) = one_bead(ratio).frf(grid(step), drive=("z", 0.5)).peaks()
    # |receptance| at its highest: 1/(k 2 zeta sqrt(1 - zeta^2)). The nearest frequency is at most
    # half a step off: 1 - ((step/2)/zeta)^2/2 of it
    highest = 1 / (4 * TENSION / LENGTH * 2 * ratio * math.sqrt(1 - ratio**2))
    assert highest * (1 - (0.01) ** 2 / 2 * 1.1) <= found.amplitude[0] <= highest * (1 + 1e-12)


def test_label_of_the_peaks_is_that_of_the_response():
    frf = one_bead(1e-2).frf(grid(2e-3), drive=("z", 0.5), response=[("z", 0.5), ("z", 0.25)])
    assert [found.label for found in frf.peaks()] == list(frf.labels)


def test_peaks_of_several_drives_are_those_of_each():
    model = one_bead(1e-2)
    points = [("z", 0.5), ("z", 0.2)]
    both = model.frf(grid(2e-3), drive=points, response=[("z", 0.5)])
    for number, point in enumerate(points):
        (expected,) = model.frf(grid(2e-3), drive=point, response=("z", 0.5)).peaks()
        (found,) = both.peaks(number)
        assert found.amplitude.tolist() == expected.amplitude.tolist()


def test_no_peak_is_found_on_a_slope():
    frf = one_bead(1e-2).frf(NATURAL * np.array([0.1, 0.2, 0.3]), drive=("z", 0.5))
    (found,) = frf.peaks()
    assert len(found.frequency) == len(found.amplitude) == len(found.damping_ratio) == 0


def test_a_drive_that_does_not_move_a_response_has_no_peaks():
    rope = rd.Rope(1.0, 0.1, torsional_stiffness=0.5)
    model = rd.Scene(rope, tension=100.0).compile(elements=2, element="rigid")
    frf = model.frf(np.linspace(1, 20, 50), drive=("z", 0.5), response=("alpha", 0.5))
    assert not frf.value.any()
    assert len(frf.peaks()[0].frequency) == 0


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_peak_beside_0_hz_is_no_nan(quantity):
    # three frequencies, the first 0: velocity and acceleration are 0 there
    frf = one_bead(0.01).frf([0.0, NATURAL, 2 * NATURAL], drive=("z", 0.5), quantity=quantity)
    (found,) = frf.peaks()
    assert np.isfinite(found.frequency).all()
    assert np.isfinite(found.damping_ratio).all()


def test_frequencies_in_any_order_show_the_same_peaks():
    model = one_bead(1e-2)
    (expected,) = model.frf(grid(2e-3), drive=("z", 0.5)).peaks()
    shuffled = np.random.default_rng(3).permutation(grid(2e-3))
    (found,) = model.frf(shuffled, drive=("z", 0.5)).peaks()
    assert found.frequency.tolist() == expected.frequency.tolist()


def test_a_frequency_given_twice_is_no_nan():
    doubled = np.repeat(grid(2e-3), 2)
    (found,) = one_bead(1e-2).frf(doubled, drive=("z", 0.5)).peaks()
    # the same mode as without the copies
    assert found.frequency == pytest.approx([NATURAL], rel=2e-4)
