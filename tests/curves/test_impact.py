"""Responses per force from records of hits and of noise, by their own forward model."""

import dataclasses
import re

import hammer
import numpy as np
import pytest
from scipy import signal

import ropedyn as rd
from ropedyn.curves.measured import lines_of
from ropedyn.curves.record.hits import measured_response

FIRST, RATIO = 8.0, 0.01
STRING = hammer.HeldString(8, FIRST, RATIO, 0.3, (0.3, 0.45))
HITS = ((1.0, 1.0), (17.0, 1.3), (33.0, 0.8), (49.0, 1.1))
ALL = {"hits": HITS, "duration": 65.0, "width": 0.02}
ORDER = {"displacement": 0, "velocity": 1, "acceleration": 2}
FORWARD = 1e-3
"""Of the largest: what is left of the hit before, e^-8 = 3e-4, and of what the filter lets pass."""


@pytest.fixture(scope="module")
def clean():
    """A record without noise."""
    return hammer.record(STRING, **ALL)


def truth(measured, quantity="acceleration", string=STRING):
    """The exact response where it was measured."""
    return hammer.exact_receptance(string, measured.s) * measured.s ** ORDER[quantity]


def off(measured, quantity="acceleration", below=60.0):
    """Largest error over the largest response."""
    true, band = truth(measured, quantity), measured.frequency < below
    return np.abs(measured.value - true)[:, band].max() / np.abs(true[:, band]).max()


def lowest(measured):
    """The lines of the first two modes."""
    return lines_of(measured, measured.frequency < 20.0)


def noisy(seed, **more):
    """A record with 1 % of noise on the motion and .1 % on the force."""
    return hammer.record(
        STRING, **(ALL | {"noise": 0.01, "force_noise": 1e-3, "seed": seed} | more)
    )


# --- the response of hits ------------------------------------------------------------------------


@pytest.mark.parametrize("quantity", ORDER)
@pytest.mark.parametrize("decay, length", [(0.0, None), (0.5, 10.0), (4.0, 2.0), (12.0, 1.0)])
def test_hits_tell_the_response_at_the_decay_of_the_window(quantity, decay, length):
    record = hammer.record(STRING, quantity=quantity, **ALL)
    measured = measured_response(record, decay=decay, length=length)
    assert measured.decay == decay
    assert measured.quantity == ["receptance", "mobility", "accelerance"][ORDER[quantity]]
    assert (measured.drive, measured.response) == (record.drive, record.response)
    assert measured.averages == 4
    assert off(measured, quantity) < FORWARD


def test_the_decay_is_chosen_so_that_nothing_is_cut(clean):
    long, short = measured_response(clean), measured_response(clean, length=2.0)
    # e^-8 is left of the first mode after 16 s, e^-1 after 2 s, in parts of what is not
    assert long.decay == 0
    assert short.decay == pytest.approx(np.log(1000 / (np.e - 1)) / 2, rel=0.1)
    assert off(long) < FORWARD and off(short) < 3 * FORWARD
    assert long.notes == short.notes == ()


def test_poles_of_peaks_are_those_without_the_window(clean):
    for decay, length in ((0.0, None), (0.5, 12.0), (1.5, 6.0)):
        (peaks, _) = lowest(measured_response(clean, decay=decay, length=length)).peaks()
        assert np.abs(peaks.frequency[:2] / [FIRST, 2 * FIRST] - 1).max() < 3e-4
        # a window of three times the decay of the mode; other modes bend a wider peak more
        assert np.abs(peaks.damping_ratio[:2] / RATIO - 1).max() < 0.01 + 0.02 * decay


def test_a_window_that_is_not_told_makes_damping_too_large(clean):
    measured = lowest(measured_response(clean, decay=1.5, length=6.0))
    wrong = dataclasses.replace(measured, decay=0.0).peaks()[0]
    # decay over that of the mode, 1.5/(0.01 2 pi 8)
    assert wrong.damping_ratio[0] / RATIO - 1 == pytest.approx(2.98, abs=0.1)


