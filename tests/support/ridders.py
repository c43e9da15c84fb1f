"""Derivatives of frequency responses that have no closed form: differences, extrapolated."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ropedyn.base.array import Complex, Real
from ropedyn.base.errors import SceneError
from ropedyn.chain.compile import remeshed, stations_of
from ropedyn.chain.compiled import Compiled
from ropedyn.chain.port import Point
from ropedyn.response.harmonic import solve_harmonic
from ropedyn.scene.path import value_at, with_values
from ropedyn.scene.stations import nearest

WIDEST, SHRINK, LEVELS = 0.02, 4.0, 12
"""The first step over the size of the number, by what it shrinks, and how often at most."""
SETTLED = 1e-6  # An error estimated below this part of the largest derivative may be rounding.


def frf_difference(
    model: Compiled,
    path: str,
    frequency: Real,
    drives: tuple[Point, ...],
    responses: tuple[Point, ...],
) -> Complex:
    """Return the derivative of receptances by Ridders' method."""
    # central differences over ever smaller steps, extrapolated to none; of each line the one that
    # changed least counts. Near resonances of a damping ratio z steps below z of the number are
    # needed; the least is 1e-9 of it
    # C. J. F. Ridders, Accurate computation of F'(x) and F'(x)F''(x), Advances in Engineering
    # Software 4 (1982)
    scene, here = model.scene, value_at(model.scene, path)
    if here == 0:
        raise SceneError(
            f"{path} must not be 0 for a derivative by differences, to both sides of it"
        )
    count = len(stations_of(scene))

    def at(value: float) -> Complex:
        other = with_values(scene, {path: value})
        if len(stations_of(other)) != count:
            raise SceneError(
                f"{path} must be free to change to both sides for a derivative by differences"
            )
        there = remeshed(model, other)
        return solve_harmonic(there, frequency, drive=list(drives), response=list(responses)).value

    def quotient(h: float) -> Complex:
        above, below = here + h, here - h
        return (at(above) - at(below)) / (above - below)

    return _extrapolated(quotient, WIDEST * _free(model, path, here))


def _extrapolated(quotient: Callable[[float], Complex], step: float) -> Complex:
    """Return what difference quotients tend to as their step goes to 0, of each entry the best."""
    best = quotient(step)
    error, row = np.full(best.shape, np.inf), [best]
    for _ in range(LEVELS):
        step /= SHRINK
        last, row, improved = row, [quotient(step)], False
        for k, before in enumerate(last):
            power = SHRINK ** (2 * (k + 1))
            row.append((power * row[k] - before) / (power - 1))
            off = np.maximum(np.abs(row[k + 1] - row[k]), np.abs(row[k + 1] - before))
            better = off < error
            improved |= bool(better.any())
            best = np.where(better, row[k + 1], best)
            error = np.where(better, off, error)
        if not improved and error.max(initial=0.0) <= SETTLED * np.abs(best).max(initial=0.0):
            break
    return best


def _free(model: Compiled, path: str, here: float) -> float:
    """Return the size of a number, of a place how far it is from its neighbours."""
    if path.rsplit(".", 1)[-1] not in ("x", "start", "stop", "length"):
        return abs(here)
    stations = stations_of(model.scene)
    at = int(nearest(stations, [here])[0])
    return float(np.diff(stations)[max(at - 1, 0) : at + 1].min())
