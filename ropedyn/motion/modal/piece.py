"""A force in time as pieces of sines."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...scene.force import Force, Impulse, Sine, Step


class Piece(NamedTuple):
    """A force cosine cos(w (t - start)) + sine sin(w (t - start)) until the next piece.

    A blow at its start moves what it hits by `kick`.
    """

    start: float  # [s]
    frequency: float = 0.0  # w [rad/s]
    cosine: float = 0.0  # [N]
    sine: float = 0.0  # [N]
    kick: float = 0.0  # [N s]

    def value(self, time: Real, order: int) -> Real:
        """Return the force at times [s], `order` times differentiated."""
        angle = self.frequency * (time - self.start) + order * math.pi / 2
        wave = self.cosine * np.cos(angle) + self.sine * np.sin(angle)
        return np.asarray(np.float64(self.frequency) ** order * wave)


def pieces(force: Force, begin: float) -> list[Piece]:
    """Return what acts from a time on, in turn."""
    if isinstance(force, Sine):
        w = 2 * math.pi * force.frequency
        return [sine(begin, w, force.amplitude, w * begin + force.phase)]
    if isinstance(force, Step):
        return [Piece(max(force.time, begin), cosine=force.amplitude)]
    assert isinstance(force, Impulse)
    start, end = max(force.time, begin), force.time + force.duration
    if force.duration == 0:
        return [Piece(start, kick=force.impulse)] if force.time >= begin else []
    if end <= begin:
        return []
    w = math.pi / force.duration
    return [sine(start, w, force.amplitude, w * (start - force.time)), Piece(end)]


def sine(start: float, w: float, amplitude: float, phase: float) -> Piece:
    """Return amplitude sin(w (t - start) + phase)."""
    return Piece(start, w, amplitude * math.sin(phase), amplitude * math.cos(phase))