def test_peaks_of_one_mode_move_by_exactly_the_decay():
    f, d = np.arange(6.0, 10.0, 0.05), 1.5
    s = 2j * np.pi * f + d
    own, ratio = 2 * np.pi * 8.0, 0.004
    for quantity, times in (("receptance", 0), ("accelerance", 2)):
        value = s**times / (own**2 + 2 * ratio * own * s + s**2)
        point = ("z", 0.5)
        measured = rd.Measured(f, value, drive=point, response=point, quantity=quantity, decay=d)
        (peaks,) = measured.peaks()
        assert abs(peaks.frequency[0] / 8.0 - 1) < 1e-12
        assert abs(peaks.damping_ratio[0] / ratio - 1) < 1e-9
        # of three lines alone, without a fit
        (few,) = rd.Measured(f[37:44], value[37:44], drive=point, response=point,
                             quantity=quantity, decay=d).peaks()  # fmt: skip
        assert abs(few.frequency[0] / 8.0 - 1) < 1e-9
        assert abs(few.damping_ratio[0] / ratio - 1) < 1e-6


def test_the_gate_takes_the_noise_of_the_force_away():
    error = {
        gate: np.median([off(measured_response(noisy(seed, force_noise=0.01, noise=0.0), gate=gate))
                         for seed in range(4)])
        for gate in (True, False)
    }  # fmt: skip
    assert error[False] > 3 * error[True]


def test_estimators_agree_at_resonance():
    found = [measured_response(noisy(1), estimator=name) for name in ("H1", "H2", "Hv")]
    at = np.abs(found[0].frequency - FIRST).argmin()
    for one in found[1:]:
        assert np.abs(one.value[:, at] / found[0].value[:, at] - 1).max() < 1e-3


def test_coherence_is_low_where_the_motion_is_noise():
    measured = measured_response(noisy(2, noise=0.2))
    peak = np.abs(measured.frequency - FIRST).argmin()
    assert measured.coherence[:, peak].min() > 0.99
    assert np.median(measured.coherence[:, measured.frequency < 5.0]) < 0.9


def covered(seeds, **more):
    """Share of lines below 40 Hz, their parts, within two standard uncertainties."""
    z = []
    for seed in seeds:
        measured = measured_response(noisy(seed, force_noise=0.0, **more))
        band = measured.frequency < 40.0
        z.append(((measured.value - truth(measured)) / measured.std)[:, band].ravel())
    z = np.concatenate(z)
    return (np.abs(np.concatenate([z.real, z.imag])) < 1.96).mean()


def test_std_over_hits_covers():
    # 4000 correlated numbers: 0.95 within 0.02
    assert 0.92 < covered((11,), noise=0.03) < 0.98


@pytest.mark.slow
@pytest.mark.claim(
    "the 95 % of lines of a response by hits that lie within their uncertainties",
    reference="exact responses of 20 records",
    accepted=0.02,
)
def test_std_over_hits_covers_in_many_records(claim):
    claim(abs(covered(range(100, 120), noise=0.03) - 0.95))


# --- hits that are left out or named ------------------------------------------------------------


def test_a_clipped_hit_is_left_out_by_name():
    record = hammer.record(STRING, **ALL)
    record.force = np.minimum(record.force, 1.15)
    measured = measured_response(record)
    assert measured.averages == 3
    assert measured.notes == ("the hit at 17 s is left out: its force is clipped",)
    assert off(measured) < FORWARD


def test_a_hit_too_late_in_the_record_is_left_out_by_name():
    record = hammer.record(STRING, **(ALL | {"duration": 52.0}))
    measured = measured_response(record)
    assert measured.averages == 3
    words = "the hit at 49 s is left out: its response is cut: the record ends after 3.03 of 16 s"
    assert measured.notes == (words,)
    assert off(measured) < FORWARD


