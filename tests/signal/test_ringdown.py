"""Frequencies and damping from free decay, against the modes it is made of."""

import numpy as np
import pytest
from made_history import decaying, made

import ropedyn as rd
from ropedyn.signal.ringdown import _band

TIME = np.linspace(0.0, 2.0, 4001)
MODES = [(20.0, 0.01, 1.0), (40.3, 0.004, 0.5j), (61.0, 0.02, 0.3), (85.0, 0.005, 0.2 - 0.1j)]
CLOSE = [(20.0, 0.01, 1.0), (20.5, 0.012, -0.6)]
# what is not told apart leaks through the filter, at 1e-5 of the strongest, into records of 1e-3
EXACT = 1e-7


def assert_found(found, modes, tolerance=EXACT):
    frequency, ratio, amplitude = (np.array(column) for column in zip(*modes, strict=True))
    np.testing.assert_allclose(found.frequency, frequency, rtol=tolerance)
    np.testing.assert_allclose(found.damping_ratio, ratio, rtol=tolerance)
    np.testing.assert_allclose(found.amplitude, amplitude, rtol=tolerance)


@pytest.mark.parametrize("rest", [0.0, 0.3])
def test_modes_of_a_sum_are_found_exactly_beside_what_stands_still(rest):
    found = made(TIME, rest + decaying(TIME, *MODES)).ring_down([19.0, 41.0, 60.0, 86.0])
    assert_found(found, MODES)
    assert found.residual.max() < 1e-6


def test_two_modes_within_their_bandwidth_are_told_apart():
    found = made(TIME, decaying(TIME, *CLOSE)).ring_down([19.8, 20.8])
    assert_found(found, CLOSE, 1e-7)


@pytest.mark.parametrize(
    ("rate", "seconds"), [(200.0, 0.2), (200.0, 1.0), (50_000.0, 0.2), (101.0, 20.0)]
)
def test_few_periods_and_few_times_of_each_are_enough(rate, seconds):
    time = np.arange(int(rate * seconds)) / rate
    assert_found(made(time, decaying(time, MODES[0])).ring_down(20.0), MODES[:1])


def test_modes_above_do_not_matter_where_the_record_is_short():
    modes = [(5.0 * k, 0.01, 1 / k**2) for k in range(1, 40, 2)]
    found = made(TIME, decaying(TIME, *modes)).ring_down(5.0)
    assert_found(found, modes[:1], 1e-6)


def test_a_weak_mode_is_told_from_strong_ones_beside_it():
    modes = [(40.0, 0.01, 1.0), (48.0, 0.01, 1e-3), (56.0, 0.01, 1.0)]
    found = made(TIME, decaying(TIME, *modes)).ring_down(48.0)
    assert_found(found, modes[1:2])


def test_the_strongest_line_is_looked_at_where_nothing_is_said():
    found = made(TIME, decaying(TIME, MODES[2], (40.3, 0.004, 0.5j))).ring_down()
    assert_found(found, [MODES[1]])


@pytest.mark.parametrize(
    ("seconds", "shift", "width", "edge"),
    [(12.0, 20.0, 5.0, 2.0), (100.0, 20.0, 2.5, 2.0), (6.0, 20.0, 5.0, 3.0), (4.0, 20.0, 5.0, 3.8),
     (2.0, 20.0, 5.0, 3.8), (1.0, 0.0, 20.0, 3.0)],
    ids=["a quarter of it", "a long record", "a shorter one", "a short one", "a third", "all"],
)  # fmt: skip
def test_what_is_near_passes_and_what_stands_still_does_not(seconds, shift, width, edge):
    """Within 1e-5 of 1 in the pass band, 100 dB, and less than 1e-5 beyond the stop band's edge."""
    step = 1e-3
    band = _band(np.zeros(round(seconds / step)), step, 20.0)
    assert band.shift == pytest.approx(2 * np.pi * shift, rel=1e-15)
    assert band.step == pytest.approx(int(1 / (2 * edge * width * step)) * step, rel=1e-12)
    off = np.linspace(0.0, 0.5 / step, 4001)
    turn = np.exp(2j * np.pi * step * np.outer(off, np.arange(len(band.taps))))
    gain = np.abs(turn @ band.taps)
    assert np.abs(gain[off <= width] - 1).max() < 2e-5
    assert gain[off >= edge * width].max() < 2e-5
    between = (off > 1.2 * width) & (off < edge * width / 1.2)
    assert (np.abs(gain[between] - 0.5) < 0.5).all()


def test_growth_is_negative_damping():
    growing = (30.0, -0.002, 1e-3)
    assert_found(made(TIME, decaying(TIME, growing)).ring_down(30.0), [growing])


@pytest.mark.parametrize("response", [0, 1])
def test_each_response_has_its_own_amplitude(response):
    value = [decaying(TIME, MODES[0]), decaying(TIME, (20.0, 0.01, -2.5j))]
    found = made(TIME, value).ring_down(20.0, response=response)
    assert_found(found, [(20.0, 0.01, (1.0, -2.5j)[response])])
    assert found.label == f"z at 0.{response + 1}00 m [m]"


def test_free_motion_begins_when_the_force_has_changed_for_the_last_time():
    free = TIME > 0.5
    value = np.where(free, decaying(TIME - 0.5, MODES[0]), 7.0)
    found = made(TIME, value, force=np.where(free, 0.0, 3.0)).ring_down(20.0)
    assert found.since == TIME[free][0]
    start = np.exp(2j * np.pi * 20.0 * np.sqrt(1 - 1e-4) * (found.since - 0.5))
    assert found.amplitude[0] == pytest.approx(
        start * np.exp(-2 * np.pi * 0.2 * (found.since - 0.5)), rel=EXACT
    )
    later = made(TIME, value).ring_down(20.0, since=1.0)
    assert later.since == 1.0
    assert later.damping_ratio[0] == pytest.approx(0.01, rel=EXACT)


