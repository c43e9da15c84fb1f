"""Steady states under a stepped sine, by implicit steps along the chain."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SolveError
from ...scene.force import Sine
from ...scene.tension import Tension
from ...signal.spectrum import amplitudes
from ..request import Run, SteadyStates, SteppedSine
from .direct import refuse_responses
from .lumped import Lumps, lumped_chains, refuse
from .march import Motion, stage_of

FEWEST, MOST = 32, 1 << 14  # A period takes from so many steps to so many.
WINDOW = 8  # The amplitude is looked at after so many periods at least.
TOGETHER = 1000  # Drive and tension must both begin anew within so many periods.
BLOCK = 4096  # The core takes so many steps in one call, or a period: a look for Ctrl-C.
LOOKS = 4  # So many looks in a row must agree.
LONGEST = 100_000  # A motion that changes after so many periods is said not to settle.
KEEPS = stage_of(1.0)


def march_steadily(asked: SteppedSine) -> SteadyStates:
    """Follow the motion through the frequencies in their order, see `Model.stepped_sine`."""
    refuse(asked.model)
    still, push = np.array([0.0, 1.0]), _push(asked, float(asked.frequency[0]))
    run = Run(asked.model, still, (asked.drive,), (push,), asked.responses, direct=True, step=1.0)
    refuse_responses(run)
    motions = [Motion(lumps, refined=False) for lumps in lumped_chains(run)]
    value = np.zeros((len(asked.responses), len(asked.frequency)), dtype=np.complex128)
    error = np.zeros(value.shape)
    for k, f in enumerate(asked.frequency.tolist()):
        found, wrong = _converged(asked, motions, f)
        size = np.abs(found)
        relative = np.divide(wrong, size, out=np.zeros_like(size), where=size > 0)
        value[:, k], error[:, k] = found / asked.amplitude, relative
        asked.progress((k + 1) / len(asked.frequency))
    return SteadyStates(
        value,
        error,
        "direct",
        sum(m.lumps.chain.free for m in motions),
        sum(m.stages for m in motions),
        sum(m.factorisations for m in motions),
    )


def _push(asked: SteppedSine, frequency: float) -> Sine:
    return Sine(asked.amplitude, frequency, phase=math.pi / 2)


def _converged(asked: SteppedSine, motions: list[Motion], frequency: float) -> tuple[Complex, Real]:
    """Return the amplitudes with ever shorter steps, extrapolated, and how far they are off."""
    count = FEWEST
    before = _settled(asked, motions, frequency, count)
    while count < MOST:
        count *= 2
        after = _settled(asked, motions, frequency, count)
        # of second order: a third of the change is what is left of it
        off = np.abs(after.value - before.value) / 3
        if (off <= asked.tolerance * np.abs(after.value).max()).all():
            return after.value + (after.value - before.value) / 3, off + after.left
        before = after
    raise SolveError(
        f"frequency {frequency!r} Hz: with {count} steps a period the amplitude is still known to "
        f"{float((off / np.abs(after.value).max()).max()):.1e} only: ask for a larger tolerance"
    )


class _Settled(NamedTuple):
    value: Complex  # (responses,)
    left: Real  # (responses,) what may still change


def _settled(asked: SteppedSine, motions: list[Motion], frequency: float, count: int) -> _Settled:
    """Follow the motion until its amplitude stays, with so many steps a period."""
    for motion in motions:
        motion.lumps = _pushed(motion.lumps, _push(asked, frequency))
    periods = _together(asked, frequency)
    seen: list[Complex] = []
    for k in range(max(LONGEST // periods, LOOKS + 1)):
        seen.append(
            _window(asked, motions, frequency, count, range(k * periods, (k + 1) * periods))
        )
        if len(seen) <= LOOKS:
            continue
        changes = np.abs(np.diff(seen[-LOOKS - 1 :], axis=0)).max(axis=1)
        size = np.abs(seen[-1]).max()
        left = _left(changes)
        if left <= asked.tolerance / 2 * size:
            return _Settled(seen[-1], np.full(len(seen[-1]), left))
    raise SolveError(
        f"frequency {frequency!r} Hz has no steady state: after {LONGEST} periods the amplitude "
        f"changes by {float(changes[-1] / size):.1e} of itself in {periods} periods"
    )


def _together(asked: SteppedSine, frequency: float) -> int:
    """Return after how many periods drive and tension both begin anew, `WINDOW` at least."""
    tension = asked.model.scene.tension
    if not isinstance(tension, Tension) or not tension.pulsates:
        return WINDOW
    turns = tension.frequency / frequency * np.arange(1, TOGETHER + 1)
    whole = np.flatnonzero(np.abs(turns - np.rint(turns)) <= 1e-12 * np.maximum(turns, 1.0))
    if len(whole) == 0:
        raise SolveError(
            f"frequency {frequency!r} Hz has no steady state: the tension pulsates at "
            f"{tension.frequency!r} Hz, and both do not begin anew together within {TOGETHER} "
            "periods"
        )
    least = int(whole[0]) + 1
    return math.ceil(WINDOW / least) * least


def _left(changes: Real) -> float:
    """Return what geometric changes add up to from now on, infinite where they grow."""
    half = len(changes) // 2
    early, late = float(changes[:half].max()), float(changes[half:].max())
    if late == 0:
        return 0.0
    ratio = math.sqrt(late / early) if early > 0 else math.inf
    return late * ratio / (1 - ratio) if ratio < 1 else math.inf


def _pushed(lumps: Lumps, force: Sine) -> Lumps:
    """Return the chain under the force of another frequency."""
    forces = (force,) * len(lumps.forces)
    return replace(lumps, forces=forces, motions=(force,) * len(lumps.motions))


def _window(
    asked: SteppedSine, motions: list[Motion], frequency: float, count: int, periods: range
) -> Complex:
    """Follow all chains through some periods; return the mean of their amplitudes."""
    found = np.zeros(len(asked.responses), dtype=np.complex128)
    most = max(BLOCK // count, 1)
    # samples are at the ends of steps, the first one step after a period begins
    turn = np.exp(-2j * np.pi / count) / len(periods)
    for first in periods[::most]:
        these = np.arange(first * count, min(first + most, periods.stop) * count + 1)
        time = these / (frequency * count)
        for motion in motions:
            stride = motion.stride(time, 1 / (frequency * count), KEEPS, (0.0, 0.0))
            if stride.error is not None:
                raise stride.error
            value = motion.lumps.values(stride.read, time[1:], 0).T
            found[motion.lumps.number] += turn * amplitudes(value, count).sum(axis=1)
    return found
