"""Frequency responses of many ropes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base.answer import axes
from ..base.array import Complex, Real
from ..base.table import Table
from .rows import RowsAnswer


@dataclass(frozen=True, eq=False)
class FamilyFRF(RowsAnswer):
    """Frequency responses of many ropes.

    Attributes
    ----------
    paths : tuple of str
        The numbers in which the ropes differ, in the order of the columns.
    quantity : str
        As of `FRF`.
    frequency : ndarray, shape (f,)
        [Hz].
    value : ndarray, shape (m, responses, f)
        Complex amplitude of each row and response, NaN in rows that failed; with a list of drives
        shape (m, drives, responses, f).
    rounding_error : ndarray, shape of value
        Estimated relative error.
    failed : dict of int to exception
        Why a row has no answer, by its number from 0.
    cost : Cost
        Of all together.

    Examples
    --------
    >>> import ropedyn as rd
    >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"])
    >>> family.frf([[1000.0], [2000.0]], [0.0], drive=("z", 1.0)).value[:, 0, 0].real.round(9)
    array([0.0005 , 0.00025])
    """

    quantity: str
    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    value: Complex = field(metadata=axes("row", "drive", "response", "frequency"))
    rounding_error: Real = field(metadata=axes("row", "drive", "response", "frequency"))

    def table(self) -> Table:
        """Return the largest amplitude of each row and where it is."""
        size = np.abs(self.value).reshape(len(self.value), -1, len(self.frequency))
        highest = size.max(axis=1) if size.shape[1] else np.zeros((len(size), len(self.frequency)))
        known = ~np.isnan(highest).any(axis=1)
        at = np.where(known, np.nan_to_num(highest).argmax(axis=1), 0)
        columns: dict[str, Any] = {
            "row": np.arange(len(size)),
            "largest amplitude": np.where(known, highest.max(axis=1), np.nan),
            "at [Hz]": np.where(known, self.frequency[at], np.nan),
        }
        return Table.of(f"largest {self.quantity} of a family", columns)
