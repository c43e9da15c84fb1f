"""Responses per force from motion over time: what drives is transformed exactly, not sampled."""

import dataclasses
import re
from itertools import pairwise

import numpy as np
import pytest
from made_history import made
from scipy.integrate import quad

import ropedyn as rd
from ropedyn.motion.force_spectrum import transform
from ropedyn.scene.force import Samples, Sum

DAMPED = rd.RayleighDamping(4.0, 0.0)
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=DAMPED).compile()
BEAM = rd.Scene(
    rd.Rope(1.0, 0.1, bending_stiffness=0.05),
    tension=10.0,
    damping=rd.RayleighDamping(4.0, 1e-5),
).compile(elements=64)
WHERE = {"drive": ("z", 0.3), "response": ("z", 0.7)}
RATE = 2000.0
LOOSE = 2.0  # A string that is hit at an instant moves by steps, which no finite sum tells.
TIME = np.arange(16_000) / RATE
BEGIN, END = 0.1, 0.35
SAMPLED = np.linspace(BEGIN, END, 26)
FORCES = {
    "sine": rd.Sine(3.0, 20.0, phase=0.4),
    "step": rd.Step(2.0, time=0.2),
    "step before": rd.Step(2.0),
    "half sine": rd.Impulse(0.1, time=0.15, duration=0.01),
    "half sine cut off": rd.Impulse(0.1, time=0.3, duration=0.1),
    "chirp": rd.Chirp(2.0, 5.0, 60.0, 0.3),
    "falling chirp": rd.Chirp(2.0, 60.0, 5.0, 0.5, phase=1.0),
    "chirp of one frequency": rd.Chirp(2.0, 20.0, 20.0, 0.2),
    "chirp that is over": rd.Chirp(2.0, 20.0, 30.0, 0.05),
    "samples": Samples(SAMPLED, np.cos(40.0 * SAMPLED)),
    "sum": Sum((rd.Step(1.0, time=0.2), rd.Step(-1.0, time=0.2137))),
}


def integral(force, omega):
    """Integrate numerically, piece by piece between everything that breaks."""
    breaks = [at for at in force.breaks if BEGIN < at < END]
    if isinstance(force, Samples):
        breaks = SAMPLED[1:-1].tolist()
    edges = [BEGIN, *sorted(breaks), END]
    total = 0.0
    for a, b in pairwise(edges):
        for part, unit in ((np.cos, 1.0), (np.sin, -1j)):

            def integrand(t, part=part):
                return float(force.value(np.array(t))) * part(omega * t)

            total += unit * quad(integrand, a, np.nextafter(b, a), limit=200, epsabs=1e-13)[0]
    return total


@pytest.mark.parametrize("name", FORCES)
def test_transforms_are_the_integrals(name):
    force = FORCES[name]
    lines = 2 * np.pi * np.fft.rfftfreq(len(SAMPLED), SAMPLED[1] - SAMPLED[0])
    right = np.array([integral(force, omega) for omega in lines])
    # what quad finds is right to 1e-13 beside its own rounding
    np.testing.assert_allclose(transform(force, lines, BEGIN, END), right, rtol=0, atol=1e-12)


def test_the_transform_of_a_blow_at_an_instant_is_its_impulse():
    omega = np.array([0.0, 3.0])
    blow = transform(rd.Impulse(0.2, time=0.5), omega, 0.0, 1.0)
    np.testing.assert_allclose(blow, 0.2 * np.exp(-0.5j * omega), rtol=1e-15)
    assert not transform(rd.Impulse(0.2, time=1.5), omega, 0.0, 1.0).any()


def away(model, force, time=TIME, below=100.0, **how):
    """Return the largest distance to the exact response below a frequency, over its largest."""
    found = model.transient(time, force=force, tolerance=LOOSE, **WHERE).frf(**how)
    kept = (found.frequency > 0) & (found.frequency < below)
    exact = model.frf(found.frequency[kept], **WHERE).value
    return np.abs(found.value[:, kept] - exact).max() / np.abs(exact).max(), found.notes


