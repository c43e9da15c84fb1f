"""Numbers of a scene that are sought, and the variables they are sought by."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from ...base import check
from ...base.array import Complex, Flags, Index, Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...scene.path import unit_of, value_at, with_values
from ...scene.scene import Scene

CALIBRATION = (
    "calibration"  # Path of the factor on a calculated response that makes it the measured one.
)

_PLACE = re.compile(r"parts\[\d+\]\.(x|start|stop)")
_ANGLE = "gravity.inclination"
Slopes = TypeVar("Slopes", Real, Complex)

_WHAT = 'paths such as ["tension", "bending_stiffness"]'
TIE = " = "  # Between the places of one number in its name.


@dataclass(frozen=True, eq=False)
class Unknowns:
    """What is sought.

    A number keeps its sign: u = ln(p/p_0), p_0 its start. Only positions, by the length of the
    rope, and the inclination may pass 0: u = (p - p_0)/scale. A number may stand at several places,
    which are tied; it starts from what the first of them has.
    """

    scene: Scene  # with the starts
    paths: tuple[str, ...]  # of the p numbers, "a = b" of one that stands at a and at b
    places: tuple[tuple[str, ...], ...]  # (p,) where each stands
    start: Real  # (p,) [of each number]
    scale: Real  # (p,) 0 where u is a logarithm
    hidden: int = 0  # so many, the last, are not asked for but known with an uncertainty

    @classmethod
    def of(cls, scene: Scene, unknown: str | Sequence[str | Sequence[str]]) -> Unknowns:
        """Check paths and read their starts; several together, or "a = b", are one number."""
        if isinstance(unknown, str):
            unknown = [unknown]
        check.instance(unknown, "unknown", (list, tuple, np.ndarray), _WHAT)
        places = tuple(_places(one, i) for i, one in enumerate(unknown))
        every = [path for some in places for path in some]
        if not every or len(set(every)) < len(every):
            raise SceneError(f"unknown must be different {_WHAT}, got {check.shown(unknown)}")
        start = np.array([_start(scene, some, i) for i, some in enumerate(places)])
        # what changes of a number that may pass 0 are measured by, 0 of others
        first, length = [some[0] for some in places], scene.rope.length
        scale = np.array([length if _PLACE.fullmatch(p) else float(p == _ANGLE) for p in first])
        paths = tuple(map(TIE.join, places))
        for i, path in enumerate(paths):
            if start[i] == 0 and scale[i] == 0:
                raise SceneError(
                    f"unknown[{i}] must not start at 0, from where no factor leads on: give the "
                    f"scene a guess of {path}"
                )
        return cls(scene, paths, places, start, scale)

    def with_nuisances(self, paths: Iterable[str]) -> Unknowns:
        """Return the same with numbers of a prior that are not among it, hidden ones."""
        others = [path for path in paths if path not in self.at_place]
        if not others:
            return self
        for path in others:
            _refuse_nuisance(self.scene, path)
        more = Unknowns.of(self.scene, others)
        return Unknowns(
            self.scene,
            (*self.paths, *more.paths),
            (*self.places, *more.places),
            np.concatenate([self.start, more.start]),
            np.concatenate([self.scale, more.scale]),
            self.hidden + len(more),
        )

    def __len__(self) -> int:
        return len(self.paths)

    @property
    def shown(self) -> int:
        """How many are asked for, the first."""
        return len(self) - self.hidden

    @computed
    def at_place(self) -> dict[str, int]:
        """Which number stands at each place."""
        return {path: i for i, some in enumerate(self.places) for path in some}

    @property
    def tied(self) -> bool:
        """Whether a number stands at several places."""
        return len(self.at_place) > len(self)

    @computed
    def _number(self) -> Index:
        return np.fromiter(self.at_place.values(), dtype=np.intp)

    def at_places(self, value: Real) -> Real:
        """Return what stands at each place, (..., m), of the numbers, (..., p)."""
        return value[..., self._number] if self.tied else value

    def of_numbers(self, slope: Slopes) -> Slopes:
        """Return slopes by the numbers, (..., p), of those by what stands at places, (..., m)."""
        if not self.tied:
            return slope
        number = self._number[:, None] == np.arange(len(self))
        return slope @ number.astype(slope.dtype)

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
        values = dict(zip(self.at_place, self.at_places(self.value(u)).tolist()))
        values.pop(CALIBRATION, None)
        return with_values(self.scene, values)

    def with_calibration(self, start: float) -> Unknowns:
        """Return the same with a start of the factor of the calibration, the last one."""
        others = self.only(np.array([path != CALIBRATION for path in self.paths]))
        return replace(
            others,
            paths=(*others.paths, CALIBRATION),
            places=(*others.places, (CALIBRATION,)),
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
        at = np.flatnonzero(wanted)
        return replace(
            self,
            paths=tuple(self.paths[i] for i in at),
            places=tuple(self.places[i] for i in at),
            start=self.start[at],
            scale=self.scale[at],
            hidden=int((at >= self.shown).sum()),
        )


def _places(one: Any, i: int) -> tuple[str, ...]:
    """Return where a number stands, of a path, of several, or of several in one name."""
    if isinstance(one, str):
        places = tuple(path.strip() for path in one.split("="))
    else:
        check.instance(one, f"unknown[{i}]", tuple, f"{_WHAT}, or a tuple of tied ones")
        places = tuple(
            check.instance(p, f"unknown[{i}][{k}]", str, _WHAT) for k, p in enumerate(one)
        )
    units = [unit_of(path) for path in places]
    if len(set(units)) > 1 or any(
        _may_pass_zero(path) != _may_pass_zero(places[0]) for path in places
    ):
        raise SceneError(
            f"unknown[{i}] must tie numbers of one kind and unit, got "
            + " and ".join(f"{path} [{unit or '1'}]" for path, unit in zip(places, units))
        )
    return places


def _refuse_nuisance(scene: Scene, path: str) -> None:
    """Refuse what is known of a number that there is not, by its name in the prior."""
    try:
        Unknowns.of(scene, path)
    except SceneError as error:
        raise SceneError(str(error).replace("unknown[0]", f"prior[{path!r}]")) from error


def _may_pass_zero(path: str) -> bool:
    """Whether a number may pass 0."""
    return path == _ANGLE or _PLACE.fullmatch(path) is not None


def _start(scene: Scene, places: tuple[str, ...], i: int) -> float:
    """Return what a scene has at the first of several places; it must have something at each."""
    try:
        first, *_ = [value_at(scene, path) for path in places]
    except SceneError as error:
        raise SceneError(f"unknown[{i}]: {error}") from error
    return first
