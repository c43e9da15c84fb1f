"""Growth of motion under the tension that pulsates."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base import check
from ..base.answer import Answer, Cost, axes
from ..base.array import Complex, Index, Real
from ..base.errors import SceneError
from ..base.table import Table
from ..chain.compiled import Compiled
from ..motion.modal_system import ModalSystem, modal_system, transverse
from ..scene.tension import Tension
from .hill import motion_next_to
from .monodromy import finite, monodromy, rates, scales, steps_for

EPS = float(np.finfo(float).eps)
FINE = 0.6  # The highest mode turns so far in a step at first [rad].
CONVERGED = 1e-13  # Half as long steps change motion over a period by less than this part of it.
LOST = 1e-3  # A multiplier whose error is this part of it is lost beside larger ones.
TRACE = 1e-9  # Rates add up to what they must to this part of it.
AGREES = 10.0  # So many errors of it a multiplier may be from that of Hill's matrix.
PART = 0.1  # A mode with more of the energy of a motion takes part in it.
MOST_MODES = 200


@dataclass(frozen=True, eq=False)
class Floquet(Answer):
    """How free motion grows or decays under a tension that pulsates.

    Motion is a sum of 2k motions, each of which is multiplied by its multiplier over every period
    of the tension. Those that grow most come first.

    Attributes
    ----------
    period : float
        Of the tension [s].
    multiplier : ndarray of complex, shape (2k,)
        1.
    rate : ndarray of complex, shape (2k,)
        ln(multiplier)/period [1/s]. Also of motion that decays so fast that its multiplier
        is lost beside the others.
    growth : ndarray, shape (2k,)
        Real part of the rate [1/s], negative where motion decays.
    rounding_error : ndarray, shape (2k,)
        Estimated absolute error of each multiplier. Two of them that nearly meet, as on the
        boundary of instability, lose half of the digits.
    stable : bool
        Whether no |multiplier| is larger than 1 by more than its error. Without damping those of
        stable motion are 1.
    modes : ndarray of int, shape (k,)
        Which of the modes with transverse motion are summed, from 1.
    frequency : ndarray, shape (k,)
        Of these modes at the mean tension [Hz].
    participation : ndarray, shape (2k, k)
        Share of each mode in the energy of each motion at the beginning of a period.
    dominant : tuple of int
        The modes that take part in the motion which grows most, or decays least.
    cost : Cost
        What it cost.

    Examples
    --------
    A string whose tension pulsates at twice its first frequency:

    >>> import ropedyn as rd
    >>> tension = rd.Tension(1000.0, amplitude=100.0, frequency=100.0)
    >>> floquet = rd.Scene(rd.Rope(1.0, 0.1), tension=tension).compile().floquet(1)
    >>> floquet.stable, floquet.dominant, floquet.growth.round(2)
    (False, (1,), array([ 7.85, -7.85]))
    """

    period: float
    modes: Index = field(metadata=axes("mode"))
    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    rate: Complex = field(metadata=axes("motion", unit="1/s"))
    multiplier: Complex = field(metadata=axes("motion"))
    rounding_error: Real = field(metadata=axes("motion"))
    participation: Real = field(metadata=axes("motion", "mode"))
    cost: Cost

    @property
    def growth(self) -> Real:
        """Growth rates [1/s], shape (2k,)."""
        return self.rate.real

    @property
    def stable(self) -> bool:
        """Whether no motion grows, as far as rounding lets that be seen."""
        return bool((np.abs(self.multiplier) <= 1 + self.rounding_error).all())

    @property
    def dominant(self) -> tuple[int, ...]:
        """Modes that take part in the motion that grows most."""
        return self._taking_part(0)

    def _taking_part(self, motion: int) -> tuple[int, ...]:
        return tuple(self.modes[self.participation[motion] > PART].tolist())

    def table(self) -> Table:
        """Return one row for each motion."""
        numbers = range(len(self.multiplier))
        columns: dict[str, Any] = {
            "multiplier, real": self.multiplier.real,
            "multiplier, imaginary": self.multiplier.imag,
            "size": np.abs(self.multiplier),
            "error": self.rounding_error,
            "growth [1/s]": self.growth,
            "modes": tuple(", ".join(map(str, self._taking_part(n))) for n in numbers),
        }
        verdict = "stable" if self.stable else "unstable"
        return Table.of(f"multipliers of one period, {verdict}", columns)


def solve_floquet(model: Compiled, modes: int | None) -> Floquet:
    """Find the multipliers of a model; see `Model.floquet`."""
    tension = model.scene.tension
    if not isinstance(tension, Tension) or not tension.pulsates:
        raise SceneError(
            "tension must pulsate, such as Tension(1000.0, amplitude=100.0, frequency=50.0), got "
            f"{tension!r}"
        )
    system = modal_system(model, checked_modes(model, modes))
    count = len(system.eigenvalue)
    share = np.zeros((2 * count, count))
    rate: list[Complex] = []
    error: list[Real] = []
    steps, harmonics = 0, 0
    for block in system.blocks:
        part = system.only(block)
        matrix, off, made = converged(part, tension.frequency, tension.amplitude)
        found = _motions(part, tension.amplitude, 1 / tension.frequency, matrix, off)
        begin = sum(map(len, rate))
        share[begin : begin + len(found.rate), block] = found.share
        rate.append(found.rate)
        error.append(found.error)
        steps, harmonics = max(steps, made), max(harmonics, found.harmonics)
    every = np.concatenate(rate)
    value = np.exp(every / tension.frequency)
    value.imag[np.abs(value.imag) <= 4 * EPS * np.abs(value)] = 0.0
    # of a pair of the same size the one above the real axis comes first
    order = np.lexsort((-value.imag, -np.round(every.real / tension.frequency, 12)))
    return Floquet(
        period=1 / tension.frequency,
        modes=np.arange(1, count + 1),
        frequency=system.omega / (2 * np.pi),
        rate=every[order],
        multiplier=value[order],
        rounding_error=np.concatenate(error)[order],
        participation=share[order],
        cost=Cost(
            f"Hill's matrix, {harmonics} harmonics; composition of order 10, {steps} steps",
            len(model.x) - 1,
            2 * count,
        ),
    )


@dataclass(eq=False)
class _Motions:
    """Motions of coupled modes."""

    rate: Complex  # (2k,) [1/s]
    error: Real  # (2k,) of the multiplier
    share: Real  # (2k, k) of modes in the energy
    harmonics: int = 0  # so many were needed


def _motions(
    system: ModalSystem, amplitude: float, period: float, matrix: Real, off: float
) -> _Motions:
    """Find the motions by Hill's matrix, from those of the motion over a period and its error."""
    value, right = np.linalg.eig(matrix)
    error = _errors(matrix, off, right)
    lost = error > LOST * np.abs(value)
    with np.errstate(divide="ignore"):
        rate = np.log(value.astype(complex)) / period
    # what decays so fast is nearly as without pulsation
    decays = np.linalg.eigvals(rates(system))
    rate[lost] = decays[np.argsort(decays.real)[: lost.sum()]]
    found = _Motions(rate, error, _shares(right))
    for n, guess in enumerate(rate):
        motion = motion_next_to(system, amplitude, period, complex(guess))
        if motion is None:
            continue
        multiplier = np.exp(motion.rate * period)
        if lost[n] or abs(multiplier - value[n]) <= AGREES * error[n]:
            found.rate[n] = motion.rate
            found.error[n] = min(AGREES * motion.error * period * abs(multiplier), error[n])
            k = len(system.eigenvalue)
            state = np.concatenate([motion.start[:k] * scales(system), motion.start[k:]])
            found.share[n] = _shares(state[:, None])[0]
            found.harmonics = max(found.harmonics, motion.harmonics)
    # the rates of all motions add up to the trace of the damping
    off_trace = abs(float(found.rate.real.sum() + np.trace(system.damping)))
    if lost.any() and not off_trace * period <= TRACE * max(
        float(np.trace(system.damping)) * period, 1.0
    ):
        with np.errstate(divide="ignore"):
            found.rate[lost] = np.log(value[lost].astype(complex)) / period
        found.error[lost] = error[lost]
    return found


