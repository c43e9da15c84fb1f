"""Natural frequencies by each solver, and what follows from the shapes."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base import check
from ..base.answer import Cost, Work
from ..base.array import Index, Real
from ..base.errors import SceneError, SolveError
from ..base.unit import FAMILY
from ..chain.chain import CARRIED, CHANNELS, Chain
from ..chain.compile import check_points, divided, finer, station_nodes, stations_of
from ..chain.compiled import MOST_POINTS, MOST_STEPS, Compiled
from ..scene import damping
from .damped.attached_energy import Carried
from .mesh_error import mesh_of_modes
from .modes import Modes, UndampedMesh, UndampedVectors
from .sensitivity import Shapes, clusters_of

STRAINS = ("bending", "twist", "stretch", "lay", "tension", "spring")
"""What stores strain energy, in the core's order."""

LARGEST_DENSE = 8_000
"""Unknowns above which the dense matrix of the assembled solver, 8 n^2 bytes, is refused."""

HIGHEST = 1e100
"""Of eigenvalues that are counted [rad^2/s^2], so that their products do not overflow."""

UNSEEN = 1e-8
"""Of the largest component of a shape: less at all points is rounding at nodes of the mode."""


@dataclass(frozen=True)
class Found:
    """Modes of one component, lowest first."""

    eigenvalue: Real  # (k,) [rad^2/s^2]
    error: Real  # (k,) [rad^2/s^2]
    # (k, nodes, width) over the component's coordinates, None where it was not asked for
    shape: Real | None
    certified: bool  # whether none is missing
    work: Work  # what it took
    # (k, attached) of the structures that the component's nodes carry, as y in csrc/attached.h [m]
    motion: Real | None = None


def solve_modes(
    model: Compiled,
    number: int | None,
    *,
    below: float | None,
    solver: str,
    points: int | None = None,
    strict: bool = True,
) -> Modes:
    """Find natural frequencies and shapes; see `Model.modes`.

    Without `strict` fewer modes than asked for are no error.
    """
    solve = SOLVERS[check.one_of(solver, "solver", SOLVERS)]
    check_points(model, points)
    if model.element == "continuous" and solver != "sweep":
        raise SceneError(f'solver must be "sweep" for continuous spans, got {solver!r}')
    limit = check_asked(number, below)
    if below is not None:
        _refuse_short_waves(model, limit)
    start = time.perf_counter()
    found = [solve(model, c, number, limit, shaped=False) for c in model.components]
    seconds = time.perf_counter() - start
    existing = sum(len(part.eigenvalue) for part in found)
    if strict and number is not None and number > existing:
        raise SolveError(
            f"number must be at most {existing}, the modes this model has, got {number}"
        )
    eigenvalue, error, order = _merged(found, number)
    later: Callable[[], UndampedVectors] = partial(_later, model, solver, number, limit)
    frequency = np.sqrt(np.maximum(eigenvalue, 0.0)) / (2 * math.pi)
    which = np.repeat(np.arange(len(found)), [len(part.eigenvalue) for part in found])[order]
    mesh: UndampedMesh | Callable[[], UndampedMesh]
    mesh = partial(mesh_of_modes, model.scene, model.components, which, eigenvalue)
    x = model.x
    if model.element == "continuous":
        mesh = UndampedMesh(mesh_error=np.zeros_like(frequency), limit=frequency)
        points = points or points_for(model, eigenvalue)
        x = within(model.x, points)
        later = partial(_later_within, model, number, limit, eigenvalue, points)
    return Modes(
        coordinates=model.coordinates,
        certified=all(part.certified for part in found),
        x=x,
        frequency=frequency,
        eigenvalue=eigenvalue,
        growth=np.sqrt(np.maximum(-eigenvalue, 0.0)),
        rounding_error=error_in_hertz(eigenvalue, error),
        cost=_cost(model, solver, seconds, found),
        vectors=later if found[0].shape is None else _vectors(model, found, eigenvalue, order),
        mesh=mesh,
        solve_shapes=partial(solve_shapes, model, solver, eigenvalue),
    )


