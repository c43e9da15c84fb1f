"""What corners between samples of a force ring beyond the rates that are looked at.

Of straight lines between samples in even steps h, s^2 f(s) repeats with 2 pi/h: a slow force has
images on both sides of every multiple of it, where a mode may ring. The strongest of them are
followed on a line so near the resonances that what they make is not lost in what grows with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...base.array import Complex, Real
from ...scene.force import Force, Samples, Sum, is_sampled
from .force_transform import transform
from .grid import Grid

STRONGEST = 64  # So many rates of a force have images that are followed,
SEEN, UNSEEN = 0.7, 1.5  # beside multiples from where sums fade to this part of the highest rate,
TURNS = 4  # and so many more.
ALIAS = 0.05  # What is left of motion a period later.


def ringing(force: Force, grid: Grid, order: int, follow: Callable[[Complex], Complex]) -> Real:
    """Return how large a derivative of the images' motion becomes, (responses,).

    `follow` says what the force moves beyond the rates, (responses, n).
    """
    if isinstance(force, Sum):
        parts = [one for one in force.forces if is_sampled(one)]
        return np.asarray(sum(ringing(one, grid, order, follow) for one in parts))
    assert isinstance(force, Samples)
    line = replace(grid, finer=1, a=grid.a + math.log(grid.decay / ALIAS) / grid.period)
    s = line.s[1:]
    repeated = transform(force, line)[1:] * s * s
    size = np.abs(repeated) ** 2
    strong = np.sort(size.argsort()[-STRONGEST:])
    turn = 2 * math.pi * (len(force.time) - 1) / float(force.time[-1] - force.time[0])
    near, far = (share * grid.omega / turn for share in (SEEN, UNSEEN))
    turns = turn * np.arange(max(1, math.floor(near)), math.ceil(far) + TURNS)
    # below and above each multiple: images of -s and s
    at = line.a + 1j * (turns[:, None, None] + np.outer((-1, 1), s[strong].imag))
    beyond = at.imag > SEEN * grid.omega
    at = at[beyond]
    moved = follow(at) * at ** (order - 2)
    moves = np.zeros((len(moved), *beyond.shape), dtype=np.complex128)
    moves[:, beyond] = moved
    spectrum = np.zeros((len(moves), len(line.s)), dtype=np.complex128)
    both = moves[:, :, 0].conj() + moves[:, :, 1]
    spectrum[:, strong + 1] = both.sum(axis=1) * repeated[strong]
    motion = line.finely(spectrum)[:, : grid.steps + 1]
    # what is not followed comes on top, as noise does
    share = size[strong].sum() / max(float(size.sum()), np.finfo(float).tiny)
    return np.asarray(np.abs(motion).max(axis=1) / math.sqrt(share or 1.0))
