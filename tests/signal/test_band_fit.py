"""Fit of one mode to the lines of a band, and sinusoids in noise."""

from types import SimpleNamespace

import numpy as np
import pytest

from ropedyn.signal import band_fit
from ropedyn.signal.band_fit import FourierLines, fit_band
from ropedyn.signal.steady_lines import take_lines

DURATION, F0 = 600.0, 4.0
ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}


def lines(rng, quantity, *, ratio=0.004, channels=3, noise=1e-2, wide=8.0, slope=0.0):
    """Return lines of a mode under Gaussian load as the model has them, noise per peak."""
    half = max(wide * ratio * F0, 12 / DURATION)
    f = np.arange(np.ceil((F0 - half) * DURATION), (F0 + half) * DURATION) / DURATION
    # u (displacement) = p/(f_0^2 - f^2 + 2 i zeta f_0 f), each derivative a factor f
    h = 2 * ratio * F0**2 / (F0**2 - f**2 + 2j * ratio * F0 * f) * (f / F0) ** ORDERS[quantity]
    # a finite duration, which `blurred` describes: here the load makes what it says
    band = band_fit._Band.of(FourierLines(f, np.full(len(f), DURATION), h[np.newaxis]), quantity)
    blur = band.blurred(np.log([F0, ratio]))[0]
    load = np.sqrt(blur) * (f / F0) ** (slope / 2)
    shape = np.array([0.3, 0.5, 0.8])[:channels]
    shape /= np.linalg.norm(shape)

    def gaussian(*size):
        return (rng.standard_normal(size) + 1j * rng.standard_normal(size)) / np.sqrt(2)

    value = np.outer(shape, load * h * gaussian(len(f)))
    value = value + np.sqrt(noise) * gaussian(channels, len(f))
    return FourierLines(f, np.full(len(f), DURATION), value), shape


@pytest.mark.parametrize("quantity", ORDERS)
@pytest.mark.parametrize("channels", [1, 3])
def test_uncertainty_of_a_mode_is_what_its_load_makes_of_it(quantity, channels):
    rng = np.random.default_rng(11)
    z = []
    for _ in range(40):
        band, shape = lines(rng, quantity, channels=channels, slope=rng.uniform(-2, 2))
        found = fit_band(band, quantity, F0 * 1.003, 0.006)
        z.append(np.log([found.frequency / F0, found.ratio / 0.004]) / found.log_std)
        assert abs(found.shape @ shape) > 0.99
    # 40 trials know a root mean square to 11 %: three times that
    assert np.sqrt(np.mean(np.square(z), axis=0)) == pytest.approx([1.0, 1.0], abs=0.35)


def test_the_wrong_amplification_is_the_wrong_mode():
    """What is taken for a displacement and is an acceleration is off by far, where it is wide."""
    rng = np.random.default_rng(5)
    band, _ = lines(rng, "acceleration", ratio=0.02, noise=1e-4, wide=30.0)
    right, wrong = (fit_band(band, q, F0, 0.02) for q in ("acceleration", "displacement"))
    assert abs(np.log(right.ratio / 0.02)) < 4 * right.log_std[1]
    assert wrong.gain < right.gain


@pytest.mark.parametrize("quantity", ORDERS)
def test_slopes_are_differences_of_the_value(quantity):
    rng = np.random.default_rng(2)
    given, _ = lines(rng, quantity)
    band = band_fit._Band.of(given, quantity)
    x = np.array([np.log(1.003 * F0), np.log(0.005), 0.3, -4.0, 0.4, -3.0, 0.07, 3.0])
    step = 1e-6
    differences = [
        (band_fit._value(band, x + step * one)[0] - band_fit._value(band, x - step * one)[0])
        / (2 * step)
        for one in np.eye(len(x))
    ]
    # rounding: eps times the value, some 1e3, over the step
    size = np.finfo(float).eps * abs(band_fit._value(band, x)[0]) / step
    np.testing.assert_allclose(band_fit._value(band, x)[1], differences, rtol=1e-6, atol=100 * size)


