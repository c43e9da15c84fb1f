"""Transfer functions of the linear scene between a few points, as series along the frequency.

H(i omega) is what the sweep solves for. Periodic motion asks for it at every harmonic of every
frequency that a branch passes, and its stability along whole strips: so it is computed once, as
Chebyshev series on panels that are halved until the last terms are below `SMALL` of the largest
value. A pole on the real axis never lets them: that motion is not damped.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from ...base.array import Complex, Flags, Index, Real
from ...base.errors import SolveError

TERMS = 16  # Of a series.
LAST = 2  # So many terms must be small.
SMALL = 1e-11  # Of the largest value on the panel.
FLOOR = 1e-5  # An entry counts as if it were at least this part of the largest.
FIRST = 32  # Panels that cover what is asked for first.
HALVINGS = 34  # A panel that is still not smooth then has a pole in it.

MOST = 1 << 14  # Panels that are solved at once.

Ask = Callable[[Real], Complex]
"""From frequencies [rad/s], (f,), to transfer functions, (f, ..)."""


@cache
def _rule() -> tuple[Real, Real, Real]:
    """Return Chebyshev's points, values to terms, and terms to those of the derivative."""
    x = chebyshev.chebpts1(TERMS)
    terms = np.linalg.inv(chebyshev.chebvander(x, TERMS - 1))
    slope = np.zeros((TERMS, TERMS))
    slope[:-1] = chebyshev.chebder(np.eye(TERMS))
    return x, np.asarray(terms, dtype=np.float64), slope


class PanelledTransfer:
    """H(i omega) between points, on the whole real axis."""

    def __init__(self, ask: Ask, known: Callable[[Real], Real]) -> None:
        self.ask = ask
        self.known = known  # their errors, of the largest at each frequency, (f,)
        self.edge = np.zeros(1)  # (panels + 1,) [rad/s]
        self.series = np.zeros((0, 0, 0), dtype=np.complex128)  # (panels, terms, pairs)
        self.shape: tuple[int, ...] = ()  # of what is asked for at one frequency
        self.lines = 0  # that were solved

    def cover(self, limit: float) -> None:
        """Be ready for frequencies up to a limit [rad/s]."""
        reached = float(self.edge[-1])
        if limit <= reached:
            return
        # what comes is rarely much: a branch passes its limit by a step
        limit = max(limit, 1.25 * reached)
        edges = np.linspace(reached, limit, FIRST + 1 if reached == 0 else FIRST // 4 + 1)
        low, high = edges[:-1], edges[1:]
        kept: list[tuple[Real, Real, Complex]] = []
        for _ in range(HALVINGS):
            series = self._solved(low, high)
            rough = _is_rough(series, np.zeros(len(low)))
            if rough.any():
                known = self.known(_points(low[rough], high[rough])).reshape(-1, TERMS)
                rough[rough] = _is_rough(series[rough], known.max(axis=1))
            kept.append((low[~rough], high[~rough], series[~rough]))
            if not rough.any():
                break
            if rough.sum() > MOST:
                raise SolveError(
                    f"up to {limit / (2 * np.pi):.6g} Hz there are too many resonances for {MOST} "
                    "panels: ask for lower frequencies or a larger tolerance"
                )
            low, high = low[rough], high[rough]
            middle = (low + high) / 2
            low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        else:
            raise _undamped(float(low[0]))
        begin, end, new = (np.concatenate(arrays) for arrays in zip(*kept))
        order = begin.argsort()
        self.edge = np.concatenate([self.edge, end[order]])
        self.series = np.concatenate([self.series, new[order]]) if len(self.series) else new[order]

    def _solved(self, low: Real, high: Real) -> Complex:
        """Return the series on panels."""
        omega = _points(low, high)
        try:
            value = self.ask(omega)
        except SolveError as error:
            if "resonance" not in str(error):
                raise
            raise _undamped(float(low[(high - low).argmin()])) from error
        self.lines += omega.size
        self.shape = value.shape[1:]
        return np.asarray(_rule()[1] @ value.reshape(len(low), TERMS, -1))

    def at(self, omega: Real) -> Complex:
        """Return H at frequencies of any sign, (.., pairs as asked)."""
        panel, basis, _ = self._basis(np.abs(omega).ravel())
        value = np.matmul(basis[:, None, :], self.series[panel])[:, 0]
        value = np.where(omega.ravel()[:, None] < 0, value.conj(), value)
        return np.asarray(value.reshape(*omega.shape, *self.shape))

    def with_slope(self, omega: Real) -> tuple[Complex, Complex]:
        """Return H and dH/domega at frequencies >= 0."""
        panel, basis, stretch = self._basis(omega.ravel())
        both = np.stack([basis, basis @ _rule()[2] * stretch[:, None]], axis=1)
        value = (both @ self.series[panel]).reshape(*omega.shape, 2, *self.shape)
        return value[..., 0, :, :], value[..., 1, :, :]

    def peaks(self) -> Real:
        """Return the edges of panels on which an entry of H is larger than beside them [rad/s]."""
        size = np.abs(self.series).sum(axis=1)
        around = np.pad(size, ((1, 1), (0, 0)))
        top = ((size > around[:-2]) & (size >= around[2:])).any(axis=1)
        return np.unique([self.edge[:-1][top], self.edge[1:][top]])

    def _basis(self, omega: Real) -> tuple[Index, Real, Real]:
        """Return panels, Chebyshev's polynomials there, (f, terms), and their argument's slope."""
        self.cover(float(omega.max(initial=0.0)))
        panel = np.minimum(self.edge.searchsorted(omega, side="right"), len(self.series)) - 1
        low, stretch = self.edge[panel], 2 / (self.edge[panel + 1] - self.edge[panel])
        angle = np.arccos(np.minimum(np.maximum((omega - low) * stretch - 1, -1.0), 1.0))
        return panel, np.cos(np.multiply.outer(angle, np.arange(TERMS))), stretch


def _points(low: Real, high: Real) -> Real:
    """Return where panels are looked at, one after another."""
    return ((low + high)[:, None] / 2 + (high - low)[:, None] / 2 * _rule()[0]).ravel()


def _is_rough(series: Complex, known: Real) -> Flags:
    """Whether the last terms on a panel are neither small nor rounding, (panels,)."""
    size = np.abs(series)
    largest = size.max(axis=1)
    most = largest.max(axis=1, initial=0.0, keepdims=True)
    small = np.maximum(SMALL * np.maximum(largest, FLOOR * most), known[:, None] * most)
    return np.asarray((size[:, -LAST:] > small[:, None]).any(axis=(1, 2)))


def _undamped(omega: float) -> SolveError:
    return SolveError(
        "there is no steady state: motion that is not damped is excited where it begins, and "
        f"stays, near {omega / (2 * np.pi):.6g} Hz; `frf` needs none"
    )
