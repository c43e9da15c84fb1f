"""Find numbers of a scene from measured peaks."""

from __future__ import annotations

import dataclasses
import time
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import check
from .answer import Cost
from .calculated import Calculated
from .errors import IdentifyWarning, SceneError
from .fit import Fit
from .guess import start_of
from .misfit import Known, PeakMisfit
from .notes import notes_of
from .peaks import Peaks
from .resonance import Resonances
from .scene import Scene
from .solution import Solution, solve
from .tension import Tension
from .unknown import Unknowns

Real = NDArray[np.float64]
Orders = NDArray[np.intp]


def identify(
    scene: Scene,
    measured: Peaks | Resonances | ArrayLike,
    unknown: str | Sequence[str],
    *,
    orders: str | Sequence[int] | None = "auto",
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
) -> Fit:
    """Find the numbers of a scene that make its natural frequencies those that were measured.

    Weighted least squares with exact derivatives. Numbers keep the sign of their guess in the
    scene; the guess may be wrong by powers of ten.

    Parameters
    ----------
    scene : Scene
        With what is known, and guesses of what is not; a tension of 0 is no guess.
    measured : Peaks, Resonances or array_like of shape (k,)
        Peaks [Hz]. Their standard deviations are weights; without any the relative noise is taken
        to be the same for all and estimated from the residuals.
    unknown : str or sequence of str
        Paths of what is sought, such as ``"tension"``, ``"bending_stiffness"``,
        ``"ends[0].spring.beta"``, ``"parts[0].mass"`` or ``"parts[0].x"``: what `Modes.derivative`
        takes.
    orders : "auto" or sequence of int, shape (k,)
        Which mode each peak is, from 1, and 0 where it is none. ``"auto"``: as the peaks say, and
        where they do not the lowest modes in their order.
    prior : mapping from str to (float, float), optional
        What is known of unknown numbers beforehand: value and standard deviation by path.
    elements, element
        As `Scene.compile` takes them: continuous spans where left out.

    Returns
    -------
    Fit

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning, there is no such number in the scene, natural frequencies do not
        depend on it, or there are more unknown numbers than peaks and prior values.
    SolveError
        If the scene has fewer modes than the orders ask for, or the solution does not converge.

    Warns
    -----
    IdentifyWarning
        If the peaks do not tell all numbers: tension and linear density from peaks alone, say. The
        warning names what they do tell.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(2.0, 0.5, bending_stiffness=1.0)
    >>> scene = rd.Scene(rope, tension=100.0, ends=("pinned", "pinned"))
    >>> peaks = rd.Peaks([11.21, 22.58, 34.29, 46.49], std=0.01)
    >>> fit = rd.identify(scene, peaks, ["tension", "bending_stiffness"])
    >>> print(fit)
    identified
    unknown              value        std
    -----------------  -------  ---------
    tension            999.615   0.867523
    bending_stiffness  2.05243  0.0277407
    """
    check.instance(scene, "scene", Scene, "a Scene")
    started = time.perf_counter()
    peaks = _peaks(measured)
    frequency = np.asarray(peaks.frequency, dtype=np.float64)
    chosen = _orders(orders, peaks)
    unknowns = Unknowns.of(_guessed(scene, unknown, frequency, chosen), unknown)
    known = _known(unknowns, prior)
    _refuse_few(unknowns, chosen, known)
    std = _weights(peaks)
    weight = frequency if std is None else std
    misfit = PeakMisfit(Calculated(unknowns, elements, element), frequency, weight, chosen)
    start = start_of(misfit, np.zeros(len(unknowns)))
    _refuse_unseen(misfit, start, known)
    noise = None if std is None else 1.0
    solution = solve(unknowns, misfit, start, rows=len(frequency), known=known, noise=noise)
    notes = notes_of(solution)
    for note in notes:
        warnings.warn(note, IdentifyWarning, stacklevel=2)
    return _fit(solution, misfit, notes, time.perf_counter() - started)


def _fit(solution: Solution, misfit: PeakMisfit, notes: tuple[str, ...], seconds: float) -> Fit:
    minimum, used = solution.minimum, misfit.orders > 0
    off = minimum.residual[: solution.rows]
    calculated = np.where(used, misfit.measured + off * misfit.weight, np.nan)
    chi_square = float(np.sum((off / solution.noise) ** 2))
    cost = Cost(
        seconds=seconds,
        method="least squares",
        elements=misfit.calculated.elements or 0,
        unknowns=len(solution.unknowns),
        factorisations=minimum.evaluations,
    )
    return Fit(
        unknown=solution.unknowns.paths,
        value=solution.value,  # type: ignore[arg-type]
        std=solution.std,  # type: ignore[arg-type]
        correlation=solution.uncertainty.correlation,
        orders=misfit.orders.astype(np.int64),
        measured=misfit.measured,
        measured_std=solution.noise * misfit.weight,
        calculated=calculated,
        freedom=solution.freedom,
        chi_square=chi_square,
        notes=notes,
        cost=cost,
        solution=solution,
    )


