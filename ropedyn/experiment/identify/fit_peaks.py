"""Fit of numbers of many ropes to their measured peaks: rows of peaks in, rows of answers out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.array import Index
from ...base.errors import RopedynError, SceneError
from ...family.rows import Filled
from ...scene.path import with_values
from ...scene.scene import Scene
from ..fitting.misfit import PeakMisfit, PriorMisfit, unseen_of
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.peak_start import start_of_peaks
from ..fitting.solution import Solution, Task
from ..fitting.unknown import Unknowns

Ropes = NDArray[np.void]
"""What was measured of many ropes, with the fields of `kind_of_ropes`."""


def kind_of_ropes(k: int, p: int) -> np.dtype[np.void]:
    """Return what there is of a rope of at most k peaks and p unknown numbers."""
    return np.dtype(
        [
            ("peaks", np.int64),  # how many are none of the padding
            ("measured", float, (k,)),  # [Hz]
            ("weight", float, (k,)),  # by which differences are divided [Hz]
            ("orders", np.int64, (k,)),  # which mode each is, from 1; 0 where it is none
            ("guess", float, (p,)),  # of the variables
            ("noise", float),  # standard deviation of residuals, NaN where it is estimated
        ]
    )


class Options(NamedTuple):
    """How it is identified, checked; see `identify`."""

    paths: tuple[str, ...]
    damping: tuple[str, ...]  # of numbers that the widths of peaks tell
    orders: Any
    ends: str  # "unknown" or "given"
    numbers: int  # how many are sought, with those that a prior alone knows
    prior: Mapping[str, tuple[float, float]]  # a Prior, where there is one
    model_std: float
    elements: int | None
    element: str | None
    seed: int


@dataclass(frozen=True, eq=False)
class Identification:
    """Numbers of ropes that are sought by peaks."""

    scene: Scene  # that describes all of them
    how: Options
    calculated: NaturalFrequencies  # natural frequencies as functions of what is sought

    @classmethod
    def of(cls, scene: Scene, how: Options, ropes: Ropes) -> Identification:
        """Prepare it, and guess tensions where the scene has none."""
        tensed = scene
        if scene.mean_tension == 0 and "tension" in how.paths:
            # a string whose lowest peak is its first mode
            tensed = with_values(scene, {"tension": 1.0})
            inside = np.arange(ropes["measured"].shape[1]) < ropes["peaks"][:, None]
            wave = 2 * scene.rope.length * np.where(inside, ropes["measured"], np.inf).min(axis=1)
            guess = np.log(scene.rope.linear_density * wave**2)
            ropes["guess"][:, how.paths.index("tension")] = guess
        unknowns = Unknowns.of(tensed, how.paths).with_nuisances(how.prior)
        return cls(scene, how, NaturalFrequencies.of(unknowns, how.elements, how.element))

    def misfit(self, ropes: Ropes) -> PeakMisfit:
        """Return how far calculated frequencies are off."""
        return PeakMisfit(self.calculated, ropes["measured"], ropes["weight"], ropes["orders"])

    def task(self, ropes: Ropes) -> Task:
        """Return what is to be solved."""
        unknowns, k = self.calculated.unknowns, ropes["measured"].shape[1]
        known = PriorMisfit.of(unknowns, self.how.prior)
        return Task(unknowns, self.misfit(ropes), k, known, ropes["noise"])

    def solve(self, ropes: Ropes) -> Filled:
        """Fit ropes; what refuses one has not solved it."""
        found, failed = self._fitted(ropes, np.arange(len(ropes)))
        reasons = {k: (type(error).__name__, str(error)) for k, error in failed.items()}
        return Filled(found.rows, (found.record,), reasons)

    def _fitted(self, ropes: Ropes, rows: Index) -> tuple[Solution, dict[int, RopedynError]]:
        """Fit some of the ropes; return also why others of them have no solution."""
        task, paths = self.task(ropes), self.calculated.unknowns.paths
        prior = 0 if task.known is None else len(task.known.at)
        peaks = (ropes["orders"][rows] > 0).sum(axis=1)
        few = peaks + prior < len(paths)
        failed: dict[int, RopedynError] = {
            row: SceneError(
                f"measured must have at least {len(paths) - prior} peaks for {len(paths)} unknown "
                f"and {prior} prior values, got {count}"
            )
            for row, count in zip(rows[few].tolist(), peaks[few].tolist())
        }
        rows, misfit, guess = rows[~few], self.misfit(ropes), ropes["guess"]
        start, evaluations = start_of_peaks(misfit, rows, guess[rows])
        lost = np.asarray(np.isnan(start.residual).any(axis=1))
        refusal: dict[tuple[bytes, int], RopedynError] = {}
        for row in rows[lost].tolist():
            # what equal guesses are refused for is the same
            key = guess[row].tobytes(), int(ropes["orders"][row].max())
            if key not in refusal:
                refusal[key] = misfit.refusal(row, guess[row])
            failed[row] = refusal[key]
        unseen = unseen_of(start.slope, task.known) & ~lost[:, None]
        for row, i in zip(rows[unseen.any(axis=1)].tolist(), unseen.argmax(axis=1)):
            failed[row] = SceneError(
                f"unknown[{i}] must change the natural frequencies of these peaks, got "
                f"{paths[i]!r}, which does not"
            )
        kept = np.flatnonzero(~lost & ~unseen.any(axis=1))
        whole = len(kept) == len(rows)
        found, refused = task.solve(rows[kept], start if whole else start.take(kept))
        found.record["evaluations"] += evaluations[kept]
        failed |= {int(rows[kept[k]]): error for k, error in refused.items()}
        solved = np.delete(np.arange(len(kept)), list(refused))
        return found.take(solved) if refused else found, failed
