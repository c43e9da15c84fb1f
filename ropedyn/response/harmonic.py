"""The response to harmonic forces, by each solver."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Flags, Real
from ..base.computed import computed
from ..base.errors import SceneError, SolveError
from ..base.unit import QUANTITIES
from ..chain import tip
from ..chain.chain import Chain
from ..chain.compiled import EXACT, MOST_STEPS, Compiled
from ..chain.place import observed, points
from ..chain.port import Point, Ports, cut, is_force, local, locate, moving, ports, stops
from ..chain.reaction import at_start, first_left_end, tellers
from ..eigen.mesh_error import mesh_of_frf
from ..scene import damping
from .frf import FRF, Mesh
from .modal_sum import Solver, Summed, modal_sum, refuse_other_damping
from .moved_end import moves_ends

if TYPE_CHECKING:
    from .frf_rate import FrequencyRates

LANES = 16
"""Frequencies that the sweep solves side by side."""

SWEEP_SLICE, BAND_SLICE = 1 << 20, 1 << 13
"""Steps times frequencies of one call of the core: a look for Ctrl-C every few milliseconds."""


@dataclass(frozen=True)
class Question:
    """What is asked of one component."""

    model: Compiled  # whose component it is
    component: tuple[str, ...]  # Coordinates
    frequency: Real  # (f,) [Hz]
    factor: Complex  # (5, f) on sections, tension, springs, inertia and dashpots
    drives: list[Point]  # on these coordinates
    responses: list[Point]  # on these coordinates
    workers: int  # Threads

    @property
    def is_damped(self) -> Flags:
        """Whether a factor of something that this component has is complex, shape (f,)."""
        chain = self.cut[0]
        bends, rods = "beta" in self.component, {"x", "alpha"} & set(self.component)
        has = {
            damping.SECTION: bends or bool(rods),
            damping.TENSION: "z" in self.component and self.model.scene.mean_tension != 0,
            damping.SPRING: bool(chain.stiffness.any()),
            damping.INERTIA: True,
            damping.DASHPOT: chain.damping is not None
            or chain.drag is not None
            or (chain.attached_value is not None and bool(chain.attached_value[:, -1].any())),
        }
        return (self.factor[[part for part in has if has[part]]].imag != 0).any(axis=0)

    @computed
    def cut(self) -> tuple[Chain, Real]:
        """The component's chain with nodes where points need them, and where they stand."""
        model, points = self.model, [*self.drives, *self.responses]
        chain = model.chain.only(self.component)
        between = [p for p in points if locate(model.x, p[1])[1] is not None]
        if model.element not in EXACT:
            for point in filter(is_force, between):
                raise SceneError(
                    "response of an internal force must stand at a node unless elements are "
                    f'"tensed", got {point} between nodes of {model.element!r} elements'
                )
            between = []
        positions = [p[1] for p in between]
        if model.element == "tensed":
            positions += stops(chain, model.x)
        if model.element == "continuous" and any(at_start(model.x, p) for p in self.responses):
            positions += self._short(chain)
        return cut(chain, model.x, positions)

    def _short(self, chain: Chain) -> list[float]:
        """Return where the first element is cut so that its left end is far from resonances."""
        first = chain.between(0, 1)
        pieces = _core.steps(first, self.fastest)
        return [float(self.model.x[1]) / pieces]

    @property
    def fastest(self) -> Complex:
        """The factors of the highest frequency, shape (5, 1), or none where there is none."""
        factor = self.factor
        highest = [np.argmax(np.abs(factor[damping.INERTIA]))] if factor.size else []
        return np.ascontiguousarray(factor[:, highest])

    def resonance(self, k: int) -> str:
        """Say that frequency k has no answer."""
        return (
            f"frequency {float(self.frequency[k])!r} Hz has no correct digit in "
            f"({', '.join(self.component)}): it lies on an undamped resonance"
        )


