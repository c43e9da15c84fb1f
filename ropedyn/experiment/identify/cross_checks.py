"""Tensions by closed formulas of the field, each with its range: cross-checks, no more.

With C = sqrt(B/mu)/L^2 [Hz], xi = L sqrt(T/B) and t = T/(mu L^2) [1/s^2], so that xi = sqrt(t)/C.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.errors import SceneError
from ...scene.rope import Rope

MOST_ORDER = 10_000


@dataclass(frozen=True)
class CrossCheck:
    """What a closed formula says of the tension."""

    name: str
    tension: float | None  # [N]; None where the formula has none
    applies: bool  # whether the rope is in its range, by the tension that it gives
    range_text: str  # its range and the mode it was given, or what is missing
    source: str


class _Told(NamedTuple):
    """What a formula says: t [1/s^2], and the range that counts, or why it says nothing."""

    t: float | None
    text: str
    least: float = 0.0  # of xi


def cross_checks(
    rope: Rope, frequency: ArrayLike, orders: Sequence[int] | ArrayLike
) -> tuple[CrossCheck, ...]:
    """Return the tension by each formula, from frequencies [Hz] and their orders, 0 for none."""
    check.instance(rope, "rope", Rope, "a Rope")
    f = _modes(frequency, orders)
    length, density, stiffness = rope.length, rope.linear_density, rope.bending_stiffness or 0.0
    if isinstance(stiffness, tuple):
        raise SceneError(f"rope must bend alike in both planes, got bending_stiffness {stiffness}")
    c = math.sqrt(stiffness / density) / length**2
    found = []
    for name, source, formula in FORMULAS:
        told = formula(f, c)
        inside = (
            told.t is not None and told.t > 0 and (c == 0 or math.sqrt(told.t) >= told.least * c)
        )
        tension = None if told.t is None or told.t <= 0 else told.t * density * length**2
        found.append(CrossCheck(name, tension, inside, told.text, source))
    return tuple(found)


def _modes(frequency: ArrayLike, orders: Any) -> dict[int, float]:
    """Return the frequency of each mode, by rising order."""
    f = check.numbers(frequency, "frequency", "Hz", sign="positive")
    order = [
        check.count(one, f"orders[{i}]", least=0, most=MOST_ORDER)
        for i, one in enumerate(np.asarray(orders).tolist())
    ]
    if len(order) != len(f):
        raise SceneError(f"orders must be one for each of {len(f)} frequencies, got {len(order)}")
    modes = dict(sorted((n, one) for n, one in zip(order, f.tolist()) if n))
    if not modes or len(modes) < len(order) - order.count(0):
        raise SceneError(f"orders must be different ones from 1, at least one, got {order}")
    return modes


def _lowest(f: dict[int, float]) -> tuple[int, float]:
    return next(iter(f.items()))


def _string(f: dict[int, float], c: float) -> _Told:
    """Return t = (2 f/n)^2."""
    n, one = _lowest(f)
    text = "xi above 210, where clamped ends make it 2 % too large" if c else "no bending stiffness"
    return _Told((2 * one / n) ** 2, f"{text}; mode {n}", 210.0)


def _line(f: dict[int, float], c: float) -> _Told:
    """(2 f/n)^2 = t + C^2 pi^2 n^2, exact of pinned ends: a line through all modes."""
    if len(f) < 2:
        return _Told(None, "needs two modes")
    n, one = np.array(list(f), dtype=np.float64), np.array(list(f.values()))
    t, _ = np.polynomial.polynomial.polyfit(n**2, (2 * one / n) ** 2, 1)
    return _Told(float(t), f"pinned ends, any xi; B from the modes; {len(f)} modes")


def _zui(f: dict[int, float], c: float) -> _Told:
    """Pieces of the first mode, or of the second, or one of higher modes."""
    if not c:
        return _NO_STIFFNESS
    n, one = _lowest(f)
    x = c / one
    pieces = {
        1: [
            (17.0, 4 * (1 - 2.20 * x - 0.550 * x**2)),
            (6.0, 4 * (0.865 - 11.6 * x**2)),
            (3.0, 4 * (0.828 - 10.5 * x**2)),
        ],
        2: [
            (60.0, 1 - 4.40 * x - 1.10 * x**2),
            (17.0, 1.03 - 6.33 * x - 1.58 * x**2),
            (6.0, 0.882 - 85.0 * x**2),
        ],
    }
    several = pieces.get(n, [(200.0, 4 / n**2 * (1 - 2.20 * n * x))])
    return _piece(
        several, one, c, f"clamped ends, little sag, xi above {several[-1][0]:g}; mode {n}"
    )


def _ren(f: dict[int, float], c: float) -> _Told:
    """Pieces of the first mode."""
    if not c:
        return _NO_STIFFNESS
    if 1 not in f:
        return _Told(None, "needs mode 1")
    x = c / f[1]
    stiff = 3.432 - 45.191 * x**2
    several = [(210.0, 4.0), (18.0, max(2 - 2.363 * x, 0.0) ** 2), (10.0, stiff)]
    return _piece(several, f[1], c, "clamped ends, xi above 10; mode 1")


def _piece(several: list[tuple[float, float]], f: float, c: float, text: str) -> _Told:
    """Take the first of t/f^2 by pieces of falling xi that is in its range, or the last."""
    for least, share in several:
        if share > 0 and math.sqrt(share) * f >= least * c:
            break
    return _Told(share * f**2, text, least)


def _mehrabi(f: dict[int, float], c: float) -> _Told:
    """2 f/(n C) = xi + 2 + (4 + n^2 pi^2/2)/xi."""
    if not c:
        return _NO_STIFFNESS
    n, one = _lowest(f)
    half = one / (n * c) - 1
    square = half**2 - 4 - n**2 * math.pi**2 / 2
    text = f"clamped ends, xi above {max(50, 10 * n)}; mode {n}"
    if half <= 0 or square < 0:
        return _Told(None, text)
    return _Told(((half + math.sqrt(square)) * c) ** 2, text, max(50.0, 10.0 * n))


def _fang(f: dict[int, float], c: float) -> _Told:
    """Return t = (omega/gamma)^2 - (C gamma)^2, gamma = n pi + a psi + b psi^2, psi = C/omega."""
    if not c:
        return _NO_STIFFNESS
    n, one = _lowest(f)
    omega = 2 * math.pi * one
    psi = c / omega
    gamma = n * math.pi + (-18.9 + 26.2 * n + 15.1 * n**2) * psi + (290 if n == 1 else 0) * psi**2
    t = (omega / gamma) ** 2 - (c * gamma) ** 2
    return _Told(
        t, f"clamped ends, xi above 10, orders to 10; mode {n}", 10.0 if n <= 10 else math.inf
    )


_NO_STIFFNESS = _Told(None, "needs a bending stiffness")

FORMULAS: tuple[tuple[str, str, Callable[[dict[int, float], float], _Told]], ...] = (
    ("taut string", "Mersenne, Harmonie universelle (1636)", _string),
    ("line of (f/n)^2", "Shimada, Proceedings of JSCE 501 (1994) 163-171", _line),
    ("Zui", "Zui, Shinke, Namita, J. Structural Engineering 122 (1996) 651-656", _zui),
    (
        "Mehrabi-Tabatabai",
        "Mehrabi, Tabatabai, J. Structural Engineering 124 (1998) 1313-1322",
        _mehrabi,
    ),
    ("Ren", "Ren, Chen, Hu, Structural Engineering and Mechanics 20 (2005) 363-380", _ren),
    ("Fang-Wang", "Fang, Wang, J. Bridge Engineering 17 (2012) 161-164", _fang),
)
"""Name, source and formula; of frequencies by order [Hz] and C [Hz]."""
