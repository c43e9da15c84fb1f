"""Identifications of many ropes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ...base.answer import TRANSIENT, Answer, axes
from ...base.array import Real
from ...base.drawing import draw
from ...base.errors import RopedynError
from ...base.table import Table, numbers
from .fit import Fit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Fits(Answer, Sequence[Fit | None]):
    """What was identified of many ropes, in their order.

    A sequence of `Fit`, None where one failed.

    Attributes
    ----------
    unknown : tuple of str
        Paths of the numbers.
    value, std : ndarray, shape (ropes, p)
        NaN of ropes that failed.
    rms : ndarray, shape (ropes,)
        Root mean square of relative residuals.
    failure : tuple of str
        Why one failed; empty of the others.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
    >>> peaks = [rd.Peaks([f, 2 * f], std=0.1) for f in (25.0, 30.0)]
    >>> fits = rd.identify(scene, peaks, "tension")
    >>> len(fits), fits.value.round(3).tolist()
    (2, [[1000.0], [1440.0]])
    """

    unknown: tuple[str, ...]
    value: Real = field(metadata=axes("rope", "unknown"))
    std: Real = field(metadata=axes("rope", "unknown"))
    rms: Real = field(metadata=axes("rope"))
    failure: tuple[str, ...]
    fits: tuple[Fit | None, ...] = field(default=(), repr=False, metadata=TRANSIENT)
    failed: Mapping[int, RopedynError] = field(default_factory=dict, repr=False, metadata=TRANSIENT)

    @classmethod
    def of(
        cls,
        unknown: tuple[str, ...],
        fits: Sequence[Fit | None],
        failed: Mapping[int, RopedynError],
    ) -> Fits:
        """Gather the numbers.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
        >>> fit = rd.identify(scene, rd.Peaks([25.0, 50.0], std=0.1), "tension")
        >>> rd.Fits.of(("tension",), [fit, None], {1: rd.SolveError("too few modes")}).failure
        ('', 'too few modes')
        """
        nothing = np.full(len(unknown), np.nan)
        return cls(
            unknown=unknown,
            value=np.array([nothing if fit is None else fit.value for fit in fits]),
            std=np.array([nothing if fit is None else fit.std for fit in fits]),
            rms=np.array([np.nan if fit is None else fit.rms for fit in fits]),
            failure=tuple(str(failed.get(i, "")) for i in range(len(fits))),
            fits=tuple(fits),
            failed=dict(failed),
        )

    def __len__(self) -> int:
        return len(self.rms)

    @overload
    def __getitem__(self, at: int) -> Fit | None: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Fit | None, ...]: ...
    def __getitem__(self, at: int | slice) -> Fit | tuple[Fit | None, ...] | None:
        """Return the fit of a rope; those of a file have only what the table shows."""
        return self.fits[at]

    def __iter__(self) -> Iterator[Fit | None]:
        return iter(self.fits)

    def table(self) -> Table:
        """Return one row for each rope."""
        columns: dict[str, Any] = {"rope": np.arange(len(self))}
        for k, path in enumerate(self.unknown):
            columns[path] = numbers(self.value[:, k])
            columns[f"std of {path}"] = numbers(self.std[:, k])
        columns["rms residual [%]"] = numbers(100 * self.rms)
        if any(self.failure):
            columns["failure"] = tuple(why or None for why in self.failure)
        return Table.of("identified", columns)

    def plot(self, ax: Axes | None = None, *, unknown: str | None = None) -> Axes:
        """Plot one number of each rope with its standard deviation, the first by default."""
        return draw(self, "plot", ax, unknown=unknown)
