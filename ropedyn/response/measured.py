"""How far rounding moved a response: the same line in wider numbers; see docs/theory/errors.md."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..base.check import is_end
from ..chain.chain import Chain
from ..chain.compiled import EXACT, Compiled
from ..chain.port import Point, Ports, cut, is_force, is_held, locate, moving, ports, stops
from ..chain.wide import (
    FINE,
    SEEDS,
    SPARE,
    SURE,
    Number,
    Wide,
    as_real,
    factors_of,
    moved,
    narrow,
    rescaled,
    wide_of,
)
from ..chain.witness import Loads, NodeFields, respond
from ..scene import damping
from .moved_end import released
from .question import Question
from .solvers import inside_elements

Array = NDArray[Any]

EPS = float(np.finfo(float).eps)


class RoundingFound(NamedTuple):
    """How far a response is from its value in wider numbers, (drives, responses, f)."""

    error: Real
    noise: Real  # what of it is the error of wider numbers


def measured(question: Question, value: Complex) -> RoundingFound | None:
    """Measure what rounding did to a response; None where there are no wider numbers."""
    drives = question.drives
    ends = [k for k, point in enumerate(drives) if is_end(point)]
    forces = [k for k in range(len(drives)) if k not in ends]
    error, noise = np.zeros(value.shape), np.zeros(value.shape)
    parts = [(forces, replace(question, drives=[drives[k] for k in forces]))] if forces else []
    for k in ends:
        model, own = released(question.model, drives[k])
        asked = [own, *question.responses]
        parts.append(([k], replace(question, model=model, drives=[own], responses=asked)))
    for which, part in parts:
        found = _answers(part)
        if found is None:
            return None
        error[which], noise[which] = _apart(value[which], found, which[0] in ends)
        if which[0] in ends:
            still = [k for k, point in enumerate(question.responses) if point == part.drives[0]]
            error[which[0], still] = noise[which[0], still] = 0.0
    return RoundingFound(error, noise)


STILL = np.array([[1.0], [1.0], [1.0], [0.0], [0.0]])  # Factors at 0 Hz.


def off_by(value: Array, once: Array, noise: Array) -> Real:
    """Return how far doubles are from wide numbers that know themselves but for some noise."""
    with np.errstate(all="ignore"):
        error = (1 + SPARE) * np.abs(value - once) + noise + EPS / 2 * np.abs(value)
        return np.where(np.isfinite(error), error, np.inf).astype(float)


def surely(error: Real, noise: Real, bound: Real, *, solver: str) -> tuple[Real, Flags]:
    """Return what was measured where that says more than a bound, and where that is."""
    # on a resonance that takes no part wider numbers know less than the bound does, but where they
    # differ by more than they know, a bound that is less is wrong
    told = np.isfinite(error) & (noise <= np.maximum(bound, error / 2))
    if solver != "sweep":
        # of the residuals of all rows, that of assembled solvers misses what little is left of them
        told |= noise > bound
    return np.where(told, error, bound), told


def _apart(value: Complex, found: list[Array], is_ratio: bool) -> tuple[Real, Real]:
    """Return the error of a response, and what of it is the error of the wide answers."""
    with np.errstate(all="ignore"):
        if is_ratio:
            found = [one[:, 1:] / one[:, :1] for one in found]
        once = found[0]
        noise = SURE * np.max([np.abs(other - once) for other in found[1:]], axis=0)
    error = off_by(value, once, noise)
    return error, np.where(np.isfinite(noise), noise, np.inf).astype(float)


def _answers(question: Question) -> list[Array] | None:
    """Return a response in wider numbers, and with these moved a little, or None."""
    wide = wide_of(question.model)
    if wide is None:
        return None
    chain, x, component = wide.chain.only(question.component), wide.x, question.component
    points = [*question.drives, *question.responses]
    if question.model.element in EXACT:
        between = [p[1] for p in points if locate(x, p[1])[1] is not None]
        chain, x = cut(chain, x, [*between, *stops(narrow(chain), x.astype(float))])
    plain, places = narrow(chain), x.astype(float)
    pushed = ports(plain, places, component, question.drives)
    told = ports(plain, places, component, [(moving(p), p[1]) for p in question.responses])
    rough = 16 * EPS if any(locate(x, p[1])[1] is not None for p in points) else 0.0
    watched = np.concatenate([told.node, told.node + 1])
    local, found = inside_elements(question), []
    still = [not is_force(p) and is_held(chain, places, component, p) for p in question.responses]
    asked = Pushed(Loads.of(pushed), watched, rough)
    for fields, random in _perturbed(wide, chain, _factors(question), asked):
        if fields is None:
            return None
        row: Array = told.row.astype(Number)
        part = local
        if random is not None:
            row, part = moved(row, rough, random), local * (1 + 4 * EPS)
        answer = _read(question, x, fields, told._replace(row=row)) + part
        answer[:, still] = 0
        found.append(answer)
    return found


class Pushed(NamedTuple):
    """What acts on a chain and what is watched."""

    loads: Loads
    watched: Index  # nodes
    rough: float  # how far shapes between nodes are off, as all numbers of the loads


def _perturbed(
    wide: Wide, chain: Chain, factor: Array, asked: Pushed
) -> Iterator[tuple[NodeFields | None, np.random.Generator | None]]:
    """Yield what loads cause in wide numbers, then in others that are a little off."""
    scales = _core.scales(narrow(chain), np.ascontiguousarray(factor.astype(np.complex128)))
    unit: Array = 2.0 ** np.round(np.log2(scales)).astype(Number)
    loads = asked.loads._replace(row=asked.loads.row.astype(Number))
    yield respond(chain, as_real(factor), unit, loads, asked.watched), None
    for seed in SEEDS:
        random = np.random.default_rng(seed)
        own, ones = wide.moved(chain, seed), np.ones((len(factor), 1), dtype=Number)
        off = factor * moved(ones, FINE, random)  # the same at all lines
        z = unit * rescaled(random, len(unit))
        push = loads._replace(row=moved(loads.row, asked.rough, random))
        yield respond(own, as_real(off), z, push, asked.watched), random


class AtRest(NamedTuple):
    """A deflection in wider numbers, each (nodes, width), and how little these know of it."""

    displacement: Array
    force: Array
    unsure: Array
    force_unsure: Array


def measured_at_rest(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> AtRest | None:
    """Deflect a component in wider numbers; None where there are none."""
    wide = wide_of(model)
    if wide is None:
        return None
    chain, x = wide.chain.only(component).at_rest, wide.x
    if model.element in EXACT:
        places = [*nodes, *(at for _, at in loads), *stops(narrow(chain), x.astype(float))]
        chain, x = cut(chain, x, places)
    pushed = ports(narrow(chain), x.astype(float), component, loads)
    push, amount = Loads.of(pushed), np.array(list(loads.values()))
    push = push._replace(row=push.row @ amount[:, None])
    right = np.searchsorted(x, nodes).clip(1, len(x) - 1)
    near = np.where(x[right] - nodes < nodes - x[right - 1], right, right - 1)
    found = []
    for fields, _ in _perturbed(wide, chain, STILL.astype(Number), Pushed(push, near, 0.0)):
        if fields is None:
            return None
        at = np.searchsorted(fields.node, near)
        # what the surroundings put on a node is what the rope on both sides does not
        force = fields.left[0, at, :, 0] - fields.right[0, at, :, 0]
        found.append((fields.u[0, at, :, 0] * (chain.held[chain.term_of[near]] == 0), force))
    (u, force), *others = found
    with np.errstate(invalid="ignore"):
        noise = [SURE * np.max([np.abs(o[k] - found[0][k]) for o in others], 0) for k in range(2)]
    if model.element == "continuous":
        # a node is where its double is but for half a rounding
        noise[0] = noise[0] + EPS * np.abs(
            nodes[:, None] * np.gradient(u.astype(float), nodes, axis=0)
        )
    return AtRest(u, force, *noise)


def _factors(question: Question) -> Array:
    """Return the factors in wide numbers."""
    scene = question.model.scene
    given = damping.factors(scene.dampings, np.asarray(question.omega)).T
    if np.array_equal(given, question.factor):
        return factors_of(scene, question.frequency, question.decay)
    # those that are not of a frequency are what is asked for as they are
    return question.factor.astype(np.result_type(Number, np.complex64))


def _read(question: Question, x: Array, found: NodeFields, told: Ports) -> Array:
    """Return motion and forces, (drives, responses, f)."""
    at = {int(node): k for k, node in enumerate(found.node)}
    lines = []
    for k, point in enumerate(question.responses):
        node = locate(x, point[1])[0]
        if is_force(point):
            c = question.component.index(moving(point))
            lines.append((found.left if node else found.right)[:, at[node], c])
            continue
        here = [at[int(told.node[k]) + j] for j in range(2)]
        lines.append(sum(told.row[k, j] @ found.u[:, here[j]] for j in range(2)))
    return np.stack(lines, axis=2).transpose(1, 2, 0)
