"""What a model, modes or a frequency response say about frequencies, for a comparison."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...base import check
from ...base.array import Complex, Flags, Index, Real
from ...base.check import COORDINATES, NEAR
from ...base.errors import SceneError, SolveError
from ...chain.port import Point
from ...eigen.eigen import solve_modes
from ...eigen.modes import Modes
from ...eigen.sensitivity import Sensitivity
from ...eigen.vectors import shapes_at
from ...model import Model
from ...response.frf import FRF
from ...scene.agree import in_space
from ...signal.likeness import residues
from ...space.model import SpaceModel
from ..fitting.natural import natural_of
from .measured import peaks_in

UNSEEN = 1e-9  # Smaller products of a shape at drive and response are rounding at a node.


@dataclass(frozen=True, eq=False)
class CalculatedPeaks:
    """Calculated frequencies."""

    frequency: Real  # (m,) natural, |s|/2 pi where damped modes are known [Hz], each > 0
    error: Real  # (m,) of modes by mesh and rounding, of peaks that of the fit to them [Hz]
    damping_ratio: Real  # (m,) NaN where nothing damps
    number: Index  # (m,) which of `modes` each is, from 0
    modes: Modes | None = None  # rigid motion and growth among them
    frf: FRF | None = None  # that shows the peaks
    notes: tuple[str, ...] = ()  # what a reader must know of them

    @property
    def has_shapes(self) -> bool:
        """Whether shapes can be asked for: modes from a file have no model."""
        return self.modes is None or self.modes.solve_shapes is not None

    @property
    def is_followed(self) -> bool:
        """Whether modes can be followed while a number changes: on an axis they are not."""
        modes = self.modes if self.has_shapes else None
        return modes is not None and isinstance(modes.sensitivity, Sensitivity)

    def checked(self, points: Any, name: str) -> tuple[Point, ...]:
        """Return points that the rope has, each a coordinate at a position."""
        check.instance(points, name, (list, tuple), 'points such as [("z", 0.2), ("z", 0.5)]')
        coordinates: tuple[str, ...] = COORDINATES
        length = None
        if self.modes is not None:
            coordinates, length = self.modes.coordinates, float(self.modes.x[-1])
        return tuple(
            check.point(point, f"{name}[{k}]", coordinates, length)
            for k, point in enumerate(points)
        )

    def shapes(self, points: tuple[Point, ...], drive: int) -> Complex | Real | None:
        """Return the shapes at points, shape (m, points), or None where they are not known."""
        if self.modes is not None:
            return shapes_at(self.modes, points)[self.number]
        assert self.frf is not None
        which = [index(self.frf.response, point) for point in points]
        if None in which:
            return None
        value = np.stack([self.frf.curve(r, drive) for r in which if r is not None])
        order = np.argsort(self.frf.frequency)
        order = order[self.frf.frequency[order] > 0]
        return residues(
            self.frf.frequency[order],
            value[:, order],
            self.frf.quantity,
            self.frequency,
            self.damping_ratio,
            decay=self.frf.decay,
        )

    def visible(self, drive: Point, response: tuple[Point, ...]) -> Flags:
        """Return which frequencies a drive can show in at least one response."""
        if self.modes is None or not self.has_shapes or not all(map(is_motion, response)):
            return np.ones(len(self.frequency), dtype=np.bool_)
        response = self.checked(response, "measured.response")
        drives = self.checked([drive], "measured.drive") if is_motion(drive) else ()
        shape = np.abs(shapes_at(self.modes, (*drives, *response))[self.number])
        moved = shape[:, len(drives) :].max(axis=1)
        return np.asarray(moved * shape[:, 0] > UNSEEN if drives else moved > UNSEEN)


def is_motion(point: tuple[object, ...]) -> bool:
    """Whether a point is a coordinate at a position, and no force, wire or end that is moved."""
    return point[0] in COORDINATES


def index(points: tuple[Point, ...], wanted: Point) -> int | None:
    """Return which of the points is where the wanted one is."""
    for k, point in enumerate(points):
        if point == wanted:
            return k
        if is_motion(point) and point[0] == wanted[0]:
            x, y = point[1], wanted[1]
            if abs(x - y) <= NEAR * max(abs(x), abs(y)):
                return k
    return None


def calculated_peaks(
    given: Model | SpaceModel | Modes | FRF, highest: float, more: int, least: int, drive: int
) -> CalculatedPeaks:
    """Return the calculated frequencies that measured ones may be."""
    if isinstance(given, FRF):
        found = _of_frf(given, drive)
    elif isinstance(given, (Model, SpaceModel)):
        found = _with_damping(given, undamped_peaks(given, highest, more, least))
    else:
        found = _of_modes(given)
    if len(found.frequency) == 0:
        raise SceneError("calculated must have at least one peak, got none")
    return found


MOST = 5000
"""Modes that a comparison looks at."""


def undamped_peaks(
    model: Model | SpaceModel, highest: float, more: int, least: int = 0
) -> CalculatedPeaks:
    """Return the natural frequencies up to the highest measured one, and some more."""
    below = model.count(below=highest)
    if below > MOST:
        raise SceneError(
            f"measured must be of at most {MOST} modes, got a peak at {highest:.6g} Hz, below "
            f"which the scene has {below}: leave it out"
        )
    number = max(below + more, least) + len(model.coordinates) + 1
    if isinstance(model, SpaceModel) or model.scene.sags:
        return _of_modes(model.modes(number))
    return _of_modes(solve_modes(model, number, below=None, solver="sweep", strict=False))


def _of_modes(modes: Modes) -> CalculatedPeaks:
    number = np.flatnonzero(modes.frequency > 0)
    ratio = modes.damping_ratio[number]
    return CalculatedPeaks(
        frequency=modes.frequency[number],
        error=(modes.mesh_error + modes.rounding_bound)[number],
        damping_ratio=ratio if ratio.any() else np.full(len(ratio), np.nan),
        number=number,
        modes=modes,
    )


def _with_damping(model: Model | SpaceModel, found: CalculatedPeaks) -> CalculatedPeaks:
    """Return natural frequencies and damping ratios of the damped modes, in their order."""
    modes = found.modes
    if modes is None or not modes.damping_ratio.any():
        return found
    try:
        if isinstance(model, SpaceModel):
            raise SolveError(f"complex modes are not carried for {in_space(model.scene)}")
        natural = natural_of(model, modes)
    except SolveError as refusal:
        return replace(found, notes=(f"undamped frequencies are compared: {refusal}",))
    frequency = natural.frequency[found.number]
    rising = np.argsort(frequency, kind="stable")
    number = found.number[rising]
    return replace(
        found,
        frequency=frequency[rising],
        error=(modes.mesh_error + natural.rounding_error)[number],
        damping_ratio=natural.damping_ratio[number],
        number=number,
    )


def _of_frf(frf: FRF, drive: int) -> CalculatedPeaks:
    if frf.power != 1:
        raise SceneError("calculated must be a response at the frequency, got harmonic 2")
    peaks = peaks_in(frf if len(frf.drive) == 1 else frf.peaks(drive))
    return CalculatedPeaks(
        frequency=peaks.frequency,
        error=peaks.std,
        damping_ratio=peaks.damping_ratio,
        number=np.arange(len(peaks.frequency)),
        frf=frf,
    )
