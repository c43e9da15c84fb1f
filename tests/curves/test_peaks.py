"""Peaks: measured ones, and those that a response shows."""

import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd

TENSION, DENSITY, LENGTH = 100.0, 0.1, 1.0


# measured peaks


@pytest.mark.parametrize("given", [64, 64.0, [64.0], (64,), np.array([64.0]), np.float32(64)])
def test_one_peak_may_be_given_as_a_number_or_array(given):
    assert rd.Peaks(given).frequency.tolist() == [64.0]


@pytest.mark.parametrize(
    ("std", "expected"), [(0.5, (0.5, 0.5)), ([0.5, 1], (0.5, 1.0)), (0, (0.0, 0.0)), (None, None)]
)
def test_one_uncertainty_holds_for_every_peak(std, expected):
    assert rd.Peaks([64.0, 130.0], std=std).std == expected


@pytest.mark.parametrize(
    "order", [[2, 1], (2, 1), np.array([2, 1]), np.array([2, 1], np.uint8), range(2, 0, -1)]
)
def test_orders_are_kept_as_whole_numbers(order):
    kept = rd.Peaks([130.0, 64.0], order=order).order
    assert kept == (2, 1)
    assert [type(k) for k in kept] == [int, int]


def test_table_of_peaks_shows_what_is_known():
    whole = rd.Peaks([64.0, 130.0], std=0.5, order=[1, 3]).table()
    assert whole.columns == ("frequency [Hz]", "std [Hz]", "order")
    assert whole.rows == ((64.0, 0.5, 1), (130.0, 0.5, 3))
    assert rd.Peaks([64.0]).table().columns == ("frequency [Hz]",)


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


def test_peaks_have_the_unit_of_the_drive_they_answer():
    """A force moves a point by m/N, an end that is moved by m/m."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.StiffnessDamping(1e-4))
    frf = scene.compile().frf(
        np.arange(5.0, 40.0, 0.5), drive=[("z", 0.3), ("end", 0, "z")], response=("z", 0.3)
    )
    assert [frf.peaks(d)[0].label for d in (0, 1)] == [
        "z at 0.300 m [m/N]",
        "z at 0.300 m [m/m]",
    ]