def test_a_finite_duration_widens_a_resonance_as_simulated():
    # the mean periodogram of a decay that is driven by white noise
    rng = np.random.default_rng(3)
    rate, n, f0, ratio = 8.0, 256, 1.0, 0.01
    many = 3000
    pole = np.exp(2 * np.pi * f0 / rate * (-ratio + 1j * np.sqrt(1 - ratio**2)))
    from scipy.signal import lfilter

    load = rng.standard_normal((many, 8 * n))
    motion = lfilter([1.0], [1.0, -2 * pole.real, abs(pole) ** 2], load)[:, -n:]
    power = np.mean(np.abs(np.fft.rfft(motion)) ** 2, axis=0) / n
    f = np.fft.rfftfreq(n, 1 / rate)
    z = np.exp(2j * np.pi * f / rate)
    exact = np.abs(1 / (1 - 2 * pole.real / z + abs(pole) ** 2 / z**2)) ** 2
    near = np.abs(f - f0) < 0.1
    value = np.ones((1, near.sum()), complex)
    band = band_fit._Band.of(
        FourierLines(f[near], np.full(near.sum(), n / rate), value), "displacement"
    )
    blur = band.blurred(np.log([f0, ratio]))[0]
    # 3000 trials know a mean power to 1.8 %, each of 7 lines to some 5 %
    assert np.abs(power[near] / exact[near] / blur - 1).max() < 0.08
    assert np.abs(power[near] / exact[near] - 1).min() > 0.25


def test_a_band_of_noise_gains_nothing():
    rng = np.random.default_rng(4)
    gains = []
    for _ in range(40):
        band, _ = lines(rng, "acceleration", noise=1e6)
        found = fit_band(band, "acceleration", F0, 0.004)
        gains.append(0.0 if found is None else found.gain)
    # peaks need 8: see `output_peaks`
    assert max(gains) < 8


def test_a_sinusoid_is_found_to_what_noise_allows_and_taken_away():
    rng = np.random.default_rng(6)
    rate, n = 20.0, 6000
    time, shape = np.arange(n) / rate, np.array([[0.2], [-0.6]])
    z = []
    for _ in range(20):
        f = rng.uniform(2.0, 6.0)
        noise = rng.standard_normal((2, n))
        line = 0.5 * shape * np.sin(2 * np.pi * f * time + rng.uniform(0, 6))
        (found,), (rest,) = take_lines([noise + line], rate, 0.5, 8.0)
        z.append((found.frequency - f) / found.std)
        assert abs(found.shape @ shape[:, 0] / np.linalg.norm(shape)) > 0.97
        # amplitudes are known to sqrt(2/n) = 0.02, at the ends twice that for the frequency
        assert np.abs(rest - noise).max() < 0.2
    # 20 trials know a root mean square to 16 %: two and a half times that
    assert np.sqrt(np.mean(np.square(z))) == pytest.approx(1.0, abs=0.4)


def test_noise_shows_no_sinusoid():
    rng = np.random.default_rng(7)
    pieces = [rng.standard_normal((2, 6000))]
    found, (rest,) = take_lines(pieces, 20.0, 0.5, 8.0)
    assert found == []
    assert rest is pieces[0]


def test_the_shape_is_that_of_lines_above_the_noise():
    """Each counts as signal over all it holds; peak and rise are those of the form."""
    form, top, noise, other = np.array([1e-3, 500.0, 1e-2]), 2.0, 1.0, 0.01
    mode, rest = np.array([0.6, 0.8]), np.array([0.8, -0.6])
    square = np.stack([np.outer(s, s) * size for s, size in ((rest, 9), (mode, 1), (rest, 9))])
    band = SimpleNamespace(amplified=lambda best: (form,), square=square)
    best = np.array([np.log(F0), np.log(0.01), np.log(top), np.log(noise), 0.0, np.log(other / 2)])
    found = band_fit._mode(band, best, np.diag([1e-8, 1e-4, 1.0, 1.0, 1.0, 1.0]), 3.0)
    share = 1 - noise / (top * form + other + noise)
    weighted = share[1] * np.outer(mode, mode) + (share[0] + share[2]) * 9 * np.outer(rest, rest)
    largest = np.linalg.eigh(weighted)[1][:, 1]
    assert np.abs(found.shape) == pytest.approx(np.abs(largest), rel=1e-12)
    assert (found.frequency, found.ratio) == (pytest.approx(F0), pytest.approx(0.01))
    assert found.log_std == (pytest.approx(1e-4), pytest.approx(1e-2))
    assert found.signal == pytest.approx(top * 500.0 / (other + noise), rel=1e-12)
    every = other + noise
    assert found.rise == pytest.approx((top * 500.0 + every) / (top * 1e-2 + every), rel=1e-12)