def solve_frf(
    model: Compiled,
    frequency: ArrayLike,
    *,
    drive: Any,
    response: Any,
    quantity: str = "receptance",
    solver: str = "sweep",
    threads: int | None = None,
) -> FRF:
    """Compute the frequency response; see `Model.frf`."""
    solve = moves_ends(SOLVERS[check.one_of(solver, "solver", SOLVERS)])
    if model.element == "continuous" and solver != "sweep":
        raise SceneError(f'solver must be "sweep" for continuous spans, got {solver!r}')
    workers = _workers(threads)
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = points(model, drive, "drive", forces=False, ends=True)
    responses = observed(model, response, drives)
    asked = tip.spread(model, responses)
    factor = np.ascontiguousarray(damping.factors(model.scene.dampings, 2 * np.pi * f).T)
    is_modal = bool(damping.having(model.scene.dampings, "ratio"))
    if is_modal:
        refuse_other_damping(model, drives, responses)
    start = time.perf_counter()
    whole = Question(model, model.coordinates, f, factor, list(drives), asked, workers)
    got = _by_components(whole, partial(modal_sum if is_modal else _line_by_line, solver=solve))
    value, error, truncation = got.value, got.error, got.truncation
    if any(map(tip.is_tip, responses)):
        _, truncation = tip.gather(model, responses, factor, value, truncation)
        value, error = tip.gather(model, responses, factor, value, error)
    _refuse_overflow(f, value, error)
    seconds = time.perf_counter() - start
    if QUANTITIES[quantity] > 0:
        value *= (2j * np.pi * f) ** QUANTITIES[quantity]
    if not several:
        value, error, truncation = value[0], error[0], truncation[0]
    mesh: Mesh | Callable[[], Mesh]
    mesh = partial(mesh_of_frf, model.scene, f, drives, responses, quantity=quantity, value=value)
    if model.element == "continuous":
        mesh = Mesh(truncation)
    return FRF(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=value,
        rounding_error=error,
        cost=Cost(
            seconds,
            solver,
            len(model.x) - 1,
            got.unknowns,
            sweeps=2 * got.lines if solver == "sweep" else 0,
            factorisations=0 if solver == "sweep" else got.lines,
        ),
        mesh=mesh,
        solve_rates=partial(_rates, model, f, drives, responses),
    )


def _rates(
    model: Compiled, frequency: Real, drives: tuple[Point, ...], responses: tuple[Point, ...]
) -> FrequencyRates:
    from .frf_rate import FrequencyRates

    return FrequencyRates(model, frequency, drives, responses)


class Receptance(NamedTuple):
    """Motion and internal forces per unit force, of all components."""

    value: Complex
    """(drives, responses, f)."""
    error: Real
    """Estimated relative error of rounding, as value."""
    truncation: Real
    """Bound of the relative error that modes cause which are left out, as value."""
    unknowns: int
    """Of the components that take part."""
    lines: int
    """That were solved."""


def _by_components(whole: Question, answer: Callable[[Question], Summed]) -> Receptance:
    """Ask each component for what it has of the drives and responses; nothing else moves."""
    model, drives, responses = whole.model, whole.drives, whole.responses
    value = np.zeros((len(drives), len(responses), len(whole.frequency)), dtype=np.complex128)
    error, truncation = np.zeros(value.shape), np.zeros(value.shape)
    unknowns, lines = 0, 0
    for component, free in zip(model.components, model.unknowns):
        d = [k for k, point in enumerate(drives) if moving(point) in component]
        r = [k for k, point in enumerate(responses) if moving(point) in component]
        if not d or not r:
            continue
        block = np.ix_(d, r)
        pushed, watched = [drives[k] for k in d], [responses[k] for k in r]
        got = answer(replace(whole, component=component, drives=pushed, responses=watched))
        value[block], error[block], truncation[block] = got.value, got.rounding, got.truncation
        unknowns += free
        lines += got.lines
    return Receptance(value, error, truncation, unknowns, lines)


