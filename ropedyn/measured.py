"""Measured frequency response, and what motion over time measures."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import check
from .answer import axes
from .curves import Curves
from .errors import SceneError
from .port import Point
from .spectrum import time_step, window_weights
from .unit import MOTIONS, QUANTITIES

if TYPE_CHECKING:
    from .history import History

FLOOR = 1e-3
"""Lines where the force is less than this part of its largest line are left out."""


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


def measured(
    history: History, drive: int, segments: int, window: str | None, band: Any
) -> Measured:
    """Estimate the response per force; see `History.frf`."""
    from scipy import signal

    step, n = time_step(history.time), len(history.time)
    force = _force(history, drive)
    most = max(1, n // 8)
    length = int(2 * n // (check.count(segments, "segments", most=most) + 1))
    if segments == 1:
        length = n
    if window is None:
        window = "boxcar" if segments == 1 else "hann"
    how = {
        "fs": 1 / step,
        "window": window_weights(window, length),
        "noverlap": 0 if segments == 1 else length // 2,
        "detrend": False,
    }
    frequency, cross = signal.csd(force, history.value, **how)
    _, power = signal.welch(force, **how)
    kept = _kept(frequency, power, _band(band), history.quantity)
    coherence = None
    if segments > 1:
        # rounding may lift it above 1
        coherence = np.minimum(signal.coherence(force, history.value, **how)[1][:, kept], 1.0)
    names = {times: name for name, times in QUANTITIES.items()}
    return Measured(
        frequency=frequency[kept],
        value=cross[:, kept] / power[kept],
        drive=(history.drive[drive],),
        response=history.response,
        quantity=names[MOTIONS[history.quantity]],
        coherence=coherence,
    )


def _force(history: History, drive: int) -> NDArray[np.float64]:
    """Return the force that alone drives."""
    if not history.drive:
        raise SceneError("drive must be there for a response per force: the motion is free")
    check.count(drive, "drive", least=0, most=len(history.drive) - 1)
    for k, force in enumerate(history.force):
        if k != drive and force.any():
            raise SceneError(f"force must be 0 at other drives than {drive}, got some at {k}")
    if not history.force[drive].any():
        raise SceneError(
            f"force of drive {drive} must be known at the times, got 0 at all of them: "
            "a blow needs a duration"
        )
    return history.force[drive]


def _band(given: Any) -> NDArray[np.float64] | None:
    """Return the lowest and the highest frequency that are asked for [Hz]."""
    if given is None:
        return None
    band = check.numbers(given, "band", "Hz", sign="nonnegative")
    if len(band) != 2 or not band[0] < band[1]:
        raise SceneError(
            f"band must be two frequencies that increase [Hz], got {check.shown(given)}"
        )
    return band


def _kept(
    frequency: NDArray[np.float64],
    power: NDArray[np.float64],
    band: NDArray[np.float64] | None,
    quantity: str,
) -> NDArray[np.bool_]:
    """Return which lines are told: those of the band, or where the force is not small."""
    if band is None:
        kept = power > FLOOR**2 * power.max()
    else:
        kept = (frequency >= band[0]) & (frequency <= band[1]) & (power > 0)
    # a velocity at 0 Hz says nothing of the displacement there
    kept &= (frequency > 0) | (quantity == "displacement")
    if not kept.any():
        raise SceneError(f"band must hold a frequency the force has, got {check.shown(band)}")
    return kept
