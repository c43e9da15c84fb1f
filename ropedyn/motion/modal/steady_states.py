"""Steady states under a stepped sine, as sums over modes."""

from __future__ import annotations

import math
import time as clock

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Flags, Real
from ...base.errors import SolveError
from ...chain.compiled import Compiled
from ...response.frf import FRF
from ...scene.force import Sine
from ...signal.spectrum import amplitudes
from ..request import SteppedSine
from .convolution import convolve
from .expansion import Share, expand
from .truncation import ratio_beyond

SAMPLES = 16  # The motion is looked at so many times a period.
REST = 100.0  # Free motion is waited for until less than the tolerance over this is left of it.
UNSEEN = 1e-11  # A mode with a residue below this part of the largest has a node there.
DOUBLINGS = 30  # The wait for the steady state is doubled so often at most.


def superpose_steadily(asked: SteppedSine) -> FRF:
    """Sum modes at each frequency; see `Model.stepped_sine`."""
    start = clock.perf_counter()
    model, f = asked.model, asked.frequency
    resolved = 2 * math.pi * float(f.max())
    shares = expand(model, [asked.drive], asked.responses, resolved=resolved)
    value = np.zeros((len(asked.responses), len(f)), dtype=np.complex128)
    error = np.zeros(value.shape)
    slowest = min((_slowest(share) for share in shares), default=math.inf)
    for k, one in enumerate(f):
        value[:, k], error[:, k] = _steady(asked, shares, float(one), slowest)
        left_out = _left_out(model, shares, 2 * math.pi * float(one), len(value))
        size = np.abs(value[:, k])
        error[:, k] += np.divide(left_out, size, out=np.zeros_like(size), where=size > 0)
        asked.progress((k + 1) / len(f))
    modes = sum(share.expansion.modes for share in shares)
    seconds = clock.perf_counter() - start
    return asked.answer(value, error, Cost(seconds, "modal", len(model.x) - 1, modes))


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
    """Return how far modes that are left out move beyond what is static, at most."""
    # a mode's response is 1/(1 - x^2 + 2 i zeta x) of its static one, x = omega/omega_k. Where
    # damping couples modes that motion is estimated: its residues have parts in proportion to x.
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
    asked: SteppedSine, shares: tuple[Share, ...], frequency: float, slowest: float
) -> tuple[Complex, Real]:
    """Return amplitudes per unit of the drive in the steady state, and their relative error."""
    if not slowest > 0:
        raise SolveError(
            f"frequency {frequency!r} Hz has no steady state: motion that is not damped is excited "
            "where it begins, and stays; `frf` needs none"
        )
    force = Sine(1.0, frequency, phase=math.pi / 2)
    period = 1 / frequency
    wait = math.log(REST / asked.tolerance) / slowest if math.isfinite(slowest) else 0.0
    for _ in range(DOUBLINGS):
        first = math.ceil(wait / period) * period
        looks = first + period * np.arange(2 * SAMPLES) / SAMPLES
        time = np.append(0.0, looks) if first > 0 else looks
        motion = np.zeros((len(asked.responses), len(time)))
        for share in shares:
            motion[share.response] += convolve(share.expansion, 0, force, time, 0)
        found = amplitudes(motion[:, -2 * SAMPLES :], SAMPLES)
        value = found[:, 1] * np.exp(-2j * np.pi * frequency * first)
        change = np.abs(found[:, 1] - found[:, 0])
        size = np.abs(value)
        if (change <= asked.tolerance * size.max(initial=0.0)).all():
            relative = np.divide(change, size, out=np.zeros_like(size), where=size > 0)
            return value, relative + 16 * np.finfo(float).eps * frequency * (first + period)
        wait = max(2 * wait, period)
    raise SolveError(
        f"frequency {frequency!r} Hz has no steady state after {first:g} s: its amplitude changes "
        f"by {float((change / size.max()).max()):.1e} a period"
    )