def test_a_double_hit_does_no_harm_and_is_named():
    hits = (*HITS[:2], (17.12, 0.5), *HITS[2:])
    measured = measured_response(hammer.record(STRING, **(ALL | {"hits": hits})))
    assert measured.averages == 4
    assert measured.notes == ("the hit at 17 s has 2 pulses, all of them gated",)
    assert off(measured) < FORWARD


def test_one_hit_tells_no_noise_and_says_so():
    record = hammer.record(STRING, **(ALL | {"hits": HITS[:1], "duration": 14.0}))
    measured = measured_response(record)
    assert measured.std is None and measured.coherence is None and measured.averages == 1
    assert measured.notes == ("one hit was used: nothing tells its noise, more hits would",)


def test_motion_that_is_cut_is_said(clean):
    measured = measured_response(clean, decay=0.0, length=4.0)
    (note,) = measured.notes
    # e^(-0.01 2 pi 8 4) of a mode that is cut
    said = float(re.match(r"([\d.]+)% of the motion comes behind records of 4 s", note)[1])
    assert 10 < said < 20
    assert (measured.std > 0.01 * np.abs(truth(measured)).max() / 10).any()


def test_motion_from_before_a_hit_is_said():
    hits = tuple((1.0 + 2 * k, 1.0) for k in range(6))
    measured = measured_response(hammer.record(STRING, **(ALL | {"hits": hits, "duration": 13.0})))
    (note,) = measured.notes
    # e^(-0.01 2 pi 8 2) = 0.37 of the motion
    said = float(re.search(r"up to ([\d.]+)% of its motion when it is hit", note)[1])
    assert 30 < said < 60
    band = measured.frequency < 40.0
    z = np.abs((measured.value - truth(measured)) / measured.std)[:, band]
    assert (z < 2.8).mean() > 0.9


def test_a_record_without_a_usable_hit_is_refused_with_every_reason():
    record = hammer.record(STRING, **(ALL | {"hits": HITS[:2], "duration": 33.0}))
    record.value = np.clip(record.value, -1e-1, 1e-1)
    words = (
        "force must have a hit that can be used, got 2: the hit at 1.002 s is left out: response 0"
    )
    with pytest.raises(rd.SceneError, match=re.escape(words)):
        measured_response(record)


def test_a_hit_at_the_first_sample_is_used():
    record = hammer.record(STRING, hits=((0.0, 1.0),), duration=16.0)
    measured = measured_response(record)
    assert measured.averages == 1
    # half of what the filter rings before the hit is cut
    assert off(measured) < 10 * FORWARD


def test_a_force_of_which_nothing_stands_out_is_refused():
    record = hammer.record(STRING, **ALL)
    record.force = np.where(np.arange(len(record.force)) % 2, 0.09, -0.09)
    record.force[:1000] = 0.0
    record.force[5000:5003] = 1.0
    with pytest.raises(rd.SceneError, match="got 0: none out of the noise"):
        measured_response(record)


# --- a force that acts all the time -------------------------------------------------------------


DAMPED = hammer.HeldString(8, FIRST, 0.03, 0.3, (0.3, 0.45))


