"""What an answer changes when something is left out: mode by mode, or line by line."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...base.array import Complex, Index, Real
from ...chain.chain import CARRIED
from ...eigen.eigen import solve_modes
from ...eigen.modes import Modes
from ...eigen.spectrum import in_hertz
from ...model import Model
from ...motion.history import History
from ...response.frf import FRF
from ...space.model import SpaceModel

# Modes are told apart by whose kinetic energy they have: a cross section that turns with dz/dx
# belongs to z, and what the rope carries has modes of its own.
MOTIONS = {
    "axial": ("x",),
    "transverse": ("z", "beta"),
    "transverse in y": ("y", "gamma"),
    "torsional": ("alpha",),
    **{kind: (name,) for kind, name in CARRIED.items()},
}
RATIO_MESH, RATIO_ROUNDING = 100.0, 1e-10
"""Error of a damping ratio, relative: so much of that of the frequency, of a shape's rounding."""
FURTHEST = 16  # Modes are paired with those among at most so many times as many.
# What is measured of a change, the largest first.
RATIO = "damping ratio [1]"
OF_MODES = ("largest [Hz]", "rms [Hz]", "largest [%]", "rms [%]", RATIO)
PHASE = "phase [deg]"
OF_FRF = ("largest [dB]", "median [dB]", "peak shift [Hz]", PHASE)
OF_MOTION = ("largest [%]", "rms [%]", "peak [%]")
OF_VALUES = ("largest [%]", "rms [%]")


@dataclass(frozen=True)
class AnswerChange:
    """What leaving something out changes."""

    size: dict[str, float]  # by what is measured with its unit; NaN where nothing can be compared
    error: float  # error bars of both answers where the change is largest, in the same unit
    beyond_error: bool  # whether any change is larger than its error bars, or something is lost
    lost: int  # modes or responses that are only there with it
    changed: tuple[str, ...] = ()  # what changes by more than the error bars that are known
    relative: float = math.inf  # how far the answer is off without it, with its error bars
    unsure: int = 0  # values whose partner another one could be; error bars have both

    @staticmethod
    def unknown(measures: Sequence[str]) -> AnswerChange:
        """Return the change of what has no answer."""
        return AnswerChange.lost_some(measures, 0)

    @staticmethod
    def lost_some(measures: Sequence[str], lost: int) -> AnswerChange:
        """Return the change of an answer that has fewer values, which cannot be compared."""
        return AnswerChange(dict.fromkeys(measures, np.nan), np.nan, lost != 0, max(lost, 0))


def relative(found: NDArray[Any], right: NDArray[Any]) -> Real:
    """Return relative differences: 0 where both are 0, 1 where only the right value is."""
    size = np.where(right == 0, np.abs(found), np.abs(right))
    return np.divide(np.abs(found - right), size, out=np.zeros(size.shape), where=size > 0)


def of_largest(found: Real, values: Real) -> Real:
    """Return differences (responses, t) over the largest value of each response.

    0 of a response that is 0 where the difference is too, else infinite.
    """
    size = np.broadcast_to(np.abs(values).max(axis=1, keepdims=True), found.shape)
    ratio = np.where(found == 0, 0.0, np.inf)
    return np.divide(np.abs(found), size, out=ratio, where=size > 0)


# --- modes ------------------------------------------------------------------------------------


def change_of_modes(whole: Modes, model: Model | SpaceModel, solver: str) -> AnswerChange:
    """Compare modes with those of the same motion and order of a model that has less."""
    mine = motions(whole)
    others = _modes_alike(mine, model, solver)
    paired = [np.flatnonzero(mine == motion)[: len(one)] for motion, one in others.items()]
    before, error, ratio, blurred = _numbers(whole)[np.concatenate(paired)].T
    after, uncertain, left, unclear = np.concatenate(list(others.values())).T
    hertz, percent = np.abs(after - before), 100 * relative(after, before)
    error = error + uncertain
    lost = len(mine) - len(after)
    measures = (np.max, lambda each: np.sqrt(np.mean(each**2)))
    size = [_of(measure, each) for each in (hertz, percent) for measure in measures]
    damping = np.abs(left - ratio)
    ratios = damping + blurred + unclear
    beyond = {"frequency": hertz > error, "damping ratio": damping > blurred + unclear}
    changed = tuple(name for name, where in beyond.items() if where.any())
    return AnswerChange(
        size=dict(zip(OF_MODES, (*size, _of(np.max, damping[~np.isnan(damping)])))),
        error=_of(lambda of: error[of.argmax()], hertz),
        beyond_error=bool(lost > 0 or changed),
        lost=lost,
        changed=changed,
        relative=math.inf if lost else max(_share(hertz + error, before), _of(np.nanmax, ratios)),
    )


def _share(change: Real, values: Real) -> float:
    """Return the largest change relative to values, infinite where one is 0."""
    size = np.abs(values)
    return float(np.divide(change, size, out=np.full(size.shape, np.inf), where=size > 0).max())


