"""All roots of a characteristic function within a circle, each of them isolated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Complex, Real
from .characteristic import Characteristic
from .winding import Winding

MOST_STEPS = 30  # The simultaneous iteration takes so many steps at most.
CLOSE = 1e-7  # A step of this part of the mean distance of roots ends the iteration.
MOST_TRIES = 6  # Where roots are missing the iteration begins anew so often at most.
MOST_MOMENTS = 6  # So many missing roots at most have their places guessed from moments.
SAMPLES = 16  # The circle around a cluster has so many points for each root in it.
CIRCLE = 0.03
"""Radius of a circle in distances to the next root: what lies outside shows as powers of it."""
NOISE = 8.0  # Noise of roots in units of the last quarter of a series, where nothing else is left.
CENTERED = 0.05
"""The mean of the roots lies within this part of the radius from the middle of a circle."""
INNER = 0.7  # Each root lies within this part of the radius from the middle of a circle.
MOST_CIRCLES = 4
APART = (1e-6, 1e-4, 1e-2)
"""Roots nearer than this part of the distance to others are a cluster, in one try after another."""
TOGETHER = 0.1
"""Roots nearer than this part of their mean distance are one in any case."""
REAL = 1e-6  # An imaginary part below this part of the mean distance of roots may be rounding.


@dataclass(frozen=True)
class Roots:
    """Roots within a circle, of conjugate pairs the one above the real axis."""

    value: Complex  # (n,) [rad/s]
    error: Real  # (n,) estimated absolute error [rad/s]
    certified: bool  # whether circles around them surround as many as the whole circle does


def find_roots(function: Characteristic, within: Winding, guess: Complex) -> Roots:
    """Find all roots within a circle."""
    if within.count == 0:
        return Roots(np.zeros(0, dtype=np.complex128), np.zeros(0), True)
    spacing = 2 * within.radius / within.count
    random = np.random.default_rng(within.count)
    found = np.zeros(0, dtype=np.complex128)
    guess = guess[np.abs(guess) < within.radius]
    for _ in range(MOST_TRIES):
        inside = found[np.abs(found) < within.radius]
        missing = within.count - len(inside)
        if missing <= 0:
            break
        if len(found) > 0 and missing <= MOST_MOMENTS:
            guess = within.radius * _from_moments(within.moments(inside, missing))
        more = random.uniform(size=missing) ** 0.5 * within.radius
        more = more * np.exp(2j * np.pi * random.uniform(size=missing))
        begin = np.concatenate([guess, more])[:missing]
        guess = guess[:0]
        found = np.concatenate([found, _iterate(function, begin, found, spacing)])
        if within.paired:
            found = _completed(found, REAL * spacing)
    return _isolate(function, found, within, spacing)


def _completed(root: Complex, tolerance: float) -> Complex:
    """Add what is missing of conjugate pairs."""
    above, below = root[root.imag > tolerance], root[root.imag < -tolerance].conj()
    more = []
    for has, lacks in ((above, below), (below, above)):
        left = list(lacks)
        for one in has:
            distance = np.abs(np.array(left) - one)
            if len(left) > 0 and distance.min() < tolerance:
                left.pop(int(distance.argmin()))
            else:
                more.append(np.conj(one) if has is above else one)
    return np.concatenate([root, np.array(more, dtype=np.complex128)])


def _iterate(function: Characteristic, begin: Complex, fixed: Complex, spacing: float) -> Complex:
    """Return the roots, other than fixed ones, that several approximations find."""
    # by Ehrlich's and Aberth's steps: with Newton's w = f/f' and all others repelling,
    # z <- z - w/(1 - w sum 1/(z - z_j)), of third order for single roots; no two find the same
    z = begin + spacing * 1e-3 * np.exp(1j * np.arange(len(begin)))
    h = 1e-5 * spacing
    active = np.arange(len(z))
    for _ in range(MOST_STEPS):
        at = z[active]
        value, magnitude = function(np.stack([at, at + h, at - h]))
        scaled = value * np.exp(np.minimum(magnitude - magnitude[0], 600.0))
        slope = (scaled[1] - scaled[2]) / (2 * h)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = scaled[0] / slope
            apart = at[:, None] - np.concatenate([z, fixed])[None, :]
            apart[np.arange(len(active)), active] = np.inf
            step = newton / (1 - newton * (1 / apart).sum(axis=1))
        step = np.where(np.isfinite(step), step, spacing * 0.1)
        step *= np.minimum(1.0, 4 * spacing / np.maximum(np.abs(step), 1e-300))
        moved = at - step
        far = np.abs(moved) > 0.999 * function.reach
        moved[far] *= 0.9 * function.reach / np.abs(moved[far]) * np.exp(0.3j)
        z[active] = moved
        active = active[(np.abs(step) > CLOSE * spacing) | far]
        if len(active) == 0:
            break
    return np.delete(z, active)


def _isolate(function: Characteristic, root: Complex, within: Winding, spacing: float) -> Roots:
    """Draw a circle around each root or cluster, and see that it surrounds as many."""
    wanted = np.abs(root) < within.radius
    if within.paired:
        wanted &= root.imag >= -REAL * spacing
    for apart in APART:
        clusters = _clusters(root[wanted], root[~wanted], spacing, apart)
        roots = _settle_all(function, clusters, within, REAL * spacing)
        if roots.certified:
            break
    return roots


def _settle_all(
    function: Characteristic,
    clusters: list[tuple[Complex, float]],
    within: Winding,
    tolerance: float,
) -> Roots:
    values, errors = [np.zeros(0, dtype=np.complex128)], [np.zeros(0)]
    surrounded = 0
    for member, gap in clusters:
        # what lies beyond the circle is not known
        room = min(gap, within.radius - np.abs(member).max())
        settled = _settle(function, member, room)
        if settled is None:
            continue
        values.append(settled[0])
        errors.append(settled[1])
        pair = within.paired and member.mean().imag > tolerance
        surrounded += len(member) * (2 if pair else 1)
    return Roots(np.concatenate(values), np.concatenate(errors), surrounded == within.count)


def _clusters(
    inside: Complex, outside: Complex, spacing: float, apart: float
) -> list[tuple[Complex, float]]:
    """Return the members of each cluster and the distance to what is not in it."""
    everything = np.concatenate([inside, outside])
    distance = np.abs(everything[:, None] - everything[None, :])
    group = np.arange(len(everything))
    i, j = np.triu_indices(len(everything), 1)
    near = distance[i, j]
    for k in np.argsort(near, kind="stable"):
        if near[k] > apart * spacing:
            break
        a, b = group[i[k]], group[j[k]]
        both = (group == a) | (group == b)
        gap = distance[np.ix_(both, ~both)].min(initial=spacing)
        if near[k] <= max(apart * gap, TOGETHER * apart * spacing):
            group[group == b] = a
    found = []
    for g in np.unique(group[: len(inside)]):
        own = group == g
        gap = float(distance[np.ix_(own, ~own)].min(initial=spacing))
        found.append((everything[own], gap))
    return found


def _settle(function: Characteristic, member: Complex, gap: float) -> tuple[Complex, Real] | None:
    """Return the roots of a cluster and their errors, from moments of f'/f on a circle."""
    # None where the circle does not surround as many
    count = len(member)
    samples = SAMPLES * count
    turn = np.exp(2j * np.pi * np.arange(samples) / samples)
    for _ in range(MOST_CIRCLES):
        center = member.mean()
        radius = CIRCLE * min(gap, function.reach - abs(center))
        value, magnitude = function(center + radius * turn)
        scaled = value * np.exp(magnitude - magnitude.max())
        moments = _moments(scaled, turn, count)
        if moments is None:
            return None
        offset = _from_moments(moments)
        member = center + radius * offset
        tail = np.fft.fft(scaled)[-samples // 4 :] / samples
        noise = NOISE * float(np.sqrt(np.mean(np.abs(tail) ** 2)) / np.abs(scaled).min())
        noise = max(noise, function.rounding / float(np.abs(value).min()))
        error = radius * _spread(offset, noise) + 4 * np.finfo(float).eps * np.abs(member)
        if np.abs(offset.mean()) < CENTERED and np.abs(offset).max() < INNER:
            return member, error
    return None


def _moments(value: Complex, turn: Complex, count: int) -> Complex | None:
    """Return sums of powers 1 .. count of the roots within the unit circle."""
    # the function's Taylor series from its values on the circle, t f'/f there, and its moments.
    # None where it does not surround as many
    change = np.angle(np.roll(value, -1) / value)
    if np.abs(change).max() > 2.0 or round(float(change.sum()) / (2 * np.pi)) != count:
        return None
    samples = len(value)
    series = np.fft.fft(value) / samples
    slope = np.fft.ifft(series * np.arange(samples)) * samples
    relative = slope / value
    powers = turn[None, :] ** np.arange(1, count + 1)[:, None]
    return np.asarray((powers * relative).mean(axis=1))


def _from_moments(moments: Complex) -> Complex:
    """Return numbers from the sums of their powers, by Newton's identities."""
    coefficient = [1.0 + 0.0j]
    for k in range(1, len(moments) + 1):
        total = sum(coefficient[k - i] * moments[i - 1] for i in range(1, k + 1))
        coefficient.append(-total / k)
    return np.roots(coefficient).astype(np.complex128)


def _spread(root: Complex, noise: float) -> Real:
    """Return how far roots move where all coefficients of their polynomial change by `noise`."""
    # of a root with others at distances d it is noise over their product, and never more than the
    # root of its order
    count = len(root)
    spread = np.full(count, noise ** (1 / count))
    distance = np.abs(root[:, None] - root[None, :])
    for _ in range(3):
        wide = np.maximum(distance, spread[:, None])
        np.fill_diagonal(wide, 1.0)
        spread = np.minimum(spread, noise / wide.prod(axis=1))
    return spread