def _shares(state: Complex) -> Real:
    """Return the share of each mode in the energy of states, columns."""
    part = np.abs(state[: len(state) // 2]) ** 2 + np.abs(state[len(state) // 2 :]) ** 2
    return np.asarray((part / part.sum(axis=0)).T)


def checked_modes(model: Compiled, modes: int | None) -> int | None:
    """Return how many modes are asked for."""
    if modes is not None:
        return check.count(modes, "modes", most=MOST_MODES)
    if model.element == "continuous":
        raise SceneError("modes must be a number for continuous spans, which have no last one")
    finite = [model.chain.only(component).finite for component in transverse(model)]
    if None in finite or sum(one or 0 for one in finite) > MOST_MODES:
        raise SceneError(f"modes must be a number for models with more than {MOST_MODES} of them")
    return None


def converged(system: ModalSystem, frequency: float, amplitude: float) -> tuple[Real, float, int]:
    """Return motion over a period, its error, and the steps that were enough."""

    def with_steps(count: int) -> Real:
        given = np.array([frequency]), np.array([[amplitude]])
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(finite(monodromy(system, *given, count))[0, 0])

    steps = steps_for(system, frequency, amplitude, FINE)
    matrix, change = with_steps(steps), np.inf
    while True:
        steps *= 2
        before, old = change, matrix
        matrix = with_steps(steps)
        size = np.abs(matrix).max()
        change = float(np.abs(matrix - old).max() / size)
        # where halving gains nothing rounding is what is left
        if change <= CONVERGED or change > before / 4:
            return matrix, size * max(change, EPS * np.sqrt(steps)), steps


def _errors(matrix: Real, off: float, right: Complex) -> Real:
    """Return errors of eigenvalues for one of the matrix: by their condition, at most by a root."""
    # two that meet part as the root of a change
    with np.errstate(all="ignore"):
        try:
            left = np.linalg.inv(right)
        except np.linalg.LinAlgError:
            left = np.full_like(right, np.inf)
        condition = np.linalg.norm(left, axis=1) * np.linalg.norm(right, axis=0)
    whole = off * len(matrix)
    root = np.sqrt(whole * np.abs(matrix).max())
    return np.fmin(whole * condition, root)
