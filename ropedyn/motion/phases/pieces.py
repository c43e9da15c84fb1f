"""Forces as pieces between the times at which they jump or bend: sines and straight lines."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...scene.force import Chirp, Force, Impulse, Samples, Sine, Step, Sum, rotation
from .driven import Forcing

ULP = np.finfo(float).eps  # Rates are known to this part, which after many turns is far more.
ROUND = 1e-6  # A force that changes by less of itself in an ulp does not jump.


class ForcePiece(NamedTuple):
    """What drives from one time to another."""

    start: float  # since the first time [s]
    stop: float
    push: Forcing  # since the start
    kick: Real  # (drives,) blows at the start [N s]


def pieces(forces: Sequence[Force], time: Real, nudge: float = 0.0) -> Iterator[ForcePiece]:
    """Return what drives, nudged, between the times at which it changes, in turn."""
    factor = 1 + nudge
    first, last = float(time[0]), float(time[-1])
    each = [list(_flat(force)) for force in forces]
    cuts = {first, last}
    for one in (one for some in each for one in some):
        inner = one.time.tolist() if isinstance(one, Samples) else one.breaks
        cuts.update(t for t in (*inner, *(at for at, _ in one.blows)) if first < t < last)
    # what jumps at the last time has its value from then on
    ends = [last] if any(_jumps(one, last) for some in each for one in some) else []
    order = np.array([*sorted(cuts), *ends])
    start, middle = order[:-1], (order[:-1] + order[1:]) / 2
    level, slope = (factor * one for one in _straight(each, start, middle))
    for k, begin in enumerate(start.tolist()):
        kick = [sum(p for one in some for at, p in one.blows if at == begin) for some in each]
        rate, wave = _waves(each, begin, float(middle[k]))
        push = Forcing((1 + min(nudge, ULP)) * rate, factor * wave, level[:, k], slope[:, k])
        since, until = (order[k : k + 2] - first).tolist()
        yield ForcePiece(since, until, push, factor * np.array(kick, dtype=np.float64))


def _jumps(force: Force, when: float) -> bool:
    """Whether a force is another one from a time on."""
    if when not in force.breaks:
        return False
    before, after = force.value(np.array([np.nextafter(when, -np.inf), when]))
    return bool(abs(after - before) > ROUND * max(abs(after), abs(before)))


def is_chirp(force: Force) -> bool:
    """Whether some of it is a chirp, which is no sum of exponentials."""
    return any(isinstance(one, Chirp) for one in _flat(force))


def _flat(force: Force) -> Iterator[Force]:
    if isinstance(force, Sum):
        for one in force.forces:
            yield from _flat(one)
    else:
        yield force


def _straight(each: Sequence[Sequence[Force]], start: Real, middle: Real) -> tuple[Real, Real]:
    """Return levels and slopes of drives, (drives, pieces), which do not break within pieces."""
    level, slope = np.zeros((2, len(each), len(start)))
    for d, force in ((d, one) for d, some in enumerate(each) for one in some):
        if isinstance(force, Samples):
            level[d] += force.value(start)
            slope[d] += force.rate(middle)
        elif isinstance(force, Step) or (isinstance(force, Sine) and force.frequency == 0):
            level[d] += force.value(middle)
    return level, slope


def _waves(each: Sequence[Sequence[Force]], start: float, middle: float) -> tuple[Complex, Complex]:
    """Return the rates of a piece, and how much drives have of each, (drives, rates)."""
    waves: list[tuple[int, float, complex]] = []
    for d, force in ((d, one) for d, some in enumerate(each) for one in some):
        if isinstance(force, Sine) and force.frequency > 0:
            w = 2 * math.pi * force.frequency
            angle = float(rotation(force.frequency, start, force.phase))
            waves.append((d, w, _sine(force.amplitude, angle)))
        elif isinstance(force, Impulse) and force.time <= middle < force.time + force.duration:
            w = math.pi / force.duration
            waves.append((d, w, _sine(float(force.amplitude), w * (start - force.time))))
    rate = 1j * np.array(sorted({w for _, w, _ in waves}))
    wave = np.zeros((len(each), len(rate)), dtype=np.complex128)
    for d, w, amplitude in waves:
        wave[d, np.flatnonzero(rate.imag == w)[0]] += amplitude
    return rate, wave


def _sine(amplitude: float, angle: float) -> complex:
    """Return the wave of amplitude sin(w t + angle)."""
    return amplitude * complex(math.sin(angle), -math.cos(angle))
