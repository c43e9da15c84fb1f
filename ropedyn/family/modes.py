"""Natural frequencies of many ropes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base.answer import axes
from ..base.array import Flags, Real
from ..base.table import Table
from .rows import RowsAnswer

WIDEST = 20
"""Modes that have columns in a table."""


@dataclass(frozen=True, eq=False)
class FamilyModes(RowsAnswer):
    """Natural frequencies of many ropes, lowest first, a row each.

    Attributes
    ----------
    paths : tuple of str
        The numbers in which the ropes differ, in the order of the columns.
    frequency : ndarray, shape (m, k)
        [Hz]; 0 for rigid-body motion and where motion grows, NaN in rows that failed and beyond
        the last mode of a chain.
    eigenvalue : ndarray, shape (m, k)
        omega^2 [rad^2/s^2]; negative beyond the critical compression.
    growth : ndarray, shape (m, k)
        Growth rate sqrt(-omega^2) where that is negative [1/s], else 0.
    rounding_error : ndarray, shape (m, k)
        Estimated absolute error of the frequency that rounding causes [Hz]; of growth/2 pi where
        motion grows.
    derivative : ndarray, shape (m, k, p), or None
        Of the frequency by each number [Hz per unit], where it was asked for: 0 where motion grows,
        NaN where the eigenvalue is 0 and the number changes it, 0 by an infinite spring.
    certified : ndarray of bool, shape (m,)
        True: no mode is missed below the last of the row. False in rows that failed.
    failed : dict of int to exception
        Why a row has no answer, by its number from 0.
    cost : Cost
        Of all together; `method` says how many rows were solved in closed form.

    Examples
    --------
    >>> import ropedyn as rd
    >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"])
    >>> found = family.modes([[1000.0], [-1.0], [4000.0]], 2)
    >>> found.frequency[[0, 2]].round(9).tolist(), found.certified.tolist()
    ([[25.0, 50.0], [50.0, 100.0]], [True, False, True])
    >>> found.failed[1]
    SceneError('tension must be >= 0 for a rope without bending_stiffness [N], got -1')
    """

    frequency: Real = field(metadata=axes("row", "mode", unit="Hz"))
    eigenvalue: Real = field(metadata=axes("row", "mode", unit="rad^2/s^2"))
    growth: Real = field(metadata=axes("row", "mode", unit="1/s"))
    rounding_error: Real = field(metadata=axes("row", "mode", unit="Hz"))
    certified: Flags = field(metadata=axes("row"))
    derivative: Real | None = field(default=None, metadata=axes("row", "mode", "number"))

    def table(self) -> Table:
        """Return one row for each rope, with its lowest frequencies."""
        shown = min(self.frequency.shape[1], WIDEST)
        columns: dict[str, Any] = {"row": np.arange(len(self.frequency))}
        columns |= {f"mode {k + 1} [Hz]": self.frequency[:, k] for k in range(shown)}
        columns["certified"] = self.certified
        if self.reasons:
            why = {row: text for row, _, text in self.reasons}
            columns["failed"] = tuple(why.get(row) for row in range(len(self.frequency)))
        return Table.of("natural frequencies of a family", columns)