def check_asked(number: int | None, below: float | None) -> float:
    """Check that one of both is given; return the limit of eigenvalues [rad^2/s^2]."""
    if (number is None) == (below is None):
        raise SceneError(f"give either number or below, got number={number!r} and below={below!r}")
    if number is not None:
        check.count(number, "number", most=np.iinfo(np.int32).max)
    return math.inf if below is None else eigenvalue_of(below)


def spectrum(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float = math.inf
) -> tuple[Real, Real]:
    """Return the lowest eigenvalues of one component and their errors [rad^2/s^2]."""
    if number is None:
        _refuse_short_waves(model, limit)
    found = _sweep(model, component, number, limit, shaped=False)
    eigenvalue, error, _ = _merged([found], number)
    return eigenvalue, error


def _cost(model: Compiled, solver: str, seconds: float, found: Sequence[Found]) -> Cost:
    work = Work.of(part.work for part in found)
    share = work.redone / max(sum(len(part.eigenvalue) for part in found), 1)
    return Cost(
        seconds, solver, len(model.x) - 1, model.size, work.sweeps, work.factorisations, share
    )


def eigenvalue_of(below: Any) -> float:
    """Return the squared angular frequency of a limit in Hz, checked."""
    highest = min(check.number(below, "below", "Hz", sign="positive"), check.HIGHEST)
    return (2 * math.pi * highest) ** 2


def count_modes(model: Compiled, below: float) -> int:
    """Count the natural frequencies below a limit; see `Model.count`."""
    limit = eigenvalue_of(below)
    _refuse_short_waves(model, limit)
    return sum(count_component(model, c, limit) for c in model.components)


def count_component(model: Compiled, component: tuple[str, ...], limit: float) -> int:
    """Count the eigenvalues of one component below a limit [rad^2/s^2]."""
    return _count(model.chain.undamped.only(component), limit)


def _count(chain: Chain, limit: float) -> int:
    """Count the eigenvalues of a component below a limit."""
    return int(_core.count(chain, np.array([min(limit, HIGHEST)]))[0])


def _merged(found: Sequence[Found], number: int | None) -> tuple[Real, Real, Index]:
    """Return eigenvalues and errors of all components in order, and that order."""
    eigenvalue = np.concatenate([part.eigenvalue for part in found])
    error = np.concatenate([part.error for part in found])
    # what rounding cannot tell from 0 is rigid-body motion
    eigenvalue = np.where(np.abs(eigenvalue) <= error, 0.0, eigenvalue)
    order = np.argsort(eigenvalue, kind="stable")[:number]
    return eigenvalue[order], error[order], order


def _refuse_short_waves(model: Compiled, eigenvalue: float) -> None:
    """Refuse to count more half waves than can be walked."""
    if model.element != "continuous":
        return
    for component in model.components:
        steps = pieces_of(model.chain.undamped.only(component), min(eigenvalue, HIGHEST))
        if steps > MOST_STEPS:
            raise SolveError(
                f"below is too high: ({', '.join(component)}) has {steps} pieces shorter than its "
                f"waves there, at most {MOST_STEPS} are walked"
            )


def pieces_of(chain: Chain, eigenvalue: float) -> int:
    """Return how many pieces shorter than its waves a component is walked in."""
    factor = np.array([[1.0], [1.0], [1.0], [-eigenvalue], [0.0]], dtype=np.complex128)
    return int(_core.steps(chain, factor))


def _in_threads(call: Callable[..., Any], nodes: int, *arguments: Any) -> Any:
    """Call the core; long calls in a thread of their own, so that Ctrl-C is heard."""
    if nodes < 10_000:
        return call(*arguments)
    executor = ThreadPoolExecutor(1)
    try:
        return executor.submit(call, *arguments).result()
    finally:
        executor.shutdown(wait=False)


