"""The compiled model: what every solver takes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.answer import Frozen
from ..base.array import Real
from ..base.computed import computed
from ..base.errors import SceneError
from ..scene.card import Card, card, card_html, card_text
from ..scene.damping import WireFriction, having, separable
from ..scene.parts.stretch import KINDS as STRETCHES
from ..scene.rope import ACROSS, own_number
from ..scene.scene import Scene
from . import matrices
from .chain import CHANNELS, PLANE, TRANSVERSE, Chain
from .lean import lean
from .mesh_choice import Choice

if TYPE_CHECKING:
    import scipy.sparse as sp


EXACT = ("tensed", "continuous")  # Elements that can be cut anywhere.

MOST_STEPS = 10_000_000  # A walk over continuous spans has at most so many steps.

MOST_POINTS = 1_000_000  # An answer is given at so many parts of a continuous element at most.


BELOW = 1e-9  # A bound is taken by so much.


KEPT = 8  # So many answers to a question are kept for when it is asked again,
NUMBERS = 1 << 17  # each of so many numbers at most.

Answered = TypeVar("Answered", bound=tuple[Any, ...])


class Triples(NamedTuple):
    """The distinct elements: u_b = F u_a + G f_b and f_a = F^T f_b - Q u_a.

    Attributes
    ----------
    F, G, Q : ndarray, shape (distinct, width, width)
        Over the model's coordinates, SI units.
    element : ndarray of int, shape (elements,)
        Which of them stands where.
    """

    F: Real
    G: Real
    Q: Real
    element: NDArray[np.int32]


class NodeTerms(NamedTuple):
    """What stands at the nodes: inertia, springs to the ground, supports.

    Attributes
    ----------
    mass, stiffness : ndarray, shape (terms, width, width)
        Over the model's coordinates [kg, kg m, kg m^2; N/m, N, N m].
    held : ndarray of uint8, shape (terms, width)
        1 where a coordinate cannot move.
    term : ndarray of int, shape (nodes,)
        Which of them stands where.
    """

    mass: Real
    stiffness: Real
    held: NDArray[np.uint8]
    term: NDArray[np.int32]


@dataclass(frozen=True, eq=False, repr=False)
class Compiled(Frozen):
    """A scene compiled to plain arrays that the core reads: what solvers take; see `Model`."""

    scene: Scene
    element: str
    coordinates: tuple[str, ...]
    components: tuple[tuple[str, ...], ...]
    x: Real
    chain: Chain
    unknowns: tuple[int, ...]
    choice: Choice | None = None

    def __repr__(self) -> str:
        return card_text(*self._card)

    def _repr_html_(self) -> str:
        return card_html(*self._card)

    @property
    def _card(self) -> tuple[str, Card]:
        spans = f"continuous spans, {len(self.x)} stations"
        chain = f"{len(self.x) - 1} {self.element} elements, {self.size} unknowns"
        cut = {"model": spans if self.element == "continuous" else chain}
        return "Model of a rope", card(self.scene) | cut

    @property
    def size(self) -> int:
        """Number of unknowns: coordinates of nodes that can move."""
        return sum(self.unknowns)

    @computed
    def _nonlinear(self) -> str:
        """What a part must be for a linear scene, as ``parts[0].exponent must be 1``; or empty."""
        for i, part in enumerate(self.scene.parts):
            if not isinstance(part, STRETCHES) and (must_be := part.term().nonlinear):
                return f"parts[{i}].{must_be}"
        return ""

    @computed
    def _parts(self) -> dict[tuple[str, ...], Chain]:
        """Undamped chains of the components, spans joined that nothing parts."""
        return {c: lean(self.chain.undamped.only(c))[0] for c in self.components}

    @computed
    def _told(self) -> dict[Any, Any]:
        """What was computed of it last, by what was asked; see `once`."""
        return {}

    @computed
    def _least(self) -> dict[tuple[str, ...], float]:
        """What no eigenvalue of each component is below [rad^2/s^2]; 0 where that is not told."""
        return {c: _least_of_rod(chain) for c, chain in self._parts.items()}

    @property
    def mesh_order(self) -> dict[str, float]:
        """The power of the elements' length that frequencies converge with at least, by coordinate.

        Of coordinates that move together and have inertia it is the least. Infinite without a mesh
        error, 0 where refinement leads elsewhere. A coordinate that turns out better than the least
        is coupled to it by little. `Scene.compile` begins with it where a tolerance
        chooses the elements.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=2.0, axial_stiffness=1e5)
        >>> rd.Scene(rope, tension=100.0).compile(elements=8).mesh_order
        {'x': 2.0, 'z': 4.0, 'beta': 4.0}
        """
        if self.element == "continuous":
            return dict.fromkeys(self.coordinates, math.inf)
        order = dict.fromkeys(self.coordinates, 2.0)
        for across, turns in TRANSVERSE:
            if turns in order:
                order[across] = order[turns] = self._bending_order(across, turns)
        moved = np.abs(np.diagonal(self.chain.mass, axis1=1, axis2=2)).max(axis=0)
        slow = {self.coordinates[k] for k in np.flatnonzero(moved)}
        for part in self.components:
            least = min((order[c] for c in part if c in slow), default=2.0)
            order |= dict.fromkeys(part, least)
        return order

    def _bending_order(self, across: str, turning: str) -> float:
        if self.element != "tensed":
            return 2.0 if self.element == "rigid" else 0.0
        if self.scene.is_graded:  # of which each element has the mean
            return 2.0
        name = "rotary_inertia" if turning == "beta" else ACROSS["rotary_inertia"]
        turns, hinge = bool(own_number(self.scene.rope, name)), self.chain.hinge
        held = self.chain.held[:, self.coordinates.index(across)] != 0
        at = self.coordinates.index(turning)
        if hinge is not None and ((hinge[:, at] != 0) & ~held).any():
            return 1.0 if turns else 2.0
        return 2.0 if turns else 4.0

    @property
    def separable(self) -> bool:
        """Whether damping scales parts of the assembled stiffness that the model keeps apart.

        In a tensed element that bends, sections and tension are one, and in a string that hangs.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope, damping = rd.Rope(1.0, 0.1, bending_stiffness=1.0), rd.StiffnessDamping(1e-4)
        >>> scene = rd.Scene(rope, tension=100.0, damping=damping)
        >>> [scene.compile(elements=4, element=kind).separable for kind in ("rigid", "tensed")]
        [True, False]
        """
        bends = "beta" in self.coordinates
        inseparable = self.element == "tensed" if bends else self.scene.gravity is not None
        if not inseparable or self.scene.mean_tension == 0:
            return True
        return separable(self.scene.dampings)

    @property
    def triples(self) -> Triples:
        """The distinct elements, at rest.

        Raises
        ------
        SolveError
            If the compression is exactly the critical load of one element.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=4, element="rigid")
        >>> model.triples.G.round(6), model.triples.element
        (array([[[0.0025]]]), array([0, 0, 0, 0], dtype=int32))
        """
        if self.chain.rise is not None:
            raise SceneError("elements must be given for triples where the tension grows")
        found = np.zeros((3, len(self.chain.length), *2 * (len(self.coordinates),)))
        for plane in self.chain.planes:
            for whole, own in zip(found, _core.triples(plane.chain.at_rest)):
                whole[:, *plane.square] = own
        F, G, Q = found
        return Triples(F, G, Q, self.chain.element_of)

    @property
    def node_terms(self) -> NodeTerms:
        """The distinct node terms.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=4, element="rigid")
        >>> model.node_terms.held.tolist(), model.node_terms.term.tolist()
        ([[1], [1], [0]], [0, 2, 2, 2, 1])
        """
        chain = self.chain
        return NodeTerms(chain.mass, chain.stiffness, chain.held, chain.term_of)

    def stiffness_matrix(self) -> sp.csr_array:
        """Assemble the stiffness matrix, tension included.

        Returns
        -------
        scipy.sparse.csr_array, shape (size, size)
            Over the free coordinates, node by node in the order of `coordinates` [N/m, N, N m].

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=3, element="rigid")
        >>> print(model.stiffness_matrix().toarray().round(6))
        [[ 600. -300.]
         [-300.  600.]]
        """
        self._refuse_matrices()
        return matrices.stiffness(self.chain)

    def mass_matrix(self) -> sp.csr_array:
        """Assemble the mass matrix.

        Returns
        -------
        scipy.sparse.csr_array, shape (size, size)
            Over the free coordinates [kg, kg m, kg m^2].

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.3), tension=100.0).compile(elements=3, element="rigid")
        >>> print(model.mass_matrix().toarray().round(6))
        [[0.1 0. ]
         [0.  0.1]]
        """
        self._refuse_matrices()
        return matrices.mass(self.chain)

    def damping_matrix(self) -> sp.csr_array:
        """Assemble the damping matrix.

        Returns
        -------
        scipy.sparse.csr_array, shape (size, size)
            Over the free coordinates [N s/m, N s, N m s].

        Raises
        ------
        SceneError
            If there is none: tensed elements with tension and stiffness damping, a loss factor,
            modal damping.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.3), tension=100.0, damping=rd.ViscousDamping(6.0))
        >>> model = scene.compile(elements=3, element="rigid")
        >>> print(model.damping_matrix().toarray().round(6))
        [[2. 0.]
         [0. 2.]]
        """
        self._refuse_matrices()
        refuse_nonlinear(self)
        for one in having(self.scene.dampings, "loss", "ratio"):
            raise SceneError(
                f"damping must be in proportion to velocity to have a matrix, got {one}"
            )
        if not self.separable:
            raise SceneError(
                "damping must scale sections and tension alike for tensed elements or a hanging "
                f"string to have a damping matrix, got {self.scene.damping}"
            )

        return matrices.damping(self.chain, self.scene.dampings)

    def _refuse_matrices(self) -> None:
        if self.element == "continuous":
            raise SceneError(
                "elements must be given for matrices: continuous spans have none, their stiffness "
                "depends on the frequency"
            )
        if self.chain.attached_kind is not None:
            kinds = " or ".join(self.chain.carried)
            raise SceneError(
                f"parts must not have a {kinds} for matrices: their stiffness depends on the "
                "frequency"
            )

    def component_of(self, coordinate: str) -> tuple[str, ...]:
        """Return the coordinates that move with this one.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.2)
        >>> rd.Scene(rope, tension=100.0).compile(elements=4).component_of("beta")
        ('z', 'beta')
        """
        return next(c for c in self.components if coordinate in c)


def part_of(model: Compiled, component: tuple[str, ...]) -> Chain:
    """Return the undamped chain of a component, spans joined that nothing parts."""
    return model._parts[component]


def with_plain_lumps(model: Compiled, component: tuple[str, ...]) -> Compiled:
    """Return the model with plain lumps where corrected ones of a component have negative inertia.

    Those move before what moves them, which no motion over time that is followed takes.
    """
    chain = model.chain
    if not chain.only(component).spurious:
        return model
    return replace(model, chain=chain._replace(mass=chain.mass * np.eye(chain.mass.shape[1])))


def once(model: Compiled, asked: Any, compute: Callable[[], Answered]) -> Answered:
    """Return what computes, or what it returned when the same was asked of the model before.

    That must be a tuple: its arrays become read-only. The last few are kept, but what is large.
    """
    told = model._told
    known: Answered | None = told.get(asked)
    if known is not None:
        return known
    known = compute()
    arrays = [one for one in known if isinstance(one, np.ndarray)]
    if sum(one.size for one in arrays) <= NUMBERS:
        for one in arrays:
            one.setflags(write=False)
        for old in list(told)[: max(0, len(told) - KEPT + 1)]:
            told.pop(old, None)
        told[asked] = known
    return known


def least_of(model: Compiled, component: tuple[str, ...]) -> float:
    """Return what no eigenvalue of a component is below [rad^2/s^2], 0 where that is not told."""
    return model._least[component]


def rubbing(model: Compiled) -> WireFriction | None:
    """Return the friction between wires that a scene has, None where there is none."""
    found = [one for one in model.scene.dampings if isinstance(one, WireFriction)]
    return found[0] if found else None


def refuse_nonlinear(model: Compiled) -> None:
    """Refuse a scene with a part that only integration over time takes, or whose wires rub."""
    refuse_rubbing(model, "that depends on the amplitude, which only")
    if model._nonlinear:
        raise SceneError(f"{model._nonlinear}: only integration over time takes others")


def refuse_rubbing(model: Compiled, why: str) -> None:
    """Refuse friction between wires."""
    if rubbing(model):
        raise SceneError(
            f"damping must not be friction between wires here: {why} frf and stepped_sine with an "
            'amplitude take. Say scene.without("wire friction") for motion in which nothing slips, '
            "or Section.bending and Section.loss of an amplitude for B and a LossFactor"
        )


def _least_of_rod(chain: Chain) -> float:
    """Return what no eigenvalue of a rod is below, 0 where it is not told: 1/(mass flexibility)."""
    # of the rod without the springs and supports inside it, which is softer: L from one end, of S
    # in all, the flexibility is L (S - L)/S, at most S/4, or at most S where the other end is free
    coordinate, beside = PLANE[chain.coordinate[0]], (chain.attached_row, chain.hinge)
    several = len(chain.coordinate) > 1 or any(one is not None for one in beside)
    if coordinate == "z" or chain.inertia is None or several:
        return 0.0
    mass, spring = chain.mass[:, 0, 0], chain.stiffness[:, 0, 0]
    if min(spring.min(), mass.min()) < 0:
        return 0.0
    length, channel = chain.length[chain.element] * np.diff(chain.first), CHANNELS[coordinate]
    give = float(length @ chain.flexibility[chain.element, channel, channel])
    moved = float(length @ chain.inertia[chain.element, 0]) + float(mass[chain.term].sum())
    ends = [term for term in chain.term[[0, -1]] if chain.held[term, 0] or spring[term]]
    give += sum(0.0 if chain.held[term, 0] else 1 / float(spring[term]) for term in ends)
    if moved * give == 0:
        return 0.0
    return (0, 1, 4)[len(ends)] / (moved * give) * (1 - BELOW)
