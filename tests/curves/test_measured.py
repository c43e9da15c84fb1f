"""Measured frequency response: estimated from motion over time, and what both kinds can do."""

import numpy as np
import pytest
from made_history import made
from scipy.special import erf

import ropedyn as rd

EPS = np.finfo(float).eps
# one mode: mass [kg], undamped frequency [Hz], damping ratio
MASS, FREQUENCY, RATIO = 0.2, 25.0, 0.03
TIME = np.arange(4000) / 500.0
WHEN, WIDTH = 0.1, 5e-3  # of a blow as Gauss's curve: all its frequencies are below 250 Hz


def blow(time):
    return 3.0 * np.exp(-((time - WHEN) ** 2) / (2 * WIDTH**2))


def motion(time, order=0):
    """Return displacement, velocity of the mode after the blow: Duhamel's integral in closed form.

    integral of exp(-u^2/2 w^2) exp(lambda (t - u)) over u < t - t0 is
    w sqrt(pi/2) exp(lambda (t - t0) + lambda^2 w^2/2) (1 + erf((t - t0 + lambda w^2)/(w sqrt 2))).
    """
    omega = 2 * np.pi * FREQUENCY
    rate = omega * (-RATIO + 1j * np.sqrt(1 - RATIO**2))
    since = time - WHEN
    area = WIDTH * np.sqrt(np.pi / 2) * np.exp(rate * since + (rate * WIDTH) ** 2 / 2)
    area = area * (1 + erf((since + rate * WIDTH**2) / (np.sqrt(2) * WIDTH)))
    return 3.0 / (MASS * rate.imag) * (rate**order * area).imag


def receptance(frequency):
    omega, natural = 2 * np.pi * frequency, 2 * np.pi * FREQUENCY
    return 1 / (MASS * (natural**2 - omega**2 + 2j * RATIO * natural * omega))


def assert_near(found, exact, tolerance):
    np.testing.assert_allclose(found, exact, atol=tolerance * np.abs(exact).max())


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
def test_a_blow_that_decays_measures_the_response_of_one_mode(quantity):
    order = ["displacement", "velocity"].index(quantity)
    history = made(TIME, motion(TIME, order), force=blow(TIME), quantity=quantity)
    measured = history.frf()
    exact = receptance(measured.frequency) * (2j * np.pi * measured.frequency) ** order
    # the decay is done at exp(-0.03 2 pi 25 7.9) = 7e-17; the curve's tail at 250 Hz is 1e-14
    assert_near(measured.value[0], exact, 1e-11)
    assert measured.quantity == ("receptance", "mobility")[order]
    assert measured.coherence is None
    assert (measured.frequency[0] == 0) == (quantity == "displacement")


def test_lines_without_force_are_left_out_unless_a_band_asks_for_them():
    history = made(TIME, motion(TIME), force=blow(TIME))
    # the spectrum of the blow, exp(-(omega w)^2/2), is 1e-3 there
    limit = np.sqrt(2 * np.log(1e3)) / (2 * np.pi * WIDTH)
    assert history.frf().frequency[-1] == np.floor(limit * 8) / 8
    asked = history.frf(band=(20.0, 140.0)).frequency
    assert (asked[0], asked[-1]) == (20.0, 140.0)


def test_the_peak_of_a_measurement_is_the_mode():
    (peaks,) = made(TIME, motion(TIME), force=blow(TIME)).frf().peaks()
    # the parabola through three lines of one mode is exact
    np.testing.assert_allclose(peaks.frequency, [FREQUENCY], rtol=1e-9)
    np.testing.assert_allclose(peaks.damping_ratio, [RATIO], rtol=1e-8)


def test_a_measured_receptance_turns_into_an_accelerance():
    measured = made(TIME, motion(TIME), force=blow(TIME)).frf(band=(1.0, 100.0))
    other = measured.to("accelerance")
    assert isinstance(other, rd.Measured)
    assert other.labels == ("z at 0.100 m [m/s^2/N]",)
    exact = -((2 * np.pi * other.frequency) ** 2) * receptance(other.frequency)
    assert_near(other.value[0], exact, 1e-11)


def noisy(segments, gain=2e-3, noise=1e-3):
    """Return what is measured of a spring that noise drives, with noise on its motion."""
    rng, n = np.random.default_rng(11), 2**14
    force = rng.normal(size=n)
    value = gain * force + noise * rng.normal(size=n)
    return made(np.arange(n) / 1000.0, value, force=force).frf(segments=segments)


