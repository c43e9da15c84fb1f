"""How fast what a model is made of changes with one number of its scene."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TypeVar

import numpy as np

from ..base.array import Flags, Index, Real
from ..base.errors import SceneError
from ..scene.damping import drag
from ..scene.end import end_of
from ..scene.parts.node import AttachedRate, NodeRate
from ..scene.parts.part import places as places_of
from ..scene.parts.part import standing, stretches
from ..scene.parts.stretch import KINDS as STRETCHES
from ..scene.parts.stretch import (
    Stretch,
    changed_by,
    changes,
    numbers_of,
    rope_rate,
    ropes,
    stretch_rate,
)
from ..scene.rope import ACROSS, Rope, own_number
from ..scene.scene import Scene
from ..scene.stations import nearest
from ..scene.weight import Grade, grade_rate
from .chain import CONTINUOUS
from .compile import (
    INERTIA,
    carried_by,
    dragged,
    halves,
    has_inertia,
    inertia_of,
    lumped,
    section,
    standing_at,
    station_nodes,
    stations_of,
)
from .compiled import Compiled

_Any = TypeVar("_Any")

STEP = 2.0**-100
"""The square of this imaginary step is nothing beside 1: derivatives are exact."""

ENTRIES = ([0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2])
"""Rows and columns of the entries of the section in the core's order: aa, tt, bb, at, ab, tb."""

STIFFNESS = {
    "axial_stiffness": np.diag([1.0, 0.0, 0.0]),
    "torsional_stiffness": np.diag([0.0, 1.0, 0.0]),
    "bending_stiffness": np.diag([0.0, 0.0, 1.0]),
    "lay_coupling": np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
}
"""d/dp of the section's stiffness about its own axes (axial, torsion, bending)."""

SECTION = STIFFNESS.keys() | {"lay_slope", ACROSS["bending_stiffness"]}
"""Properties of a rope that its section depends on."""

TENSION, SAG = 6, 8  # Numbers of the weights by tension, and by sag or the slope of the tension.

GRAVITY = ("g", "inclination")  # Numbers of gravity.

DENSITIES = tuple(dict.fromkeys(INERTIA.values()))
"""Properties of a rope that are inertia per length."""


def section_rate(rope: Rope, name: str) -> Real:
    """Return the derivative of the section flexibility with respect to a property of the rope.

    With S = R^T K^-1 R, R the turn by the angle arctan H of the lay slope in (torsion, bending):
    dS = -S~^T dK S~ with S~ = K^-1 R, and dS/dH = (J^T S + S J)/(1 + H^2) with R' = R J.
    """
    slope = rope.lay_slope or 0.0
    turn = np.eye(3)
    turn[1:, 1:] = np.array([[1.0, slope], [-slope, 1.0]]) / np.hypot(1.0, slope)
    if name == "lay_slope":
        turned = section(rope) @ np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        return (turned + turned.T) / (1.0 + slope * slope)
    own = section(rope.replace(lay_slope=None)) @ turn
    return -own.T @ STIFFNESS[name] @ own


def inertia_rate(scene: Scene, name: str) -> Real:
    """Return the derivative of the inertia per length of each coordinate, shape (width,)."""
    own = np.array([float(INERTIA[c] == name) for c in scene.coordinates])
    return np.where(has_inertia(scene), own, 0.0)


@dataclass(frozen=True, eq=False)
class Weights:
    """By what the slopes of a form are multiplied, see `_core.sensitivity`.

    The derivative of the form is the sum of slopes times `element`, `jump` and `node`, less lambda
    times that of slopes times `moving`, `mass` and `heavier`.
    """

    # (stretches - 1, 9 or 10) Section, tension, length of massless elements, sag; section across
    element: Real
    place: Real  # (stretches, 2) of the first node of each, of continuous elements, and 0
    moving: Real  # (stretches - 1, width) inertia per length of continuous elements
    jump: Real  # (stretches - 1, width) stiffness of hinges
    node: Real  # (stretches, width, width) springs and inertia
    mass: Real  # (stretches, width, width) springs and inertia
    dashpot: Real  # (stretches, width, width) damping, which undamped modes do not feel
    dragging: Real  # (stretches - 1, width) the same per length of continuous elements
    # (attached,) relative changes of stiffness and mass of the structures that nodes carry
    stiffer: Real
    # (attached,) relative changes of stiffness and mass of the structures that nodes carry
    heavier: Real
    foot: Real  # (attached, 2, width) displacement and rotation of their feet
    moves: Real  # (attached, 2, width) the same, but for those that are larger as a whole
    damped: Real  # (attached,) of their damping ratios, which undamped modes do not feel

    def element_in(self, coordinates: Sequence[str]) -> Real:
        """Return `element` for some coordinates alone, whose own bending is the section's."""
        element, across = self.element[:, :9], self.element[:, 9:]
        if "y" in coordinates:
            element = element.copy()
            element[:, :6], element[:, 2:3] = 0.0, across
        return element


