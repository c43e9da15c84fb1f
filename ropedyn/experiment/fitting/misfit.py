"""What least squares make small: what was measured and what was known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.errors import SceneError, SolveError
from ...curves.measured import Measured
from ...model import Model
from ...response.frf import FRF
from .natural_frequencies import NaturalFrequencies
from .unknown import CALIBRATION, Unknowns

# Takes variables u, shape (p,); returns residuals (m,) and their slopes (m, p).
Misfit = Callable[[Real], tuple[Real, Real]]


@dataclass(frozen=True, eq=False)
class PriorMisfit:
    """What is known beforehand: values and their standard deviations."""

    unknowns: Unknowns  # what is sought
    at: Index  # (q,) which of it
    value: Real  # (q,)
    std: Real  # (q,)

    @classmethod
    def of(cls, unknowns: Unknowns, prior: Mapping[str, tuple[float, float]]) -> PriorMisfit | None:
        """Return what is known of these unknowns, if anything is."""
        at = [i for i, path in enumerate(unknowns.paths) if path in prior]
        if not at:
            return None
        value, std = zip(*(prior[unknowns.paths[i]] for i in at))
        return cls(unknowns, np.array(at, dtype=np.intp), np.array(value), np.array(std))

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return (p - value)/std and its slopes."""
        residual = (self.unknowns.value(u)[self.at] - self.value) / self.std
        slope = np.zeros((len(self.at), len(u)))
        slope[np.arange(len(self.at)), self.at] = self.unknowns.slope(u)[self.at] / self.std
        return residual, slope


def unseen_of(slope: Real, known: PriorMisfit | None) -> Index:
    """Return which numbers change no residual and are not known beforehand."""
    unseen = np.asarray(~slope.any(axis=0))
    if known is not None:
        unseen[known.at] = False
    return np.flatnonzero(unseen)


@dataclass(frozen=True, eq=False)
class JointMisfit:
    """What was measured and what was known, the last in units of the noise of the first."""

    measured: Misfit
    known: PriorMisfit
    noise: float

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals of both and their slopes."""
        (first, of_first), (second, of_second) = self.measured(u), self.known(u)
        return (
            np.concatenate([first, self.noise * second]),
            np.concatenate([of_first, self.noise * of_second]),
        )


@dataclass(frozen=True, eq=False)
class PeakMisfit:
    """Differences of natural frequencies from measured peaks."""

    calculated: NaturalFrequencies  # the frequencies
    measured: Real  # (k,) [Hz]
    weight: Real  # (k,) by which differences are divided [Hz]
    orders: Index  # (k,) from 1; 0 of a peak that is no mode, whose difference is 0

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals and their slopes."""
        frequency, slope = self.of_peaks(u)
        used = self.orders > 0
        residual = np.where(used, (frequency - self.measured) / self.weight, 0.0)
        return residual, np.where(used, slope.T / self.weight, 0.0).T

    def of_peaks(self, u: Real) -> tuple[Real, Real]:
        """Return the calculated frequency of each peak [Hz] and its slope; any where it is none."""
        most = int(self.orders.max())
        frequency, slope = self.calculated(u, most)
        if len(frequency) < most:
            raise SolveError(
                f"the scene must have {most} modes for these orders, got {len(frequency)}"
            )
        return frequency[self.orders - 1], slope[self.orders - 1]


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
        )
        factor = unknowns.calibration(u)
        slope = [
            frf.value if path == CALIBRATION else factor * _derivative(frf, path, i)
            for i, path in enumerate(unknowns.paths)
        ]
        return factor * frf.value, np.stack(slope, axis=-1) * unknowns.slope(u)


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
