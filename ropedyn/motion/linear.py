"""Motion of a linear model: by its modes where they tell it, else by the line."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from ..base.answer import Cost
from ..base.array import Real
from ..base.errors import SceneError, SolveError
from ..base.progress import silent
from ..chain.port import moving
from ..chain.tip import carrier
from ..eigen.damped.proportional import proportional
from ..eigen.damped.rates import Rates
from ..eigen.vectors import within
from ..response.deflection import POINTS
from ..response.modal_sum import beside_ratios
from ..scene import damping
from .coupled.energy import of_chain
from .history import Balance, History
from .line.inversion import invert
from .line.still import is_still
from .modal.energy_balance import balance, tells_energy
from .modal.expansion import refuse_losses
from .modal.superposition import apart, estimated, fastest, superpose
from .moved import Moved, against_spans
from .request import TOLERANCE, Run

Told = TypeVar("Told")

MORE, MOST = 4, 1600  # So many times more modes are summed next, and so many at most.
LOOSER = (TOLERANCE, 0.1, 2.0)  # That the motion of continuous spans keeps to, if it can.
SHAPED = 64  # Modes that the places of a shape resolve.
UNTOLD = (
    ". Rounding does so much: a larger tolerance or a shorter time help, and one damping ratio for "
    "modes that lie too close together to tell which is which"
)


def solve_linear(run: Run) -> History:
    """Return the motion of a linear model within the tolerance; see `Model.transient`."""
    moved = within_tolerance(run)
    x, snapshot = snapshots_of(run)
    kept, model = run.kept, run.model
    mesh_error: Real | Callable[[], Real] = partial(mesh_error_of, kept, moved.value)
    if model.element == "continuous":
        mesh_error = np.zeros(moved.value.shape)
    return History(
        **kept.told,
        value=moved.value,
        x=x,
        snapshot=snapshot,
        cost=Cost(moved.method, len(model.x) - 1, moved.modes, sweeps=2 * moved.lines),
        error=moved.error,
        mesh_error=mesh_error,
        balance=partial(_balance, kept),
    )


def _balance(run: Run) -> Balance:
    """Return the energies, of modes where damping does not couple them."""
    return balance(run, fastest(run)) if tells_energy(run) else of_chain(run, within_tolerance)


def within_tolerance(run: Run) -> Moved:
    """Return the motion within the tolerance, or raise."""
    if run.coarse is None:
        return _by_methods(run)
    is_modal = run.modes is None and _methods(run)[0] == "modal"
    moved = _shaped(run, run.coarse) if is_modal else _shaped_by_line(run, run.coarse)
    tolerance = _tolerance(run)
    share = moved.shares(run)
    if (share > tolerance).any():
        raise SolveError(
            f"start and velocity are known to {share.max():.1e} of the largest value, with "
            f"{len(run.loads) + len(run.kicks)} places along the rope, not to {tolerance:g}"
        )
    return moved


def nearest(run: Run, tolerance: float) -> Moved:
    """Return the motion within the tolerance, or the nearest to it that a method finds."""
    methods = ["modal"] if _has_ratios(run) else [*dict.fromkeys(("line", _methods(run)[0]))]
    found: list[Moved] = []
    for _, moved in _tried(run, methods, tolerance):
        if isinstance(moved, SolveError):
            refused = moved
        elif (moved.shares(run) <= tolerance).all():
            return moved
        else:
            found.append(moved)
    if not found:
        raise refused
    return min(found, key=lambda moved: float(np.nan_to_num(moved.shares(run), nan=np.inf).max()))


def _tried(
    run: Run, methods: list[str], tolerance: float
) -> Iterator[tuple[str, Moved | SolveError]]:
    """Return what each method finds, or why it refuses."""
    for method in methods:
        try:
            found: Moved | SolveError = METHOD[method](run, tolerance)
        except SolveError as refusal:
            found = refusal
        yield method, found


def _shaped(run: Run, coarse: Run) -> Moved:
    """Return the motion from shapes and velocities, by modes that their places resolve."""
    coarser = coarse if coarse.coarse is None else coarse.coarse
    still: dict[str, Any] = {"drives": (), "forces": ()}
    each = [
        superpose(replace(one, **still, modes=SHAPED >> k))
        for k, one in enumerate((run, coarse, coarser))
    ]
    # shapes between places are of second order in their distance
    better, worse = (
        one._replace(value=one.value + (one.value - less.value) / 3) for one, less in pairwise(each)
    )
    moved = better._replace(error=apart(better, [worse]))
    if not run.drives:
        return moved
    driven = _by_methods(replace(run, loads={}, kicks={}, coarse=None))
    value, error = moved.value + driven.value, moved.error + driven.error
    return driven._replace(value=value, error=error)


def _shaped_by_line(run: Run, coarse: Run) -> Moved:
    """Return the motion from shapes and velocities where damping couples modes."""
    moved = _by_methods(run)
    other = _by_methods(replace(coarse, tolerance=None))
    return moved._replace(error=moved.error + np.abs(moved.value - other.value))


def _by_methods(run: Run) -> Moved:
    """Return the motion by the first method whose error is within the tolerance, or raise."""
    tolerance = _tolerance(run)
    refused, advice = list[str](), ""
    for method, moved in _tried(run, _methods(run), tolerance):
        if isinstance(moved, SolveError):
            refused.append(f"{method}: {moved}")
            continue
        advice = ". A larger tolerance, more times or a smoother force help"
        share = moved.shares(run)
        late = np.flatnonzero(~(share <= tolerance))
        if all(is_still(run, int(r)) for r in late):
            return moved
        rounded = moved._replace(error=np.broadcast_to(moved.rounding, moved.value.shape))
        if not (rounded.shares(run) <= tolerance).all():
            advice = UNTOLD
        worst = int(np.nan_to_num(share, nan=np.inf).argmax())
        how = f"{moved.modes} modes" if method == "modal" else f"the line at {moved.lines} rates"
        refused.append(f"{how}: up to {share[worst]:.1e} of it for {run.responses[worst]}")
    raise SolveError(
        f"the motion is not known to {tolerance:g} of its largest value. Error by "
        f"{'; by '.join(refused)}{advice}"
    )


def _summed(run: Run, tolerance: float) -> Moved:
    """Return the sum over modes, over more of them while its error exceeds the tolerance."""
    moved, count = superpose(run), run.modes
    is_modal = _has_ratios(run)
    while run.modes is None and not (moved.shares(run) <= tolerance).all():
        if is_modal:
            # modes with ratios of their own have no transfer function that the line could take
            moved = estimated(run, moved)
        count = MORE * (moved.modes if count is None else count)
        if count > MOST or (moved.shares(run) <= tolerance).all():
            break
        more = superpose(replace(run, modes=count))
        if more.modes <= moved.modes:
            break
        moved = more
    return moved


METHOD: dict[str, Callable[[Run, float], Moved]]
METHOD = {"modal": _summed, "line": invert}


def _tolerance(run: Run) -> float:
    """Return the tolerance; of modes whose number is given the error is said, however large."""
    if run.tolerance is not None:
        return run.tolerance
    return TOLERANCE if run.modes is None else math.inf


def _methods(run: Run) -> list[str]:
    """Return the methods that take the model, in turn."""
    refuse_losses(run.model)
    is_modal = _has_ratios(run)
    if run.method == "line":
        if is_modal:
            raise SceneError('method must be "modal" or "auto" where damping is modal, got "line"')
        return ["line"]
    if is_modal or is_proportional(run):
        return ["modal", "line"][: 2 if run.method == "auto" and not (is_modal or run.modes) else 1]
    if run.method == "modal" or run.modes:
        raise SceneError(
            'method must be "line" or "auto", without modes, where damping is not proportional, '
            f'got "{run.method}"'
        )
    return ["line"]


def _has_ratios(run: Run) -> bool:
    """Whether modes have damping ratios of their own."""
    return bool(damping.having(run.model.scene.dampings, "ratio"))


def resists_beside_ratios(run: Run) -> bool:
    """Whether modes that have damping ratios of their own are damped otherwise too."""
    is_open = run.method == "auto" and run.modes is None
    return is_open and _has_ratios(run) and bool(beside_ratios(run.model))


def is_proportional(run: Run) -> bool:
    """Whether modes without damping are not coupled in any component that takes part."""
    model, rates = run.model, Rates.of(run.model.scene.dampings)
    driven, watched = {moving(p) for p in run.places}, {carrier(model, p) for p in run.responses}
    taking = [c for c in model.components if driven & set(c) and watched & set(c)]
    return all(proportional(model.chain.only(c), rates) is not None for c in taking)


def snapshots_of(run: Run) -> tuple[Real, Real]:
    """Return where the rope is looked at, and its motion, (s, nodes, coordinates)."""
    model = run.model
    x = within(model.x, POINTS) if model.element == "continuous" else model.x
    width = len(model.coordinates)
    if len(run.snapshots) == 0:
        return x, np.zeros((0, len(x), width))
    points = tuple((c, float(at)) for at in x for c in model.coordinates)
    time = np.unique(np.concatenate([run.time[[0, -1]], run.snapshots]))
    looks = replace(run, time=time, responses=points, order=0, together=True, progress=silent)
    kept = within_tolerance(looks).value[:, np.searchsorted(time, run.snapshots)]
    return x, np.ascontiguousarray(kept.T).reshape(-1, len(x), width)


def mesh_error_of(run: Run, value: Real) -> Real:
    """Return the distance to the motion of continuous spans and the error of that, as value."""
    solve = partial(loosely, within_tolerance)
    return against_spans(replace(run, modes=None, method="auto"), value, solve)


def loosely(solve: Callable[[Run], Told], run: Run) -> Told:
    """Return the motion within the first of some tolerances that it keeps to."""
    for tolerance in LOOSER:
        try:
            return solve(replace(run, tolerance=tolerance))
        except SolveError as refusal:
            refused = refusal
    raise refused
