"""How many elements were chosen, and why."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Choice:
    """The chain that `Scene.compile` chose for a tolerance.

    Attributes
    ----------
    tolerance : float
        Largest relative mesh error that was asked for.
    below : float
        Of the frequencies below this one [Hz].
    element : str
        Kind of the elements.
    elements : int
        How many were chosen.
    mesh_error : float
        The relative mesh error they have.
    frequencies : int
        How many frequencies lie below, rates of growth among them.
    tried : tuple of (int, float)
        Elements and relative mesh error of each chain that was solved, in order; infinite where a
        chain lacks a frequency.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    >>> choice = scene.compile(tolerance=1e-3, below=20.0).choice
    >>> choice.elements, choice.frequencies
    (21, 1)
    """

    tolerance: float
    below: float
    element: str
    elements: int
    mesh_error: float
    frequencies: int
    tried: tuple[tuple[int, float], ...]

    def __str__(self) -> str:
        fewer = [one for one in self.tried if one[0] < self.elements]
        refused = "no chain has fewer"
        if fewer:
            number, error = max(fewer)
            has = f"have {error:.3g}" if math.isfinite(error) else "lack a frequency"
            refused = f"{number} {has}"
        return (
            f"{self.elements} {self.element} element{'s' * (self.elements > 1)}: relative mesh "
            f"error {self.mesh_error:.3g} <= {self.tolerance:g} of {self.frequencies} "
            f"frequenc{'y' if self.frequencies == 1 else 'ies'} below {self.below:g} Hz; "
            f"{refused}; {len(self.tried)} chain{'s' * (len(self.tried) > 1)} tried"
        )
