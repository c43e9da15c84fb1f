"""Records of a stay cable of known tension as they come from a bridge."""

from typing import NamedTuple

import numpy as np

import ropedyn as rd

SENSORS = (3.5, 6.0, 9.0)
"""Where accelerometers are [m]."""
NEAREST, RELATIVE = 0.12, 0.03
"""Strays keep so far from the modes of the rope and from each other, in Hz and relatively: some
four half-widths of both."""


class Truth(NamedTuple):
    """What a record was made of."""

    scene: rd.Scene
    tension: float  # [N]
    bending_stiffness: float  # [N m^2]
    springs: tuple[float, float]  # of both ends in bending [N m]
    length: float  # [m]
    linear_density: float  # [kg/m]
    frequency: np.ndarray  # (modes,) [Hz]: mode 1, 2, ...
    damping_ratio: np.ndarray
    deck: np.ndarray  # (strays,) [Hz]: modes of what carries the rope
    lines: np.ndarray  # (lines,) [Hz]: machines


def stay_cable(rng):
    """Return a cable of 5 MN whose ends give in bending."""
    length, density = rng.uniform(95.0, 130.0), rng.uniform(50.0, 75.0)
    tension = 5e6
    stiffness = tension * (length / np.exp(rng.uniform(np.log(70), np.log(250)))) ** 2
    springs = np.exp(rng.uniform(np.log(1e-2), np.log(1e2), 2)) * np.sqrt(tension * stiffness)
    ends = tuple(rd.End(beta="free", spring={"beta": float(s)}) for s in springs)
    rope = rd.Rope(length, density, bending_stiffness=stiffness)
    scene = rd.Scene(rope, tension=tension, ends=ends)
    return scene, tuple(springs.tolist())


def shapes_at(scene, sensors, modes):
    """Return frequencies and the displacements of the sensors, (sensors, modes), of unit modes."""
    # a mass of 0 is a station: a node of the answer
    found = scene.replace(parts=[rd.PointMass(x, 0.0) for x in sensors]).compile().modes(modes)
    at = [int(np.abs(found.x - x).argmin()) for x in sensors]
    return found.frequency, found.shape[:, at, 0].T


def apart(rng, taken, low, high):
    """Return a frequency that is not near those taken."""
    while True:
        f = rng.uniform(low, high)
        if np.abs(np.asarray(taken) - f).min() > max(NEAREST, RELATIVE * f):
            return f


def gaussian(rng, shape):
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2)


def modal_motion(rng, f, frequency, ratio, shape):
    """Return lines (sensors, f) of accelerations of modes under a coloured load they share."""
    modes = len(frequency)
    mix = np.eye(modes) + rng.uniform(0.0, 0.3) * rng.standard_normal((modes, modes)) / 2
    load = (1 + (f / rng.uniform(2.0, 10.0)) ** 2) ** -rng.uniform(0.0, 0.5)
    push = load * (mix @ gaussian(rng, (modes, len(f))))
    ratio, omega = ratio[:, np.newaxis], frequency[:, np.newaxis]
    amplified = f**2 / (omega**2 - f**2 + 2j * ratio * omega * f)
    return shape @ (amplified * push)


def accelerations(rng, n, rate, frequency, ratio, shape, deck, lines):
    """Return motion over time of all that shakes the sensors, (sensors, n)."""
    # longer than the record: what begins has not been at rest and does not end where it began
    whole = int(1.2 * n)
    f = np.fft.rfftfreq(whole, 1 / rate)
    motion = modal_motion(rng, f, frequency, ratio, shape)
    loud = np.median([np.abs(motion[:, np.abs(f - one) < 0.05]).max() for one in frequency])
    for one in deck:
        own = rng.uniform(0.005, 0.015)
        seen = 1 + 0.2 * rng.standard_normal((len(shape), 1))
        size = loud * 10 ** rng.uniform(-1.3, -0.3) * 2 * own
        motion = motion + size * modal_motion(rng, f, np.array([one]), np.array([own]), seen)
    noise = loud * 10 ** rng.uniform(-3.0, -1.8)
    motion = motion + noise * gaussian(rng, motion.shape)
    value = np.fft.irfft(motion * np.sqrt(whole), whole)[:, (whole - n) // 2 :][:, :n]
    time = np.arange(n) / rate
    for one in lines:
        size = rng.uniform(0.1, 1.0, (len(shape), 1)) * value.std() * rng.uniform(0.1, 0.5)
        value = value + size * np.sin(2 * np.pi * one * time + rng.uniform(0, 2 * np.pi))
    return value * (0.05 / value.std())


def soil(rng, time, value):
    """Return what a bad logger makes of motion: drift, gaps, a clipped and a dead channel."""
    span = time[-1]
    value = value.copy()
    for k in range(len(value)):
        slow = rng.uniform(0.5, 3.0) * value[k].std()
        value[k] += slow * (time / span - np.sin(2 * np.pi * rng.uniform(0.2, 1.5) * time / span))
        value[k] += rng.normal() * 0.3
    spoiled = rng.permutation(len(value))
    if rng.random() < 0.3:
        value[spoiled[0]] = rng.normal()
    if rng.random() < 0.3:
        one = value[spoiled[1]]
        middle, most = one.mean(), rng.uniform(2.5, 3.2) * one.std()
        value[spoiled[1]] = np.clip(one, middle - most, middle + most)
    kept = np.ones(len(time), dtype=bool)
    for _ in range(rng.integers(0, 4)):
        at = rng.integers(1000, len(time) - 1000)
        kept[at : at + rng.integers(1, 4)] = False
    if rng.random() < 0.5:
        at = rng.integers(len(time) // 6, len(time) * 5 // 6)
        kept[at : at + rng.integers(100, 800)] = False
    return time[kept], value[:, kept]


def dirty_record(seed, *, dirty=True, duration=600.0, rate=100.0, modes=12, sensors=SENSORS):
    """Return a record of accelerations and the truth behind it."""
    rng = np.random.default_rng(seed)
    scene, springs = stay_cable(rng)
    frequency, shape = shapes_at(scene, sensors, modes)
    ratio = 0.004 * np.exp(rng.normal(0.0, 0.35, modes))
    deck, lines = [], []
    if dirty:
        for kind, highest in (deck, 6.0), (lines, 1.1 * frequency[-1]):
            for _ in range(rng.integers(0, 3)):
                kind.append(apart(rng, [*frequency, *deck, *lines], 0.8, highest))
    n = round(duration * rate)
    value = accelerations(rng, n, rate, frequency, ratio, shape, deck, lines)
    time = np.arange(n) / rate
    if dirty:
        time, value = soil(rng, time, value)
    record = rd.Record(time, value, response=[("z", x) for x in sensors])
    rope = scene.rope
    truth = Truth(
        scene=scene,
        tension=scene.tension,
        bending_stiffness=rope.bending_stiffness,
        springs=springs,
        length=rope.length,
        linear_density=rope.linear_density,
        frequency=frequency,
        damping_ratio=ratio,
        deck=np.sort(deck),
        lines=np.sort(lines),
    )
    return record, truth
