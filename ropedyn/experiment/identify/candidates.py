"""Numberings of peaks that are worth naming, each with what it tells."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import overload

import numpy as np

from ...base.answer import TRANSIENT, Frozen, axes
from ...base.array import Integer, Real
from ...base.named import Named
from .known import METHODS, Known, checked_level, kept_bounds, kept_interval

NAMED = 0.05
"""A numbering is a rival that has this part of the probability of the likeliest."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One numbering of the peaks.

    Attributes
    ----------
    probability : float
        Of all numberings.
    orders : ndarray of int, shape (k,)
        Which mode each peak is, from 1; 0 where it is none.
    value : Named, shape (p,)
        The numbers that it tells.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
    >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension", orders=[1, 2, 3])
    >>> first = fit.candidates[0]
    >>> first.probability, first.orders.tolist(), first.interval(0.95)["tension"].round()
    (1.0, [1, 2, 3], array([ 995., 1004.]))
    """

    probability: float
    orders: Integer
    value: Named
    bounds: Real = field(repr=False)
    known: Known | None = field(repr=False)

    def interval(self, level: float = 0.95) -> Named:
        """Find confidence intervals, as `Fit.interval` does, if this numbering is right.

        Parameters
        ----------
        level : float
            As `Fit.interval` takes it.

        Returns
        -------
        Named, shape (p, 2)

        Raises
        ------
        TypeError, SceneError
            As `Fit.interval` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
        >>> peaks = rd.Peaks([25.1, 49.9, 75.0], std=0.1)
        >>> fit = rd.identify(scene, peaks, "tension", orders=[1, 2, 3])
        >>> fit.candidates[0].interval(0.95).round().tolist()
        [[995.0, 1004.0]]
        """
        level = checked_level(level, METHODS[0])
        return Named(kept_interval(self, level, METHODS[0]), self.value.paths or ())


@dataclass(frozen=True, eq=False)
class Candidates(Frozen, Sequence[Candidate]):
    """Numberings with their numbers, the likeliest first: a sequence of `Candidate`."""

    candidate_unknown: tuple[str, ...]
    candidate_probability: Real = field(metadata=axes("candidate"))
    candidate_orders: Integer = field(metadata=axes("candidate", "peak"))
    candidate_value: Real = field(metadata=axes("candidate", "unknown"))
    candidate_bounds: Real = field(metadata=axes("candidate", "level", "unknown", "bound"))
    known: tuple[Known, ...] = field(default=(), repr=False, metadata=TRANSIENT)

    @classmethod
    def of(
        cls, unknown: tuple[str, ...], numbered: Sequence[tuple[float, Integer, Real, Known]]
    ) -> Candidates:
        """Gather probabilities, orders, values, and how well these are known."""
        probability, orders, value, known = zip(*numbered)
        bounds = [kept_bounds(one.interval) for one in known]
        return cls(
            candidate_unknown=unknown,
            candidate_probability=np.array(probability),
            candidate_orders=np.array(orders),
            candidate_value=np.array(value),
            candidate_bounds=np.array(bounds),
            known=known,
        )

    def __len__(self) -> int:
        return len(self.candidate_probability)

    @overload
    def __getitem__(self, at: int) -> Candidate: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Candidate, ...]: ...
    def __getitem__(self, at: int | slice) -> Candidate | tuple[Candidate, ...]:
        """Return one, or some."""
        if isinstance(at, slice):
            return tuple(self[i] for i in range(len(self))[at])
        i = range(len(self))[at]
        return Candidate(
            float(self.candidate_probability[i]),
            self.candidate_orders[i],
            Named(self.candidate_value[i], self.candidate_unknown),
            self.candidate_bounds[i],
            self.known[i] if self.known else None,
        )

    def __iter__(self) -> Iterator[Candidate]:
        return (self[i] for i in range(len(self)))

    @property
    def rivals(self) -> tuple[Candidate, ...]:
        """Those that cannot be left out, the likeliest among them."""
        return tuple(one for one in self if one.probability >= NAMED * self[0].probability)

    def hull(self, level: float, method: str) -> Real:
        """Return intervals that hold those of all rivals, shape (p, 2)."""
        each = np.array([kept_interval(one, level, method) for one in self.rivals])
        return np.stack([each[:, :, 0].min(axis=0), each[:, :, 1].max(axis=0)], axis=1)
