"""How well frequencies fit, at the tension that fits best: a cloud of points on that ridge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from ...base.array import Flags, Index, Real
from ...base.errors import RopedynError, SolveError
from ...family.family import Family
from ..fitting.natural_frequencies import vibrating
from .space import TENSION, Space
from .task import PosteriorTask

NEAR = 2e-3  # The ridge is straight over so much of ln T: to 1e-6 of a frequency at worst.
STEPS = 12  # The tension that fits best is sought by so many steps at most.
FARTHEST = 3.0  # A step of ln T is at most this long.


@dataclass(eq=False)
class Cloud:
    """Points, and what was measured says of each."""

    u: Real  # (n, d)
    tied: Flags  # (n,) whether both ends are alike
    base: Real  # (n,) ln of the density beforehand
    likelihood: Real  # (n,) ln; -inf where there is no such rope
    log_tension: Real  # (n,) that fits best, or is given
    scale: Real  # (n,) of Student's distribution of ln T about it, 0 where it is given
    chi_square: Real  # (n,)
    residual: Real  # (n, m) over the noise, of a normal likelihood that is as steep
    slope: Real  # (n, m, d) of the residuals, the tension being the best

    def __len__(self) -> int:
        return len(self.u)

    def take(self, some: Index | Flags) -> Cloud:
        """Return some of the points."""
        return Cloud(*(getattr(self, item.name)[some] for item in fields(self)))

    def put(self, some: Index | Flags, other: Cloud) -> None:
        """Replace some of the points."""
        for item in fields(self):
            getattr(self, item.name)[some] = getattr(other, item.name)


@dataclass(frozen=True, eq=False)
class Ridge:
    """Frequencies of a rope against peaks, with the tension that fits best wherever it is sought.

    With weights w of peaks, residuals r of ln f and slopes s = d ln f/d ln T (1/2 where all that is
    elastic grows with T), ln T is best where sum w s r = 0; about that the sum of squares chi^2
    grows by S x^2, S = sum w s^2, and Student's likelihood (1 + chi^2/nu)^(-(nu + k)/2) is one of
    ln T with nu + k - 1 degrees of freedom and scale^2 = (nu + chi^2)/((nu + k - 1) S), times
    (1 + chi^2/nu)^(-(nu + k - 1)/2) S^(-1/2).
    """

    space: Space
    family: Family
    log_frequency: Real  # (k,) measured
    weight: Real  # (k,) 1/std^2 of ln f
    modes: Index  # (k,) from 0
    noise: float  # nu

    @classmethod
    def of(cls, task: PosteriorTask, space: Space) -> Ridge:
        """Compile the family."""
        peak, model = task.log_std
        used = task.used
        return cls(
            space,
            task.scene.family(space.paths, elements=task.elements, element=task.element),
            np.log(np.asarray(task.frequency)[used]),
            1 / (peak**2 + model**2),
            np.asarray(task.orders)[used] - 1,
            task.freedom,
        )

    @property
    def freedom(self) -> float:
        """Degrees of freedom of what is known of ln T at a point."""
        return self.noise + len(self.modes) - 1

    def cloud(self, u: Real, tied: Flags, log_tension: Real) -> Cloud:
        """Say what was measured of points; the tension is sought from what is given."""
        n, k = len(u), len(self.modes)
        base = self.space.log_density(u, self.freedom)
        residual, slope = np.full((n, k), np.nan), np.zeros((n, k, len(self.space.paths)))
        log_tension, open_ = log_tension.copy(), np.flatnonzero(base > -np.inf)
        for _ in range(STEPS):
            residual[open_], slope[open_] = self._at(u[open_], log_tension[open_])
            step = self._step(residual[open_], slope[open_])
            residual[open_] += step[:, None] * (slope[open_] @ self.space.of_tension)
            log_tension[open_] += step
            open_ = open_[np.abs(step) > (np.inf if self.space.scales else NEAR)]
            if not len(open_):
                break
        residual[open_] = np.nan
        raw = Cloud(u, tied, base, base, log_tension, np.zeros(n), np.zeros(n), residual, slope)
        return self._weighed(raw)

    def refusal(self, cloud: Cloud) -> RopedynError:
        """Say why there is no such rope at the first point."""
        value = self.space.values(cloud.u[:1], cloud.log_tension[:1])
        failed = self.family.modes(value, int(self.modes.max()) + 1, threads=1).failed
        return failed.get(0, SolveError("the scene must have the modes of orders, got too few"))

    def numbers(self, cloud: Cloud, paths: Sequence[str]) -> tuple[Real, Real]:
        """Return numbers of each point, and the scales of their logarithms, shapes (n, p).

        Where the tension has a prior its points have it, and the scales are 0.
        """
        space, at = self.space, [self.space.paths.index(path) for path in paths]
        if space.about_tension is not None:
            tension = cloud.log_tension + cloud.scale * cloud.u[:, -1]
            return space.values(cloud.u, tension)[:, at], np.zeros((len(cloud), len(at)))
        scale = cloud.scale[:, None] * np.abs(space.of_tension[at])
        return space.values(cloud.u, cloud.log_tension)[:, at], scale

    def frequency(self, cloud: Cloud) -> Real:
        """Return the frequencies of each point [Hz], shape (n, k)."""
        return np.exp(self.log_frequency + self._at(cloud.u, cloud.log_tension)[0])

    def _at(self, u: Real, log_tension: Real) -> tuple[Real, Real]:
        """Return calculated less measured ln f, (n, k), and its slopes by v, (n, k, r)."""
        value = self.space.values(u, log_tension)
        if not len(u):
            return np.empty((0, len(self.modes))), np.empty((0, len(self.modes), value.shape[1]))
        found, derivative = vibrating(self.family, value, int(self.modes.max()) + 1)
        frequency, derivative = found[:, self.modes], derivative[:, self.modes]
        by_v = np.where(self.space.by_factor & np.isfinite(value), value, 1.0)[:, None, :]
        slope = derivative * by_v / frequency[:, :, None]
        return np.log(frequency) - self.log_frequency, np.where(np.isfinite(slope), slope, 0.0)

    def _step(self, residual: Real, slope: Real) -> Real:
        """Return how far the best ln T is, shape (n,)."""
        if not self.space.pivot:
            return np.zeros(len(residual))
        s = slope @ self.space.of_tension
        size = s**2 @ self.weight
        far = -np.divide(residual * s @ self.weight, size, out=np.zeros(len(s)), where=size > 0)
        far = np.where(np.isfinite(far), far, 0.0)
        return far if self.space.scales else np.clip(far, -FARTHEST, FARTHEST)

    def _weighed(self, raw: Cloud) -> Cloud:
        """Return the likelihood of residuals of ln f and of their slopes by v."""
        k, root = len(self.modes), np.sqrt(self.weight)
        chi_square = raw.residual**2 @ self.weight
        known = np.log1p(chi_square / self.noise)
        slope = raw.slope @ self.space.matrix * root[:, None]
        shrunk = np.sqrt((self.noise + k) / (self.noise + chi_square))
        if self.space.pivot:
            s = raw.slope @ self.space.of_tension * root
            size = np.einsum("nk,nk->n", s, s)
            size[size == 0] = np.nan
            of_best = -np.einsum("nk,nkd->nd", s, slope) / size[:, None]
            slope += s[:, :, None] * of_best[:, None, :]
            raw.scale = np.sqrt((self.noise + chi_square) / (self.freedom * size))
            raw.likelihood = -0.5 * (self.freedom * known + np.log(size))
        else:
            raw.likelihood = -0.5 * (self.noise + k) * known
        raw.chi_square = chi_square
        raw.residual, raw.slope = (
            raw.residual * (root * shrunk[:, None]),
            slope * shrunk[:, None, None],
        )
        if self.space.about_tension is not None:
            raw = self._with_prior(raw, of_best)
        raw.likelihood[~np.isfinite(raw.likelihood + raw.base)] = -np.inf
        return raw

    def _with_prior(self, cloud: Cloud, of_best: Real) -> Cloud:
        """Return the same with what is known of the tension beforehand, at ln T + scale z."""
        space = self.space
        assert space.about_tension is not None
        others, z = cloud.u[:, space.believed], cloud.u[:, -1]
        mean, std = space.about_tension.given(TENSION, others, space.belief.paths)
        off = (cloud.log_tension + cloud.scale * z - mean) / std
        row = of_best / std
        row[:, -1] += cloud.scale / std
        return replace(
            cloud,
            likelihood=cloud.likelihood - off**2 / 2,
            residual=np.column_stack([cloud.residual, off]),
            slope=np.concatenate([cloud.slope, row[:, None, :]], axis=1),
        )
