"""The compiled chain: plain arrays that the core reads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Flags, Index, Real
from ..base.unit import ROLE, UNIT

KINDS = ("difference", "rigid", "tensed", "continuous")  # Kinds of element, in the core's order.

TENSED, CONTINUOUS = KINDS.index("tensed"), KINDS.index("continuous")

ATTACHED = ("resonator", "broken wire")
"""Kinds of structure that a node carries, in the core's order."""

CARRIED = {kind: f"{kind} mass" for kind in ATTACHED}  # Names of the kinetic energy of each.

PLANE = ("x", "z", "alpha", "beta")  # Coordinates of a chain in one plane, in the core's order.

NUMBERS = {c: PLANE.index(ROLE.get(c, c)) for c in UNIT}  # Of each coordinate in its plane.

CHANNELS = {"x": 0, "y": 3, "z": 2, "alpha": 1, "beta": 2, "gamma": 3}
"""Channel of the section (axial, torsion, bending, that in y) that carries a coordinate's force."""


def roles(coordinates: Sequence[str]) -> tuple[str, ...]:
    """Return what coordinates are in their own plane: of y and gamma z and beta."""
    return tuple([ROLE.get(c, c) for c in coordinates])


def plane_of(component: Sequence[str]) -> str:
    """Return the plane that coordinates move across in: "z", "y", "space", or "" where in none."""
    planes = [name for name in ("z", "y") if name in component]
    return "space" if len(planes) > 1 else "".join(planes)


TRANSVERSE = (("z", "beta"), ("y", "gamma"))  # What moves across in each plane, and what turns.


class Plane(NamedTuple):
    """One of the planes of a chain, as the core takes it."""

    chain: Chain
    kept: Any  # the index of its coordinates among those of the whole chain
    square: Any  # that of both axes of a matrix over them
    carried: Any  # that of its structures


