"""A run marched once, from the first time to the last."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Real
from ..request import Run
from .jumps import Onset, onset
from .lumped import Lumps
from .march import DISSIPATED, ENERGIES, INPUT, Motion, Stride
from .timeline import Block, Timeline

BLOCK = 4096  # The core takes so many steps in one call: a look for Ctrl-C.
FINE = 1e-8  # Below this tolerance rounding counts.


@dataclass(eq=False)
class Passage:
    """What a march leaves behind."""

    value: Real  # (responses, t) at the times that were asked for
    # (chains, t, 5) Kinetic, strain; input, dissipated and taken by laws since the first time [J]
    energy: Real
    snapshot: Real  # (s, nodes, coordinates) of the model
    # (2, coordinates) displacement and velocity of any node at the times between calls of the core
    largest: Real
    last: Real  # (nodes, coordinates) displacement where the march ended
    step_error: Real  # (responses, t) estimated, nan where one march does not tell
    reached: int = 0  # how many times were reached
    seen: int = 0  # how many snapshots were
    error: BaseException | None = None  # why not all
    stages: int = 0  # what it took
    factorisations: int = 0  # what it took


class Marching:
    """All chains of a run, led through a timeline together."""

    def __init__(
        self,
        run: Run,
        chains: list[Lumps],
        line: Timeline,
        g: float,
        share: tuple[float, float] = (0.0, 1.0),
    ) -> None:
        width, nodes = len(run.model.coordinates), len(run.model.x)
        self.run, self.line, self.g, self.share = run, line, g, share
        fine = run.tolerance is not None and run.tolerance < FINE
        exact = run.spectral_radius == 1 and (run.step is not None or fine)
        # what is damped forgets the rounding of its steps
        self.motions = [Motion(one, refined=exact and not one.is_damped) for one in chains]
        self.now = np.zeros((len(chains), len(ENERGIES)))
        self.passage = Passage(
            value=np.zeros((len(run.responses), len(run.time))),
            energy=np.zeros((len(chains), len(run.time), len(ENERGIES))),
            snapshot=np.zeros((len(run.snapshots), nodes, width)),
            largest=np.zeros((2, width)),
            last=np.zeros((nodes, width)),
            step_error=np.full((len(run.responses), len(run.time)), np.nan),
        )

    def through(self) -> Passage:
        """March from the first time to the last, or to where something stops it."""
        passage = self.passage
        try:
            self._through()
        except BaseException as error:  # Ctrl-C too: nothing is lost
            passage.error = error
        passage.stages = sum(m.stages for m in self.motions)
        passage.factorisations = sum(m.factorisations for m in self.motions)
        return passage

    def _through(self) -> None:
        line, (begin, end) = self.line, self.share
        self._arrive(0)
        done = 0
        for block in line.blocks(BLOCK):
            strides = [self._advance(m, block) for m in self.motions]
            self._record(block, strides)
            for stride in strides:
                if stride.error is not None:
                    raise stride.error
            if len(block.ends):
                self._arrive(block.first + len(block.ends))
            done += block.steps
            self.run.progress(begin + (end - begin) * done / line.steps)

    def _advance(self, motion: Motion, block: Block) -> Stride:
        line, i, j = self.line, block.first, block.first + len(block.ends)
        after = line.breaks[i] and block.time[0] == line.mark[i]
        before = j > i and line.breaks[j]
        near = 2 * line.near
        edges = (near * after, near * before)
        if motion.late == 0:
            return motion.stride(block.time, block.h, self.g, edges)
        time, late, motion.late = block.time.copy(), motion.late, 0.0
        time[0] += late
        alone = block.steps == 1
        first = motion.stride(time[:2], block.h - late, self.g, (0.0, edges[1] if alone else 0.0))
        if first.error is not None or alone:
            return first
        return first.then(motion.stride(time[1:], block.h, self.g, (0.0, edges[1])))

    def _record(self, block: Block, strides: list[Stride]) -> None:
        """Keep what holds at the times that were asked for."""
        done = min((len(s.read) for s in strides), default=block.steps)
        ends = block.ends[block.ends < done]
        asked = self.line.asked[block.first + 1 : block.first + 1 + len(ends)]
        steps, times = ends[asked >= 0], asked[asked >= 0]
        passage = self.passage
        for k, (motion, stride) in enumerate(zip(self.motions, strides)):
            lumps = motion.lumps
            read = lumps.values(stride.read[steps], block.time[steps + 1], self.run.order)
            passage.value[lumps.number[:, None], times] = read.T
            energy = stride.energy[:done]
            with np.errstate(over="ignore", invalid="ignore"):
                energy[:, INPUT:] = self.now[k, INPUT:] + np.cumsum(energy[:, INPUT:], axis=0)
            passage.energy[k, times] = energy[steps]
            if done:
                self.now[k] = energy[-1]
        if len(times):
            passage.reached = int(times[-1]) + 1

    def _arrive(self, mark: int) -> None:
        """Take what happens at a mark, and keep what is looked at there."""
        line, passage = self.line, self.passage
        if line.breaks[mark] and mark + 1 < len(line.mark):
            for k, motion in enumerate(self.motions):
                self._break(k, motion, mark)
            if line.asked[mark] >= 0:
                passage.reached = int(line.asked[mark]) + 1
        for motion in self.motions:
            state = motion.state
            at = [self.run.model.coordinates.index(c) for c in motion.lumps.coordinates]
            most = np.abs([state.u, state.v]).max(axis=1)
            passage.largest[:, at] = np.maximum(passage.largest[:, at], most)
            passage.last[:, at] = (state.u - motion.late * state.v)[motion.lumps.kept]
        if line.seen[mark] >= 0:
            passage.snapshot[line.seen[mark]] = passage.last
            passage.seen = int(line.seen[mark]) + 1

    def _break(self, k: int, motion: Motion, mark: int) -> None:
        """Take jumps and blows at a mark, and read what holds after them."""
        line, n = self.line, int(self.line.asked[mark])
        what = onset(motion, line, mark)
        if mark == 0 and not motion.rests:
            self.now[k] = what.probe().energy[0] * [1, 1, 0, 0, 0]
        if what.jumps or what.ends.bend.any():
            self._follow(k, what)
        if n >= 0:
            self.passage.value[motion.lumps.number, n] = what.values(self.run.order)
            self.passage.energy[k, n] = self.now[k]

    def _follow(self, k: int, what: Onset) -> None:
        """Let a chain follow at once, and say what that does to its energy."""
        now, before = self.now[k], self.now[k, :INPUT].sum()
        energy = what.happen()
        now[:INPUT] = energy[-1, :INPUT]
        if what.ends.jump.any() or what.ends.bend.any():
            # what it takes to move an end at once has no limit: only what stays counts
            now[INPUT] += now[:INPUT].sum() - before
            return
        now[INPUT:] += energy[:, INPUT:].sum(axis=0)
        # what has no inertia loses the rest
        lost = before + energy[:, INPUT:].sum(axis=0) @ [1, -1, -1] - now[:INPUT].sum()
        now[DISSIPATED] += lost
