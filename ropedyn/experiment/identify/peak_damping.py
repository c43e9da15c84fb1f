"""Find numbers of the damping of a scene from measured damping ratios of peaks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Integer, Real
from ...base.errors import SceneError, SolveError
from ...base.named import Named
from ...scene.agree import refuse_axis
from ...scene.damping import ModalDamping
from ...scene.scene import Scene
from ..fitting.minimum import Point
from ..fitting.misfit import OneByOne
from ..fitting.solution import Solution, Task
from ..fitting.unknown import Unknowns
from .known import checked_level, intervals
from .notes import Data, notes_of

STEP = 1e-4  # Of central differences in the logarithm of a number: off by a square of it.
ALIKE = 1e-5  # Numbers that act alike to this share are not told apart.
ROUNDED = 4 * np.finfo(float).eps  # Of a ratio, which is a part of an eigenvalue of size 1.
LIGHT = 0.05  # Up to this ratio damping is nearly linear in its numbers.
SMALL = 1e-3  # A number starts with no less than this part of what it was tried with.
MOST_TRIES = 40
MOST_ORDER = 10_000
RATIOS = Data("the damping ratios", "do", "tell")

OF_DAMPING = re.compile(r"damping(\[\d+\])?\..+|.*\.dashpot\..+|.*\.damping(_ratio)?")
_OF_MODES = re.compile(r"damping(?:\[(\d+)\])?\.ratio")


@dataclass(frozen=True, eq=False)
class PeakDamping:
    """What damping ratios of peaks say of the damping of a scene."""

    unknown: tuple[str, ...]  # paths; "damping.ratio[0]" is that of the first mode
    value: Named  # (p,)
    std: Named  # (p,) infinite where nothing tells it
    correlation: Real  # (p, p)
    freedom: float | None  # of Student's t, None where the std was given
    chi_square: float
    orders: Integer  # (k,) from 1; 0 of a peak that is no mode
    measured: Real  # (k,) damping ratios
    measured_std: Real  # (k,) as given, or estimated alike for all relative to the ratios
    calculated: Real  # (k,) NaN of a peak that is no mode
    notes: tuple[str, ...]  # what is not told, in words
    scene: Scene  # with these numbers
    solution: Solution

    def interval(self, level: float = 0.95, *, method: str = "profile") -> Named:
        """Return bounds (p, 2), as those of `identify`."""
        level = checked_level(level, method)
        return Named(intervals(self.solution, level, method)[0], self.unknown)


def beside(first: Real, second: Real) -> Real:
    """Return correlations of numbers that are told apart, (p, p) and (q, q)."""
    p, q = len(first), len(second)
    return np.block([[first, np.zeros((p, q))], [np.zeros((q, p)), second]])


def damping_of_peaks(
    scene: Scene,
    paths: str | Sequence[str],
    orders: ArrayLike,
    damping_ratio: ArrayLike,
    std: ArrayLike | None = None,
    *,
    elements: int | None = None,
    element: str | None = None,
) -> PeakDamping:
    """Fit damping to the ratios of modes, weighted by their std or all alike in proportion.

    The scene has the numbers that were found of its frequencies, and guesses of its damping. Of a
    `ModalDamping` with a ratio for each mode the path of these seeks one for each mode.
    """
    measured = check.numbers(damping_ratio, "damping_ratio")
    order, weight = _orders(orders, len(measured)), _weights(measured, std)
    model = _model(scene, paths, order, elements, element)
    p, used = len(model.unknowns), int((order > 0).sum())
    if used < p:
        raise SceneError(
            f"damping_ratio must have at least {p} values of modes for {p} unknown, got {used}"
        )
    misfit = _RatioMisfit(model, measured, weight, order > 0)
    u = model.start(measured, weight)
    start = Point(u[None], *(one[None] for one in misfit(u)))
    for i in np.flatnonzero(~start.slope[0].any(axis=0)):
        raise SceneError(
            f"unknown must change the damping ratios of these peaks, got "
            f"{model.unknowns.paths[i]!r}, which does not"
        )
    noise = np.full(1, np.nan if std is None else 1.0)
    task = Task(model.unknowns, OneByOne(misfit), len(measured), None, noise)
    solution, failed = task.solve(np.zeros(1, dtype=np.intp), start)
    if failed:
        raise failed[0]
    return _answer(solution, model, misfit)


def _answer(solution: Solution, model: _Model, misfit: _RatioMisfit) -> PeakDamping:
    residual = solution.record["residual"][0]
    freedom, paths = float(solution.record["freedom"][0]), model.unknowns.paths
    calculated = misfit.measured + residual * misfit.weight
    return PeakDamping(
        unknown=paths,
        value=Named(solution.value[0], paths),
        std=Named(solution.std[0], paths),
        correlation=solution.uncertainty.correlation[0],
        freedom=None if np.isnan(freedom) else freedom,
        chi_square=float(solution.off[0] / solution.nominal[0] ** 2),
        orders=model.orders,
        measured=misfit.measured,
        measured_std=solution.nominal[0] * misfit.weight,
        calculated=np.where(misfit.used, calculated, np.nan),
        notes=tuple(f"damping: {note}" for note in notes_of(solution, RATIOS)),
        scene=model.at(solution.u[0]),
        solution=solution,
    )


@dataclass(frozen=True, eq=False)
class _RatioMisfit:
    """Differences of damping ratios from the measured ones, over their weights."""

    model: _Model
    measured: Real  # (k,)
    weight: Real  # (k,)
    used: Any  # (k,) whether it is a mode

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals (k,) and their slopes (k, p), 0 of what is no mode."""
        off = (self.model.ratios(u) - self.measured) / self.weight
        ways = [self.model.ratios(u + way * h) for h in STEP * np.eye(len(u)) for way in (1, -1)]
        slope = (np.array(ways[::2]) - np.array(ways[1::2])).T / (2 * STEP * self.weight[:, None])
        noise = np.linalg.norm((ROUNDED / STEP / self.weight)[self.used])
        told = _told(np.where(self.used[:, None], slope, 0.0), float(noise))
        return np.where(self.used, off, 0.0), told


