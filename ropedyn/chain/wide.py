"""A model's chain compiled once more in wider numbers, from the same numbers of the scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Complex, Index, Real
from ..scene import damping
from ..scene.damping import DASHPOT as DRAG
from ..scene.damping import INERTIA as INERTIA_FACTOR
from ..scene.parts.broken_wire import BrokenWire
from ..scene.parts.part import standing, stretches
from ..scene.parts.resonator import Resonator
from ..scene.parts.stretch import FACTOR, RopeChange, changes
from ..scene.rope import ACROSS, Rope, own_number
from ..scene.scene import Scene
from ..scene.stations import nearest
from ..scene.tension import Tension
from ..scene.weight import graded
from .chain import CONTINUOUS, Chain
from .compile import (
    INERTIA,
    carried_by,
    dragged,
    halves,
    has_inertia,
    lumped,
    standing_at,
    station_nodes,
    stations_of,
    terms_of,
)
from .compiled import Compiled
from .wide_parts import tip_of_wire

Array = Any  # Of numbers that are wider than a chain's are declared to be.
Number = np.longdouble

PI = Number("3.141592653589793238462643383279502884197")
FINE = 32 * float(np.finfo(Number).eps)  # How far wide numbers are moved to see what that does.
COARSE = 2 * float(np.finfo(float).eps)  # How far those that are known as doubles alone are.
SLIGHT = float(np.finfo(float).eps)  # How far doubles are moved so that all rounds otherwise.
LINEAR = 1 / 8  # What moves an answer by less of itself moves it in proportion.
RUNS = 16  # Answers are found again so many times, of doubles that are a little off.
SEEDS = (1, 2)  # Numbers are moved so many times,
SURE = 8.0  # and what that does is taken so many times.
SPARE = 1 / 64  # A wide value's own error is less than this part of what is measured.
STEEP = 1024.0  # Tension does not grow by more than so many times what it is anywhere.
FALLS = 16.0  # Where it does by so many times a rounding of its mean is more at one end.
OF_TENSION = 4.0  # Roundings of T - a x, in units of eps of the largest.
STEP = 2.0**-40  # Of one that does: what its rounding does is told by so much of it.
SAME = 1e-12  # Doubles that differ by no more are roundings of the same numbers.


class Wide(NamedTuple):
    """A chain of wide numbers."""

    chain: Chain
    x: Array  # (nodes,) [m]
    coarse: frozenset[str]  # names of those of its arrays that are known as doubles alone

    def moved(self, chain: Chain, seed: int) -> Chain:
        """Return a chain cut from this one with every number a little off."""
        random = np.random.default_rng(seed)
        names = [n for n in MOVED if getattr(chain, n) is not None]
        off: dict[str, Any] = {
            n: moved(getattr(chain, n), self.amount(n), random, n in SQUARE) for n in names
        }
        return chain._replace(**off)

    def amount(self, name: str) -> float:
        """Return how far an array may be off."""
        return COARSE if name in self.coarse else FINE


SQUARE = ("flexibility", "mass", "stiffness", "damping")  # Symmetric matrices.
ALONG = ("length", "tension", "inertia", "drag", "sag", "rise")  # Of elements, not all symmetric.
MOVED = (*SQUARE, *ALONG, "hinge", "attached_row", "attached_value")


def moved(array: Array, amount: float, random: np.random.Generator, square: bool = False) -> Array:
    """Return the numbers with relative errors."""
    off = random.uniform(-1, 1, array.shape).astype(Number)
    if square:
        off = off + np.swapaxes(off, -1, -2)
    return np.asarray(array * (1 + Number(amount) * off))


def nudged(array: Array, random: np.random.Generator) -> Array:
    """Return doubles with relative errors, the same where numbers are the same."""
    size, which = np.unique(np.abs(array), return_inverse=True)
    off = 1 + SLIGHT * random.uniform(-1, 1, len(size))
    return np.asarray(array * off[which].reshape(np.shape(array)))


def apart(value: Array, every: Array) -> Array:
    """Bound the error of an answer by answers to numbers that are a little off, (RUNS, ..)."""
    mean = every.mean(axis=0)
    least = 2 * SLIGHT * np.abs(value)  # what differs by next to nothing is rounded all the same
    return np.asarray(
        (1 + SPARE) * np.abs(value - mean) + 2 * np.abs(every - mean).max(axis=0) + least
    )


def nudged_chain(chain: Chain, seed: int) -> Chain:
    """Return a chain of doubles with every number a little off."""
    random = np.random.default_rng(seed)
    names = [n for n in MOVED if getattr(chain, n) is not None]
    return chain._replace(**{n: nudged(getattr(chain, n), random) for n in names})


def rescaled(random: np.random.Generator, width: int) -> Array:
    """Return by how much units are moved, so that everything rounds otherwise, (width, 1)."""
    return random.uniform(0.7, 1.4, (width, 1)).astype(Number)


def wide_of(model: Compiled) -> Wide | None:
    """Return the chain of a model in wide numbers; None where its tension vanishes somewhere."""
    if _is_steep(model.chain, STEEP):
        return None
    own = _compiled(model)
    return own if own is not None else _given(model)


def _is_steep(chain: Chain, times: float) -> bool:
    """Whether the tension of a span grows by so many times what it is somewhere."""
    if chain.rise is None:
        return False
    least = chain.tension - np.abs(chain.rise) / 2
    return bool((least * times <= np.abs(chain.rise)).any())


def of_steep(model: Compiled, value: Array, answer: Callable[[Compiled], Array]) -> Array:
    """Return what rounding of a tension that falls much does to an answer, 0 of any other."""
    chain = model.chain
    if not _is_steep(chain, FALLS):
        return np.zeros(np.shape(value))
    assert chain.rise is not None
    # each element's is a difference of what is as large as the largest
    more = STEP * float((np.abs(chain.tension) + np.abs(chain.rise) / 2).max())
    moved = replace(model, chain=chain._replace(tension=chain.tension + more))
    return np.asarray(OF_TENSION * SLIGHT / STEP * np.abs(answer(moved) - value))


def _given(model: Compiled) -> Wide:
    """Return the numbers of a chain as they are."""
    chain = model.chain
    names = [n for n in MOVED if getattr(chain, n) is not None]
    wide = {n: getattr(chain, n).astype(Number) for n in names}
    return Wide(chain._replace(**wide), model.x.astype(Number), frozenset(names))


def _compiled(model: Compiled) -> Wide | None:
    """Compile the scene once more; None where the model's chain is not the scene's."""
    scene, chain = model.scene, model.chain
    at = station_nodes(model)
    counts, stations = np.diff(at), stations_of(scene).astype(Number)
    if at[-1] != len(model.x) - 1 or (counts < 1).any():
        return None
    length = np.diff(stations) / counts
    parts = zip(stations, length, counts)
    x = np.concatenate([start + each * np.arange(n) for start, each, n in parts])
    x = np.append(x, stations[-1])
    flexibility, inertia, coarse = _ropes(scene, stations_of(scene))
    wide = _with_terms(model, length, counts, flexibility, inertia)
    wide = _let_go(chain, at, _with_structures(scene, stations_of(scene), wide))
    if chain.sag is not None:
        spans = chain.element_of[at[:-1]]
        wide = wide._replace(
            sag=chain.sag[spans].astype(Number),
            flexibility=chain.flexibility[spans].astype(Number),
        )
        coarse |= {"sag", "flexibility"}
    if scene.is_graded:
        wide = _graded(scene, wide, stations, x)
        coarse |= {"tension", "rise"} if coarse else set()
    return Wide(wide, x, frozenset(coarse)) if _alike(chain, wide) else None


def _graded(scene: Scene, wide: Chain, stations: Array, x: Array) -> Chain:
    """Return the chain with every element a distinct one, and the tension of each."""
    assert scene.gravity is not None
    given = scene.tension if isinstance(scene.tension, Tension) else Tension(scene.tension)
    density = [own("linear_density") for own in _each(scene, stations.astype(float))]
    along = Number(scene.gravity.g) * np.sin(Number(scene.gravity.inclination))
    tension = graded(stations, np.array(density), along, tension=given, parts=scene.parts)
    left, right = tension.parted(x)
    each = wide.element_of
    names = ("flexibility", "length", "inertia", "drag", "sag")
    own: dict[str, Any] = {n: getattr(wide, n) for n in names}
    own = {n: None if one is None else one[each] for n, one in own.items()}
    return wide._replace(
        **own,
        tension=(left + right) / 2,
        rise=right - left if wide.kind == CONTINUOUS else None,
        first=np.arange(len(x), dtype=np.int32),
        element=np.arange(len(each), dtype=np.int32),
        term=wide.term_of,
    )


def _let_go(chain: Chain, stations: Index, wide: Chain) -> Chain:
    """Return the wide chain with the spring and dashpot on an end that was let go to be moved."""
    own = chain.term[np.searchsorted(chain.first, stations)]
    for k, i in np.argwhere(chain.held[own] != wide.held[: len(own)]):
        t = own[k]
        wide.held[k, i] = chain.held[t, i]
        wide.stiffness[k, i, i] = chain.stiffness[t, i, i]
        if chain.damping is not None:
            drag = np.zeros_like(wide.mass) if wide.damping is None else wide.damping
            drag[k, i, i] = chain.damping[t, i, i]
            wide = wide._replace(damping=drag)
    return wide


def _alike(chain: Chain, wide: Chain) -> bool:
    """Whether a chain is one of wide numbers but for rounding."""
    if not np.array_equal(chain.first, wide.first) or not (
        np.array_equal(chain.held[chain.term], wide.held[wide.term])
    ):
        return False
    every = slice(None)
    pairs: list[tuple[str, Any, Any]] = []
    pairs += [(n, chain.element, wide.element) for n in ("flexibility", *ALONG)]
    pairs += [(n, chain.term, wide.term) for n in ("mass", "stiffness", "damping", "hinge")]
    pairs += [(n, every, every) for n in ("attached_row", "attached_value")]
    for name, at, wide_at in pairs:
        one, other = getattr(chain, name), getattr(wide, name)
        if (one is None) != (other is None):
            return False
        if one is None:
            continue
        one, other = one[at], other[wide_at]
        if one.shape != other.shape:
            return False
        with np.errstate(invalid="ignore"):
            near = np.abs(one - other) <= SAME * np.abs(one).max(initial=0.0)
        if not (near | (one == other)).all():
            return False
    return True


def _ropes(scene: Scene, stations: Real) -> tuple[Array, Array, set[str]]:
    """Return flexibility and inertia of each span, and what of them is known as doubles alone."""
    channels = 3 + ("y" in scene.coordinates)
    still = has_inertia(scene)
    flexibility, inertia = [], []
    for own in _each(scene, stations):
        flexibility.append(_section(own, channels))
        inertia.append([own(INERTIA[c]) for c in scene.coordinates] * still)
    several = len(stretches(scene.parts)) > 1
    coarse = {"flexibility", "inertia", "mass"} if several else set()
    return np.array(flexibility), np.array(inertia), coarse


def _each(scene: Scene, stations: Real) -> list[_Numbers]:
    """Return the properties of the rope between stations."""
    parts = stretches(scene.parts)
    change = changes(parts, stations) if parts else np.array([RopeChange()] * (len(stations) - 1))
    return [_Numbers(scene.rope, RopeChange(*row.tolist())) for row in change]


class _Numbers(NamedTuple):
    """Properties of a rope with what parts do to them."""

    rope: Rope
    change: RopeChange

    def __call__(self, name: str) -> Any:
        more = getattr(self.change, name, 0.0)
        own = Number(own_number(self.rope, name) or 0.0)
        return own * getattr(self.change, FACTOR[name]) + more if name in FACTOR else own


def _section(own: _Numbers, channels: int) -> Array:
    """Return the section's flexibility; see csrc/element/section.c."""
    names = ("axial_stiffness", "torsional_stiffness", "bending_stiffness")
    EA, C, B = (own(name) for name in names)
    D, H = own("lay_coupling"), own("lay_slope")
    S = np.zeros((channels, channels), dtype=Number)
    left = 1 - D * D / (EA * C) if D else Number(1)
    S[0, 0] = 1 / (EA * left) if EA else 0
    twist, bend = 1 / (C * left) if C else Number(0), 1 / B if B else Number(0)
    both = -D / (EA * C * left) if D else Number(0)
    square = 1 + H * H
    c, s = 1 / np.sqrt(square), H / np.sqrt(square)
    S[0, 1] = S[1, 0] = c * both
    S[0, 2] = S[2, 0] = s * both
    S[1, 1] = (twist + H * H * bend) / square
    S[2, 2] = (H * H * twist + bend) / square
    S[1, 2] = S[2, 1] = H * (twist - bend) / square
    if channels > 3:
        across = own(ACROSS["bending_stiffness"])
        S[3, 3] = 1 / across if across else 0
    return S


