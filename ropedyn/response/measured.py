"""How far rounding moved a response: the same line in wider numbers; see docs/theory/errors.md."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Real
from ..base.check import is_end
from ..chain.chain import Chain
from ..chain.compiled import EXACT
from ..chain.port import Point, Ports, cut, is_force, is_held, locate, moving, ports, stops
from ..chain.wide import (
    FINE,
    SEEDS,
    SPARE,
    SURE,
    Number,
    as_real,
    factors_of,
    moved,
    narrow,
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


def _apart(value: Complex, found: list[Array], is_ratio: bool) -> tuple[Real, Real]:
    """Return the error of a response, and what of it is the error of the wide answers."""
    with np.errstate(all="ignore"):
        if is_ratio:
            found = [one[:, 1:] / one[:, :1] for one in found]
        once = found[0]
        noise = SURE * np.max([np.abs(other - once) for other in found[1:]], axis=0)
        error = (1 + SPARE) * np.abs(value - once) + noise + EPS / 2 * np.abs(value)
        error = np.where(np.isfinite(error), error, np.inf)
    return error.astype(float), np.where(np.isfinite(noise), noise, np.inf).astype(float)


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
    factor, local = _factors(question), inside_elements(question)
    scales = _core.scales(plain, np.ascontiguousarray(factor.astype(np.complex128)))
    z = 2.0 ** np.round(np.log2(scales)).astype(Number)
    found = []
    for seed in (None, *SEEDS):
        own, factors, rows, part = chain, factor, [pushed, told], local
        if seed is not None:
            random = np.random.default_rng(seed)
            own, factors = wide.moved(chain, seed), _moved_factors(factor, random)
            rows = [one._replace(row=moved(one.row, rough, random)) for one in rows]
            part = local * (1 + 4 * EPS)
        rows = [one._replace(row=one.row.astype(Number)) for one in rows]
        fields = respond(own, as_real(factors), z, Loads.of(rows[0]), watched)
        if fields is None:
            return None
        answer = _read(question, x, fields, rows[1]) + part
        still = [_stands(chain, places, component, p) for p in question.responses]
        answer[:, still] = 0
        found.append(answer)
    return found


def _moved_factors(factor: Array, random: np.random.Generator) -> Array:
    """Return factors with relative errors, the same at all lines."""
    return factor * moved(np.ones((len(factor), 1), dtype=Number), FINE, random)


def _factors(question: Question) -> Array:
    """Return the factors in wide numbers."""
    scene = question.model.scene
    given = damping.factors(scene.dampings, np.asarray(question.omega)).T
    if np.array_equal(given, question.factor):
        return factors_of(scene, question.frequency, question.decay)
    # those that are not of a frequency are what is asked for as they are
    return question.factor.astype(np.result_type(Number, np.complex64))


def _stands(chain: Chain, x: Real, component: tuple[str, ...], point: Point) -> bool:
    """Whether a point cannot move."""
    return not is_force(point) and is_held(chain, x, component, point)


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
