"""Families: many ropes that differ in a few numbers, solved side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.answer import Cost
from ..base.array import Integer, Real
from ..base.computed import computed, waited
from ..base.errors import ModelWarning, SceneError, warn
from ..base.progress import Progress
from ..base.unit import QUANTITIES
from ..chain.compile import compile_scene
from ..chain.place import observed, points
from ..eigen.spectrum import eigenvalue_of
from ..response.question import workers_of
from ..scene.hung import PARABOLA, parabola_error
from ..scene.scene import Scene
from ..space import response as space_response
from ..space.model import compile_space
from .alone import count_of_row, frf_of_row, modes_of_row
from .closed import Component, closed_counts, closed_modes, components_of
from .frf import FamilyFRF
from .harmonic import asked_of_rows, closed_frf
from .modes import FamilyModes
from .rows import Filled, Means, Shared, one_by_one
from .template import Template, template

ROWS, ROWS_ALONE = 1024, 8
"""Rows that are sent together at most: in closed form, and one by one."""

NUMBERS = 1 << 20
"""Numbers of an answer that are sent together at most, unless one row has more."""

MOST_MODES = 100_000
"""Of a row."""


@dataclass(frozen=True)
class Family:
    """Many ropes that differ in a few numbers; plain data that pickles. Made by `Scene.family`.

    Attributes
    ----------
    scene : Scene
        What all other numbers are taken from.
    paths : tuple of str
        The numbers that differ, in the order of the columns of values.
    elements, element
        Of chains, as `Scene.compile` takes them; continuous spans where they are None.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
    >>> family = rd.Scene(rope, tension=2830.0).family(["tension", "ends[0].spring.beta"])
    >>> family.modes([[2830.0, 0.0], [2830.0, float("inf")]], 1).frequency.round(2).tolist()
    [[62.96], [64.09]]
    """

    scene: Scene
    paths: tuple[str, ...]
    elements: int | None = None
    element: str | None = None

    @computed
    def _template(self) -> Template:
        return Template(self.scene, self.paths, self.elements, self.element)

    @computed
    def _closed(self) -> tuple[Component, ...]:
        return components_of(self._template)

    @property
    def closed(self) -> bool:
        """Whether rows are solved in closed form, some microseconds each.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"]).closed
        True
        """
        return bool(self._closed)

    @waited
    def modes(
        self,
        values: ArrayLike,
        number: int,
        *,
        derivative: bool = False,
        threads: int | None = None,
        executor: Executor | None = None,
        progress: Progress = None,
    ) -> FamilyModes:
        """Find the lowest natural frequencies of each rope.

        Parameters
        ----------
        values : array_like, shape (m, p)
            A row for each rope, in the order of `paths`. Springs at ends may be 0 (free), infinite
            (held) and of either sign.
        number : int
            How many frequencies of each.
        derivative : bool
            Also the derivatives of the frequencies by the numbers.
        threads : int, optional
            That share the rows; the environment variable ROPEDYN_THREADS or all cores where left
            out. The bits of a row depend neither on it nor on the other rows.
        executor : concurrent.futures.Executor, optional
            That shares the rows instead, as `sweep` takes it; rows it lost have failed.
        progress : None, True or callable
            True prints the share of rows that are done to stderr, a callable takes it.

        Returns
        -------
        FamilyModes
            Rows that have no meaning, or no answer, are NaN and named in `FamilyModes.failed`.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If values are NaN or not as many to a row as there are paths, or the number is not
            positive.

        Notes
        -----
        Uniform ropes without parts, lay and sag are solved in closed form, in microseconds each
        (see csrc/closed/span_phase.h); what that does not certify, such as rigid motion or motion
        that grows, and all other scenes are compiled and solved row by row.

        Examples
        --------
        A string has f = sqrt(T/mu)/2 L:

        >>> import ropedyn as rd
        >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension", "length"])
        >>> found = family.modes([[1000.0, 2.0], [4000.0, 4.0]], 1, derivative=True)
        >>> found.frequency.round(9).tolist(), found.derivative.round(9).tolist()
        ([[25.0], [25.0]], [[[0.0125, -12.5]], [[0.003125, -6.25]]])
        """
        check.count(number, "number", most=MOST_MODES)
        check.instance(derivative, "derivative", bool, "True or False")
        rows = self._checked(values)
        shape, p = (len(rows), number), len(self.paths)
        blank: list[np.ndarray[Any, Any]] = [np.full(shape, np.nan) for _ in range(3)]
        blank.append(np.zeros(len(rows), dtype=bool))
        if derivative:
            blank.append(np.full((*shape, p), np.nan))
        stages = self._stages(
            blank,
            partial(closed_modes, self._closed, number, derivative),
            partial(modes_of_row, self._template, number, derivative),
        )
        shared = Shared(rows, workers_of(threads), executor, progress)
        reasons, answered = shared.fill(blank, stages)
        frequency, eigenvalue, error, certified = blank[:4]
        return FamilyModes(
            paths=self.paths,
            reasons=reasons,
            cost=_cost(answered, len(rows)),
            frequency=frequency,
            eigenvalue=eigenvalue,
            growth=np.sqrt(np.maximum(-eigenvalue, 0.0)),
            rounding_error=error,
            certified=certified,
            derivative=blank[4] if derivative else None,
        )

    def count(
        self,
        values: ArrayLike,
        *,
        below: float,
        threads: int | None = None,
        executor: Executor | None = None,
        progress: Progress = None,
    ) -> Integer:
        """Count the natural frequencies of each rope below a limit.

        Parameters
        ----------
        values : array_like, shape (m, p)
            As `modes` takes them.
        below : float
            [Hz].
        threads, executor, progress
            As `modes` takes them.

        Returns
        -------
        ndarray of int, shape (m,)
            Motion that grows is counted too; -1 where a row has no meaning.

        Raises
        ------
        TypeError, SceneError
            As `modes` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"])
        >>> family.count([[1000.0], [4000.0]], below=60.0).tolist()
        [2, 1]
        """
        limit = eigenvalue_of(below)
        rows = self._checked(values)
        blank = [np.full(len(rows), -1, dtype=np.int64)]
        stages = self._stages(
            blank,
            partial(closed_counts, self._closed, float(np.sqrt(limit))),
            partial(count_of_row, self._template, below),
        )
        Shared(rows, workers_of(threads), executor, progress).fill(blank, stages)
        return blank[0]

    @waited
    def frf(
        self,
        values: ArrayLike,
        frequency: ArrayLike,
        *,
        drive: Any,
        response: Any = None,
        quantity: str = "receptance",
        threads: int | None = None,
        executor: Executor | None = None,
        progress: Progress = None,
    ) -> FamilyFRF:
        """Compute the frequency response of each rope.

        Parameters
        ----------
        values : array_like, shape (m, p)
            As `modes` takes them.
        frequency, drive, response, quantity
            As `Model.frf` takes them.
        threads, executor, progress
            As `modes` takes them.

        Returns
        -------
        FamilyFRF

        Raises
        ------
        TypeError, SceneError
            As `modes` and `Model.frf` do.

        Examples
        --------
        >>> import ropedyn as rd
        >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"])
        >>> family.frf([[1000.0]], [0.0, 10.0], drive=("z", 1.0)).value.shape
        (1, 1, 2)
        """
        f = check.frequencies(frequency)
        asked = {"drive": drive, "response": response, "quantity": quantity}
        rows = self._checked(values)
        # what is asked is refused before anything runs, and its shape is known
        check.one_of(quantity, "quantity", QUANTITIES)
        if self.scene.is_spatial:
            drives, several = space_response.checked_points(self.scene, drive, "drive")
            watched, swept = space_response.watched(self.scene, response, drives), None
        else:
            model = compile_scene(self.scene, elements=self.elements, element=self.element)
            drives, several = points(model, drive, "drive", forces=False, ends=True)
            watched = observed(model, response, drives)
            swept = asked_of_rows(model, f, drives, watched, quantity, several=several)
        shape = (len(rows), *((len(drives),) if several else ()), len(watched), len(f))
        blank = [np.full(shape, np.nan + 0j), np.full(shape, np.nan)]
        stages = self._stages(
            blank,
            partial(closed_frf, self._closed, swept) if swept else None,
            partial(frf_of_row, self._template, f, asked),
        )
        shared = Shared(rows, workers_of(threads), executor, progress)
        reasons, answered = shared.fill(blank, stages)
        cost = _cost(answered, len(rows))
        return FamilyFRF(self.paths, reasons, cost, quantity, f, *blank)

    def scene_of(self, values: ArrayLike) -> Scene:
        """Return the scene of one rope.

        Parameters
        ----------
        values : array_like, shape (p,)
            In the order of `paths`.

        Raises
        ------
        SceneError
            If the values have no meaning.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=2.0))
        >>> scene.family(["ends[1].spring.z"]).scene_of([5.0]).ends[1].spring
        {'z': 5.0}
        """
        row = self._checked(np.asarray(values)[np.newaxis])[0]
        return self._template.at(row)

    def _stages(
        self,
        blank: Sequence[np.ndarray[Any, Any]],
        closed: Callable[[Real], Filled] | None,
        alone: Callable[[Real], tuple[Any, ...]],
    ) -> list[Means]:
        """Return the ways to fill rows: in closed form where there is one, then one by one."""
        last = Means(partial(one_by_one, alone), ROWS_ALONE)
        row = sum(math.prod(one.shape[1:]) for one in blank)
        size = max(1, min(ROWS, NUMBERS // max(row, 1)))
        return [Means(closed, size), last] if closed and self._closed else [last]

    def _checked(self, values: ArrayLike) -> Real:
        p = len(self.paths)
        what = f"values must be numbers of shape (ropes, {p}), a column for each path"
        try:
            rows = np.asarray(values)
        except ValueError as error:
            raise SceneError(f"{what}, got {check.shown(values)}") from error
        if rows.size == 0 and rows.ndim < 2:
            rows = np.empty((0, p))
        if rows.dtype.kind not in "iuf":
            raise TypeError(f"{what}, got {check.shown(values)}")
        if rows.ndim != 2 or rows.shape[1] != p:
            raise SceneError(f"{what}, got shape {rows.shape}")
        rows = np.ascontiguousarray(rows, dtype=np.float64)
        if np.isnan(rows).any():
            row, column = np.argwhere(np.isnan(rows))[0]
            raise SceneError(f"values[{row}, {column}] ({self.paths[column]}) must not be NaN")
        return rows


def _cost(answered: Sequence[int], rows: int) -> Cost:
    closed = answered[0] if len(answered) > 1 else 0
    return Cost(f"{closed} of {rows} rows in closed form", elements=0, unknowns=0)


def compile_family(
    scene: Scene, paths: Iterable[str], elements: int | None = None, element: str | None = None
) -> Family:
    """Compile a scene and the numbers that differ; see `Scene.family`."""
    known = template(scene, paths)
    if elements is not None or element not in (None, "continuous"):
        compile_one = compile_space if scene.is_spatial else compile_scene
        compile_one(scene, elements=elements, element=element)
    if scene.sags and (off := parabola_error(scene)) > PARABOLA:
        warn(
            f"the rows of a family that sags are those of a parabola, here off by up to {off:.2g} "
            "of a frequency",
            ModelWarning,
        )
    return Family(scene, known.paths, elements, element)
