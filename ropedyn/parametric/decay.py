"""Which periods of the tension let damped motion grow: none can be missed.

Growth begins where a multiplier mu is on the unit circle, and there

    prod_a (1 - mu_a) (1 + mu_a)  prod_{a<b} (1 - mu_a mu_b) = 0,

the factors of real mu, and of mu and its conjugate. The product is real, and as symmetric in the
mu it is an entire function of the period, also where they meet: polynomials are as good as it, and
all of their roots are known.
"""

from __future__ import annotations

import math

import numpy as np

from ..base.array import Complex, Real
from ..motion.modal_system import ModalSystem
from .hill import Hill, Numbers, order_of
from .krein import TAIL, Regions, Unstable
from .monodromy import Propagator

EPS = float(np.finfo(float).eps)
DEGREE = 32
RESOLVED = 1e-8  # The last terms of a polynomial are smaller than this part of the largest.
NOISE = 1e-2  # Where the last terms are this small they are either smooth or rounding.
APART = 4.0  # Roots are told apart that are as many times further from each other than off.
LEAST = 1e-7  # A polynomial is asked for in no smaller part of the period.
MOST, MORE = 512, 4  # So many pieces are open at most, or so many times as many as there were.
ROUNDING = 1e-14  # So is what rounding leaves of it.
BESIDE = 0.1  # A root so far beside the real axis, in parts of half a piece, is looked at too.


def damped(
    system: ModalSystem, between: tuple[float, float], amplitude: float, least: float, looked: Real
) -> Regions:
    """Find where motion of coupled modes grows by more than a least ln|multiplier|."""
    low, high = between
    motion = Propagator.of(system, low, high, amplitude)
    place, resolved = _places(motion)
    place = np.unique(np.clip(np.concatenate([place, looked, [low, high]]), low, high))
    place = np.union1d(place, (place[1:] + place[:-1]) / 2)
    grows = _growth(motion, place) > least
    at = np.flatnonzero(grows[1:] != grows[:-1])
    edge = [_edge(motion, place[i], place[i + 1], least) for i in at]
    order = [_order(system, amplitude, motion, one) for one in edge]
    if grows[0]:
        edge, order = [low, *edge], [0, *order]
    if grows[-1]:
        edge, order = [*edge, high], [*order, 0]
    unstable = list(map(Unstable, edge[::2], edge[1::2], order[::2], order[1::2]))
    return Regions(unstable, 0, resolved and motion.tail < TAIL)


def _places(motion: Propagator) -> tuple[Real, bool]:
    """Return periods at and next to which a multiplier is on the circle; whether these are all."""
    begin, end = motion.edge[:-1], motion.edge[1:]
    angle = np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1)
    series = np.cos(np.arange(DEGREE + 1)[:, None] * angle)
    series[0] /= 2
    place, resolved, before = [motion.edge], True, np.ones(len(begin))
    while len(begin):
        middle, half = (begin + end) / 2, (end - begin) / 2
        period = middle[:, None] + half[:, None] * np.cos(angle)
        coefficient = _product(motion, period) @ series.T
        size = np.abs(coefficient)
        tail = size[:, -3:].max(axis=1) / size.max(axis=1)
        smooth = tail < RESOLVED
        # where halving a piece gains nothing rounding is what is left
        rough = ~smooth & ((half < LEAST * middle) | (tail < NOISE) & (tail > before / 4))
        # all of it may be, as where motion that nothing damps goes beside what is damped
        rough |= ~smooth & (2 * np.count_nonzero(~smooth) > max(MOST, MORE * len(motion.edge)))
        resolved &= not rough.any()
        rest = ~smooth & ~rough
        for piece in np.flatnonzero(~rest):
            root = np.polynomial.chebyshev.chebroots(coefficient[piece])
            near = root[(np.abs(root.imag) < BESIDE) & (np.abs(root.real) < 1 + BESIDE)]
            small = half[piece] < LEAST * middle[piece]
            if rough[piece] or small or _are_apart(coefficient[piece], near):
                place.append(middle[piece] + half[piece] * near.real)
            else:  # a smaller piece knows them better
                rest[piece] = True
        begin = np.concatenate([begin[rest], middle[rest]])
        end = np.concatenate([middle[rest], end[rest]])
        before = np.tile(tail[rest], 2)
    return np.concatenate(place), resolved


def _are_apart(coefficient: Real, root: Complex) -> bool:
    """Whether roots of a polynomial are further from each other than each is off."""
    chebyshev, size = np.polynomial.chebyshev, np.abs(coefficient)
    wrong = max(size[-3:].max(), ROUNDING * size.max())
    slope = np.abs(chebyshev.chebval(root, chebyshev.chebder(coefficient)))
    bend = np.abs(chebyshev.chebval(root, chebyshev.chebder(coefficient, 2))) / 2
    # slope e + bend e^2 = wrong
    off = 2 * wrong / (slope + np.sqrt(slope**2 + 4 * bend * wrong) + np.finfo(float).tiny)
    apart = np.abs(root[:, None] - root) + np.diag(np.full(len(root), np.inf))
    return bool((apart > APART * (off[:, None] + off)).all())


def _product(motion: Propagator, period: Real) -> Real:
    """Return the product over periods, shape (pieces, nodes), beside the largest of each piece."""
    value = np.linalg.eigvals(motion(period.ravel()))
    one, other = np.triu_indices(value.shape[1], 1)
    factor = np.hstack([1 - value[:, one] * value[:, other], 1 - value**2])
    with np.errstate(divide="ignore"):
        size = np.log(np.abs(factor)).sum(axis=1).reshape(period.shape)
    turn = np.angle(factor).sum(axis=1).reshape(period.shape)
    return np.asarray(np.cos(turn) * np.exp(size - size.max(axis=1, keepdims=True)))


def _growth(motion: Propagator, period: Real) -> Real:
    with np.errstate(divide="ignore"):
        return np.log(np.abs(np.linalg.eigvals(motion(period))).max(axis=1))


def _edge(motion: Propagator, begin: float, end: float, least: float) -> float:
    """Return where growth begins or ends between two periods."""
    from scipy.optimize import brentq

    def beyond(period: float) -> float:
        return float(_growth(motion, np.array([period]))[0]) - least

    # a root may be one of the two periods, but for rounding
    first, last = beyond(begin), beyond(end)
    if first * last >= 0:
        return begin if abs(first) < abs(last) else end
    return float(brentq(beyond, begin, end, xtol=EPS * begin, rtol=4 * EPS))


def _order(system: ModalSystem, amplitude: float, motion: Propagator, period: float) -> int:
    """Return the order of the tongue at whose edge a period is."""
    value = np.linalg.eigvals(motion(np.array([period]))[0])
    phase = float(np.angle(value[np.abs(value).argmax()]))
    hill = Hill.of(system, amplitude, period)
    nu = phase / (2 * math.pi)
    rate = 2j * math.pi / period * (hill.harmonic + nu)
    column: Numbers = np.random.default_rng(0).normal(size=(len(rate) * len(system.eigenvalue), 1))
    for _ in range(4):
        column = np.linalg.qr(hill.solve(rate, column))[0]
    return order_of(rate, column, nu)