def test_averages_find_a_response_in_noise_as_well_as_theory_says():
    segments = 127
    measured = noisy(segments)
    share = 2.0**2 / (2.0**2 + 1.0)
    # Bendat and Piersol (2010), table 9.6: relative standard error of |H|; overlapping segments of
    # Hann's window count as 0.53 times as many (section 11.5.2.2)
    averages = 0.53 * segments
    error = np.sqrt((1 - share) / (2 * share * averages))
    off = np.abs(measured.value[0]) / 2e-3 - 1
    assert np.sqrt(np.mean(off**2)) == pytest.approx(error, rel=0.25)
    assert measured.coherence.mean() == pytest.approx(share, abs=0.02)


def test_one_segment_has_no_coherence_and_several_have():
    assert noisy(1).coherence is None
    coherence = noisy(3).coherence
    assert coherence.shape == noisy(3).value.shape
    assert 0 <= coherence.min() <= coherence.max() <= 1 + 4 * EPS
    assert "coherence of z at 0.100 m [m/N]" in noisy(3).table().columns


def two_drives(second):
    force = [blow(TIME), second]
    return made(TIME, motion(TIME), force=force, drive=(("z", 0.5), ("z", 0.7)))


def test_one_of_several_drives_is_told_while_others_rest():
    measured = two_drives(np.zeros(len(TIME))).frf(drive=0)
    assert measured.drive == (("z", 0.5),)


REFUSED = {
    "free motion": (lambda: made(TIME, motion(TIME)).frf(), "drive must be there"),
    "no force at the times": (
        lambda: made(TIME, motion(TIME), force=0 * TIME).frf(),
        "a blow needs a duration",
    ),
    "two forces": (lambda: two_drives(blow(TIME)).frf(), "got some at 1"),
    "no such drive": (lambda: two_drives(blow(TIME)).frf(drive=2), "drive must be"),
    "no segment": (lambda: noisy(0), "segments must be"),
    "too many segments": (lambda: noisy(10_000), "segments must be"),
    "band of one": (lambda: two_drives(0 * TIME).frf(band=[3.0]), "band must be two"),
    "band that falls": (lambda: two_drives(0 * TIME).frf(band=[3.0, 2.0]), "band must be two"),
    "band beyond": (lambda: two_drives(0 * TIME).frf(band=[3e3, 4e3]), "band must hold"),
    "window": (lambda: two_drives(0 * TIME).frf(window="round"), "window must be"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_measures_nothing_is_refused(name):
    call, words = REFUSED[name]
    with pytest.raises(rd.SceneError, match=words):
        call()


def build(**changes):
    given = {"frequency": [10.0, 20.0], "value": [1e-4, 2e-4j], "drive": ("z", 0.5)}
    return rd.Measured(**given | {"response": ("z", 0.5)} | changes)


def test_numbers_by_hand_are_a_measurement():
    measured = build(coherence=[0.9, 1.0])
    assert measured.drive == (("z", 0.5),)
    assert measured.value.tolist() == [[1e-4, 2e-4j]]
    assert measured.coherence.tolist() == [[0.9, 1.0]]
    assert measured.curve().shape == (2,)


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"frequency": [20.0, 10.0]}, rd.SceneError, "frequency must increase"),
        ({"frequency": "10"}, TypeError, "frequency must be"),
        ({"value": [1e-4]}, rd.SceneError, "value must be finite numbers of shape"),
        ({"value": [1e-4, np.nan]}, rd.SceneError, "value must be finite numbers"),
        ({"value": "large"}, TypeError, "value must be finite numbers"),
        ({"coherence": [[0.9]]}, rd.SceneError, "coherence must be finite numbers"),
        ({"coherence": [0.9, 1.1]}, rd.SceneError, "coherence must lie between 0 and 1"),
        ({"averages": 0}, rd.SceneError, "averages must be a finite number > 0"),
        ({"drive": None}, TypeError, "drive must be a coordinate and a position"),
        ({"drive": ("w", 0.5)}, rd.SceneError, r"drive\[0\] must be one of"),
        ({"drive": [("z", 0.5), ("z", 0.6)]}, rd.SceneError, "drive must be one point"),
        ({"response": ("F_q", 0.5)}, rd.SceneError, r"response\[0\] must be one of"),
        ({"response": ()}, rd.SceneError, "response must be"),
        ({"quantity": "displacement"}, rd.SceneError, "quantity must be one of"),
    ],
)
def test_numbers_without_meaning_are_refused(changes, error, words):
    with pytest.raises(error, match=words):
        build(**changes)
