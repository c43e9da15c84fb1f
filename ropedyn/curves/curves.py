"""Responses over frequency: what a calculated and a measured one have in common."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from ..base import check
from ..base.answer import Answer
from ..base.array import Complex, Real
from ..base.computed import changed
from ..base.drawing import draw
from ..base.errors import SceneError
from ..base.table import Table
from ..base.unit import QUANTITIES, label, named
from ..chain.port import Point
from .files import Content
from .files.formats import write
from .resonance import Resonances, resonances

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Curves(Answer):
    """Base of what holds motion Re(value exp(+i omega t)) per unit force."""

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    frequency: Real
    value: Complex
    decay: float  # 1/s
    power: ClassVar[int] = 1  # of the force, that the value is per

    @property
    def s(self) -> Complex:
        """Where the value is the response, i omega + decay, shape (f,) [1/s].

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> model.frf([0.0, 1.0], drive=("z", 0.5), decay=0.5).s.round(3)
        array([0.5+0.j   , 0.5+6.283j])
        """
        return np.asarray(2j * np.pi * self.frequency + self.decay, dtype=np.complex128)

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit, for the first drive."""
        of = self.drive[0], self.quantity
        return tuple(label(r, *of, power=self.power) for r in self.response)

    def curve(self, response: int = 0, drive: int = 0) -> Complex:
        """Return one response to one drive, shape (f,).

        Raises
        ------
        TypeError, SceneError
            If a number is none of those there are.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> frf = model.frf([0.0, 5.0], drive=("z", 0.5), response=[("z", 0.25), ("z", 0.5)])
        >>> frf.curve(1).real.round(6)
        array([0.0025  , 0.002728])
        """
        check.count(response, "response", least=0, most=len(self.response) - 1)
        check.count(drive, "drive", least=0, most=len(self.drive) - 1)
        return self.value[response] if self.value.ndim == 2 else self.value[drive, response]

    @property
    def amplitude(self) -> Real:
        """Size of each value, as `value` has it.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> model.frf([0.0, 5.0], drive=("z", 0.5), response=("z", 0.25)).amplitude.round(6)
        array([[0.00125 , 0.001407]])
        """
        return np.abs(self.value)

    def to(self, quantity: str) -> Self:
        """Return the same response as another quantity.

        Parameters
        ----------
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration per force.

        Raises
        ------
        SceneError
            If the quantity is unknown, or a motion at 0 Hz would have to be integrated.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
        >>> frf = model.frf([1.0], drive=("z", 0.5)).to("mobility")
        >>> frf.labels
        ('z at 0.500 m [m/s/N]',)
        """
        check.one_of(quantity, "quantity", QUANTITIES)
        times = QUANTITIES[quantity] - QUANTITIES[self.quantity]
        if times < 0 and (self.s == 0).any():
            raise SceneError(
                f"quantity must be {self.quantity!r} where a frequency is 0, got {quantity!r}"
            )
        value = self.value * self.s**times
        return changed(self, quantity=quantity, value=value)

    def plot(self, ax: Axes | None = None, *, phase: bool = False) -> Axes:
        """Plot amplitudes over frequency on a logarithmic scale.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        phase : bool
            Whether phases stand in axes of their own below, the last of the figure.

        Returns
        -------
        matplotlib.axes.Axes
            Of the amplitudes.

        Raises
        ------
        TypeError
            If `phase` is no truth.
        SceneError
            If the axes are not those of a subplot, which phases need.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> ax = model.frf([5.0, 10.0, 20.0], drive=("z", 0.5)).plot(phase=True)
        >>> [axes.get_ylabel() for axes in ax.figure.axes]
        ['receptance, amplitude [m/N]', 'phase [degrees]']
        """
        return draw(self, "plot", ax, phase=phase)

    def peaks(self, drive: int = 0) -> tuple[Resonances, ...]:
        """Find the resonances that show as peaks, for each response.

        Parameters
        ----------
        drive : int, optional
            Which drive.

        Returns
        -------
        tuple of Resonances
            Frequency [Hz] with its standard uncertainty, amplitude and damping ratio of each peak.
            Of a measurement only what stands out of the noise is a peak. Frequency and damping are
            those of the rope: what an exponential window adds, `decay`, is taken off.

        Raises
        ------
        TypeError, SceneError
            If the drive is none of those there are.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ModalDamping(0.01))
        >>> frf = scene.compile(elements=64).frf(np.arange(1.0, 60.0, 0.1), drive=("z", 0.3))
        >>> (peaks,) = frf.peaks()
        >>> peaks.frequency.round(1), peaks.damping_ratio.round(3)
        (array([15.8, 31.6, 47.4]), array([0.01, 0.01, 0.01]))
        """
        check.count(drive, "drive", least=0, most=len(self.drive) - 1)
        return tuple(
            resonances(
                self.frequency,
                self.curve(r, drive),
                self.quantity,
                label(self.response[r], self.drive[drive], self.quantity),
                self._noise_around(r),
                known=self._noise(r),
                decay=self.decay,
            )
            for r in range(len(self.response))
        )

    def _noise_around(self, response: int) -> Real | None:
        """Return the noise out of which peaks stand at each line, None where there is none."""
        return None

    def _noise(self, response: int) -> Real | None:
        """Return the standard deviation of real and imaginary part, where that is known."""
        return None

    def write(self, path: str | os.PathLike[str], *, binary: bool = False) -> None:
        """Write the responses in SI for other programs, whole or not at all.

        `Measured.read` reads them without being told more.

        Parameters
        ----------
        path : path
            ``.csv`` for text in columns, which keeps every bit; ``.uff`` or ``.unv`` for a
            universal file with a dataset 58 for each response, by pyuff.
        binary : bool, optional
            Whether a universal file is binary and keeps every bit, or is ASCII with 12 digits of
            each value and, where start and step do not say them all, 6 of each frequency.
            Notes of a measurement are kept in text alone.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If the suffix is none of these, something is not finite, frequencies do not increase,
            or a universal file has no words for it: internal forces, wires and moved ends, less
            than two frequencies, ASCII ones that are the same in 6 digits.
        ImportError
            If pyuff is missing for a universal file.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
        >>> frf = model.frf([10.0, 11.0], drive=("z", 0.5))
        >>> path = tempfile.mkdtemp() + "/calculated.csv"
        >>> frf.write(path)
        >>> bool((rd.Measured.read(path).value == frf.value).all())
        True
        """
        content = Content(
            self.frequency,
            self.value if self.value.ndim == 3 else self.value[None],
            self.drive,
            self.response,
            self.quantity,
            coherence=getattr(self, "coherence", None),
            averages=getattr(self, "averages", None),
            std=getattr(self, "std", None),
            decay=self.decay,
            notes=getattr(self, "notes", ()),
        )
        write(content, path, binary)

    def table(self) -> Table:
        """Return amplitude and phase of every response over frequency."""
        return Table.of(f"{self.quantity} over frequency", self._columns())

    def _columns(self) -> dict[str, Any]:
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        for name, _, curve in named_curves(self):
            columns[f"|{name}|" if name not in columns else name] = np.abs(curve)
            columns[f"phase of {name} [deg]"] = np.degrees(np.angle(curve))
        return columns


def named_curves(curves: Curves) -> Iterator[tuple[str, int, Complex]]:
    """Yield each response to each drive: its name, which response it is, and the curve."""
    for name, r, d in named(curves.response, curves.drive, curves.quantity, power=curves.power):
        yield name, r, curves.curve(r, d)
