"""Whether a response does not move, of which no rates tell an error relative to its motion."""

from __future__ import annotations

import math

import numpy as np

from ...chain.port import is_force
from ...chain.tip import is_tip
from ...response.moved_end import is_end
from ...scene.damping import having
from ..request import TOLERANCE, Run
from .force_transform import transform
from .grid import Grid

STILL = 1e-9
"""It does not where it is this part of what drive and response could move at most."""


def is_still(run: Run, response: int) -> bool:
    """Whether what moves a response is 0 or adds up to 0 but for rounding, as by symmetry."""
    own = run.responses[response]
    if is_tip(own) or having(run.model.scene.dampings, "ratio") or any(map(is_end, run.places)):
        return False
    transfer = run.look(tuple(run.places), (own,))
    grid = Grid.over(run.time, TOLERANCE, growth=transfer.growth, ahead=math.inf)
    s, force = grid.s[grid.few], np.stack([transform(one, grid)[grid.few] for one in run.as_forces])
    moves = (transfer.at(s)[:, 0] * force).sum(axis=0)
    if is_force(own):  # no force drives it alone: as a moment where the rope is pinned
        most = transfer.rounding(s)[:, 0] * np.abs(force)
        return bool((np.abs(moves) <= most.sum(axis=0)).all())
    itself = [run.look((p,), (p,)).at(s)[0, 0] for p in (*run.places, own)]
    most = np.sqrt(np.abs(itself[:-1]) * np.abs(itself[-1])) * np.abs(force)
    return bool((np.abs(moves) <= STILL * most.sum(axis=0)).all())
