"""Differences of a calculated frequency response from a measured one, with their slopes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SceneError
from ...curves.measured import Measured
from ...model import Model
from ...response.frf import FRF
from .unknown import CALIBRATION, Unknowns


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
    """Logarithms of amplitude ratios, and how far phases are apart.

    A peak at a wrong place is off by its height in decades: a wide valley. Phases are compared by
    exp(i phi), which knows no jump of 2 pi.
    """

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
