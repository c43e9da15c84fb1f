"""A component under smooth laws: its modes, its laws, and what moves it without them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from ...base.array import Flags, Real
from ...chain.port import Point, moving
from ...scene.force import Force
from ..acting import ActingLaw
from ..line.jumps import jumps
from ..modal.convolution import motion_under
from ..modal.expansion import Expansion
from ..modal.superposition import sizes
from ..request import Run
from ..states import States, states
from .collocation import Oscillating
from .laws import slopes

LEAST = 32  # A run has so many steps at least,
PER_PERIOD = 4  # and a period of the lowest mode, and of what pushes, so many.
ROUNDING = 1e-12  # Of the largest value of a force, what is left of one that ends at 0.
SEEN = 256  # Runs are compared at so many times at least.


class OutputTimes(NamedTuple):
    """When outputs are asked for."""

    output: slice
    time: Real  # (t,) [s]
    order: int


@dataclass(frozen=True, eq=False)
class LawSystem:
    """A component: its modes, its laws, and what moves it without them."""

    laws: list[ActingLaw]
    modes: Oscillating  # of inputs at the laws' points; outputs there come first
    driven: list[Expansion]  # of each drive: the same outputs
    pushes: list[Force | float]  # of each drive
    time: Real  # (t,) [s]
    looks: list[OutputTimes]
    beyond: float  # lowest angular frequency that is left out [rad/s]

    @classmethod
    def of(
        cls,
        run: Run,
        component: tuple[str, ...],
        laws: list[ActingLaw],
        outputs: list[Point],
        *,
        looks: list[OutputTimes],
        count: int,
    ) -> LawSystem:
        """Find the modes; looks are at the outputs."""
        n, drive = len(laws), [k for k, p in enumerate(run.places) if moving(p) in component]
        points = [one.point for one in laws]
        inputs = [*points, *(run.places[k] for k in drive)]
        found = states(run.model, component, inputs, [*points, *outputs], modes=count)
        return cls(
            laws,
            oscillating(found, n),
            [expansion(found, n + k) for k in range(len(drive))],
            [run.pushes[k] for k in drive],
            run.time,
            [look._replace(output=shifted(look.output, n)) for look in looks],
            found.beyond,
        )

    def looking_between(self) -> tuple[Self, slice]:
        """Return the same whose first look has more times where it has few, and which are its own.

        At a few times two runs agree by chance.
        """
        time = self.looks[0].time
        if not 1 < len(time) < SEEN or self.jumps:
            return self, slice(None)
        parts = math.ceil(SEEN / (len(time) - 1))
        index = np.arange(len(time), dtype=np.float64)
        more = np.interp(np.arange(parts * (len(time) - 1) + 1) / parts, index, time)
        looks = [one._replace(time=more) if one.time is time else one for one in self.looks]
        return replace(self, looks=looks), slice(None, None, parts)

    def looking(self, time: Real) -> LawSystem:
        """Return the same that looks at other times too, at what the first look sees."""
        until = max(float(self.time[-1]), float(time[-1]))
        whole = np.append(self.time, until) if until > self.time[-1] else self.time
        looks = [*self.looks, self.looks[0]._replace(time=time)]
        return replace(self, time=whole, looks=looks)

    @property
    def points(self) -> slice:
        """Outputs that are the laws' points."""
        return slice(len(self.laws))

    @property
    def is_sharp(self) -> bool:
        """Whether some law jumps or bends where velocities turn or contact begins."""
        return False

    @property
    def jumps(self) -> bool:
        """Whether what is looked at jumps, sooner in one run than in another: accelerations."""
        return self.is_sharp and self.looks[0].order == 2

    def held(self, points: Sequence[Point], _largest: Real) -> Flags:
        """Say which points laws hold, whose forces have been so large [N]."""
        return np.zeros(len(points), dtype=np.bool_)

    @property
    def falls(self) -> float:
        """By how much half the step divides errors at least, where two runs may agree by chance."""
        return math.inf

    @property
    def finer(self) -> float:
        """How much shorter the steps of the next run are."""
        return 2.0

    @property
    def breaks(self) -> list[float]:
        """When what drives jumps or bends [s]."""
        return [at for one in self.pushes if not isinstance(one, float) for at in one.breaks]

    def pushed_at_once(self, since: float, until: float) -> bool:
        """Whether a force jumps between two times."""
        for one in self.pushes:
            if not isinstance(one, float):
                at, _, jump, _ = jumps(one, self.time[[0, -1]]).T
                size = np.abs(one.value(self.time)).max(initial=np.abs(jump).max())
                if (np.abs(jump[(at >= since) & (at <= until)]) > ROUNDING * size).any():
                    return True
        return False

    @property
    def first_step(self) -> float:
        """The longest step to begin with [s]."""
        omega = np.sqrt(self.modes.square[self.modes.square > 0])
        highest = [one.highest for one in self.pushes if not isinstance(one, float)]
        fastest = max([float(omega.min(initial=np.inf)) / (2 * np.pi), *highest])
        span = float(self.time[-1] - self.time[0]) / LEAST
        return min(span, 1 / (PER_PERIOD * fastest)) if np.isfinite(fastest) else span

    def linear(self, rows: slice, time: Real, order: int) -> Real:
        """Return what drives move, without laws, (rows, t)."""
        value = np.zeros((len(self.modes.seen[rows]), len(time)))
        for one, push in zip(self.driven, self.pushes):
            a, b, rest, late = (each[:, rows] for each in one[2:6])
            some = one._replace(a=a, b=b, rest=rest, late=late)
            value += motion_under(some, 0, push, time, order)
        return value

    def sizes(self) -> Real:
        """Return how large modes are where no law acts, without their signs, first look, (o, k)."""
        look = self.looks[0]
        each = [
            sizes(one, 0, push, self.time, look.order)[look.output]
            for one, push in zip(self.driven, self.pushes)
        ]
        return np.asarray(sum(each, np.zeros((look.output.stop - look.output.start, 1))))

    def unmoved(self, h: float, size: Real) -> Real:
        """Return how far laws change all modes that steps are too long for, first look, (o,).

        Their motion has such a size (3, laws). Shorter steps see as little of it, up to a radian of
        each mode.
        """
        omega = np.sqrt(np.abs(self.modes.square))
        fast = omega * h > 1
        if np.isfinite(self.beyond) or not (fast.any() and size.size):
            return np.zeros(1)
        each = [slopes(law.law, self.time, one) for law, one in zip(self.laws, size.T)]
        stiff, damps = np.abs(np.array(each)).T
        push = self.modes.push[fast, : len(self.laws)] ** 2
        rate = push @ damps / 2 + push @ stiff / (2 * omega[fast])
        lost = np.zeros(len(omega))
        lost[fast] = np.minimum(1.0, rate * (self.time[-1] - self.time[0]))
        sizes = self.sizes()
        return np.asarray(sizes @ lost[: sizes.shape[1]])

    def told(self, looked: list[Real]) -> list[Real]:
        """Return what is asked for of what was looked at."""
        return looked

    def without_laws(self) -> list[Real]:
        """Return what each look sees where no law acts, (outputs, t)."""
        begin = float(self.time[0])
        seen = []
        for look in self.looks:  # motion begins at the first time
            late = len(look.time) == 0 or look.time[0] > begin
            time = np.append(begin, look.time) if late else look.time
            seen.append(self.linear(look.output, time, look.order)[:, int(late) :])
        return seen


