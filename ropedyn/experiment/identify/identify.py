"""Find numbers of a scene from measured peaks or a whole response."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Integer, Real
from ...base.computed import changed, waited
from ...base.errors import IdentifyWarning, SceneError, warn
from ...base.progress import Progress
from ...curves.measured import Measured, above_zero
from ...curves.peaks import Peaks
from ...curves.record.record import Record
from ...curves.resonance import Resonances
from ...family.rows import Shared
from ...response.question import workers_of
from ...scene.agree import in_space
from ...scene.bench.prior import Prior
from ...scene.path import with_values
from ...scene.scene import Scene
from ..compare.slips import slips
from ..fitting.misfit import PriorMisfit, Response
from ..fitting.natural import is_moved
from ..fitting.unknown import CALIBRATION, Unknowns
from ..orders.orders import given_orders
from .fit import Fit
from .fit_frf import fit_response
from .fit_peaks import Options
from .fits import Fits, each_alone, fits_of
from .found import by_peaks_alone, find
from .one_rope import RopeTask
from .peak_damping import OF_DAMPING
from .response_fit import ResponseFit
from .told import Told, by_posterior

ENDS = ("unknown", "given")
ROTATIONAL = re.compile(r"ends\[[01]\]\.spring\.beta")
# Peaks [Hz], their relative standard deviations and what is known beforehand relative to the guess
# are between these: squares of all that is between do not overflow.
SIZES = (1e-50, 1e50)


@overload
def identify(
    scene: Scene,
    measured: Measured,
    unknown: str | Sequence[str | tuple[str, ...]],
    *,
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
) -> ResponseFit: ...


@overload
def identify(
    scene: Scene,
    measured: Record | Peaks | Resonances | Sequence[Resonances] | ArrayLike,
    unknown: str | Sequence[str | tuple[str, ...]],
    *,
    orders: str | Sequence[int] | None = "auto",
    ends: str | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    model_std: float = 0.0,
    seed: int = 0,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fit: ...


@overload
def identify(
    scene: Scene,
    measured: Sequence[Record | Peaks | Measured],
    unknown: str | Sequence[str | tuple[str, ...]],
    *,
    orders: str | Sequence[int] | None = "auto",
    ends: str | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    model_std: float = 0.0,
    seed: int = 0,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fits: ...


@waited
def identify(
    scene: Scene,
    measured: Any,
    unknown: str | Sequence[str | tuple[str, ...]],
    *,
    orders: str | Sequence[int] | None = "auto",
    ends: str | None = None,
    prior: Mapping[str, tuple[float, float]] | None = None,
    model_std: float = 0.0,
    seed: int = 0,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fit | Fits | ResponseFit:
    """Find the numbers of a scene that make its answers those that were measured.

    Which modes peaks are is decided by evidence, and where the rope bends the rotational stiffness
    of its ends is taken to be unknown: both are in the interval and in `Fit.status`. With ends and
    orders given it is weighted least squares with exact derivatives, of natural frequencies or of a
    whole frequency response. Numbers keep the sign of their guess.

    Parameters
    ----------
    scene : Scene
        With what is known, and guesses of what is not; of peaks, a tension of 0 is no guess.
    measured : Record, Peaks, Resonances, array_like of shape (k,), a list of these, or Measured
        A recorded time series, whose peaks are found first. Or peaks [Hz]; their standard
        deviations are weights, without any the relative noise is taken to be the same for all and
        estimated from the residuals. A list has one for each of many ropes, which the scene
        describes alike; responses in it stand for their peaks. Or one whole response, which tells
        damping too, without its line at 0 Hz (for its peaks alone give `Peaks.of` it). Its noise is
        estimated from the residuals, for each point a part equal on all lines, or what measured
        coherence tells, and one in proportion to the amplitude.
    unknown : str or sequence of str or tuple of str
        Paths of what is sought, a tuple of several where they have one number, such as
        ``"tension"``, ``"bending_stiffness"``, ``"ends[0].spring.beta"``, ``"parts[0].mass"`` or
        ``"parts[0].x"``: what `Modes.derivative` takes. Numbers of damping, such as
        ``"damping.gamma"``, are told by the damping ratios of peaks or by a whole response; of that
        ``"calibration"`` is a real factor of either sign on all of it.
    orders : "auto", None or sequence of int, shape (k,)
        Which mode each peak is, from 1, and 0 where it is none. ``"auto"``: as the peaks say, and
        where they do not by evidence. None: by evidence in any case. Rigid motions are no modes
        here. Of a rope on an axis they are given, counted over both planes.
    ends : {"unknown", "given"}, optional
        Whether the rotational stiffness of both ends is unknown, from pinned to clamped, and in the
        intervals, or as the scene says. Unknown where left out if a straight rope bends and no such
        stiffness is sought. A whole response, and a rope on an axis, take them as given.
    prior : Prior or mapping from str to (float, float), optional
        What is known beforehand: value and std by path, also of what is not sought, whose
        uncertainty then is in the intervals.
    model_std : float
        Relative standard deviation of what the model itself is off, of each frequency.
    seed : int
        Of the random numbers of a posterior.
    elements, element
        As `Scene.compile` takes them: continuous spans where left out.
    threads : int, optional
        That share the ropes of a list; the environment variable ROPEDYN_THREADS or all cores where
        left out. What is found of a rope does not depend on it.
    executor : concurrent.futures.Executor, optional
        That shares them instead, as `sweep` takes it; ropes it lost have failed.
    progress : None, True or callable
        True prints the share of ropes that are done to stderr, a callable takes it.

    Returns
    -------
    Fit, Fits of a list, or ResponseFit of a whole response

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning, there is no such number in the scene, natural frequencies do not
        depend on it, or there are more unknown numbers than peaks and prior values.
    SolveError
        If the scene has fewer modes than the orders ask for, or the solution does not converge;
        of a list nothing is raised: `Fits.status` and `Fits.failure` name each rope without one.

    Warns
    -----
    IdentifyWarning
        If what was measured does not tell all numbers, as tension and linear density from peaks
        alone; it names what is told. If the fit is ambiguous or refused. And if a response differs
        from the model beyond noise.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(2.0, 0.5, bending_stiffness=1.0)
    >>> scene = rd.Scene(rope, tension=900.0, ends=("pinned", "pinned"))
    >>> peaks = rd.Peaks([11.21, 22.58, 34.29, 46.49], std=0.01)
    >>> fit = rd.identify(scene, peaks, ["tension", "bending_stiffness"], ends="given")
    >>> print(fit)
    identified
    unknown              value        std  95 % from       to  status
    -----------------  -------  ---------  ---------  -------  -------
    tension            999.615   0.867523    997.915  1001.32  trusted
    bending_stiffness  2.05243  0.0277407    1.99806   2.1068  trusted
    """
    check.instance(scene, "scene", Scene, "a Scene")
    whole = isinstance(measured, Measured)
    sought, calibrated = _calibrated(unknown, whole=whole)
    given = None if whole else _given(measured)
    if scene.is_spatial:
        _refuse_on_axis(scene, given, orders)
    elif given is not None and scene.planes == "both":
        raise SceneError('planes must be "z" of peaks, which do not say their plane, got "both"')
    sought, damping = _damped(sought, given)
    checked = Unknowns.of(_tensed(scene, 1.0), sought)
    taken = _ends(ends, scene, checked, whole=whole)
    known = _prior(prior, checked)
    how = Options(
        paths=checked.paths,
        damping=damping,
        orders=orders,
        ends=taken,
        numbers=len(checked.with_nuisances(known) if taken == ENDS[1] else checked),
        prior=known,
        model_std=check.number(model_std, "model_std", sign="nonnegative"),
        elements=elements,
        element=element,
        seed=check.count(seed, "seed", least=0, most=np.iinfo(np.int64).max),
    )
    if given is None:
        found = _response(scene, measured, how, scale=calibrated)
        _warn(found.notes)
        return found
    workers: dict[str, Any] = {"threads": threads, "executor": executor, "progress": progress}
    if isinstance(given, list):
        fits = _many(scene, how, given, workers)
        _warn(fits.notes)
        return fits
    Shared(np.zeros(0), workers_of(threads), executor, progress)  # which checks them
    _weigh(given)
    record = said_of(measured) if isinstance(measured, Record) else None
    fit = RopeTask(_guessed(scene, how, given), how, given, _teller(how), record).fit()
    _warn(fit.notes)
    return fit


def _refuse_on_axis(scene: Scene, given: Peaks | list[Peaks] | None, orders: Any) -> None:
    """Refuse what does not tell the numbers of a rope on an axis."""
    what = in_space(scene)
    if given is None:
        raise SceneError(
            f"measured must be peaks for {what}, such as Peaks.of(measured), got a whole response: "
            "derivatives of responses are not carried"
        )
    each = given if isinstance(given, list) else [given]
    if orders is None or (isinstance(orders, str) and any(one.order is None for one in each)):
        raise SceneError(
            f"orders must be given for {what}, counted over both planes, or be in the peaks: "
            f"evidence of them is that of one plane, got {check.shown(orders)}"
        )


def peaks_of_record(record: Record, below: float | None = None) -> Peaks:
    """Return its peaks, below a frequency [Hz], by its force where it has one."""
    if record.force is None:
        return record.peaks(below)
    if below is not None:
        raise SceneError(f"below must be None where a record has a force [Hz], got {below!r}")
    return Peaks.of(record.frf())


def said_of(record: Record) -> dict[str, Any]:
    """Return what a record says of itself, as JSON knows it."""
    return {
        "rate": record.rate,
        "duration": float(record.time[-1] - record.time[0]),
        "channels": list(record.labels),
        "quantity": record.quantity,
        "notes": list(record.notes),
    }


def _given(measured: Any) -> Peaks | list[Peaks]:
    """Return the peaks of a rope, or of each of several."""
    listed = isinstance(measured, (list, tuple))
    if listed and any(isinstance(one, (Peaks, Measured, Record)) for one in measured):
        return [_peaks(one, f"measured[{i}]") for i, one in enumerate(measured)]
    return _peaks(measured, "measured")


def _damped(unknown: Any, given: Peaks | list[Peaks] | None) -> tuple[Any, tuple[str, ...]]:
    """Part what the widths of peaks tell from what is sought by frequencies."""
    if isinstance(unknown, str) or not isinstance(unknown, (list, tuple)) or given is None:
        return unknown, ()
    each = given if isinstance(given, list) else [given]
    if any(one.damping_ratio is None for one in each):
        return unknown, ()
    damping = [path for path in unknown if isinstance(path, str) and OF_DAMPING.fullmatch(path)]
    return [path for path in unknown if path not in damping], tuple(damping)


def _calibrated(unknown: Any, *, whole: bool) -> tuple[Any, bool]:
    """Part the calibration from what is sought of the scene."""
    if not isinstance(unknown, (list, tuple, np.ndarray)) or CALIBRATION not in unknown:
        return unknown, False
    if not whole:
        raise SceneError(
            f"unknown must not have {CALIBRATION!r} of peaks, which have no amplitude, got "
            f"{check.shown(unknown)}"
        )
    return [path for path in unknown if path != CALIBRATION], True


def _ends(ends: Any, scene: Scene, unknowns: Unknowns, *, whole: bool) -> str:
    """Return whether the ends are unknown; they are where that is not said and acts."""
    sought = any(map(ROTATIONAL.fullmatch, unknowns.at_place))
    free = "beta" in scene.coordinates and not (sought or whole or scene.is_spatial)
    ends = (ENDS[0] if free else ENDS[1]) if ends is None else check.one_of(ends, "ends", ENDS)
    if ends == ENDS[0] and not free:
        why = "a whole response" if whole else "ends that are sought" if sought else "a string"
        why = in_space(scene) if scene.is_spatial else why
        raise SceneError(f'ends must be "given" of {why}, got "unknown"')
    if unknowns.tied and ends == ENDS[0]:
        raise SceneError('ends must be "given" where numbers are tied, got "unknown"')
    return str(ends)


def _many(
    scene: Scene, how: Options, measured: Sequence[Peaks], workers: Mapping[str, Any]
) -> Fits:
    """Identify ropes, side by side where only least squares are asked."""
    refused: dict[int, SceneError] = {}
    weighable = _all_weighable(measured)
    orders: list[Integer | None] = [None] * len(measured)
    said: dict[tuple[int, Any], Any] = {}
    for i, one in enumerate(measured):
        key = np.size(one.frequency), one.order
        try:
            if not weighable:
                _weigh(one)
            if key not in said:
                said[key] = given_orders(how.orders, one)
            orders[i] = said[key]
        except SceneError as error:
            refused[i] = error
            orders[i] = np.zeros(key[0], dtype=np.int64)
    numbered = [one for one in orders if one is not None]
    alike = how.ends == "given" and not how.damping and not is_moved(scene) and not scene.sags
    if alike and len(numbered) == len(measured):
        return fits_of(find(scene, how, measured, numbered, refused, **workers), measured)
    tasks = [RopeTask(_guessed(scene, how, one), how, one, _teller(how)) for one in measured]
    return each_alone(tasks, refused, **workers)


def _teller(how: Options) -> Callable[[Options, Peaks, Integer, Scene], Told]:
    """Return what tells the numbers of one rope by its peaks, their orders and a scene."""
    return by_peaks_alone if how.ends == ENDS[1] else by_posterior


def _response(scene: Scene, measured: Measured, how: Options, *, scale: bool) -> ResponseFit:
    """Identify one rope by a whole response."""
    if not isinstance(how.orders, str) or how.orders != "auto":
        raise SceneError(
            'orders must be "auto" of a whole response, got '
            f"{check.shown(how.orders)}: give its peaks to say which modes they are"
        )
    unknowns = Unknowns.of(scene, how.paths)
    _refuse_beside(how.prior, unknowns)
    if scale:
        unknowns = unknowns.with_calibration(1.0)
    response = Response(unknowns, above_zero(measured), how.elements, how.element)
    found = fit_response(response, PriorMisfit.of(unknowns, how.prior))
    slipped = () if scale else slips(measured, scene.compile())  # of a scale they would be one
    return changed(found, notes=(*found.notes, *slipped))


def _warn(notes: Sequence[str]) -> None:
    for note in notes:
        warn(note, IdentifyWarning)


# --- what was given ---------------------------------------------------------------------------


def _peaks(measured: Any, name: str) -> Peaks:
    """Return peaks from what they may be given as."""
    if isinstance(measured, Peaks):
        return measured
    if isinstance(measured, Record):
        return peaks_of_record(measured)
    many = isinstance(measured, (list, tuple)) and any(isinstance(m, Resonances) for m in measured)
    if many or isinstance(measured, (Measured, Resonances)):
        return Peaks.of(measured)
    return Peaks(check.numbers(measured, name, "Hz", sign="positive"))


def _within(values: Real, name: str, unit: str, scale: Real | float = 1.0) -> None:
    """Refuse values that are so far from a scale that sums of squares overflow."""
    least, most = SIZES
    bad = (values < least * scale) | (values > most * scale)
    if bad.any():
        at = int(np.flatnonzero(bad)[0])
        size = float(np.broadcast_to(scale, values.shape)[at])
        raise SceneError(
            f"{name}[{at}] must be between {least * size:g} and {most * size:g} [{unit}], "
            f"got {float(values[at])!r}"
        )


def _all_weighable(measured: Sequence[Peaks]) -> bool:
    """Say whether all peaks have squares that are numbers, and weights."""
    if not measured:
        return True
    least, most = SIZES
    given = [one.frequency if one.std is None else one.std for one in measured]
    frequency = np.concatenate([np.asarray(one.frequency) for one in measured])
    std = np.concatenate([np.asarray(one) for one in given])
    inside = (frequency >= least) & (frequency <= most)
    with np.errstate(over="ignore"):
        return bool((inside & (std >= least * frequency) & (std <= most * frequency)).all())


def _weigh(peaks: Peaks) -> None:
    """Refuse frequencies whose squares are no numbers, and standard deviations."""
    frequency = np.asarray(peaks.frequency, dtype=np.float64)
    _within(frequency, "measured", "Hz")
    if peaks.std is None:
        return
    std = np.asarray(peaks.std, dtype=np.float64)
    if (std == 0).any():
        at = int(np.flatnonzero(std == 0)[0])
        raise SceneError(
            f"measured.std[{at}] must be a finite number > 0 [Hz] to be a weight, got 0.0: leave "
            "std out where it is not known"
        )
    _within(std, "measured.std", "Hz", frequency)


def _prior(prior: Any, unknowns: Unknowns) -> Mapping[str, tuple[float, float]]:
    """Return what is known beforehand."""
    if prior is None:
        return {}
    if not isinstance(prior, Prior):
        check.instance(prior, "prior", Mapping, 'a mapping such as {"tension": (300.0, 15.0)}')
        prior = Prior(prior) if prior else {}
    paths = tuple(unknowns.at_place)
    for path, size in zip(paths, unknowns.at_places(np.abs(unknowns.start) + unknowns.scale)):
        value, std = prior.get(path, (size, size))
        if abs(value) > SIZES[1] * size or std < SIZES[0] * size:
            raise SceneError(
                f"prior[{path!r}] must be of at most {SIZES[1] * size:g} and have a std of at "
                f"least {SIZES[0] * size:g}, got {(value, std)}: the scene's guess is {size:g}"
            )
    return prior


def _refuse_beside(prior: Mapping[str, tuple[float, float]], unknowns: Unknowns) -> None:
    """Refuse what is known of numbers that a whole response is not asked for."""
    for path in prior:
        if path not in unknowns.at_place:
            raise SceneError(
                f"prior must be of what is unknown where a whole response is fitted, got {path!r}: "
                "let it be unknown too"
            )


def _guessed(scene: Scene, how: Options, peaks: Peaks) -> Scene:
    """Guess a tension that is sought and lacks one: of a string whose lowest peak is mode 1."""
    if "tension" not in how.paths:
        return scene
    wave = 2 * scene.rope.length * float(np.min(peaks.frequency))
    return _tensed(scene, scene.rope.linear_density * wave**2)


def _tensed(scene: Scene, tension: float) -> Scene:
    """Return a scene with this tension in place of none."""
    return with_values(scene, {"tension": tension}) if scene.mean_tension == 0 else scene