# --- what was given ---------------------------------------------------------------------------


def _peaks(measured: Any) -> Peaks:
    """Return peaks from what they may be given as."""
    if isinstance(measured, Peaks):
        return measured
    if isinstance(measured, Resonances):
        return Peaks(measured.frequency)
    frequency = check.numbers(measured, "measured", "Hz", sign="positive")
    return Peaks(frequency)


def _weights(peaks: Peaks) -> Real | None:
    """Return the standard deviations, if there are any."""
    if peaks.std is None:
        return None
    std = np.asarray(peaks.std, dtype=np.float64)
    if (std == 0).any():
        at = int(np.flatnonzero(std == 0)[0])
        raise SceneError(
            f"measured.std[{at}] must be a finite number > 0 [Hz] to be a weight, got 0.0: leave "
            "std out where it is not known"
        )
    return std


def _orders(orders: Any, peaks: Peaks) -> Orders:
    """Return the mode of each peak, from 1; 0 where it is none."""
    frequency = np.asarray(peaks.frequency)
    if isinstance(orders, str):
        check.one_of(orders, "orders", ("auto",))
        if peaks.order is not None:
            return np.array(peaks.order, dtype=np.intp)
        return np.argsort(np.argsort(frequency, kind="stable")) + 1
    k = len(frequency)
    what = f"{k} whole numbers, one for each peak, those from 1 different"
    check.instance(orders, "orders", (list, tuple, np.ndarray), what)
    most = np.iinfo(np.int32).max
    given = [check.count(n, f"orders[{i}]", least=0, most=most) for i, n in enumerate(orders)]
    modes = [n for n in given if n > 0]
    if len(given) != k or len(set(modes)) < len(modes) or not modes:
        raise SceneError(f"orders must be {what}, got {check.shown(orders)}")
    return np.array(given, dtype=np.intp)


def _known(unknowns: Unknowns, prior: Any) -> Known | None:
    """Return what is known of the unknowns beforehand, if anything is."""
    if prior is None:
        return None
    what = 'a mapping such as {"bending_stiffness": (value, std)}'
    check.instance(prior, "prior", Mapping, what)
    at, value, std = [], [], []
    for path, given in prior.items():
        check.one_of(path, "key of prior", unknowns.paths)
        check.instance(given, f"prior[{path!r}]", (tuple, list), "(value, std)")
        if len(given) != 2:
            raise SceneError(f"prior[{path!r}] must be (value, std), got {check.shown(given)}")
        at.append(unknowns.paths.index(path))
        value.append(check.number(given[0], f"prior[{path!r}][0]"))
        std.append(check.number(given[1], f"prior[{path!r}][1]", sign="positive"))
    if not at:
        return None
    return Known(unknowns, np.array(at, dtype=np.intp), np.array(value), np.array(std))


def _refuse_few(unknowns: Unknowns, orders: Orders, known: Known | None) -> None:
    peaks, others = int((orders > 0).sum()), 0 if known is None else len(known.at)
    if peaks + others < len(unknowns):
        raise SceneError(
            f"measured must have at least {len(unknowns) - others} peaks for {len(unknowns)} "
            f"unknown and {others} prior values, got {peaks}"
        )


def _refuse_unseen(misfit: PeakMisfit, u: Real, known: Known | None) -> None:
    """Refuse numbers that no peak depends on, unless they are known beforehand."""
    unseen = np.asarray(~misfit(u)[1].any(axis=0))
    if known is not None:
        unseen[known.at] = False
    for i in np.flatnonzero(unseen):
        raise SceneError(
            f"unknown[{i}] must change the natural frequencies of these peaks, got "
            f"{misfit.calculated.unknowns.paths[i]!r}, which does not"
        )


def _guessed(scene: Scene, unknown: Any, frequency: Real, orders: Orders) -> Scene:
    """Return the scene with the tension of a string in place of none."""
    wanted = [unknown] if isinstance(unknown, str) else unknown
    if scene.mean_tension != 0 or not isinstance(wanted, (list, tuple)) or "tension" not in wanted:
        return scene
    rope = scene.rope
    wave = 2 * rope.length * frequency[orders > 0] / orders[orders > 0]
    tension = rope.linear_density * float(wave.min()) ** 2
    if isinstance(scene.tension, Tension):
        return scene.replace(tension=dataclasses.replace(scene.tension, mean=tension))
    return scene.replace(tension=tension)
