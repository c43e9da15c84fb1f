"""What follows from the shapes of undamped modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Index, Real
from ..base.errors import SolveError
from ..base.unit import FAMILY
from ..chain.chain import CARRIED, Chain
from ..chain.compile import check_points, divided, finer, station_nodes, stations_of
from ..chain.compiled import MOST_POINTS, Compiled
from ..chain.port import Point, locate, ports
from ..scene import damping
from .damped.attached_energy import AttachedEnergy
from .fewest import solve_components
from .forms import STRAINS
from .modes import Modes, UndampedVectors
from .sensitivity import Sensitivity, Shapes, clusters_of
from .spectrum import ComponentModes, merged, pieces_of

RADIANS = 1.2  # Of a piece, below the first resonance of a cantilever, of pi/2.

UNSEEN = 1e-8
"""Less than this part of the largest component at all points is rounding at nodes of a mode."""


def later_vectors(model: Compiled, solver: str, which: Index, limit: float) -> UndampedVectors:
    """Solve once more, with shapes; a finite limit tells how many modes there are of each kind."""
    number = len(which) if math.isinf(limit) else None
    found = solve_components(model, solver, number, limit, shaped=True)
    eigenvalue, _, order = merged(found, len(which), which)
    return vectors_of(model, found, eigenvalue, order)


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
    parts = (element.only(c) for c in model.components)
    return max((_waves(p, eigenvalue) or pieces_of(p, eigenvalue) for p in parts), default=1)


def _waves(beam: Chain, eigenvalue: float) -> int:
    """Return how many pieces the shortest wave of a beam whose tension grows has, 0 of others."""
    # steps of these are pieces and the joints that make them, by halves
    if beam.rise is None or not beam.rise[0] or beam.inertia is None or len(beam.coordinate) < 2:
        return 0
    load, turn = eigenvalue * beam.inertia[0]
    stiffness = 1 / beam.flexibility[0, 2, 2]
    half = (beam.tension[0] - abs(beam.rise[0]) / 2 - turn) / 2
    root = math.hypot(half, math.sqrt(load * stiffness))
    square = load / (root + half) if half > 0 else (root - half) / stiffness
    return math.ceil(beam.length[0] * math.sqrt(square) / RADIANS)


def points_for(model: Compiled, eigenvalue: Real) -> int:
    """Return how many parts of each element show the highest mode."""
    pieces = _most_pieces(model, eigenvalue)
    return min(max(32, 8 * pieces), MOST_POINTS)


def places_within(model: Compiled, eigenvalue: Real, points: int | None) -> Real:
    """Return where shapes of continuous spans are given."""
    return within(model.x, points or points_for(model, eigenvalue))


def later_within(
    model: Compiled, which: Index, limit: float, eigenvalue: Real, points: int | None
) -> UndampedVectors:
    """Solve continuous spans once more, with shapes inside them."""
    # energies want elements below their own resonance, and a mode may have its nodes at all points,
    # so there may be more elements than points. A mode that the points show nothing of is as large
    # as its largest component elsewhere is 1
    least = points_for(model, eigenvalue)
    points = points or least
    more = -(-least // points)
    vectors = later_vectors(finer(model, points * more), "sweep", which, limit)
    own = np.stack([vectors.energy[c] for c in model.coordinates]).argmax(axis=0)
    size = largest(vectors.shape[:, ::more], own)
    size = np.where(np.abs(size) < UNSEEN, 1.0, size)
    return replace(
        vectors,
        shape=vectors.shape[:, ::more] / size[:, None, None],
        modal_mass=vectors.modal_mass / size**2,
    )


def _cut(model: Compiled, highest: float, points: int | None) -> tuple[Compiled, Index]:
    """Cut continuous spans into elements below their own resonance."""
    # two for each piece of the highest eigenvalue: more would be differences of ever closer nodes
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
    model: Compiled, solver: str, eigenvalue: Real, which: Index, points: int | None = None
) -> Shapes:
    """Solve as many modes as there are eigenvalues, with the shapes that sensitivities need."""
    # modes that coincide with the last one belong to them. Of eigenvalues of continuous spans the
    # largest tells how short elements must be
    check_points(model, points)
    edges = np.arange(len(model.x))
    if model.element == "continuous":
        model, edges = _cut(model, float(eigenvalue.max(initial=0.0)), points)
    return shapes_of(model, solver, which, edges)


def shapes_of(model: Compiled, solver: str, which: Index, edges: Index) -> Shapes:
    """Solve for so many modes, and those that coincide with the last one, with their shapes."""
    number = more = len(which)
    while True:
        more += 1
        found = solve_components(model, solver, more, math.inf, shaped=True)
        value, error, order = merged(found, more, which)
        clusters = clusters_of(value, error)
        kept = [cluster for cluster in clusters if cluster[0] < number]
        last = kept[-1][-1] if kept else -1
        if last < more - 1 or len(value) < more:
            break
        more *= 2
    own = np.repeat(np.arange(len(found)), [len(part.eigenvalue) for part in found])[order]
    beyond = float(value[last + 1]) if last + 1 < len(value) else math.inf
    order = order[: last + 1]
    shape, motion = _spread(model, found)[order], _motion(model, found)[order]
    value, error = value[: last + 1], error[: last + 1]
    own = own[: last + 1]
    return Shapes(model, value, shape, motion, tuple(kept), edges, error, own, beyond)


def shapes_at(modes: Modes, points: Sequence[Point]) -> Real:
    """Return the shapes of modes at points of the rope."""
    # inside elements of a chain that of the element between its nodes; continuous spans are cut
    # there, which changes nothing
    if not isinstance(modes.sensitivity, Sensitivity):
        return np.asarray(modes.sensitivity.shapes_at(points))
    shapes, number = modes.sensitivity.shapes, len(modes.frequency)
    model = shapes.model
    inside = [at for _, at in points if locate(model.x, at)[1] is not None]
    if model.element == "continuous" and inside:
        x = np.unique(np.concatenate([model.x, inside]))
        model = divided(model.scene, "continuous", x, np.ones(len(x) - 1, dtype=np.intp))
        shapes = shapes_of(model, "sweep", shapes.which[:number], np.arange(len(x)))
    shape = shapes.shape[:number]
    shape = shape / np.abs(shape).max(axis=(1, 2), keepdims=True)
    node, row, _ = ports(model.chain, model.x, model.coordinates, points)
    beside = np.stack([shape[:, node], shape[:, node + 1]], axis=2)
    return np.einsum("psc,kpsc->kp", row, beside)


def vectors_of(
    model: Compiled, found: Sequence[ComponentModes], eigenvalue: Real, order: Index
) -> UndampedVectors:
    """Return what follows from the shapes of all components, in order."""
    shape = _spread(model, found)[order]
    strain, kinetic, dragged = model.chain.energy(shape, eigenvalue)
    motion = _motion(model, found)[order]
    carried = AttachedEnergy.real(model.chain, shape, motion, eigenvalue).of(model.chain)
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


def _motion(model: Compiled, found: Sequence[ComponentModes]) -> Real:
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
        if count and moved.any():
            assert part.motion is not None
            motion[:, moved] = part.motion
        motions.append(motion)
    return np.concatenate(motions)


def _spread(model: Compiled, found: Sequence[ComponentModes]) -> Real:
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


class _Energies(NamedTuple):
    """Twice the energies of shapes."""

    strain: Real  # (k, strains)
    kinetic: Real  # (k, coordinates) modal mass of the rope and its nodes
    dragged: Real  # (k,) modal damping of drag and dashpots
    carried: Real  # (k, 3) strain, modal mass and losses of all structures that nodes carry


def _damping_ratio(model: Compiled, omega: Real, energies: _Energies) -> Real:
    """Return zeta = shape^T Im(dynamic stiffness) shape / (2 omega^2 modal mass) at omega."""
    # and the ratio that a mode has by itself
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
    """Return shares of the strain and of the kinetic energy."""
    # `carried`, shape (kinds, k, 3), is of each kind of structure that the nodes carry
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