def motions(modes: Modes) -> NDArray[np.str_]:
    """Say of each mode which motion it is, one of `MOTIONS`, by its kinetic energy."""
    # Where a coupling mixes two modes in equal parts, both could be called the same: so what a mode
    # has of the motions that it is not called is owed to them, and the next mode pays. The shares
    # that a resonator has of all modes there are have the sum 1: it is given one of them.
    moving = _moving(modes.energy)
    names = np.array(list(moving))
    shares = {motion: sum(modes.energy[c] for c in own) for motion, own in moving.items()}
    owed, which = np.zeros(len(names)), []
    for share in np.stack(list(shares.values()), axis=1):
        owed += share / share.sum()
        which.append(int(owed.argmax()))
        owed[which[-1]] -= 1.0
    return names[which]


def _moving(energies: Collection[str]) -> dict[str, tuple[str, ...]]:
    """Return the motions there are, and which of the energies are theirs."""
    present = {m: tuple(e for e in energies if e in own) for m, own in MOTIONS.items()}
    return {motion: own for motion, own in present.items() if own}


def _modes_alike(mine: NDArray[np.str_], model: Model | SpaceModel, solver: str) -> dict[str, Real]:
    """Return modes of a model, for each motion as many as wanted or as there are."""
    carried = () if isinstance(model, SpaceModel) else model.chain.carried
    energies = (*model.coordinates, *(CARRIED[kind] for kind in carried))
    wanted = {
        motion: min(int(np.sum(mine == motion)), _most(model, motion, own))
        for motion, own in _moving(energies).items()
    }
    found = {motion: np.zeros((0, 4)) for motion in wanted}
    number = len(mine)
    while True:
        sags = model.scene.sags and model.element == "continuous"
        if isinstance(model, SpaceModel) or sags:
            modes = model.modes(number)
        else:
            modes = solve_modes(model, number, below=None, solver=solver, strict=False)
        which, numbers = motions(modes), _numbers(modes)
        for motion in [m for m in wanted if len(found[m]) < wanted[m]]:
            found[motion] = numbers[which == motion][: wanted[motion]]
        complete = all(len(found[motion]) == wanted[motion] for motion in wanted)
        if complete or len(modes.frequency) < number or number >= FURTHEST * len(mine):
            return found
        number *= 2


def _most(model: Model | SpaceModel, motion: str, own: tuple[str, ...]) -> int:
    """Return how many modes of a motion there can be: as many as coordinates have inertia."""
    endless = np.iinfo(np.int32).max
    if isinstance(model, SpaceModel):
        return endless if model.rope.has_inertia(own) else 0
    if motion in CARRIED:
        return int(model.chain.carries(motion).sum()) if motion == "resonator" else endless
    chain = model.chain.only(own)
    if chain.inertia is not None and chain.inertia.any():
        return endless
    heavy = chain.mass.any(axis=2) & (chain.held == 0)
    return int(heavy[chain.term_of].sum())


def _numbers(modes: Modes) -> Real:
    """Return frequency and error [Hz], damping ratio and error of each mode, shape (k, 4)."""
    hertz, error, ratio = in_hertz(modes.eigenvalue), modes.mesh_error, modes.damping_ratio
    # shapes are less right than frequencies, of which the error is quadratic in that of the shape
    off = np.divide(error, np.abs(hertz), out=np.zeros_like(error), where=hertz != 0)
    blurred = (RATIO_MESH * off + RATIO_ROUNDING) * np.abs(ratio)
    return np.stack([hertz, error + modes.rounding_bound, ratio, blurred], axis=1)


# --- frequency response -----------------------------------------------------------------------


def change_of_frf(whole: FRF, left: FRF) -> AnswerChange:
    """Compare a frequency response with that of what is left, line by line."""
    lines = len(whole.frequency)
    # without a correct digit, as by symmetry, it counts as 0
    known = (np.where(frf.rounding_bound < 1, frf.value, 0.0) for frf in (whole, left))
    before, after = (one.reshape(-1, lines) for one in known)
    there = ~before.any(axis=1) | after.any(axis=1)
    before, after = before[there], after[there]
    off = (_relative_error(whole) + _relative_error(left)).reshape(-1, lines)[there]
    level, phase = _level(before, after), np.degrees(np.abs(np.angle(after * before.conj())))
    # of both answers, as a decibel and as an angle
    error, turned = _decibel(off), np.degrees(np.arcsin(np.minimum(off, 1.0)))
    size = (_of(np.max, level), _of(np.median, level), _peak_shift(whole, left))
    lost = int((~there).sum())
    beyond = {"level": level > error, "phase": phase > turned}
    changed = tuple(name for name, where in beyond.items() if where.any())
    return AnswerChange(
        size=dict(zip(OF_FRF, (*size, _of(np.max, phase)))),
        error=_of(lambda of: error.flat[of.argmax()], level),
        beyond_error=bool(lost or changed),
        lost=lost,
        changed=changed,
        relative=math.inf if lost else _of(np.max, _ratio(after - before, before) + off),
    )


