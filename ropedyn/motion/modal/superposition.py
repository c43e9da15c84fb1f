"""Motion over time as a sum over modes, each of them exact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...base.array import Real
from ...scene.force import Force, peak
from ..moved import Moved
from ..request import TOLERANCE, Run
from .convolution import motion_under
from .expansion import Expansion, Share, expand
from .truncation import departure, left_out, ratio_beyond

RESIDUES = 4e-12  # Residues are known to so much of the largest value.
PHASES = 2048 * np.finfo(float).eps  # Phases are known to this for each rad of the fastest mode,
SMALL = 0.1  # or better where that is more than this part of the tolerance.
EPS = 4 * np.finfo(float).eps  # Times are rounded by this, and so is each step.
SHARES, TIMES, AROUND = (0.5, 0.7, 0.85), 3.0, 4
"""So much fewer modes tell the error, this many times over, within so many steps."""
WAVE = 8  # Times resolve a period of so many samples.


def superpose(run: Run) -> Moved:
    """Sum up the modes of a linear model; see `Model.transient`."""
    shares = expand(run.model, run.places, run.responses, modes=run.modes, resolved=fastest(run))
    value = _responses(run, shares, len(run.responses))
    rounding, modes = _rounding(run, shares, value), sum(one.expansion.modes for one in shares)
    error = np.add(_truncation(run, shares)[:, None], rounding)
    return Moved(value, error, "modal", modes=modes, rounding=rounding)


def estimated(run: Run, moved: Moved) -> Moved:
    """Return the same where fewer modes tell the error, if that is less than its bound."""
    fewer = [superpose(replace(run, modes=max(1, int(part * moved.modes)))) for part in SHARES]
    return moved._replace(error=np.minimum(moved.error, apart(moved, fewer)))


def apart(moved: Moved, fewer: Sequence[Moved]) -> Real:
    """Return the error that sums of fewer modes tell, shape as their values."""
    from scipy.ndimage import maximum_filter1d

    distance = np.max([np.abs(moved.value - one.value) for one in fewer], axis=0)
    return np.asarray(TIMES * maximum_filter1d(distance, 2 * AROUND + 1, axis=-1) + moved.rounding)


def fastest(run: Run) -> float:
    """Return the highest angular frequency that forces have or times resolve [rad/s]."""
    resolved = 2 * math.pi / WAVE * (len(run.time) - 1) / float(run.time[-1] - run.time[0])
    return max([resolved, *(2 * math.pi * force.bandwidth for force in run.forces)])


def _responses(run: Run, shares: tuple[Share, ...], count: int) -> Real:
    """Return what all forces and loads move together, shape (count, t)."""
    value = np.zeros((count, len(run.time)))
    for done, share in enumerate(shares):
        for k, d in enumerate(share.drive):
            value[share.response] += motion_under(
                share.expansion, k, run.pushes[d], run.time, run.order
            )
            run.progress((done + (k + 1) / len(share.drive)) / len(shares))
    return value


def _truncation(run: Run, shares: tuple[Share, ...]) -> Real:
    """Bound what the modes cause that are left out, shape (responses,)."""
    error = np.zeros(len(run.responses))
    for share in shares:
        expansion = share.expansion
        ratio = ratio_beyond(run.model, expansion)
        for k, d in enumerate(share.drive):
            own, one = expansion.bound[k], run.pushes[d]
            if not own.any() or one == 0.0:
                continue
            if isinstance(one, float):  # let go, they swing about 0
                most = own * abs(one) if run.order == 0 else np.full(len(own), np.inf)
                error[share.response] += np.where(own > 0, most, 0.0)
            else:
                most = left_out(one, run.time, own, expansion.beyond, run.order, ratio=ratio)
                error[share.response] += np.nan_to_num(most, nan=np.inf, posinf=np.inf)
    return error


def _rounding(run: Run, shares: tuple[Share, ...], value: Real) -> Real:
    """Estimate what rounding does to value: the phases of modes drift with time, shape as value."""
    # as of the fastest, which assembled matrices do not tell better, unless that is too much
    most, since = np.abs(value).max(axis=1, initial=0.0), run.time - run.time[0]
    each = [
        (share, k, sizes(share.expansion, k, run.pushes[d], run.time, run.order))
        for share in shares
        for k, d in enumerate(share.drive)
    ]
    size = np.zeros(len(most))
    for share, _, one in each:
        size[share.response] += one.sum(axis=1)
    # where modes cancel, as until a wave arrives, they round by what each of them is
    still = RESIDUES * np.maximum(most, size)
    fastest = max(
        (np.abs(share.expansion.square).max(initial=0.0) for share in shares), default=0.0
    )
    rough = PHASES * math.sqrt(fastest) * most
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    told = not any(np.any(share.expansion.mixed) for share in shares)
    if told and (rough * since[-1] <= SMALL * tolerance * most).all():
        return np.asarray(still[:, None] + np.multiply.outer(rough, since))
    return np.asarray(still[:, None] + _drifted(run, each, most, since))


def _drifted(run: Run, each: list[tuple[Share, int, Real]], most: Real, since: Real) -> Real:
    """Estimate how far the phases of modes drift, each by its own eigenvalue's error."""
    span, late = float(since[-1]), float(np.abs(run.time[[0, -1]]).max())
    shaken, drift, whole = np.zeros((3, len(most)))
    for share, k, size in each:
        modes, r = share.expansion, share.response
        omega = np.sqrt(np.abs(modes.square))
        slip = omega * modes.wrong / 2 + modes.mixed
        memory = 1 / np.maximum(modes.sigma, 1 / span)
        # a mode moves no more than all do, but for those that cancel
        seen = np.maximum(most[r, None], size)
        moving = np.minimum(_departing(run, modes, k, run.pushes[share.drive[k]]), seen)
        shaken[r] += EPS * moving @ (late * omega + len(since))
        drift[r] += moving @ slip
        whole[r] += moving @ (slip * memory)
    slipped = np.minimum(np.multiply.outer(drift, since), whole[:, None])
    return np.asarray(shaken[:, None] + slipped)


