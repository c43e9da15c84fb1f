"""Numbers of a scene that are sought, and the variables they are sought by."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...base import check
from ...base.array import Flags, Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...scene.path import value_at, with_values
from ...scene.scene import Scene

CALIBRATION = (
    "calibration"  # Path of the factor on a calculated response that makes it the measured one.
)

_PLACE = re.compile(r"parts\[\d+\]\.(x|start|stop)")
_ANGLE = "gravity.inclination"


@dataclass(frozen=True, eq=False)
class Unknowns:
    """What is sought.

    A number keeps its sign: u = ln(p/p_0), p_0 its start. Only positions, by the length of the
    rope, and the inclination may pass 0: u = (p - p_0)/scale.
    """

    scene: Scene  # with the starts
    paths: tuple[str, ...]  # of the p numbers
    start: Real  # (p,) [of each number]
    scale: Real  # (p,) 0 where u is a logarithm

    @classmethod
    def of(cls, scene: Scene, unknown: str | Sequence[str]) -> Unknowns:
        """Check paths and read their starts."""
        what = 'paths such as ["tension", "bending_stiffness"]'
        if isinstance(unknown, str):
            unknown = [unknown]
        check.instance(unknown, "unknown", (list, tuple, np.ndarray), what)
        paths = tuple(check.instance(p, f"unknown[{i}]", str, what) for i, p in enumerate(unknown))
        if not paths or len(set(paths)) < len(paths):
            raise SceneError(f"unknown must be different {what}, got {check.shown(unknown)}")
        start = np.array([_start(scene, path, i) for i, path in enumerate(paths)])
        length = scene.rope.length
        scale = np.array([length if _PLACE.fullmatch(p) else float(p == _ANGLE) for p in paths])
        for i, path in enumerate(paths):
            if start[i] == 0 and scale[i] == 0:
                raise SceneError(
                    f"unknown[{i}] must not start at 0, from where no factor leads on: give the "
                    f"scene a guess of {path}"
                )
        return cls(scene, paths, start, scale)

    def __len__(self) -> int:
        return len(self.paths)

    @property
    def by_factor(self) -> Flags:
        """Which are sought by their logarithms, shape (p,)."""
        return self.scale == 0

    @computed
    def all_by_factor(self) -> bool:
        """Whether all are."""
        return bool(self.by_factor.all())

    def value(self, u: Real) -> Real:
        """Return the numbers, shape (..., p)."""
        if self.all_by_factor:
            return self.start * np.exp(u)
        return self.start * np.exp(np.where(self.by_factor, u, 0.0)) + self.scale * u

    def slope(self, u: Real) -> Real:
        """Return dp/du, shape (..., p)."""
        return (
            self.value(u)
            if self.all_by_factor
            else np.where(self.by_factor, self.value(u), self.scale)
        )

    def bound(self, u: Real) -> Real:
        """Return the numbers at bounds of u, infinite ones too, shape (..., p, bounds)."""
        start, scale = self.start[:, None], self.scale[:, None]
        inside = np.where(np.isinf(u), 0.0, u)
        value = start * np.exp(np.where(scale == 0, inside, 0.0)) + scale * inside
        return np.where(np.isinf(u), np.sign(start) * np.where(u < 0, 0.0, np.inf), value)

    @property
    def widest(self) -> Real:
        """Bounds that exclude nothing, shape (p, 2)."""
        least = np.where(self.by_factor & (self.start > 0), 0.0, -np.inf)
        most = np.where(self.by_factor & (self.start < 0), 0.0, np.inf)
        return np.column_stack([least, most])

    def at(self, u: Real) -> Scene:
        """Return the scene with these numbers."""
        values = dict(zip(self.paths, self.value(u).tolist()))
        values.pop(CALIBRATION, None)
        return with_values(self.scene, values)

    def with_calibration(self, start: float) -> Unknowns:
        """Return the same with a start of the factor of the calibration, the last one."""
        others = self.only(np.array([path != CALIBRATION for path in self.paths]))
        return replace(
            others,
            paths=(*others.paths, CALIBRATION),
            start=np.append(others.start, start),
            scale=np.append(others.scale, 0.0),
        )

    def calibration(self, u: Real) -> float:
        """Return the factor of the calibration, 1 where it is not sought."""
        if CALIBRATION not in self.paths:
            return 1.0
        return float(self.value(u)[self.paths.index(CALIBRATION)])

    def only(self, wanted: Flags) -> Unknowns:
        """Return some of them, chosen by shape (p,)."""
        paths = tuple(path for path, one in zip(self.paths, wanted) if one)
        return replace(self, paths=paths, start=self.start[wanted], scale=self.scale[wanted])


def _start(scene: Scene, path: str, i: int) -> float:
    try:
        return value_at(scene, path)
    except SceneError as error:
        raise SceneError(f"unknown[{i}]: {error}") from error
