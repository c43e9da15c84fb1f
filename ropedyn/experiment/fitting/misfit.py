"""What least squares make small: what was measured and what was known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from ...base.array import Complex, Flags, Index, Real
from ...base.errors import RopedynError, SceneError, SolveError
from ...curves.measured import Measured
from ...model import Model
from ...response.frf import FRF
from ...scene.bench.prior import LOG_NORMAL, Prior
from .natural_frequencies import NaturalFrequencies
from .unknown import CALIBRATION, Unknowns


class Misfit(Protocol):
    """Differences of many rows, each of a scene, from what was measured."""

    def __call__(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return residuals (n, m) of some rows at u, (n, p), and their slopes (n, m, p); or NaN."""

    def refusal(self, row: int, u: Real) -> RopedynError:
        """Say why a row has none at u, shape (p,)."""


@dataclass(frozen=True, eq=False)
class PriorMisfit:
    """What is known beforehand of some of the numbers."""

    unknowns: Unknowns  # what is sought
    at: Index  # (q,) which of it
    prior: Prior  # of q numbers

    @classmethod
    def of(cls, unknowns: Unknowns, prior: Mapping[str, tuple[float, float]]) -> PriorMisfit | None:
        """Return what is known of these unknowns, if anything is."""
        known = [path for path in prior if path in unknowns.at_place]
        if not known:
            return None
        whole = prior if isinstance(prior, Prior) else Prior(prior)
        at = np.array([unknowns.at_place[path] for path in known], dtype=np.intp)
        for path, i in zip(known, at.tolist()):
            if whole.distribution[path] == LOG_NORMAL and unknowns.start[i] < 0:
                raise SceneError(
                    f"prior[{path!r}] must be of the sign of the scene's guess, which is kept: "
                    f"{unknowns.start[i]:g}, got a log-normal one of {whole[path]}"
                )
        return cls(unknowns, at, whole.marginal(known))

    def of_rows(self, u: Real) -> tuple[Real, Real]:
        """Return independent residuals of variance 1, (n, q), and their slopes (n, q, p)."""
        residual, by_number = self.prior.residual(self.unknowns.value(u)[:, self.at])
        slope = by_number * self.unknowns.slope(u)[:, None, self.at]
        of_number = self.at[:, None] == np.arange(u.shape[1])
        return residual, slope @ of_number.astype(np.float64)


def unseen_of(slope: Real, known: PriorMisfit | None) -> Flags:
    """Return which numbers change no residual and are not known beforehand, shape (n, p)."""
    unseen = np.asarray(~slope.any(axis=1))
    if known is not None:
        unseen[:, known.at] = False
    return unseen