BLOWS = {
    "1 ms": rd.Impulse(0.01, duration=1e-3),
    "between two times": rd.Impulse(0.01, time=1.3e-4, duration=2e-4),
    "at an instant": rd.Impulse(0.01, time=2.0e-4),
    "two steps": (rd.Step(1.0, time=1e-3), rd.Step(-1.0, time=2.7e-3)),
}


@pytest.mark.parametrize("name", BLOWS)
@pytest.mark.parametrize("model", [STRING, BEAM], ids=["string", "beam"])
def test_a_blow_shorter_than_the_samples_tell_has_the_exact_response(model, name):
    error, notes = away(model, BLOWS[name])
    # samples alone are 27 % off, after 1 ms. What is left is motion above 1 kHz, which folds: of
    # the string, which jumps, up to 4e-3, of the beam up to 4e-6
    assert error < (1e-2 if model is STRING else 1e-5)
    assert notes[0].startswith("force: its exact transform")
    assert not any("cut off" in note for note in notes)


@pytest.mark.parametrize("name", BLOWS)
@pytest.mark.parametrize("model", [STRING, BEAM], ids=["string", "beam"])
def test_what_folds_is_told_in_the_notes(model, name):
    error, notes = away(model, BLOWS[name], below=RATE / 2)
    folds = next(note for note in notes if "folds" in note)
    told = float(folds.rpartition("about ")[2].partition(" ")[0])
    assert "1000 Hz" in folds
    # beyond half the rate peaks and troughs are not known, nor which of them folds into a line
    assert error <= told <= 100 * error


@pytest.mark.parametrize("seed", range(8))
def test_what_folds_beside_little_force_is_told(seed):
    rng = np.random.default_rng(seed)
    rate = rng.choice([100.0, 200.0, 400.0])
    time = np.arange(int(rate * 8)) / rate
    rope = rd.Rope(1.0, 0.1, bending_stiffness=rng.choice([1e-3, 0.05, 0.5]))
    model = rd.Scene(rope, tension=10.0, damping=rd.ModalDamping(rng.uniform(0.02, 0.05))).compile()
    chirp = rd.Chirp(1.0, *rng.uniform(1.0, rate / 3, 2), rng.uniform(1.0, 4.0))
    hit = rd.Impulse(0.1, duration=rng.uniform(0.1, 3.0) / rate)
    points = {"drive": ("z", rng.uniform(0.1, 0.9)), "response": ("z", rng.uniform(0.1, 0.9))}
    for force in chirp, hit:
        history = model.transient(time, force=force, quantity="velocity", **points)
        found = history.frf()
        exact = model.frf(found.frequency, quantity="mobility", **points).value
        error = np.abs(found.value - exact).max() / np.abs(found.value).max()
        told = [
            float(re.search(r"up to (?:about )?(\S+) of", note)[1])
            for note in found.notes
            if "up to" in note and note.startswith("motion")
        ]
        # a record that is cut off says so by itself, and is by less than 1e-6 here
        assert error <= sum(told) + 1e-5


def test_the_error_of_the_motion_is_told_beside_little_force():
    loose = STRING.transient(TIME, force=rd.Chirp(1.0, 5.0, 60.0, 0.5), tolerance=1e-2, **WHERE)
    found = loose.frf()
    (known,) = (note for note in found.notes if "known to its error" in note)
    kept = found.frequency > 0
    exact = STRING.frf(found.frequency[kept], **WHERE).value
    error = np.abs(found.value[:, kept] - exact).max() / np.abs(found.value).max()
    assert error <= float(re.search(r"up to (\S+) of", known)[1])


def test_samples_of_a_force_are_the_straight_lines_that_drive():
    noise = np.random.default_rng(5).normal(size=len(TIME))
    noise[-8000:] = 0.0
    # without sinc^2, (sin(x)/x)^2 with x = pi f/rate, 400 Hz is 12 % off
    error, notes = away(BEAM, noise, below=400.0, band=(1.0, 400.0))
    # the record ends with 2.6e-4 of the largest motion left, and says so
    assert error < 1e-3
    assert "cut off at the end, with 0.00026" in notes[-1]
    found = BEAM.transient(TIME, force=noise, **WHERE).frf(segments=8, band=(200.0, 400.0))
    plain = BEAM.frf(found.frequency, **WHERE).value
    assert found.notes[0].startswith("force: straight lines")
    # leakage of the segments scatters by percents, sinc^2 alone is 3 to 12 %
    ratio = np.median(np.abs(found.value / plain))
    assert ratio == pytest.approx(1.0, abs=0.01)


