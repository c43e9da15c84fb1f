"""Slips in measured responses: signs of phase, quantities, angles, units of frequencies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.unit import QUANTITIES
from ...chain.port import Point
from ...curves.measured import Measured, above_zero
from ...curves.resonance import Resonances
from ...model import Model
from ...signal.likeness import residues
from .calculated import CalculatedPeaks, index, is_motion, undamped_peaks
from .measured import peaks_in
from .numbering import numbered
from .unit_slips import slips_of_peaks

CLEAR = 6.0  # A damping ratio is proved by so many standard uncertainties.
FEWEST = 3  # Of fewer peaks nothing is said of all of them.
LIKE = math.radians(25)  # Phases of residues are those of a quantity to so much.
AGREE = 0.75  # So many of them agree.
LEAST = 4  # Of fewer residues no trend is said.
TREND = 0.35  # Amplitudes grow by a whole power of frequency to so much.
NODE = 0.3  # Residues of less than this share of the largest say less.
PROVED = 0.2  # Standard error of that power at most.
TURN = math.radians(1.02 * math.pi)  # Phases in radians that were read as degrees are less.
MOVES = math.radians(1.0)  # And move by a radian.


class Residues(NamedTuple):
    """What one response shows of its modes, if it is what it is said to be."""

    frequency: Real  # (k,) [Hz]
    size: Complex  # (k,) A of A/(omega_k^2 - omega^2 + 2 i zeta omega_k omega) [1/kg]


def slips(measured: Measured, model: Model | None = None) -> tuple[str, ...]:
    """Name slips in a measured response, each with what to do; nothing is repaired."""
    measured = above_zero(measured)
    if _in_radians(measured):
        return (
            "all phases lie within 3.2 deg although the response has peaks: they were read as "
            "degrees and are radians; multiply the phases by 180/pi",
        )
    found, said = measured.peaks(), []
    if not _grows(found):
        mirrored = replace(measured, value=measured.value.conj())
        turned = mirrored.peaks()
        if _grows(turned):
            said.append(
                "all peaks would grow by themselves: the phase has the other sign, motion is "
                "Re(value exp(-i omega t)); take the complex conjugate of the values"
            )
            measured, found = mirrored, turned
    said += _quantity(measured, found, model)
    if model is not None:
        said += slips_of_peaks(peaks_in(found).frequency, model)
    return tuple(said)


def _in_radians(measured: Measured) -> bool:
    """Whether phases of a resonant response were read as degrees and are radians."""
    # past a resonance they move by 180 degrees
    angle = np.angle(measured.value)
    if np.abs(angle).max(initial=0.0) > TURN or np.ptp(angle) < MOVES:
        return False
    return any(len(one.frequency) > 0 or len(one.left_out) > 0 for one in measured.peaks())


def _grows(found: Sequence[Resonances]) -> bool:
    """Whether any peak is proved to be damped: with the phase of the other sign none is."""
    return any((one.damping_ratio > CLEAR * one.damping_ratio_std).any() for one in found)


def _quantity(measured: Measured, found: Sequence[Resonances], model: Model | None) -> list[str]:
    """Say which quantity the responses are, if it is another than was said."""
    # a driven point's residues are positive for the right quantity: each derivative in time more
    # turns them by 90 degrees and multiplies them by omega
    drive = measured.drive[0]
    at = index(measured.response, drive) if is_motion(drive) else None
    if at is not None:
        return _by_phase(measured, at, found[at], model)
    if model is None:
        return []
    for k, one in enumerate(found):
        other = _other(measured, _power(measured, _residues(measured, k, one), k, model) or 0)
        if other:
            return [_said(measured, other, "the amplitudes of its modes")]
    return []


def _by_phase(measured: Measured, at: int, found: Resonances, model: Model | None) -> list[str]:
    """Say which quantity a driven point shows, by the phases of its residues."""
    seen = _residues(measured, at, found)
    if len(seen.frequency) < FEWEST:
        return []
    # a mode that has a node nearby may turn otherwise
    turns = round(float(np.median(np.degrees(np.angle(seen.size)) % 360)) / 90)
    turns = (turns + 1) % 4 - 1
    away = np.abs(np.angle(seen.size / 1j**turns))
    if turns == 0 or np.mean(away < LIKE) < AGREE:
        return []
    if abs(turns) == 1:
        other = _other(measured, turns)
        return [_said(measured, other, "the phase of its driven point")] if other else []
    other = _other(measured, 2) or _other(measured, -2)
    power = None if model is None else _power(measured, seen, at, model)
    against = "the driven point moves against its force: "
    if power and other:
        return [_said(measured, other, "the phase of its driven point and its amplitudes")]
    if power == 0 or not other:
        return [f"{against}the sensor or the force has the other sign; change the sign"]
    return [
        f"{against}what was said to be {measured.quantity} is {other}, or the sensor or the force "
        f'has the other sign; read it with quantity="{other}", or change the sign'
    ]


def _other(measured: Measured, power: int) -> str:
    """Return the quantity with a power of omega more than the one that was said, empty if none."""
    names = {k: name for name, k in QUANTITIES.items()}
    return names.get(QUANTITIES[measured.quantity] + power, "") if power else ""


def _said(measured: Measured, other: str, by: str) -> str:
    """Say that a response is another quantity."""
    return (
        f"what was said to be {measured.quantity} is {other}, by {by}; read it with "
        f'quantity="{other}"'
    )


def _residues(measured: Measured, k: int, found: Resonances) -> Residues:
    """Return the residues of the peaks of one response."""
    f, ratio = found.frequency, found.damping_ratio
    seen = residues(measured.frequency, measured.value[[k]], measured.quantity, f, ratio)[:, 0]
    alive = np.abs(seen) > 0
    return Residues(f[alive], seen[alive] * (2 * np.pi * f[alive]) ** 2)


def _power(measured: Measured, seen: Residues, k: int, model: Model) -> int | None:
    """Return the power of omega by which residues exceed those of a model; None: not told."""
    points = (measured.drive[0], measured.response[k])
    if len(seen.frequency) < LEAST or not all(map(is_motion, points)):
        return None
    found = undamped_peaks(model, float(seen.frequency.max()), len(seen.frequency))
    order = numbered(seen.frequency, found.frequency, np.full(len(seen.frequency), np.nan))[0].order
    at = order > 0
    size = _sizes(found, found.checked(points, "measured.response"))[order[at] - 1]
    if at.sum() < LEAST or not (size > 0).all():
        return None
    # near a node a model that is a little off is off by much
    weight = size / (size + NODE * size.max())
    log = np.log(np.abs(seen.size[at]) / size)
    (slope, _), square = np.polyfit(np.log(seen.frequency[at]), log, 1, w=weight, cov=True)
    power = round(slope)
    return power if abs(slope - power) < TREND and square[0, 0] < PROVED**2 else None


def _sizes(found: CalculatedPeaks, points: Sequence[Point]) -> Real:
    """Return the residues of calculated modes between two points, without their signs."""
    modes = found.modes
    assert modes is not None
    size = 1 / modes.modal_mass
    for name, x in points:
        column = modes.shape[:, :, modes.coordinates.index(name)]
        size = size * np.array([abs(np.interp(x, modes.x, row)) for row in column])
    return np.asarray(size[found.number])