@dataclass(frozen=True, eq=False)
class Places:
    """Where the spans and stations of a model are among the stretches of its chain."""

    model: Compiled  # the model
    counts: Index = field(init=False)  # (spans,) elements of each span
    # (stretches - 1,) to which the elements of a stretch belong
    span: Index = field(init=False)
    # (stretches,) the last one that is no further right
    station: Index = field(init=False)
    # (stretches,) whether its nodes lie between stations
    inside: Flags = field(init=False)
    change: Real = field(init=False)  # (spans, 7) of the rope, see `stretch.RopeChange`
    ropes: tuple[Rope, ...] = field(init=False)  # of each span

    def __post_init__(self) -> None:
        model = self.model
        stations = stations_of(model.scene)
        along = stretches(model.scene.parts)
        local, which = ropes(model.scene.rope, along, stations)
        at = station_nodes(model)
        station = np.searchsorted(at, model.chain.first, side="right") - 1
        values = {
            "counts": np.diff(at),
            "span": station[:-1],
            "station": station,
            "inside": at[station] != model.chain.first,
            "change": changes(along, stations),
            "ropes": tuple(local[k] for k in which),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def length(self) -> Real:
        """Of the elements of each span [m]."""
        begins = np.flatnonzero(~self.inside)[:-1]
        return self.model.chain.length[self.model.chain.element[begins]]

    @property
    def inertia(self) -> Real:
        """Per length, of each span and coordinate, shape (spans, width)."""
        return np.stack([inertia_of(self.model.scene, rope) for rope in self.ropes])

    @property
    def drag(self) -> Real:
        """Damping per length, of each span and coordinate, shape (spans, width)."""
        scene = self.model.scene
        return np.tile(drag(scene.dampings) * dragged(scene), (len(self.counts), 1))

    def at_nodes(self, of: Real) -> Real:
        """Return what stands at stations, (stations, width), at the stretches, on the diagonal."""
        node = np.zeros((len(self.station), *2 * of.shape[1:]))
        own = np.where(self.inside[:, None], 0.0, of[self.station])
        np.einsum("sii->si", node)[:] = own
        return node

    def beside(self, given: Real) -> Real:
        """Return what elements of spans give to their nodes, (spans, 2, ..), at the stretches."""
        station, inside = self.station, self.inside
        right = np.minimum(station, len(given) - 1)
        left = np.where(inside, right, np.maximum(station - 1, 0))
        total = np.where((station < len(given))[:, None, None], given[right, 0], 0.0)
        return total + np.where((inside | (station > 0))[:, None, None], given[left, 1], 0.0)

    @property
    def linear_density(self) -> Real:
        """Of each span [kg/m], shape (spans,)."""
        return np.array([rope.linear_density for rope in self.ropes])

    @property
    def stretch(self) -> Real:
        """Axial flexibility of each span along its own curve [1/N], shape (spans,)."""
        return np.array([section(rope)[0, 0] for rope in self.ropes])

    @property
    def pull(self) -> float:
        """Curvature of the rope that hangs per linear density, g cos(inclination)/T [m/kg]."""
        scene = self.model.scene
        if scene.gravity is None or not scene.sags:
            return 0.0
        return scene.gravity.g * math.cos(scene.gravity.inclination) / scene.mean_tension

    def sections(self, name: str) -> Real:
        """Return the derivative of the section flexibility of each span."""
        rate = np.zeros((len(self.ropes), *self.model.chain.flexibility.shape[1:]))
        if name == ACROSS["bending_stiffness"]:
            soft = [section(rope, 4)[3, 3] for rope in self.ropes]
            rate[:, 3, 3] = -np.square(soft)
        else:
            rate[:, :3, :3] = [section_rate(rope, name) for rope in self.ropes]
        return self.longer(rate)

    def longer(self, flexibility: Real) -> Real:
        """Return sections of a rope that hangs, longer than its chord along x."""
        scene = self.model.scene
        if scene.gravity is not None and scene.sags:
            flexibility[:, 0, 0] *= scene.gravity.lengthening(scene.rope, scene.mean_tension)
        return flexibility


class Rate:
    """d/dp of what the spans and stations of a model are made of, zero where it is not said."""

    def __init__(self, places: Places) -> None:
        spans, width = len(places.counts), len(places.model.coordinates)
        self.rope: dict[str, Real] = {}
        self.pull = self.chord = 0.0
        self.grade: Grade | None = None  # of a tension that grows along the rope
        self.tension, self.length = np.zeros(spans), np.zeros(spans)
        self.mass = np.zeros((spans + 1, width))
        self.stiffness, self.hinge = np.zeros_like(self.mass), np.zeros_like(self.mass)
        self.dashpot, self.drag = np.zeros_like(self.mass), np.zeros(width)
        rows = places.model.chain.attached_row
        carried = 0 if rows is None else len(rows)
        self.stiffer, self.heavier = np.zeros(carried), np.zeros(carried)
        self.damped, self.size = np.zeros(carried), np.zeros(carried)
        self.moves = np.zeros((carried, 2, width))

    def weights(self, places: Places) -> Weights:
        """Return the weights that belong to it."""
        span, station, inside = places.span, places.station, places.inside
        flexibility = self._flexibility(places)
        section, across = flexibility[:, ENTRIES[0], ENTRIES[1]], flexibility[:, 3:, 3:]
        longer, place = self.length, np.zeros(len(station))
        if places.model.chain.kind == CONTINUOUS:
            moved = np.append(0.0, np.cumsum(longer * places.counts))
            longer, place = np.zeros_like(longer), np.where(inside, 0.0, moved[station])
        sag, across = self._sag(places), across.reshape(len(section), -1)
        element = np.column_stack([section, self.tension, longer, sag, across])
        inertia = self.inertia(places)
        rows = places.model.chain.attached_row
        larger = self.moves if rows is None else self.size[:, None, None] / 2 * rows
        return Weights(
            element=self._graded(places, element[span]),
            place=np.column_stack([place, np.zeros_like(place)]),
            moving=inertia[span],
            jump=np.where(inside[:-1, None], 0.0, self.hinge[station[:-1]]),
            node=places.at_nodes(self.stiffness),
            mass=places.at_nodes(self.mass) + places.beside(self._given(places, inertia)),
            dashpot=places.at_nodes(self.dashpot) + places.beside(self._dragging(places)),
            dragging=np.tile(self.drag, (len(span), 1)),
            stiffer=self.stiffer,
            heavier=self.heavier,
            foot=self.moves + larger,
            moves=self.moves,
            damped=self.damped,
        )

    def _graded(self, places: Places, element: Real) -> Real:
        """Put the derivatives of a tension that grows in place of those of one that does not."""
        if self.grade is None:
            return element
        chain = places.model.chain
        left, right = self.grade.parted(places.model.x)
        element[:, TENSION] = (left + right) / 2
        element[:, SAG] = 0.0 if chain.rise is None else (right - left) / chain.length
        return element

    def _flexibility(self, places: Places) -> Real:
        """Return the derivative of the section flexibility of each span."""
        flexibility = np.zeros((len(places.counts), *places.model.chain.flexibility.shape[1:]))
        for name in self.rope.keys() & SECTION:
            flexibility += self.rope[name][:, None, None] * places.sections(name)
        flexibility[:, 0, 0] += self._lengthening(places) * places.stretch
        return flexibility

    def _lengthening(self, places: Places) -> float:
        """Return the derivative of 1 + s^2/8, s = mu L g cos(inclination)/T."""
        rope = places.model.scene.rope
        own = rope.linear_density * rope.length
        return own * places.pull * (self.chord * places.pull + own * self.pull) / 4

    def _sag(self, places: Places) -> Real:
        """Return the derivative of the curvature of each span, mu g cos(inclination)/T."""
        density = self.rope.get("linear_density", np.zeros(len(places.counts)))
        return density * places.pull + places.linear_density * self.pull

    def inertia(self, places: Places) -> Real:
        """Return the derivative of the inertia per length of each span."""
        inertia = np.zeros((len(places.counts), self.mass.shape[1]))
        for name in self.rope.keys() & set(DENSITIES):
            inertia += np.outer(self.rope[name], inertia_rate(places.model.scene, name))
        return inertia

    def _given(self, places: Places, inertia: Real) -> Real:
        """Return the derivative of the inertia that elements give to their nodes."""
        model = places.model
        moving = places.inertia + 1j * STEP * inertia
        length = places.length + 1j * STEP * self.length
        return lumped(model.chain.kind, model.coordinates, moving, length).imag / STEP

    def _dragging(self, places: Places) -> Real:
        """Return the derivative of the damping along the rope that elements give to their nodes."""
        kind, more = places.model.chain.kind, np.tile(self.drag, (len(self.length), 1))
        return halves(kind, places.drag, self.length) + halves(kind, more, places.length)


def rates_of(places: Places) -> dict[str, Callable[[], Rate]]:
    """Return the numbers of a scene that answers have derivatives by, with their paths."""
    model = places.model
    found: dict[str, Callable[[], Rate]] = {}
    if model.scene.sags or model.scene.is_graded:
        found |= {f"gravity.{name}": partial(_of_gravity, places, name) for name in GRAVITY}
    if "z" in model.coordinates and not (model.element == "difference" and _bends(model)):
        found["tension"] = partial(_of_tension, places)
    acting = _acting(model)
    found |= _of_properties(places, acting)
    found["length"] = partial(_of_length, places)
    for i, part in enumerate(model.scene.parts):
        for name, of in _of_numbers(places, i, acting).items():
            found[f"parts[{i}].{name}"] = of
        for name in ("start", "stop") if isinstance(part, STRETCHES) else ("x",):
            found[f"parts[{i}].{name}"] = partial(_of_position, places, i, name)
    for i, end in enumerate(model.scene.ends):
        for kind, values in end_of(end).standing.items():
            for c in (c for c in values if c in model.coordinates):
                found[f"ends[{i}].{kind}.{c}"] = partial(_of_end, places, i, kind, c)
    if model.scene.is_graded:
        moving = re.compile(r"length|parts\[\d+\]\.(x|start|stop)")
        fixed = {path: of for path, of in found.items() if not moving.fullmatch(path)}
        return {path: partial(_of_graded, places, path, of) for path, of in fixed.items()}
    return found


def _of_properties(places: Places, acting: set[str]) -> dict[str, Callable[[], Rate]]:
    """Return those of the rope."""
    rope = places.model.scene.rope
    found: dict[str, Callable[[], Rate]] = {}
    for name in (*STIFFNESS, "lay_slope", *DENSITIES):
        if name in ACROSS.values() or getattr(rope, name) is None:
            continue
        names = [name, ACROSS[name]] if name in ACROSS else [name]
        is_pair = isinstance(getattr(rope, name), tuple)
        for k, each in enumerate([[one] for one in names] if is_pair else [names]):
            if own := [one for one in each if one in acting]:
                found[f"{name}[{k}]" if is_pair else name] = partial(_of_rope, places, own)
    return found


def _of_graded(places: Places, path: str, of: Callable[[], Rate]) -> Rate:
    """Return that of a number, and of the tension that grows with it."""
    rate, along = of(), places.model.scene.grade
    rate.grade = grade_rate(places.model.scene, path)
    if rate.grade is not None:
        ends = ((along.left[0], rate.grade.left[0]), (along.right[-1], rate.grade.right[-1]))
        if any(T == 0 and change != 0 for T, change in ends) and not _bends(places.model):
            raise SceneError(
                f"tension must not vanish at an end for a derivative by {path!r}: it has none there"
            )
    return rate


def asked(rates: Mapping[str, Callable[[], _Any]], path: str) -> Callable[[], _Any]:
    """Return what a path names, checked."""
    if not isinstance(path, str):
        raise TypeError(f'path must be a string such as "tension", got {path!r}')
    if path not in rates:
        words = ", ".join(f'"{name}"' for name in rates)
        raise SceneError(
            f"path must be a number that acts in this scene, one of {words}, got {path!r}"
        )
    return rates[path]


def _acting(model: Compiled) -> set[str]:
    """Return the properties that a rope may have and this model's depends on."""
    stiffness = {name for name in SECTION if own_number(model.scene.rope, name) is not None}
    if not model.chain.is_spatial:
        stiffness -= {ACROSS["bending_stiffness"]}
    return stiffness | {c for c in DENSITIES if inertia_rate(model.scene, c).any()}


def _of_numbers(places: Places, i: int, acting: set[str]) -> dict[str, Callable[[], Rate]]:
    """Return the rates of the numbers of a part, positions apart."""
    part = places.model.scene.parts[i]
    if isinstance(part, STRETCHES):
        return {
            name: partial(_of_stretch, places, part, own)
            for name, fields in numbers_of(part).items()
            if (own := [field for field in fields if acting & changed_by(field)])
        }
    return {
        name: partial(_of_part, places, i, rate)
        for name, rate in part.rates().items()
        if rate.acts(places.model.coordinates)
    }


def _bends(model: Compiled) -> bool:
    return "beta" in model.coordinates


def _of_tension(places: Places) -> Rate:
    rate = Rate(places)
    rate.tension[:] = 1.0
    if places.pull:
        rate.pull = -places.pull / places.model.scene.mean_tension
    return rate


def _of_gravity(places: Places, name: str) -> Rate:
    """Return that of g cos(inclination)/T."""
    gravity, tension = places.model.scene.gravity, places.model.scene.mean_tension
    assert gravity is not None
    turned = math.cos(gravity.inclination), -gravity.g * math.sin(gravity.inclination)
    rate = Rate(places)
    rate.pull = turned[GRAVITY.index(name)] / tension if places.pull else 0.0
    return rate


def _of_rope(places: Places, names: Sequence[str]) -> Rate:
    """Return that of a property of the rope, in one plane or both, which stretches multiply."""
    rate = Rate(places)
    rate.rope |= {name: rope_rate(places.change, name) for name in names}
    if "linear_density" in names:
        rate.chord = places.model.scene.rope.length
    return rate


def _of_length(places: Places) -> Rate:
    """Let the last span grow: parts keep their x."""
    rate = Rate(places)
    rate.length[-1] = 1.0 / places.counts[-1]
    rate.chord = places.model.scene.rope.linear_density
    return rate


def _of_position(places: Places, i: int, name: str) -> Rate:
    """Let the span on the left grow by what the span on the right loses."""
    scene = places.model.scene
    x = getattr(scene.parts[i], name)
    at, *others = nearest(_stations(places), [x, *places_of(scene.parts)]).tolist()
    if at in (0, len(places.counts)) or others.count(at) > 1:
        raise SceneError(
            f"parts[{i}].{name} must be a place of its own for a derivative, got one at an end of "
            "the rope or where another part stands: it would part them in one direction"
        )
    rate = Rate(places)
    rate.length[at - 1] = 1.0 / places.counts[at - 1]
    rate.length[at] = -1.0 / places.counts[at]
    return rate


def _of_stretch(places: Places, part: Stretch, names: Sequence[str]) -> Rate:
    """Return that of what a part does to the rope between its ends."""
    start, stop = nearest(_stations(places), [part.start, part.stop])
    rate, rope = Rate(places), places.model.scene.rope
    for of, change in stretch_rate(rope, places.change[start:stop], part, names).items():
        rate.rope[of] = np.zeros(len(places.counts))
        rate.rope[of][start:stop] = change
    return rate


def _of_end(places: Places, i: int, kind: str, coordinate: str) -> Rate:
    """Return that of what stands at an end."""
    rate = Rate(places)
    into = {"spring": rate.stiffness, "mass": rate.mass, "dashpot": rate.dashpot}
    into[kind][-i, places.model.coordinates.index(coordinate)] = 1.0
    return rate


def _of_part(places: Places, i: int, of: NodeRate) -> Rate:
    rate = Rate(places)
    scene = places.model.scene
    terms = list(standing_at(scene, _stations(places)))
    station, term = terms[2 + len(standing(scene.parts[:i]))]  # those of the ends come first
    for c, k in ((c, k) for k, c in enumerate(places.model.coordinates)):
        rate.mass[station, k] = of.mass.get(c, 0.0)
        rate.stiffness[station, k] = of.stiffness.get(c, 0.0)
        rate.dashpot[station, k] = of.damping.get(c, 0.0)
        if c in of.hinge:
            others = sum(t.hinge.get(c, 0.0) for s, t in terms if s == station and t is not term)
            rate.hinge[station, k] = of.hinge[c] * _share(term.hinge[c], others) ** 2
    for k, (_, carries, one) in enumerate(carried_by(scene, terms)):
        if carries is term and of.attached:
            _set_attached(rate, places, k, of.attached[term.attached.index(one)])
    return rate


def _set_attached(rate: Rate, places: Places, k: int, of: AttachedRate) -> None:
    """Let structure k of the chain change.

    A larger one is the same under a larger motion of its foot: its form is of second order there.
    So nothing of the strain and the kinetic energy has to cancel where the foot hardly moves.
    """
    rate.heavier[k], rate.stiffer[k] = of.mass, of.stiffness
    rate.damped[k], rate.size[k] = of.damping, of.size
    for line, moves in enumerate((of.displacement, of.rotation)):
        for c, value in moves.items():
            if c in places.model.coordinates:
                rate.moves[k, line, places.model.coordinates.index(c)] += value


def _share(own: float, others: float) -> float:
    """Return the share of the jump that one of several hinges in series opens by."""
    if np.isinf(others):
        return 0.0
    return 1.0 if np.isinf(own) else own / (own + others)


def _stations(places: Places) -> Real:
    return stations_of(places.model.scene)
