"""From a scene to a model: stations, elements, node terms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base import check
from ..base.array import Flags, Index, Real
from ..base.errors import SceneError
from ..scene.agree import refuse_axis
from ..scene.damping import drag
from ..scene.end import end_of
from ..scene.parts.node import Attached, NodeTerm
from ..scene.parts.part import places, standing, stretches
from ..scene.parts.stretch import ropes
from ..scene.rope import ACROSS, Rope, own_number
from ..scene.scene import Scene
from ..scene.stations import nearest, shares, stations_at
from .chain import ATTACHED, CONTINUOUS, KINDS, NUMBERS, TENSED, TRANSVERSE, Chain, components
from .compiled import EXACT, MOST_POINTS, Compiled

MOST_ELEMENTS = 10_000_000

INERTIA = {
    "x": "linear_density",
    "y": "linear_density",
    "z": "linear_density",
    "alpha": "polar_inertia",
    "beta": "rotary_inertia",
    "gamma": ACROSS["rotary_inertia"],
}
"""Property of the rope that is the inertia per length of each coordinate."""

ROUNDING = 4 * np.finfo(float).eps  # Positions are known to so much of the rope's length.

MOST_RADIANS = 1e10  # A continuous span has boundary layers, L sqrt(T/B), of at most this.


def compile_scene(
    scene: Scene, *, elements: int | None = None, element: str | None = None
) -> Compiled:
    """Compile a scene; see `Scene.compile`."""
    refuse_axis(scene, "a chain of elements or spans")
    if element is None:
        element = "continuous" if elements is None else "tensed"
    check.one_of(element, "element", KINDS)
    if elements is not None:
        check.count(elements, "elements", most=MOST_ELEMENTS)
    elif element != "continuous":
        raise SceneError(f"elements must be given, how many {element!r} ones, got None")
    stations = stations_of(scene)
    if elements is None:
        counts = np.ones(len(stations) - 1, dtype=np.intp)
    else:
        counts = shares(np.diff(stations), elements)
    return divided(scene, element, stations, counts)


def stations_of(scene: Scene) -> Real:
    """Return where the ends and parts of a scene stand, begin and end [m]."""
    return stations_at(scene.rope.length, places(scene.parts))


def divided(scene: Scene, element: str, stations: Real, counts: Index) -> Compiled:
    """Compile a scene with so many elements between stations."""
    kind = KINDS.index(element)
    if (
        element == "difference"
        and scene.mean_tension != 0
        and scene.rope.bending_stiffness is not None
    ):
        raise SceneError(
            'element must not be "difference" where there is bending and tension: the '
            "2015 study's kinematics has no geometric stiffness"
        )
    if "y" in scene.coordinates and element not in EXACT:
        raise SceneError(
            f'element must be "continuous" or "tensed" where planes is "both", got {element!r}: '
            "it has one plane"
        )
    spans = stations[1:] - stations[:-1]
    if not (spans / counts > 0).all():
        raise SceneError(
            f"elements must be longer than the smallest number, got {int(counts.sum())} on "
            f"{scene.rope.length!r} m"
        )
    local, rope = ropes(scene.rope, stretches(scene.parts), stations)
    if element == "continuous":
        _check_layers(scene, local)
    division = Division(*_core.divide(stations, counts, rope, ROUNDING * float(spans.sum())))
    if scene.is_graded:
        division = _apart(division, stations)
    elements = _elements(scene, local, rope[division.span])
    chain = _chain(scene, kind, stations, division, elements)
    groups = components(chain, scene.coordinates)
    # nothing is held but at stations, each of which is a node
    count = len(stations if kind == CONTINUOUS else division.x)
    free = dict(zip(scene.coordinates, (count - chain.held.sum(axis=0)).tolist()))
    return Compiled(
        scene=scene,
        element=element,
        coordinates=scene.coordinates,
        components=groups,
        x=division.x,
        chain=chain,
        unknowns=tuple(sum(free[c] for c in group) for group in groups),
    )


def station_nodes(model: Compiled) -> Index:
    """Return the nodes of a model at the stations of its scene."""
    return np.searchsorted(model.x, stations_of(model.scene))


def finer(model: Compiled, points: int) -> Compiled:
    """Return the same continuous spans with nodes at the ends of equal parts of their elements."""
    counts = np.diff(station_nodes(model)) * points
    return divided(model.scene, model.element, stations_of(model.scene), counts)


def remeshed(model: Compiled, scene: Scene) -> Compiled:
    """Compile another scene, with the elements that each span of a model has; one if continuous."""
    stations = stations_of(scene)
    if model.element == "continuous":
        counts = np.ones(len(stations) - 1, dtype=np.intp)
    else:
        counts = np.diff(station_nodes(model))
    return divided(scene, model.element, stations, counts)


def check_points(model: Compiled, points: int | None) -> None:
    """Refuse points inside the elements of a chain, and numbers of them without meaning."""
    if points is None:
        return
    check.count(points, "points", most=MOST_POINTS)
    if model.element != "continuous":
        raise SceneError(f"points must be left out for chains, got {points}: answers are at nodes")


def _check_layers(scene: Scene, local: Sequence[Rope]) -> None:
    """Refuse boundary layers too thin for the rope to be halved into them."""
    names = ["bending_stiffness"] + [ACROSS["bending_stiffness"]] * ("gamma" in scene.coordinates)
    bending = [B for rope in local for name in names if (B := own_number(rope, name)) is not None]
    if not bending:
        return
    most = max(np.abs(scene.grade.left).max(), np.abs(scene.grade.right).max())
    radians = scene.rope.length * np.sqrt(most) / np.sqrt(min(bending))
    if not radians <= MOST_RADIANS:
        raise SceneError(
            f"bending_stiffness must leave L sqrt(T/B) at most {MOST_RADIANS:g} in continuous "
            f"spans, got {radians:.3g}: without bending_stiffness the rope is a string"
        )


def section(rope: Rope, channels: int = 3) -> Real:
    """Return the section flexibility of a rope, with that of bending in the plane of y beside."""
    own = _core.section(
        rope.axial_stiffness or 0.0,
        rope.torsional_stiffness or 0.0,
        own_number(rope, "bending_stiffness") or 0.0,
        rope.lay_coupling or 0.0,
        rope.lay_slope or 0.0,
    )
    if channels == len(own):
        return own
    both = np.zeros((channels, channels))
    both[:-1, :-1] = own
    across = own_number(rope, ACROSS["bending_stiffness"])
    both[-1, -1] = 0.0 if across is None else 1.0 / across
    return both


class Division(NamedTuple):
    """Equal elements between stations, as the core tells them; see csrc/chain/division.h.

    Those of one rope that differ by the rounding of positions are one, as long as their mean.
    """

    length: Real  # (distinct,) [m], in the order they come in
    span: Index  # (distinct,) the first one that has each
    which: NDArray[np.int32]  # (spans,) which of them each span has
    within: Index  # those that have nodes inside spans, increasing
    first: NDArray[np.int32]  # (stretches,) as in `Chain`
    element: NDArray[np.int32]  # (stretches - 1,) as in `Chain`
    term: NDArray[np.int32]  # (stretches,) stations first, then nodes inside spans by `within`
    x: Real  # (nodes,) [m]


class Elements(NamedTuple):
    """What the distinct elements are made of."""

    flexibility: Real  # (distinct, 3, 3) of the section
    inertia: Real  # (distinct, width) per length [kg/m, kg m]
    sag: Real | None  # (distinct,) weight per length over tension [1/m], None without gravity


def _elements(scene: Scene, local: Sequence[Rope], rope: Index) -> Elements:
    """Return what elements of so many different ropes are made of, by which of them each is of."""
    flexibility = np.array([section(one, 3 + ("y" in scene.coordinates)) for one in local])
    inertia = np.array([inertia_of(scene, one) for one in local])
    sag = None
    if scene.sags:
        assert scene.gravity is not None
        # a rope that hangs is longer than its chord along x
        flexibility[:, 0, 0] *= scene.gravity.lengthening(scene.rope, scene.mean_tension)
        curvature = [scene.gravity.curvature(one, scene.mean_tension) for one in local]
        sag = np.array(curvature)[rope]
    return Elements(flexibility[rope], inertia[rope], sag)


def _chain(
    scene: Scene, kind: int, stations: Real, division: Division, elements: Elements
) -> Chain:
    """Return the chain of these elements, with what stands at the stations."""
    length, inertia, width = division.length, elements.inertia, len(scene.coordinates)
    tension, rise = _tensions(scene, division, kind)
    along = np.empty((len(length), width))
    along[:] = drag(scene.dampings) * dragged(scene)
    size = (len(stations) + len(division.within), width, width)
    mass, damping, is_lumped = np.zeros(size), np.zeros(size), kind != CONTINUOUS
    if is_lumped:
        _add_lumps(mass, lumped(kind, scene.coordinates, inertia, length), division)
        _add_lumps(damping, halves(kind, along, length), division)
    terms = list(standing_at(scene, stations))
    stiffness, held, hinge = terms_of(scene, terms, mass, damping)
    chain = Chain(
        kind=kind,
        coordinate=np.array([NUMBERS[c] for c in scene.coordinates], dtype=np.int32),
        length=length,
        tension=tension,
        flexibility=elements.flexibility,
        first=division.first,
        element=division.element,
        mass=mass,
        stiffness=stiffness,
        held=held,
        term=division.term,
        hinge=hinge,
        inertia=None if is_lumped else inertia,
        damping=damping if damping.any() else None,
        drag=along if along.any() and not is_lumped else None,
        sag=elements.sag,
        rise=rise,
    )
    return _with_attached(scene, stations, terms, chain)


def _tensions(scene: Scene, division: Division, kind: int) -> tuple[Real, Real | None]:
    """Return the mean tension of elements, and how it grows along continuous ones."""
    if not scene.is_graded:
        return np.full(len(division.length), scene.mean_tension), None
    left, right = scene.grade.parted(division.x)
    return (left + right) / 2, right - left if kind == CONTINUOUS else None


def _apart(division: Division, stations: Real) -> Division:
    """Return the division with every element a distinct one."""
    sizes = np.diff(np.append(division.first, len(division.x)))
    each = division.element.repeat(sizes[:-1])
    return Division(
        length=division.length[each],
        span=division.span[each],
        which=division.x.searchsorted(stations[:-1]).astype(np.int32),
        within=np.unique(each, return_index=True)[1][division.within],
        first=np.arange(len(division.x), dtype=np.int32),
        element=np.arange(len(each), dtype=np.int32),
        term=division.term.repeat(sizes),
        x=division.x,
    )


def _with_attached(
    scene: Scene, stations: Real, terms: Iterable[tuple[int, NodeTerm]], chain: Chain
) -> Chain:
    """Return the chain with the structures that its stations carry."""
    carried = [(at, one) for at, _, one in carried_by(scene, terms)]
    if not carried:
        return chain
    row = np.zeros((len(carried), 2, len(scene.coordinates)))
    for k, (station, one) in enumerate(carried):
        for line, moves in enumerate((one.displacement, one.rotation)):
            for coordinate, value in moves.items():
                if coordinate in scene.coordinates:
                    row[k, line, scene.coordinates.index(coordinate)] = value
        if not (row[k].any(axis=0) & (chain.held[station] == 0)).any():
            raise SceneError(
                f"a {one.kind} must stand where its foot can move, got one at "
                f"{float(stations[station])!r} m, where that is held"
            )
    return chain._replace(
        attached_kind=np.array([ATTACHED.index(one.kind) for _, one in carried], dtype=np.int32),
        attached_term=np.array([station for station, _ in carried], dtype=np.int32),
        attached_row=row,
        attached_value=np.array([one.value for _, one in carried]),
    )


def carried_by(
    scene: Scene, terms: Iterable[tuple[int, NodeTerm]]
) -> list[tuple[int, NodeTerm, Attached]]:
    """Return the structures of what stands at stations, in the order that the chain has them in."""
    carried = [
        (at, term, one)
        for at, term in terms
        for one in term.attached
        if next(iter(one.displacement)) in scene.coordinates
    ]
    carried.sort(key=lambda one: one[0])  # stable: those of a station in the order of the parts
    return carried


def terms_of(
    scene: Scene,
    terms: Iterable[tuple[int, NodeTerm]],
    mass: Real,
    damping: Real,
) -> tuple[Real, NDArray[np.uint8], Real | None]:
    """Add masses and dashpots of parts to those of the distinct node terms, stations first."""
    width = len(scene.coordinates)
    stiffness = np.zeros_like(mass)
    held = np.zeros((len(mass), width), dtype=np.uint8)
    hinge = None
    number = {c: k for k, c in enumerate(scene.coordinates)}
    for station, term in terms:
        given = ((term.mass, mass), (term.stiffness, stiffness), (term.damping, damping))
        for values, into in given:
            for coordinate, value in values.items():
                if value != 0.0 and coordinate in number:
                    k = number[coordinate]
                    into[station, k, k] += value
        for coordinate in term.held:
            if coordinate in number:
                held[station, number[coordinate]] = 1
        for coordinate, compliance in term.hinge.items():
            hinge = np.zeros((len(mass), width), dtype=mass.dtype) if hinge is None else hinge
            hinge[station, number[coordinate]] += compliance
    return stiffness, held, hinge


def _add_lumps(terms: Real, given: Real, division: Division) -> None:
    """Add what elements give to the nodes beside them: to stations, then inside spans."""
    beside, spans = given[division.which], len(division.which)
    terms[1 : spans + 1] += beside[:, 1]
    terms[:spans] += beside[:, 0]
    terms[spans + 1 :] = given[division.within].sum(axis=1)


def halves(kind: int, along: NDArray[Any], length: NDArray[Any]) -> NDArray[Any]:
    """Return what is `along` elements, per length, half on either node: see `lumped`."""
    count, width = along.shape
    given = np.zeros((count, 2, width, width), dtype=np.result_type(along, length))
    if kind != CONTINUOUS:
        with np.errstate(over="ignore"):  # the core refuses what is no number
            np.einsum("eskk->esk", given)[:] = (along * length[:, None] / 2)[:, None]
    return given


def lumped(
    kind: int, coordinates: Sequence[str], inertia: NDArray[Any], length: NDArray[Any]
) -> NDArray[Any]:
    """Return the inertia that elements give to their left and to their right node.

    Half of it each, and of tensed elements +-mu l^2/12 at z and beta: lumping is the trapezoidal
    rule, this is its first error term by Euler and Maclaurin, zero inside a uniform span. With it
    bending of tensed chains converges with the fourth power of the element's length; no lumps make
    twist, stretch, strings or rotary inertia do so (docs/theory/elements.md).
    """
    given = halves(kind, inertia, length)
    if kind != TENSED or "beta" not in coordinates:
        return given
    density = inertia[:, coordinates.index("z")]
    with np.errstate(over="ignore", invalid="ignore"):
        correction = density * length**2 / 12
    if not np.isfinite(correction).all():
        raise SceneError(
            f"elements must be short enough for linear_density length^2 to be a number [kg m], got "
            f"{float(density.max())!r} kg/m and {float(length.max())!r} m"
        )
    for across, turn in TRANSVERSE:
        if across in coordinates:
            i, j = coordinates.index(across), coordinates.index(turn)
            given[:, 0, i, j] = given[:, 0, j, i] = correction
            given[:, 1, i, j] = given[:, 1, j, i] = -correction
    return given


def inertia_of(scene: Scene, rope: Rope) -> Real:
    """Return the inertia per length of each coordinate [kg/m, kg m]; sag follows at once."""
    own = [own_number(rope, INERTIA[c]) or 0.0 for c in scene.coordinates]
    return np.array(own) * has_inertia(scene)


def has_inertia(scene: Scene) -> Flags:
    """Say on which coordinates the rope's own inertia acts, shape (width,)."""
    still = ("x",) if scene.sags else ()
    return np.array([c not in still for c in scene.coordinates])


def dragged(scene: Scene) -> Real:
    """Return 1 for each coordinate that damping along the rope acts on, else 0, shape (width,)."""
    along = ("y", "z") if scene.sags else ("x", "y", "z")
    return np.array([float(c in along) for c in scene.coordinates])


def standing_at(scene: Scene, stations: Real) -> Iterator[tuple[int, NodeTerm]]:
    """Return what stands at which station."""
    for station, end in zip((0, len(stations) - 1), map(end_of, scene.ends)):
        yield station, end.term()
    parts = standing(scene.parts)
    for station, part in zip(nearest(stations, places(parts)).tolist(), parts):
        yield station, part.term()
