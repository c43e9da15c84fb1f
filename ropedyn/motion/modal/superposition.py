"""Motion over time as a sum over modes, each of them exact."""

from __future__ import annotations

import dataclasses
import math
import time as clock
from collections.abc import Callable
from functools import partial

import numpy as np

from ...base.answer import Cost
from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...base.progress import silent
from ...chain.compile import compile_scene
from ...eigen.vectors import within
from ...response.deflection import POINTS
from ..history import Deviation, History
from ..request import Run
from .convolution import motion_under
from .energy_balance import balance
from .expansion import Share, expand
from .truncation import left_out, ratio_beyond

WAVE = 8  # Times resolve a period of so many samples.


def superpose(run: Run) -> History:
    """Sum up the modes of a linear model; see `Model.transient`."""
    start = clock.perf_counter()
    resolved = _fastest(run)
    shares = expand(run.model, run.places, run.responses, modes=run.modes, resolved=resolved)
    value = _responses(run, shares, len(run.responses))
    x, snapshot = _snapshots(run, resolved)
    seconds = clock.perf_counter() - start
    truncation = _truncation(run, shares)
    modes = sum(share.expansion.modes for share in shares)
    run = run.kept
    deviation: Deviation | Callable[[], Deviation] = partial(_deviation, run, value)
    if run.model.element == "continuous":
        deviation = Deviation(np.zeros(value.shape), np.zeros(value.shape))
    return History(
        **run.told,
        value=value,
        truncation_error=truncation,
        x=x,
        snapshot=snapshot,
        cost=Cost(seconds, "modal", len(run.model.x) - 1, modes),
        balance=partial(balance, run, resolved),
        deviation=deviation,
    )


def _fastest(run: Run) -> float:
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


def _snapshots(run: Run, resolved: float) -> tuple[Real, Real]:
    """Return where the rope is looked at, and its motion, (s, nodes, coordinates)."""
    model = run.model
    x = within(model.x, POINTS) if model.element == "continuous" else model.x
    width = len(model.coordinates)
    if len(run.snapshots) == 0:
        return x, np.zeros((0, len(x), width))
    points = [(c, float(at)) for at in x for c in model.coordinates]
    shares = expand(model, run.places, points, modes=run.modes, resolved=resolved, bound=False)
    time = np.unique(np.append(run.time[0], run.snapshots))
    looks = dataclasses.replace(run, time=time, order=0, progress=silent)
    kept = _responses(looks, shares, len(points))[:, len(time) - len(run.snapshots) :]
    return x, np.ascontiguousarray(kept.T).reshape(-1, len(x), width)


def _deviation(run: Run, value: Real) -> Deviation:
    """Return how far exact steps are from the motion of continuous spans."""
    return Deviation(np.zeros(value.shape), mesh_error(run, value))


def mesh_error(run: Run, value: Real) -> Real:
    """Return the distance to the motion of continuous spans and the error of that, as value."""
    try:
        model = compile_scene(run.model.scene)
        true = superpose(dataclasses.replace(run, model=model, modes=None, snapshots=np.zeros(0)))
    except (SceneError, SolveError):
        return np.full(value.shape, np.inf)
    return np.asarray(np.abs(value - true.value) + true.truncation_error[:, None])