def test_a_band_is_asked_for_where_the_force_stays():
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=DAMPED).compile(elements=8)
    time = np.linspace(0.0, 8.0, 4000)
    history = model.transient(time, force=rd.Step(1.0), quantity="velocity", **WHERE)
    history = dataclasses.replace(history, law=())  # what is known of it are samples
    with pytest.raises(rd.SceneError, match="band must be given for responses of velocity"):
        history.frf()
    assert history.frf(band=(1.0, 40.0)).frequency[0] >= 1.0


def test_what_is_not_known_is_named():
    history = BEAM.transient(TIME, force=BLOWS["1 ms"], **WHERE)
    assert history.frf(window="hann").notes[0].startswith("force: its samples, which the window")
    assert (
        made(TIME, history.value, force=history.force)
        .frf()
        .notes[0]
        .startswith("force: its samples; what it does between them is not known")
    )
    short = BEAM.transient(TIME[:400], force=rd.Sine(1.0, 30.0), **WHERE).frf()
    assert sum("cut off" in note for note in short.notes) == 2


@pytest.mark.parametrize(
    "force",
    [BLOWS["1 ms"], rd.Chirp(1.0, 5.0, 60.0, 0.2), np.sin(9 * TIME[:64]) ** 3],
    ids=["blow", "chirp", "samples"],
)
@pytest.mark.parametrize("beside", [(), (rd.Impulse(0.1, time=0.01), rd.Step(2.0, time=0.3))])
def test_a_file_keeps_what_drives(force, beside, tmp_path):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile(elements=2, element="rigid")
    given = [force, *beside] if beside else force
    if beside and isinstance(force, np.ndarray):
        given = [*beside, force]
    history = model.transient(TIME[:64], drive=("z", 0.5), force=given)
    history.save(tmp_path / "motion.nc")
    again = rd.load(tmp_path / "motion.nc")
    found, before = again.frf(), history.frf()
    assert found.notes == before.notes
    # samples beside others are what the others leave of the sum, in which they may round
    size = np.abs(before.value).max()
    assert np.abs(found.value - before.value).max() <= 1e-14 * size
    assert again.to_json() == history.to_json()


def test_a_file_keeps_a_sum_of_several_samples_once(tmp_path):
    """What others leave was counted once for each of them: 52 % off."""
    time = TIME[:64]
    rope = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ViscousDamping(1.0))
    several = [np.sin(9 * time), rd.Step(1.0, time=time[9]), [np.cos(20 * time), rd.Sine(1.0, 3.0)]]
    model = rope.compile(elements=2, element="rigid")
    history = model.transient(time, drive=("z", 0.5), force=several)
    history.save(tmp_path / "motion.nc")
    found, before = rd.load(tmp_path / "motion.nc").frf(), history.frf()
    assert found.notes == before.notes
    assert np.abs(found.value - before.value).max() <= 1e-13 * np.abs(before.value).max()


def test_a_file_keeps_what_no_sample_shows(tmp_path):
    """The force of a blow at an instant is 0 at every time."""
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile(elements=2, element="rigid")
    asked = {"drive": ("z", 0.5), "force": rd.Impulse(0.01, time=0.02), "quantity": "acceleration"}
    model.transient(np.arange(64) / 1000.0, **asked).save(tmp_path / "motion.nc")
    with pytest.raises(rd.SceneError, match="where a blow between two times hits"):
        rd.load(tmp_path / "motion.nc").frf()


