"""Slips of units: measured frequencies, or tensions, a known factor away from the scene's."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...model import Model
from ...scene.scene import Scene
from .calculated import CalculatedPeaks, undamped_peaks
from .numbering import Pairing, numbered, weighed

FEWEST = 3  # Of fewer peaks nothing is said of all of them.
FARTHER = 20.0  # Modes above so many times the median peak are not looked at.
BELOW = 0.4  # Of the first mode, less than this no peak pairs.
ALMOST = 0.9  # Of all peaks so many pair.
MUCH = 5.0  # By which the evidence of scaled frequencies is more than that of frequencies.
DENSE = 10  # Of scaled frequencies no more than so many times as many modes are looked at.
CROWD = 30  # Among more modes for each peak than that none is told.
NEAR = 1.25  # A tension is so near to a power that it is a slip's.


class UnitSlip(NamedTuple):
    """What the frequencies, or the scene's tension and length, are times what they would be."""

    said: str
    frequency: float = 1.0
    tension: float = 1.0
    length: float = 1.0


class Power(NamedTuple):
    """How many times its guess a tension is by a slip."""

    times: float
    name: str
    asked: str


ANGULAR = (
    "all peaks pair with modes after division by 2 pi: the frequencies are rad/s, or the tension "
    "is some 40 times the scene's; divide them by 2 pi"
)
UNIT_SLIPS = (
    UnitSlip(ANGULAR, frequency=2 * math.pi),
    UnitSlip(
        "all peaks pair with modes after division by 60: the frequencies are per minute, or the "
        "tension is some 3600 times the scene's; divide them by 60",
        frequency=60.0,
    ),
    UnitSlip(
        "all peaks pair with modes after division by 1000: the frequencies are in mHz, or the "
        "scene has its length in mm; give Hz and m",
        frequency=1e3,
    ),
    UnitSlip(
        "all peaks pair with modes times 1000: the frequencies are in kHz, or the scene has its "
        "length in km; give Hz and m",
        frequency=1e-3,
    ),
    UnitSlip(
        "all peaks pair with modes after division by sqrt(1000): the scene has its linear_density "
        "in g/m, or a tension 1000 times too low; give kg/m and N",
        frequency=math.sqrt(1e3),
    ),
    UnitSlip(
        "all peaks pair with modes of 1000 times the tension: the scene has it in kN; give N",
        tension=1e-3,
    ),
    UnitSlip(
        "all peaks pair with modes of 10^6 times the tension: the scene has it in MN; give N",
        tension=1e-6,
    ),
    UnitSlip(
        "all peaks pair with modes of a 1000th of the length: the scene has its length in mm; give "
        "m",
        length=1e3,
    ),
)
POWERS = (
    Power((2 * math.pi) ** 2, "(2 pi)^2", "are these peaks in rad/s?"),
    Power(3600.0, "60^2", "are these peaks per minute?"),
    Power(1e3, "1000", "was it guessed in kN, or is linear_density in g/m?"),
    Power(1e6, "10^6", "was it guessed in MN, is length in mm, or are the peaks in mHz?"),
    Power(1e-3, "1/1000", "was it guessed in mN?"),
    Power(1e-6, "10^-6", "are these peaks in kHz, or is length in km?"),
)


def slip_of_tension(guess: float, found: float) -> Power | None:
    """Return what makes a tension so many times what it was guessed to be; 1 N is no guess."""
    times = math.nan if guess in (0.0, 1.0) else found / guess
    return next((one for one in POWERS if 1 / NEAR < times / one.times < NEAR), None)


def slips_of_peaks(frequency: Real, model: Model) -> tuple[str, ...]:
    """Name the slip in measured frequencies [Hz] that the modes of a model prove, if any."""
    frequency = np.asarray(frequency, dtype=np.float64)
    if len(frequency) < FEWEST:
        return ()
    tried = ((slip, _unslipped(frequency, slip, model)) for slip in UNIT_SLIPS)
    proved = [(slip, pairing) for slip, pairing in tried if pairing is not None]
    if not proved:
        return ()
    slip, best = max(proved, key=lambda one: one[1].evidence)
    return () if best.evidence < _as_said(frequency, model) + MUCH else (slip.said,)


def _as_said(frequency: Real, model: Model) -> float:
    """Return the evidence of frequencies as they were given; among crowds of modes all stray."""
    if model.count(below=_highest(frequency)) > CROWD * len(frequency):
        unknown, none = np.full(len(frequency), np.nan), np.zeros(len(frequency), dtype=np.int64)
        return weighed(frequency, unknown, unknown, none).evidence
    found = undamped_peaks(model, _highest(frequency), len(frequency))
    return _numbered(frequency, found).evidence


def _unslipped(frequency: Real, slip: UnitSlip, model: Model) -> Pairing | None:
    """Return the pairs of frequencies without a slip, None where not nearly all pair."""
    if (slip.tension, slip.length) != (1, 1):
        scene = _unslipped_scene(model.scene, slip)
        if scene is None:
            return None
        model = scene.compile()
    scaled = frequency / slip.frequency
    highest, most = _highest(scaled), DENSE * len(frequency)
    if model.count(below=highest) > most:
        return None
    found = undamped_peaks(model, highest, len(frequency))
    if np.mean(scaled > BELOW * found.frequency.min(initial=np.inf)) < ALMOST:
        return None
    pairing = _numbered(scaled, found)
    return pairing if pairing.pairs >= ALMOST * len(frequency) else None


def _unslipped_scene(scene: Scene, slip: UnitSlip) -> Scene | None:
    """Return the scene without a slip, None where more than the slip would change."""
    if not isinstance(scene.tension, float) or not scene.tension > 0:
        return None
    if slip.length != 1 and (scene.parts or scene.gravity is not None):
        return None
    rope = scene.rope.replace(length=scene.rope.length / slip.length)
    return scene.replace(rope=rope, tension=scene.tension / slip.tension)


def _numbered(frequency: Real, found: CalculatedPeaks) -> Pairing:
    return numbered(frequency, found.frequency, np.full(len(frequency), np.nan))[0]


def _highest(frequency: Real) -> float:
    return min(float(frequency.max()), FARTHER * float(np.median(frequency)))