@dataclass(frozen=True, eq=False)
class JointMisfit:
    """What was measured and what was known, the last in units of the noise of the first."""

    measured: Misfit
    known: PriorMisfit
    noise: Real  # of each row

    def __call__(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return the residuals of both and their slopes."""
        return self.joined(rows, u, *self.measured(rows, u))

    def joined(self, rows: Index, u: Real, residual: Real, slope: Real) -> tuple[Real, Real]:
        """Return the same with what was known, where residuals have been computed."""
        noise = self.noise[rows, None]
        more, of_more = self.known.of_rows(u)
        return (
            np.concatenate([residual, noise * more], axis=1),
            np.concatenate([slope, noise[:, :, None] * of_more], axis=1),
        )

    def refusal(self, row: int, u: Real) -> RopedynError:
        """Say why a row has none."""
        return self.measured.refusal(row, u)


@dataclass(frozen=True, eq=False)
class PeakMisfit:
    """Differences of natural frequencies from the measured peaks of many ropes."""

    calculated: NaturalFrequencies  # the frequencies
    measured: Real  # (n, k) [Hz]
    weight: Real  # (n, k) by which differences are divided [Hz]
    orders: Index  # (n, k) from 1; 0 of a peak that is no mode, whose difference is 0

    def __call__(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return the residuals of some ropes and their slopes."""
        frequency, slope = self.of_peaks(rows, u)
        weight, used = self.weight[rows], self.orders[rows] > 0
        residual, slope = (frequency - self.measured[rows]) / weight, slope / weight[:, :, None]
        if used.all():
            return residual, slope
        return np.where(used, residual, 0.0), np.where(used[:, :, None], slope, 0.0)

    def of_peaks(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return the calculated frequency of each peak [Hz] and its slope; any where it is none."""
        orders = self.orders[rows]
        most = int(orders.max(initial=1))
        frequency, slope = self.calculated(u, most)
        if orders.shape[1] == most and (orders == np.arange(1, most + 1)).all():
            return frequency, slope
        at = np.maximum(orders - 1, 0)
        return np.take_along_axis(frequency, at, 1), np.take_along_axis(slope, at[:, :, None], 1)

    def refusal(self, row: int, u: Real) -> RopedynError:
        """Say why a rope has none."""
        return self.calculated.refusal(u, int(self.orders[row].max()))


@dataclass(frozen=True, eq=False)
class Response:
    """The response of a scene with unknown numbers, where and as it was measured."""

    unknowns: Unknowns  # what is sought; the factor of the calibration may be among it
    measured: Measured
    elements: int | None = None  # as `Scene.compile` takes them
    element: str | None = None  # as `Scene.compile` takes them
    _last: dict[bytes, tuple[Complex, Complex]] = field(
        default_factory=dict, init=False, repr=False
    )

    def __call__(self, u: Real) -> tuple[Complex, Complex]:
        """Compute the response and its slopes."""
        key = u.tobytes()
        if key not in self._last:
            answer = self._solve(u)
            self._last.clear()
            self._last[key] = answer
        return self._last[key]

    def model(self, u: Real) -> Model:
        """Compile the scene with these numbers."""
        return self.unknowns.at(u).compile(elements=self.elements, element=self.element)

    def _solve(self, u: Real) -> tuple[Complex, Complex]:
        measured, unknowns = self.measured, self.unknowns
        frf = self.model(u).frf(
            measured.frequency,
            drive=measured.drive[0],
            response=list(measured.response),
            quantity=measured.quantity,
            decay=measured.decay,
        )
        factor = unknowns.calibration(u)
        slope = [
            frf.value if path == CALIBRATION else factor * _derivative(frf, path, i)
            for path, i in unknowns.at_place.items()
        ]
        by_number = unknowns.of_numbers(np.stack(slope, axis=-1))
        return factor * frf.value, by_number * unknowns.slope(u)


def _derivative(frf: FRF, path: str, i: int) -> Complex:
    try:
        return frf.derivative(path)
    except SceneError as error:
        raise SceneError(f"unknown[{i}] must change the response: {error}") from error


@dataclass(frozen=True, eq=False)
class LogMisfit:
    """Logarithms of amplitude ratios, with wide valleys, and phases as exp(i phi): no jumps."""

    response: Response

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals (3 m,) and their slopes (3 m, p), m lines that are not 0."""
        value, slope = self.response(u)
        kept = (self.response.measured.value != 0) & (value != 0)
        ratio = value[kept] / self.response.measured.value[kept]
        relative = slope[kept] / value[kept][:, None]
        turn = ratio / np.abs(ratio)
        turns = 1j * turn[:, None] * relative.imag
        off = np.concatenate([np.log(np.abs(ratio)), turn.real - 1, turn.imag])
        return off, np.concatenate([relative.real, turns.real, turns.imag])


@dataclass(frozen=True, eq=False)
class LineMisfit:
    """Differences of the responses over the noise of each line, real and imaginary parts."""

    response: Response
    std: Real  # (responses, f) of either part; infinite where a line says nothing

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals (2 m,) and their slopes (2 m, p)."""
        value, slope = self.response(u)
        off = ((value - self.response.measured.value) / self.std).ravel()
        by_u = (slope / self.std[..., None]).reshape(off.size, -1)
        return np.concatenate([off.real, off.imag]), np.concatenate([by_u.real, by_u.imag])


@dataclass(frozen=True, eq=False)
class OneByOne:
    """Rows whose residuals are computed one after the other."""

    function: Callable[[Real], tuple[Real, Real]]  # of u, shape (p,)

    def __call__(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return the residuals and their slopes."""
        residual, slope = zip(*map(self._answer, u))
        m = max(map(len, residual))
        return (
            np.stack([np.broadcast_to(one, m) for one in residual]),
            np.stack([np.broadcast_to(one, (m, u.shape[1])) for one in slope]),
        )

    def _answer(self, u: Real) -> tuple[Real, Real]:
        try:
            return self.function(u)
        except (SceneError, SolveError):
            return np.full(1, np.nan), np.full((1, len(u)), np.nan)

    def refusal(self, row: int, u: Real) -> RopedynError:
        """Say why there are none."""
        try:
            self.function(u)
        except (SceneError, SolveError) as error:
            return error
        return SolveError(f"residuals must be finite, they are not at {u.tolist()}")
