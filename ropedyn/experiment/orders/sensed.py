"""What sensors see of the modes of a scene: how visible each is, and its shape there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError
from ...scene.parts.part import PointMass
from ...scene.scene import Scene

FAINT = 0.02  # Of a mode at whose nodes all sensors are, so much of it is seen.
NODE = 0.08  # A sensor sees a mode where it moves by more than this share of its largest.
ANGLE = 0.06  # [rad] between a measured shape and that of its mode, sensors away from the ends.
AWAY = 0.15  # Sensors so many lengths from an end tell shapes, whatever holds it.
FALSE = 0.01  # A measured shape is anything with this probability.
WAVE = 6  # Elements of the chain to a half wave at least.


@dataclass(frozen=True, eq=False)
class Sensed:
    """Modes 1 .. N at sensors."""

    shape: Real  # (N, channels), of the largest deflection of each
    away: Flags  # (channels,) which tell shapes

    @classmethod
    def of(cls, scene: Scene, sensors: Sequence[tuple[str, float]], count: int) -> Sensed:
        """Calculate them with the numbers of the scene."""
        length = scene.rope.length
        marks = tuple(PointMass(x, 0.0) for x in sorted({x for _, x in sensors if 0 < x < length}))
        marked = scene.replace(parts=(*scene.parts, *marks))
        modes = marked.compile(elements=WAVE * count).modes(count)
        largest = np.abs(modes.shape).max(axis=1)
        columns = []
        for coordinate, x in sensors:
            c, node = modes.coordinates.index(coordinate), np.abs(modes.x - x).argmin()
            size = np.where(largest[:, c] > 0, largest[:, c], 1.0)
            columns.append(modes.shape[:, node, c] / size)
        place = np.array([x for _, x in sensors]) / length
        return cls(np.stack(columns, axis=1), (place >= AWAY) & (place <= 1 - AWAY))

    @property
    def visible(self) -> Real:
        """How visible each mode is, (N,)."""
        most = np.abs(self.shape).max(axis=1)
        return FAINT + (1 - FAINT) * -np.expm1(-((most / NODE) ** 2))

    def likeness(self, measured: Real) -> Real:
        """Return ln of how much likelier shapes, (k, channels), are of modes than of none, (k, N).

        Of C channels an angle a has the density exp(-sin^2 a/2 s^2)/(2 pi s^2)^((C - 1)/2) on half
        the sphere, whose area is pi^(C/2)/Gamma(C/2).
        """
        from scipy.special import gammaln

        channels = int(self.away.sum())
        if channels < 2:
            return np.zeros((len(measured), len(self.shape)))
        one, other = _unit(measured[:, self.away]), _unit(self.shape[:, self.away])
        square = 1 - np.minimum(np.abs(one.conj() @ other.T) ** 2, 1.0)
        area = channels / 2 * np.log(np.pi) - gammaln(channels / 2)
        density = -(channels - 1) / 2 * np.log(2 * np.pi * ANGLE**2) - square / (2 * ANGLE**2)
        return np.logaddexp(np.log1p(-FALSE) + density + area, np.log(FALSE))


def refuse_outside(scene: Scene, sensors: Sequence[tuple[str, float]]) -> None:
    """Refuse sensors that are not on the rope."""
    length = scene.rope.length
    for i, (coordinate, x) in enumerate(sensors):
        if coordinate not in scene.coordinates or not 0 <= x <= length:
            raise SceneError(
                f"sensors[{i}] must be a coordinate of {', '.join(scene.coordinates)} and a "
                f"place from 0 to {length:g} m, got {(coordinate, x)!r}"
            )


def _unit(rows: Real) -> Real:
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return rows / np.where(size > 0, size, 1.0)
