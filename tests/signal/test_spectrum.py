"""Spectra and steady amplitudes of motion over time, against the motion they are made of."""

import numpy as np
import pytest
from made_history import made

import ropedyn as rd

EPS = np.finfo(float).eps
TIME = 0.25 + np.arange(400) / 200.0  # 2 s at 200 Hz, not from 0
STEADY = 0.7 - 0.4j


def steady(frequency, amplitude=STEADY, time=TIME):
    return (amplitude * np.exp(2j * np.pi * frequency * time)).real


@pytest.mark.parametrize("window", ["hann", "boxcar", "flattop", "blackman"])
def test_a_sine_at_a_line_shows_its_amplitude_and_phase(window):
    spectrum = made(TIME, [steady(30.0), 2 * steady(42.5)]).spectrum(window=window)
    assert spectrum.frequency.tolist() == (np.arange(201) / 2).tolist()
    found = spectrum.value[[0, 1], [60, 85]]
    # sums of 400 terms
    np.testing.assert_allclose(found, [STEADY, 2 * STEADY], rtol=400 * EPS)


def test_what_stands_still_shows_at_0_hz_and_the_fastest_at_half_the_rate():
    fastest = np.cos(np.pi * np.arange(400))
    spectrum = made(TIME - 0.25, 3.0 + 0.5 * fastest).spectrum(window="boxcar")
    np.testing.assert_allclose(spectrum.amplitude[0, [0, -1]], [3.0, 0.5], rtol=400 * EPS)
    assert spectrum.amplitude[0, 1:-1].max() < 400 * EPS


@pytest.mark.parametrize("n", [400, 399])
def test_density_without_a_window_sums_to_the_mean_square(n):
    value = np.random.default_rng(7).normal(size=n)
    time = np.arange(n) / 200.0
    spectrum = made(time, value).spectrum(window="boxcar")
    density = spectrum.psd[0].copy()
    if n % 2 == 0:
        # a line at half the rate has the mean square of its amplitude, as what stands still
        density[-1] *= 2
    assert density.sum() * 200.0 / n == pytest.approx(np.mean(value**2), rel=n * EPS)


def test_density_of_white_noise_is_its_variance_over_half_the_rate():
    n, rate, std = 2**16, 500.0, 0.3
    value = std * np.random.default_rng(3).normal(size=n)
    density = made(np.arange(n) / rate, value).spectrum().psd[0]
    # the mean of about n/2/1.5 independent lines with the standard deviation of each its mean
    level = 2 * std**2 / rate
    assert density[5:-5].mean() == pytest.approx(level, rel=4 * np.sqrt(3 / n))


def test_the_table_and_the_labels_name_units():
    spectrum = made(TIME, steady(30.0), quantity="velocity").spectrum()
    assert spectrum.labels == ("z at 0.100 m [m/s]",)
    assert spectrum.table().columns[1] == "|z at 0.100 m [m/s]|"


def test_unequal_steps_are_refused():
    time = TIME.copy()
    time[17] += 1e-4
    with pytest.raises(rd.SceneError, match=r"time must have equal steps, .* got time\[17\]"):
        made(time, steady(30.0)).spectrum()


@pytest.mark.parametrize(("window", "error"), [("round", rd.SceneError), (3, TypeError)])
def test_unknown_windows_are_refused(window, error):
    with pytest.raises(error, match="window must be"):
        made(TIME, steady(30.0)).spectrum(window=window)


def test_the_amplitude_of_a_sine_is_found_between_lines_beside_rest_and_drift():
    value = [steady(31.7) + 5.0 + 0.3 * TIME, -2 * steady(31.7)]
    found = made(TIME, value).amplitude(31.7)
    # the fit solves 400 equations whose largest term is 5
    np.testing.assert_allclose(found, [STEADY, -2 * STEADY], atol=5 * 400 * EPS)


def test_a_sine_force_has_the_amplitude_minus_i():
    time = np.linspace(0.0, 1.0, 301)
    history = made(time, rd.Sine(10.0, 20.0).value(time))
    np.testing.assert_allclose(history.amplitude(20.0), [-10j], atol=10 * 301 * EPS)


def test_harmonics_are_fitted_together_at_times_of_any_distance():
    time = np.sort(np.random.default_rng(5).uniform(0.0, 1.0, 300))
    value = steady(20.0, time=time) + steady(40.0, 0.1j, time) + steady(60.0, 0.02, time)
    found = made(time, value).amplitude([20.0, 40.0, 60.0])
    np.testing.assert_allclose(found, [[STEADY, 0.1j, 0.02]], atol=300 * EPS)


def test_only_the_end_of_the_record_is_taken():
    value = np.where(TIME < 1.25, 100.0, steady(30.0))
    found = made(TIME, value).amplitude(30.0, last=1.0 - 1e-9)
    np.testing.assert_allclose(found, [STEADY], atol=400 * EPS)


@pytest.mark.parametrize(
    ("frequency", "last", "words"),
    [
        (100.0, None, "frequency must be below half the rate of the times, 100 Hz"),
        (0.0, None, "frequency must be different numbers > 0"),
        ([20.0, 20.0], None, "frequency must be different numbers > 0"),
        (30.0, 0.01, "last must hold 4 times at least, got 3"),
        (30.0, -1.0, "last must be a finite number > 0"),
        (1e-9, None, "last must be long enough to tell 1e-09 Hz"),
    ],
)
def test_amplitudes_that_the_record_does_not_tell_are_refused(frequency, last, words):
    with pytest.raises(rd.SceneError, match=words):
        made(TIME, steady(30.0)).amplitude(frequency, last=last)
