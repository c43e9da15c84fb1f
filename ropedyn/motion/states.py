"""Motion of a few points as undamped modes, each damped for itself, and what follows them at rest.

    q_k'' + 2 sigma_k q_k' + square_k q_k = sum_i push[k, i] (f_i + lead_i f_i')
    y_o = sum_k (seen[o, k] q_k + swept[o, k] q_k') + sum_i (now[o, i] f_i + late[o, i] l_i),
    l_i + gamma l_i' = f_i

`now` and `late` are the flexibility of the modes that are left out: damped stiffness lets it relax.
Residues are means over circles around the eigenvalues (see contour.py), so that nothing but H is
asked for, and each is a product push times seen (products.py). Dashpots of single points are left
out of the modes: they are laws of these points, as stops and friction are.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Flags, Index, Real
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
from .products import factored
from .undamped import UndampedResponses, losses_of, mixed

LARGEST = 200  # All modes of a chain with so many are taken.
FEW = 16  # Nodes whose damping is not as their mass are points of their own, at most.
CIRCLED = 0.6  # Other circles are so much smaller.
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

    @property
    def modes(self) -> int:
        """How many modes there are."""
        return len(self.sigma)


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
    from these as rounding is from the truth: of other circles, with squares off by their errors,
    and other shapes of modes that are one.
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
    own, push, seen, reach, rest = _parted_points(asked, eigenvalue, circles, beyond, other=other)
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
            eigenvalue[one] += off[one]
    return eigenvalue, circles._replace(radius=CIRCLED * circles.radius)


def _parted_points(
    asked: UndampedResponses,
    eigenvalue: Real,
    circles: contour.Circles,
    beyond: float,
    *,
    other: bool,
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
    own, push, seen, reach = factored(
        parted, eigenvalue, circles, (drives, responses), turned=other
    )
    i, o = ([one.index(p) for p in given] for one, given in zip((drives, responses), both))
    return own, push[:, i], seen[o], reach[o], rest[np.ix_(o, i)]


def _probes(model: Compiled, component: tuple[str, ...]) -> list[Point]:
    """Return points spread along the rope."""
    at = spread(PROBES).tolist()
    return [(c, x * float(model.x[-1])) for c in component for x in at]