def _line_by_line(question: Question, solver: Solver) -> Summed:
    """Solve at each frequency, with the damping that acts at it."""
    value, error = solver(question)
    return Summed(value, error, np.zeros(error.shape), len(question.frequency))


def _workers(threads: int | None) -> int:
    if threads is not None:
        return check.count(threads, "threads", most=1024)
    text = os.environ.get("ROPEDYN_THREADS", "")
    if not text:
        return os.cpu_count() or 1
    if not text.isdecimal():
        raise SceneError(f"ROPEDYN_THREADS must be a whole number from 1 to 1024, got {text!r}")
    return check.count(int(text), "ROPEDYN_THREADS", most=1024)


def _refuse_overflow(frequency: Real, value: Complex, error: Real) -> None:
    bad = ~np.isfinite(value).all(axis=(0, 1)) | np.isnan(error).any(axis=(0, 1))
    if bad.any():
        first = float(frequency[bad][0])
        raise SolveError(f"the numbers overflow at the frequency {first!r} Hz: check the units")


def _relative(value: Complex, error: Real) -> Real:
    """Return the relative error: 0 where both are 0, infinite where only the value is.

    Below the smallest normal number digits vanish however small the error is.
    """
    size = np.abs(value)
    ratio = np.full(size.shape, np.inf)
    np.divide(error + np.finfo(float).tiny, size, out=ratio, where=size > 0)
    return np.where((size == 0) & (error == 0), 0.0, ratio)


# --- the chain as it is: nothing assembled ----------------------------------------------------


def _sweep(question: Question) -> tuple[Complex, Real]:
    chain, _ = question.cut
    steps = _core.steps(chain, question.fastest)
    if steps > max(MOST_STEPS, chain.nodes):
        raise SolveError(
            f"frequency {float(question.frequency.max())!r} Hz is too high: the rope has {steps} "
            f"pieces shorter than its waves, at most {MOST_STEPS} are walked"
        )
    return _unassembled(question, partial(_core.sweep, chain), steps, SWEEP_SLICE)


def _band(question: Question) -> tuple[Complex, Real]:
    chain, _ = question.cut
    return _unassembled(question, partial(_core.mixed, chain), chain.nodes, BAND_SLICE)


Core = Callable[[Complex, Ports, Ports], tuple[Complex, Real, int]]


def _unassembled(question: Question, core: Core, steps: int, size: int) -> tuple[Complex, Real]:
    """Ask the core for motion and internal forces, `size` steps times frequencies at a time."""
    component, factor = question.component, question.factor
    chain, x = question.cut
    direct = [p for p in question.responses if not at_start(x, p)]
    reactions = len(direct) < len(question.responses)
    pushed = ports(chain, x, component, question.drives)
    asked = direct + (tellers(component, x) if reactions else [])
    watched = pushed if asked == question.drives else ports(chain, x, component, asked)

    def solve(part: slice) -> tuple[Complex, Real]:
        value, error, solved = core(np.ascontiguousarray(factor[:, part]), pushed, watched)
        if solved < value.shape[2]:
            raise SolveError(question.resonance(part.start + solved))
        return value, error

    count = len(question.frequency)
    value, error = _in_slices(solve, count, steps, size, question.workers)
    if reactions:
        value, error = _with_reactions(question, value, error)
    value.imag[..., ~question.is_damped] = 0.0  # only rounding is there
    _hold(question, value, error)
    _add_local(question, value)
    return value, _relative(value, error)