def test_acceleration_that_no_sample_shows_is_refused():
    """It was 54 % off, with a note of 3 %; elsewhere on a chain of lumps it is right."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ViscousDamping(8.0))
    model, time = scene.compile(elements=8, element="rigid"), np.arange(4000) / 1000.0
    asked = {"drive": ("z", 0.25), "force": rd.Impulse(0.01, time=0.02), "quantity": "acceleration"}
    with pytest.raises(
        rd.SceneError, match=r"of \('z', 0.25\) for a response per force where a blow"
    ):
        model.transient(time, **asked).frf()
    found = model.transient(time, **asked, response=("z", 0.75)).frf(band=(1.0, 60.0))
    exact = model.frf(found.frequency, drive=("z", 0.25), response=("z", 0.75))
    off = found.value + exact.value * (2 * np.pi * found.frequency) ** 2
    assert np.abs(off).max() < 0.01 * np.abs(found.value).max()


@pytest.mark.parametrize("duration", [0.0, 2e-6, 4e-4])
@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
def test_what_follows_a_blow_between_two_times_at_once_is_refused(duration, quantity):
    """Between nodes the element does: of the receptance 13 % were missing, with a note of 4e-4."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ViscousDamping(8.0))
    model, time = scene.compile(elements=6), np.arange(4000) / 4000.0
    blow = rd.Impulse(0.01, time=0.0101, duration=duration)
    at = {"drive": ("z", 0.42), "force": [blow, rd.Step(0.0)], "quantity": quantity}
    with pytest.raises(rd.SceneError, match="where a blow between two times hits"):
        model.transient(time, **at).frf()
    for hidden in (rd.Step(0.0, time=0.0101 + duration / 2), rd.Chirp(1.0, 1e4, 1.2e5, 4e-6)):
        with pytest.raises(rd.SceneError, match="where a blow between two times hits"):
            model.transient(time, **(at | {"force": [blow, hidden]})).frf()
    # those that last are seen, and what is elsewhere
    model.transient(time, **(at | {"force": rd.Impulse(0.01, time=0.01, duration=2e-3)})).frf()
    model.transient(time, **at, response=("z", 0.75)).frf()


def test_what_was_let_go_is_no_response_per_force():
    history = BEAM.transient(TIME[:500], start={("z", 0.5): 1.0}, force=BLOWS["1 ms"], **WHERE)
    assert history.released
    with pytest.raises(rd.SceneError, match="start must be nothing for a response per force"):
        history.frf()


@pytest.mark.parametrize("other", [rd.Impulse(0.1), rd.Impulse(0.1, duration=1e-4), TIME[:500]])
def test_what_acts_at_another_drive_is_seen(other):
    drives = [("z", 0.3), ("z", 0.6)]
    history = STRING.transient(
        TIME[:500], drive=drives, force=[BLOWS["1 ms"], other], tolerance=LOOSE
    )
    with pytest.raises(rd.SceneError, match="force must be 0 at other drives than 0, got some at"):
        history.frf()


def test_a_force_outside_of_the_record_is_refused():
    history = STRING.transient(TIME[:50], force=rd.Impulse(0.1, time=1.0, duration=1e-3), **WHERE)
    with pytest.raises(rd.SceneError, match="force must drive within the times, got 0"):
        history.frf()


@pytest.mark.parametrize(
    "force", [rd.Step(1.0, time=0.01), np.clip((np.arange(8192) / RATE - 0.01) / 0.02, 0.0, 1.0)]
)
@pytest.mark.parametrize("quantity", ["velocity", "acceleration"])
def test_a_force_that_is_held_at_the_end_is_held_for_ever(force, quantity):
    """It ended with the record, and the motion that this would have caused was not there."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(2.0))
    model, where = scene.compile(elements=16), {"drive": ("z", 0.25), "response": ("z", 0.5)}
    time = np.arange(8192) / RATE
    found = model.transient(time, force=force, quantity=quantity, **where).frf()
    per = {"velocity": "mobility", "acceleration": "accelerance"}[quantity]
    exact = model.frf(found.frequency, quantity=per, **where).value
    # measured: 2e-13
    assert np.abs(found.value - exact).max() <= 1e-11 * np.abs(exact).max()
    assert "force: held after the end, with 1 of its largest value" in found.notes
