"""Linear motion of any damping by inversion of its exact transfer functions on a line Re s = a.

    y(t) = e^(a t)/P sum over k of W_k y(s_k) e^(2 pi i k t/P),   s_k = a + 2 pi i k/P,

of y(s) = s^order H(s) f(s) without what it does at once (at_once.py): that is added in closed form.
W = exp(-36 (omega/Omega)^p) ends the sum smoothly. The error is told by sums that end earlier.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...base.array import Complex, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...base.unit import MOTIONS
from ...eigen.damped.rates import Rates
from ...scene import damping
from ...scene.force import Force, is_sampled, peak
from ..modal.convolution import convolve
from ..modal.expansion import Expansion
from ..moved import Moved
from ..request import Run
from .at_once import LOOKS, at_once, at_once_by, response
from .beyond import Beyond
from .force_transform import transform
from .grid import LEAST, Grid, off
from .images import ringing
from .jumps import jumps, largest
from .still import is_still
from .transfer import TransferFunctions

SHARES = {0.5: 1.2, 0.7: 2.8, 0.85: 4.0}
"""Sums that end at this part of the rates tell the error, so many times over,"""
AROUND = 4  # where they differ most within so many steps.
SHARP = 20  # p.
TIMES = 2.0  # What modes beyond the rates do is told so many times over.
LAST = 8  # What is left beyond the rates is told by the last of so many parts of them.
FADED = 0.8  # Modes beyond this part of the highest rate are not summed in full.
DEAD = 0.3  # Modes beyond the rates whose stiffness lags by more [rad] do not ring.
ALIAS = 8.0  # A period later motion may be so much larger,
GROWN = 2.0  # where it grows by at most so much after the record.
ROUGH = 1e-3  # Else it is looked at for two periods, with this alias,
FAR_LARGER = 10.0  # as where slow rates tell of motion so much larger after both.
ROUNDED = 33  # Rounding is bounded at so many of the rates that are looked at together.
MOST_NUMBERS = 1 << 23  # Lines times pairs of drives and responses, at most.
PEAK = 4.0  # Rates share some of their rounding: the sum is so many times the root of squares.
EPS = 16 * np.finfo(float).eps
FAR, LEAST_FAR = 1e4, 1e2  # So many times the highest rate of the times no mode of a chain is left,
# and so many times that of the sum: what is infinite there is.
GROWS = 2.0**0.25  # What grows by this with the rate has no bound
STRONG = 1e-3  # where it is more than this part of the largest value.
SOON = 1e-6  # What jumps is there from so much before on, over the rate far beyond all modes.
LOST = 10.0  # Times the tolerance: an error that twice the rates rarely mend.
FINE, FIRST = 1e-5, 4  # So fine a tolerance is rarely reached by fewer times the times' rates.
REACH = 4.0  # They reach so many times as far as the forces do, at first.


def invert(run: Run, tolerance: float) -> Moved:
    """Return the motion, of as many rates as it takes to be within the tolerance."""
    line = Line.of(run, tolerance)
    still = np.zeros(len(run.responses), dtype=np.bool_)
    asked = still.copy()

    def late(moved: Moved) -> Real:
        """Return what errors are of responses that move."""
        share = moved.shares(run)
        lost = np.flatnonzero(~(share <= 1) & ~asked)
        still[lost], asked[lost] = [is_still(run, int(r)) for r in lost], True
        return np.asarray(np.where(still, 0.0, share))

    while True:
        with np.errstate(all="ignore"):  # numbers that are not finite are refused
            moved = line.motion()
        if not np.isfinite(moved.value).all():
            raise SolveError("the numbers overflow: check the units and the times")
        # rounding is asked for where nothing else is in the way
        share = late(moved)
        if (share <= tolerance).all() or not line.reaches(2):
            moved = line.rounded(moved)
            if (late(moved) <= tolerance).all() or not line.reaches(2):
                line.refuse_infinite(moved)
                return moved
        # what is still but for rounding tells nothing of rates
        worst = share[np.isfinite(share)].max(initial=0.0)
        line = line.further(4 if worst > LOST * tolerance and line.reaches(4) else 2)


@dataclass(frozen=True, eq=False)
class Line:
    """Transfer functions at the rates of a grid."""

    run: Run
    transfer: TransferFunctions
    forces: tuple[Force, ...]
    grid: Grid
    beyond: Beyond  # what is beyond the least of the highest rates
    value: Complex  # (drives, responses, lines + 1)
    slow: Complex  # (drives, responses, n) at the slow rates
    parts: tuple[slice, ...]  # of the lines, one after another, that were looked at together

    @classmethod
    def of(cls, run: Run, tolerance: float) -> Line:
        """Look at as many as the times resolve, and at twice as many under blows at an instant."""
        forces = run.as_forces
        omega = 2 * math.pi * REACH * max((f.bandwidth for f in forces), default=0.0)
        # whose responses are not small up to where the sum ends
        least = 2 if any(force.blows for force in forces) else 1
        least = least if tolerance > FINE else FIRST
        transfer = run.look(tuple(run.places), run.responses)
        rates = {"growth": transfer.growth, "ahead": transfer.ahead}
        grid = Grid.over(run.time, tolerance, **rates, omega=omega, least=least)
        end = max(FAR / grid.finer, LEAST_FAR)
        beyond = Beyond(run, transfer, FADED * grid.omega, end * grid.omega)
        parts = (slice(0, len(grid.s)),)
        both = np.append(grid.s, grid.slow.s[grid.slow.few])
        value, slow = np.split(transfer.at(both), [len(grid.s)], axis=2)
        return cls(run, transfer, forces, grid, beyond, value, slow, parts)

    def further(self, times: int) -> Line:
        """Look so many times as far."""
        grid = replace(self.grid, finer=times * self.grid.finer)
        more = self.transfer.at(grid.s[len(self.grid.s) :])
        parts = (*self.parts, slice(len(self.grid.s), len(grid.s)))
        value = np.concatenate([self.value, more], axis=2)
        return replace(self, grid=grid, value=value, parts=parts)

    def reaches(self, times: int) -> bool:
        """Whether rates so many times as far can be looked at."""
        lines, numbers = times * self.grid.lines, times * self.value.size
        most = self.transfer.most(times * self.grid.omega, self.grid.count // 2)
        return numbers <= MOST_NUMBERS and lines <= most

    def motion(self) -> Moved:
        """Return the motion, its error without rounding."""
        grid, run, order = self.grid, self.run, self.run.order
        fast, *_, smooth = self._smooth
        value, differ, later = self._summed(smooth)
        value += self._resting()
        for d, one in enumerate(self.forces):
            value += convolve(fast, d, one, run.time, order)
        alias = ALIAS * self.grid.decay * later
        # modes beyond the rates, where none is near their end, are seen by what they do there
        last = np.median(np.abs(smooth[:, -(grid.lines // LAST) :]), axis=1)
        alias += grid.omega / math.pi * last + TIMES * (self._unseen() + self._images())
        error = differ + alias[:, None] + self._at_jumps(fast)
        return Moved(value, error, "line", lines=grid.lines)

    def rounded(self, moved: Moved) -> Moved:
        """Return the motion with what rounding adds to its error."""
        grid, (_, held, force, _) = self.grid, self._smooth
        wrong = _rounding(self.transfer, grid.s, self.value, self.parts) + EPS * np.abs(held)
        wrong = np.einsum("drk,dk->rk", wrong, np.abs(force))
        # transforms are rounded as those of forces that do not alternate
        most = np.array([peak(one, self.run.time) for one in self.forces])
        unsure = EPS / 4 * np.multiply.outer(most, np.abs(grid.s) ** (self.run.order - 1))
        wrong += np.einsum("drk,dk->rk", np.abs(self.value), unsure)
        wrong = PEAK * np.sqrt((wrong**2).sum(axis=1)) / grid.period
        grown = np.exp(grid.a * (self.run.time - grid.begin))
        return moved._replace(error=moved.error + np.multiply.outer(wrong, grown))

    @computed
    def _smooth(self) -> tuple[Expansion, Complex, Complex, Complex]:
        """What transfer functions do at once, also at the rates, forces, and motion without it."""
        looked = self._far[..., : len(LOOKS)]
        fast = at_once(looked, self.grid.omega, self.value[..., 0])
        force = np.stack([transform(one, self.grid) for one in self.forces])
        force *= self.grid.s**self.run.order
        held = response(fast, self.grid.s)
        return fast, held, force, np.einsum("drk,dk->rk", self.value - held, force)

    def _at_jumps(self, fast: Expansion) -> Real:
        """Bound what is wrong at the instant when something jumps on a chain, (responses, t).

        What strong damping holds is there at once as seen from the highest rate.
        """
        run, s = self.run, self._afar[-1]
        wrong = np.zeros((len(run.responses), len(run.time)))
        if not self._is_chain:
            return wrong
        seen = at_once_by(fast)
        far = self._far[..., -2:]
        # what goes as 1/s^m there is m times smoother than the force
        power = np.rint(np.log2(np.abs(far[..., 0]) / np.abs(far[..., 1])))

        def apart(d: int, n: int) -> Real:
            truly = np.where(power[d] == n, (far[d, :, 1] * s**n).real, 0.0)
            return np.where(power[d] < n, 0.0, np.abs(seen[d, :, n] - truly))

        for d, force in enumerate(self.forces):
            for when, *sizes in jumps(force, run.time):
                since = run.time - when
                at = (since >= -SOON / abs(s)) & (since <= 1 / self.grid.omega)
                for n, jump in enumerate(sizes, run.order - 1):
                    if jump and 0 <= n < seen.shape[-1]:
                        wrong += np.multiply.outer(apart(d, n) * abs(jump), at)
            if run.order and is_sampled(force):
                slope = force.rate(run.time)
                corner = np.abs(np.diff(slope, prepend=slope[0]))
                wrong += np.multiply.outer(apart(d, run.order - 1), corner)
        return wrong

    @property
    def _is_chain(self) -> bool:
        return self.run.model.element != "continuous"

    @property
    def _afar(self) -> Complex:
        """Rates beyond the highest, the last two where modes of a chain are over."""
        omega = self.grid.omega
        end = np.array([max(self.beyond.last, LEAST_FAR * omega)] * self._is_chain)
        looks = np.append(omega * LOOKS, np.multiply.outer(end, LOOKS[-2:]))
        return np.asarray(looks, dtype=np.complex128)

    @computed
    def _far(self) -> Complex:
        """The transfer functions there."""
        try:
            return self.transfer.at(self._afar)
        except SolveError as refusal:
            raise SolveError(
                "what acts at once has no correct digit far beyond the rates that times resolve"
            ) from refusal

    def _unseen(self) -> Real:
        """Estimate what modes of a chain beyond the rates do under the forces, (responses,)."""
        run, omega = self.run, self.grid.omega
        lag = omega * float(Rates.of(run.model.scene.dampings).linear.real[: damping.INERTIA].max())
        if not self._is_chain or lag > DEAD:
            # modes of spans are dense, damped ones over at once
            return np.zeros(len(run.responses))
        return self.beyond.ringing(FADED * omega, self._smooth[0], self.forces)

    def _images(self) -> Real:
        """Return what corners between samples ring beyond the rates, (responses,)."""
        found = np.zeros(len(self.run.responses))
        for d, one in enumerate(self.forces):
            if is_sampled(one):
                found += ringing(one, self.grid, self.run.order, partial(self._rest, drive=d))
        return found

    def _rest(self, s: Complex, drive: int) -> Complex:
        """Return what a drive moves but for what is there at once, (responses, n)."""
        alone = self.run.look((self.run.places[drive],), self.run.responses)
        return np.asarray(alone.at(s)[0] - response(self._smooth[0], s)[drive])

    def refuse_infinite(self, moved: Moved) -> None:
        """Refuse by name what has no bound, as velocity where a blow at an instant hits a beam."""
        if self._is_chain and self.run.model.chain.finite is not None:
            return  # what jumps without inertia has its value from the right
        run, s = self.run, self._afar[-2:]
        far = self._far[..., -2:]
        for d, (place, force) in enumerate(zip(run.places, self.forces)):
            for more, size in enumerate(largest(force, run.time)):
                reach = np.abs(far[d] * s ** (run.order + more))
                grows = reach[:, 1] > GROWS * reach[:, 0]
                seen = size * reach[:, 1] > STRONG * np.abs(moved.value).max(axis=1)
                for r in np.flatnonzero(grows & seen):
                    raise SceneError(
                        f'quantity must not be "{list(MOTIONS)[run.order]}" of '
                        f"{run.responses[r]}, which is infinite when what acts at {place} "
                        f"{('jumps', 'is a blow at an instant')[more]}"
                    )

    def _resting(self) -> Real:
        """Return the deflection under the loads that are let go, (responses, 1)."""
        count = len(self.run.loads)
        if not count or self.run.order:
            return np.zeros((len(self.run.responses), 1))
        try:
            still = self.transfer.at(np.zeros(1, dtype=np.complex128))
        except SolveError as refusal:
            raise SceneError(
                "start must be None where the rope has no rest under a load"
            ) from refusal
        loads = np.array(list(self.run.loads.values()))
        return np.asarray(loads @ still[-count:, :, 0].real)[:, None]

    def _summed(self, smooth: Complex) -> tuple[Real, Real, Real]:
        """Return the sum at the times, how far earlier sums are, and how large it grows."""
        from scipy.ndimage import maximum_filter1d

        grid = self.grid
        share = (np.arange(grid.lines + 1) / grid.lines) ** SHARP
        # one by one: rounding would depend on how many are transformed together
        whole, *earlier = (
            grid.finely(smooth * np.exp(-36 / end**SHARP * share)) for end in (1.0, *SHARES)
        )
        apart = (times * np.abs(one - whole) for one, times in zip(earlier, SHARES.values()))
        differ = np.max(list(apart), axis=0)
        # few times are far apart
        steps = AROUND * min(1.0, grid.steps / LEAST)
        around = max(2 * AROUND, math.ceil(steps * grid.finer))
        differ = maximum_filter1d(differ, 2 * around + 1, axis=-1)
        later = self._later(np.abs(whole), differ)
        since = grid.time - grid.begin
        if grid.even:
            even = slice(0, len(since) * grid.finer, grid.finer)
            value = whole[:, even].copy()
            # motion goes on for as long as times are off
            goes = off(grid.time) * np.abs(np.diff(value, axis=1)).max(axis=1, keepdims=True)
            return value, differ[:, even] + goes, later
        at = np.rint(since * (2 * grid.lines / grid.period)).astype(np.intp)
        ended = smooth * np.exp(-36 * share)
        return grid.summed(ended, since), differ[:, at], later

    def _later(self, size: Real, differ: Real) -> Real:
        """Return how large motion becomes from a period after the record begins, (responses,)."""
        grid = self.grid
        # lumps of negative inertia move before what moves them: before the next period
        after = (grid.count - grid.steps) // (4 if math.isfinite(grid.ahead) else 1)
        size, differ = (one[:, : (grid.steps + after) * grid.finer] for one in (size, differ))
        most, later = size.max(axis=1, initial=0.0), self._seen_slowly()
        record, wrong = (
            one[:, : grid.steps * grid.finer + 1].max(axis=1, initial=0.0) for one in (size, differ)
        )
        grows = (size - differ).max(axis=1, initial=0.0) > GROWN * record
        comes = (later > FAR_LARGER * most) & (ALIAS * grid.decay * later > wrong)
        if not (grows | comes).any():
            return np.maximum(most, later)
        # it has hardly begun, as where a wave has not arrived
        slower = grid.a + (math.log(self.grid.decay) - math.log(ROUGH) / 2) / grid.period
        twice = replace(grid, count=2 * grid.count, a=slower, finer=1)
        line = replace(self, grid=twice, value=self.transfer.at(twice.s))
        ends = np.exp(-36 * np.linspace(0.0, 1.0, twice.lines + 1) ** SHARP)
        following = slice(twice.lines, twice.lines + grid.steps + after)
        found = np.abs(twice.finely(line._smooth[-1] * ends))[:, following]
        return np.maximum.reduce([most, found.max(axis=1), grid.decay * later])

    def _seen_slowly(self) -> Real:
        """Estimate how large motion ever becomes, (responses,): |s y(s)| of a sine or a step."""
        slower = self.grid.slow
        force = np.stack([transform(one, slower)[slower.few] for one in self.forces])
        force *= slower.s[slower.few] ** (self.run.order + 1)
        return np.abs(np.einsum("drk,dk->rk", self.slow, force)).max(axis=1)


def _rounding(
    transfer: TransferFunctions, s: Complex, value: Complex, parts: tuple[slice, ...]
) -> Real:
    """Bound what rounding does to values at many rates by what it does at some of each part."""
    some = [np.linspace(k.start, k.stop - 1, ROUNDED).astype(np.intp) for k in parts]
    at = np.unique(np.concatenate(some))
    size = np.abs(value)
    bound = transfer.rounding(s[at])
    share = np.divide(bound, size[..., at], out=np.zeros_like(bound), where=size[..., at] > 0)
    # a part of the value, as where it is large, and a part that is there where it is not
    part = np.minimum(share[..., 1:], share[..., :-1])
    floor = np.maximum(bound[..., 1:], bound[..., :-1])
    width = np.diff(at)
    width[-1] += 1
    return np.asarray(np.repeat(part, width, axis=-1) * size + np.repeat(floor, width, axis=-1))
