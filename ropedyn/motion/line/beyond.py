"""Modes of a chain beyond the rates that are looked at: where they are, and what they may do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...base.array import Complex, Real
from ...base.computed import computed
from ...chain.compiled import part_of
from ...chain.port import moving
from ...eigen.spectrum import numbers_below
from ...scene.force import Force
from ..modal.expansion import Expansion
from ..request import Run
from .at_once import response
from .jumps import excited
from .transfer import TransferFunctions

WIDTH, CLOSEST = 0.01, 1e-4  # Steps are at most so wide over the lowest rate, and wider as its
# root farther away; those with several modes there or beside them are parted down to this,
MOST = 400  # unless there are so many.


@dataclass(frozen=True, eq=False)
class Beyond:
    """Modes from one rate to another that drives move, in steps of rates, at best one in each."""

    run: Run
    transfer: TransferFunctions
    first: float  # [rad/s]
    last: float  # [rad/s]

    def ringing(self, omega: float, fast: Expansion, forces: Sequence[Force]) -> Real:
        """Estimate what modes beyond a rate do that is not done at once, (responses,)."""
        run, (near, value) = self.run, self._looked
        far = near.imag + near.real > omega
        near, moved = near[far], np.abs(value - response(fast, near))[..., far]
        rung = np.stack([excited(one, run.time, near.imag)[run.order] for one in forces])
        share = 2 / math.pi * near.real / near.imag
        return np.asarray(np.einsum("k,dk,drk->r", share, rung, moved))

    @computed
    def _looked(self) -> tuple[Complex, Complex]:
        """Where steps begin, each as far to the right as it is wide, and what transfer is there."""
        model, driven = self.run.model, {moving(place) for place in self.run.places}
        moved = [part_of(model, c) for c in model.components if driven & set(c)]

        def below(rate: Real) -> Real:
            return sum((numbers_below(one, rate**2) for one in moved), np.zeros(len(rate)))

        octaves = np.arange(math.log2(self.last / self.first) + 1)
        edges = np.asarray(self.first * 2.0**octaves)
        count = below(edges)
        top = int(np.argmax(count == count[-1])) + 1
        edges, count = edges[:top], count[:top]
        while True:
            modes, rate, step = np.diff(count), edges[:-1], np.diff(edges)
            few = modes <= MOST  # else so many that they are not counted
            beside = np.concatenate([[0.0], modes, [0.0]])
            crowded = few & (modes > 0) & (beside[:-2] + modes + beside[2:] > 1)  # may cancel
            most = np.where(crowded, CLOSEST, WIDTH) * np.sqrt(rate * self.first)
            part = np.flatnonzero(step > most)
            if not len(part) or len(rate) + len(part) > MOST:
                right = np.asarray(1j * rate + step, dtype=np.complex128)
                return right, self.transfer.at(right)
            middle = rate[part] + step[part] / 2
            counted = np.full(len(part), math.nan)
            counted[few[part]] = below(middle[few[part]])
            edges, count = np.insert(edges, part + 1, middle), np.insert(count, part + 1, counted)
