"""Measured peaks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.answer import Answer, axes
from ..base.array import Real
from ..base.errors import SceneError
from ..base.table import Table
from ..base.unit import place
from ..chain.port import Point
from .curves import Curves
from .merge_peaks import merge_peaks
from .resonance import Resonances

LENGTH = 1e-14  # Shapes whose length is within this of 1 have it.
KINDS = ("mode", "line", "weak", "double")
NUMBERS = (
    ("std", "Hz", "nonnegative"),
    ("damping_ratio", "", "any"),
    ("damping_ratio_std", "", "nonnegative"),
    ("snr", "", "nonnegative"),
)
"""What each peak may have one number of: name, unit, sign."""
COLUMNS = (
    ("std", "std [Hz]"),
    ("order", "order"),
    ("damping_ratio", "damping ratio"),
    ("damping_ratio_std", "std of damping ratio"),
    ("kind", "kind"),
    ("snr", "S/N"),
)


@dataclass(frozen=True, eq=False)
class Peaks(Answer):
    """Resonance peaks of a measurement, or published ones.

    Parameters
    ----------
    frequency : array_like, shape (k,)
        [Hz], each > 0.
    std : array_like, shape (k,) or one number, optional
        Standard uncertainty [Hz].
    order : sequence of int, shape (k,), optional
        Which mode each peak is, from 1; left out where that is not known.
    damping_ratio : array_like, shape (k,) or one number, optional
        Share of critical damping.
    damping_ratio_std : array_like, shape (k,) or one number, optional
        Its standard uncertainty.
    kind : sequence of {"mode", "line", "weak", "double"}, optional
        What each peak is: a mode; a sinusoid, such as of a machine; something that hardly stands
        out of what is around it; two that could not be told apart. Only modes say something about
        the rope. All are modes where left out.
    shape : array_like, shape (k, sensors), optional
        Real or complex shape of each peak at the sensors, of unit length.
    sensors : sequence of points, optional
        Where the shapes are, such as ``("z", 3.5)``.
    snr : array_like, shape (k,) or one number, optional
        Power density at the peak over that of what else is there.
    band : array_like, shape (k, 2), optional
        What of the spectrum each peak was found in [Hz].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If a frequency is not positive, lengths differ, or an order is used twice.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Peaks([64.0, 130.0, 193.0]).frequency.tolist()
    [64.0, 130.0, 193.0]
    """

    frequency: ArrayLike = field(metadata=axes("peak", unit="Hz"))
    _: KW_ONLY
    std: Any = None
    order: Sequence[int] | None = None
    damping_ratio: Any = None
    damping_ratio_std: Any = None
    kind: Sequence[str] | None = None
    shape: Any = field(default=None, metadata=axes("peak", "sensor"))
    sensors: Sequence[Point] | None = None
    snr: Any = None
    band: Any = field(default=None, metadata=axes("peak", "bound", unit="Hz"))

    def __post_init__(self) -> None:
        frequency = check.numbers(self.frequency, "frequency", "Hz", sign="positive")
        object.__setattr__(self, "frequency", frequency)
        for name, unit, sign in NUMBERS:
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, _each(given, name, unit, sign, len(frequency)))
        if self.order is not None:
            object.__setattr__(self, "order", _checked_order(self.order, len(frequency)))
        if self.kind is not None:
            object.__setattr__(self, "kind", _checked_kind(self.kind, len(frequency)))
        if self.band is not None:
            object.__setattr__(self, "band", _checked_band(self.band, len(frequency)))
        if self.shape is not None or self.sensors is not None:
            shape, sensors = _checked_shape(self.shape, self.sensors, len(frequency))
            object.__setattr__(self, "shape", shape)
            object.__setattr__(self, "sensors", sensors)
        super().__post_init__()

    @classmethod
    def of(cls, measured: Curves | Resonances | Sequence[Resonances]) -> Self:
        """Return the resonances of all responses as one list.

        Peaks of different responses that are nearer than a line, half the width at half power or
        3 standard uncertainties are one: their mean, weighted by the uncertainties, whose own
        follows from these, or from the scatter where that is more.

        Parameters
        ----------
        measured : Measured or FRF, or Resonances or a sequence of them
            Responses, or what their ``peaks()`` found.

        Returns
        -------
        Peaks
            With `std` and `damping_ratio`.

        Raises
        ------
        TypeError
            If it is none of these.
        SceneError
            If there is no peak.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ModalDamping(0.01))
        >>> points = [("z", 0.4), ("z", 0.25)]
        >>> frf = scene.compile().frf(np.arange(5.0, 40.0, 0.1), drive=points[0], response=points)
        >>> print(rd.Peaks.of(frf).frequency.round(2))
        [15.81 31.62]
        """
        given = (measured,) if isinstance(measured, Resonances) else measured
        what = "responses such as a Measured, or the Resonances of some"
        check.instance(given, "measured", (Curves, list, tuple), what)
        if not isinstance(given, Curves):
            for k, one in enumerate(given):
                check.instance(one, f"measured[{k}]", Resonances, "Resonances")
        found = merge_peaks(given)
        return cls(found.frequency, std=found.std, damping_ratio=found.damping_ratio)

    def table(self) -> Table:
        """Return one row for each peak."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        for name, title in COLUMNS:
            values = getattr(self, name)
            if values is not None:
                columns[title] = values
        if self.shape is not None:
            for sensor, column in zip(self.sensors or (), np.asarray(self.shape).T):
                columns[f"shape, {place(sensor)}"] = column
        return Table.of("peaks", columns)