class Chain(NamedTuple):
    """A chain as the core takes it; see csrc/chain/chain.h.

    Nodes with the same term and the same element on their right are a stretch; the last node is
    one alone. A chain in both planes has four channels, and the coordinates of both: y and gamma
    are another z and beta, for which the core takes them where a chain is theirs alone.
    """

    kind: int
    coordinate: NDArray[np.int32]  # (width,) numbers in `PLANE` of what each is in its plane
    length: Real  # (distinct,) [m]
    tension: Real  # (distinct,) [N]
    flexibility: Real  # (distinct, channels, channels) of the section, see `CHANNELS`
    first: NDArray[np.int32]  # (stretches,) first node, increasing from 0 to the last node
    element: NDArray[np.int32]  # (stretches - 1,) which distinct element stands right of each node
    mass: Real  # (terms, width, width)
    stiffness: Real  # (terms, width, width)
    held: NDArray[np.uint8]  # (terms, width)
    term: NDArray[np.int32]  # (stretches,) which node term
    hinge: Real | None = None
    """(terms, width) compliance between the node and the element on its right, infinite where
    free; None where nothing is hinged."""
    inertia: Real | None = None
    """(distinct, width) per length of continuous elements [kg/m, kg m]; None for others."""
    damping: Real | None = None
    """(terms, width, width) of dashpots [N s/m, N m s]; None where there are none."""
    drag: Real | None = None
    """(distinct, width) damping per length of continuous elements [N s/m^2, N s]; None where there
    is none."""
    sag: Real | None = None
    """(distinct,) weight per length over tension [1/m]; None without gravity."""
    rise: Real | None = None
    """(distinct,) how much more the tension is at the right end of continuous elements, which stand
    once each then [N]; None where it is the same along all of them."""
    attached_kind: NDArray[np.int32] | None = None
    """(attached,) kinds of the structures that nodes carry, see csrc/chain/attached.h; None where
    there are none, as the rest of them."""
    attached_term: NDArray[np.int32] | None = None  # (attached,) node term that carries it
    attached_row: Real | None = None
    """(attached, 2, width) displacement and rotation of its foot per motion of the node."""
    attached_value: Real | None = None  # (attached, 4) its numbers, its damping last

    @property
    def nodes(self) -> int:
        """How many nodes there are."""
        return int(self.first[-1]) + 1

    @property
    def element_of(self) -> NDArray[np.int32]:
        """Which distinct element stands right of each node, shape (nodes - 1,)."""
        return self.element.repeat(self._sizes[:-1])

    @property
    def term_of(self) -> NDArray[np.int32]:
        """Which node term each node has, shape (nodes,)."""
        return self.term.repeat(self._sizes)

    @property
    def _sizes(self) -> Index:
        """How many nodes each stretch has, shape (stretches,)."""
        sizes = np.ones(len(self.first), dtype=np.intp)
        sizes[:-1] = self.first[1:] - self.first[:-1]
        return sizes

    @property
    def free(self) -> int:
        """How many coordinates can move."""
        free_of_term = self.held.shape[1] - self.held.sum(axis=1, dtype=np.int64)
        return int(free_of_term[self.term] @ self._sizes)

    @property
    def spurious(self) -> int:
        """How many modes there are of lumps whose mass is negative, which are no motion."""
        # the end correction of tensed elements makes the mass matrix indefinite
        free = self.held == 0
        moving = np.where(free[:, :, None] & free[:, None, :], self.mass, 0.0)
        # of coordinates in their own units, in which 0 is told from rounding
        size = np.sqrt(np.abs(np.diagonal(moving, axis1=1, axis2=2)))
        size = np.where(size > 0, size, 1.0)
        scaled = moving / (size[:, :, None] * size[:, None, :])
        negative = (np.linalg.eigvalsh(scaled) < -1e-13).sum(axis=1)
        return int(negative[self.term] @ self._sizes)

    @property
    def finite(self) -> int | None:
        """How many modes there can be at most, None where inertia is spread along something."""
        if self.inertia is not None and self.inertia.any():
            return None
        kinds = () if self.attached_kind is None else self.attached_kind
        return None if ATTACHED.index("broken wire") in kinds else self.free + len(kinds)

    @property
    def undamped(self) -> Chain:
        """The chain without what is in proportion to velocity."""
        if self.damping is None and self.drag is None:
            return self
        return self._replace(damping=None, drag=None)

    @property
    def carried(self) -> tuple[str, ...]:
        """Kinds of the structures that nodes carry."""
        kinds = () if self.attached_kind is None else set(self.attached_kind.tolist())
        return tuple(ATTACHED[kind] for kind in sorted(kinds))

    @property
    def resists(self) -> bool:
        """Whether structures that nodes carry have damping of their own."""
        return bool(self._own_damping(range(len(ATTACHED))).any())

    @property
    def is_hysteretic(self) -> bool:
        """Whether that of some, of broken wires, is a complex modulus."""
        return bool(self._own_damping([ATTACHED.index("broken wire")]).any())

    def _own_damping(self, kinds: Sequence[int]) -> Real:
        """Return the damping of the structures of some kinds that these nodes carry."""
        if self.attached_value is None:
            return np.zeros(0)
        assert self.attached_kind is not None
        assert self.attached_term is not None
        own = np.isin(self.attached_kind, kinds) & np.isin(self.attached_term, self.term)
        return self.attached_value[own, -1]

    @property
    def feet(self) -> Index:
        """Nodes that carry the structures, -1 for those of another part, shape (attached,)."""
        if self.attached_term is None:
            return np.zeros(0, dtype=np.intp)
        carries = self.attached_term[:, None] == self.term
        return np.where(carries.any(axis=1), self.first[carries.argmax(axis=1)], -1)

    @property
    def section_loss(self) -> float:
        """What rounding grows by where bending twists or pulls: 1/det of S.

        S is the section's flexibility over the root of its diagonal: 1 without coupling.
        """
        S = self.flexibility[self.flexibility[:, :2, 2].any(axis=1)]
        size = np.sqrt(np.diagonal(S, axis1=1, axis2=2))
        size = np.where(size > 0, size, 1.0)
        scaled = S / (size[:, :, None] * size[:, None, :])
        absent = np.diagonal(scaled, axis1=1, axis2=2) == 0
        left = np.linalg.det(scaled + np.eye(3) * absent[:, None, :])
        return float(1 / max(left.min(initial=1.0), np.finfo(float).eps))

    @property
    def at_rest(self) -> Chain:
        """The chain at no speed, without inertia, where continuous elements are tensed exactly."""
        if self.rise is not None:
            assert self.inertia is not None
            return self.undamped._replace(inertia=np.zeros_like(self.inertia))
        kind = self.kind if self.inertia is None else TENSED
        return self.undamped._replace(kind=kind, inertia=None)

    def stretch(self, node: int) -> int:
        """Return the stretch that a node belongs to."""
        return int(self.first.searchsorted(node, side="right")) - 1

    @property
    def spans(self) -> tuple[tuple[int, int], ...]:
        """First and last node of what lies between nodes where nothing can move."""
        still: Flags = np.logical_and.reduce(self.held, axis=1)[self.term]
        nodes = [
            node
            for k in still[1:-1].nonzero()[0].tolist()
            for node in range(self.first[k + 1], self.first[k + 2])
        ]
        return tuple(pairwise([0, *nodes, self.nodes - 1]))

    def between(self, first: int, last: int) -> Chain:
        """Return the chain of some of the nodes."""
        if (first, last) == (0, self.nodes - 1):
            return self
        begin, end, after = map(self.stretch, (first, last - 1, last))
        nodes, term = (
            np.concatenate([of[begin : end + 1], of[after : after + 1]])
            for of in (self.first, self.term)
        )
        nodes -= first
        nodes[0], nodes[-1] = 0, last - first
        return self._replace(first=nodes, element=self.element[begin : end + 1], term=term)

    @property
    def is_spatial(self) -> bool:
        """Whether it lies in both planes."""
        return self.flexibility.shape[1] > CHANNELS["gamma"]

    @property
    def names(self) -> list[str]:
        """The coordinates, of one plane as those of z."""
        own = [PLANE[k] for k in self.coordinate]
        if self.is_spatial:  # y stands before z, gamma behind beta
            own[own.index("z")] = "y"
            own[-1] = "gamma" if own[-1] == "beta" else own[-1]
        return own

    @property
    def planes(self) -> list[Plane]:
        """The plane of z, with x and alpha, and that of y; the chain itself where it is in one."""
        if not self.is_spatial:
            return [Plane(self, slice(None), (slice(None), slice(None)), slice(None))]
        names, found = self.names, []
        for inside in (False, True):
            own = [c for c in names if (c in ROLE) == inside]
            kept, rows = np.array([names.index(c) for c in own]), self.attached_row
            carried = slice(None) if rows is None else rows[:, :, kept].any(axis=(1, 2))
            found.append(Plane(self.only(own), kept, (kept[:, None], kept), carried))
        return found

    def shape(self, left: int, s: float, at: int) -> Real:
        """Return how a coordinate inside an element moves with the nodes beside, (2, width)."""
        rows = np.zeros((2, len(self.coordinate)))
        for plane in self.planes:
            own = np.arange(len(self.coordinate))[plane.kept]
            if at in own:
                rows[:, own] = _core.shape(plane.chain, left, s)[own.searchsorted(at)]
        return rows

    @property
    def parted(self) -> list[tuple[Chain, list[int]]]:
        """Its components with their coordinates, where tension grows; the core takes each alone."""
        names = self.names
        groups = [tuple(names)] if self.rise is None else components(self, names)
        return [(self.only(group), [names.index(c) for c in group]) for group in groups]

    def energy(self, shape: Real, eigenvalue: Real) -> tuple[Real, Real, Real]:
        """Return strain, kinetic and dragged energy of shapes, twice; see `_core.energy`."""
        if self.rise is None and not self.is_spatial:
            return _core.energy(self, shape, eigenvalue)
        strain, kinetic, dragged = [], np.zeros((len(shape), shape.shape[2])), []
        for plane in self.planes:
            within = np.arange(shape.shape[2])[plane.kept]
            for part, at in plane.chain.parted:
                own = np.ascontiguousarray(shape[..., within[at]])
                stored, kinetic[:, within[at]], lost = _core.energy(part, own, eigenvalue)
                strain.append(stored)
                dragged.append(lost)
        return np.sum(strain, axis=0), kinetic, np.sum(dragged, axis=0)

    def only(self, coordinates: Sequence[str]) -> Chain:
        """Return the chain of some of the coordinates."""
        wanted = [NUMBERS[c] for c in coordinates]
        if wanted == self.coordinate.tolist():
            return self
        names = self.names
        kept = np.array(
            [names.index(c if self.is_spatial else ROLE.get(c, c)) for c in coordinates]
        )

        def columns(array: Any) -> Any:
            return None if array is None else array.take(kept, axis=-1)

        def squares(array: Any) -> Any:
            return None if array is None else array.take(kept, axis=-1).take(kept, axis=-2)

        flexibility = self.flexibility
        if self.is_spatial:
            of = [0, 1, CHANNELS["gamma" if ROLE.keys() & set(coordinates) else "beta"]]
            flexibility = np.ascontiguousarray(flexibility[:, of][:, :, of])
        # channels of other coordinates do not matter, and must not look as if they coupled
        used = np.isin(range(flexibility.shape[1]), [CHANNELS[ROLE.get(c, c)] for c in coordinates])
        matters = np.outer(used, used) | np.eye(len(used), dtype=np.bool_)
        flexibility = np.where(matters, flexibility, 0.0)
        return self._replace(
            coordinate=np.array(wanted, dtype=np.int32),
            flexibility=flexibility,
            mass=squares(self.mass),
            stiffness=squares(self.stiffness),
            held=columns(self.held),
            hinge=_present(columns(self.hinge)),
            inertia=columns(self.inertia),
            damping=_present(squares(self.damping)),
            drag=_present(columns(self.drag)),
            sag=self.sag if {"x", "z"} <= set(coordinates) else None,
            rise=self.rise if {"y", "z"} & set(coordinates) else None,
            attached_row=columns(self.attached_row),
        )._moving_attached

    def carries(self, kind: str) -> Flags:
        """Return which structures are of a kind of `ATTACHED`, shape (attached,)."""
        if self.attached_kind is None:
            return np.zeros(0, dtype=np.bool_)
        return np.asarray(self.attached_kind == ATTACHED.index(kind))

    @property
    def _moving_attached(self) -> Chain:
        """The chain with those structures alone whose feet its coordinates move."""
        row = self.attached_row
        return self if row is None else self.carrying(np.asarray(row.any(axis=(1, 2))))

    def carrying(self, these: Flags) -> Chain:
        """Return the chain with some of its structures alone, chosen by shape (attached,)."""
        if not these.any():
            return self._replace(
                attached_kind=None, attached_term=None, attached_row=None, attached_value=None
            )
        assert self.attached_kind is not None
        assert self.attached_term is not None
        assert self.attached_row is not None
        assert self.attached_value is not None
        return self._replace(
            attached_kind=self.attached_kind[these],
            attached_term=self.attached_term[these],
            attached_row=self.attached_row[these],
            attached_value=self.attached_value[these],
        )