def _told(slope: Real, noise: float) -> Real:
    """Return slopes without directions in which numbers are alike but for their differences."""
    size = np.linalg.norm(slope, axis=0)
    size = np.where(size > 0, size, 1.0)
    of_rows, share, direction = np.linalg.svd(slope / size, full_matrices=False)
    # the slope of what damps next to nothing is the first to drown in rounding
    told = share > max(ALIKE * share[0], noise / float(size.min()))
    if told.all():
        return slope
    return np.asarray((of_rows * np.where(told, share, 0.0)) @ direction * size)


@dataclass(frozen=True, eq=False)
class _OfScene:
    """The exact ratios of damped modes."""

    unknowns: Unknowns
    orders: Integer
    elements: int | None
    element: str | None

    def at(self, u: Real) -> Scene:
        """Return the scene with these numbers."""
        return self.unknowns.at(u)

    def ratios(self, u: Real) -> Real:
        """Solve for the modes that oscillate, in their order."""
        model = self.at(u).compile(elements=self.elements, element=self.element)
        most = count = int(self.orders.max())
        while True:
            modes = model.modes(count, damped=True)
            ratio = modes.damping_ratio[modes.eigenvalue.imag > 0]
            if len(ratio) >= most:
                return np.asarray(ratio[np.maximum(self.orders - 1, 0)])
            count += most - len(ratio)

    def start(self, measured: Real, weight: Real) -> Real:
        """Fit what is linear where damping is light, with numbers >= 0."""
        from scipy.optimize import nnls

        p, used = len(self.unknowns), self.orders > 0
        size = self._light()
        small = size + np.log(SMALL)
        base = self.ratios(small)
        each = [self.ratios(np.where(np.arange(p) == i, size, small)) - base for i in range(p)]
        matrix = np.array(each).T / (1 - SMALL)
        rest = (measured - base + SMALL * matrix.sum(axis=1)) / weight
        share, _ = nnls(matrix[used] / weight[used, None], rest[used])
        return np.asarray(size + np.log(np.maximum(share, SMALL)))

    def _light(self) -> Real:
        """Return variables of numbers so small that the damping of these modes is light."""
        used, failure = self.orders > 0, None
        for u in -np.log(10.0) * np.arange(MOST_TRIES):
            size = np.full(len(self.unknowns), u)
            try:
                if self.ratios(size)[used].max() <= LIGHT:
                    return size
            except SolveError as error:  # so few oscillate
                failure = error
        raise failure or SceneError(
            f"scene must have modes damped by less than {LIGHT:g} without the unknown damping"
        )