def _with_terms(
    model: Compiled, length: Array, counts: Array, flexibility: Array, inertia: Array
) -> Chain:
    """Return the chain of spans, each with its own terms: those of stations, then inside."""
    scene, chain, spans = model.scene, model.chain, len(length)
    width, is_lumped = len(scene.coordinates), chain.kind != CONTINUOUS
    along: Array = np.zeros((spans, width), dtype=Number)
    along[:] = Number(damping.drag(scene.dampings)) * dragged(scene)
    size = (2 * spans + 1, width, width)
    mass: Array = np.zeros(size, dtype=Number)
    dashpots: Array = np.zeros(size, dtype=Number)
    if is_lumped:
        for into, given in (
            (mass, lumped(chain.kind, scene.coordinates, inertia, length)),
            (dashpots, halves(chain.kind, along, length)),
        ):
            into[1 : spans + 1] += given[:, 1]
            into[:spans] += given[:, 0]
            into[spans + 1 :] = given.sum(axis=1)
    stiffness, held, hinge = terms_of(scene, standing_at(scene, stations_of(scene)), mass, dashpots)
    several = counts > 1
    begin = np.concatenate([[0], np.cumsum(counts)])
    first, element, term = [], [], []
    for j in range(spans):
        first.append(begin[j])
        element.append(j)
        term.append(j)
        if several[j]:
            first.append(begin[j] + 1)
            element.append(j)
            term.append(spans + 1 + j)
    return chain._replace(
        length=length,
        tension=np.full(spans, Number(scene.mean_tension)),
        flexibility=flexibility,
        first=np.array([*first, begin[-1]], dtype=np.int32),
        element=np.array(element, dtype=np.int32),
        mass=mass,
        stiffness=stiffness,
        held=held,
        term=np.array([*term, spans], dtype=np.int32),
        hinge=hinge,
        inertia=None if is_lumped else inertia,
        damping=dashpots if dashpots.any() else None,
        drag=along if along.any() and not is_lumped else None,
        sag=None,
    )


