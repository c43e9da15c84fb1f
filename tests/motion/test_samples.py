"""Linear motion under forces of samples: straight lines between them are those on finer samples."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.signal import lsim

import ropedyn as rd
from ropedyn.motion.line.grid import Grid
from ropedyn.motion.line.images import ringing
from ropedyn.scene.force import Samples, Sum
from ropedyn.space.model import compile_space

FINER = 8  # So many samples on each straight line.
DASHPOT = rd.Dashpot(0.3, 1.0)


@pytest.mark.parametrize("jitter", [0.0, 0.02])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    ("compiled", "response"),
    [
        (rd.Scene.compile, ("z", 0.21)),
        (partial(rd.Scene.compile, elements=32), ("F_z", 0.0)),
        (compile_space, ("z", 0.21)),
    ],
    ids=["span", "chain", "structure"],
)
def test_corners_between_samples_that_ring_a_mode_are_told(compiled, response, side, jitter):
    """A mode at the rate of the samples, but for the force's frequency, was lost: up to 91 %."""
    model = compiled(
        rd.Scene(
            rd.Rope(1.0, 0.1, bending_stiffness=0.01, torsional_stiffness=0.1),
            tension=1000.0,
            damping=rd.ViscousDamping(1.0),
            parts=[DASHPOT],
            planes="both",
        )
    )
    time = np.arange(501) / (400.0 + side * 37.0)  # a mode is at 400 Hz
    drawn = np.random.default_rng(7).uniform(-jitter, jitter, 501) * time[1]
    time[1:-1] += drawn[1:-1]
    force = np.sin(2 * np.pi * 37.0 * time) * np.sin(np.pi * time / time[-1]) ** 2
    finer = np.interp(np.arange(4001) / 8, np.arange(501), time)
    asked = {"drive": ("z", 0.21), "response": response, "tolerance": 3e-3}
    some = model.transient(time, force=force, **asked)
    every = model.transient(finer, force=np.interp(finer, time, force), **asked)
    off = np.abs(some.value - every.value[:, ::8])
    assert some.cost.method == "line"
    assert (off <= some.error + every.error[:, ::8]).all()


def test_records_of_any_length_are_followed_beyond_what_their_times_resolve(monkeypatch):
    """Noise of 10^6 samples was refused: its first sum took all rates that there were."""
    monkeypatch.setattr("ropedyn.motion.line.transfer.MOST", 1)
    scene = rd.Scene(
        rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(0.5), parts=[DASHPOT]
    )
    force = np.random.default_rng(0).normal(size=1001)
    asked = {"drive": ("z", 0.25), "force": force, "response": ("z", 0.5)}
    history = scene.compile(elements=16).transient(np.arange(1001) / 600.0, **asked)
    assert history.error.max() <= 1e-3 * np.abs(history.value).max()
    assert history.cost.sweeps > 2 * 1001


@pytest.mark.parametrize("finer", [1, 8, 64])
@pytest.mark.parametrize("beyond", [0.9, 1.4])
def test_images_are_what_a_mode_near_or_beyond_the_highest_rate_does(finer, beyond):
    """Of long sums only multiples below the highest rate were looked at."""
    time, rate = np.linspace(0.0, 1.0, 401), 30.0
    samples = Samples(time, np.sin(2 * np.pi * rate * time) * np.sin(np.pi * time) ** 2)
    grid = replace(Grid.over(time, 1e-3, growth=0.0, ahead=np.inf), finer=finer)
    multiple = max(1, round(beyond * finer / 2))
    mode, drag = 2 * np.pi * (400.0 * multiple - rate), 2.0
    alone = ringing(samples, grid, 0, lambda s: 1 / (s * s + drag * s + mode**2)[None])
    _, motion, _ = lsim(([1.0], [1.0, drag, mode**2]), samples.sample, time)
    motion -= samples.sample / mode**2  # it follows the force beside
    assert alone == pytest.approx(np.abs(motion).max(), rel=0.05)  # measured: 0.012


