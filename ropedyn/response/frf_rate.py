"""Derivatives of a frequency response with respect to numbers of the scene.

The dynamic stiffness Z(omega) is symmetric, damped or not. So with the motion u_d that a drive
causes and the motion u_r that a unit load on the response would, the receptance h has

    dh/dp = -u_r^T (dZ/dp) u_d,

and nothing is solved again. What stands at a place needs the motion there. A span adds to Z the
form of which its Hamiltonian H is the density, see hamiltonian.py: with y = (u, f)

    dh/dp = integral of y_r^T (dH/dp) y_d dx.

As far as there is no load y_r^T H y_d is the same everywhere. Where a place between two spans
moves, dh/dx is what it is on the left less what it is on the right.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.array import Complex, Real
from ..base.check import NEAR
from ..base.computed import computed
from ..base.errors import SceneError
from ..base.unit import END, QUANTITIES, WIRE
from ..chain.compile import dragged
from ..chain.compiled import Compiled
from ..chain.port import Point, is_force, moving
from ..chain.rate import ENTRIES, Places, Rate, Weights, asked, rates_of
from ..scene import damping
from ..scene.damping import Damping, ModalDamping
from ..scene.parts.stretch import KINDS as STRETCHES
from .frf import FRF
from .hamiltonian import Span, hamiltonian_rate
from .harmonic import solve_harmonic
from .products import Loaded, Products, driven
from .ridders import frf_difference

TENSION, LENGTH, SAG = 6, 7, 8
"""Numbers of these weights of an element, behind the entries of its section."""


@dataclass(frozen=True, eq=False)
class FrequencyRates:
    """How a frequency response changes."""

    model: Compiled  # that was asked
    frequency: Real  # (f,) [Hz]
    drives: tuple[Point, ...]  # that were asked for
    responses: tuple[Point, ...]  # that were asked for

    @computed
    def places(self) -> Places:
        """Where spans and stations are."""
        return Places(self.model)

    @computed
    def loaded(self) -> Loaded:
        """The spans and the unit loads."""
        return Loaded(self.model, driven(self.model, self.drives), self.drives, self.responses)

    @computed
    def products(self) -> Products:
        """Of the fields."""
        watched = [r for r in self.responses if moving(r) in self.loaded.coordinates]
        return dataclasses.replace(self.loaded, responses=tuple(watched)).products(self.frequency)

    def receptance(self, path: str) -> Complex:
        """Return d(receptance)/dp, shape (drives, responses, f)."""
        of = asked(self.paths, path)
        if not self._is_exact(path):
            if path not in self._dampings:
                of()  # refuses what has no derivative
            return frf_difference(self.model, path, self.frequency, self.drives, self.responses)
        value = np.zeros(
            (len(self.drives), len(self.responses), len(self.frequency)), dtype=np.complex128
        )
        moved = [moving(r) in self.loaded.coordinates for r in self.responses]
        if any(moved):
            value[:, moved] = of() if path in self._dampings else self._of_rate(of())
        return value

    @computed
    def paths(self) -> dict[str, Callable[[], Any]]:
        """What each number that there are derivatives by does: a rate, of dampings the answer."""
        by_damping = {name: partial(self._of_damping, *at) for name, at in self._dampings.items()}
        return rates_of(self.places) | by_damping

    @computed
    def _dampings(self) -> dict[str, tuple[int, str]]:
        """Return number and argument of what dampings are made of, by path."""
        dampings = self.model.scene.dampings
        found = {}
        for i, one in enumerate(dampings):
            for item in dataclasses.fields(one):  # type: ignore[arg-type]
                if isinstance(getattr(one, item.name), float):
                    found[f"damping[{i}].{item.name}"] = (i, item.name)
                    if len(dampings) == 1:
                        found[f"damping.{item.name}"] = (i, item.name)
        return found

    def _is_exact(self, path: str) -> bool:
        """Whether the fields of forces say all; what is left is differentiated numerically."""
        scene = self.model.scene
        special = any(p[0] in (END, WIRE) or is_force(p) for p in (*self.drives, *self.responses))
        modal = any(isinstance(one, ModalDamping) for one in scene.dampings)
        if self.model.element != "continuous" or special or modal:
            return False
        if path in self._dampings:
            heavier = self._dampings[path][1] == "mass"
            return not (heavier and self.model.chain.carried)
        return not self._is_carried(path)

    def _is_carried(self, path: str) -> bool:
        """Whether it is a number of a structure that a node carries, its place apart."""
        for i, part in enumerate(self.model.scene.parts):
            if path.startswith(f"parts[{i}].") and not isinstance(part, STRETCHES):
                rate = part.rates().get(path.rsplit(".", maxsplit=1)[-1])
                return rate is not None and rate.attached is not None
        return False

    def _of_rate(self, rate: Rate) -> Complex:
        still = np.zeros_like(self._factor)
        return self._summed(rate.weights(self.places), still, np.zeros(self._width))

    def _of_damping(self, number: int, name: str) -> Complex:
        """Return that of a number of a damping: all of them are in proportion to what they add."""
        omega = 2 * np.pi * self.frequency
        one = self.model.scene.dampings[number]

        def having(value: float) -> Damping:
            return dataclasses.replace(one, **{name: value})  # type: ignore[type-var]

        on, off = ([having(value)] for value in (1.0, 0.0))
        by_factor = damping.factors(on, omega).T - damping.factors(off, omega).T
        drag = (damping.drag(on) - damping.drag(off)) * dragged(self.model.scene)
        return self._summed(Rate(self.places).weights(self.places), by_factor, drag)

    @property
    def _width(self) -> int:
        return len(self.model.coordinates)

    @computed
    def _factor(self) -> Complex:
        return damping.factors(self.model.scene.dampings, 2 * np.pi * self.frequency).T

    def _summed(self, weights: Weights, by_factor: Complex, drag: Real) -> Complex:
        """Return dh/dp by all that changes."""
        return (
            self._along(weights, by_factor, drag)
            - self._at_nodes(weights, by_factor)
            - self._at_hinges(weights, by_factor)
        )

    @computed
    def _kept(self) -> list[int]:
        return [self.model.coordinates.index(c) for c in self.loaded.coordinates]

    def _along(self, weights: Weights, by_factor: Complex, drag: Real) -> Complex:
        """Integrate over the spans, and add what their ends move by."""
        places, products = self.places, self.products
        begins = np.flatnonzero(~places.inside)[:-1]
        total = np.zeros(products.span.shape[1:4], dtype=np.complex128)
        for k, (span, begin) in enumerate(zip(self.loaded.spans, begins)):
            section = np.zeros((3, 3))
            section[ENTRIES[0], ENTRIES[1]] = weights.element[begin, :TENSION]
            section[ENTRIES[1], ENTRIES[0]] = weights.element[begin, :TENSION]
            own = weights.element[begin]
            rate = Span(
                section,
                tension=float(own[TENSION]),
                inertia=weights.moving[begin, self._kept],
                drag=drag[self._kept],
                sag=float(own[SAG]),
            )
            by_p = hamiltonian_rate(span, rate, self.loaded.coordinates, self._factor, by_factor)
            total += np.einsum("drfij,fij->drf", products.span[k], by_p)
        moves = np.append(0.0, np.cumsum(weights.element[begins, LENGTH] * places.counts))
        self._refuse_loads_at(self.loaded.stations[moves != 0])
        total += np.einsum("s,sdrf->drf", moves[1:], products.last)
        return total - np.einsum("s,sdrf->drf", moves[:-1], products.first)

    def _refuse_loads_at(self, places: Real) -> None:
        margin = NEAR * self.model.scene.rope.length
        for point in self.loaded.loads:
            if (np.abs(places - point[1]) <= margin).any():
                raise SceneError(
                    f"drive and response must not stand where the scene changes, got {point}: what "
                    "moves there would be left of it or right of it"
                )

    def _at_nodes(self, weights: Weights, by_factor: Complex) -> Complex:
        """Sum u_r (dN/dp) u_d over the stations, N on the diagonal."""
        chain, stations = self.loaded.chain, ~self.places.inside
        term = chain.term[stations]

        def own(given: Real) -> Real:
            return np.diagonal(given, axis1=1, axis2=2)

        spring, mass = (own(m[stations])[:, self._kept] for m in (weights.node, weights.mass))
        dashpot = weights.dashpot[stations][:, self._kept]
        by_p = np.einsum("sw,f->sfw", spring, self._factor[damping.SPRING])
        by_p += np.einsum("sw,f->sfw", mass, self._factor[damping.INERTIA])
        by_p += np.einsum("sw,f->sfw", dashpot, self._factor[damping.DASHPOT])
        by_p += np.einsum("sw,f->sfw", own(chain.stiffness[term]), by_factor[damping.SPRING])
        by_p += np.einsum("sw,f->sfw", own(chain.mass[term]), by_factor[damping.INERTIA])
        return np.einsum("sdrfw,sfw->drf", self.products.node, by_p)

    def _at_hinges(self, weights: Weights, by_factor: Complex) -> Complex:
        """Sum the products of jumps times how fast the springs across them grow."""
        chain, stations = self.loaded.chain, ~self.places.inside
        if chain.hinge is None:
            return np.zeros(self.products.jump.shape[1:4], dtype=np.complex128)
        soft = chain.hinge[chain.term[stations][:-1]]
        stiff = np.divide(1, soft, out=np.zeros_like(soft), where=soft != 0)
        stiffer = weights.jump[stations[:-1]][:, self._kept]
        by_p = np.einsum("sw,f->sfw", stiffer, self._factor[damping.SPRING])
        by_p += np.einsum("sw,f->sfw", stiff, by_factor[damping.SPRING])
        return np.einsum("sdrfw,sfw->drf", self.products.jump, by_p)

    def of(self, path: str, quantity: str) -> Complex:
        """Return the derivative of a quantity, shape (drives, responses, f)."""
        times = QUANTITIES[quantity]
        return self.receptance(path) * (2j * np.pi * self.frequency) ** times


def solve_frf(model: Compiled, frequency: ArrayLike, **asked: Any) -> FRF:
    """Compute the frequency response, and keep what its derivatives take; see `Model.frf`."""
    return solve_harmonic(model, frequency, rates=FrequencyRates, **asked)