@dataclass(frozen=True, eq=False)
class _OfModes:
    """Ratios of modes that each have their own."""

    scene: Scene
    at_damping: int  # which of the dampings it is
    unknowns: Unknowns
    orders: Integer

    def at(self, u: Real) -> Scene:
        """Return the scene with these numbers."""
        damping = list(self.scene.dampings)
        modal = damping[self.at_damping]
        assert isinstance(modal, ModalDamping)
        ratio = np.array(modal.ratio)
        ratio[self._modes - 1] = self.unknowns.value(u)
        damping[self.at_damping] = replace(modal, ratio=tuple(ratio.tolist()))
        return self.scene.replace(damping=tuple(damping))

    def ratios(self, u: Real) -> Real:
        """Take them."""
        at = np.searchsorted(self._modes, np.maximum(self.orders, self._modes[0]))
        return np.asarray(self.unknowns.value(u)[at])

    def start(self, measured: Real, weight: Real) -> Real:
        """Take the weighted mean of the peaks of each mode, where that is positive."""
        share = np.where(self.orders == self._modes[:, None], 1 / weight**2, 0.0)
        mean = share @ measured / share.sum(axis=1)
        return np.asarray(
            np.log(np.maximum(mean, SMALL * self.unknowns.start) / self.unknowns.start)
        )

    @property
    def _modes(self) -> Integer:
        return np.unique(self.orders[self.orders > 0])


_Model = _OfScene | _OfModes


def _model(
    scene: Scene,
    paths: str | Sequence[str],
    orders: Integer,
    elements: int | None,
    element: str | None,
) -> _Model:
    check.instance(scene, "scene", Scene, "a Scene")
    refuse_axis(scene, "damping by the widths of peaks")
    wanted = [paths] if isinstance(paths, str) else list(paths)
    for path in wanted:
        if isinstance(path, str) and OF_DAMPING.fullmatch(path) is None:
            raise SceneError(
                f'unknown must be paths of damping such as "damping.gamma", got {path!r}'
            )
    for path in wanted:
        at = _own_ratios(scene, path)
        if at is not None:
            if len(wanted) > 1:
                raise SceneError(
                    f"{path} must be sought alone where modes have ratios of their own"
                )
            return _OfModes(scene, at, _of_modes(scene, path, at, orders), orders)
    return _OfScene(Unknowns.of(scene, wanted), orders, elements, element)


def _own_ratios(scene: Scene, path: str) -> int | None:
    """Return which damping has a ratio for each mode, if this path is that of them."""
    found = _OF_MODES.fullmatch(path) if isinstance(path, str) else None
    at = 0 if found is None else int(found[1] or 0)
    if found is None or at >= len(scene.dampings) or (not found[1] and len(scene.dampings) > 1):
        return None
    damping = scene.dampings[at]
    own = isinstance(damping, ModalDamping) and isinstance(damping.ratio, tuple)
    return at if own else None


def _of_modes(scene: Scene, path: str, at: int, orders: Integer) -> Unknowns:
    """Return a number for each mode that has a peak, which starts from the mean of those given."""
    if len(scene.dampings) > 1:
        raise SceneError(
            "damping must not be modal damping beside another where its ratios are sought, got "
            f"{len(scene.dampings)} dampings"
        )
    ratio = np.array(scene.dampings[at].term().ratio)
    if orders.max() > len(ratio):
        raise SceneError(
            f"{path} must have a ratio for each mode, got {len(ratio)} and mode {orders.max()}"
        )
    modes = np.unique(orders[orders > 0])
    names = tuple(f"{path}[{n - 1}]" for n in modes)
    start = np.where(ratio[modes - 1] > 0, ratio[modes - 1], ratio.max() or LIGHT)
    return Unknowns(scene, names, tuple((n,) for n in names), start, np.zeros(len(modes)))


def _orders(orders: ArrayLike, k: int) -> Integer:
    given = np.asarray(orders).tolist()
    found = [check.count(n, f"orders[{i}]", least=0, most=MOST_ORDER) for i, n in enumerate(given)]
    if len(found) != k:
        raise SceneError(f"orders must be one for each of {k} damping ratios, got {len(found)}")
    if not any(found):
        raise SceneError(f"orders must name at least one mode, got {found}")
    return np.array(found, dtype=np.int64)


def _weights(measured: Real, std: ArrayLike | None) -> Real:
    if std is not None:
        given = check.numbers(std, "std", sign="positive")
        if len(given) != len(measured):
            raise SceneError(
                f"std must be one for each of {len(measured)} damping ratios, got {len(given)}"
            )
        return given
    for i in np.flatnonzero(measured <= 0):
        raise SceneError(
            f"damping_ratio[{i}] must be > 0 where there is no std, got {float(measured[i])!r}"
        )
    return measured