def _each(given: Any, name: str, unit: str, sign: str, peaks: int) -> tuple[float, ...]:
    """Return a number for each peak; one is for all."""
    values = check.numbers(given, name, unit, sign=sign)
    if len(values) not in (1, peaks):
        raise SceneError(f"{name} must be one number or {peaks}, as frequency, got {len(values)}")
    return tuple(np.broadcast_to(values, peaks).tolist())


def _checked_order(order: Any, peaks: int) -> tuple[int, ...]:
    what = f"{peaks} different whole numbers from 1, one for each frequency"
    check.instance(order, "order", (list, tuple, range, np.ndarray), what)
    if len(order) != peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    most = np.iinfo(np.int32).max
    checked = tuple(check.count(k, f"order[{i}]", most=most) for i, k in enumerate(order))
    if len(set(checked)) < peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    return checked


def _checked_kind(kind: Any, peaks: int) -> tuple[str, ...]:
    check.instance(kind, "kind", (list, tuple, np.ndarray), f"{peaks} words, one for each peak")
    if len(kind) != peaks:
        raise SceneError(f"kind must be {peaks} words, as frequency, got {len(kind)}")
    return tuple(str(check.one_of(k, f"kind[{i}]", KINDS)) for i, k in enumerate(kind))


def _checked_band(band: Any, peaks: int) -> Real:
    checked: Real = check.matrix(band, "band", (peaks, 2), "peaks and bounds", np.float64)
    if (checked[:, 0] > checked[:, 1]).any():
        k = int(np.argmax(checked[:, 0] > checked[:, 1]))
        raise SceneError(f"band[{k}] must begin before it ends, got {checked[k].tolist()} Hz")
    return checked


def _checked_shape(shape: Any, sensors: Any, peaks: int) -> tuple[Any, tuple[Point, ...]]:
    """Return unit shapes at points; real ones stay real."""
    if shape is None or sensors is None:
        alone = "sensors" if shape is None else "shape"
        raise SceneError(f"shape and sensors must be given together, got {alone} alone")
    points = check.points(sensors, "sensors", forces=False)
    points = (points,) if isinstance(points[0], str) else points
    kind = np.complex128 if np.iscomplexobj(shape) else np.float64
    checked = check.matrix(shape, "shape", (peaks, len(points)), "peaks and sensors", kind)
    size = np.linalg.norm(checked, axis=1, keepdims=True)
    if not (size > 0).all():
        raise SceneError(f"shape[{int(np.argmin(size))}] must not be 0, got {checked.tolist()}")
    # what has unit length stays as it is
    return np.where(np.abs(size - 1) <= LENGTH, checked, checked / size), points
