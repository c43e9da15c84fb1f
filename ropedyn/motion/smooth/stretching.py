"""A tension that varies and nothing else that couples modes: forces on all modes by collocation.

The forces t G q at the stages of a step are unknown, t = pulsation + EA/(2 L) q^T G q. Newton's
method takes the couplings of G aside from t for what they were: with the diagonal of G each mode
has a system of its own, and t one of the stages.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ..coupled.system import CoupledSystem
from .collocation import STAGES, lagrange, nodes
from .passage import LawPassage, Passed
from .system import OutputTimes

STEPS = 256  # They are kept a block at a time.
MOST = 40  # Newton steps.
ENOUGH, LEAST = 1e-13, 1e-10  # They end here, or here where rounding lets gaps fall no more.


class StretchedPassage(LawPassage):
    """A run with steps of one length at most."""

    system: CoupledSystem

    def through(self, progress: Callable[[float], object]) -> Passed:
        """Take all steps."""
        known = self._known()[:, :, 0]
        k = known.shape[-1]
        state, force, size = np.zeros((2, k)), np.zeros((STAGES, k)), 0.0
        done, before = 0, None
        ahead = lagrange(1 + nodes(STAGES))
        for block in self._blocks(STEPS):
            if block.h != before:
                step = StretchedStep.of(self.system, block.h)
            before = block.h
            states, forces = np.empty((block.number, 2, k)), np.empty((block.number, STAGES, k))
            for i in range(block.number):
                states[i] = state
                q = known[done] + step.free(state)
                guess = ahead @ force if i else force
                added = self.system.added(block.begin + block.h * (i + nodes(STAGES)))
                solved, residual = step.solve(q, guess, added, size)
                if solved is None:
                    when = block.begin + i * block.h
                    error = self._failed(when, residual, None)
                    return Passed(self.looked, self.reached, self.stages, error, settles=False)
                forces[i] = force = solved
                size = max(size, float(np.abs(force).max()))
                state = step.carry(state, force)
                done += 1
            self._look(block, forces, states, done == len(known))
            self.stages = done * STAGES
            progress(done / len(known))
        return Passed(self.looked, float(self.system.time[-1]), done * STAGES)

    def _sees(self, look: OutputTimes, h: float, theta: float) -> tuple[Real, Real]:
        some = self.system.modes.some(slice(0, 0), look.output)
        return some.modal_rows(some.reached(h, theta), look.order, h)


class StretchedStep(NamedTuple):
    """How modes move over a step."""

    form: Real  # (k, k) G
    stretching: float  # EA/L [N/m]
    ahead: Real  # (stages, 2, k) amplitudes at the stages per (q, q') at the beginning
    own: Real  # (k, stages, stages) amplitudes at the stages per forces there
    change: Real  # (2, 2, k)
    pushed: Real  # (stages, 2, k)

    @classmethod
    def of(cls, system: CoupledSystem, h: float) -> StretchedStep:
        """Return that of a length."""
        all_ = [system.modes.reached(h, float(theta)) for theta in nodes(STAGES)]
        own = np.array([one.pushed[:, 0] for one in all_]).transpose(2, 0, 1)
        ahead = np.array([one.change[0] for one in all_])
        own = np.ascontiguousarray(own)
        last = all_[-1]
        return cls(system.form, system.stretching, ahead, own, last.change, last.pushed)

    def free(self, state: Real) -> Real:
        """Return the amplitudes at the stages without forces of this step, (stages, k)."""
        return np.asarray((self.ahead * state).sum(axis=1))

    def carry(self, state: Real, force: Real) -> Real:
        """Return (q, q') at the end."""
        return np.asarray((self.change * state).sum(axis=1) + (self.pushed * force[:, None]).sum(0))

    def solve(self, free: Real, force: Real, added: Real, size: float) -> tuple[Real | None, float]:
        """Return the forces at the stages, (stages, k), or None, and what they are off by.

        `added` is what pulsation adds to the tension there.
        """
        best = worst = np.inf
        inverse = None
        for _ in range(MOST):
            q = free + applied(self.own, force)
            bent = q @ self.form
            tension = added + self.stretching / 2 * (q * bent).sum(axis=1)
            wanted = -tension[:, None] * bent
            gap = wanted - force
            scale = max(size, float(np.abs(wanted).max()), np.finfo(float).tiny)
            worst = float(np.abs(gap).max()) / scale
            if not np.isfinite(worst):
                return None, worst
            if worst <= ENOUGH or (worst <= LEAST and worst >= best / 2):
                return force, worst
            if inverse is None or worst > best / 10:
                inverse = self._inverse(tension)
            best = min(best, worst)
            force = force + self._newton(gap, bent, inverse)
        return None, worst

    def _inverse(self, tension: Real) -> Real:
        """Return (1 + t G_kk own)^-1 of each mode, (k, stages, stages)."""
        own = np.diag(self.form)[:, None, None] * tension[:, None] * self.own
        return np.asarray(np.linalg.inv(np.eye(STAGES) + own), dtype=np.float64)

    def _newton(self, gap: Real, bent: Real, inverse: Real) -> Real:
        """Return the change of the forces, with the changes of t at all stages."""
        plain = applied(inverse, gap)
        right = self.stretching * (bent * applied(self.own, plain)).sum(axis=1)
        left = self.stretching * coupled(bent, self.own @ inverse, bent)
        more = np.linalg.solve(np.eye(STAGES) + left, right)
        return np.asarray(plain - applied(inverse, more[:, None] * bent), dtype=np.float64)


def applied(matrix: Real, stages: Real) -> Real:
    """Return (k, i, j) matrices times (j, k) stages, (i, k)."""
    return np.asarray((matrix @ stages.T[:, :, None])[:, :, 0].T)


def coupled(one: Real, matrix: Real, other: Real) -> Real:
    """Return the sum over k of one_ik matrix_kij other_jk, (i, j)."""
    return np.asarray((one.T[:, :, None] * matrix * other.T[:, None]).sum(axis=0))
