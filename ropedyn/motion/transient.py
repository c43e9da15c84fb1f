"""Motion over time and steady states: who answers."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ..base.unit import QUANTITIES
from ..response.frf import FRF, MeshOfResponse
from ..response.harmonic import mesh_of_frf
from .direct.direct import march
from .direct.steady_states import march_steadily
from .history import History
from .modal.steady_states import superpose_steadily
from .modal.superposition import superpose
from .request import Run, SteppedSine, why_direct


def solve_transient(run: Run) -> History:
    """Integrate over time; see `Model.transient`."""
    return march(run) if run.direct else superpose(run)


def solve_stepped_sine(asked: SteppedSine) -> FRF:
    """Step a sine through frequencies; see `Model.stepped_sine`."""
    start = time.perf_counter()
    found = march_steadily(asked) if asked.direct else superpose_steadily(asked)
    seconds = time.perf_counter() - start
    model, f, drives = asked.model, asked.frequency, (asked.drive,)
    quantity, responses = asked.quantity, asked.responses
    value = found.value * (2j * np.pi * f) ** QUANTITIES[quantity]
    mesh: MeshOfResponse | Callable[[], MeshOfResponse]
    mesh = partial(mesh_of_frf, model.scene, f, drives, responses, quantity=quantity, value=value)
    if why_direct(model):
        mesh = MeshOfResponse(np.full(value.shape, np.inf))
    return FRF(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=value,
        rounding_error=found.error,
        cost=replace(found.cost, seconds=seconds),
        mesh=mesh,
    )
