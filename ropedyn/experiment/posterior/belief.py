"""What is known of numbers of a scene beforehand, as normal variables."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError
from ...scene.bench.prior import Prior
from ...scene.path import unit_of, value_at
from ...scene.scene import Scene

WEAK = 1.2
"""Standard deviation of the logarithm of an unknown number that nobody says more of."""

_OF_EITHER_SIGN = re.compile(r"parts\[\d+\]\.(x|start|stop)|gravity\.inclination")


@dataclass(frozen=True, eq=False)
class Belief:
    """Normal variables: ln of numbers that are positive, the numbers of places and angles."""

    paths: tuple[str, ...]
    by_factor: Flags  # (q,) whether the variable is a logarithm
    mean: Real  # (q,) of the variables
    covariance: Real  # (q, q) of the variables
    said: tuple[str, ...]  # in words

    @classmethod
    def of(
        cls, scene: Scene, prior: Mapping[str, tuple[float, float]], weak: Sequence[str]
    ) -> Belief:
        """Return that of a prior, or a mapping to means and standard deviations, and weak ones.

        Of the paths of `weak` that it lacks a guess is right within a factor.
        """
        more = [path for path in weak if path not in prior]
        each = [_weak(scene, path) for path in more]
        mean, said = [one for one, _ in each], [words for _, words in each]
        covariance = WEAK**2 * np.eye(len(more))
        by_factor = np.ones(len(more), dtype=bool)
        if not len(prior):
            return cls(tuple(more), by_factor, np.array(mean), covariance, tuple(said))
        given = prior if isinstance(prior, Prior) else Prior(prior)
        law, q = given.law.apart, len(given)
        whole = np.zeros((q + len(more),) * 2)
        whole[:q, :q], whole[q:, q:] = law.spread @ law.spread.T, covariance
        return cls(
            (*given, *more),
            np.append(law.by_log, by_factor),
            np.append(law.centre, mean),
            whole,
            (*(_words(given, path) for path in given), *said),
        )

    def only(self, paths: Sequence[str]) -> Belief:
        """Return what is known of some of them, whatever the others are."""
        at = [self.paths.index(path) for path in paths]
        block = self.covariance[np.ix_(at, at)]
        said = tuple(self.said[i] for i in at)
        return Belief(tuple(paths), self.by_factor[at], self.mean[at], block, said)

    def __len__(self) -> int:
        return len(self.paths)

    def draw(self, rng: np.random.Generator, n: int) -> Real:
        """Draw the variables, shape (n, q)."""
        half = np.linalg.cholesky(self.covariance) if len(self) else self.covariance
        return self.mean + rng.standard_normal((n, len(self))) @ half.T

    def log_density(self, v: Real) -> Real:
        """Return that of variables of shape (n, q), up to a constant, shape (n,)."""
        off = v - self.mean
        return -0.5 * np.einsum("ni,ij,nj->n", off, self.precision, off)

    @property
    def precision(self) -> Real:
        """Inverse of the covariance, shape (q, q)."""
        return np.asarray(np.linalg.inv(self.covariance) if len(self) else self.covariance, float)

    def given(self, path: str, others: Real, rest: Sequence[str]) -> tuple[Real, float]:
        """Return mean (n,) and std of one variable where those of `rest`, (n, r), are known."""
        i, at = self.paths.index(path), [self.paths.index(one) for one in rest]
        cross = self.covariance[i, at]
        if not at:
            return np.full(len(others), self.mean[i]), float(np.sqrt(self.covariance[i, i]))
        gain = np.linalg.solve(self.covariance[np.ix_(at, at)], cross)
        mean = self.mean[i] + (others - self.mean[at]) @ gain
        return mean, float(np.sqrt(self.covariance[i, i] - cross @ gain))


def _words(prior: Prior, path: str) -> str:
    """Say what is known of a number."""
    mean, std = prior[path]
    known = f"{path} {mean:.6g} +- {std:.3g} {unit_of(path)}".rstrip()
    alone = prior.covariance is None or len(prior) == 1
    return f"{known}, {prior.distribution[path]}{'' if alone else ', correlated'}"


def _weak(scene: Scene, path: str) -> tuple[float, str]:
    """Return the mean of the logarithm of a number that nobody says more of, and words."""
    guess = value_at(scene, path)
    if _OF_EITHER_SIGN.fullmatch(path) or guess <= 0:
        raise SceneError(
            f"prior must tell the mean and std of {path} where ends are unknown, which is no "
            f"positive number that a factor changes, got a guess of {guess:g} alone"
        )
    words = f"{path} about {guess:.6g} {unit_of(path)}".rstrip()
    return float(np.log(guess)), f"{words} within a factor {np.exp(WEAK):.1f}"
