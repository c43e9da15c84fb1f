"""The response of one component to harmonic forces, by each solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Real
from ..base.chebyshev import fitted
from ..base.errors import SceneError, SolveError
from ..base.threads import Errands
from ..chain.chain import Chain
from ..chain.compiled import EXACT, MOST_STEPS
from ..chain.port import Point, Ports, is_force, is_held, local, moving, ports
from ..chain.reaction import at_start, first_left_end, tellers
from ..scene import damping
from .bands import bands, between, is_many
from .closed import closed_lines
from .question import Bound, Question, angular
from .rounding import EPS, bound_of, bound_of_structures

NODES = 40  # Of a band: pieces end below 0.76 of their resonance, the error falls by 2.9 with each.
SAME, LOOKS = 1e-12, 8  # Of other rates are factors that differ by more at one of so many lines.
LATE, TOLD = slice(28, 32), 1e-12
"""These coefficients of pieces are below this of the largest: those left out are rounding."""
LANES = 16  # Frequencies that the sweep solves side by side.
SWEEP_SLICE, BAND_SLICE = 1 << 20, 1 << 16
"""Steps times frequencies of one call of the core: a look for Ctrl-C some times a second."""
BOUND_SLICE = 1 << 18  # Pairs of loads times stations times frequencies, likewise.


def _sweep(question: Question) -> tuple[Complex, Bound]:
    """Take what is certain in closed form, and walk along the chain for the other lines."""
    drives, responses = question.drives, question.responses
    found = closed_lines(question.lean[0], question.factor, drives, responses)
    if found is None:
        value = _walk(question)
    else:
        value, left = found.value[0], ~found.certain[0]
        if left.any():
            value[..., left] = _walk(question.at(np.flatnonzero(left)))
    return value, lambda: _bound(question, bound_of) + _last(question, value)


def _walk(question: Question) -> Complex:
    chain, _ = question.walked
    steps = _core.steps(chain, question.fastest)
    if steps > max(MOST_STEPS, chain.nodes):
        raise SolveError(
            f"frequency {float(question.frequency.max())!r} Hz is too high: the rope has {steps} "
            f"pieces shorter than its waves, at most {MOST_STEPS} are walked"
        )
    # pieces of strings are sooner solved than interpolated: 5.3 and 7.0 ms of 1000 lines
    if chain.rise is None or not chain.rise.any() or len(question.component) == 1:
        return _unassembled(question, partial(_core.sweep, chain), steps, SWEEP_SLICE)[0]
    shape = len(question.drives), len(question.responses), len(question.frequency)
    value = np.empty(shape, dtype=np.complex128)
    left = list(bands(question.frequency))
    while left:
        lines = left.pop()
        band = question.at(lines)
        known = _between(band)
        if known is None:
            left += np.array_split(lines, 2)
            continue
        # cut by its own waves
        chain, _ = band.walked
        steps = _core.steps(chain, band.fastest)
        value[..., lines] = _unassembled(
            band, partial(_core.sweep, chain), steps, SWEEP_SLICE, known=known
        )[0]
    return value


def _between(question: Question) -> Known | None:
    """Return nodes of increasing frequencies, what their pieces are, and their weights.

    Nothing where each is sooner solved by itself, and None where so many nodes do not tell them.
    """
    if not is_many(question.frequency):
        return ()
    nodes, weight = between(question.frequency, NODES)
    omega = angular(nodes, question.decay)
    factor = np.ascontiguousarray(damping.factors(question.model.scene.dampings, omega).T)
    some = slice(None, None, len(weight) // LOOKS)
    asked, told = question.factor[:, some], factor @ weight[some].T
    if (np.abs(told - asked) > SAME * np.abs(asked).max(axis=1, keepdims=True)).any():
        return ()  # rates that are no frequencies
    pieces = _core.sweep_between(question.walked[0], factor)
    size = np.abs(pieces.reshape(-1, 2 * NODES)).max(axis=1)
    late = fitted(NODES)[LATE] @ pieces.reshape(-1, NODES).T
    late = np.abs(late).max(axis=0).reshape(-1, 2).max(axis=1)
    return (factor, pieces, weight) if (late <= TOLD * size).all() else None


def _last(question: Question, value: Complex) -> Real:
    """Return what the last two roundings of a response may be."""
    return 2 * EPS * (np.abs(value) + np.abs(inside_elements(question)))


def _assembled(question: Question, error: Real) -> Bound:
    """Return the bound of an assembled solver, which leaves out what rounds in structures."""
    if question.walked[0].attached_kind is None:
        return lambda: error
    return lambda: error + _bound(question, bound_of_structures)


def _bound(question: Question, bounded: Callable[[Chain, Complex, Ports, Ports], Real]) -> Real:
    """Bound what rounding does to motion and internal forces, by their fields."""
    chain, _ = question.walked
    pushed, watched, reactions = _ports(question)
    loads = len(pushed.node) + len(watched.node)

    def solve(part: slice) -> tuple[Real]:
        factor = np.ascontiguousarray(question.factor[:, part])
        return (bounded(chain, factor, pushed, watched),)

    size, count = loads**2 * chain.first.size * len(question.component), len(question.frequency)
    (error,) = in_slices(solve, count, size, BOUND_SLICE, question.workers)
    if reactions:
        error = _reacting(question, error, sign=1.0)
    _hold(question, error)
    return error


def _band(question: Question) -> tuple[Complex, Bound]:
    chain, _ = question.walked
    value, error = _unassembled(
        question, partial(_core.mixed, chain), chain.nodes, BAND_SLICE, lanes=1
    )
    return value, _assembled(question, error)


def _ports(question: Question) -> tuple[Ports, Ports, bool]:
    """Return those of drives and of responses, and whether forces at the left end are told."""
    chain, x = question.walked
    component = question.component
    direct = [p for p in question.responses if not at_start(x, p)]
    reactions = len(direct) < len(question.responses)
    asked = direct + (tellers(component, x) if reactions else [])
    pushed = ports(chain, x, component, question.drives)
    watched = pushed if asked == question.drives else ports(chain, x, component, asked)
    return pushed, watched, reactions


Core = Callable[..., tuple[Complex, Real, int]]
"""What answers factors, drives and responses, beside what is known."""
Known = tuple[Complex, Real, Real] | tuple[()]


def _unassembled(
    question: Question, core: Core, steps: int, size: int, *, lanes: int = LANES, known: Known = ()
) -> tuple[Complex, Real]:
    """Ask the core for motion and internal forces, `size` steps times frequencies at a time."""
    factor = question.factor
    pushed, watched, reactions = _ports(question)

    def solve(part: slice) -> tuple[Complex, Real]:
        beside = ((*known[:2], known[2][part]),) if known else ()
        value, error, solved = core(np.ascontiguousarray(factor[:, part]), pushed, watched, *beside)
        if solved < value.shape[2]:
            raise question.resonance(part.start + solved)
        return value, error

    count = len(question.frequency)
    value, error = in_slices(solve, count, steps, size, question.workers, lanes=lanes)
    if reactions:
        value = _reacting(question, value, sign=-1.0)
        error = _reacting(question, error, sign=1.0)
    value.imag[..., ~question.is_damped] = 0.0  # only rounding is there
    _hold(question, value)
    _hold(question, error)
    value += inside_elements(question)
    return value, error


def in_slices(
    solve: Callable[[slice], Sequence[NDArray[Any]]],
    count: int,
    steps: int,
    most: int,
    workers: int,
    *,
    lanes: int = LANES,
) -> tuple[NDArray[Any], ...]:
    """Solve slices of the frequencies, several at a time; the bits do not depend on them."""
    # only the main thread sees Ctrl-C: what takes long by itself is solved there
    workers = 1 if steps > most else workers
    size = max(lanes, most // max(steps, 1) // lanes * lanes)
    if count * steps > most // 16:
        size = min(size, max(lanes, -(-count // workers // lanes) * lanes))
    parts = [slice(start, min(start + size, count)) for start in range(0, max(count, 1), size)]
    if workers == 1 or len(parts) == 1:
        found = [solve(part) for part in parts]
    else:
        found = _shared(solve, parts, workers)
    return tuple(np.concatenate(arrays, axis=-1) for arrays in zip(*found))


def _shared(
    solve: Callable[[slice], Sequence[NDArray[Any]]], parts: Sequence[slice], workers: int
) -> list[Sequence[NDArray[Any]]]:
    """Solve each part on one of several threads, which have few before them."""
    found: dict[int, Sequence[NDArray[Any]]] = {}
    todo = enumerate(parts)
    with Errands[int, Sequence[NDArray[Any]]](ThreadPoolExecutor(workers)) as sent:
        try:
            while len(found) < len(parts):
                for k, part in islice(todo, 2 * workers - len(sent)):
                    sent.send(k, solve, part)
                k, future = sent.receive()
                found[k] = future.result()
        finally:
            sent.executor.shutdown(cancel_futures=True)
    return [found[k] for k in range(len(parts))]


def _hold(question: Question, value: NDArray[Any]) -> None:
    """Set to 0 what is held, which rounding moves by its last digits."""
    chain, x = question.walked

    def stands(point: Point) -> bool:
        return not is_force(point) and is_held(chain, x, question.component, point)

    for k, point in enumerate(question.drives):
        if stands(point):
            value[k] = 0.0
    for k, point in enumerate(question.responses):
        if stands(point):
            value[:, k] = 0.0


def _reacting(question: Question, told: NDArray[Any], *, sign: float) -> NDArray[Any]:
    """Put f_a = E f_b - Q u_a + P u_b of the first element, or its size, where it was asked for."""
    component, responses = question.component, question.responses
    chain, x = question.walked
    w = len(component)
    of = first_left_end(chain, question.factor)
    E, Q, P = (of.E, of.Q, of.P) if sign < 0 else map(np.abs, (of.E, of.Q, of.P))
    given, left, right, force = np.split(np.arange(told.shape[1]), [-3 * w, -2 * w, -w])
    reaction = np.einsum("kij,djk->dik", E, told[:, force])
    reaction += sign * np.einsum("kij,djk->dik", Q, told[:, left])
    reaction += np.einsum("kij,djk->dik", P, told[:, right])
    found = np.zeros((len(told), len(responses), told.shape[2]), dtype=told.dtype)
    direct = iter(given)
    for k, point in enumerate(responses):
        if at_start(x, point):
            found[:, k] = reaction[:, component.index(moving(point))]
        else:
            found[:, k] = told[:, next(direct)]
    return found


def _lapack(question: Question) -> tuple[Complex, Bound]:
    if any(map(is_force, question.responses)):
        raise SceneError('solver must be "sweep" or "band" where an internal force is asked for')
    chain, x = question.walked
    value, rounding, motion, solved = _core.frf(
        chain,
        np.ascontiguousarray(question.factor.T),
        ports(chain, x, question.component, question.drives),
        ports(chain, x, question.component, question.responses),
    )
    if solved < len(question.frequency) or (motion >= 1).any():
        first = min([solved, *np.flatnonzero((motion[:solved] >= 1).any(axis=1))])
        more = f", or {chain.nodes - 1} elements are too many for the assembled stiffness"
        raise question.resonance(first, more)
    value = np.ascontiguousarray(value.transpose(1, 2, 0))
    error = np.ascontiguousarray(rounding.transpose(1, 2, 0))
    value += inside_elements(question)
    return value, _assembled(question, error)


def inside_elements(question: Question) -> Complex:
    """Return the flexibility inside driven elements that are not cut, as the response."""
    shape = len(question.drives), len(question.responses), len(question.frequency)
    value = np.zeros(shape, dtype=np.complex128)
    if question.model.element in EXACT:
        return value
    chain, x = question.walked
    bends = "beta" in question.component
    for d, pushed in enumerate(question.drives):
        which = damping.SECTION if bends or pushed[0] != "z" else damping.TENSION
        for r, watched in enumerate(question.responses):
            flexibility = local(chain, x, question.component, pushed, watched)
            if flexibility != 0:
                value[d, r] = flexibility / question.factor[which]
    return value


SOLVERS = {"sweep": _sweep, "band": _band, "lapack": _lapack}
"""What computes the response of one component, and what bounds its rounding when it is asked."""
