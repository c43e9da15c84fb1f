"""The response of a model to harmonic forces, and how far it is from that without elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Flags, Real
from ..base.computed import Late, computed
from ..base.errors import SceneError, SolveError
from ..base.unit import QUANTITIES
from ..chain import tip
from ..chain.compile import compile_scene
from ..chain.compiled import Compiled
from ..chain.place import observed, points
from ..chain.port import Point, moving
from ..chain.wide import of_steep
from ..scene import damping
from ..scene.scene import Scene
from .at_node import answers_at_nodes
from .frf import FRF, MeshOfResponse, RoundingOfResponse
from .frf_rate import Answered, FrequencyRates
from .measured import measured, surely
from .modal_sum import Summed, modal_sum, refuse_other_damping
from .moved_end import gathered, moves_ends
from .question import Bound, Question, Solver, angular, workers_of
from .rounding import relative
from .solvers import SOLVERS


def solve_harmonic(
    model: Compiled,
    frequency: ArrayLike,
    *,
    drive: Any,
    response: Any = None,
    quantity: str = "receptance",
    solver: str = "sweep",
    threads: int | None = None,
    decay: float = 0.0,
    tight: bool = True,
) -> FRF:
    """Compute the frequency response; see `Model.frf`. Its rounding is bounded unless `tight`."""
    solve = _solver(check.one_of(solver, "solver", SOLVERS))
    if model.element == "continuous" and solver != "sweep":
        raise SceneError(f'solver must be "sweep" for continuous spans, got {solver!r}')
    workers = workers_of(threads)
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = points(model, drive, "drive", forces=False, ends=True)
    responses = observed(model, response, drives)
    asked = tip.spread(model, responses)
    decay = check.number(decay, "decay", "1/s", sign="nonnegative")
    factor = damping.factors(model.scene.dampings, angular(f, decay)).T
    is_modal = bool(damping.having(model.scene.dampings, "ratio"))
    if is_modal:
        refuse_other_damping(model, drives, responses)
    whole = Question(model, model.coordinates, f, factor, list(drives), asked, workers, decay)
    got = by_components(whole, partial(modal_sum if is_modal else line_by_line, solver=solve))
    found = _Found(whole, responses, quantity, slice(None) if several else 0, got)
    _refuse_overflow(f, found.gathered)
    return FRF(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=found.value,
        cost=Cost(
            solver,
            len(model.x) - 1,
            got.unknowns,
            sweeps=2 * got.lines if solver == "sweep" else 0,
            factorisations=0 if solver == "sweep" else got.lines,
        ),
        mesh=found.mesh(),
        rounding=Late(partial(found.rounding, solver if tight else None)),
        rounding_bound=Late(found.bound),
        solve_rates=partial(
            FrequencyRates, model, found.omega, drives, responses, got.answered, got.value
        ),
        decay=decay,
    )


@dataclass(frozen=True, eq=False)
class _Found:
    """What all components answered, and the quantity that is told of it."""

    whole: Question
    responses: tuple[Point, ...]
    quantity: str
    drive: slice | int  # all of them, or the only one
    got: Receptance

    @computed
    def omega(self) -> Real | Complex:
        """Angular frequencies, with what decays [rad/s]."""
        return angular(self.whole.frequency, self.whole.decay)

    @computed
    def gathered(self) -> Complex:
        """Motion and forces of tips too, (drives, responses, f)."""
        whole = self.whole
        return tip.gather(whole.model, self.responses, whole.factor, self.got.value)

    @computed
    def value(self) -> Complex:
        """The quantity."""
        power = QUANTITIES[self.quantity]
        value = self.gathered * (1j * self.omega) ** power if power else self.gathered
        return np.asarray(value[self.drive])

    def of_value(self, solved: Complex, error: Real) -> Real:
        """Return errors of the quantity from those of what was solved for."""
        whole, power = self.whole, (1j * self.omega) ** QUANTITIES[self.quantity]
        found = tip.gather_error(whole.model, self.responses, whole.factor, solved, error)
        return np.asarray(found[self.drive] * np.abs(power))

    def bound(self) -> Real:
        """Bound its rounding, relative."""
        return relative(self.value, self.of_value(self.got.value, self.got.bound()))

    def rounding(self, solver: str | None) -> RoundingOfResponse:
        """Measure the rounding of a solver, or bound it."""
        got = self.got
        if solver is None:
            error, certain = got.bound(), np.zeros(got.value.shape, bool)
        else:
            error, certain = got.error(solver)
        certain = tip.gather_flags(self.whole.model, self.responses, certain)
        wrong = self.of_value(got.value, error)
        return RoundingOfResponse.of(self.value, wrong, certain[self.drive])

    def mesh(self) -> MeshOfResponse | Callable[[], MeshOfResponse]:
        """Return how far it is from the response without elements, or what tells it."""
        whole, got = self.whole, self.got
        if whole.model.element == "continuous":
            return MeshOfResponse(
                relative(self.value, self.of_value(0 * got.value, got.truncation))
            )
        asked = whole.model.scene, whole.frequency, tuple(whole.drives), self.responses
        return partial(
            mesh_of_frf, *asked, quantity=self.quantity, value=self.value, decay=whole.decay
        )


class Receptance(NamedTuple):
    """Motion and internal forces per unit force, of all components."""

    value: Complex  # (drives, responses, f)
    bounds: list[tuple[Any, Bound]]  # of rounding, of blocks of the value
    truncation: Real  # bound of the error that modes cause which are left out, as value
    unknowns: int  # of the components that take part
    lines: int  # that were solved
    answered: list[Answered]

    def bound(self) -> Real:
        """Bound what rounding does, as value."""
        return gathered(self.value.shape, self.bounds)

    def error(self, solver: str) -> tuple[Real, Flags]:
        """Measure what rounding did, as value, or bound it; and where it was measured."""
        error, certain = np.zeros(self.value.shape), np.ones(self.value.shape, dtype=np.bool_)
        for (block, bound), answered in zip(self.bounds, self.answered):
            question, found, limit = answered.question, None, bound()
            if answered.parts is None:
                found = measured(question, self.value[block])
                limit = limit + _lost(question, self.value[block], solver)
            if found is None:
                error[block], certain[block] = limit, False
                continue
            error[block], certain[block] = surely(found.error, found.noise, limit, solver=solver)
        return error, certain


def _solver(name: str) -> Solver:
    """Return a solver that takes forces at nodes of modes and ends that move too."""
    return answers_at_nodes(moves_ends(SOLVERS[name]))


def _lost(question: Question, value: Complex, solver: str) -> Real:
    """Return what rounding of a tension that falls much does to a response."""
    solve = _solver(solver)
    return of_steep(question.model, value, lambda one: solve(replace(question, model=one))[0])


def by_components(whole: Question, answer: Callable[[Question], Summed]) -> Receptance:
    """Ask each component for what it has of the drives and responses; nothing else moves."""
    model, drives, responses = whole.model, whole.drives, whole.responses
    value = np.zeros((len(drives), len(responses), len(whole.frequency)), dtype=np.complex128)
    truncation, unknowns, lines = np.zeros(value.shape), 0, 0
    answered: list[Answered] = []
    bounds: list[tuple[Any, Bound]] = []
    for component, free in zip(model.components, model.unknowns):
        d = [k for k, point in enumerate(drives) if moving(point) in component]
        r = [k for k, point in enumerate(responses) if moving(point) in component]
        if not d or not r:
            continue
        block = (np.array(d)[:, None], r)
        pushed, watched = [drives[k] for k in d], [responses[k] for k in r]
        question = replace(whole, component=component, drives=pushed, responses=watched)
        got = answer(question)
        answered.append(Answered(question, got.parts))
        value[block], truncation[block] = got.value, got.truncation
        bounds.append((block, got.rounding))
        unknowns += free
        lines += got.lines
    return Receptance(value, bounds, truncation, unknowns, lines, answered)


def line_by_line(question: Question, solver: Solver) -> Summed:
    """Solve at each frequency, with the damping that acts at it."""
    value, bound = solver(question)
    return Summed(value, bound, np.zeros(value.shape), len(question.frequency))


def _refuse_overflow(frequency: Real, value: Complex) -> None:
    wrong = ~np.isfinite(value)
    if wrong.any():
        bad = wrong.any(axis=(0, 1))
        first = float(frequency[bad][0])
        raise SolveError(f"the numbers overflow at the frequency {first!r} Hz: check the units")


def mesh_of_frf(
    scene: Scene,
    frequency: Real,
    drives: tuple[Point, ...],
    responses: tuple[Point, ...],
    *,
    quantity: str,
    value: Complex,
    decay: float = 0.0,
) -> MeshOfResponse:
    """Compare the response of a chain with that of continuous spans."""
    try:
        ask = partial(solve_harmonic, compile_scene(scene), drive=drives, response=responses)
        ask = partial(ask, quantity=quantity, decay=decay, tight=False)
        true, uncertain = _response(ask, frequency, (len(drives), len(responses)))
    except SceneError:
        return MeshOfResponse(np.full(value.shape, np.inf))
    true, uncertain = true.reshape(value.shape), uncertain.reshape(value.shape)
    size, known = np.abs(value), np.isfinite(true)
    rounding = np.where(known, uncertain, 0.0)
    relative = np.full(value.shape, np.inf)
    with np.errstate(over="ignore"):  # a value of denormal size
        np.divide(np.abs(value - true) + rounding, size, out=relative, where=known & (size > 0))
    return MeshOfResponse(np.where(known & (size == 0) & (true == 0), 0.0, relative))


def _response(
    ask: Callable[[Real], FRF], frequency: Real, pairs: tuple[int, int]
) -> tuple[Complex, Real]:
    """Return value and its error, (drives, responses, f); NaN where there is no answer."""
    # one frequency without an answer refuses all: halves are asked until it is alone
    try:
        answer = ask(frequency)
        # a sum over modes has an error beside rounding, continuous spans or not
        beside = np.where(answer.value == 0, 0.0, answer.mesh_error) * np.abs(answer.value)
        return answer.value, answer.rounding_limit + beside
    except SolveError:
        shape = (*pairs, len(frequency))
        if len(frequency) == 1:
            return np.full(shape, np.nan, dtype=np.complex128), np.full(shape, np.nan)
    half = len(frequency) // 2
    parts = [_response(ask, part, pairs) for part in (frequency[:half], frequency[half:])]
    value, error = zip(*parts)
    return np.concatenate(value, axis=2), np.concatenate(error, axis=2)
