"""Hits in a force: where they are, which can be used, what they tell."""

import hammer
import numpy as np
import pytest

from ropedyn.signal import hits as module
from ropedyn.signal.hits import clipped, find_hits, find_pulses, is_of_hits, jackknifed
from ropedyn.signal.transfer import ESTIMATORS, Spectra, coherence_of

RATE = 512.0
TIME = np.arange(int(60 * RATE)) / RATE


def force_of(*hits, width=0.02, offset=0.0, noise=0.0, seed=0):
    """A force of hits (when, how strong)."""
    rng = np.random.default_rng(seed)
    return hammer.pulses(TIME, hits, width) + offset + noise * rng.standard_normal(len(TIME))


def silence(rows=1):
    """A response of noise alone."""
    return np.random.default_rng(9).standard_normal((rows, len(TIME)))


def reasons(force, value=None, length=None):
    """Why each hit is left out."""
    found = find_hits(RATE, force, silence() if value is None else value, length)
    return [hit.reason for hit in found.each]


# --- where they are -----------------------------------------------------------------------------


@pytest.mark.parametrize("sign", [1, -1])
def test_pulses_are_found_in_an_offset_and_noise(sign):
    force = sign * force_of((1.0, 50.0), (21.0, 80.0), (41.0, 10.0), offset=3.0, noise=0.1)
    found = find_pulses(force)
    assert [round(pulse.start / RATE) for pulse in found] == [1, 21, 41]
    # the noise is a hundredth of the smallest
    np.testing.assert_allclose([pulse.peak for pulse in found], [50, 80, 10], rtol=0.05)


def test_hits_are_told_from_a_force_that_acts_all_the_time():
    rng = np.random.default_rng(3)
    assert is_of_hits(force_of(*((2.0 * k + 1, 1.0) for k in range(29)), noise=0.01))
    assert not is_of_hits(rng.standard_normal(len(TIME)))
    assert not is_of_hits(np.sin(TIME))
    assert not is_of_hits(np.zeros(len(TIME)))


def test_a_double_hit_is_one_record():
    found = find_hits(
        RATE, force_of((1.0, 5.0), (1.3, 2.0), (20.0, 5.0), (40.0, 4.0)), silence(), None
    )
    assert [len(hit.pulses) for hit in found.each] == [2, 1, 1]
    assert [hit.reason for hit in found.each] == ["", "", ""]
    # as long as between the hits that are nearest, and the ringing before
    assert found.length == round(19.0 * RATE)


def test_hits_within_the_length_that_is_asked_for_are_one_record():
    found = find_hits(RATE, force_of((1.0, 5.0), (6.0, 2.0), (31.0, 5.0)), silence(), 5120)
    assert [len(hit.pulses) for hit in found.each] == [2, 1]
    assert found.length == 5120


# --- which can be used --------------------------------------------------------------------------


def test_a_clipped_force_is_rejected():
    force = np.minimum(force_of((1.0, 5.0), (21.0, 9.0), (41.0, 5.5), noise=0.01), 7.0)
    assert reasons(force) == ["", "its force is clipped", ""]


def test_an_overloaded_response_is_rejected():
    value = silence(2)
    value[1, 11_000:11_050] = 30.0 * np.sin(np.arange(50) / 5)
    value[1] = np.clip(value[1], -20.0, 20.0)
    force = force_of((1.0, 5.0), (21.0, 5.0), (41.0, 5.0))
    assert reasons(force, value) == ["", "response 1 is clipped", ""]


def test_a_response_that_is_cut_is_rejected():
    force = force_of((1.0, 5.0), (21.0, 5.0), (41.0, 5.0), (58.0, 5.0))
    assert reasons(force) == [
        *[""] * 2,
        "",
        "its response is cut: the record ends after 2.03 of 17 s",
    ]
    early = force_of((1.0, 5.0), (21.0, 5.0), (25.0, 5.0), (41.0, 5.0))
    assert reasons(early)[1] == "its response is cut: the next hit comes after 4 of 16 s"


def test_a_hit_without_force_is_rejected():
    force = force_of((1.0, 5.0), (21.0, 0.3), (41.0, 5.0))
    # the largest sample of a pulse may stand beside its top
    assert reasons(force)[1].startswith("it has no force: 0.")
    assert reasons(force)[::2] == ["", ""]


def test_a_rounded_top_of_a_coarse_converter_is_not_clipped():
    force = force_of((1.0, 1000.0), width=2.0)
    assert (np.round(force) == np.round(force).max()).sum() >= module.FLAT
    assert not clipped(np.round(force))[force > 900].any()
    assert clipped(np.round(np.minimum(force, 900)))[force > 900].all()


# --- what they tell -----------------------------------------------------------------------------


def noisy_spectra(n, rng, on_force=0.0, on_motion=0.0, lines=2000):
    """Spectra of n records of a response 2 - i, and the truth."""

    def noise(size):
        return size * (rng.standard_normal((n, lines)) + 1j * rng.standard_normal((n, lines)))

    F = 1.0 + noise(0.3)
    X = (2 - 1j) * F + noise(on_motion)
    F = F + noise(on_force)
    return Spectra(np.abs(F) ** 2, (F.conj() * X)[:, None], np.abs(X)[:, None] ** 2), 2 - 1j


@pytest.mark.parametrize(
    "estimator, on_force, on_motion",
    [("H1", 0.0, 0.5), ("H2", 0.25, 0.0), ("Hv", 0.2, 0.2 * 5**0.5)],
)
def test_each_estimator_is_unbiased_under_its_own_noise(estimator, on_force, on_motion):
    rng = np.random.default_rng(4)
    each, true = noisy_spectra(50, rng, on_force, on_motion)
    found = ESTIMATORS[estimator](each.total)
    # the mean over 2000 lines of 50 averages; of second order in the noise 1/(2 50) of its square
    assert abs(found.mean() / true - 1) < 4e-3
    for other in {"H1", "H2", "Hv"} - {estimator}:
        assert abs(np.abs(ESTIMATORS[other](each.total)).mean() / abs(true) - 1) > 0.01


def test_estimators_agree_without_noise():
    each, true = noisy_spectra(3, np.random.default_rng(5))
    for estimator in ESTIMATORS.values():
        np.testing.assert_allclose(estimator(each.total), true, rtol=1e-14)
    np.testing.assert_allclose(coherence_of(each.total), 1.0, rtol=1e-14)


@pytest.mark.parametrize("n", [2, 3, 8])
def test_the_jackknife_over_hits_covers_as_it_says(n):
    each, true = noisy_spectra(n, np.random.default_rng(6 + n), on_motion=0.2)
    off = (ESTIMATORS["H1"](each.total) - true) / jackknifed(each, "H1", 1.0)
    inside = np.abs(np.concatenate([off.real, off.imag])) < 1.96
    # 4000 numbers, so that 0.95 is within 0.007; of two hits the bias of the jackknife widens
    assert 0.94 < inside.mean() < (0.985 if n == 2 else 0.97)