def _with_structures(scene: Scene, stations: Real, chain: Chain) -> Chain:
    """Return the chain with the numbers of what its stations carry."""
    if chain.attached_value is None:
        return chain
    parts = standing(scene.parts)
    at = nearest(stations, [part.x for part in parts]).tolist()
    carried = carried_by(scene, [(k, part.term()) for k, part in zip(at, parts)])
    order = sorted(zip(at, range(len(parts))), key=lambda one: one[0])
    values = []
    for _, k in order:
        count = len(carried_by(scene, [(0, parts[k].term())]))
        values += [_structure(parts[k])] * count if count else []
    assert len(values) == len(carried)
    assert chain.attached_row is not None
    return chain._replace(
        attached_value=np.array(values, dtype=Number),
        attached_row=chain.attached_row.astype(Number),
        attached_term=np.array([at for at, _, _ in carried], dtype=np.int32),
    )


def _structure(part: Any) -> list[Any]:
    """Return the numbers of a structure, as its own `term` does."""
    if isinstance(part, Resonator):
        mass, omega = Number(part.mass), 2 * PI * part.frequency
        drag = 2 * Number(part.damping_ratio) * mass * omega
        return [mass, mass * omega * omega, omega * omega, drag]
    assert isinstance(part, BrokenWire)
    length, d = Number(part.length), Number(part.diameter)
    mass = part.density * (PI * d * d / 4) * length
    stiffness = part.youngs_modulus * (PI * d**4 / 64) / length**3
    return [mass, stiffness, length, Number(part.damping_ratio)]


