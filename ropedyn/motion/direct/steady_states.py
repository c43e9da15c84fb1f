"""Steady states of motion with dry friction that slips, by implicit steps along the chain."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Real
from ...base.errors import SolveError
from ...response.frf import FRF
from ...scene.force import Sine
from ...signal.spectrum import amplitudes
from ..periodic.asked import SteppedSine
from ..request import Run
from .direct import refuse_responses
from .lumped import lumped_chains, refuse_model
from .march import Motion, stage_of

FEWEST, MOST = 32, 1 << 14  # A period takes from so many steps to so many.
WINDOW = 8  # The amplitude is looked at after so many periods at least.
BLOCK = 4096  # The core takes so many steps in one call, or a period: a look for Ctrl-C.
LOOKS = 4  # So many looks in a row must agree.
LONGEST = 100_000  # A motion that changes after so many periods is said not to settle.
KEEPS = stage_of(1.0)
TOLERANCE = 1e-3  # Of the steady state where none is given.


def march_steadily(asked: SteppedSine, turn: Callable[[float], int]) -> FRF:
    """Follow the motion through the frequencies in their order, see `Model.stepped_sine`.

    `turn` says after how many periods of a frequency everything that acts begins anew.
    """
    refuse_model(asked.model)
    still = np.array([0.0, 1.0])
    push = Sine(asked.amplitude, float(asked.frequency[0]), phase=math.pi / 2)
    run = Run(asked.model, still, (asked.drive,), (push,), asked.responses, direct=True, step=1.0)
    refuse_responses(run)
    motions = [Motion(lumps, refined=False) for lumps in lumped_chains(run)]
    value = np.zeros((len(asked.responses), len(asked.frequency)), dtype=np.complex128)
    error = np.zeros(value.shape)
    for k, f in enumerate(asked.frequency.tolist()):
        found, wrong = _converged(asked, motions, f, turn(f))
        size = np.abs(found)
        relative = np.divide(wrong, size, out=np.zeros_like(size), where=size > 0)
        value[:, k], error[:, k] = found / asked.amplitude, relative
        asked.progress((k + 1) / len(asked.frequency))
    unknowns = sum(m.lumps.chain.free for m in motions)
    work = sum(m.stages for m in motions), sum(m.factorisations for m in motions)
    cost = Cost("direct", len(asked.model.x) - 1, unknowns, *work)
    stable = np.ones(len(asked.frequency), dtype=np.bool_)  # or it would not have settled
    return asked.answer(asked.frequency, value, error, cost, stable)


def _converged(
    asked: SteppedSine, motions: list[Motion], frequency: float, turn: int
) -> tuple[Complex, Real]:
    """Return the amplitudes with ever shorter steps, extrapolated, and how far they are off."""
    count = FEWEST
    before, _ = _settled(asked, motions, frequency, count, turn)
    while count < MOST:
        count *= 2
        after, left = _settled(asked, motions, frequency, count, turn)
        # of second order: a third of the change is what is left of it
        off = np.abs(after - before) / 3
        if (off <= (asked.tolerance or TOLERANCE) * np.abs(after).max()).all():
            return after + (after - before) / 3, off + left
        before = after
    raise SolveError(
        f"frequency {frequency!r} Hz: with {count} steps a period the amplitude is still known to "
        f"{float((off / np.abs(after).max()).max()):.1e} only: ask for a larger tolerance"
    )


def _settled(
    asked: SteppedSine, motions: list[Motion], frequency: float, count: int, turn: int
) -> tuple[Complex, float]:
    """Return the amplitudes when they stay, with so many steps a period, and what is left."""
    push = (Sine(asked.amplitude, frequency, phase=math.pi / 2),)
    for motion in motions:
        drives, ends = push * len(motion.lumps.forces), push * len(motion.lumps.motions)
        motion.lumps = replace(motion.lumps, forces=drives, motions=ends)
    periods = math.ceil(WINDOW / turn) * turn
    seen: list[Complex] = []
    for k in range(max(LONGEST // periods, LOOKS + 1)):
        these = range(k * periods, (k + 1) * periods)
        seen.append(_window(asked, motions, frequency, count, these))
        if len(seen) <= LOOKS:
            continue
        changes = np.abs(np.diff(seen[-LOOKS - 1 :], axis=0)).max(axis=1)
        size = np.abs(seen[-1]).max()
        left = _left(changes)
        if left <= (asked.tolerance or TOLERANCE) / 2 * size:
            return seen[-1], left
    raise SolveError(
        f"frequency {frequency!r} Hz has no steady state: after {LONGEST} periods the amplitude "
        f"changes by {float(changes[-1] / size):.1e} of itself in {periods} periods"
    )


def _left(changes: Real) -> float:
    """Return what geometric changes add up to from now on, infinite where they grow."""
    half = len(changes) // 2
    early, late = float(changes[:half].max()), float(changes[half:].max())
    if late == 0:
        return 0.0
    ratio = math.sqrt(late / early) if early > 0 else math.inf
    return late * ratio / (1 - ratio) if ratio < 1 else math.inf


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
