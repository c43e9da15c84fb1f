"""Natural frequencies of the components of a model, by each solver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from ..base import check
from ..base.answer import Work
from ..base.array import Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.chain import CHANNELS, CONTINUOUS, TENSED, Chain
from ..chain.compiled import MOST_STEPS, Compiled, least_of, once, part_of
from ..signal.contour import TOLD
from .closed import closed_count, closed_eigenvalues

LARGEST_DENSE = 8_000
"""Unknowns above which the dense matrix of the assembled solver, 8 n^2 bytes, is refused."""
STEP = 1.2
RATES = STEP ** np.arange(-100.0, 300.0)
"""Rates of lumps of negative inertia are told apart so far [1/s]."""
HIGHEST = 1e100
"""Eigenvalues are counted up to this [rad^2/s^2], so that their products do not overflow."""

TIE = 1e-9
"""Eigenvalues of two components that differ by less of themselves come in the order of these."""


@dataclass(frozen=True, eq=False)
class ComponentModes:
    """Modes of one component, lowest first."""

    eigenvalue: Real  # (k,) [rad^2/s^2]
    error: Real  # (k,) [rad^2/s^2]
    # (k, nodes, width) over the component's coordinates, None where it was not asked for
    shape: Real | None
    certified: bool  # whether none is missing
    work: Work  # what it took
    # (k, attached) of the structures that nodes carry, as y in csrc/chain/attached.h [m]
    motion: Real | None = None


def spectrum(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float = math.inf
) -> tuple[Real, Real]:
    """Return the lowest eigenvalues of one component and their errors [rad^2/s^2]."""
    if number is None:
        refuse_short_waves(model, limit)

    def swept() -> tuple[Real, Real]:
        found = _sweep(model, component, number, limit, shaped=False)
        return merged([found], number)[:2]

    return once(model, ("spectrum", component, number, limit), swept)


def eigenvalue_of(below: Any) -> float:
    """Return the squared angular frequency of a limit in Hz, checked."""
    highest = min(check.number(below, "below", "Hz", sign="positive"), check.HIGHEST)
    return (2 * math.pi * highest) ** 2


def count_modes(model: Compiled, below: float) -> int:
    """Count the natural frequencies below a limit; see `Model.count`."""
    limit = eigenvalue_of(below)
    refuse_short_waves(model, limit)
    return sum(count_component(model, c, limit) for c in model.components)


def count_component(model: Compiled, component: tuple[str, ...], limit: float) -> int:
    """Count the eigenvalues of one component below a limit [rad^2/s^2]."""
    return 0 if limit < least_of(model, component) else _count(part_of(model, component), limit)


def numbers_below(chain: Chain, eigenvalue: Real) -> Real:
    """Count the eigenvalues of a component below each of many, NaN where waves are too short."""
    return _core.count(chain, np.minimum(eigenvalue, HIGHEST))


def slowest_lump(model: Compiled, component: tuple[str, ...]) -> float:
    """Bound from below how fast lumps of negative inertia move [1/s]; infinite where none is."""
    chain = part_of(model, component)
    if not chain.spurious:
        return math.inf
    least = float(spectrum(model, component, 1)[0][0])
    # below -rate^2 lie true motions that grow faster, and lumps that are slower
    rate = RATES[math.sqrt(max(-least, 0.0)) < RATES]
    slower = numbers_below(chain, -(rate**2)) > 0
    return math.inf if not slower.any() else float(rate[slower.argmax()]) / STEP


def _count(chain: Chain, limit: float) -> int:
    """Count the eigenvalues of a component below a limit."""
    limit = min(limit, HIGHEST)
    found = closed_count(chain, limit)
    if found is not None:
        return found
    count = float(numbers_below(chain, np.array([limit]))[0])
    if math.isnan(count):
        raise SolveError("the waves at the limit are too short to be counted")
    return int(count)


def apart(eigenvalue: Real, places: Index | int) -> Real:
    """Return eigenvalues moved by so many ties, as components that come later are."""
    return eigenvalue + TIE * places * np.abs(eigenvalue)


def parted(eigenvalue: Real, error: Real, most: int) -> tuple[Real, Real, float]:
    """Return at most so many of the lowest, their errors and the next, which is one with none."""
    one = np.diff(eigenvalue) <= TOLD * (error[1:] + error[:-1])
    while 0 < most < len(eigenvalue) and one[most - 1]:
        most -= 1
    beyond = float(eigenvalue[most]) if len(eigenvalue) > most else math.inf
    return eigenvalue[:most], error[:most], beyond


def merged(
    found: Sequence[ComponentModes], number: int | None, which: Index | None = None
) -> tuple[Real, Real, Index]:
    """Return eigenvalues and errors of all components, and their order: by size, or as before.

    Those that are one come in the order of components.
    """
    eigenvalue = np.concatenate([part.eigenvalue for part in found])
    error = np.concatenate([part.error for part in found])
    # what rounding cannot tell from 0 is rigid-body motion
    eigenvalue = np.where(np.abs(eigenvalue) <= error, 0.0, eigenvalue)
    own = np.repeat(np.arange(len(found)), [len(part.eigenvalue) for part in found])
    order = np.argsort(apart(eigenvalue, own), kind="stable")
    if which is not None:  # the components that modes have had, however close they are
        order = _in_turn([len(part.eigenvalue) for part in found], which, order)
    order = order[:number]
    return eigenvalue[order], error[order], order


def _in_turn(counts: Sequence[int], which: Index, order: Index) -> Index:
    """Return an order of modes that begins with those of these components, the lowest of each."""
    rank = np.zeros_like(which)
    for k in range(len(counts)):
        rank[which == k] = np.arange(np.count_nonzero(which == k))
    if (rank >= np.take(counts, which)).any():
        return order  # one that a limit parts
    own = np.repeat(np.arange(len(counts)), counts)[order]
    rising = order[np.argsort(own, kind="stable")]  # the modes of each component, one after another
    first = rising[(np.cumsum(counts) - counts)[which] + rank]
    return np.concatenate([first, order[~np.isin(order, first)]])


def refuse_short_waves(model: Compiled, eigenvalue: float) -> None:
    """Refuse to count more half waves than can be walked."""
    if model.element != "continuous":
        return
    for component in model.components:
        steps = pieces_of(part_of(model, component), min(eigenvalue, HIGHEST))
        if steps > MOST_STEPS:
            raise SolveError(
                f"below is too high: ({', '.join(component)}) has {steps} pieces shorter than its "
                f"waves there, at most {MOST_STEPS} are walked"
            )


def pieces_of(chain: Chain, eigenvalue: float) -> int:
    """Return how many pieces shorter than its waves a component is walked in."""
    factor = np.array([[1.0], [1.0], [1.0], [-eigenvalue], [0.0]], dtype=np.complex128)
    return int(_core.steps(chain, factor))


def _sweep(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float, *, shaped: bool
) -> ComponentModes:
    """Solve each span between nodes that nothing moves for itself."""
    chain = model.chain.undamped.only(component) if shaped else part_of(model, component)
    found = []
    for first, last in chain.spans:
        try:
            found.append(lowest(chain.between(first, last), number, limit, shaped=shaped))
        except SolveError as refusal:
            raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    if len(found) == 1:
        return found[0]
    eigenvalue, error, order = merged(found, number)
    shape = motion = None
    if shaped:
        motion = np.concatenate([part.motion for part in found if part.motion is not None])[order]
        parts = []
        for part, (first, last) in zip(found, chain.spans):
            assert part.shape is not None
            parts.append(np.zeros((len(part.shape), chain.nodes, part.shape.shape[2])))
            parts[-1][:, first : last + 1] = part.shape
        shape = np.concatenate(parts)[order]
    certified = all(part.certified for part in found)
    work = Work.of(part.work for part in found)
    return ComponentModes(eigenvalue, error, shape, certified, work, motion)


def lowest(chain: Chain, number: int | None, limit: float, *, shaped: bool) -> ComponentModes:
    """Find the lowest modes of a chain between ends that nothing moves, or all below a limit."""
    if not shaped and (found := closed_eigenvalues(chain, number, limit)):
        return ComponentModes(*found, None, True, Work())
    wanted = _count(chain, limit) if number is None else number
    wanted = wanted if chain.finite is None else min(wanted, chain.finite)
    # beyond all that is counted there is no limit
    eigenvalue, error, certified, shape, motion, most, sweeps, redone = _core.certify(
        chain, wanted, limit if limit < HIGHEST else math.inf, shaped
    )
    if chain.kind in (CONTINUOUS, TENSED):
        loss = 16 * (chain.section_loss - 1)
        if chain.kind == TENSED:
            # half of the digits, 55 times the root at most: the inverse of what a section gives
            loss = 128 * (math.sqrt(chain.section_loss) - 1)
        with np.errstate(invalid="ignore"):  # infinite ones are refused below, or not asked for
            error += np.finfo(float).eps * loss * np.abs(eigenvalue)
    if not np.isfinite(eigenvalue[:most]).all() or not np.isfinite(error[:most]).all():
        raise SolveError("the numbers of the modes overflow: check the units")
    return ComponentModes(
        eigenvalue[:most],
        error[:most],
        shape[:most] if shaped else None,
        bool((certified[:most] == 1).all()),
        Work(sweeps, redone=redone),
        motion[:most] if shaped else None,
    )


def _lapack(
    model: Compiled, component: tuple[str, ...], number: int | None, limit: float, *, shaped: bool
) -> ComponentModes:
    chain = model.chain.undamped.only(component)
    if chain.carried:
        kinds = " or ".join(chain.carried)
        raise SceneError(
            f'solver must be "sweep" where parts have a {kinds}, got "lapack": its matrix problem '
            "is linear"
        )
    if chain.free > LARGEST_DENSE:
        raise SolveError(
            f"({', '.join(component)}) has {chain.free} unknowns: solver 'lapack' needs a dense "
            f"matrix of that size and takes at most {LARGEST_DENSE}; use fewer elements"
        )
    try:
        (eigenvalue, error, shape), _ = _core.modes(
            chain, number or 0, 0.0 if number else limit, _scale(model, component)
        )
    except SolveError as refusal:
        raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    lost = ~np.isfinite(error) | ~np.isfinite(eigenvalue)
    if lost.any():
        raise SolveError(
            f"mode {int(lost.argmax()) + 1} of ({', '.join(component)}) has no correct digit: the "
            "inertias or stiffnesses differ too much for the assembled solver"
        )
    return ComponentModes(eigenvalue, error, shape, False, Work(factorisations=1))


def _scale(model: Compiled, component: tuple[str, ...]) -> float:
    """Return the order of the first elastic eigenvalue: half a wave over the rope."""
    rope, chain = model.scene.rope, model.chain
    with np.errstate(over="ignore"):
        wave = float(np.square(np.pi / rope.length))
    inertia = chain.mass[chain.term_of].sum(axis=0).diagonal() / rope.length
    share = np.bincount(chain.element, np.diff(chain.first), len(chain.length)) * chain.length
    soft = np.tensordot(share / share.sum(), chain.flexibility, 1).diagonal()
    with np.errstate(divide="ignore", over="ignore"):
        own = np.divide(1.0, soft)
    elastic = np.where(np.isfinite(own), own, 0.0)
    stiffness = {c: float(elastic[CHANNELS[c]]) for c in model.coordinates}
    pull = abs(model.scene.mean_tension)
    stiffness |= {c: stiffness[c] * wave + pull for c in ("y", "z") if c in stiffness}
    orders = [
        stiffness[c] * wave / inertia[k]
        for k, c in enumerate(model.coordinates)
        if c in component and inertia[k] > 0 and stiffness[c] > 0
    ]
    return float(np.clip(min(orders, default=1.0), 1e-200, 1e200))


SOLVERS = {"sweep": _sweep, "lapack": _lapack}  # What finds the lowest modes of one component.


def in_hertz(eigenvalue: Real) -> Real:
    """Return frequencies, and -growth/2 pi where motion grows [Hz]."""
    return np.copysign(np.sqrt(np.abs(eigenvalue)), eigenvalue) / (2 * np.pi)


def error_in_hertz(eigenvalue: Real, error: Real) -> Real:
    """Return the largest change of frequency or growth while the eigenvalue changes by its error.

    sqrt(a + e) - sqrt(a) = e/(sqrt(a + e) + sqrt(a)), so that no digit is lost.
    """
    size = np.abs(eigenvalue)
    # below zero frequency 0 is as far as a mode can go; a growth rate begins there
    most = np.minimum(error, size)
    sum_ = np.sqrt(size) + np.sqrt(size - most)
    change = np.divide(most, sum_, out=np.zeros_like(size), where=sum_ > 0)
    wide = error > size
    change[wide] = np.sqrt(size + error)[wide]
    return change / (2 * math.pi)


def distance(eigenvalue: Real, true: Real, uncertain: Real) -> Real:
    """Return how far frequencies are from true ones, and how uncertain those are [Hz]."""
    return np.abs(in_hertz(eigenvalue) - in_hertz(true)) + error_in_hertz(true, uncertain)
