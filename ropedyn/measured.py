"""Measured frequency response."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import check
from .answer import axes
from .curves import Curves
from .errors import SceneError
from .port import Point
from .unit import QUANTITIES


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

    frequency: NDArray[np.float64] = field(metadata=axes("frequency", unit="Hz"))
    value: NDArray[np.complex128] = field(metadata=axes("response", "frequency"))
    _: KW_ONLY
    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str = "receptance"
    coherence: NDArray[np.float64] | None = field(
        default=None, metadata=axes("response", "frequency")
    )

    def __post_init__(self) -> None:
        frequency = check.frequencies(self.frequency)
        if (np.diff(frequency) <= 0).any():
            raise SceneError(f"frequency must increase, got {check.shown(self.frequency)}")
        drive, response = _points(self.drive, "drive"), _points(self.response, "response")
        if len(drive) != 1:
            raise SceneError(f"drive must be one point, got {check.shown(self.drive)}")
        check.one_of(self.quantity, "quantity", QUANTITIES)
        shape = (len(response), len(frequency))
        object.__setattr__(self, "frequency", frequency)
        object.__setattr__(self, "drive", drive)
        object.__setattr__(self, "response", response)
        object.__setattr__(self, "value", _matrix(self.value, "value", shape, np.complex128))
        if self.coherence is not None:
            coherence = _matrix(self.coherence, "coherence", shape, np.float64)
            if (coherence < 0).any() or (coherence > 1).any():
                raise SceneError(
                    f"coherence must lie between 0 and 1, got {check.shown(self.coherence)}"
                )
            object.__setattr__(self, "coherence", coherence)
        super().__post_init__()

    def _columns(self) -> dict[str, Any]:
        columns = super()._columns()
        if self.coherence is not None:
            for name, values in zip(self.labels, self.coherence):
                columns[f"coherence of {name}"] = values
        return columns


def _points(given: Any, name: str) -> tuple[Any, ...]:
    """Return points on any rope; a point alone is a tuple of it."""
    found = check.points(given, name, forces=name == "response")
    return (found,) if isinstance(found[0], str) else found


def _matrix(given: ArrayLike, name: str, shape: tuple[int, int], kind: Any) -> Any:
    """Return finite numbers, a row for each response."""
    what = f"finite numbers of shape {shape}, as response and frequency"
    try:
        array = np.array(given, ndmin=2)
    except ValueError as error:
        raise SceneError(f"{name} must be {what}, got {check.shown(given)}") from error
    if array.size and array.dtype.kind not in ("iufc" if kind == np.complex128 else "iuf"):
        raise TypeError(f"{name} must be {what}, got {check.shown(given)}")
    if array.shape != shape or not np.isfinite(array).all():
        raise SceneError(f"{name} must be {what}, got {check.shown(given)} of {array.shape}")
    return array.astype(kind)