def _in_slices(
    solve: Callable[[slice], tuple[Complex, Real]], count: int, steps: int, most: int, workers: int
) -> tuple[Complex, Real]:
    """Solve slices of the frequencies, several at a time; the bits do not depend on them."""
    size = max(LANES, most // max(steps, 1) // LANES * LANES)
    if count * steps > most // 16:
        size = min(size, max(LANES, -(-count // workers // LANES) * LANES))
    parts = [slice(start, min(start + size, count)) for start in range(0, count, size)]
    if workers == 1 or len(parts) == 1:
        values, errors = zip(*(solve(part) for part in parts))
    else:
        executor = ThreadPoolExecutor(workers)
        try:
            values, errors = zip(*executor.map(solve, parts))
        finally:
            executor.shutdown(cancel_futures=True)
    return np.concatenate(values, axis=2), np.concatenate(errors, axis=2)


def _hold(question: Question, value: Complex, error: Real) -> None:
    """Set to 0 what is held, which rounding moves by its last digits."""
    chain, x = question.cut

    def is_held(point: Point) -> bool:
        node, between = locate(x, point[1])
        at = question.component.index(moving(point))
        held = between is None and not is_force(point)
        return held and bool(chain.held[chain.term[chain.stretch(node)], at])

    for k, point in enumerate(question.drives):
        if is_held(point):
            value[k] = error[k] = 0.0
    for k, point in enumerate(question.responses):
        if is_held(point):
            value[:, k] = error[:, k] = 0.0


def _with_reactions(question: Question, value: Complex, error: Real) -> tuple[Complex, Real]:
    """Put f_a = E f_b - Q u_a + P u_b of the first element where it was asked for."""
    component, responses = question.component, question.responses
    chain, x = question.cut
    w = len(component)
    of = first_left_end(chain, question.factor)
    given, left, right, force = np.split(np.arange(value.shape[1]), [-3 * w, -2 * w, -w])
    reaction = np.einsum("kij,djk->dik", of.E, value[:, force])
    reaction -= np.einsum("kij,djk->dik", of.Q, value[:, left])
    reaction += np.einsum("kij,djk->dik", of.P, value[:, right])
    spread = np.einsum("kij,djk->dik", np.abs(of.E), error[:, force])
    spread += np.einsum("kij,djk->dik", np.abs(of.Q), error[:, left])
    spread += np.einsum("kij,djk->dik", np.abs(of.P), error[:, right])
    shape = (value.shape[0], len(responses), value.shape[2])
    values, errors = np.zeros(shape, dtype=np.complex128), np.zeros(shape)
    direct = iter(given)
    for k, point in enumerate(responses):
        if at_start(x, point):
            at = component.index(moving(point))
            values[:, k], errors[:, k] = reaction[:, at], spread[:, at]
        else:
            at = next(direct)
            values[:, k], errors[:, k] = value[:, at], error[:, at]
    return values, errors


# --- the assembled system ---------------------------------------------------------------------


def _lapack(question: Question) -> tuple[Complex, Real]:
    if any(map(is_force, question.responses)):
        raise SceneError('solver must be "sweep" or "band" where an internal force is asked for')
    chain, x = question.cut
    value, rounding, motion, solved = _core.frf(
        chain,
        np.ascontiguousarray(question.factor.T),
        ports(chain, x, question.component, question.drives),
        ports(chain, x, question.component, question.responses),
    )
    if solved < len(question.frequency) or (motion >= 1).any():
        first = min([solved, *np.flatnonzero((motion[:solved] >= 1).any(axis=1))])
        raise SolveError(
            f"{question.resonance(first)}, or {chain.nodes - 1} elements are too many for the "
            "assembled stiffness"
        )
    value = np.ascontiguousarray(value.transpose(1, 2, 0))
    _add_local(question, value)
    return value, np.ascontiguousarray(rounding.transpose(1, 2, 0))


def _add_local(question: Question, value: Complex) -> None:
    """Add the flexibility inside a driven element that is not cut."""
    if question.model.element in EXACT:
        return
    chain, x = question.cut
    bends = "beta" in question.component
    for d, pushed in enumerate(question.drives):
        which = damping.SECTION if bends or pushed[0] != "z" else damping.TENSION
        for r, watched in enumerate(question.responses):
            flexibility = local(chain, x, question.component, pushed, watched)
            if flexibility != 0:
                value[d, r] += flexibility / question.factor[which]


SOLVERS = {"sweep": _sweep, "band": _band, "lapack": _lapack}
"""What computes the response of one component: value and relative error, (drives, responses, f)."""