@pytest.mark.parametrize("noise", [1e-4, 1e-2, 0.05])
def test_standard_errors_are_those_of_many_noisy_records(noise):
    rng = np.random.default_rng(2)
    modes = [(20.0, 0.01, 1.0), (22.0, 0.004, 0.5j)]
    value, runs = decaying(TIME, *modes), 60
    near = [mode[0] for mode in modes]
    found = [
        made(TIME, value + noise * rng.normal(size=len(TIME))).ring_down(near) for _ in range(runs)
    ]
    for name, true in (("frequency", near), ("damping_ratio", [m[1] for m in modes])):
        off = np.array([(getattr(f, name) - true) / getattr(f, f"{name}_std") for f in found])
        # of 60 runs the standard deviation is known to 9 %, the mean to 0.13: 4 of these
        np.testing.assert_allclose(off.std(axis=0), 1.0, atol=0.37)
        np.testing.assert_allclose(off.mean(axis=0), 0.0, atol=0.52)


def test_noise_alone_has_no_mode():
    noise = np.random.default_rng(4).normal(size=len(TIME))
    with pytest.raises(rd.SolveError, match="no mode near 30 Hz is told from noise"):
        made(TIME, noise).ring_down(30.0)


def test_what_creeps_back_does_not_oscillate():
    with pytest.raises(rd.SolveError, match="nothing oscillates near 3 Hz"):
        made(TIME, np.exp(-4.0 * TIME)).ring_down(3.0)


def test_what_does_not_move_has_no_mode():
    with pytest.raises(rd.SolveError, match=r"nothing moves in response 0 since 0 s"):
        made(TIME, np.zeros(len(TIME))).ring_down()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"near": 1000.0}, "near must be below half the rate of the times, 1000 Hz, got 1000"),
        ({"near": -3.0}, "near"),
        ({"response": 1}, "response must be a whole number from 0 to 0"),
        ({"since": 1.999}, "since must leave 16 times of free motion at least, got 3"),
        ({"since": 5.0}, "since must leave 16 times of free motion at least, got 0"),
    ],
)
def test_questions_without_meaning_are_refused(options, words):
    with pytest.raises(rd.SceneError, match=words):
        made(TIME, decaying(TIME, *MODES)).ring_down(**options)


def test_a_history_has_its_errors_over_responses_and_time():
    found = made(TIME[:5], np.ones((2, 5))).to_xarray()
    for name in ("value", "error", "mesh_error"):
        assert found[name].dims == ("response", "time")


def test_what_rounding_leaves_is_no_mode():
    """Of 1e-15 of the motion, and nearer to the line, it was told as a mode that grows."""
    length = 0.9291018001730192
    tip = rd.End(z="free", dashpot={"z": 66.42436391178306})
    scene = rd.Scene(
        rd.Rope(length, 0.11736287681810484),
        tension=2384.2756672773194,
        ends=("clamped", tip),
        damping=rd.RayleighDamping(21.19159644986563, 6.082380058495784e-05),
    )
    model = scene.compile(elements=3, element="rigid")
    time = np.linspace(0.0, 20 / 76.70427384872973, 1500)
    where = {"start": {("z", length / 3): 1.0}, "response": ("z", 2 * length / 3)}
    found = model.transient(time, tolerance=1e-5, **where).ring_down()
    mode = model.modes(2, damped=True)
    (k,) = np.flatnonzero(mode.damping_ratio < 1)
    exact = mode.frequency[k] / np.sqrt(1 - mode.damping_ratio[k] ** 2)
    assert found.damping_ratio[0] == pytest.approx(mode.damping_ratio[k], rel=1e-8)
    assert found.frequency[0] == pytest.approx(exact, rel=1e-8)


SLACK = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ViscousDamping(0.5))
"""Its chain moves by 15 modes, of which the lowest decays by 0.4 in each period."""


def let_go(time):
    """Return free motion of a chain, and the rate of its lowest mode."""
    model = SLACK.compile(elements=16, element="rigid")
    found = model.transient(time, start={("z", 0.1875): 1.0}, response=("z", 0.1875))
    return found, model.modes(1, damped=True).eigenvalue[0]


@pytest.mark.parametrize("count", [1000, 2000, 4000, 8000])
def test_motion_that_is_over_long_before_the_end_is_looked_at_where_it_is(count):
    """The window was 0 where it moves: 2.1 and 1.1 Hz were told for 5, to 4 digits."""
    history, rate = let_go(np.arange(count) / 120.0)
    decay = history.ring_down()
    assert abs(decay.frequency[0] / (abs(rate) / (2 * np.pi)) - 1) < 1e-5  # measured: 4e-6
    assert abs(decay.damping_ratio[0] / (-rate.real / abs(rate)) - 1) < 1e-3  # measured: 6e-5


@pytest.mark.parametrize("rate", [49.0, 69.0, 71.5, 81.0, 110.0])
def test_what_a_low_pass_leaves_of_others_is_not_the_mode_that_is_asked_for(rate):
    """It lay nearer, with 5e-6 of the amplitude: 8 standard errors off."""
    history, exact = let_go(np.arange(500) / rate)
    decay = history.ring_down(abs(exact) / (2 * np.pi))
    assert abs(decay.damping_ratio[0] / (-exact.real / abs(exact)) - 1) < 1e-2
    assert abs(decay.amplitude[0]) > 0.1 * np.abs(history.value).max()