def sizes(modes: Expansion, drive: int, push: Force | float, time: Real, order: int) -> Real:
    """Return how large modes are without their signs, off resonance, (responses, k)."""
    span = float(time[-1] - time[0])
    if isinstance(push, float):
        pushes, blow = abs(push), 0.0
    else:
        pushes = peak(push, time)
        blow = sum(abs(size) for at, size in push.blows if time[0] <= at <= time[-1])
    each = [
        pushes * _reach(modes.square, span, order + n, 2)
        + blow * _reach(modes.square, span, order + n, 1)
        for n in range(2)
    ]
    return np.asarray(np.abs(modes.a[drive]) * each[0] + np.abs(modes.b[drive]) * each[1])


def _departing(run: Run, modes: Expansion, drive: int, push: Force | float) -> Real:
    """Bound how far modes move from their static response, (responses, k), or infinite."""
    swings = modes.square > 0
    omega, square = np.sqrt(modes.square[swings]), modes.square[swings]
    ratio = modes.sigma[swings] / omega
    far = np.full(modes.a[drive].shape, math.inf)
    far[:, swings] = 0.0
    for size, order in ((modes.a, run.order), (modes.b, run.order + 1)):
        own = np.abs(size[drive][:, swings]) / square
        if own.any():
            if isinstance(push, float):
                most = abs(push) * omega**order
            else:
                most = departure(push, run.time, omega, ratio, order)
            far[:, swings] += np.multiply(own, most, out=np.zeros_like(own), where=own > 0)
    return far


def _reach(square: Real, span: float, order: int, smooth: int) -> Real:
    """Return how far a derivative of modes goes: 2 omega^(order - smooth), less for short times.

    Under a force of 1, with smooth = 2, or after a blow of 1, with smooth = 1.
    """
    left = smooth - order
    omega = np.sqrt(np.abs(square))
    with np.errstate(divide="ignore"):
        far = 2 * omega**-left
    return np.asarray(np.minimum(far, span**left) if left >= 0 else far)