def _present(array: Real | None) -> Real | None:
    """Return an array that has something in it, else None."""
    return array if array is not None and array.any() else None


def components(chain: Chain, coordinates: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Group the coordinates that move together.

    Two coordinates are joined where the section flexibility couples their channels, a node term or
    an attached structure couples them, or sag does x and z; z and beta are one bending motion.
    """
    width = len(coordinates)
    channel = np.array([CHANNELS[c] for c in coordinates])
    coupled: Flags = np.logical_or.reduce(chain.flexibility)[channel[:, None], channel]
    for of in (chain.mass, chain.stiffness, chain.damping):
        if of is not None:
            coupled |= np.logical_or.reduce(of)
    if chain.sag is not None:
        x, z = coordinates.index("x"), coordinates.index("z")
        coupled[x, z] = coupled[z, x] = True
    if chain.attached_row is not None:
        moved = (chain.attached_row != 0).any(axis=1)
        coupled |= (moved[:, :, None] & moved[:, None, :]).any(axis=0)
    group = list(range(width))
    for i, row in enumerate(coupled.tolist()):
        for j in range(i):
            if row[j]:
                group = [group[i] if g == group[j] else g for g in group]
    members = [tuple(c for c, g in zip(coordinates, group) if g == k) for k in range(width)]
    return tuple(sorted((m for m in members if m), key=lambda m: coordinates.index(m[0])))