def shifted(rows: slice, by: int) -> slice:
    """Return rows further down."""
    return slice(rows.start + by, rows.stop + by)


def oscillating(found: States, laws: int) -> Oscillating:
    """Return the modes as laws push them; what is left out follows as a mode of its lowest."""
    count, inputs = found.modes, slice(laws)
    # of all modes only rounding is left
    now = found.now[:, inputs] * np.isfinite(found.beyond)
    late = found.late[:, inputs]
    lag = 1 / found.gamma if found.gamma else 0.0
    beyond = found.beyond if now.any() else 0.0
    more = laws * (bool(now.any()) + bool(late.any()))
    sigma, square = np.zeros(more), np.zeros(more)
    seen, swept = np.zeros((len(found.seen), more)), np.zeros((len(found.seen), more))
    at = 0
    if now.any():
        sigma[:laws] = found.ratio * beyond + (found.drag + found.gamma * beyond**2) / 2
        square[:laws], seen[:, :laws] = beyond**2, now * beyond**2
        at = laws
    if late.any():  # 1/(1 + gamma s) as two equal rates, one of which is taken away again
        sigma[at:], square[at:] = lag, lag**2
        seen[:, at:], swept[:, at:] = late * lag**2, late * lag
    push = np.zeros((count + more, laws))
    push[:count] = found.push[:, inputs]
    push[count:] = np.tile(np.eye(laws), (more // max(laws, 1), 1))
    return Oscillating(
        np.append(found.sigma, sigma),
        np.append(found.square, square),
        push,
        np.concatenate([found.seen, seen], axis=1),
        np.concatenate([found.swept, swept], axis=1),
    )


def expansion(found: States, which: int) -> Expansion:
    """Return what one input moves as an expansion of one drive."""
    push, lead = found.push[:, which], found.lead[which]
    return Expansion(
        sigma=found.sigma,
        square=found.square,
        a=(found.seen * push)[None],
        b=((found.swept + lead * found.seen) * push)[None],
        rest=found.now[None, :, which],
        late=found.late[None, :, which],
        lag=found.gamma,
    )
