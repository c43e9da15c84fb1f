"""Fit of numbers of many ropes to their measured peaks: rows of numbers in, rows of answers out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Flags, Index, Integer, Real
from ...base.errors import RopedynError, SceneError, SolveError
from ...family.rows import Answered, Array
from ..fitting.misfit import PeakMisfit, PriorMisfit, unseen_of
from ..fitting.natural_frequencies import NaturalFrequencies
from ..orders.orders import found_orders, lowest_suffice
from .peak_start import start_of_peaks
from .solution import Solution, Task


class Ropes(NamedTuple):
    """What was measured of many ropes, padded to the largest number of peaks."""

    measured: Real  # (n, k) [Hz]
    weight: Real  # (n, k) by which differences are divided [Hz]
    orders: Integer  # (n, k) which mode each peak is, from 1; 0 where it is none
    guess: Real  # (n, p) of the variables
    noise: Real  # (n,) standard deviation of residuals, NaN where it is estimated
    peaks: Integer  # (n,) how many are none of the padding
    searched: Flags  # (n,) whether other orders may be likelier

    def take(self, some: Index) -> Ropes:
        """Return some of them."""
        of: dict[str, Any] = self._asdict()
        return Ropes(**{name: one[some] for name, one in of.items()})

    def packed(self) -> Real:
        """Return all of it as rows of numbers."""
        return np.column_stack([np.asarray(one, dtype=np.float64) for one in self])

    @classmethod
    def unpacked(cls, rows: Real, p: int) -> Ropes:
        """Return what was packed, of p variables."""
        k = (rows.shape[1] - p - 3) // 3
        measured, weight, orders, guess, *last = np.split(
            rows, np.cumsum([k, k, k, p, 1, 1]), axis=1
        )
        noise, count, searched = (one[:, 0] for one in last)
        each = noise, count.astype(np.int64), searched > 0
        return cls(measured, weight, orders.astype(np.int64), guess, *each)


class Fitted(NamedTuple):
    """The solutions of some ropes, in their order, and why others have none."""

    solution: Solution
    failed: dict[int, RopedynError]

    def arrays(self, orders: Integer, runner_up: Array) -> tuple[Array, ...]:
        """Return what is to be known of the ropes that have a solution."""
        found = self.solution
        minimum = found.minimum
        return (
            minimum.u,
            minimum.residual,
            minimum.slope,
            minimum.evaluations,
            found.noise,
            found.freedom,
            found.side,
            found.weight,
            orders[found.rows],
            runner_up[found.rows],
        )


@dataclass(frozen=True, eq=False)
class Identification:
    """Numbers of ropes that are sought by peaks."""

    calculated: NaturalFrequencies  # natural frequencies as functions of what is sought
    prior: Mapping[str, tuple[float, float]]  # value and standard deviation of what is known
    missing: int | None = None  # of a search, see `identify`
    spurious: int = 1  # of a search, see `identify`
    always: bool = False  # whether orders are searched where the lowest modes suffice

    def misfit(self, ropes: Ropes) -> PeakMisfit:
        """Return how far calculated frequencies are off."""
        return PeakMisfit(self.calculated, ropes.measured, ropes.weight, ropes.orders)

    def task(self, ropes: Ropes) -> Task:
        """Return what is to be solved."""
        unknowns, peaks = self.calculated.unknowns, ropes.measured.shape[1]
        known = PriorMisfit.of(unknowns, self.prior)
        return Task(unknowns, self.misfit(ropes), peaks, known, ropes.noise)

    def solve(self, packed: Real) -> Answered:
        """Fit ropes, as rows of numbers, and where orders are not said those that are likeliest."""
        ropes = Ropes.unpacked(packed, len(self.calculated.unknowns))
        runner_up = np.full(len(packed), None, dtype=object)
        rows = np.arange(len(packed))
        first = self._fitted(ropes, rows)
        again, failed = self._numbered(ropes, first, runner_up)
        kept = ~np.isin(first.solution.rows, again)
        parts = [Fitted(first.solution.take(np.flatnonzero(kept)), first.failed)]
        if len(again):
            parts.append(self._fitted(ropes, again))
        failed = {k: e for k, e in first.failed.items() if k not in again} | failed
        for part in parts[1:]:
            failed |= part.failed
        arrays = [part.arrays(ropes.orders, runner_up) for part in parts]
        return Answered(
            np.concatenate([part.solution.rows for part in parts]),
            tuple(np.concatenate(each) for each in zip(*arrays)),
            {k: (type(e).__name__, str(e)) for k, e in failed.items()},
        )

    def _fitted(self, ropes: Ropes, rows: Index) -> Fitted:
        """Fit some of the ropes."""
        task, p = self.task(ropes), len(self.calculated.unknowns)
        prior = 0 if task.known is None else len(task.known.at)
        peaks = (ropes.orders[rows] > 0).sum(axis=1)
        failed: dict[int, RopedynError] = {
            int(rows[k]): SceneError(
                f"measured must have at least {p - prior} peaks for {p} unknown and {prior} prior "
                f"values, got {peaks[k]}"
            )
            for k in np.flatnonzero(peaks + prior < p)
        }
        rows = rows[peaks + prior >= p]
        misfit = self.misfit(ropes)
        start, evaluations = start_of_peaks(misfit, rows, ropes.guess[rows])
        lost = np.asarray(np.isnan(start.residual).any(axis=1))
        failed |= _refusals(misfit, rows[lost], ropes.guess)
        unseen = unseen_of(start.slope, task.known) & ~lost[:, None]
        failed |= {
            int(rows[k]): self._unseen(unseen[k]) for k in np.flatnonzero(unseen.any(axis=1))
        }
        kept = np.flatnonzero(~lost & ~unseen.any(axis=1))
        whole = len(kept) == len(rows)
        solution, refused = task.solve(rows[kept], start if whole else start.take(kept))
        solution.minimum.evaluations[:] += evaluations[kept]
        failed |= {int(rows[kept[k]]): error for k, error in refused.items()}
        solved = np.delete(np.arange(len(kept)), list(refused))
        return Fitted(solution.take(solved) if refused else solution, failed)

    def _unseen(self, unseen: Flags) -> SceneError:
        i = int(np.flatnonzero(unseen)[0])
        return SceneError(
            f"unknown[{i}] must change the natural frequencies of these peaks, got "
            f"{self.calculated.unknowns.paths[i]!r}, which does not"
        )

    def _numbered(
        self, ropes: Ropes, first: Fitted, runner_up: Array
    ) -> tuple[Index, dict[int, RopedynError]]:
        """Search orders where the lowest modes do not suffice; return these ropes, and failures."""
        best = {int(row): k for k, row in enumerate(first.solution.rows)}
        again, failed = [], {}
        for row in np.flatnonzero(ropes.searched).tolist():
            if row not in best and not isinstance(first.failed[row], SolveError):
                continue
            count = ropes.peaks[row]
            frequency, weight = ropes.measured[row, :count], ropes.weight[row, :count]
            std = None if np.isnan(ropes.noise[row]) else weight
            centres = [ropes.guess[row]]
            if row in best:
                minimum = first.solution.minimum
                off = minimum.residual[best[row], :count] * weight
                freedom = int(count) - len(ropes.guess[row])
                if not self.always and lowest_suffice(off, frequency, std, freedom):
                    continue
                centres.append(minimum.u[best[row]])
            try:
                orders, runner_up[row] = found_orders(
                    self.calculated,
                    centres,
                    frequency,
                    std,
                    missing=self.missing,
                    spurious=self.spurious,
                )
            except RopedynError as error:
                failed[row] = error
            else:
                ropes.orders[row, :count] = orders
            again.append(row)
        again = [row for row in again if row not in failed]
        return np.array(again, dtype=np.intp), failed


def _refusals(misfit: PeakMisfit, rows: Index, guess: Real) -> dict[int, RopedynError]:
    """Say why ropes have no frequencies at their guesses, equal ones once."""
    known: dict[bytes, RopedynError] = {}
    failed = {}
    for row in rows.tolist():
        key = guess[row].tobytes() + misfit.orders[row].max().tobytes()
        if key not in known:
            known[key] = misfit.refusal(row, guess[row])
        failed[row] = known[key]
    return failed