def tip_rows(model: Compiled, structure: int, factor: Array, root: list[int]) -> Array | None:
    """Return the motion of a wire's tip per motion of coordinates of its root, (roots, f)."""
    wide = wide_of(model)
    if wide is None:
        return None
    assert wide.chain.attached_value is not None
    assert wide.chain.attached_row is not None
    tip = tip_of_wire(wide.chain.attached_value[structure], factor[INERTIA_FACTOR], factor[DRAG])
    return np.einsum("lf,lc->cf", tip, wide.chain.attached_row[structure][:, root])


def factors_of(scene: Scene, frequency: Real, decay: float) -> Array:
    """Return the factors on the parts of a model in wide numbers, (5, f)."""
    omega = 2 * PI * np.asarray(frequency, dtype=Number)  # NumPy 1 keeps doubles beside a scalar
    if decay:
        omega = omega - 1j * Number(decay)
    return damping.factors(scene.dampings, omega).T


def narrow(chain: Chain) -> Chain:
    """Return the chain of doubles next to it."""
    names = [n for n in MOVED if getattr(chain, n) is not None]
    return chain._replace(**{n: getattr(chain, n).astype(float) for n in names})


def as_real(factor: Complex) -> Array:
    """Return real factors where none of them but that of dashpots is complex, as they are else."""
    return factor if np.iscomplexobj(factor) and factor.imag.any() else factor.real
