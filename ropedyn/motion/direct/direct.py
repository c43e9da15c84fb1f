"""Motion over time by implicit steps along the chain, linear or not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ...base.answer import Cost
from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...base.unit import WIRE
from ...chain.port import is_force
from ..history import Balance, History, ended_by
from ..linear import mesh_error_of
from ..request import Run, why_direct
from .lumped import Lumps, lumped_chains, refuse_model
from .march import stage_of
from .run import Passage
from .steps import covering, march_given, march_within

ENERGIES = (
    "kinetic",
    "strain",
    "input",
    "dissipated",
    "laws",
)  # They are in the order of a passage.
STOPS = (Exception, KeyboardInterrupt)  # May end a march early and leave an answer.


def march(run: Run) -> History:
    """Integrate step by step; see `Model.transient`."""
    why = why_not_march(run)
    if why:
        raise SceneError(why)
    chains = lumped_chains(run)
    g = stage_of(run.spectral_radius)
    passage = march_within(run, chains, g) if run.step is None else march_given(run, chains, g)
    error = passage.error
    if error is not None and (passage.reached == 0 or not isinstance(error, STOPS)):
        raise error
    history = _history(run, chains, passage)
    if error is not None and not run.partial:
        if isinstance(error, SolveError):
            error.history = history
        raise error
    return history


def balance(run: Run) -> Balance:
    """Return the energies of a motion, which steps along the chain account for."""
    return march(replace(run, snapshots=np.zeros(0))).balance


def why_not_march(run: Run) -> str:
    """Say what steps along the chain do not take, with nothing where they take all."""
    if run.is_shaped:
        return 'velocity must be None and start loads where the method is "direct"'
    try:
        refuse_model(run.model)
        refuse_responses(run)
    except SceneError as refusal:
        return str(refusal)
    return ""


def refuse_responses(run: Run) -> None:
    """Refuse what a march does not read."""
    for response in run.responses:
        if response[0] == WIRE:
            raise SceneError('response must not be the tip of a wire where the method is "direct"')
        if is_force(response) and run.order > 0:
            raise SceneError(
                'quantity must be "displacement" where an internal force is asked for and the '
                f'method is "direct", got {response}'
            )


def _history(run: Run, chains: list[Lumps], passage: Passage) -> History:
    kept, seen = slice(passage.reached), slice(passage.seen)
    asked = replace(run.kept, time=run.time[kept], snapshots=run.snapshots[seen])
    value = passage.value[:, kept]
    total = passage.energy[:, kept].sum(axis=0)
    energy = {name: total[:, k].copy() for k, name in enumerate(ENERGIES)}
    if all((lumps.laws.kind == 0).all() for lumps in chains):
        del energy["laws"]
    unknowns = sum(lumps.chain.free for lumps in chains)
    work = passage.stages, passage.factorisations
    mesh_error: Real | Callable[[], Real] = np.full(value.shape, np.inf)
    if not why_direct(run.model):
        mesh_error = partial(mesh_error_of, asked, value)
    return History(
        **asked.told,
        value=value,
        x=run.model.x,
        snapshot=passage.snapshot[seen],
        cost=Cost("direct", len(run.model.x) - 1, unknowns, *work),
        balance=Balance(energy),
        error=partial(_error, asked, value, passage.step_error[:, kept]),
        mesh_error=mesh_error,
        stopped=ended_by(passage.error),
    )


def _error(run: Run, value: Real, step_error: Real) -> Real:
    """Return how far the values are from those without steps."""
    if run.step is None or len(run.time) < 2:
        return step_error
    finer = march_given(run, lumped_chains(run), stage_of(run.spectral_radius), 2).value
    return covering(4 / 3 * np.abs(value - finer))
