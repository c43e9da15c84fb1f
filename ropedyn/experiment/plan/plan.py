"""Plan of a measurement: where to drive and where to listen, how long and how fast to record."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.answer import Answer, axes
from ...base.array import Integer, Real
from ...base.table import Table
from ...base.unit import label, place

RATE = 2.56  # A cycle at the top of the band has so many samples.


@dataclass(frozen=True, eq=False)
class Plan(Answer):
    """Where to drive and where to listen, how long and how fast to record.

    Attributes
    ----------
    drive : tuple of (str, float)
        Coordinate and position [m], as `Model.frf` takes it.
    response : tuple of points
        One for each sensor.
    mode : ndarray of int, shape (k,)
        Numbers of the wanted modes, from 1.
    frequency, damping_ratio : ndarray, shape (k,)
        [Hz, 1].
    visibility : ndarray, shape (sensors, k)
        |phi_n(x_d) phi_n(x_r)| over its largest: the share of the highest peak of mode n.
    amplitude : ndarray, shape (sensors, k)
        |phi_n(x_d) phi_n(x_r)|/(2 zeta_n m_n omega_n^2): receptance at the peak by its own mode
        alone [m/N and so on]; infinite without damping.
    separation : ndarray, shape (k,)
        Distance to the nearest other natural frequency that drive and response can see [Hz].
    line_spacing : float
        The widest that serves [Hz].
    reason : str
        What makes it so narrow.
    highest : float
        Top of the band: 1.1 times the highest wanted frequency [Hz].
    x : ndarray, shape (places,)
        Along the rope [m].
    driven, heard : ndarray, shape (k, places)
        phi_n over its largest, in the coordinate of the drive and of the response.
    damage : str
        What damage was asked for; empty for none.
    shift : ndarray, shape (k,), or None
        What that changes of each frequency [Hz]; 0 where that is less than rounding.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, damping=rd.ModalDamping(0.01))
    >>> plan = rd.plan_measurement(scene, modes=3)
    >>> plan.drive[0], plan.mode, plan.frequency.round(6)
    ('z', array([1, 2, 3]), array([25., 50., 75.]))
    >>> round(plan.record_length * plan.line_spacing, 9), round(plan.rate / plan.highest, 9)
    (1.0, 2.56)
    >>> len(plan.lines) == int(plan.highest / plan.line_spacing), plan.shift_in_lines
    (True, None)
    """

    said = ("record_length", "rate")

    drive: tuple[str, float]
    response: tuple[tuple[str, float], ...]
    mode: Integer = field(metadata=axes("mode"))
    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    damping_ratio: Real = field(metadata=axes("mode"))
    visibility: Real = field(metadata=axes("sensor", "mode"))
    amplitude: Real = field(metadata=axes("sensor", "mode"))
    separation: Real = field(metadata=axes("mode", unit="Hz"))
    line_spacing: float
    reason: str
    highest: float
    x: Real = field(metadata=axes("place", unit="m"))
    driven: Real = field(metadata=axes("mode", "place"))
    heard: Real = field(metadata=axes("mode", "place"))
    damage: str = ""
    shift: Real | None = field(default=None, metadata=axes("mode", unit="Hz"))

    @property
    def seen(self) -> Real:
        """Visibility of each mode by the sensor that sees it best, shape (k,)."""
        return np.asarray(self.visibility.max(axis=0))

    @property
    def bandwidth(self) -> Real:
        """Half-power bandwidths 2 zeta f [Hz], shape (k,)."""
        return np.asarray(2 * self.damping_ratio * self.frequency)

    @property
    def record_length(self) -> float:
        """Of each record: 1 over the line spacing [s]."""
        return 1 / self.line_spacing

    @property
    def rate(self) -> float:
        """Samples per second, at least: 2.56 times the top of the band [Hz]."""
        return RATE * self.highest

    @property
    def lines(self) -> Real:
        """Lines of the planned spectrum up to the top of the band [Hz], without 0."""
        number = math.floor(self.highest / self.line_spacing)
        return np.asarray(self.line_spacing * np.arange(1, number + 1))

    @property
    def shift_in_lines(self) -> Real | None:
        """What the damage changes of each frequency, in lines of the spectrum, shape (k,)."""
        return None if self.shift is None else np.abs(self.shift) / self.line_spacing

    def table(self) -> Table:
        """Return one row for each mode."""
        best = self.visibility.argmax(axis=0)
        columns: dict[str, Any] = {
            "mode": self.mode,
            "frequency [Hz]": self.frequency,
            "seen [%]": 100 * self.seen,
        }
        if len(self.response) > 1:
            columns["by sensor"] = best + 1
        for r, response in enumerate(self.response):
            columns[f"peak of {label(response, self.drive)}"] = self.amplitude[r]
        columns["half-power bandwidth [Hz]"] = self.bandwidth
        columns["next mode [Hz]"] = self.separation
        if self.shift is not None and self.shift_in_lines is not None:
            columns["shift by damage [Hz]"] = self.shift
            columns["shift [lines]"] = self.shift_in_lines
        return Table.of(f"plan: drive {place(self.drive)}", columns)

    def report(self) -> str:
        """Return the plan in sentences.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, damping=rd.ModalDamping(0.01))
        >>> print(rd.plan_measurement(scene, modes=3).report().splitlines()[2])
        Record 8 s, lines 0.125 Hz apart: 4 lines in the half-power bandwidth of mode 1, 0.5 Hz.
        """
        where = " and ".join(place(response) for response in self.response)
        worst = int(self.seen.argmin())
        text = [
            f"Drive {place(self.drive)}, listen to {where}.",
            f"Every mode has at least {100 * self.seen[worst]:.0f} % of the highest peak it can "
            f"have; mode {self.mode[worst]} has least.",
            f"Record {self.record_length:.4g} s, lines {self.line_spacing:.4g} Hz apart: "
            f"{self.reason}.",
            f"Sample at {self.rate:.4g} Hz or faster, band up to {self.highest:.4g} Hz.",
        ]
        merged = self.mode[self.separation < self.bandwidth].tolist()
        if merged:
            text.append(
                f"Nearer to another mode than the half-power bandwidth, so that no record shows "
                f"two peaks there: {', '.join(f'mode {k}' for k in merged)}."
            )
        return "\n".join(text + self._on_damage())

    def _on_damage(self) -> list[str]:
        if self.shift is None or self.shift_in_lines is None:
            return []
        if not self.shift.any():
            return [f"{self.damage} changes no wanted frequency."]
        most = int(self.shift_in_lines.argmax())
        lines = self.shift_in_lines[most]
        text = f"{self.damage} moves mode {self.mode[most]} most, by {self._moved(most)}: "
        if lines >= 1:
            text += f"{lines:.3g} lines."
        else:
            alone = 1 / abs(float(self.shift[most]))
            text += f"{lines:.2g} of a line, too little; a record of {alone:.4g} s makes that one."
        if not self.bandwidth.all():
            return [text]
        share = np.abs(self.shift) / self.bandwidth
        sharp = int(share.argmax())
        return [
            text,
            f"Against the width of its peak mode {self.mode[sharp]} moves most, by "
            f"{self._moved(sharp)}: {100 * share[sharp]:.2g} % of the half-power bandwidth.",
        ]

    def _moved(self, k: int) -> str:
        assert self.shift is not None
        return f"{self.shift[k]:.3g} Hz ({100 * self.shift[k] / self.frequency[k]:.2g} %)"