# --- by sweeps --------------------------------------------------------------------------------


def _sweep(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float, *, shaped: bool
) -> Found:
    """Solve each span between nodes that nothing moves for itself."""
    chain = model.chain.undamped.only(component)
    found = []
    for first, last in chain.spans:
        try:
            found.append(lowest(chain.between(first, last), number, limit, shaped=shaped))
        except SolveError as refusal:
            raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    if len(found) == 1:
        return found[0]
    eigenvalue, error, order = _merged(found, number)
    shape = motion = None
    if shaped:
        motion = np.concatenate([part.motion for part in found if part.motion is not None])[order]
        parts = []
        for part, (first, last) in zip(found, chain.spans):
            assert part.shape is not None
            parts.append(np.zeros((len(part.shape), chain.nodes, part.shape.shape[2])))
            parts[-1][:, first : last + 1] = part.shape
        shape = np.concatenate(parts)[order]
    certified = all(part.certified for part in found)
    work = Work.of(part.work for part in found)
    return Found(eigenvalue, error, shape, certified, work, motion)


def lowest(chain: Chain, number: int | None, limit: float, *, shaped: bool) -> Found:
    """Find the lowest modes of a chain between ends that nothing moves, or all below a limit."""
    wanted = _count(chain, limit) if number is None else number
    wanted = wanted if chain.finite is None else min(wanted, chain.finite)
    eigenvalue, error, certified, shape, motion, found, sweeps, redone = _in_threads(
        _core.certify, max(chain.nodes, 100 * wanted), chain, wanted, _upper(limit), shaped
    )
    if not np.isfinite(eigenvalue[:found]).all() or not np.isfinite(error[:found]).all():
        raise SolveError("the numbers of the modes overflow: check the units")
    return Found(
        eigenvalue[:found],
        error[:found],
        shape[:found] if shaped else None,
        bool((certified[:found] == 1).all()),
        Work(sweeps, redone=redone),
        motion[:found] if shaped else None,
    )


def _upper(limit: float) -> float:
    """Return the limit as the core takes it: beyond all that is counted there is none."""
    return limit if limit < HIGHEST else math.inf


# --- the assembled system ---------------------------------------------------------------------


def _lapack(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float, *, shaped: bool
) -> Found:
    chain = model.chain.undamped.only(component)
    if chain.carried:
        kinds = " or ".join(chain.carried)
        raise SceneError(
            f'solver must be "sweep" where parts have a {kinds}, got "lapack": its matrix problem '
            "is linear"
        )
    if chain.free > LARGEST_DENSE:
        raise SolveError(
            f"({', '.join(component)}) has {chain.free} unknowns: solver 'lapack' needs a dense "
            f"matrix of that size and takes at most {LARGEST_DENSE}; use fewer elements"
        )
    try:
        (eigenvalue, error, shape), _ = _core.modes(
            chain, number or 0, 0.0 if number else limit, _scale(model, component)
        )
    except SolveError as refusal:
        raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    lost = ~np.isfinite(error) | ~np.isfinite(eigenvalue)
    if lost.any():
        raise SolveError(
            f"mode {int(lost.argmax()) + 1} of ({', '.join(component)}) has no correct digit: the "
            "inertias or stiffnesses differ too much for the assembled solver"
        )
    return Found(eigenvalue, error, shape, False, Work(factorisations=1))


