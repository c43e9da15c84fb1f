"""Responses of a component without damping, as a sum over its modes and what that leaves out."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, Self

import numpy as np

from ..base.array import Complex, Real
from ..base.errors import SolveError
from ..chain import tip
from ..chain.compiled import Compiled
from ..chain.port import Point, is_force, moving
from ..response.modal_sum import shift_of, undamped_factors
from ..response.moved_end import is_end, moves_ends
from ..response.question import OnResonance, Question
from ..response.solvers import SOLVERS
from ..scene.damping import INERTIA, having
from ..scene.parts.broken_wire import BrokenWire
from ..scene.parts.part import standing
from ..signal import contour

SOME = 64  # Points are pushed side by side.
MIXED = 4 * np.finfo(float).eps  # Which mode is which is known to this over their distance.
ROUND = 1e-11  # What all modes leave is rounding below this share of what there is.


class Parted(NamedTuple):
    """Responses at z = -s^2 = -shift, and the parts that modes have in them."""

    residue: Real  # (drives, responses, k)
    whole: Real  # (drives, responses)
    soft: Real  # (k,) of each residue, 1/(eigenvalue + shift)
    yields: Callable[[], Real]  # returns the products of what both yield by themselves

    @property
    def rest(self) -> Real:
        """What modes leave of the whole."""
        return np.asarray(self.whole - self.residue @ self.soft)

    @property
    def size(self) -> Real:
        """What modes are without their signs."""
        return np.asarray(np.abs(self.residue) @ np.abs(self.soft))

    @property
    def left(self) -> Real:
        """What is left by all modes: of points that both have no inertia."""
        rest = self.rest
        rest[np.abs(rest) <= ROUND * (np.abs(self.whole) + self.size)] = 0.0
        return np.where(np.abs(rest) > ROUND * self.yields(), rest, 0.0) if rest.any() else rest


@dataclasses.dataclass(frozen=True)
class UndampedResponses:
    """Which transfer functions of one component."""

    model: Compiled
    component: tuple[str, ...]
    drives: list[Any]
    responses: list[Point]

    def at(self, z: Complex) -> Complex:
        """Return them at z = -s^2, shape (drives, responses, n)."""
        model, factor = self.model, np.ascontiguousarray(undamped_factors(z))
        hertz = np.sqrt(np.abs(factor[INERTIA])) / (2 * np.pi)
        asked = tip.spread(model, self.responses)
        question = Question(model, self.component, hertz, factor, self.drives, asked, 1)
        try:
            value, _ = moves_ends(SOLVERS["sweep"])(question)
        except OnResonance as refusal:
            raise SolveError(
                f"modes of ({', '.join(self.component)}) at {refusal.frequency:.9g} Hz lie too "
                "close together for rounding to tell what each of them does"
            ) from None
        if any(map(tip.is_tip, self.responses)):
            value = tip.gather(model, self.responses, factor, value)
        return value

    def own(self, point: Point) -> Self:
        """Return the same of one point, driven there."""
        return dataclasses.replace(self, drives=[point], responses=[point])

    def parted(self, eigenvalue: Real, circles: contour.Circles) -> Parted:
        """Part what modes do from what they leave, by means over circles around eigenvalues."""
        residue = np.zeros((len(self.drives), len(self.responses), len(eigenvalue)))
        if len(eigenvalue):
            residue = -contour.residues(self.at, eigenvalue, circles)
        shift = shift_of(eigenvalue)
        whole, soft = self._at_rest(shift), 1 / (eigenvalue + shift)
        return Parted(residue, whole, soft, partial(self._yields, shift, np.abs(whole)))

    def _at_rest(self, shift: float) -> Real:
        return self.at(np.array([-shift], dtype=np.complex128))[..., 0].real

    def _yields(self, shift: float, whole: Real) -> Real:
        """Return the products of what drives and responses yield by themselves, else the whole."""
        points = [p for p in dict.fromkeys([*self.drives, *self.responses]) if _is_plain(p)]
        own: dict[Any, float] = {}
        softest: dict[str, float] = {}
        for k in range(0, len(points), SOME):
            some = points[k : k + SOME]
            still = dataclasses.replace(self, drives=some, responses=some)._at_rest(shift)
            own |= zip(some, np.sqrt(np.abs(np.diag(still))).tolist())
        for (coordinate, _), one in own.items():
            softest[coordinate] = max(softest.get(coordinate, 0.0), one)
        # an internal force and what the motion of an end takes are stiff where points are soft
        sizes = (
            [own[p] if p in own else 1 / (softest.get(moving(p)) or math.inf) for p in some]
            for some in (self.drives, self.responses)
        )
        product = np.multiply.outer(*sizes)
        return np.where(product > 0, product, whole)

    def bounded(self, left: Callable[[Self], Real]) -> Real:
        """Bound what is left out, (drives, responses), as an inner product; see `own`."""
        # there is no bound of internal forces, tips and motion of ends
        own: dict[Any, float] = {}
        for point in dict.fromkeys([*self.drives, *self.responses]):
            own[point] = np.inf
            if _is_plain(point):
                own[point] = float(np.abs(left(self.own(point))[0, 0]))
        d, r = ([own[point] for point in some] for some in (self.drives, self.responses))
        with np.errstate(invalid="ignore"):
            return np.nan_to_num(np.sqrt(np.multiply.outer(d, r)), nan=np.inf, posinf=np.inf)


def mixed(eigenvalue: Real, circles: contour.Circles, sigma: Real) -> tuple[Real, Real]:
    """Return how far rates of close modes are off, as one may be the other, and the largest."""
    off, most = np.zeros(len(eigenvalue)), np.ones(len(eigenvalue))
    for members in (one for one in circles.outer.members if len(one) > 1):
        value, rate = eigenvalue[members], sigma[members]
        apart, gap = (np.abs(np.subtract.outer(one, one)) for one in (rate, value))
        share = MIXED / (gap / max(np.abs(value).max(), np.finfo(float).tiny) + MIXED)
        off[members] = (apart * share).max(axis=1)
        most[members] = max(float(rate.max()), np.finfo(float).tiny)
    for one in circles.some(circles.innermost).members:
        off[one] = np.maximum(off[one], np.ptp(sigma[one]))
    return off, most


def _is_plain(point: Any) -> bool:
    return not (is_end(point) or is_force(point) or tip.is_tip(point))


def losses_of(model: Compiled) -> list[str]:
    """Name the complex moduli, which have a meaning at each frequency, not in time."""
    losses = [one.kind for one in having(model.scene.dampings, "loss")]
    wires = (part for part in standing(model.scene.parts) if isinstance(part, BrokenWire))
    return losses + ["damping ratio of a broken wire"] * any(one.damping_ratio for one in wires)
