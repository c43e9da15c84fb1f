"""Measured frequency response."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ..base import check
from ..base.answer import axes
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..base.reading import reading
from ..base.unit import QUANTITIES, curve_unit, is_quantity
from ..chain.port import Point
from .curves import Curves
from .files.formats import read

ROWS = "response and frequency"
AROUND = 41  # Lines that the median of the differences goes over: narrow peaks are few of them.
LEAST = 12  # Lines below which nothing is said.


@dataclass(frozen=True, eq=False)
class Measured(Curves):
    """A measured frequency response: motion is Re(value exp(+i omega t)) per unit force.

    Parameters
    ----------
    frequency : array_like, shape (f,)
        [Hz], increasing.
    value : array_like of complex, shape (responses, f) or (f,)
        [m/N, rad/N, m/(N m), rad/(N m), and these per s or s^2].
    drive : point or tuple of one point
        What the force acted on, such as ``("z", 0.5)``.
    response : point or tuple of points
        What was watched.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration per force.
    coherence : array_like, as value, optional
        Share of the motion that follows from the force, from 0 to 1; None where nothing was
        averaged.
    averages : float, optional
        How many independent records were averaged, where that is known.
    std : array_like, as value, optional
        Standard uncertainty of the real and of the imaginary part of each line, where it is known;
        `coherence` and `averages` tell one too.
    decay : float, optional
        [1/s], >= 0, of the window exp(-decay t) that force and motion both carry: the value is the
        response at s = i omega + decay, and a model is asked for it there.
    notes : sequence of str, optional
        What was left out or mended on the way to it.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If shapes do not fit, frequencies do not increase or something is not finite.

    Examples
    --------
    >>> import ropedyn as rd
    >>> measured = rd.Measured([10.0, 20.0], [1e-4, 2e-4], drive=("z", 0.5), response=("z", 0.5))
    >>> measured.labels
    ('z at 0.500 m [m/N]',)
    """

    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    value: Complex = field(metadata=axes("response", "frequency"))
    _: KW_ONLY
    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str = "receptance"
    coherence: Real | None = field(default=None, metadata=axes("response", "frequency"))
    averages: float | None = None
    std: Real | None = field(default=None, metadata=axes("response", "frequency"))
    decay: float = 0.0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        frequency = check.frequencies(self.frequency)
        if (np.diff(frequency) <= 0).any():
            how = ": reverse it and the values" if (np.diff(frequency) < 0).all() else ""
            raise SceneError(f"frequency must increase, got {check.shown(self.frequency)}{how}")
        drive, response = _points(self.drive, "drive"), _points(self.response, "response")
        if len(drive) != 1:
            raise SceneError(f"drive must be one point, got {check.shown(self.drive)}")
        check.one_of(self.quantity, "quantity", QUANTITIES)
        shape = (len(response), len(frequency))
        object.__setattr__(self, "frequency", frequency)
        object.__setattr__(self, "drive", drive)
        object.__setattr__(self, "response", response)
        object.__setattr__(self, "value", _value(self, shape))
        if self.coherence is not None:
            coherence = check.matrix(self.coherence, "coherence", shape, ROWS, np.float64)
            if (coherence < 0).any() or (coherence > 1).any():
                raise SceneError(
                    f"coherence must lie between 0 and 1, got {check.shown(self.coherence)}"
                )
            object.__setattr__(self, "coherence", coherence)
        if self.std is not None:
            std = check.matrix(self.std, "std", shape, ROWS, np.float64)
            if (std < 0).any():
                raise SceneError(f"std must be >= 0, got {check.shown(self.std)}")
            object.__setattr__(self, "std", std)
        averages = check.optional(self.averages, "averages", sign="positive")
        object.__setattr__(self, "averages", averages)
        decay = check.number(self.decay, "decay", "1/s", sign="nonnegative")
        object.__setattr__(self, "decay", decay)
        check.instance(self.notes, "notes", (list, tuple), "a sequence of texts")
        notes = (check.instance(n, f"notes[{k}]", str, "a text") for k, n in enumerate(self.notes))
        object.__setattr__(self, "notes", tuple(notes))
        super().__post_init__()

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        *,
        drive: Any = None,
        response: Any = None,
        unit: str | Sequence[str] | None = None,
        quantity: str | None = None,
        positions: str | Mapping[int, float | None] | None = None,
        coordinate: str | Mapping[str, str] | None = None,
        reciprocal: bool = False,
        records: int | Sequence[int] | None = None,
        decay: float | None = None,
        columns: Mapping[str, Any] | None = None,
        delimiter: str | None = None,
        decimal: str = ".",
        comments: str = "#",
        skip: int = 0,
    ) -> Self:
        r"""Read a universal file (dataset 58, ASCII or binary) or text in columns.

        What `write` has written needs nothing else. Of other files, what they do not say must be
        said here, and what is said here replaces what they say.

        Parameters
        ----------
        path : path
            ``.uff``, ``.unv`` or ``.uf``; ``.csv``, ``.txt``, ``.dat`` or ``.tsv``.
        drive : point, optional
            What the force acted on, such as ``("z", 0.5)``. Of a universal file: which of several.
        response : point or list of points, optional
            What was watched. Of a universal file: which of several; all where left out.
        unit : str, optional
            Of the values, as the file has them: motion per force such as ``"m/N"``, ``"mm/s/N"``,
            ``"g/N"``, ``"(m/s^2)/lbf"``, ``"rad/(N m)"``; or one for each response. Of a universal
            file where left out: by its labels, or else by dataset 164.
        quantity : {"receptance", "mobility", "accelerance"}, optional
            The unit says it too. Of a universal file where left out: by the type of its ordinate.
        positions : dict or {"X", "Y", "Z"}, optional
            Of a universal file: where on the rope each node is [m]; None leaves it out. Or the axis
            along which the rope lies, its first end at 0, if the file has the nodes (dataset 15 or
            2411) and their unit (164).
        coordinate : str or dict, optional
            Of a universal file: which coordinate of the rope each of its directions is, such as
            ``{"Z": "z", "RY": "-beta"}``, or one where there is one direction. The signs of
            records such as -Z are respected.
        reciprocal : bool, optional
            Of a universal file: exchange what was driven and what was watched, which changes no
            response of a passive rope (Maxwell, Betti); for a hammer that roves.
        records : int or list of int, optional
            Of a universal file: numbers of the datasets to be read, from 0.
        decay : float, optional
            Of the exponential window that force and motion were given [1/s]; files that `write`
            has written say it.
        columns : dict, optional
            Of text: names or numbers, from 0, of the columns "frequency" [Hz], "real" and "imag" or
            "amplitude" and "phase" [deg], and "coherence"; a list has one for each response.
        delimiter : str, optional
            Of text; found where left out.
        decimal : {".", ","}, optional
            Of text.
        comments : str, optional
            Of text: how lines begin that are left out.
        skip : int, optional
            Of text: how many lines are left out first. One line of names may follow.

        Returns
        -------
        Measured

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If something is not said, has no meaning for such a file, or the file is damaged; the
            message names it.
        ImportError
            If pyuff is missing for a universal file.
        OSError
            If the file cannot be read.

        Examples
        --------
        >>> import tempfile
        >>> import ropedyn as rd
        >>> path = tempfile.mkdtemp() + "/run1.csv"
        >>> with open(path, "w") as file:
        ...     _ = file.write("f,re,im\n10.0,1.5,0.5\n11.0,2.5,-0.5\n")
        >>> columns = {"frequency": "f", "real": "re", "imag": "im"}
        >>> where = {"drive": ("z", 0.5), "response": ("z", 0.2)}
        >>> measured = rd.Measured.read(path, columns=columns, unit="g/N", **where)
        >>> measured.labels
        ('z at 0.200 m [m/s^2/N]',)
        """
        given = read(
            path,
            anything={"drive": drive, "response": response, "unit": unit, "quantity": quantity},
            universal={
                "positions": positions,
                "coordinate": coordinate,
                "reciprocal": reciprocal,
                "records": records,
            },
            text={
                "columns": columns,
                "delimiter": delimiter,
                "decimal": decimal,
                "comments": comments,
                "skip": skip,
            },
        )
        with reading(path, "a whole file of responses"):
            given = given if decay is None else given._replace(decay=decay)
            return cls(**given._asdict())

    def _noise_around(self, response: int) -> Real | None:
        return by_differences(self.value[response])

    def _noise(self, response: int) -> Real | None:
        if self.std is not None:
            return self.std[response]
        if self.coherence is None or self.averages is None:
            return None
        return by_coherence(self.value[response], self.coherence[response], self.averages)

    def _columns(self) -> dict[str, Any]:
        columns = super()._columns()
        if self.coherence is not None:
            for name, values in zip(self.labels, self.coherence):
                columns[f"coherence of {name}"] = values
        if self.std is not None:
            for name, values in zip(self.labels, self.std):
                columns[f"std of {name}"] = values
        return columns


def by_coherence(value: Complex, coherence: Real, averages: float) -> Real:
    """Return the standard deviation of real and of imaginary part of each line."""
    # var |H|/|H|^2 = (1 - gamma^2)/(2 n gamma^2) for n averages, and as much for the phase: J. S.
    # Bendat, A. G. Piersol, Random Data (2010), table 9.6
    share = np.maximum(coherence, np.finfo(float).tiny)
    return np.abs(value) * np.sqrt((1 - coherence) / (2 * averages * share))


def by_differences(value: Complex) -> Real | None:
    """Estimate the noise of lines from them alone, None where they are too few."""
    # what is smooth has small third differences y_0 - 3 y_1 + 3 y_2 - y_3, noise large ones: |.|^2
    # is distributed as 40 sigma^2 times an exponential variable, whose median is ln 2
    from scipy.ndimage import median_filter

    if len(value) < LEAST:
        return None
    size = np.abs(np.diff(value, 3)) / np.sqrt(40 * np.log(2))
    return np.pad(median_filter(size, AROUND, mode="nearest"), (1, 2), mode="edge")


def lines_of(measured: Measured, which: NDArray[Any]) -> Measured:
    """Return some of the lines, by numbers or as True and False."""
    kept: dict[str, Any] = {
        name: None if of_lines is None else of_lines[:, which]
        for name in ("value", "coherence", "std")
        for of_lines in [getattr(measured, name)]
    }
    return replace(measured, frequency=measured.frequency[which], **kept)


def above_zero(measured: Measured) -> Measured:
    """Leave out a line at 0 Hz: velocities are 0 there and free bodies have no displacement."""
    lines = measured.frequency > 0
    if lines.all():
        return measured
    if not lines.any():
        raise SceneError("measured must have lines above 0 Hz, got none")
    return lines_of(measured, lines)


def _points(given: Any, name: str) -> tuple[Any, ...]:
    """Return points on any rope; a point alone is a tuple of it."""
    found = check.points(given, name, forces=name == "response")
    return (found,) if isinstance(found[0], str) else found


def _value(measured: Measured, shape: tuple[int, int]) -> Complex:
    """Return the values; of a quantity of pint in the unit that all responses have."""
    units = {curve_unit(r, measured.drive[0], measured.quantity) for r in measured.response}
    if len(units) > 1 and is_quantity(measured.value):
        raise SceneError(
            "value must be plain numbers where responses have different units "
            f"({', '.join(sorted(units))}), got {check.shown(measured.value)}"
        )
    return check.matrix(measured.value, "value", shape, ROWS, np.complex128, unit=units.pop())
