"""Mean stretching: forces on all modes by quadratic forms of their amplitudes.

With the mean tension's modes of unit mass, of both planes where there are two, and G the integral
of the products of their slopes in a plane,

    q_k'' + 2 sigma_k q_k' + square_k q_k = drive_k - N (G q)_k,   N = EA/(2 L) q^T G q,

the forces N G q at the stages of a step are unknown. Newton's method takes the couplings of G aside
from N for what they were: with the diagonal of G each mode has a system of its own, and N one of
the stages.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Real
from ...base.errors import SolveError
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, locate, moving
from ...chain.tip import is_tip
from ...eigen.damped.proportional import proportional
from ...eigen.damped.rates import Rates
from ...eigen.sensitivity import by_tension
from ...eigen.spectrum import SOLVERS
from ...response.modal_sum import known_ratios
from ...response.moved_end import is_end
from ...scene.damping import having
from ...scene.tension import Tension
from ..modal.expansion import Expansion
from ..request import Run
from ..states import LARGEST
from .collocation import STAGES, Oscillating, lagrange, nodes
from .passage import LawPassage, Passed
from .system import LawQuestion, LawSystem, shifted

MOST = 40  # Newton steps.
ENOUGH, LEAST = 1e-13, 1e-10  # They end here, or here where rounding lets gaps fall no more.


class Form(NamedTuple):
    """A force -(stiffness/2 q^T matrix q) matrix q on the modes."""

    stiffness: float  # [N/m]
    matrix: Real  # (k, k)


@dataclass(frozen=True, eq=False)
class StretchedSystem(LawSystem):
    """A component whose modes forms couple; the amplitudes are the first of its outputs."""

    forms: tuple[Form, ...]

    @classmethod
    def stretched(cls, run: Run, asked: LawQuestion) -> StretchedSystem:
        """Find the modes of a chain, in one plane or both, and how stretching couples them."""
        from scipy.linalg import block_diag

        model, (component, _, outputs, looks) = run.model, asked
        planes = [_Plane.of(model, one) for one in model.components if {*one} <= {*component}]
        eigenvalue = np.concatenate([plane.eigenvalue for plane in planes])
        sigma = np.concatenate([plane.decay for plane in planes])
        count = len(eigenvalue)
        seen = np.concatenate([np.eye(count), _moved(planes, outputs)])
        drive = [k for k, p in enumerate(run.places) if moving(p) in component]
        push = _moved(planes, [run.places[k] for k in drive])
        none = np.zeros((1, len(seen), 0)), np.zeros((1, len(seen)))
        rest = {"b": np.zeros((1, *seen.shape)), "p": np.zeros(0), "r": none[0], "rest": none[1]}
        stiffness = (model.scene.rope.axial_stiffness or 0.0) / model.scene.rope.length
        return cls(
            laws=[],
            modes=Oscillating(sigma, eigenvalue, np.eye(count), seen, np.zeros_like(seen)),
            driven=[
                Expansion(
                    sigma, eigenvalue, a=(seen * one)[None], bound=none[1], beyond=np.inf, **rest
                )
                for one in push
            ],
            pushes=[run.pushes[k] for k in drive],
            time=run.time,
            looks=[look._replace(output=shifted(look.output, count)) for look in looks],
            beyond=np.inf,
            forms=(Form(stiffness, block_diag(*(plane.form for plane in planes))),),
        )

    @property
    def points(self) -> slice:
        """Outputs that are the amplitudes."""
        return slice(len(self.modes.sigma))


class _Plane(NamedTuple):
    """All modes of a plane of a chain, of unit modal mass."""

    model: Compiled
    component: tuple[str, ...]
    eigenvalue: Real
    decay: Real
    shape: Real
    form: Real  # integrals of the products of their slopes

    @classmethod
    def of(cls, model: Compiled, component: tuple[str, ...]) -> _Plane:
        eigenvalue, shape = unit_modes(model, component)
        decay = _decay(model, component, eigenvalue)
        form = by_tension(model.chain.only(component), shape)
        return cls(model, component, eigenvalue, decay, shape, form)


def _moved(planes: Sequence[_Plane], points: list[Point]) -> Real:
    """Return how the modes of all planes move points at nodes, (points, k)."""
    moved = []
    for plane in planes:
        mine = [k for k, point in enumerate(points) if moving(point) in plane.component]
        rows = np.zeros((len(points), len(plane.eigenvalue)))
        own = [points[k] for k in mine]
        rows[mine] = moved_by(plane.model, plane.component, plane.shape, own)
        moved.append(rows)
    return np.concatenate(moved, axis=1)


def is_stretched(model: Compiled, component: tuple[str, ...]) -> bool:
    """Whether motion of a component adds to the tension."""
    tension = model.scene.tension
    across = not {"y", "z"}.isdisjoint(component)
    return across and isinstance(tension, Tension) and tension.stretching


def moving_together(model: Compiled) -> list[tuple[str, ...]]:
    """Return the components, as one those that stretching couples."""
    planes = [one for one in model.components if is_stretched(model, one)]
    others = [one for one in model.components if one not in planes]
    return [*([sum(planes, ())] if planes else []), *others]


def stretched_points(model: Compiled, component: tuple[str, ...], points: Sequence[Any]) -> bool:
    """Whether modes of a chain tell how these points move."""
    chain = model.chain.only(component)
    if chain.finite is None or chain.free > LARGEST or chain.carried:
        return False
    if model.element == "difference" and "beta" in component:
        return False
    mass = chain.mass[chain.term_of]
    for point in (p for p in points if moving(p) in component):
        if is_end(point) or is_tip(point) or is_force(point):
            return False
        node, inside = locate(model.x, point[1])
        at = component.index(point[0])
        if inside is not None or not (
            mass[node, at, at] > 0 or chain.held[chain.term_of[node], at]
        ):
            return False
    return True


def unit_modes(model: Compiled, component: tuple[str, ...]) -> tuple[Real, Real]:
    """Return the eigenvalues of all modes of a chain, and their shapes of unit modal mass."""
    chain = model.chain.only(component)
    found = SOLVERS["sweep"](model, component, chain.finite, np.inf, shaped=True)
    shape = found.shape
    assert shape is not None
    heavy = np.einsum("nab,knb->kna", chain.mass[chain.term_of], shape)
    half = np.sqrt(np.einsum("kna,kna->k", heavy, shape))
    return found.eigenvalue, shape / half[:, None, None]


def _decay(model: Compiled, component: tuple[str, ...], eigenvalue: Real) -> Real:
    closed = proportional(model.chain.only(component), Rates.of(model.scene.dampings))
    assert closed is not None
    ratio = np.zeros(len(eigenvalue))
    if having(model.scene.dampings, "ratio"):
        ratio = known_ratios(model, component, eigenvalue)
    omega = np.sqrt(np.maximum(eigenvalue, 0.0))
    return np.asarray(ratio * omega + (closed.drag.real + closed.soften.real * eigenvalue) / 2)


def moved_by(model: Compiled, component: tuple[str, ...], shape: Real, points: list[Point]) -> Real:
    """Return how modes move points at nodes, (points, k)."""
    at = [(locate(model.x, x)[0], component.index(c)) for c, x in points]
    return np.array([shape[:, n, c] for n, c in at]).reshape(len(points), len(shape))


# --- steps --------------------------------------------------------------------------------------


class StretchedPassage(LawPassage):
    """A run with steps of one length at most."""

    system: StretchedSystem

    def through(self, progress: Callable[[float], object]) -> Passed:
        """Take all steps."""
        known = self._known()[:, :, 0]
        k = known.shape[-1]
        state, force, size = np.zeros((2, k)), np.zeros((STAGES, k)), 0.0
        done, before = 0, None
        ahead = lagrange(1 + nodes(STAGES))
        for block in self._blocks(4096):
            if block.h != before:
                step = StretchedStep.of(self.system, block.h)
            before = block.h
            states, forces = np.empty((block.number, 2, k)), np.empty((block.number, STAGES, k))
            for i in range(block.number):
                states[i] = state
                q = known[done] + step.free(state)
                guess = ahead @ force if i else force
                solved, residual = step.solve(q, guess, size)
                if solved is None:
                    when = block.begin + i * block.h
                    told = f"stretching does not converge at t = {when!r} s: the residual is "
                    error = SolveError(f"{told}{residual:.3g} of the forces")
                    return Passed(self.looked, when, done * STAGES, error, settles=False)
                forces[i] = force = solved
                size = max(size, float(np.abs(force).max()))
                state = step.carry(state, force)
                done += 1
            self._look(block, forces, states, done == len(known))
            progress(done / len(known))
        return Passed(self.looked, float(self.system.time[-1]), done * STAGES)

    def _row(self, number: int, h: float, theta: float) -> tuple[Real, Real]:
        if (h, theta, number) not in self._rows:
            look, modes = self.system.looks[number], self.system.modes
            some = modes.some(slice(0, 0), look.output)
            own, forced = some.modal_rows(modes.reached(h, theta), look.order, h)
            self._rows[h, theta, number] = own.reshape(len(own), -1), forced.reshape(len(own), -1)
        return self._rows[h, theta, number]


class StretchedStep(NamedTuple):
    """How modes move over a step."""

    forms: tuple[Form, ...]
    ahead: Real  # (stages, 2, k) amplitudes at the stages per (q, q') at the beginning
    own: Real  # (k, stages, stages) amplitudes at the stages per forces there
    change: Real  # (2, 2, k)
    pushed: Real  # (stages, 2, k)

    @classmethod
    def of(cls, system: StretchedSystem, h: float) -> StretchedStep:
        """Return that of a length."""
        all_ = [system.modes.reached(h, float(theta)) for theta in nodes(STAGES)]
        own = np.array([one.pushed[:, 0] for one in all_]).transpose(2, 0, 1)
        ahead = np.array([one.change[0] for one in all_])
        return cls(system.forms, ahead, np.ascontiguousarray(own), all_[-1].change, all_[-1].pushed)

    def free(self, state: Real) -> Real:
        """Return the amplitudes at the stages without forces of this step, (stages, k)."""
        return np.asarray((self.ahead * state).sum(axis=1))

    def carry(self, state: Real, force: Real) -> Real:
        """Return (q, q') at the end."""
        return np.asarray((self.change * state).sum(axis=1) + (self.pushed * force[:, None]).sum(0))

    def solve(self, free: Real, force: Real, size: float) -> tuple[Real | None, float]:
        """Return the forces at the stages, (stages, k), or None, and what they are off by."""
        best = worst = np.inf
        inverse = None
        for _ in range(MOST):
            q = free + applied(self.own, force)
            bent = [q @ form.matrix for form in self.forms]
            taken = [f.stiffness / 2 * (q * b).sum(axis=1) for f, b in zip(self.forms, bent)]
            wanted = -sum(N[:, None] * b for N, b in zip(taken, bent))
            gap = wanted - force
            scale = max(size, float(np.abs(wanted).max()), np.finfo(float).tiny)
            worst = float(np.abs(gap).max()) / scale
            if not np.isfinite(worst):
                return None, worst
            if worst <= ENOUGH or (worst <= LEAST and worst >= best / 2):
                return force, worst
            if inverse is None or worst > best / 10:
                inverse = self._inverse(taken)
            best = min(best, worst)
            force = force + self._newton(gap, bent, inverse)
        return None, worst

    def _inverse(self, taken: list[Real]) -> Real:
        """Return (1 + N G_kk own)^-1 of each mode, (k, stages, stages)."""
        matrix = np.eye(STAGES) + sum(
            np.diag(f.matrix)[:, None, None] * N[:, None] * self.own
            for f, N in zip(self.forms, taken)
        )
        return np.asarray(np.linalg.inv(matrix), dtype=np.float64)

    def _newton(self, gap: Real, bent: list[Real], inverse: Real) -> Real:
        """Return the change of the forces, with the changes of N of all forms and stages."""
        plain = applied(inverse, gap)
        moved = applied(self.own, plain)
        both = self.own @ inverse
        right = np.concatenate([f.stiffness * (b * moved).sum(1) for f, b in zip(self.forms, bent)])
        left = np.block(
            [[f.stiffness * coupled(b, both, c) for c in bent] for f, b in zip(self.forms, bent)]
        )
        more = np.linalg.solve(np.eye(len(left)) + left, right).reshape(len(self.forms), -1)
        push = np.sum([N[:, None] * b for N, b in zip(more, bent)], axis=0)
        return np.asarray(plain - applied(inverse, push), dtype=np.float64)


def applied(matrix: Real, stages: Real) -> Real:
    """Return (k, i, j) matrices times (j, k) stages, (i, k)."""
    return np.asarray((matrix @ stages.T[:, :, None])[:, :, 0].T)


def coupled(one: Real, matrix: Real, other: Real) -> Real:
    """Return the sum over k of one_ik matrix_kij other_jk, (i, j)."""
    return np.asarray((one.T[:, :, None] * matrix * other.T[:, None]).sum(axis=0))
