"""From a scene to a model: stations, elements, node terms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import _core, check, mesh
from .chain import Chain, components
from .end import End, end_of
from .errors import SceneError
from .model import Model
from .part import NodeTerm, node_term
from .rope import Rope
from .scene import Scene

KINDS = ("difference", "rigid", "tensed")
"""Kinds of element, in the core's order."""

MOST_ELEMENTS = 10_000_000


def compile_scene(scene: Scene, *, elements: int, element: str) -> Model:
    """Compile a scene; see `Scene.compile`."""
    check.count(elements, "elements", most=MOST_ELEMENTS)
    kind = KINDS.index(check.one_of(element, "element", KINDS))
    if element == "difference" and scene.tension != 0 and scene.rope.bending_stiffness is not None:
        raise SceneError(
            'element must not be "difference" where there is bending and tension: the '
            "2015 study's kinematics has no geometric stiffness"
        )
    stations = mesh.stations(scene.rope.length, (part.x for part in scene.parts))
    spans = np.diff(stations)
    counts = mesh.shares(spans, elements)
    if not (spans / counts > 0).all():
        raise SceneError(
            f"elements must be longer than the smallest number, got {elements} on "
            f"{scene.rope.length!r} m"
        )
    mass, stiffness, held, term_of, hinge = _terms(scene, element, stations, counts)
    chain = Chain(
        kind,
        np.array([check.COORDINATES.index(c) for c in scene.coordinates], dtype=np.int32),
        *_elements(scene, spans, counts),
        mass,
        stiffness,
        held,
        term_of,
        hinge,
    )
    groups = components(chain, scene.coordinates)
    parts = [chain.only(group) for group in groups]
    for array in chain:
        if isinstance(array, np.ndarray):
            array.flags.writeable = False
    return Model(
        scene=scene,
        element=element,
        coordinates=scene.coordinates,
        components=groups,
        x=_positions(stations, counts),
        chain=chain,
        runs=tuple(_core.runs(part) for part in parts),
        unknowns=tuple(part.free for part in parts),
    )


def section(rope: Rope) -> NDArray[np.float64]:
    """Return the section flexibility of a rope.

    Returns
    -------
    ndarray, shape (3, 3)
        (axial strain, twist rate, curvature) per (axial force, torque, bending moment), zero where
        the rope has no such stiffness.
    """
    return _core.section(
        rope.axial_stiffness or 0.0,
        rope.torsional_stiffness or 0.0,
        rope.bending_stiffness or 0.0,
        rope.lay_coupling or 0.0,
        rope.lay_slope or 0.0,
    )


def _positions(stations: NDArray[np.float64], counts: NDArray[np.intp]) -> NDArray[np.float64]:
    pieces = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(stations, stations[1:], counts)
    ]
    x = np.concatenate([*pieces, stations[-1:]])
    x.flags.writeable = False
    return x


def _elements(
    scene: Scene, spans: NDArray[np.float64], counts: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Return length, tension, flexibility of the distinct elements and which stands where."""
    length, which = _distinct(spans / counts)
    return (
        length,
        np.full(len(length), scene.tension),
        np.tile(section(scene.rope), (len(length), 1, 1)),
        np.repeat(which.astype(np.int32), counts),
    )


def _distinct(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return different values in the order they come in, and which of them each is."""
    _, first, which = np.unique(values, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return values[first[order]], rank[which]


def _terms(
    scene: Scene, element: str, stations: NDArray[np.float64], counts: NDArray[np.intp]
) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.uint8],
    NDArray[np.int32],
    NDArray[np.float64] | None,
]:
    """Return mass, stiffness, held of the distinct node terms, which stands where, and hinges.

    Term 2 k is station k's, term 2 k + 1 that of the nodes inside the span right of it.
    """
    width = len(scene.coordinates)
    lengths = np.diff(stations) / counts
    beside = np.zeros(2 * len(stations) - 1)
    beside[1::2] = lengths
    beside[2::2] += lengths / 2
    beside[:-1:2] += lengths / 2
    mass = beside[:, None, None] * np.diag(_inertia(scene))
    if element == "tensed" and "beta" in scene.coordinates:
        _correct_ends(scene, lengths, mass)
    stiffness = np.zeros((len(beside), width, width))
    held = np.zeros((len(beside), width), dtype=np.uint8)
    hinge = np.zeros((len(beside), width))
    for station, term in _standing(scene, stations):
        mass[2 * station] += term.mass
        stiffness[2 * station] += term.stiffness
        held[2 * station] |= term.held
        hinge[2 * station] += term.hinge
    pattern = np.arange(len(beside), dtype=np.int32)
    times = np.ones(len(beside), dtype=np.intp)
    times[1::2] = counts - 1
    return mass, stiffness, held, np.repeat(pattern, times), hinge if hinge.any() else None


def _correct_ends(scene: Scene, lengths: NDArray[np.float64], mass: NDArray[np.float64]) -> None:
    """Add M_z,beta = -(mu h_left^2 - mu h_right^2)/12 at stations, the Euler-Maclaurin correction.

    Lumping is the trapezoidal rule; this is its first error term, zero inside a uniform span. With
    it the frequencies of tensed chains converge with the fourth power of the element's length.
    """
    squares = np.concatenate([[0.0], lengths**2, [0.0]])
    correction = -scene.rope.linear_density * (squares[:-1] - squares[1:]) / 12
    z, beta = scene.coordinates.index("z"), scene.coordinates.index("beta")
    mass[::2, z, beta] += correction
    mass[::2, beta, z] += correction


def _inertia(scene: Scene) -> NDArray[np.float64]:
    """Return the inertia per length of each coordinate [kg/m, kg m]."""
    rope = scene.rope
    inertia = {
        "x": rope.linear_density,
        "z": rope.linear_density,
        "alpha": rope.polar_inertia or 0.0,
        "beta": rope.rotary_inertia or 0.0,
    }
    return np.array([inertia[c] for c in scene.coordinates])


def _standing(scene: Scene, stations: NDArray[np.float64]) -> list[tuple[int, NodeTerm]]:
    """Return what stands at which station."""
    standing = [
        (0, _end_term(end_of(scene.ends[0]), scene.coordinates)),
        (len(stations) - 1, _end_term(end_of(scene.ends[1]), scene.coordinates)),
    ]
    between = (stations[1:] + stations[:-1]) / 2
    standing += [
        (int(np.searchsorted(between, part.x)), part.term(scene.coordinates))
        for part in scene.parts
    ]
    return standing


def _end_term(end: End, coordinates: tuple[str, ...]) -> NodeTerm:
    held = [c for c in coordinates if end.holds(c)]
    return node_term(coordinates, stiffness=dict(end.spring), held=held)
