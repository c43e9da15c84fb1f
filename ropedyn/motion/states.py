"""Motion of a few points as undamped modes, each damped for itself, and what follows them at rest.

    q_k'' + 2 sigma_k q_k' + square_k q_k = sum_i push[k, i] (f_i + lead_i f_i')
    y_o = sum_k (seen[o, k] q_k + swept[o, k] q_k') + sum_i (now[o, i] f_i + late[o, i] l_i),
    l_i + gamma l_i' = f_i

`now` and `late` are the flexibility of the modes that are left out: damped stiffness lets it relax.
Residues are means over circles around the eigenvalues (see contour.py), so that nothing but H is
asked for, and each is a product push times seen. Dashpots of single points are left out of the
modes: they are laws of these points, as stops and friction are.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Complex, Flags, Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.chain import Chain
from ..chain.compiled import Compiled, with_plain_lumps
from ..chain.port import Point, is_force, locate
from ..eigen.damped.proportional import Proportional, proportional
from ..eigen.damped.rates import Rates
from ..eigen.damped.residue import spread
from ..eigen.spectrum import parted, spectrum
from ..response.modal_sum import known_ratios
from ..response.moved_end import is_end
from ..scene.damping import having
from ..scene.end import end_of
from ..scene.parts.part import standing
from ..signal import contour
from .undamped import Parted, UndampedResponses, losses_of, mixed

LARGEST = 200  # All modes of a chain with so many are taken.
FEW = 16  # Nodes whose damping is not as their mass are points of their own, at most.
CIRCLED = 0.6  # Other circles are so much smaller.
LOST, NONE = 1e-3, 1e-9
"""Products below this part of what rounding may be are none, and shares below that of them."""
KNOWN = 1e-13  # Above this share of what points yield rounding leaves digits.
PROBES = 8  # Modes that lie close together are told apart at so many places.


class Resistance(NamedTuple):
    """A dashpot of one point."""

    point: Point
    damping: float  # [N s/m, N m s]


@dataclasses.dataclass(frozen=True, eq=False)
class States:
    """Motion of points under forces on points; see the formulas above."""

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    push: Real  # (k, inputs)
    seen: Real  # (outputs, k)
    swept: Real  # (outputs, k) [s]; 0 but of internal forces where stiffness is damped
    now: Real  # (outputs, inputs)
    late: Real  # (outputs, inputs)
    lead: Real  # (inputs,) [s]; 0 but of the motion of ends where stiffness is damped
    gamma: float  # [s]
    beyond: float  # Angular frequency of the lowest mode that is left out [rad/s], or infinite
    drag: float  # of the modes that are left out, as proportional damping [1/s]
    ratio: float  # of their damping, as a ratio
    wrong: Real  # (k,) rounding of push and seen, relative
    reach: Real  # (outputs, k) as much as what points yield lets modes move them, as seen
    # (outputs, inputs) sum of what left-out modes have as flexibility, in magnitude, at most;
    # infinite of internal forces, tips and moved ends
    left: Real

    @property
    def modes(self) -> int:
        """How many modes there are."""
        return len(self.sigma)

    def at(self, s: Complex) -> Complex:
        """Return the transfer functions at rates s [rad/s], shape (outputs, inputs, n)."""
        own = 1 / (s * s + 2 * np.multiply.outer(self.sigma, s) + self.square[:, None])
        row = self.seen[:, :, None] + np.multiply.outer(self.swept, s)
        push = self.push[:, :, None] * (1 + np.multiply.outer(self.lead, s))
        value = np.einsum("okn,kn,kin->oin", row, own, push, optimize=True)
        late = self.late[:, :, None] / (1 + self.gamma * s)
        return np.asarray(value + self.now[:, :, None] + late)

    def bound(self, omega: Real) -> Real:
        """Bound how far `at` is from the exact response at omega, (outputs, inputs, n)."""
        # a left-out mode is 1/(g lambda + p), p = s^2 + drag s, in place of 1/(g lambda); the
        # largest share |p|/|g lambda + p| is that of the lowest, whose lambda is beyond^2
        omega = np.asarray(omega, dtype=np.float64)
        if not np.isfinite(self.beyond):
            return np.zeros((*self.left.shape, len(omega)))
        stiff = np.abs(1 + 1j * self.gamma * omega)
        moves = np.abs(-(omega**2) + 1j * self.drag * omega)
        moves += 2 * self.ratio * omega * self.beyond
        room = stiff * self.beyond**2 - moves
        share = np.divide(moves, room, out=np.full(len(omega), np.inf), where=room > 0)
        with np.errstate(invalid="ignore"):
            far = self.left[:, :, None] * (share / stiff)
        return np.nan_to_num(far, nan=0.0, posinf=np.inf)


# --- what stands at single points ---------------------------------------------------------------


def without_dashpots(
    model: Compiled, component: tuple[str, ...]
) -> tuple[Compiled, tuple[Resistance, ...]]:
    """Return the model of plain lumps without dashpots of single points on a component, and these.

    So is what a few nodes have beside drag that is everywhere as the mass: a point mass less of it.
    """
    model = with_plain_lumps(model, component)
    found = [one for one in _dashpots(model) if one.point[0] in component]
    chain = model.chain
    if chain.damping is None and chain.drag is None:
        return model, ()
    given = np.zeros_like(chain.mass) if chain.damping is None else chain.damping
    damping = given.copy()
    total: dict[Point, float] = {}  # one of a point
    terms: dict[int, int] = {}  # nodes of one term have the same dashpots: taken from it once
    for one in found:
        node = locate(model.x, one.point[1])[0]
        term = int(chain.term_of[node])
        at = model.coordinates.index(one.point[0])
        if chain.held[term, at]:
            continue
        total[one.point] = total.get(one.point, 0.0) + one.damping
        if terms.setdefault(term, node) == node:
            damping[term, at, at] -= one.damping
    kept, total = _beside_drag(model, component, given, damping, total)
    free = chain._replace(damping=kept if kept.any() else None)
    alone = tuple(Resistance(*one) for one in total.items() if one[1])
    return dataclasses.replace(model, chain=free), alone


def _beside_drag(
    model: Compiled,
    component: tuple[str, ...],
    given: Real,
    damping: Real,
    alone: dict[Point, float],
) -> tuple[Real, dict[Point, float]]:
    """Leave what is as the mass everywhere of damping beside `alone`, if few nodes have other."""
    chain = model.chain
    own = np.array([model.coordinates.index(c) for c in component])
    square = np.ix_(np.arange(len(damping)), own, own)
    free = chain.held[:, own] == 0
    free &= np.isin(np.arange(len(free)), chain.term)[:, None]
    mass, resists = (one[:, own, own] for one in (chain.mass, damping))
    usual = _usual(chain, own, mass, resists, free)
    apart = resists - usual * mass
    most = np.maximum(np.abs(given[:, own, own]), np.abs(resists))
    other = free & (np.abs(apart) > 8 * np.finfo(float).eps * most)
    left = damping.copy()
    left[:, own, own] = np.where(free, usual * mass, resists)
    total = dict(alone)
    places = np.argwhere(other[chain.term_of]).tolist()
    for node, i in places:
        point = (component[i], float(model.x[node]))
        total[point] = total.get(point, 0.0) + float(apart[chain.term_of[node], i])
    couples = (damping[square] * (1 - np.eye(len(own)))).any()
    # less drag than none would drive modes that are left out
    drives = min(total.values(), default=0.0) < 0 and not _has_all_modes(model, component)
    if len(places) > FEW or couples or drives:
        return damping, alone
    return left, total


def _usual(chain: Chain, own: Index, mass: Real, resists: Real, free: Flags) -> float:
    """Return what damping is over mass in most places [1/s]."""
    if chain.inertia is None:
        moves = ((mass > 0) & free)[chain.term_of]
        ratio = np.divide(resists, mass, out=np.zeros_like(mass), where=mass > 0)[chain.term_of]
    else:
        element = np.unique(chain.element)
        inertia = chain.inertia[element][:, own]
        drag = np.zeros_like(inertia) if chain.drag is None else chain.drag[element][:, own]
        moves = inertia > 0
        ratio = np.divide(drag, inertia, out=np.zeros_like(drag), where=moves)
    return float(np.median(ratio[moves])) if moves.any() else 0.0


def _has_all_modes(model: Compiled, component: tuple[str, ...]) -> bool:
    chain = model.chain.only(component)
    return chain.finite is not None and chain.free <= LARGEST


def _dashpots(model: Compiled) -> list[Resistance]:
    found = []
    for part in standing(model.scene.parts):
        found += [Resistance((c, part.x), value) for c, value in part.term().damping.items()]
    for end, x in zip(model.scene.ends, (0.0, float(model.x[-1]))):
        found += [Resistance((c, x), v) for c, v in end_of(end).term().damping.items()]
    return [one for one in found if one.point[0] in model.coordinates]


# --- modes and residues -------------------------------------------------------------------------


def states(
    model: Compiled,
    component: tuple[str, ...],
    inputs: Sequence[Any],
    outputs: Sequence[Point],
    *,
    modes: int,
    other: bool = False,
) -> States:
    """Find the states of one component, without its dashpots of single points.

    Chains of at most `LARGEST` unknowns have all of their modes, others so many. `other` are as far
    from these as rounding is from the truth: of other circles, with squares off by their errors.
    """
    model, _ = without_dashpots(model, component)
    closed = _damping(model, component)
    eigenvalue, beyond, error = _eigenvalues(model, component, modes)
    ratio = np.zeros(len(eigenvalue))
    if having(model.scene.dampings, "ratio"):
        ratio = known_ratios(model, component, eigenvalue)
        if len(ratio) < len(eigenvalue):
            got = f"{len(ratio)} for {len(eigenvalue)}"
            raise SceneError(f"damping ratio must be one number or one for each mode, got {got}")
    circles = contour.on_a_line(eigenvalue, error, beyond**2)
    if other:
        eigenvalue, circles = _otherwise(eigenvalue, error, circles)
    asked = UndampedResponses(model, component, list(inputs), list(outputs))
    own, push, seen, reach, rest = _parted_points(asked, eigenvalue, circles, beyond)
    left = np.zeros(rest.shape)
    if np.isfinite(beyond):
        left = asked.bounded(lambda own: own.parted(eigenvalue, circles).rest).T
    omega = np.sqrt(np.maximum(eigenvalue, 0.0))
    gamma, drag = closed.soften.real, closed.drag.real
    sigma = ratio * omega + (drag + gamma * eigenvalue) / 2
    forces, ends = _stiff(inputs, outputs, gamma)
    at_once = np.logical_or.outer(forces, ends) | (gamma == 0)
    return States(
        sigma=sigma[own],
        square=eigenvalue[own],
        push=push,
        seen=seen,
        swept=np.where(forces[:, None], gamma * seen, 0.0),
        now=np.where(at_once, rest, 0.0),
        late=np.where(at_once, 0.0, rest),
        lead=np.where(ends, gamma, 0.0),
        gamma=gamma,
        beyond=beyond,
        drag=drag,
        ratio=float(ratio.max(initial=0.0)),
        wrong=(circles.rounding + np.divide(*mixed(eigenvalue, circles, sigma)))[own],
        reach=reach,
        left=left,
    )


def _stiff(inputs: Sequence[Any], outputs: Sequence[Point], gamma: float) -> tuple[Flags, Flags]:
    """Return which outputs are internal forces and which inputs are the motion of ends.

    Those are the elastic ones with what damps them, and so is what moves with an end.
    """
    forces = np.array([is_force(p) for p in outputs], dtype=np.bool_)
    ends = np.array([is_end(p) for p in inputs], dtype=np.bool_)
    if gamma != 0 and forces.any() and ends.any():
        raise SceneError(
            "response must not be an internal force where an end is moved and stiffness is damped: "
            "a jump of the end would take an infinite force"
        )
    return forces, ends


def softens(model: Compiled, component: tuple[str, ...]) -> bool:
    """Whether stiffness is damped, all of it alike."""
    plain = without_dashpots(model, component)[0].chain.only(component)
    closed = proportional(plain, Rates.of(model.scene.dampings))
    return closed is not None and closed.soften != 0


def why_coupled(model: Compiled, component: tuple[str, ...]) -> str:
    """Say that damping couples undamped modes, with nothing where it does not."""
    losses = losses_of(model)
    rates = Rates.of(model.scene.dampings)
    if not losses and proportional(model.chain.only(component), rates) is not None:
        return ""
    got = ", ".join(losses) if losses else repr(model.scene.damping)
    return (
        "damping must leave undamped modes uncoupled, as drag, modal ratios, dashpots of single "
        f"points and stiffness damping without tension do, got {got}"
    )


def _damping(model: Compiled, component: tuple[str, ...]) -> Proportional:
    """Return how all but dashpots of single points is damped, and refuse what couples modes."""
    why = why_coupled(model, component)
    closed = proportional(model.chain.only(component), Rates.of(model.scene.dampings))
    if why or closed is None:
        raise SceneError(why)
    return closed


def _eigenvalues(
    model: Compiled, component: tuple[str, ...], modes: int
) -> tuple[Real, float, Real]:
    """Return those of the modes, the angular frequency of the next, and the errors."""
    finite = model.chain.only(component).finite
    wanted = finite if finite is not None and _has_all_modes(model, component) else modes
    value, error, beyond = parted(*spectrum(model, component, wanted + 1), wanted)
    if np.isfinite(value).all() and not np.isfinite(error).all():
        raise SolveError(f"({', '.join(component)}): the modes have no correct digit")
    return value, math.sqrt(max(beyond, 0.0)), error


def _otherwise(
    eigenvalue: Real, error: Real, circles: contour.Circles
) -> tuple[Real, contour.Circles]:
    """Return eigenvalues as their errors let them be, and other circles around them."""
    off, eigenvalue = error * (-1.0) ** np.arange(len(error)), eigenvalue.copy()
    for one in circles.some(circles.innermost).members:
        if eigenvalue[one].any():  # rigid motion stays such
            eigenvalue[one] = eigenvalue[one].mean() + off[one]
    return eigenvalue, circles._replace(radius=CIRCLED * circles.radius)


def _parted_points(
    asked: UndampedResponses, eigenvalue: Real, circles: contour.Circles, beyond: float
) -> tuple[Index, Real, Real, Real, Real]:
    """Return of each state its mode, its push, how it is and may be seen, and the rest."""
    # each point once, what is pushed and watched there is one; others tell close modes apart
    probes = _probes(asked.model, asked.component) if (circles.size > 1).any() else []
    both = asked.drives, asked.responses
    pushed = [p for p in asked.drives if not is_end(p)]
    drives, responses = (
        [*dict.fromkeys([*one, *more])] for one, more in zip(both, (probes, [*pushed, *probes]))
    )
    every = dataclasses.replace(asked, drives=drives, responses=responses)
    parted = every.parted(eigenvalue, circles)
    rest = (parted.rest if np.isfinite(beyond) else parted.left).T
    own, push, seen, reach = _factored(parted, eigenvalue, circles, every)
    i, o = ([one.index(p) for p in given] for one, given in zip((drives, responses), both))
    return own, push[:, i], seen[o], reach[o], rest[np.ix_(o, i)]


def _probes(model: Compiled, component: tuple[str, ...]) -> list[Point]:
    """Return points spread along the rope."""
    at = spread(PROBES).tolist()
    return [(c, x * float(model.x[-1])) for c in component for x in at]


# --- residues as products -----------------------------------------------------------------------


def _factored(
    parted: Parted, eigenvalue: Real, circles: contour.Circles, asked: UndampedResponses
) -> tuple[Index, Real, Real, Real]:
    """Return of each state its mode, its push, and how it is and may be seen."""
    residue, most = parted.residue, parted.yields()
    inputs, outputs, _ = residue.shape
    same = [asked.responses.index(p) if p in asked.responses else -1 for p in asked.drives]
    twin = np.array(same, dtype=np.intp)
    one_each = circles.some(circles.innermost)
    number: list[int] = []
    found: list[tuple[Real, Real]] = []
    for center, radius, members in zip(*circles.outer[:2], circles.outer.members):
        size = most / np.abs(parted.soft[members]).max()
        whole = residue[:, :, members].sum(axis=2)
        if len(members) > 1:  # where each product stands out of rounding
            size = _rounded(residue, eigenvalue, members, (center, radius))
        several = _products(whole, len(members), size, twin)
        if len(members) == 1 or not several:
            number += len(several) * members.tolist()
            found += [(one.push, one.seen) for one in several]
            continue
        inner = one_each.some(np.flatnonzero([g[0] in members for g in one_each.members]))
        parts = [
            _Part(
                residue[:, :, group].sum(axis=2),
                _rounded(residue, eigenvalue, group, (middle, near)) * np.abs(middle / near),
            )
            for middle, near, group in zip(*inner[:2], inner.members)
        ]
        for group, states in zip(inner.members, _told(several, parts, size, twin)):
            number += [int(group[min(k, len(group) - 1)]) for k in range(len(states))]
            found += states
    own = np.array(number, dtype=np.intp)
    push = np.array([one for one, _ in found], dtype=np.float64).reshape(len(own), inputs)
    seen = np.array([one for _, one in found], dtype=np.float64).reshape(len(own), outputs)
    i = max(np.flatnonzero(twin >= 0), key=lambda i: most[i, twin[i]], default=None)
    yields = np.zeros(outputs) if i is None else most[i] / np.sqrt(most[i, twin[i]] or np.inf)
    return own, push, seen.T, np.divide.outer(yields, np.sqrt(np.abs(parted.soft[own])))


def _rounded(residue: Real, eigenvalue: Real, members: Index, circle: tuple[float, float]) -> Real:
    """Return what rounding makes of the sum of residues in a circle, (inputs, outputs)."""
    center, radius = circle
    others = np.abs(np.delete(residue, members, axis=2))
    away = np.abs(np.delete(eigenvalue, members) - center)
    whole = residue[:, :, members].sum(axis=2)
    return np.asarray(contour.ROUNDED * (others @ (radius / away) + np.abs(whole)))


class _Part(NamedTuple):
    """Residues of one of close modes."""

    residue: Real  # (inputs, outputs)
    size: Real  # of rounding


def _told(
    several: list[_Product], parts: list[_Part], size: Real, twin: Index
) -> list[list[tuple[Real, Real]]]:
    """Return push and seen of the states of each of close modes.

    The products that they have together are all that they do, so only which mode does what is known
    the worse the closer they are. What is known better of a mode by itself is taken from that.
    """
    push, seen = (np.array(one).T for one in list(zip(*several))[:2])
    i, o = (list(one) for one in zip(*(one.at for one in several)))
    weight = np.sqrt(np.abs(push[i].diagonal() * seen[o].diagonal()) / size[i, o])
    stands = np.abs(push[i].diagonal())
    rounded, missed = (size[:, o] / stands, size[i].T / stands), _missed(size, twin)
    found: list[list[tuple[Real, Real]]] = []
    for part in parts:
        shares = _shares(part.residue[np.ix_(i, o)], push[i], seen[o], weight)
        states = [(push @ one, seen @ one) for one in shares]
        if states:
            by = [m + one @ np.abs(shares[0]) for m, one in zip(missed, rounded)]
            states[0] = _alone(part, states, (by[0], by[1]), twin)
        found.append(states)
    # what their sum is off by within rounding they know better
    own = [np.array([np.linalg.solve(push[i], a[i]) for a, _ in states]) for states in found]
    none = np.eye(len(several))
    off = np.linalg.cholesky(sum(one.T @ one for one in own if len(one))) - none
    off[np.abs(off) * np.multiply.outer(weight, weight) <= 1] = 0.0
    more = [np.linalg.solve(none + off, one.T).T - one if len(one) else one for one in own]
    return [
        [(a + push @ d, b + seen @ d) for (a, b), d in zip(states, each)]
        for states, each in zip(found, more)
    ]


def _shares(part: Real, push: Real, seen: Real, weight: Real) -> Real:
    """Return what a mode is of products, from what it and they are at their points.

    By how far each product stands out of rounding: what does not takes nothing from others. Shape
    (states, products).
    """
    own = np.linalg.solve(push, np.linalg.solve(seen, part.T).T)
    lost, axes = np.linalg.eigh(weight[:, None] * (own + own.T) / 2 * weight)
    return np.asarray((axes[:, lost > NONE] * np.sqrt(lost[lost > NONE])).T[::-1] / weight)


def _missed(size: Real, twin: Index) -> tuple[Real, Real]:
    """Return how much of push and seen a product may have that rounding hides."""
    t = np.flatnonzero(twin >= 0)
    root = np.sqrt(size[t, twin[t]])
    push, seen = np.zeros(len(twin)), np.divide(size[t].T, root, where=root > 0, out=0 * size[t].T)
    push[t] = root
    return math.sqrt(LOST) * push, math.sqrt(LOST) * seen.max(axis=1)


def _alone(
    part: _Part, states: list[tuple[Real, Real]], rounded: tuple[Real, Real], twin: Index
) -> tuple[Real, Real]:
    """Return the first state of a mode by what its own residues know better of it."""
    push, seen = states[0]
    t = np.flatnonzero(twin >= 0)
    i = int(t[np.argmax(push[t] ** 2 / part.size[t, twin[t]])])
    o, here = twin[i], push[i]
    left = part.residue - sum(np.multiply.outer(a, b) for a, b in states)
    half = left[i, o] / (2 * here)
    more = (left[:, o] - push * half) / here, (left[i] - seen * half) / here
    lost = part.size[:, o] / np.abs(here), part.size[i] / np.abs(here)
    a, b = (
        x * np.divide(r**2, r**2 + w**2, out=np.zeros_like(x), where=r > 0)
        for x, r, w in zip(more, rounded, lost)
    )
    a[t] = b[twin[t]] = (a[t] + b[twin[t]]) / 2
    return push + a, seen + b


class _Product(NamedTuple):
    """Residues of a mode."""

    push: Real  # (inputs,)
    seen: Real  # (outputs,)
    at: tuple[int, int]  # where it is known best


def _products(R: Real, most: int, size: Real, twin: Index) -> list[_Product]:
    """Return the products that residues are the sum of, as many as are not rounding."""
    found: list[_Product] = []
    for _ in range(most):
        one = _largest(R, size, twin, alone=most == 1)
        if one is None or any(i == one.at[0] or o == one.at[1] for i, o in (f.at for f in found)):
            break  # rounding is left where a product was known best
        found.append(one)
        R = R - np.multiply.outer(one.push, one.seen)
    return found


def _largest(R: Real, size: Real, twin: Index, *, alone: bool) -> _Product | None:
    """Return the largest product in the residues of modes."""
    share = np.divide(np.abs(R), size, out=np.zeros_like(R), where=size > 0)
    if not share.any():
        return None
    i, o = np.unravel_index(int(share.argmax()), share.shape)
    if not alone:
        # of several shapes only points that are pushed and watched leave products of such
        own = [share[i, o] if o >= 0 and R[i, o] > 0 else 0.0 for i, o in enumerate(twin)]
        best = int(np.argmax(own))
        if own[best] <= LOST:
            return None
        i, o = np.intp(best), twin[best]
    push, seen = _scaled(R, size, share, twin, (int(i), int(o)))
    return _Product(push, seen, (int(i), int(o)))


def _scaled(
    R: Real, size: Real, share: Real, twin: Index, at: tuple[int, int]
) -> tuple[Real, Real]:
    """Return push and seen from a pivot: points move by what they are pushed with."""
    i, o = at
    root = np.sqrt(np.abs(R[at]))
    push, seen = R[:, o] * (np.sign(R[at]) / root), R[i] / root
    t = np.flatnonzero(twin >= 0)
    if not len(t):
        return push, seen
    w = twin[t]
    a, b = share[t, o], share[i, w]  # what has the larger share is known better
    k = int(np.minimum(a, b).argmax())
    if min(a[k], b[k]) > KNOWN:
        one, other = push[t[k]], seen[w[k]]
    else:  # none of them: as far as rounding moves those that move most
        own = np.sqrt(np.maximum(size[t, w], np.finfo(float).tiny))
        one, other = (np.max(np.abs(x) / own) for x in (push[t], seen[w]))
    ratio = np.sqrt(np.abs(other / one)) if one and other else 1.0
    push, seen = push * ratio, seen / ratio
    known = np.divide(a**2, a**2 + b**2, out=np.full(len(t), 0.5), where=a + b > 0)
    push[t] = seen[w] = seen[w] + (push[t] - seen[w]) * known
    return push, seen
