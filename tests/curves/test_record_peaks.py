"""Peaks of records that nobody has driven on purpose."""

from typing import NamedTuple

import numpy as np
import pytest
from dirty_record import dirty_record

import ropedyn as rd


class Found(NamedTuple):
    """What the peaks of some records are against what the records were made of."""

    records: int
    modes: int  # of the rope
    missed: int
    false: int  # called modes and neither of the rope nor of the deck
    named: int  # sinusoids called lines
    lines: int
    z: np.ndarray  # errors of frequencies in standard uncertainties
    ratio_z: np.ndarray  # of logarithms of damping ratios


def judge(seeds, **more):
    missed, false, named, lines, z, ratio_z = 0, 0, 0, 0, [], []
    for seed in seeds:
        record, truth = dirty_record(seed, **more)
        peaks = record.peaks()
        kind, std, ratio = (np.array(x) for x in (peaks.kind, peaks.std, peaks.damping_ratio))
        left = set(np.flatnonzero(kind == "mode").tolist())
        for f, exact in zip(truth.frequency, truth.damping_ratio):
            at = min(left, key=lambda k: abs(peaks.frequency[k] - f))
            # twice the half width, or six standard uncertainties
            if abs(peaks.frequency[at] - f) > max(2 * exact * f, 6 * std[at]):
                missed += 1
                continue
            left.remove(at)
            z.append((peaks.frequency[at] - f) / std[at])
            own = peaks.damping_ratio_std[at] / ratio[at]
            ratio_z.append(np.log(ratio[at] / exact) / own)
        deck = truth.deck
        false += sum(not (np.abs(peaks.frequency[k] - deck) < 0.04 * deck).any() for k in left)
        lines += len(truth.lines)
        own = peaks.frequency[kind == "line"]
        named += sum((np.abs(own - f) < 0.01).any() for f in truth.lines)
    modes = missed + len(z)
    return Found(len(seeds), modes, missed, false, named, lines, np.array(z), np.array(ratio_z))


def test_rope_modes_of_dirty_records_are_found_with_their_uncertainty():
    found = judge(range(60, 64))
    # one of 48 stands beside a mode of the deck
    assert found.missed <= 1
    assert found.false == 0
    assert found.named == found.lines > 0
    # 48 errors: 95 % of them within 2, six standard deviations of that share
    assert np.mean(np.abs(found.z) < 2) > 0.95 - 6 * np.sqrt(0.95 * 0.05 / 48)


LARGE = range(2000, 2200)


@pytest.fixture(scope="module")
def large():
    return judge(LARGE)


@pytest.mark.slow
@pytest.mark.claim(
    "modes of a rope that 600 s of dirty accelerations do not show",
    "200 simulated records of three channels with deck modes, sinusoids, drift, gaps, clipped and "
    "dead channels; 2400 modes",
    0.01,
)
def test_modes_of_dirty_records_are_missed_rarely(large, claim):
    claim(large.missed / large.modes)


@pytest.mark.slow
@pytest.mark.claim("peaks called modes in a record that are none", "the same 200 records", 0.05)
def test_false_modes_are_rare(large, claim):
    claim(large.false / large.records)


@pytest.mark.slow
@pytest.mark.claim(
    "share of frequencies of modes within two standard uncertainties, its distance from 0.955",
    "the same 200 records; 0.94 to 0.97",
    0.015,
)
def test_frequencies_are_as_uncertain_as_they_say(large, claim):
    claim(abs(np.mean(np.abs(large.z) < 2) - 0.955))


@pytest.mark.slow
@pytest.mark.claim(
    "share of damping ratios within two standard uncertainties of their logarithm, its distance "
    "from 0.955",
    "the same 200 records",
    0.02,
)
def test_damping_ratios_are_as_uncertain_as_they_say(large, claim):
    claim(abs(np.mean(np.abs(large.ratio_z) < 2) - 0.955))


# what else a record may be


def test_peaks_say_where_and_how_they_were_found():
    record, truth = dirty_record(61)
    peaks = record.peaks(below=8.0)
    count = len(peaks.frequency)
    assert peaks.sensors == tuple(record.response[k] for k in record.used)
    assert peaks.shape.shape == (count, len(record.used))
    np.testing.assert_allclose(np.linalg.norm(peaks.shape, axis=1), 1.0, rtol=1e-14)
    assert (peaks.band[:, 0] < peaks.frequency).all()
    assert (peaks.frequency < peaks.band[:, 1]).all()
    assert peaks.frequency.max() < 8.1
    assert (np.diff(peaks.frequency) > 0).all()
    assert peaks.table().columns[-2:] == ("shape, z at 6.000 m", "shape, z at 9.000 m")
    # the shapes of the first modes are straight lines from the end, but for the ends' bending
    first = peaks.shape[np.abs(peaks.frequency - truth.frequency[0]).argmin()]
    assert first @ [3.5, 6.0, 9.0] > 0.99 * np.linalg.norm([3.5, 6.0, 9.0])


def test_the_same_record_has_the_same_peaks_to_the_last_bit():
    record, _ = dirty_record(62, duration=200.0)
    one, other = record.peaks(), record.peaks()
    assert one.frequency.tobytes() == other.frequency.tobytes()
    assert one.std == other.std


def test_peaks_are_kept_by_files(tmp_path):
    record, _ = dirty_record(62, duration=200.0)
    peaks = record.peaks(below=8.0)
    peaks.save(tmp_path / "peaks.nc")
    found = rd.load(tmp_path / "peaks.nc")
    assert found.kind == peaks.kind
    assert found.sensors == peaks.sensors
    assert found.shape.tobytes() == peaks.shape.tobytes()
    assert found.band.tobytes() == peaks.band.tobytes()