def _scale(model: Compiled, component: tuple[str, ...]) -> float:
    """Return the order of the first elastic eigenvalue: half a wave over the rope."""
    rope, chain = model.scene.rope, model.chain
    with np.errstate(over="ignore"):
        wave = float(np.square(np.pi / rope.length))
    inertia = chain.mass[chain.term_of].sum(axis=0).diagonal() / rope.length
    share = np.bincount(chain.element, np.diff(chain.first), len(chain.length)) * chain.length
    soft = np.tensordot(share / share.sum(), chain.flexibility, 1).diagonal()
    with np.errstate(divide="ignore", over="ignore"):
        own = np.divide(1.0, soft)
    stiffness = {c: float(own[k]) if np.isfinite(own[k]) else 0.0 for c, k in CHANNELS.items()}
    stiffness["z"] = stiffness["beta"] * wave + abs(model.scene.mean_tension)
    orders = [
        stiffness[c] * wave / inertia[k]
        for k, c in enumerate(model.coordinates)
        if c in component and inertia[k] > 0 and stiffness[c] > 0
    ]
    return float(np.clip(min(orders, default=1.0), 1e-200, 1e200))


SOLVERS = {"sweep": _sweep, "lapack": _lapack}
"""What finds the lowest modes of one component."""


# --- what follows from the shapes -------------------------------------------------------------


def _later(model: Compiled, solver: str, number: int | None, limit: float) -> UndampedVectors:
    """Solve once more, with shapes."""
    found = [SOLVERS[solver](model, c, number, limit, shaped=True) for c in model.components]
    eigenvalue, _, order = _merged(found, number)
    return _vectors(model, found, eigenvalue, order)


def within(x: Real, points: int) -> Real:
    """Return the ends of so many equal parts between each two nodes."""
    parts = np.multiply.outer(np.diff(x) / points, np.arange(points))
    return np.append((x[:-1, None] + parts).ravel(), x[-1])


def _most_pieces(model: Compiled, eigenvalue: Real) -> int:
    """Return how many pieces shorter than the waves of the highest mode an element has at most."""
    highest = float(np.abs(eigenvalue).max(initial=0.0))
    chain = model.chain.undamped
    _, stretch = np.unique(chain.element, return_index=True)
    elements = [chain.between(node, node + 1) for node in chain.first[stretch].tolist()]
    return max(_pieces(model, element, highest) for element in elements)


def _pieces(model: Compiled, element: Chain, eigenvalue: float) -> int:
    """Return how many pieces shorter than its waves an element has."""
    return max((pieces_of(element.only(c), eigenvalue) for c in model.components), default=1)


def points_for(model: Compiled, eigenvalue: Real) -> int:
    """Return how many parts of each element show the highest mode."""
    pieces = _most_pieces(model, eigenvalue)
    return min(max(32, 8 * pieces), MOST_POINTS)


