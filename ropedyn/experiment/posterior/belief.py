"""What is known of numbers of a scene beforehand, as normal variables."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...base import check
from ...base.array import Flags, Real
from ...base.errors import SceneError
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
        """Return that of a mapping to means and standard deviations, weak of some more paths.

        A log-normal variable has the mean and the standard deviation that are given.
        """
        each = [_given(path, *pair) for path, pair in prior.items()]
        each += [_weak(scene, path) for path in weak if path not in prior]
        by_factor, mean, std, said = zip(*each) if each else ((), (), (), ())
        paths = (*prior, *(path for path in weak if path not in prior))
        covariance = np.diag(np.square(np.array(std, dtype=float)))
        return cls(paths, np.array(by_factor, dtype=bool), np.array(mean), covariance, said)

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


def _given(path: str, mean: float, std: float) -> tuple[bool, float, float, str]:
    name, unit = f"prior[{path!r}]", unit_of(path)
    check.number(mean, f"{name}[0]", unit)
    check.number(std, f"{name}[1]", unit, sign="positive")
    words = f"{path} {mean:.6g} +- {std:.3g} {unit}".rstrip()
    if _OF_EITHER_SIGN.fullmatch(path) or mean <= 0:
        return False, mean, std, f"{words}, normal"
    # log-normal of the same mean and standard deviation
    square = float(np.log1p((std / mean) ** 2))
    return True, float(np.log(mean)) - square / 2, float(np.sqrt(square)), f"{words}, log-normal"


def _weak(scene: Scene, path: str) -> tuple[bool, float, float, str]:
    guess = value_at(scene, path)
    if _OF_EITHER_SIGN.fullmatch(path) or guess <= 0:
        raise SceneError(
            f"prior must tell the mean and std of {path} where ends are unknown, which is no "
            f"positive number that a factor changes, got a guess of {guess:g} alone"
        )
    words = f"{path} about {guess:.6g} {unit_of(path)}".rstrip()
    return True, float(np.log(guess)), WEAK, f"{words} within a factor {np.exp(WEAK):.1f}"