def _ratio(change: Complex, before: Complex) -> Real:
    """Return |change/before|: 0 where both are 0, infinite where only what was before is."""
    size = np.abs(before)
    none = np.where(change == 0, 0.0, np.inf)
    return np.divide(np.abs(change), size, out=none, where=size > 0)


def _level(before: Complex, after: Complex) -> Real:
    """Return |20 log10(after/before)| [dB]: 0 where both are 0, infinite where only one is."""
    before, after = np.abs(before), np.abs(after)
    with np.errstate(divide="ignore", invalid="ignore"):
        level = 20 * np.abs(np.log10(after) - np.log10(before))
    return np.where((before == 0) & (after == 0), 0.0, level)


def _relative_error(frf: FRF) -> Real:
    return np.where(frf.rounding_bound < 1, frf.rounding_bound + frf.mesh_error, 0.0)


def _decibel(relative_error: Real) -> Real:
    """Return how far a level may be off when a value is off by a relative error [dB]."""
    with np.errstate(divide="ignore"):
        return -20 * np.log10(1 - np.minimum(relative_error, 1.0))


def _peak_shift(whole: FRF, left: FRF) -> float:
    """Return how far the largest peak moves [Hz], if the nearest one has the same number."""
    shifts = []
    drives = len(whole.drive) if whole.value.ndim == 3 else 1
    for drive in range(drives):
        for one, other in zip(whole.peaks(drive), left.peaks(drive)):
            if len(one.frequency) == 0 or len(other.frequency) == 0:
                continue
            largest = one.amplitude.argmax()
            away = other.frequency - one.frequency[largest]
            if np.abs(away).argmin() == largest:
                shifts.append(float(away[largest]))
    return max(shifts, key=abs, default=np.nan)


# --- motion over time ---------------------------------------------------------------------------


def change_of_motion(whole: History, left: History) -> AnswerChange:
    """Compare motion over time with that of what is left, in percent of the largest value."""
    before, after = whole.value, left.value
    stands = np.where(before.any(axis=1, keepdims=True), before, after)
    percent, error = (
        100 * of_largest(of, stands)
        for of in (after - before, whole.total_error + left.total_error)
    )
    peaks = (np.abs(of).max(axis=1, keepdims=True) for of in (before, after))
    size = (
        _of(np.max, percent),
        _of(lambda each: np.sqrt(np.mean(each**2)), percent),
        _of(np.max, 100 * of_largest(np.subtract(*peaks), stands)),
    )
    known = 100 * of_largest(whole.error + left.error, stands)
    lost = int((before.any(axis=1) & ~after.any(axis=1)).sum())
    return AnswerChange(
        size=dict(zip(OF_MOTION, size)),
        error=_of(lambda of: error.flat[of.argmax()], percent),
        beyond_error=bool(lost > 0 or (percent > error).any()),
        lost=lost,
        changed=("motion",) * bool((percent > known).any()),
        relative=math.inf if lost else float((percent + known).max() / 100),
    )


# --- other values -------------------------------------------------------------------------------


def partners(found: NDArray[Any], right: NDArray[Any]) -> tuple[Index, Real]:
    """Return which values right ones are next to, each once at most, and how far that is open.

    All together are as near as can be. Where another choice, or two that change places, would be
    less than twice as far, the distance is open by as much.
    """
    from scipy.optimize import linear_sum_assignment

    away = np.abs(np.subtract.outer(right, found))
    which = linear_sum_assignment(away)[1]
    own = away[np.arange(len(right)), which]
    other = np.setdiff1d(np.arange(len(found)), which)
    across = away[:, which]
    alike = across + across.T < 2 * np.add.outer(own, own)
    np.fill_diagonal(alike, False)
    apart = np.abs(np.hstack([across, away[:, other]]) - own[:, None])
    could = np.hstack([alike, away[:, other] < 2 * own[:, None]])
    return which, np.where(could, apart, 0.0).max(axis=1, initial=0.0)


def change_of_values(apart: Real, error: Real, measures: Sequence[str]) -> AnswerChange:
    """Say how far values are apart that have these error bars, both relative, in percent."""
    told = np.isfinite(apart)
    percent, bars = 100 * apart[told], 100 * error[told]
    known = np.where(np.isinf(bars), 0.0, bars)
    size = (_of(np.max, percent), _of(lambda each: np.sqrt(np.mean(each**2)), percent))
    return AnswerChange(
        size=dict(zip(measures, size)),
        error=_of(lambda of: bars[of.argmax()], percent),
        beyond_error=bool((percent > bars).any()),
        lost=0,
        changed=("answer",) * bool((percent > known).any()),
        relative=_of(np.max, (percent + known) / 100),
    )


def _of(measure: Callable[[Real], Any], change: Real) -> float:
    """Return a measure of changes, NaN of none."""
    return float(measure(change)) if change.size else np.nan
