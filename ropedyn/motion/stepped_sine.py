"""Frequency response by motion over time to the steady state, as the 2015 study found it."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Flags, Real
from ..base.errors import SceneError, SolveError
from ..base.progress import reporter
from ..base.unit import QUANTITIES, push_unit
from ..chain.compiled import Compiled
from ..chain.place import observed, points
from ..chain.port import Point
from ..eigen.mesh_error import mesh_of_frf
from ..response.frf import FRF, Mesh
from ..scene.force import Sine
from .modal.convolution import convolve
from .modal.expansion import Share, expand
from .modal.superposition import ratio_beyond
from .transient import is_direct, why_direct

SAMPLES = 16
"""Of a period that the modal method looks at."""

REST = 100.0
"""Of the tolerance, what may be left of free motion where it is estimated from the slowest rate."""

UNSEEN = 1e-11
"""Of the largest residue: a mode at whose node is driven or watched has the rounding of one."""

LATER = 30
"""Times the wait for the steady state is doubled."""


@dataclass(frozen=True, eq=False)
class Steps:
    """What is asked at each frequency."""

    model: Compiled  # that is driven
    frequency: Real  # (f,) in the order they are stepped through [Hz]
    drive: Point  # what moves by, or is pushed with, amplitude cos(omega t)
    amplitude: float  # [N, N m; m, rad of an end]
    responses: tuple[Point, ...]  # what is watched
    tolerance: float  # of the steady state, relative
    progress: Callable[[float], Any]  # takes the fraction that is done


class Steady(NamedTuple):
    """The steady states."""

    value: Complex
    """(responses, f) per amplitude."""
    error: Real
    """(responses, f) estimated relative error."""
    method: str
    unknowns: int
    sweeps: int = 0
    factorisations: int = 0


def solve_stepped_sine(
    model: Compiled,
    frequency: Any,
    *,
    drive: Any,
    amplitude: float,
    response: Any,
    quantity: str,
    method: str,
    tolerance: float | None,
    progress: Any,
) -> FRF:
    """Step a sine through frequencies; see `Model.stepped_sine`."""
    check.one_of(quantity, "quantity", QUANTITIES)
    direct = is_direct(model, method)
    given = check.optional(tolerance, "tolerance", sign="positive")
    point = _driven(model, drive)
    steps = Steps(
        model=model,
        frequency=_stepped(frequency),
        drive=point,
        amplitude=check.number(amplitude, "amplitude", push_unit(point), sign="positive"),
        responses=observed(model, response, (point,)),
        tolerance=given or (DIRECT if direct else MODAL),
        progress=reporter(progress),
    )
    start = clock.perf_counter()
    if direct:
        from .stepped_direct import march_steadily

        found = march_steadily(steps)
    else:
        found = _superpose_steadily(steps)
    return _answer(steps, found, quantity, clock.perf_counter() - start)


def _stepped(frequency: Any) -> Real:
    f = check.frequencies(frequency)
    if not f.min() > 0:
        raise SceneError(f"frequency must be > 0 [Hz], got {float(f.min())!r}: that is `static`")
    return f


def _driven(model: Compiled, drive: Any) -> Point:
    drives, several = points(model, drive, "drive", forces=False, ends=True)
    if several:
        raise SceneError(f"drive must be one point, got {len(drives)}")
    return drives[0]


def _answer(steps: Steps, found: Steady, quantity: str, seconds: float) -> FRF:
    model, f = steps.model, steps.frequency
    value = found.value * (2j * np.pi * f) ** QUANTITIES[quantity]
    drives = (steps.drive,)
    mesh: Mesh | Callable[[], Mesh]
    mesh = partial(
        mesh_of_frf, model.scene, f, drives, steps.responses, quantity=quantity, value=value
    )
    if why_direct(model):
        mesh = Mesh(np.full(value.shape, np.inf))
    return FRF(
        drive=drives,
        response=steps.responses,
        quantity=quantity,
        frequency=f,
        value=value,
        rounding_error=found.error,
        cost=Cost(
            seconds,
            found.method,
            len(model.x) - 1,
            found.unknowns,
            sweeps=found.sweeps,
            factorisations=found.factorisations,
        ),
        mesh_source=mesh,
    )


MODAL, DIRECT = 1e-9, 1e-3
"""Tolerance of the steady state that each method keeps where none is given."""


def amplitudes(value: Real, samples: int) -> Complex:
    """Return the complex amplitudes over each of some periods, shape (responses, periods)."""
    turn = np.exp(-2j * np.pi * np.arange(samples) / samples)
    return np.asarray(2 / samples * (value.reshape(len(value), -1, samples) @ turn))


# --- linear: modes ------------------------------------------------------------------------------


def _superpose_steadily(steps: Steps) -> Steady:
    model, f = steps.model, steps.frequency
    resolved = 2 * math.pi * float(f.max())
    shares = expand(model, [steps.drive], steps.responses, resolved=resolved)
    value = np.zeros((len(steps.responses), len(f)), dtype=np.complex128)
    error = np.zeros(value.shape)
    slowest = min((_slowest(share) for share in shares), default=math.inf)
    for k, one in enumerate(f):
        value[:, k], error[:, k] = _steady(steps, shares, float(one), slowest)
        left_out = _left_out(model, shares, 2 * math.pi * float(one), len(value))
        size = np.abs(value[:, k])
        error[:, k] += np.divide(left_out, size, out=np.zeros_like(size), where=size > 0)
        steps.progress((k + 1) / len(f))
    modes = sum(len(s.expansion.sigma) + len(s.expansion.p) for s in shares)
    return Steady(value, error, "modal", modes)


def _slowest(share: Share) -> float:
    """Return the rate at which the slowest motion that drive and responses share decays [1/s]."""
    e = share.expansion
    seen = _seen(e.a) | _seen(e.b)
    over = np.sqrt(np.maximum(e.sigma**2 - e.square, 0.0))
    # the slow rate of overdamped motion as the product over the fast one
    fast = e.sigma + over
    slow = np.where(over > 0, np.divide(e.square, fast, out=e.sigma.copy(), where=fast > 0), fast)
    single = -e.p[(e.r != 0).any(axis=(0, 1))]
    return float(min(slow[seen].min(initial=math.inf), single.min(initial=math.inf)))


def _seen(residues: Real) -> Flags:
    size = np.abs(residues).max(axis=(0, 1), initial=0.0)
    return np.asarray(size > UNSEEN * size.max(initial=0.0))


def _left_out(model: Compiled, shares: tuple[Share, ...], omega: float, responses: int) -> Real:
    """Return how far modes that are left out move beyond what is static, at most.

    A mode's response is 1/(1 - x^2 + 2 i zeta x) of its static one, x = omega/omega_k. Where
    damping couples modes that motion is estimated: its residues have parts in proportion to x.
    """
    most = np.zeros(responses)
    for share in shares:
        e = share.expansion
        if math.isfinite(e.beyond):
            x = omega / e.beyond
            # what is left out of damped stiffness lags as it does
            zeta = 0.5 if e.b.any() else 0.0 if len(e.p) else ratio_beyond(model, e)
            far = (x**2 + 2 * zeta * x) / (1 - x**2) if x < 1 else math.inf
            most[share.response] += np.where(e.bound[0] > 0, e.bound[0] * far, 0.0)
    return most


def _steady(
    steps: Steps, shares: tuple[Share, ...], frequency: float, slowest: float
) -> tuple[Complex, Real]:
    """Return amplitudes per unit of the drive in the steady state, and their relative error."""
    if not slowest > 0:
        raise SolveError(
            f"frequency {frequency!r} Hz has no steady state: motion that is not damped is excited "
            "where it begins, and stays; `frf` needs none"
        )
    force = Sine(1.0, frequency, phase=math.pi / 2)
    period = 1 / frequency
    wait = math.log(REST / steps.tolerance) / slowest if math.isfinite(slowest) else 0.0
    for _ in range(LATER):
        first = math.ceil(wait / period) * period
        looks = first + period * np.arange(2 * SAMPLES) / SAMPLES
        time = np.append(0.0, looks) if first > 0 else looks
        motion = np.zeros((len(steps.responses), len(time)))
        for share in shares:
            motion[share.response] += convolve(share.expansion, 0, force, time, 0)
        found = amplitudes(motion[:, -2 * SAMPLES :], SAMPLES)
        value = found[:, 1] * np.exp(-2j * np.pi * frequency * first)
        change = np.abs(found[:, 1] - found[:, 0])
        size = np.abs(value)
        if (change <= steps.tolerance * size.max(initial=0.0)).all():
            relative = np.divide(change, size, out=np.zeros_like(size), where=size > 0)
            return value, relative + 16 * np.finfo(float).eps * frequency * (first + period)
        wait = max(2 * wait, period)
    raise SolveError(
        f"frequency {frequency!r} Hz has no steady state after {first:g} s: its amplitude changes "
        f"by {float((change / size.max()).max()):.1e} a period"
    )