def shaker(duration=100.0, **more):
    """A record of band limited noise."""
    rng = np.random.default_rng(21)
    low = signal.butter(6, 60.0, fs=512.0, output="sos")

    def force(samples):
        push = signal.sosfilt(low, rng.standard_normal(samples // hammer.FINER))
        return signal.resample_poly(push, hammer.FINER, 1)

    return hammer.record(DAMPED, duration=duration, force=force, **more)


def test_noise_tells_the_response_by_segments():
    measured = measured_response(shaker(noise=0.05))
    assert measured.decay == 0 and measured.averages == pytest.approx(0.53 * 16)
    band = measured.frequency < 40.0
    assert np.median(measured.coherence[:, band]) > 0.9
    # 47 s of Hann's window widen peaks of 0.16 Hz by a fiftieth
    at = [np.abs(measured.frequency - k * FIRST).argmin() for k in (1, 2)]
    # lines of 8.5 averages with a coherence of 0.98, and a window of 0.12 Hz over peaks of 0.5 Hz
    assert np.abs(measured.value / truth(measured, string=DAMPED) - 1)[:, at].max() < 0.1


def test_the_length_of_segments_may_be_chosen():
    measured = measured_response(shaker(), length=10.0, estimator="H2")
    assert measured.averages == pytest.approx(0.53 * 19)
    assert measured.frequency[1] - measured.frequency[0] == pytest.approx(0.1, rel=1e-3)


# --- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given, error, words",
    [
        ({"estimator": "H3"}, rd.SceneError, "estimator must be"),
        ({"decay": -1.0}, rd.SceneError, "decay must be a finite number >= 0 [1/s], got -1.0"),
        ({"decay": "slow"}, TypeError, "decay must be"),
        ({"gate": 1}, TypeError, "gate must be True or False"),
        ({"length": 0.0}, rd.SceneError, "length must be a finite number > 0 [s], got 0.0"),
        ({"length": 1e-3}, rd.SceneError, "length must be from 0.03125 to 65 s"),
        ({"length": 66.0}, rd.SceneError, "length must be from 0.03125 to 65 s"),
    ],
)
def test_what_has_no_meaning_is_refused(clean, given, error, words):
    with pytest.raises(error, match=re.escape(words)):
        measured_response(clean, **given)


def test_a_record_without_force_is_refused():
    record = hammer.record(STRING, duration=2.0, hits=())
    with pytest.raises(rd.SceneError, match="force must act for a response per force"):
        measured_response(record)
    record.force = None
    with pytest.raises(rd.SceneError, match="got a record without"):
        measured_response(record)


def test_a_window_of_hits_is_refused_for_noise():
    record = shaker(duration=20.0)
    with pytest.raises(rd.SceneError, match=r"decay is the window of hits, got 1\.0 1/s"):
        measured_response(record, decay=1.0)
    with pytest.raises(rd.SceneError, match="length must be from"):
        measured_response(record, length=15.0)


# --- files ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix, binary", [(".csv", False), (".uff", True), (".uff", False)])
def test_files_keep_what_hits_told(tmp_path, suffix, binary):
    measured = measured_response(noisy(5), decay=0.5)
    measured = dataclasses.replace(measured, notes=("the hit at 3 s is left out",))
    measured.write(tmp_path / f"hits{suffix}", binary=binary)
    again = rd.Measured.read(tmp_path / f"hits{suffix}")
    digits = 0 if binary or suffix == ".csv" else 1e-11
    for name in ("value", "coherence", "std"):
        np.testing.assert_allclose(getattr(again, name), getattr(measured, name), rtol=digits)
    assert (again.decay, again.averages) == (measured.decay, measured.averages)
    assert again.notes == (measured.notes if suffix == ".csv" else ())


def test_the_decay_of_a_file_may_be_said(tmp_path):
    measured = dataclasses.replace(measured_response(noisy(5), decay=0.5), decay=0.0)
    measured.write(tmp_path / "hits.csv")
    assert rd.Measured.read(tmp_path / "hits.csv", decay=0.5).decay == 0.5


@pytest.mark.parametrize(
    "given, error, words",
    [
        ({"decay": -1.0}, rd.SceneError, "decay must be a finite number >= 0 [1/s], got -1.0"),
        ({"std": [[-1.0, 1.0]]}, rd.SceneError, "std must be >= 0"),
        ({"std": [[1.0]]}, rd.SceneError, "std must be finite numbers of shape (1, 2)"),
        ({"notes": "late"}, TypeError, "notes must be a sequence of texts"),
        ({"notes": [1]}, TypeError, "notes[0] must be a text"),
    ],
)
def test_a_measured_response_refuses_what_has_no_meaning(given, error, words):
    with pytest.raises(error, match=re.escape(words)):
        rd.Measured([1.0, 2.0], [1.0, 2.0], drive=("z", 0.5), response=("z", 0.5), **given)