def _later_within(
    model: Compiled, number: int | None, limit: float, eigenvalue: Real, points: int
) -> UndampedVectors:
    """Solve continuous spans once more, with shapes inside them.

    Energies want elements below their own resonance, and a mode may have its nodes at all points,
    so there may be more elements than points. A mode that the points show nothing of is as large as
    its largest component elsewhere is 1.
    """
    more = -(-points_for(model, eigenvalue) // points)
    vectors = _later(finer(model, points * more), "sweep", number, limit)
    own = np.array([FAMILY[c] for c in model.coordinates])
    size = largest(vectors.shape[:, ::more], (vectors.family[:, None] == own).argmax(axis=1))
    size = np.where(np.abs(size) < UNSEEN, 1.0, size)
    return replace(
        vectors,
        shape=vectors.shape[:, ::more] / size[:, None, None],
        modal_mass=vectors.modal_mass / size**2,
    )


def _cut(model: Compiled, highest: float, points: int | None) -> tuple[Compiled, Index]:
    """Cut continuous spans into elements below their own resonance.

    Two for each piece of the highest eigenvalue: more would be differences of ever closer nodes.
    """
    at = station_nodes(model)
    chain = model.chain.undamped
    elements = [chain.between(first, first + 1) for first in at[:-1].tolist()]
    least = 2 * np.array([_pieces(model, element, highest) for element in elements])
    parts = least if points is None else np.full(len(least), points)
    each = -(-least // parts)
    counts = np.diff(at) * parts * each
    if counts.sum() > MOST_POINTS:
        raise SolveError(
            f"modes need {counts.sum()} points along the rope to be looked at, at most "
            f"{MOST_POINTS} are: the highest ones have too short waves"
        )
    edges = np.cumsum([0, *np.repeat(each, np.diff(at) * parts)])
    return divided(model.scene, model.element, stations_of(model.scene), counts), edges


def solve_shapes(
    model: Compiled, solver: str, eigenvalue: Real, points: int | None = None
) -> Shapes:
    """Solve as many modes as there are eigenvalues, with the shapes that sensitivities need.

    Modes that coincide with the last one belong to them. Of eigenvalues of continuous spans the
    largest tells how short elements must be.
    """
    check_points(model, points)
    edges = np.arange(len(model.x))
    if model.element == "continuous":
        model, edges = _cut(model, float(eigenvalue.max(initial=0.0)), points)
    return shapes_of(model, solver, len(eigenvalue), edges)


def shapes_of(model: Compiled, solver: str, number: int, edges: Index) -> Shapes:
    """Solve for so many modes, and those that coincide with the last one, with their shapes."""
    more = number
    while True:
        more += 1
        found = [SOLVERS[solver](model, c, more, math.inf, shaped=True) for c in model.components]
        value, error, order = _merged(found, more)
        clusters = clusters_of(value, error)
        kept = [cluster for cluster in clusters if cluster[0] < number]
        last = kept[-1][-1] if kept else -1
        if last < more - 1 or len(value) < more:
            break
        more *= 2
    order = order[: last + 1]
    shape, motion = _spread(model, found)[order], _motion(model, found)[order]
    return Shapes(model, value[: last + 1], shape, motion, tuple(kept), edges)


def _vectors(
    model: Compiled, found: Sequence[Found], eigenvalue: Real, order: Index
) -> UndampedVectors:
    shape = _spread(model, found)[order]
    strain, kinetic, dragged = _core.energy(model.chain, shape, eigenvalue)
    motion = _motion(model, found)[order]
    carried = Carried.real(model.chain, shape, motion, eigenvalue).of(model.chain)
    own = kinetic.argmax(axis=1)
    size, most = largest(shape, own), np.abs(motion).max(axis=1, initial=0.0)
    # where the rope stands still, what it carries is what moves
    size = np.where(np.abs(size) < UNSEEN * most, most, size)
    shape /= size[:, None, None]
    strain, kinetic, carried = (e / size[:, None] ** 2 for e in (strain, kinetic, carried))
    dragged /= size**2
    omega, all_carried = np.sqrt(np.maximum(eigenvalue, 0.0)), carried.sum(axis=0)
    energies = _Energies(strain, kinetic, dragged, all_carried)
    return UndampedVectors(
        damping_ratio=_damping_ratio(model, omega, energies),
        family=np.array([FAMILY[model.coordinates[k]] for k in own], dtype=np.str_),
        modal_mass=kinetic.sum(axis=1) + all_carried[:, 1],
        shape=shape,
        energy=fractions(model, eigenvalue, strain, kinetic, carried),
    )


def _motion(model: Compiled, found: Sequence[Found]) -> Real:
    """Return the motion of all structures that nodes carry, by component; shape (k, attached)."""
    modes = [len(part.eigenvalue) for part in found]
    if model.chain.attached_row is None:
        return np.zeros((sum(modes), 0))
    motions = []
    for part, count, component in zip(found, modes, model.components):
        kept = [model.coordinates.index(c) for c in component]
        row = model.chain.attached_row[:, :, kept]
        moved = (row != 0).any(axis=2).any(axis=1)
        motion = np.zeros((count, len(row)))
        if moved.any():
            assert part.motion is not None
            motion[:, moved] = part.motion
        motions.append(motion)
    return np.concatenate(motions)


def _spread(model: Compiled, found: Sequence[Found]) -> Real:
    """Return the shapes of all components over all coordinates."""
    shapes = []
    for part, component in zip(found, model.components):
        assert part.shape is not None
        shape = np.zeros((len(part.shape), len(model.x), len(model.coordinates)))
        shape[:, :, [model.coordinates.index(c) for c in component]] = part.shape
        shapes.append(shape)
    return np.concatenate(shapes)


def largest(shape: NDArray[Any], own: Index) -> NDArray[Any]:
    """Return the value of the largest component of the family's own coordinate, with its sign."""
    rows = np.arange(len(shape))
    moved = shape[rows, :, own]
    return moved[rows, np.abs(moved).argmax(axis=1)]


def error_in_hertz(eigenvalue: Real, error: Real) -> Real:
    """Return the largest change of frequency or growth while the eigenvalue changes by its error.

    sqrt(a + e) - sqrt(a) = e/(sqrt(a + e) + sqrt(a)), so that no digit is lost.
    """
    size = np.abs(eigenvalue)
    omega, less = np.sqrt(size), np.sqrt(np.maximum(size - error, 0.0))
    # below zero frequency 0 is as far as a mode can go; a growth rate begins there
    wide = np.where(error > size, np.sqrt(size + error), 0.0)
    sum_ = omega + less
    change = np.divide(np.minimum(error, size), sum_, out=np.zeros_like(size), where=sum_ > 0)
    return np.maximum(change, wide) / (2 * math.pi)


class _Energies(NamedTuple):
    """Twice the energies of shapes."""

    strain: Real
    """(k, strains)."""
    kinetic: Real
    """(k, coordinates) modal mass of the rope and its nodes."""
    dragged: Real
    """(k,) modal damping of drag and dashpots."""
    carried: Real
    """(k, 3) strain, modal mass and losses of all structures that nodes carry."""


def _damping_ratio(model: Compiled, omega: Real, energies: _Energies) -> Real:
    """Return zeta = shape^T Im(dynamic stiffness) shape / (2 omega^2 modal mass) at omega.

    And the ratio that a mode has by itself.
    """
    strain, kinetic, dragged, carried = energies
    part = np.stack(
        [
            strain[:, : STRAINS.index("tension")].sum(axis=1),
            strain[:, STRAINS.index("tension")],
            strain[:, STRAINS.index("spring")],
            kinetic.sum(axis=1) + carried[:, 1],
            dragged,
        ],
        axis=1,
    )
    dampings = model.scene.dampings
    lost = (damping.factors(dampings, omega).imag * part).sum(axis=1) + carried[:, 2]
    twice = 2 * omega**2 * part[:, damping.INERTIA]
    ratio = damping.ratios(dampings, len(omega))
    np.add(ratio, np.divide(lost, twice, where=omega > 0, out=np.zeros_like(lost)), out=ratio)
    return np.where(omega > 0, ratio, 0.0)


def fractions(
    model: Compiled,
    eigenvalue: Real,
    strain: Real,
    kinetic: Real,
    carried: Real,
) -> dict[str, Real]:
    """Return shares of the strain and of the kinetic energy.

    `carried`, shape (kinds, k, 3), is of each kind of structure that the nodes carry.
    """
    of_all = carried.sum(axis=0)
    total, moving = strain.sum(axis=1) + of_all[:, 0], kinetic.sum(axis=1) + of_all[:, 1]
    moves = (eigenvalue != 0) & (total != 0)
    energy = {}
    stores = {"spring": {"spring", "hinge"}}
    for k, name in enumerate(STRAINS):
        if stores.get(name, {name}) & set(model.scene.effects):
            share = np.divide(strain[:, k], total, out=np.zeros_like(total), where=moves)
            energy[name] = share
    for k, name in enumerate(model.coordinates):
        energy[name] = kinetic[:, k] / moving
    for kind, own in zip(model.chain.carried, carried):
        energy[kind] = np.divide(own[:, 0], total, out=np.zeros_like(total), where=moves)
        energy[CARRIED[kind]] = own[:, 1] / moving
    return energy
