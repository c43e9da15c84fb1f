"""Twist and tension at twice the frequency of transverse motion, to second order in it.

Slopes z' strain the rope by z'^2/2. Motion Re(Z e^(i omega t)) so has, at 2 omega, the eigenstrain
Z'^2/4, and where there is a first tension N it turns with the rope, N Z'/2 across. Work done on the
field of a unit load on the response r, at 2 omega, is the response (Betti):

    r(2 omega) = -1/4 integral of (N_r Z'^2 + 2 N Z' Z_r') ds ,

for an internal force with the field of a unit dislocation. The integral is taken by Gauss's rule on
pieces that follow waves and boundary layers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Index, Real
from ..base.errors import SceneError
from ..base.unit import QUANTITIES
from ..chain import tip
from ..chain.chain import CHANNELS, TRANSVERSE
from ..chain.compiled import Compiled
from ..chain.place import points
from ..chain.port import Point, cut, moving, ports
from ..curves.resonance import Resonances
from ..scene import damping
from ..scene.parts.stretch import refuse_uneven
from .fields import Fields
from .frf import FRF, MeshOfResponse, RoundingOfResponse
from .harmonic import solve_harmonic
from .question import Question
from .rounding import EPS, bound_of, relative

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)
TURN = 4.0  # All waves together turn by so much on a piece [rad]: the rule is right to rounding.
TOLD = 1 << 22  # Complex numbers of one look at the fields.


@dataclass(frozen=True, eq=False)
class SecondHarmonic(FRF):
    """Motion and tension at twice the frequency of a force, per square of the force.

    Motion is Re(value exp(+2 i omega t)) under the force cos(omega t), exact to second order: an
    amplitude A of the force makes A^2 of it. It has no derivatives, no peaks of one kind and no
    file format of other programs.

    Attributes
    ----------
    drive, response, quantity, cost
        As in `FRF`.
    frequency : ndarray, shape (f,)
        Of the force [Hz]; the value has twice that.
    value : ndarray of complex, shape (responses, f) or (drives, responses, f)
        [m/N^2, rad/N^2, of internal forces N/N^2 and so on], of each drive alone.
    rounding_error : ndarray, as value
        Estimated relative error of rounding and of the integral along the rope.
    mesh_error : ndarray, as value
        0: only continuous spans are asked.

    Examples
    --------
    A laid rope on a swivel turns twice in a period of its transverse motion:

    >>> import ropedyn as rd
    >>> rope = rd.Rope(
    ...     1.0, 0.4, axial_stiffness=6e5, torsional_stiffness=0.15, lay_coupling=120.0
    ... )
    >>> ends = "clamped", rd.End(alpha="free")
    >>> model = rd.Scene(rope, tension=2830.0, ends=ends).compile()
    >>> twice = model.frf([10.0], drive=("z", 0.3), response=("alpha", 1.0), harmonic=2)
    >>> twice.labels, twice.value.round(10)
    (('alpha at 1.000 m [rad/N^2]',), array([[-5.6889e-06+0.j]]))
    """

    power: ClassVar[int] = 2  # of the force, that the value is per

    @property
    def s(self) -> Complex:
        """The rate at which the value oscillates, 2 i omega, shape (f,) [1/s].

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.4, axial_stiffness=6e5)
        >>> model = rd.Scene(rope, tension=2830.0).compile()
        >>> model.frf([1.0], drive=("z", 0.3), response=("F_x", 0.0), harmonic=2).s.imag.round(3)
        array([12.566])
        """
        return np.asarray(4j * np.pi * self.frequency, dtype=np.complex128)

    def peaks(self, drive: int = 0) -> tuple[Resonances, ...]:
        """Refuse it: peaks belong to transverse motion and, at half their frequency, to twist.

        Raises
        ------
        SceneError
            Always.
        """
        raise SceneError(
            "peaks must be asked of motion at the frequency of the force, got harmonic 2, which "
            "has those of transverse motion and those of twist at half their frequency"
        )

    def derivative(self, path: str) -> Complex:
        """Refuse it.

        Raises
        ------
        SceneError
            Always.
        """
        raise SceneError(f"derivative must be of harmonic 1, got harmonic 2 and path {path!r}")

    def write(self, path: Any, *, binary: bool = False) -> None:
        """Refuse it: other programs know no response per square of a force; `save` does.

        Raises
        ------
        SceneError
            Always.
        """
        raise SceneError("path must be for `save`, which keeps harmonic 2: other files know none")


def solver_of(harmonic: int) -> Callable[..., FRF]:
    """Return what computes the response at a multiple of the frequency."""
    return (solve_harmonic, solve_second)[check.count(harmonic, "harmonic", most=2) - 1]


def solve_second(
    model: Compiled,
    frequency: ArrayLike,
    *,
    drive: Any,
    response: Any = None,
    quantity: str = "receptance",
    solver: str = "sweep",
    threads: int | None = None,
    decay: float = 0.0,
) -> SecondHarmonic:
    """Compute what has twice the frequency; see `Model.frf`."""
    _refuse(model, solver, decay)
    f = check.frequencies(frequency)
    drives, several = points(model, drive, "drive", forces=False, ends=True)
    responses = _responses(model, response)
    order = QUANTITIES[check.one_of(quantity, "quantity", QUANTITIES)]
    rule = _rule(model, f.max(), [*drives, *responses])
    value, rounding = _integrated(model, f, drives, responses, rule)
    top = f[[int(f.argmax())]]
    once, _ = _integrated(model, top, drives, responses, rule)
    again, _ = _integrated(model, top, drives, responses, rule.halved)
    size = np.abs(value)
    error = np.where(size > 0, rounding + _apart(once, again), 0.0)
    value *= (4j * np.pi * f) ** order
    if not several:
        value, error = value[0], error[0]
    return SecondHarmonic(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=value,
        rounding=RoundingOfResponse.of_relative(value, error),
        rounding_bound=error,
        cost=Cost(solver, len(model.x) - 1, model.size, sweeps=4 * len(f)),
        mesh=MeshOfResponse(np.zeros(value.shape)),
    )


def _refuse(model: Compiled, solver: str, decay: float) -> None:
    """Refuse what has no second order here, by name."""
    scene = model.scene
    if model.element != "continuous":
        raise SceneError(
            "elements must be left out where harmonic is 2, which continuous spans tell, got "
            f"{model.element!r} elements"
        )
    if solver != "sweep":
        raise SceneError(f'solver must be "sweep" where harmonic is 2, got {solver!r}')
    if decay:
        raise SceneError(f"decay must be 0 where harmonic is 2 [1/s], got {decay!r}")
    if scene.rope.axial_stiffness is None:
        raise SceneError(
            "axial_stiffness of the rope must be given where harmonic is 2 [N], got None: nothing "
            "is stretched"
        )
    refuse_uneven(scene.parts, "where harmonic is 2")
    if scene.gravity is not None:
        raise SceneError(
            "gravity must be None where harmonic is 2, got one: along a sag, or where the tension "
            "grows, the slopes alone do not tell what stretches"
        )
    for one in damping.having(scene.dampings, "ratio"):
        raise SceneError(
            f"damping must not be modal where harmonic is 2: it tells no fields along it, got {one}"
        )


def _responses(model: Compiled, given: Any) -> tuple[Point, ...]:
    if given is None:
        raise SceneError(
            'response must be given where harmonic is 2, such as ("alpha", x) or ("F_x", 0.0), '
            "got None"
        )
    found, _ = points(model, given, "response")
    if any(map(tip.is_tip, found)):
        raise SceneError("response must not be the tip of a wire where harmonic is 2")
    return found


class Rule(NamedTuple):
    """Where integrands are looked at along the rope, and what they count."""

    edge: Real  # (pieces + 1,) of the pieces [m]

    @property
    def x(self) -> Real:
        """Places, increasing [m]."""
        middle, half = (self.edge[1:] + self.edge[:-1]) / 2, np.diff(self.edge) / 2
        return np.asarray((middle[:, None] + half[:, None] * NODES).ravel())

    @property
    def weight(self) -> Real:
        """Weights [m]."""
        return np.multiply.outer(np.diff(self.edge) / 2, WEIGHTS).ravel()

    @property
    def halved(self) -> Rule:
        """The rule on pieces of half the length."""
        return Rule(np.sort(np.concatenate([self.edge, (self.edge[1:] + self.edge[:-1]) / 2])))


def _rule(model: Compiled, fastest: float, given: Sequence[Point]) -> Rule:
    """Divide the rope between what stands on it: short pieces in boundary layers."""
    at = [p[1] for p in given if not check.is_end(p)]
    stops = np.unique(np.concatenate([model.x, at]))
    stops = stops[np.append(True, np.diff(stops) > check.NEAR * model.x[-1])]
    layer, longest = _scales(model, fastest)
    edges = [float(stops[0])]
    for a, b in pairwise(stops.tolist()):
        half, steps, size = (b - a) / 2, [0.0], layer
        while steps[-1] + size < half:
            steps.append(steps[-1] + size)
            size = min(2 * size, longest)
        edges += [a + s for s in steps[1:]] + [a + half] + [b - s for s in reversed(steps)]
    return Rule(np.array(edges))


def _scales(model: Compiled, fastest: float) -> tuple[float, float]:
    """Return how thick boundary layers are and how long waves let pieces be [m]."""
    chain, names = model.chain, model.coordinates
    omega = 2 * np.pi * fastest
    inertia = dict(zip(names, chain.inertia.T)) if chain.inertia is not None else {}
    S = chain.flexibility
    # a slope squared and a wave along the rope at twice the frequency
    turns = 2 * omega * np.sqrt(inertia["x"] * S[:, 0, 0])
    if "alpha" in inertia:
        turns = turns + 2 * omega * np.sqrt(inertia["alpha"] * S[:, 1, 1])
    thin = np.full(len(S), np.inf)
    across = np.zeros(len(S))
    for z, beta in (plane for plane in TRANSVERSE if plane[0] in names):
        if beta in names:
            bends = S[:, CHANNELS[beta], CHANNELS[beta]]
            root = np.sqrt(chain.tension**2 + 4 * inertia[z] * omega**2 / bends)
            own = 2 * np.sqrt(np.maximum(root - chain.tension, 0.0) * bends / 2)
            layer = 1 / np.sqrt(np.maximum((root + chain.tension) * bends / 2, 1e-300))
            thin = np.minimum(thin, layer)
        else:
            own = 2 * omega * np.sqrt(inertia[z] / chain.tension)
        across = np.maximum(across, own)
    turns = turns + across
    longest = float(TURN / np.maximum(turns.max(), 1e-300))
    return min(float(thin.min()), longest), longest


class FieldsAlong(NamedTuple):
    """Fields at the places of a rule under loads one after another."""

    tension: Complex  # (loads, places, f) N
    slope: Complex  # (planes, loads, places, f) z', y'
    rounding: Real  # (loads, f) relative


def _integrated(
    model: Compiled,
    f: Real,
    drives: Sequence[Point],
    responses: Sequence[Point],
    rule: Rule,
) -> tuple[Complex, Real]:
    """Return the responses per square of the force and relative errors, (drives, responses, f)."""
    value = np.zeros((len(drives), len(responses), len(f)), dtype=np.complex128)
    rounding = np.zeros(value.shape)
    most = max(1, TOLD // (len(rule.x) * 2 * len(model.coordinates)))
    for first in range(0, len(f), most):
        part = slice(first, first + most)
        moved = _fields(model, f[part], drives, rule)
        told = _fields(model, 2 * f[part], responses, rule)
        for d in range(len(drives)):
            slope, tension = moved.slope[:, d], moved.tension[d]
            work = told.tension * (slope**2).sum(axis=0)
            work += (2 * tension * slope[:, None] * told.slope).sum(axis=0)
            value[d, :, part] = -np.einsum("rxf,x->rf", work, rule.weight) / 4
            rounding[d, :, part] = 2 * moved.rounding[d] + told.rounding
    return value, rounding


def _fields(model: Compiled, f: Real, loads: Sequence[Point], rule: Rule) -> FieldsAlong:
    """Return the fields of unit loads, dislocations and motions of ends."""
    shape = (len(loads), len(rule.x), len(f))
    planes = [plane for plane in TRANSVERSE if plane[0] in model.coordinates]
    tension, slope = np.zeros(shape, np.complex128), np.zeros((len(planes), *shape), np.complex128)
    rounding = np.zeros((len(loads), len(f)))
    factor = np.ascontiguousarray(damping.factors(model.scene.dampings, 2 * np.pi * f).T)
    for component in model.components:
        here = [k for k, load in enumerate(loads) if moving(load) in component]
        if not here or not {"x", "y", "z"} & set(component):
            continue
        fine = _cut(model, component, rule.x)
        question = Question(fine, component, f, factor, [loads[k] for k in here], [], 1)
        fields = Fields(question)
        at = _places(fields.x, rule.x)
        told = fields.at(slice(None)).reshape(len(here), len(fields.x), 2, len(component), len(f))
        if "x" in component:
            tension[here] = told[:, at, 1, component.index("x")]
        for own, (z, beta) in zip(slope, planes):
            if beta in component:
                own[here] = told[:, at, 0, component.index(beta)]
            elif z in component:
                pull = model.scene.mean_tension * factor[damping.TENSION]
                own[here] = told[:, at, 1, component.index(z)] / pull
        rounding[here] = _rounding(fields, factor, at)
    return FieldsAlong(tension, slope, rounding)


def _cut(model: Compiled, component: tuple[str, ...], positions: Real) -> Compiled:
    """Return the model with nodes at the places of a rule."""
    chain, x = cut(model.chain, model.x, positions.tolist())
    return replace(model, chain=chain, x=x)


def _places(x: Real, positions: Real) -> Index:
    """Return the nodes at positions."""
    right = np.clip(np.searchsorted(x, positions), 1, len(x) - 1)
    return right - (positions - x[right - 1] < x[right] - positions)


def _rounding(fields: Fields, factor: Complex, at: Index) -> Real:
    """Return the relative error of motion where it is driven in the midst of the rope, (f,)."""
    component, x = fields.question.component, fields.x
    inside = float(x[at[len(at) * 3 // 8]])
    pushed = ports(fields.chain, x, component, [(moving(fields.question.drives[0]), inside)])
    value = _core.sweep(fields.chain, factor, pushed, pushed)[0]
    error = bound_of(fields.chain, factor, pushed, pushed) + EPS * np.abs(value)
    return np.minimum(relative(value, error)[0, 0], 1.0)


def _apart(once: Complex, again: Complex) -> Real:
    """Return how far two values of integrals are from each other, relative to the second."""
    size = np.abs(again)
    return np.divide(np.abs(once - again), size, out=np.zeros(size.shape), where=size > 0)