def test_images_of_a_sum_are_those_of_its_samples():
    """A sine has none: it is no sum of straight lines."""
    time = np.linspace(0.0, 1.0, 401)
    samples = Samples(time, np.sin(2 * np.pi * 30.0 * time))
    grid = Grid.over(time, 1e-3, growth=0.0, ahead=np.inf)

    def follow(s):
        return 1 / (s * s + 2.0 * s + (2 * np.pi * 370.0) ** 2)[None]

    alone = ringing(samples, grid, 0, follow)
    beside = ringing(Sum((rd.Sine(100.0, 30.0), samples)), grid, 0, follow)
    assert alone > 0
    assert beside == alone


def random_case(seed):
    """Return a damped scene, times that may be uneven, samples and what is asked."""
    random = np.random.default_rng(seed)

    def between(low, high):
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    length, density, tension = between(0.5, 3.0), between(0.05, 2.0), between(100.0, 1e4)
    first = np.sqrt(tension / density) / (2 * length)
    bend = tension * length**2 * between(1e-5, 1e-2)
    places = [round(float(x), 3) for x in random.uniform(0.1, 0.9, 3) * length]
    damping = [rd.ViscousDamping(density * first * between(1e-2, 1.0))]
    if random.random() < 0.5:
        damping.append(rd.StiffnessDamping(between(1e-7, 1e-5)))
    scene = rd.Scene(
        rd.Rope(length, density, bending_stiffness=bend if random.random() < 0.5 else None),
        tension=tension,
        damping=damping,
        parts=[rd.Dashpot(places[0], between(1e-3, 1.0) * np.sqrt(tension * density))],
    )
    elements = [None, 16, 40][random.integers(3)]
    model = scene.compile() if elements is None else scene.compile(elements=elements)
    count = int(random.integers(200, 1500))
    step = 1 / (first * random.uniform(6.0, 60.0))
    time = np.arange(count) * step
    if random.random() < 0.3:
        time[1:-1] += random.uniform(-0.3, 0.3, count - 2) * step * between(0.01, 1.0)
    turns = 2 * np.pi * first * random.uniform(0.3, 4.0) * time
    around = np.exp(-(((time / time[-1] - 0.4) / 0.1) ** 2))
    force = [
        random.normal(size=count),
        np.sin(turns) * np.hanning(count),
        np.sin(turns),
        np.sin(turns * (1 + time / time[-1])) * around,
    ][random.integers(4)]
    quantity = ["displacement", "velocity", "acceleration"][random.integers(3)]
    response = [("z", places[2]), ("F_z", 0.0)][random.integers(2)]
    return (
        model,
        time,
        force,
        {"drive": ("z", places[1]), "response": response, "quantity": quantity},
    )


def beyond(seed):
    """Return the largest distance over both errors, None where it is refused."""
    model, time, force, asked = random_case(seed)
    count = len(time)
    finer = np.interp(np.arange((count - 1) * FINER + 1) / FINER, np.arange(count), time)
    try:
        some = model.transient(time, force=force, **asked)
        every = model.transient(finer, force=np.interp(finer, time, force), **asked)
    except rd.SolveError as refusal:
        assert "is not known to" in str(refusal)
        return None
    assert (some.error.max(axis=1) <= 1e-3 * np.abs(some.value).max(axis=1)).all()
    known = some.error + every.error[:, ::FINER]
    return float((np.abs(some.value - every.value[:, ::FINER]) / known).max())


@pytest.mark.long
def test_errors_cover_what_finer_samples_tell():
    found = [beyond(seed) for seed in range(31_000, 31_010)]
    known = [one for one in found if one is not None]
    assert len(known) >= 7
    assert max(known) <= 1


@pytest.mark.slow
@pytest.mark.claim(
    "Linear motion of 300 random scenes under samples, any damping: share whose distance to the "
    "same straight lines on eight times as many samples is beyond both errors",
    reference="the same force on finer samples",
    accepted=1e-2,
)
def test_errors_cover_what_finer_samples_tell_of_300_scenes(claim):
    found = [beyond(seed) for seed in range(32_000, 32_300)]
    known = np.array([one for one in found if one is not None])
    assert len(known) >= 240
    claim(np.mean(known > 1))
