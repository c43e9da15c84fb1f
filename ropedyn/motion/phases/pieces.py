"""Forces as pieces between the times at which they jump or bend: sines and straight lines."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...scene.force import Chirp, Force, Impulse, Samples, Sine, Step, Sum
from .driven import Forcing

AMPLITUDES = ("wave", "level", "slope")


class ForcePiece(NamedTuple):
    """What drives from one time to another."""

    start: float  # [s]
    stop: float  # [s]
    push: Forcing  # since the start
    kick: Real  # (drives,) blows at the start [N s]


def pieces(forces: Sequence[Force], time: Real, factor: float = 1.0) -> Iterator[ForcePiece]:
    """Return what drives, times a factor, between the times at which it changes, in turn."""
    begin, end = float(time[0]), float(time[-1])
    each = [list(_flat(force)) for force in forces]
    cuts = {begin, end}
    for one in (one for some in each for one in some):
        inner = one.time.tolist() if isinstance(one, Samples) else one.breaks
        cuts.update(t for t in (*inner, *(at for at, _ in one.blows)) if begin < t < end)
    order = sorted(cuts)
    if len(order) == 1:
        return
    for start, stop in pairwise(order):
        kick = [sum(p for one in some for at, p in one.blows if at == start) for some in each]
        push = _push(each, start, stop)
        push = push._replace(**{name: factor * getattr(push, name) for name in AMPLITUDES})
        yield ForcePiece(start, stop, push, factor * np.array(kick, dtype=np.float64))


def is_chirp(force: Force) -> bool:
    """Whether some of it is a chirp, which is no sum of exponentials."""
    return any(isinstance(one, Chirp) for one in _flat(force))


def _flat(force: Force) -> Iterator[Force]:
    if isinstance(force, Sum):
        for one in force.forces:
            yield from _flat(one)
    else:
        yield force


def _push(each: Sequence[Sequence[Force]], start: float, stop: float) -> Forcing:
    """Return the drives between two times, within which they do not break."""
    waves: list[tuple[int, float, complex]] = []
    level, slope = np.zeros(len(each)), np.zeros(len(each))
    middle = (start + stop) / 2
    for d, force in ((d, one) for d, some in enumerate(each) for one in some):
        if isinstance(force, Sine) and force.frequency > 0:
            w = 2 * math.pi * force.frequency
            waves.append((d, w, _sine(force.amplitude, w * start + force.phase)))
        elif isinstance(force, Impulse) and force.time <= middle < force.time + force.duration:
            w = math.pi / force.duration
            waves.append((d, w, _sine(float(force.amplitude), w * (start - force.time))))
        elif isinstance(force, Samples):
            level[d] += float(force.value(np.array(start)))
            slope[d] += float(force.rate(np.array(middle)))
        elif isinstance(force, (Step, Sine)):
            level[d] += float(force.value(np.array(middle)))
    rate = 1j * np.array(sorted({w for _, w, _ in waves}))
    wave = np.zeros((len(each), len(rate)), dtype=np.complex128)
    for d, w, amplitude in waves:
        wave[d, np.flatnonzero(rate.imag == w)[0]] += amplitude
    return Forcing(rate, wave, level, slope)


def _sine(amplitude: float, angle: float) -> complex:
    """Return the wave of amplitude sin(w t + angle)."""
    return amplitude * complex(math.sin(angle), -math.cos(angle))