@pytest.mark.parametrize("rate", [20.0, 400.0])
def test_samples_that_peaks_do_not_need_change_nothing(rate):
    slow, truth = dirty_record(63, dirty=False, duration=200.0, modes=4, rate=rate)
    peaks = slow.peaks(below=7.0)
    at = [int(np.abs(peaks.frequency - f).argmin()) for f in truth.frequency]
    error = np.abs(peaks.frequency[at] - truth.frequency) / np.array(peaks.std)[at]
    assert (error < 4).all()
    assert [peaks.kind[k] for k in at] == ["mode"] * 4


def test_a_channel_alone_shows_the_modes_too():
    record, truth = dirty_record(64, dirty=False, modes=5, sensors=(6.0,))
    peaks = record.peaks(below=8.0)
    modes = peaks.frequency[np.array(peaks.kind) == "mode"]
    assert len(modes) == 5
    assert modes == pytest.approx(truth.frequency, rel=5e-3)


def test_two_modes_in_one_peak_are_a_double():
    # two modes of different shape, their distance a quarter of a half width
    rng = np.random.default_rng(8)
    n, rate = 60000, 100.0
    f = np.fft.rfftfreq(n, 1 / rate)
    value = 1e-3 * rng.standard_normal((2, n))
    for one, shape in (5.0, [1.0, 0.3]), (5.005, [-0.3, 1.0]):
        h = f**2 / (one**2 - f**2 + 2j * 0.004 * one * f)
        load = rng.standard_normal(len(f)) + 1j * rng.standard_normal(len(f))
        value += np.outer(shape, np.fft.irfft(h * load, n))
    record = rd.Record(None, value, rate=rate, response=[("z", 3.5), ("z", 6.0)])
    peaks = record.peaks(below=20.0)
    assert "double" in [k for k, g in zip(peaks.kind, peaks.frequency) if abs(g - 5.0) < 0.1]


def test_a_machine_that_wanders_is_a_line():
    # 0.02 Hz to and fro: no sinusoid, yet its amplitude is steady
    rng = np.random.default_rng(9)
    n, rate = 60000, 100.0
    phase = 2 * np.pi * np.cumsum(7.0 + 2e-3 * np.sin(2 * np.pi * np.arange(n) / rate / 200)) / rate
    value = np.sin(phase) + 0.3 * rng.standard_normal(n)
    peaks = rd.Record(None, value, rate=rate, response=("z", 3.5)).peaks()
    near = [k for k, f in zip(peaks.kind, peaks.frequency) if abs(f - 7.0) < 0.05]
    assert near and set(near) <= {"line", "weak"}


def test_noise_alone_has_no_mode():
    value = np.random.default_rng(10).standard_normal((2, 30000))
    record = rd.Record(None, value, rate=50.0, response=[("z", 3.5), ("z", 6.0)])
    with pytest.raises(rd.SolveError, match="stands out of its noise, got none"):
        record.peaks()


@pytest.mark.parametrize("below", [0.01, 60.0, float("nan"), -1.0])
def test_a_frequency_that_the_record_cannot_show_is_named(below):
    record, _ = dirty_record(65, dirty=False, duration=60.0, modes=2)
    with pytest.raises(rd.SceneError, match="below must"):
        record.peaks(below=below)


def test_a_record_too_short_for_any_peak_is_named():
    record = rd.Record(None, np.sin(np.arange(64.0)), rate=50.0, response=("z", 3.5))
    with pytest.raises(
        rd.SolveError, match=r"record must hold 100 samples without a gap .* got 64"
    ):
        record.peaks()


def test_progress_ends_at_the_whole():
    record, _ = dirty_record(65, dirty=False, duration=200.0, modes=3)
    told = []
    record.peaks(below=6.0, progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0


# peaks that say more


def test_peaks_may_say_what_they_are():
    more = {"damping_ratio_std": 1e-4, "kind": ["mode", "line"], "snr": [5, 7]}
    peaks = rd.Peaks(
        [1.0, 2.0],
        **more,
        shape=[[3, 4j], [1, 0]],
        sensors=[("z", 1), ("z", 2)],
        band=[[0.9, 1.1]] * 2,
    )
    assert peaks.kind == ("mode", "line")
    assert peaks.damping_ratio_std == (1e-4, 1e-4)
    np.testing.assert_allclose(peaks.shape, [[0.6, 0.8j], [1, 0]], rtol=1e-15)
    assert peaks.table().columns[1:4] == ("std of damping ratio", "kind", "S/N")


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"kind": "mode"}, TypeError, "kind must be 2 words"),
        ({"kind": ["mode"]}, rd.SceneError, "kind must be 2 words, as frequency, got 1"),
        ({"kind": ["mode", "mde"]}, rd.SceneError, r"kind\[1\] must be one of"),
        ({"band": [[1.0, 0.9]] * 2}, rd.SceneError, r"band\[0\] must begin before it ends"),
        ({"shape": [[1.0]] * 2}, rd.SceneError, "given together, got shape alone"),
        ({"sensors": [("z", 1.0)]}, rd.SceneError, "given together, got sensors alone"),
        (
            {"shape": [[1.0], [0.0]], "sensors": ("z", 1.0)},
            rd.SceneError,
            r"shape\[1\] must not be 0",
        ),
        ({"snr": -1.0}, rd.SceneError, "snr"),
    ],
)
def test_what_peaks_cannot_be_is_named(given, error, message):
    with pytest.raises(error, match=message):
        rd.Peaks([1.0, 2.0], **given)
