"""A transfer function as a sum over modes.

Residues are means over circles around the eigenvalues (see contour.py): motion, internal forces,
tips of wires and motion of ends alike, no shape is needed. What is left is the response at one
place, s = 0 where the rope is held, less that of the modes.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.errors import SceneError, SolveError
from ...chain import tip
from ...chain.chain import Chain
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, moving
from ...eigen.damped.damped_roots import Undamped, damped_roots, most_roots
from ...eigen.damped.proportional import Proportional, proportional
from ...eigen.damped.rates import Rates, horizon
from ...eigen.spectrum import HIGHEST, count_component, spectrum
from ...response.modal_sum import (
    LEAST,
    REACH,
    known_ratios,
    refuse_other_damping,
    shift_of,
    undamped_factors,
)
from ...response.moved_end import is_end, moves_ends
from ...response.question import Question
from ...response.solvers import SOLVERS
from ...scene import damping
from ...scene.damping import INERTIA
from ...signal import contour

LARGEST, MANY = 1000, 400
"""All modes of a chain with so many unknowns are summed at most, and so many modes of others."""
SEARCHED = 200  # At most so many modes are searched for where damping is not proportional.
ROUND = 1e-11  # A rest of this part of the sum over modes is rounding.
EDGE = 0.8  # Overdamped modes are few up to this part of the rate where they accumulate.
WIDER, ATTEMPTS = 2, 4
"""The radius to search in is doubled so often, and so many searches are made, at most."""


class Expansion(NamedTuple):
    """What responses are to drives, in the rate s of a motion e^(s t).

        H(s) = rest + sum_k (a_k + b_k s)/(s^2 + 2 sigma_k s + square_k) + sum_j r_j/(s - p_j)

    Pairs are conjugate rates -sigma +- i sqrt(square - sigma^2), rigid motion (sigma = square = 0),
    modes that decay without oscillation by two rates, or grow (square < 0); p_j are real rates
    alone.
    """

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    a: Real  # (drives, responses, k)
    b: Real  # (drives, responses, k); 0 where damping is proportional
    p: Real  # (j,) [1/s]
    r: Real  # (drives, responses, j)
    rest: Real  # (drives, responses) of what is left out: it follows at once
    # (drives, responses) |H_out(0)| of the modes that are left out, at most; 0 where none is
    bound: Real
    # Angular frequency of the lowest that is left out [rad/s], infinite where none is
    beyond: float

    @property
    def modes(self) -> int:
        """How many modes are summed."""
        return len(self.sigma) + len(self.p)


class Share(NamedTuple):
    """What one component has of all drives and responses; others are not coupled."""

    drive: Index  # Which of the drives are on it
    response: Index  # Which of the responses
    expansion: Expansion


def expand(
    model: Compiled,
    drives: Sequence[Any],
    responses: Sequence[Point],
    *,
    modes: int | None = None,
    resolved: float = 0.0,
    bound: bool = True,
) -> tuple[Share, ...]:
    """Expand the transfer functions of each component."""
    losses = [one.kind for one in damping.having(model.scene.dampings, "loss")]
    losses += ["damping ratio of a broken wire"] if model.chain.is_hysteretic else []
    if losses:  # a complex modulus has a meaning at each frequency, not in time
        raise SceneError(
            "damping must be in proportion to velocity, or modal, to have a meaning in time, got "
            f"{', '.join(losses)}"
        )
    if damping.having(model.scene.dampings, "ratio"):
        refuse_other_damping(model, drives, responses)
    roots = [tip.tip_of(model, p).root[0] if tip.is_tip(p) else p for p in responses]
    shares = []
    for component in model.components:
        d = [k for k, drive in enumerate(drives) if moving(drive) in component]
        r = [k for k, root in enumerate(roots) if moving(root) in component]
        if d and r:
            pushed, watched = [drives[k] for k in d], [responses[k] for k in r]
            asked = _Asked(model, component, pushed, watched, modes, resolved, bound)
            shares.append(Share(np.array(d), np.array(r), _expansion(asked)))
    return tuple(shares)


# --- one component ------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class _Asked:
    """Which transfer functions of one component; see `expand`."""

    model: Compiled
    component: tuple[str, ...]
    drives: list[Any]
    responses: list[Point]
    modes: int | None
    resolved: float
    bound: bool

    @property
    def chain(self) -> Chain:
        return self.model.chain.only(self.component)

    def at(self, factor: Complex) -> Complex:
        """Return them at the factors (5, n) of the parts, shape (drives, responses, n)."""
        model, asked = self.model, tip.spread(self.model, self.responses)
        hertz = np.sqrt(np.abs(factor[INERTIA])) / (2 * np.pi)
        factor = np.ascontiguousarray(factor)
        question = Question(model, self.component, hertz, factor, self.drives, asked, 1)
        value, error = moves_ends(SOLVERS["sweep"])(question)
        if len(asked) > len(self.responses) or any(map(tip.is_tip, self.responses)):
            value, error = tip.gather(model, self.responses, factor, value, error)
        return value

    def undamped(self, z: Complex) -> Complex:
        """Return those without damping at z = -s^2."""
        return self.at(undamped_factors(z))

    def damped(self, rates: Rates, s: Complex) -> Complex:
        """Return those at rates s."""
        return self.at(rates.at(s))

    def own(self, point: Point) -> _Asked:
        """Return the same of one point, driven there."""
        return dataclasses.replace(self, drives=[point], responses=[point])


def _expansion(asked: _Asked) -> Expansion:
    model, component = asked.model, asked.component
    is_modal = bool(damping.having(model.scene.dampings, "ratio"))
    rates = Rates.of(model.scene.dampings)
    closed = proportional(model.chain.only(component), rates)
    most = LARGEST if is_modal or closed else SEARCHED
    eigenvalue, error, beyond = _eigenvalues(asked, most)
    if is_modal:
        ratio = known_ratios(model, component, eigenvalue)
        if len(ratio) < len(eigenvalue):
            beyond = float(eigenvalue[len(ratio)])
        eigenvalue, error = eigenvalue[: len(ratio)], error[: len(ratio)]
        sigma = ratio * np.sqrt(np.maximum(eigenvalue, 0.0))
        return _closed(asked, (eigenvalue, error), beyond, Proportional(1, 0, 0), sigma)
    if closed is not None:
        sigma = (closed.drag.real + closed.soften.real * eigenvalue) / 2
        return _closed(asked, (eigenvalue, error), beyond, closed, sigma)
    return _searched(asked, rates, eigenvalue, beyond)


def _eigenvalues(asked: _Asked, most: int) -> tuple[Real, Real, float]:
    """Return those of the undamped modes that are summed, their errors, and the next one."""
    chain, finite = asked.chain, asked.chain.finite
    if asked.modes is not None:
        wanted = asked.modes
    elif finite is not None and chain.free <= most:
        wanted = finite
    else:
        try:
            limit = min(REACH * asked.resolved, math.sqrt(HIGHEST)) ** 2
            below = count_component(asked.model, asked.component, limit)
        except SolveError:  # more than can be walked
            below = MANY
        wanted = min(max(below, LEAST), MANY, most)
    value, error = spectrum(asked.model, asked.component, wanted + 1)
    beyond = float(value[wanted]) if len(value) > wanted else np.inf
    return value[:wanted], error[:wanted], beyond


# --- damping in proportion ----------------------------------------------------------------------


def _closed(
    asked: _Asked, known: tuple[Real, Real], beyond: float, closed: Proportional, sigma: Real
) -> Expansion:
    """Sum undamped modes. With stiffness g K, g = stiff + soften s, each is r/(g lambda + ..)."""
    # internal forces are g times those of K, and so are forces that motion of an end takes
    eigenvalue, error = known
    circles = contour.on_a_line(eigenvalue, error, beyond)
    stiff, soften = closed.stiff.real, closed.soften.real
    force = np.array([is_force(point) for point in asked.responses])
    power = np.array([is_end(drive) for drive in asked.drives])[:, None] + force.astype(int)
    if soften != 0 and (power > 1).any():
        raise SceneError(
            "response must not be an internal force where an end is moved and stiffness is damped: "
            "a jump of the end would take an infinite force"
        )
    a, rest = _apart(asked, eigenvalue, circles)
    b = np.where(power[:, :, None] == 1, soften, 0.0) * a
    a *= np.where(power[:, :, None] == 0, 1.0, stiff)
    p, r = np.zeros(0), np.zeros((*rest.shape, 0))
    if soften != 0:
        # what is left out of motion by forces is held by g too
        p, r = np.array([-stiff / soften]), np.where(power == 0, rest / soften, 0.0)[:, :, None]
        rest = np.where(power == 0, 0.0, rest)
    bound = np.zeros(rest.shape)
    if not np.isfinite(beyond) and _spurious(asked.chain):
        beyond = float(eigenvalue.max(initial=0.0))
    if np.isfinite(beyond):
        bound = _bound(asked, lambda own: _apart(own, eigenvalue, circles)[1])
    lowest = float(np.sqrt(max(beyond, 0.0)))
    return Expansion(sigma, stiff * eigenvalue, a, b, p, r, rest, bound, lowest)


def _apart(asked: _Asked, eigenvalue: Real, circles: contour.Circles) -> tuple[Real, Real]:
    """Return residues, (drives, responses, k), and what is left of the response at one place."""
    shape = (len(asked.drives), len(asked.responses))
    a = np.zeros((*shape, len(eigenvalue)))
    if len(eigenvalue):
        a = -contour.residues(asked.undamped, eigenvalue, circles).real
    shift = shift_of(eigenvalue)
    whole = asked.undamped(np.array([-shift], dtype=np.complex128))[..., 0].real
    soft = 1 / (eigenvalue + shift)
    rest = whole - a @ soft
    # of all modes only rounding is left, which what is damped fast would make large
    return a, np.where(np.abs(rest) > ROUND * (np.abs(a) @ np.abs(soft)), rest, 0.0)


def _bound(asked: _Asked, left: Any) -> Real:
    """Return |H| of the modes that are left out, bounded as an inner product."""
    # there is no bound of internal forces, tips and motion of ends
    if not asked.bound:
        return np.full((len(asked.drives), len(asked.responses)), np.inf)
    own: dict[Any, float] = {}
    for point in dict.fromkeys([*asked.drives, *asked.responses]):
        plain = not (is_end(point) or is_force(point) or tip.is_tip(point))
        own[point] = float(np.abs(left(asked.own(point))[0, 0])) if plain else np.inf
    d, r = ([own[point] for point in some] for some in (asked.drives, asked.responses))
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(np.sqrt(np.multiply.outer(d, r)), nan=np.inf, posinf=np.inf)


# --- damping that couples -----------------------------------------------------------------------


class _DampedRates(NamedTuple):
    """Rates of a component with their conjugates [rad/s]."""

    value: Complex
    error: Real
    radius: float  # None of a modulus below this is missing


def _searched(asked: _Asked, rates: Rates, eigenvalue: Real, beyond: float) -> Expansion:
    """Sum damped modes, which have residues of their own."""
    poles = _rates(asked, rates, eigenvalue, beyond)
    circles = contour.in_the_plane(poles.value, poles.error, poles.radius)
    terms, rest = _taken(asked, rates, poles, circles)
    bound = np.zeros(rest.shape)
    if np.isfinite(poles.radius):
        bound = _bound(asked, lambda own: _taken(own, rates, poles, circles)[1])
    far = horizon(asked.chain, rates)
    if np.isfinite(far) and np.isfinite(poles.radius):
        terms, rest = _relaxing(asked, terms, rest, far)
    return Expansion(*terms, rest, bound, poles.radius)


def _relaxing(asked: _Asked, terms: Terms, rest: Real, far: float) -> tuple[Terms, Real]:
    """Let what is left out follow forces as overdamped motion does that accumulates at a rate."""
    # the higher the mode, the more g lambda outweighs inertia and tension: g = 1 + s/far
    sigma, square, a, b, p, r = terms
    follows = np.logical_or.outer(
        np.array([is_end(drive) for drive in asked.drives]),
        np.array([is_force(point) for point in asked.responses]),
    )
    relaxing = np.where(follows, 0.0, rest * far)[:, :, None]
    more = np.append(p, -far), np.concatenate([r, relaxing], axis=2)
    return (sigma, square, a, b, *more), np.where(follows, rest, 0.0)


def _rates(asked: _Asked, rates: Rates, eigenvalue: Real, beyond: float) -> _DampedRates:
    """Find the rates below a radius between undamped modes; of a whole chain all there are."""
    # those before the place where overdamped ones accumulate, and fewer where rounding hides some
    chain = asked.chain
    spans = [chain.between(*span) for span in chain.spans]
    most = [most_roots(span, rates) for span in spans]
    there_are = [np.inf if n is None else n - 2 * _spurious(s) for n, s in zip(most, spans)]
    edge = EDGE * horizon(chain, rates)
    radius = 1.5 * float(np.sqrt(np.abs(eigenvalue).max(initial=1.0)))
    if np.isfinite(beyond):
        radius = float(np.sqrt(np.abs(eigenvalue[-1])) + np.sqrt(beyond)) / 2
    grows, undamped = not np.isfinite(beyond), [Undamped(span) for span in spans]
    for attempt in range(ATTEMPTS):
        radius = min(radius, edge)
        try:
            found = [damped_roots(span, rates, radius) for span in undamped]
        except SolveError as refusal:
            if attempt == ATTEMPTS - 1:
                raise SolveError(f"({', '.join(asked.component)}): {refusal}") from refusal
            radius, grows = radius / 2, False
            continue
        count = [len(one.value) + int((one.value.imag > 0).sum()) for one in found]
        whole = [n >= all_of for n, all_of in zip(count, there_are)]
        if not grows or all(whole) or attempt >= WIDER or radius == edge:
            break
        radius *= 2
    value = np.concatenate([one.value for one in found])
    error = np.concatenate([one.error for one in found])
    if any(_spurious(span) for span in spans):
        # masses are indefinite: what grows faster than the rope is no motion of it
        fastest = np.sqrt(max(0.0, -float(eigenvalue.min(initial=0.0))))
        is_motion = value.real <= 1.01 * fastest + error
        value, error = value[is_motion], error[is_motion]
    twin = value.imag > 0
    return _DampedRates(
        np.concatenate([value, value[twin].conj()]),
        np.concatenate([error, error[twin]]),
        np.inf if all(whole) else min(one.radius for one in found),
    )


def _spurious(chain: Chain) -> int:
    """Return how many modes of lumps there are whose mass is negative, which are no motion."""
    # the end correction of tensed elements makes the mass matrix indefinite
    each = np.bincount(chain.term_of, minlength=len(chain.mass))
    free = chain.held == 0
    kept = free[:, :, None] & free[:, None, :]
    negative = (np.linalg.eigvalsh(np.where(kept, chain.mass, 0.0)) < 0).sum(axis=1)
    return int(negative @ each)


Terms = tuple[Real, Real, Real, Real, Real, Real]


def _taken(
    asked: _Asked, rates: Rates, poles: _DampedRates, circles: contour.Circles
) -> tuple[Terms, Real]:
    """Return sigma, square, a, b, p, r and what is left."""
    shape = (len(asked.drives), len(asked.responses))
    terms = _terms(partial(asked.damped, rates), poles.value, circles, shape)
    sigma, square, a, b, p, r = terms
    rigid = (square == 0) & (sigma == 0)
    elastic = np.abs(poles.value[poles.value != 0])
    s = float(elastic.min(initial=np.inf)) if rigid.any() else 0.0
    s = s if np.isfinite(s) else 1.0
    whole = asked.damped(rates, np.array([s], dtype=np.complex128))[..., 0].real
    rest = whole - ((a + b * s) / (s * s + 2 * sigma * s + square)).sum(axis=-1)
    return terms, rest - (r / (s - p)).sum(axis=-1)


def _terms(
    function: contour.Function, pole: Complex, circles: contour.Circles, shape: tuple[int, int]
) -> Terms:
    """Turn residues into real terms."""
    # two real rates, or two that are nearly one, of residues known together alone, are a pair:
    # (m_0 (s - c) + m_1 rho - m_0 (d_1 + d_2))/((s - p_1)(s - p_2)), p = c + d
    still = np.array([bool((pole[one] == 0).all()) for one in circles.members], dtype=np.bool_)
    is_pair = (circles.center.imag == 0) & (still | (circles.size == 2))
    upper = circles.center.imag >= 0
    joined, others = (np.flatnonzero(upper & one) for one in (is_pair, ~is_pair))
    pairs: list[tuple[float, float, Real, Real]] = []
    for k in joined:
        one = circles.some(np.array([k]))
        m0, m1 = contour.moments(function, one, 2, contour.TOGETHER)[0].real
        p = pole[one.members[0]] if len(one.members[0]) == 2 else np.zeros(2)
        total, product = float(p.sum().real), float(p.prod().real)
        a = m1 * one.radius[0] - m0 * one.center[0].real
        pairs.append((-total / 2, product, a, m0))
    real: list[tuple[float, Real]] = []
    R = contour.residues(function, pole, circles.some(others)) if len(others) else np.zeros(0)
    for k in np.concatenate([circles.members[i] for i in others]) if len(others) else ():
        own = R[..., k]
        if pole[k].imag > 0:
            a, b = -2 * (own * pole[k].conj()).real, 2 * own.real
            pairs.append((-pole[k].real, abs(pole[k]) ** 2, a, b))
        elif pole[k].imag == 0:
            real.append((pole[k].real, own.real))

    def stacked(arrays: list[Real]) -> Real:
        return np.stack(arrays, axis=-1) if arrays else np.zeros((*shape, 0))

    sigma, square = (np.array([one[i] for one in pairs]) for i in range(2))
    a_k, b_k = stacked([one[2] for one in pairs]), stacked([one[3] for one in pairs])
    p_j, r_j = np.array([one[0] for one in real]), stacked([one[1] for one in real])
    return sigma, square, a_k, b_k, p_j, r_j
