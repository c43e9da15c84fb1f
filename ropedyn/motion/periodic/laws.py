"""Forces that are not in proportion to motion, as functions of a whole period of it.

The motion u, v of the points is sampled, (points, samples). A force answers with itself and its
slopes df/du and df/dv, (points, points, samples). Several motions stand in front of these shapes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ... import _core
from ...base import check
from ...base.array import Real
from ...base.errors import SolveError
from ..acting import ActingLaw

SMOOTH, BENT = 8, 32  # Samples of a period for each harmonic.
STEP = 1e-6  # Of the largest motion in a period: numerical slopes of a law in Python.
TINY = 1e-150  # Motion is taken for at least this there.
PROBES = 3  # Samples at which a law that takes arrays is held against itself.


class Felt(NamedTuple):
    """Forces over a period and their slopes."""

    force: Real  # (points, samples)
    by_u: Real  # (points, points, samples)
    by_v: Real  # (points, points, samples)


@dataclass(frozen=True, eq=False)
class PointForces:
    """What acts on some points: laws, each on its own, and a tension beside its mean."""

    laws: Sequence[ActingLaw]
    at: Sequence[int]  # the point of each
    points: int
    tension: StringTension | None = None

    @property
    def samples(self) -> int:
        """Of a period for each harmonic: more where forces bend."""
        return BENT if any(one.law.kind in ("stop", "power") for one in self.laws) else SMOOTH

    def force(self, time: Real, u: Real, v: Real) -> Real:
        """Return the forces of motion over a period; laws in Python are not asked for slopes."""
        force = np.zeros(u.shape)
        for one, k in zip(self.laws, self.at):
            moved = time, u[..., k, :], v[..., k, :]
            called = one.law.kind == "call"
            force[..., k, :] += (
                asked_law(one, *moved) if called else KINDS[one.law.kind](one, *moved)[0]
            )
        return force if self.tension is None else force + self.tension.felt(time, u)[0]

    def felt(self, time: Real, u: Real, v: Real) -> Felt:
        """Return them with their slopes."""
        force = np.zeros(u.shape)
        by_u, by_v = np.zeros((2, *u.shape[:-2], self.points, *u.shape[-2:]))
        for one, k in zip(self.laws, self.at):
            f, f_u, f_v = KINDS[one.law.kind](one, time, u[..., k, :], v[..., k, :])
            force[..., k, :] += f
            by_u[..., k, k, :] += f_u
            by_v[..., k, k, :] += f_v
        if self.tension is not None:
            pull, by_pull = self.tension.felt(time, u)
            force, by_u = force + pull, by_u + by_pull
        return Felt(force, by_u, by_v)


Sampled = tuple[Real, Real, Real]
"""The force of one law over a period and its slopes by u and v."""


def _power(one: ActingLaw, time: Real, u: Real, v: Real) -> Sampled:
    """-c |v|^p sign v."""
    c, p = one.law.value
    size = np.abs(v)
    return -c * size**p * np.sign(v), np.zeros_like(u), -c * p * size ** (p - 1)


def _stop(one: ActingLaw, time: Real, u: Real, v: Real) -> Sampled:
    """-side k a where a = side u - gap > 0, on average while a sample stands.

    a changes by 2 w meanwhile. So the force has a slope when contact begins at one more sample.
    """
    k, gap, side = one.law.value
    step = (time[..., 1] - time[..., 0]).reshape(-1)
    u, v = (moves.reshape(-1, moves.shape[-1]) for moves in (u, v))
    force, by_u, by_v = _core.stopped(k, gap, side, step, u, v).reshape(3, *time.shape)
    return force, by_u, by_v


def _call(one: ActingLaw, time: Real, u: Real, v: Real) -> Sampled:
    """Ask a function once, for numerical slopes too."""
    a, b = (STEP * np.maximum(np.abs(moves).max(axis=-1, keepdims=True), TINY) for moves in (u, v))
    both = np.stack([u, u + a, u - a, u, u]), np.stack([v, v, v, v + b, v - b])
    force, more, less, faster, slower = asked_law(one, np.stack([time] * 5), *both)
    return force, (more - less) / (2 * a), (faster - slower) / (2 * b)


def asked_law(one: ActingLaw, time: Real, u: Real, v: Real) -> Real:
    """Return what a law in Python says: asked with arrays where it takes them."""
    call, shape = one.law.call, u.shape
    assert call is not None
    time, u, v = time.ravel(), u.ravel(), v.ravel()
    try:
        with np.errstate(all="ignore"):
            whole: Any = call(time, u, v)  # type: ignore[arg-type]
    except Exception:  # asked one by one it says where
        whole = None
    if isinstance(whole, np.ndarray) and whole.shape == u.shape and whole.dtype.kind == "f":
        probes = range(0, len(u), len(u) // PROBES)
        alone = [_number(one, call, float(time[n]), float(u[n]), float(v[n])) for n in probes]
        same = all(abs(whole[n] - x) <= 1e-12 * abs(x) for n, x in zip(probes, alone))
        if same and np.isfinite(whole).all():
            return whole.reshape(shape)
    each = zip(time.tolist(), u.tolist(), v.tolist())
    return np.array([_number(one, call, *sample) for sample in each]).reshape(shape)


def _number(
    one: ActingLaw, call: Callable[[float, float, float], float], t: float, u: float, v: float
) -> float:
    where = f"{one.name}.law(t={t!r}, u={u!r}, v={v!r})"
    try:
        value = call(t, u, v)
    except Exception as error:
        error.add_note(f"raised by {where}")
        raise
    try:
        return check.number(value, where, "N or N m")
    except (TypeError, ValueError) as error:
        raise SolveError(str(error).replace("must be", "must return")) from error


KINDS: dict[str, Callable[[ActingLaw, Real, Real, Real], Sampled]] = {
    "power": _power,
    "stop": _stop,
    "call": _call,
}


@dataclass(frozen=True, eq=False)
class StringTension:
    """What tension beside its mean does to the transverse motion of nodes.

    The nodes are pushed by -h(t) D^T diag(1/l) D u with D u what each element rises; h is what
    pulsates and EA/2L times the lengthening sum (D u)^2/l.
    """

    length: Real  # (elements,) [m]
    free: Real  # (elements, points) D, of those nodes that can move
    stretching: float  # EA/2L [N/m]
    pulsation: Callable[[Real], Real]  # at times [s]

    def felt(self, time: Real, u: Real) -> tuple[Real, Real]:
        """Return the forces and their slopes."""
        D = self.free
        K = D.T @ (D / self.length[:, None])
        pull = K @ u
        h = self.pulsation(time) + self.stretching * (u * pull).sum(axis=-2)
        by_u = K[..., None] * -h[..., None, None, :]
        by_u -= 2 * self.stretching * pull[..., None, :] * pull[..., None, :, :]
        return -h[..., None, :] * pull, by_u
