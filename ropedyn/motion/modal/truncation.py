"""How far modes that are left out move from where they would rest under the force of the moment."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...chain.compiled import Compiled
from ...scene.damping import having
from ...scene.force import Chirp, Force, Impulse, Samples, Sine, Step, Sum, rotation
from .expansion import Expansion


class Variation(NamedTuple):
    """How a derivative of a force changes while it acts, from nothing before it."""

    jump: float  # Sum of the magnitudes of its jumps, that from nothing included
    total: float  # Total variation: of the jumps and in between


STILL = Variation(0.0, 0.0)
BLOW = Variation(math.inf, math.inf)


def left_out(
    force: Force, time: Real, bound: Real, beyond: float, order: int = 0, *, ratio: float = 0.0
) -> Real:
    """Bound what modes above an angular frequency add to their static response, as `bound`.

    Infinite where there is no bound, as for a blow at an instant.
    """
    bound = np.asarray(bound, dtype=np.float64)
    reach = departure(force, time, np.array([beyond]), np.array([ratio]), order)[0]
    if reach == 0:  # no force: also where there is no bound
        return np.zeros_like(bound)
    return np.multiply(bound, reach, out=np.zeros_like(bound), where=bound != 0)


def departure(force: Force, time: Real, omega: Real, ratio: Real, order: int = 0) -> Real:
    """Bound how far modes go from a static response of 1, shape (k,).

    With C, the motion of a mode let go at 1, |C| <= 1, and f from rest, by parts

        square q - f = -f(0) C(t) - integral of C(t - s) f'(s) ds,
        |integral of C| <= (2 ratio + sqrt(1 + 4 ratio^2))/omega,

    and so on for derivatives; a sine also by its steady state.
    """
    if isinstance(force, Sum):
        each = [departure(one, time, omega, ratio, order) for one in force.forces]
        return np.asarray(sum(each, np.zeros(len(omega))))
    begin, end = float(time[0]), float(time[-1])
    try:
        variations = [_variation(force, begin, end, k) for k in range(order + 2)]
    except OverflowError:  # a derivative has left the numbers
        return np.full(len(omega), math.inf)
    if any(one.jump > 0 for one in variations[:order]):
        return np.full(len(omega), math.inf)
    now, after = variations[order:]
    lag = (2 * ratio + np.sqrt(1 + 4 * ratio**2)) / omega
    by_parts = np.minimum(now.total, now.jump + lag * after.total)
    if isinstance(force, Sine):
        return np.minimum(by_parts, _steady(force, begin, omega, order, ratio))
    return np.asarray(by_parts)


def _steady(force: Sine, begin: float, omega: Real, order: int, ratio: Real) -> Real:
    """Bound by the steady state's distance and the free motion that begins with it."""
    # with x = (w/omega)^2 the distance is |x - 2 i ratio sqrt(x)|/|1 - x + 2 i ratio sqrt(x)| of
    # the force: it grows with x, and with the ratio grows or falls throughout.
    w = 2 * math.pi * force.frequency
    x = np.minimum((w / omega) ** 2, 1.0)
    lost = 4 * ratio**2 * x
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.maximum(x / (1 - x), np.sqrt((x**2 + lost) / ((1 - x) ** 2 + lost)))
    most = abs(force.amplitude) * w**order
    angle = rotation(force.frequency, begin, force.phase + order * math.pi / 2)
    q, v = abs(math.sin(angle)) + distance, w / omega * (abs(math.cos(angle)) + distance)
    return np.asarray(np.where(x < 1, most * (distance + np.hypot(q, v)), math.inf))


def _variation(force: Force, begin: float, end: float, order: int) -> Variation:
    """Return how a force changes that is differentiated `order` times."""
    if isinstance(force, Sine):
        w = 2 * math.pi * force.frequency
        most = abs(force.amplitude) * w**order
        phase = force.phase + order * math.pi / 2
        jump = most * abs(math.sin(rotation(force.frequency, begin, phase)))
        turn = w * (end - begin)
        return Variation(jump, jump + min(turn, 2 + turn * 2 / math.pi) * most)
    if isinstance(force, Step):
        if force.time > end or force.amplitude == 0:
            return STILL
        return Variation(*2 * (abs(force.amplitude),)) if order == 0 else BLOW
    if isinstance(force, Chirp):
        return _variation_of_chirp(force, begin, end, order)
    if isinstance(force, Samples):
        return _variation_of_samples(force, begin, end, order)
    assert isinstance(force, Impulse)
    return _variation_of_blow(force, begin, end, order)


def _variation_of_chirp(force: Chirp, begin: float, end: float, order: int) -> Variation:
    """Bound the derivatives by the largest frequency and its growth."""
    if begin >= force.duration or force.amplitude == 0:
        return STILL
    last = min(end, force.duration)
    growth = (force.stop - force.start) / force.duration
    w = [2 * math.pi * (force.start + growth * t) for t in (begin, last)]
    c, most = abs(2 * math.pi * growth), max(w)
    size = [1, most, most**2 + c, most**3 + 3 * most * c, most**4 + 6 * most**2 * c + 3 * c**2]
    ends = abs(force.amplitude) * size[order]
    jump = ends * (2 if last < end else 1)
    return Variation(jump, jump + abs(force.amplitude) * size[order + 1] * (last - begin))


def _variation_of_samples(force: Samples, begin: float, end: float, order: int) -> Variation:
    if not force.sample.any():
        return STILL
    if order > 1:
        return BLOW
    first, last = np.searchsorted(force.time, begin, "right"), np.searchsorted(force.time, end)
    corner = np.concatenate([[begin], force.time[first:last], [end]])
    value = np.concatenate(
        [force.value(corner[:1]), force.sample[first:last], force.value(corner[-1:])]
    )
    rise = np.diff(value)
    if order == 0:
        jump = abs(float(value[0]))
        return Variation(jump, jump + float(np.abs(rise).sum()))
    slope = rise / np.diff(corner)
    jump = float(np.abs(slope[0]) + np.abs(np.diff(slope)).sum())
    return Variation(jump, jump)


def _variation_of_blow(force: Impulse, begin: float, end: float, order: int) -> Variation:
    if force.time > end or force.time + force.duration < begin or force.impulse == 0:
        return STILL
    if force.duration == 0:
        return BLOW
    w = math.pi / force.duration
    most = abs(force.amplitude) * w**order
    if force.time < begin:
        return Variation(2 * most, 4 * most)
    return Variation(2 * most, 4 * most) if order % 2 else Variation(0.0, 2 * most)


def ratio_beyond(model: Compiled, expansion: Expansion) -> float:
    """Return the largest damping ratio of the modes that are left out."""
    # (drag + soften lambda)/(2 omega) is at omega' > omega at most omega'/omega of that at omega,
    # and at the rate of a lump of negative inertia that is less at most omega/omega'
    omega = np.sqrt(np.maximum(expansion.square, 0.0))
    ratio = np.divide(expansion.sigma, omega, out=np.zeros_like(omega), where=omega > 0)
    if having(model.scene.dampings, "ratio"):
        return float(ratio.max(initial=0.0))
    if not omega.any() or np.isinf(expansion.beyond):
        return 0.0
    k = int(omega.argmax())
    farther = expansion.beyond / omega[k]
    return float(ratio[k] * max(farther, 1 / farther))
