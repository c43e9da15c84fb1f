"""Complex modes of a model, from the rates of its chains."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...axis.axis import Axis
from ...base import check
from ...base.answer import Cost
from ...base.array import Complex, Index, Real
from ...base.errors import SceneError, SolveError
from ...base.unit import FAMILY
from ...chain.chain import Chain, plane_of
from ...chain.compile import check_points, compile_scene, finer
from ...chain.compiled import Compiled
from ...chain.lean import lean
from ...scene.damping import factors as damping_factors
from ...scene.damping import having
from ..eigen import check_asked
from ..free_motion import MeshOfModes, Vectors
from ..measured import HERTZ, SoughtRoots, measured
from ..spectrum import lowest
from ..vectors import UNSEEN, fractions, largest, points_for, within
from .attached_energy import AttachedEnergy
from .damped_modes import DampedModes
from .damped_roots import Damped, Undamped, damped_roots, untold
from .modal_rates import solve_modal
from .rates import Rates
from .residue import motions

MORE = 4  # A search passes so many undamped modes for each one asked for before it gives up.
DOUBLINGS = 40
"""Beyond them the radius doubles so often: dashpots on light nodes have rates far above all."""
Between = tuple[tuple[str, ...], int, int]
"""A component between two nodes."""


@dataclass(frozen=True, eq=False)
class DampedRates:
    """Rates of all parts in order."""

    parts: list[Between]
    found: list[Damped]  # of each part
    value: Complex  # (k,) those asked for [rad/s]
    error: Real  # (k,) [rad/s]
    which: Index  # (k,) of which part each is
    at: Index  # (k,) which of its rates
    radius: float  # none of a modulus below this is missing [rad/s]

    @property
    def certified(self) -> bool:
        """Whether none is missing below the highest of them."""
        return bool((np.abs(self.value) <= self.radius).all())

    def first(self, number: int) -> DampedRates:
        """Return the lowest alone."""
        return replace(
            self,
            value=self.value[:number],
            error=self.error[:number],
            which=self.which[:number],
            at=self.at[:number],
            radius=min(self.radius, float(np.abs(self.value[number - 1]))),
        )

    @property
    def sweeps(self) -> int:
        """How often chains were walked."""
        return sum(part.sweeps for part in self.found)


def solve_damped(
    model: Compiled, number: int | None, *, below: float | None, solver: str, points: int | None
) -> DampedModes:
    """Find complex modes; see `Model.modes`."""
    check.one_of(solver, "solver", ("sweep", "lapack"))
    if solver != "sweep":
        raise SceneError(f'solver must be "sweep" for damped modes, got {solver!r}')
    check_points(model, points)
    limit = math.sqrt(check_asked(number, below))
    if having(model.scene.dampings, "ratio"):
        return solve_modal(model, number, below=below, points=points)
    answer = _find(model, model.components, number, limit)
    value = answer.value
    x, finest = model.x, 1
    mesh: MeshOfModes | Callable[[], MeshOfModes] = partial(_mesh, model, answer)
    if model.element == "continuous":
        mesh = MeshOfModes(np.zeros(len(value)))
        finest = points or points_for(model, np.square(np.abs(value)))
        x = within(model.x, finest)
    return DampedModes(
        coordinates=model.coordinates,
        certified=answer.certified,
        searched=min(answer.radius, limit) / (2 * math.pi),
        x=x,
        eigenvalue=value,
        rounding_error=partial(_rounding, model, answer),
        rounding_bound=answer.error / (2 * math.pi),
        plane=np.array([plane_of(answer.parts[k][0]) for k in answer.which], dtype=np.str_),
        cost=Cost(solver, len(model.x) - 1, model.size, answer.sweeps),
        vectors=partial(_vectors, model, answer, finest),
        mesh=mesh,
        line=partial(Axis.line, model.scene.rope.length),
    )


def _find(
    model: Compiled, components: Iterable[tuple[str, ...]], number: int | None, limit: float
) -> DampedRates:
    """Find the rates of some components, those of the least modulus first."""
    parts = [(c, *span) for c in components for span in model.chain.only(c).spans]
    undamped = [Undamped(lean(model.chain.only(c).between(*span))[0]) for c, *span in parts]
    if number is None:
        return _below(model, parts, undamped, limit)
    omega = _lowest(undamped, number + 2)
    at, radius, known = number, 0.0, -1
    told = [math.inf] * len(parts)
    while True:
        radius = max(_between(omega, at), 1.2 * radius)
        answer = _below(model, parts, undamped, radius, told)
        if len(answer.value) >= number:
            return answer.first(number)
        if not answer.certified and len(answer.value) == known:
            raise untold(radius)  # what more there may be decays too fast
        known = len(answer.value)
        told = [math.inf if part.certified else part.radius for part in answer.found]
        omega = _lowest(undamped, MORE * number + 4)
        most = len(omega) + (0 if model.element == "continuous" else DOUBLINGS)
        if at >= most or math.isinf(answer.radius):
            hertz = answer.radius / (2 * math.pi)
            where = "there are" if math.isinf(hertz) else f"below {hertz:.6g} Hz"
            raise SolveError(
                f"number must be at most {known}, the damped modes {where}, got {number}"
            )
        at += number - known


def _lowest(undamped: list[Undamped], number: int) -> Real:
    """Return the lowest undamped frequencies [rad/s]."""
    eigenvalue = np.concatenate([one.lowest(number).eigenvalue for one in undamped])
    return np.sort(np.sqrt(np.abs(eigenvalue)))[:number]


def _between(omega: Real, at: int) -> float:
    """Return a radius with the first `at` of these inside; beyond the last by powers of two."""
    if at < len(omega):
        return float(omega[at - 1] + omega[at]) / 2
    return float(omega[-1]) * 1.5 * 2.0 ** (at - len(omega))


def _below(
    model: Compiled,
    parts: list[Between],
    undamped: list[Undamped],
    limit: float,
    told: list[float] | None = None,
) -> DampedRates:
    """Find rates of a modulus below a limit: all, or what decays so that it can be told."""
    rates = Rates.of(model.scene.dampings)
    found = []
    for k, ((component, _, _), own) in enumerate(zip(parts, undamped)):
        try:
            found.append(damped_roots(own, rates, limit, told=None if told is None else told[k]))
        except SolveError as refusal:
            raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    radius = min(part.radius for part in found)
    value = np.concatenate([part.value for part in found])
    error = np.concatenate([part.error for part in found])
    which = np.repeat(np.arange(len(found)), [len(part.value) for part in found])
    at = np.concatenate([np.arange(len(part.value)) for part in found])
    order = np.argsort(np.abs(value), kind="stable")
    edge = min((part.radius for part in found if part.certified), default=limit)
    order = order[np.abs(value[order]) < min(edge, limit)]
    return DampedRates(parts, found, value[order], error[order], which[order], at[order], radius)


def _vectors(model: Compiled, answer: DampedRates, points: int) -> Vectors[np.complex128]:
    """Shapes at `points` parts of each element, energies with as many as the waves need."""
    value, which, at = answer.value, answer.which, answer.at
    more, fine = 1, model
    if model.element == "continuous":
        more = -(-points_for(model, np.square(np.abs(value))) // points)
        fine = finer(model, points * more)
    step = points * more
    shape = np.zeros((len(which), len(fine.x), len(model.coordinates)), dtype=np.complex128)
    mass = np.zeros(len(which), dtype=np.complex128)
    carried = AttachedEnergy.none(len(which))
    for k, ((component, first, last), part) in enumerate(zip(answer.parts, answer.found)):
        chain = fine.chain.only(component).between(first * step, last * step)
        mine = np.flatnonzero(which == k)
        nodes = np.arange(first * step, last * step + 1)
        columns = np.array([model.coordinates.index(c) for c in component])
        block = np.ix_(mine, nodes, columns)
        shape[block], mass[mine], own = _shapes(chain, part, at[mine])
        carried.energy[:, mine], carried.motion[mine] = own
    strain, kinetic = _energy(fine.chain, shape, value)
    own = kinetic.argmax(axis=1)
    size = largest(shape[:, ::more], own)
    everywhere = np.maximum(np.abs(largest(shape, own)), carried.motion)
    # where a mode has its nodes at all points, that elsewhere
    size = np.where(np.abs(size) < UNSEEN * everywhere, everywhere, size)
    return Vectors(
        family=np.array([FAMILY[model.coordinates[k]] for k in own], dtype=np.str_),
        modal_mass=mass / size**2,
        shape=shape[:, ::more] / size[:, None, None],
        energy=fractions(model, np.abs(value), strain, kinetic, carried.of(model.chain)),
    )


def _shapes(chain: Chain, part: Damped, wanted: Index) -> tuple[Complex, Complex, AttachedEnergy]:
    """Return some motions of a chain, their modal masses and what it carries in them."""
    shape = np.zeros((len(wanted), chain.nodes, chain.held.shape[1]), dtype=np.complex128)
    mass = np.zeros(len(wanted), dtype=np.complex128)
    carried = AttachedEnergy.none(len(wanted))
    value = part.value[wanted]
    # rigid motion is that without damping
    mode = np.cumsum(value == 0) - 1 if part.mode is None else part.mode[wanted]
    real = (value == 0) if part.closed is None else np.ones(len(value), dtype=np.bool_)
    if real.any():
        found = lowest(chain.undamped, int(mode[real].max()) + 1, math.inf, shaped=True)
        assert found.shape is not None
        own, eigenvalue = found.shape[mode[real]], found.eigenvalue[mode[real]]
        shape[real] = own
        assert found.motion is not None
        moved = found.motion[mode[real]]
        carried.energy[:, real], carried.motion[real] = AttachedEnergy.real(
            chain, own, moved, eigenvalue
        )
        mass[real] = chain.undamped.energy(own, eigenvalue)[1].sum(axis=1)
        mass[real] += carried.energy[:, real, 1].sum(axis=0)
        if part.closed is not None:
            mass *= part.closed.mass_ratio(value, eigenvalue)
    if not real.all():
        shape[~real] = motions(chain, part, wanted[~real])
        mass[~real] = 1 / (2 * value[~real])
        rates = part.rates.at(value[~real])
        carried.energy[:, ~real], carried.motion[~real] = AttachedEnergy.at(
            chain, rates, shape[~real]
        )
    return shape, mass, carried


def _energy(chain: Chain, shape: Complex, value: Complex) -> tuple[Real, Real]:
    """Return strain and kinetic energy over a period, twice."""
    eigenvalue = -np.square(value).real
    real = chain.undamped.energy(np.ascontiguousarray(shape.real), eigenvalue)
    imag = chain.undamped.energy(np.ascontiguousarray(shape.imag), eigenvalue)
    return real[0] + imag[0], real[1] + imag[1]


def _rounding(model: Compiled, answer: DampedRates) -> Real:
    """Return the error of s/2 pi by rounding, the bound of it where wider numbers do not tell."""
    found, dampings = answer.error.copy(), model.scene.dampings
    own = np.array([answer.parts[k][0] for k in answer.which], dtype=object)
    for component in model.components:
        mine = np.array([tuple(one) == component for one in own], dtype=np.bool_)
        asked = SoughtRoots(
            answer.value[mine],
            answer.error[mine],
            lambda s: damping_factors(dampings, -1j * s).T,
        )
        told = measured(model, component, asked)
        found[mine] = np.where(np.isnan(told), answer.error[mine], told)
    return (found + HERTZ * np.abs(answer.value)) / (2 * math.pi)


def _mesh(model: Compiled, answer: DampedRates) -> MeshOfModes:
    """Return the distance to the modes of continuous spans, matched so that all are near."""
    from scipy.optimize import linear_sum_assignment

    distance = np.full(len(answer.value), np.inf)
    with suppress(SceneError, SolveError):
        continuous = compile_scene(model.scene)
        for component in model.components:
            mine = np.flatnonzero([answer.parts[k][0] == component for k in answer.which])
            if len(mine) == 0:
                continue
            true = _find(continuous, [component], len(mine), math.inf)
            apart = np.abs(answer.value[mine][:, None] - true.value[None, :])
            row, column = linear_sum_assignment(apart)
            distance[mine[row]] = apart[row, column] + true.error[column]
    return MeshOfModes(distance / (2 * math.pi))
