"""What the fit of a whole frequency response found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.answer import TRANSIENT, Cost, axes
from ...base.array import Complex, Real
from ...base.computed import Lazy, lazy
from ...base.named import Named
from ...base.table import Table
from ...base.unit import label
from ...chain.port import Point
from ...scene.scene import Scene
from .known import KEPT_SCENE, Identified, Known


@dataclass(frozen=True, eq=False)
class ResponseFit(Identified):
    """Numbers of a scene that make its frequency response the one that was measured.

    Attributes
    ----------
    scene : Scene
        With the numbers that were found.
    unknown : tuple of str
        Paths of the numbers; the last is ``"calibration"`` where that was sought.
    value, std : Named, shape (p,)
        Each number, ``fit.value["tension"]``, and its standard deviation by the exact derivatives;
        infinite where the response does not tell it.
    correlation : ndarray, shape (p, p)
        NaN where one of both is not told.
    drive, response : tuple of points
        What the force acted on and what was watched.
    quantity : {"receptance", "mobility", "accelerance"}
    frequency : ndarray, shape (f,)
        [Hz].
    measured, calculated : ndarray of complex, shape (responses, f)
        [as `Measured.value`]; the calculated one with the calibration that was found.
    measured_std : ndarray, shape (responses, f)
        Of either part of each line, estimated from what is left; infinite where it was not used.
    freedom : float
        Degrees of freedom the noise was estimated with.
    chi_square : float
        Sum of the squared residuals in units of `measured_std`.
    notes : tuple of str
        What the response cannot tell, and where it differs from the model by more than noise.
    cost : Cost

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> rope, damping = rd.Rope(2.0, 0.1), rd.ViscousDamping(1.0)
    >>> true = rd.Scene(rope, tension=1000.0, damping=damping).compile()
    >>> lines, drive = np.arange(20.0, 60.0, 0.5), ("z", 0.7)
    >>> noise = 3e-5 * np.random.default_rng(1).normal(size=(1, len(lines), 2)) @ [1, 1j]
    >>> value = true.frf(lines, drive=drive).value + noise
    >>> measured = rd.Measured(lines, value, drive=drive, response=drive, quantity="receptance")
    >>> fit = rd.identify(rd.Scene(rope, tension=900.0, damping=damping), measured, "tension")
    >>> low, high = fit.interval(0.95)["tension"]
    >>> round(float(fit.value["tension"])), bool(low < 1000.0 < high)
    (1000, True)
    >>> print(fit.report().splitlines()[0])
    identified
    """

    said = ("lines",)

    unknown: tuple[str, ...]
    value: Named = field(metadata=axes("unknown"))
    std: Named = field(metadata=axes("unknown"))
    correlation: Real = field(metadata=axes("unknown", "other"))
    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    measured: Complex = field(metadata=axes("response", "frequency"))
    calculated: Complex = field(metadata=axes("response", "frequency"))
    measured_std: Real = field(metadata=axes("response", "frequency"))
    freedom: float | None
    chi_square: float
    notes: tuple[str, ...]
    cost: Cost
    scene: Lazy[Scene] = lazy(Scene, KEPT_SCENE)
    bounds: Lazy[Real] = lazy(np.ndarray, axes("level", "unknown", "bound"))
    known: Known | None = field(default=None, repr=False, metadata=TRANSIENT)

    @property
    def residual(self) -> Complex:
        """Calculated less measured response, shape (responses, f)."""
        return self.calculated - self.measured

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit."""
        return tuple(label(r, self.drive[0], self.quantity) for r in self.response)

    @property
    def lines(self) -> Table:
        """One row for each response: how far it is off."""
        size, off = np.abs(self.measured), np.abs(self.residual)
        level = 20 * np.abs(np.log10(np.abs(self.calculated) / np.where(size > 0, size, np.nan)))
        whole = np.sqrt(np.sum(off**2, axis=1) / np.sum(size**2, axis=1))
        columns: dict[str, Any] = {
            "response": self.labels,
            "off, rms over rms": tuple(whole.tolist()),
            "median [dB]": tuple(np.nanmedian(level, axis=1).tolist()),
        }
        return Table.of("calculated against measured response", columns)

    def report(self) -> str:
        """Return values, how far responses are off, and notes as text."""
        notes = [f"note: {note}" for note in self.notes]
        return "\n".join([str(self.table()), "", str(self.lines), *notes])
