"""Integrals of products of fields along a span: by the waves they are made of, by Gauss points."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from ..base.array import Complex, Flags, Index, Real
from .hamiltonian import generator

LONG = 0.5  # Below so many radians of every wave on a stretch their sum cancels.
APART = 1e3
"""Waves whose shapes, each coordinate in its unit, have a condition beyond this are one."""
LEAST = 1e-12  # Shapes that are apart have a determinant above this.
SMALL = 0.1  # Below so many radians exp(s) - 1 is a series.
DEEP = 40.0  # What decays as exp(-s) is nothing beyond: 4e-18.
PANEL = 128  # One panel of Gauss points spans so many radians.


@dataclass(frozen=True, eq=False)
class SpanWaves:
    """y = sum over j of shape_j amplitude_j(x), amplitude_j' = rate_j amplitude_j."""

    # (f, 2 width) by their real parts, increasing: the first half decays to the right
    rate: Complex
    shape: Complex  # (f, 2 width, 2 width) in columns
    inverse: Complex  # (f, 2 width, 2 width) makes amplitudes of y
    condition: Real  # (f,) of the shapes, each coordinate in units of its own

    @classmethod
    def of(cls, form: Complex) -> SpanWaves:
        """Take apart what a Hamiltonian, shape (f, 2 width, 2 width), says."""
        rate, shape = np.linalg.eig(generator(form))
        order = np.argsort(rate.real, axis=1)
        rate = np.take_along_axis(rate, order, axis=1)
        shape = np.take_along_axis(shape, order[:, None], axis=2)
        unit = np.abs(shape).max(axis=2, keepdims=True)
        plain = np.asarray(shape / np.where(unit > 0, unit, 1.0), dtype=np.complex128)
        apart = np.abs(np.linalg.det(plain)) > LEAST
        plain[~apart] = np.eye(plain.shape[1])
        inverse = np.asarray(np.linalg.inv(plain), dtype=np.complex128)
        size = np.linalg.norm(plain, axis=(1, 2)) * np.linalg.norm(inverse, axis=(1, 2))
        inverse /= np.where(unit > 0, unit, 1.0).swapaxes(1, 2)
        return cls(rate, shape, inverse, np.where(apart, size, np.inf))

    def at(self, lines: Index) -> SpanWaves:
        """Return those of some frequencies, by their numbers."""
        return SpanWaves(
            self.rate[lines], self.shape[lines], self.inverse[lines], self.condition[lines]
        )

    def tell(self, reach: float) -> Flags:
        """Whether waves can be told apart on a stretch of this length [m], shape (f,)."""
        long = (np.abs(self.rate) * reach > LONG).all(axis=1)
        return np.asarray(long & (self.condition < APART))

    def amplitudes(self, y: Complex, near: float, reach: float) -> tuple[Complex, Complex]:
        """Return the amplitudes at both ends of a stretch, (loads, f, 2 width) each."""
        left, right = (np.einsum("fij,ljf->lfi", self.inverse, y[:, k]) for k in (0, 1))
        falls, grows = np.split(self.rate, 2, axis=1)
        half = falls.shape[1]
        # each is told where it is largest
        left, right = left[..., :half], right[..., half:]
        far = reach - near
        first = [left * np.exp(-falls * near), right * np.exp(-grows * far)]
        last = [left * np.exp(falls * far), right * np.exp(grows * near)]
        return np.concatenate(first, axis=-1), np.concatenate(last, axis=-1)

    def products(
        self, r: tuple[Complex, Complex], d: tuple[Complex, Complex], reach: float
    ) -> Complex:
        """Integrate y_r y_d^T over a stretch."""
        first, last = (np.einsum("rfi,dfj->drfij", a, b) for a, b in zip(r, d))
        grows = self.rate[:, :, None] + self.rate[:, None, :]
        s = grows * reach
        small = np.abs(s) < SMALL
        with np.errstate(divide="ignore", invalid="ignore"):
            whole = (last - first) / grows
        series = 1 + s / 2 * (1 + s / 3 * (1 + s / 4 * (1 + s / 5 * (1 + s / 6 * (1 + s / 7)))))
        integral = np.where(small, first * (series * reach), whole)
        back = np.swapaxes(self.shape, 1, 2)
        return np.asarray(self.shape @ integral @ back)


def rule(waves: float, decay: float) -> tuple[Real, Real]:
    """Return points and weights that integrate products of two such functions to rounding."""
    # n points are exact up to the degree 2 n - 1. Products of waves, exp(2 i k x) over a length h,
    # are polynomials of degree k h and some (k h)^(1/3) more, those of what decays, exp(-2 a x), of
    # degree 8 sqrt(a h), to 1e-16. Layers that are thin beside the stretch get panels of their own
    points, weights = [], []
    for begin, end, deep in _panels(decay):
        wide = waves * (end - begin)
        count = max(1, math.ceil(wide / PANEL))
        each, width = wide / count, (end - begin) / count
        x, w = _gauss(math.ceil(6 + each / 2 + 5 * np.cbrt(each) + 4 * math.sqrt(deep)))
        points += [begin + width * (k + x) for k in range(count)]
        weights += [width * w] * count
    return np.concatenate(points), np.concatenate(weights)


def _panels(decay: float) -> list[tuple[float, float, float]]:
    """Return begin, end and how much decays within, layers and what lies between them."""
    if decay <= 4 * DEEP:
        return [(0.0, 1.0, decay)]
    layer = DEEP / decay
    return [(0.0, layer, DEEP), (layer, 1 - layer, 0.0), (1 - layer, 1.0, DEEP)]


@functools.lru_cache(maxsize=128)
def _gauss(n: int) -> tuple[Real, Real]:
    """Return Gauss points and weights on (0, 1)."""
    x, w = np.polynomial.legendre.leggauss(n)
    return (1 + x) / 2, w / 2
