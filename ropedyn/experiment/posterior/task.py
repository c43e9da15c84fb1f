"""What is asked of the posterior of a rope."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...base import check
from ...base.array import Flags, Integer, Real
from ...base.errors import SceneError
from ...family.template import SPRING
from ...scene.bench.prior import Prior
from ...scene.scene import Scene
from ..fitting.unknown import Unknowns

FLOOR = 2e-4
"""No frequency is known better than this share of itself."""

NOISE = 1e-3
"""Where no std is given the noise is thought to be about this share of each frequency."""

FREEDOM, FREEDOM_ESTIMATED = 10.0, 2.0
"""Degrees of freedom of the noise: how surely its size is known, given and estimated."""

MOST_MODES = 100_000
MOST_SEED = 2**63 - 1


@dataclass(frozen=True, eq=False)
class PosteriorTask:
    """Peaks of a rope, what is sought of it, and what is known of the rest."""

    scene: Scene  # with guesses of what is unknown
    unknown: tuple[str, ...]  # paths, such as "tension"
    frequency: Real  # (k,) [Hz]
    std: Real | None  # (k,) [Hz]; None: the noise is estimated
    orders: Integer  # (k,) from 1; 0 of a peak that is no mode
    prior: Mapping[str, tuple[float, float]] = field(default_factory=dict)  # mean and std
    model_std: float = 0.0  # relative error of the model at each frequency
    ends: bool = True  # whether rotational springs of the ends are not known
    seed: int = 0
    elements: int | None = None
    element: str | None = None

    def __post_init__(self) -> None:
        check.instance(self.scene, "scene", Scene, "a Scene")
        others = [path for path in self.unknown if not SPRING.fullmatch(path)]
        if others or not self.unknown:
            Unknowns.of(self.scene, others)
        if len(self.prior) and not isinstance(self.prior, Prior):
            Prior(self.prior)
        frequency = check.numbers(self.frequency, "frequency", "Hz", sign="positive")
        orders = np.asarray(self.orders)
        if orders.shape != frequency.shape or orders.dtype.kind not in "iu" or orders.min() < 0:
            raise SceneError(
                f"orders must be a whole number >= 0 for each of {len(frequency)} peaks, "
                f"got {check.shown(orders.tolist())}"
            )
        if not orders.any():
            raise SceneError("orders must name a mode of at least one peak, got none")
        check.count(int(orders.max()), "orders", most=MOST_MODES)
        if self.std is not None:
            std = check.numbers(self.std, "std", "Hz", sign="positive")
            if std.shape != frequency.shape:
                raise SceneError(
                    f"std must be a number for each of {len(frequency)} peaks, got {len(std)}"
                )
        check.number(self.model_std, "model_std", sign="nonnegative")
        check.count(self.seed, "seed", least=0, most=MOST_SEED)

    @property
    def used(self) -> Flags:
        """Which peaks are modes, shape (k,)."""
        return np.asarray(self.orders) > 0

    @property
    def log_std(self) -> tuple[Real, Real]:
        """Standard deviations of ln f of the used peaks, by the peaks and by the model."""
        f = np.asarray(self.frequency)[self.used]
        peak = np.full(len(f), NOISE)
        if self.std is not None:
            peak = np.maximum(np.asarray(self.std)[self.used] / f, FLOOR)
        return peak, np.full(len(f), float(self.model_std))

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the noise."""
        return FREEDOM_ESTIMATED if self.std is None else FREEDOM
