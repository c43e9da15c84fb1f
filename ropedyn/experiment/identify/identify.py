"""Find numbers of a scene from measured peaks or a whole response."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Flags, Real
from ...base.errors import IdentifyWarning, SceneError
from ...base.progress import Progress
from ...curves.measured import Measured, above_zero
from ...curves.peaks import Peaks
from ...curves.resonance import Resonances
from ...scene.path import with_values
from ...scene.prior import Prior
from ...scene.scene import Scene
from ..fitting.misfit import PriorMisfit, Response
from ..fitting.unknown import Unknowns
from ..orders.orders import given_orders, lowest_orders
from .fit import Fit
from .fit_frf import fit_response
from .fit_peaks import Options, Ropes, kind_of_ropes
from .fits import Fits, fits_of
from .found import find
from .response_fit import ResponseFit

MOST = 64  # A search lets at most so many modes be missing, and so many peaks be none.
# Peaks [Hz], their relative standard deviations and what is known beforehand relative to the guess
# are between these: squares of all that is between do not overflow.
SIZES = (1e-50, 1e50)


@overload
def identify(
    scene: Scene,
    measured: Measured,
    unknown: str | Sequence[str],
    *,
    scale: bool = False,
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
) -> ResponseFit: ...


@overload
def identify(
    scene: Scene,
    measured: Peaks | Resonances | Sequence[Resonances] | ArrayLike,
    unknown: str | Sequence[str],
    *,
    orders: str | Sequence[int] | None = "auto",
    missing: int | None = None,
    spurious: int = 1,
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fit: ...


@overload
def identify(
    scene: Scene,
    measured: Sequence[Peaks | Measured],
    unknown: str | Sequence[str],
    *,
    orders: str | Sequence[int] | None = "auto",
    missing: int | None = None,
    spurious: int = 1,
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fits: ...


def identify(
    scene: Scene,
    measured: Any,
    unknown: str | Sequence[str],
    *,
    orders: str | Sequence[int] | None = "auto",
    missing: int | None = None,
    spurious: int = 1,
    scale: bool = False,
    prior: Mapping[str, tuple[float, float]] | None = None,
    elements: int | None = None,
    element: str | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Fit | Fits | ResponseFit:
    """Find the numbers of a scene that make its answers those that were measured.

    Weighted least squares with exact derivatives, of natural frequencies or of a whole frequency
    response. Numbers keep the sign of their guess, which may be wrong by powers of ten.

    Parameters
    ----------
    scene : Scene
        With what is known, and guesses of what is not; of peaks, a tension of 0 is no guess.
    measured : Peaks, Resonances, array_like of shape (k,), a list of Peaks, or Measured
        Peaks [Hz]. Their standard deviations are weights; without any the relative noise is taken
        to be the same for all and estimated from the residuals. A list has one for each of many
        ropes, which the scene describes alike; responses in it stand for their peaks. Or one whole
        response, which tells damping too, without its line at 0 Hz (for its peaks alone give
        `Peaks.of` it). Its noise is estimated from the residuals, for each point a part equal on
        all lines, or what measured coherence tells, and one in proportion to the amplitude.
    unknown : str or sequence of str
        Paths of what is sought, such as ``"tension"``, ``"bending_stiffness"``,
        ``"ends[0].spring.beta"``, ``"parts[0].mass"`` or ``"parts[0].x"``: what `Modes.derivative`
        takes, and of a whole response `FRF.derivative`, such as ``"damping.gamma"``.
    orders : "auto", None or sequence of int, shape (k,)
        Which mode each peak is, from 1, and 0 where it is none. ``"auto"``: as the peaks say, and
        where they do not the lowest modes, if these explain the peaks as well as their noise lets
        them; else they are searched. None: they are searched in any case. A search moves all but
        positions by a factor of 30, about their guesses and about what the lowest modes tell.
    missing : int, optional
        Of a search: at most so many modes below the highest peak are not among the peaks, as many
        as there are peaks but no more than 32 where left out.
    spurious : int
        Of a search: at most so many peaks are no modes.
    scale : bool
        Whether the calibration of a whole response is unknown too, a real factor of either sign.
    prior : Prior or mapping from str to (float, float), optional
        What is known beforehand: value and std by path; more than what is sought in a `Prior` only.
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
        alone; it names what is told. And if a response differs from the model beyond noise.

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
    check.instance(scale, "scale", bool, "True or False")
    checked = Unknowns.of(_tensed(scene, 1.0), unknown)
    how = Options(
        paths=checked.paths,
        orders=orders,
        missing=None if missing is None else check.count(missing, "missing", least=0, most=MOST),
        spurious=check.count(spurious, "spurious", least=0, most=MOST),
        prior=_prior(prior, checked),
        elements=elements,
        element=element,
    )
    if isinstance(measured, Measured):
        whole = _response(scene, measured, how, scale=scale)
        _warn(whole.notes)
        return whole
    if scale:
        raise SceneError("scale must be False of peaks, which have no amplitude, got True")
    workers: dict[str, Any] = {"threads": threads, "executor": executor, "progress": progress}
    listed = isinstance(measured, (list, tuple))
    if listed and any(isinstance(one, (Peaks, Measured)) for one in measured):
        given = [_peaks(one, f"measured[{i}]") for i, one in enumerate(measured)]
        fits = fits_of(find(scene, how, *_ropes(given, how), **workers))
        _warn(fits.notes)
        return fits
    ropes = _ropes([_peaks(measured, "measured")], how)
    found = find(scene, how, *ropes, **workers)
    fit = found.fit(0)
    if fit is None:
        raise found.error(0)
    _warn(fit.notes)
    return fit


def _ropes(measured: Sequence[Peaks], how: Options) -> tuple[Ropes, dict[int, tuple[str, str]]]:
    """Return what was measured as rows, and why some of them are refused."""
    count = np.array([np.size(one.frequency) for one in measured], dtype=np.int64)
    known = np.array([one.std is not None for one in measured])
    inside = np.arange(count.max(initial=1)) < count[:, None]
    frequency = _filled(inside, [one.frequency for one in measured], 1.0)
    std = _filled(inside & known[:, None], [one.std for one in measured], 0.0)
    weight = np.where(inside & known[:, None], std, frequency)
    ropes = np.zeros(len(measured), kind_of_ropes(inside.shape[1], len(how.paths)))
    orders = lowest_orders(np.where(inside, frequency, np.inf))
    ropes["orders"], ropes["searched"] = np.where(inside, orders, 0), True
    refused: dict[int, SceneError] = {}
    for i in np.flatnonzero(~_weighable(frequency, weight).all(axis=1)).tolist():
        try:
            _weigh(measured[i])
        except SceneError as error:
            refused[i] = error
    alike: dict[tuple[int, Any], list[int]] = {}
    for i, (k, peaks) in enumerate(zip(count.tolist(), measured)):
        alike.setdefault((k, peaks.order), []).append(i)
    for (k, _), some in alike.items():
        try:
            said = given_orders(how.orders, measured[some[0]])
        except SceneError as error:
            refused = dict.fromkeys(some, error) | refused
        else:
            if said is not None:
                ropes["orders"][some, :k], ropes["searched"][some] = said, False
    ropes["peaks"], ropes["measured"], ropes["weight"] = count, frequency, weight
    ropes["noise"], ropes["runner_up"] = np.where(known, 1.0, np.nan), None
    for i in refused:
        # none of its peaks is one, so that nothing overflows
        ropes["measured"][i], ropes["weight"][i], ropes["orders"][i] = 1.0, 1.0, 0
        ropes["searched"][i] = False
    return ropes, {i: ("SceneError", str(error)) for i, error in refused.items()}


def _filled(where: Flags, rows: Sequence[Any], fill: float) -> Real:
    """Return rows of different lengths, None among them, in an array."""
    filled = np.full(where.shape, fill)
    if where.any():
        filled[where] = np.concatenate([one for one in rows if one is not None])
    return filled


def _response(scene: Scene, measured: Measured, how: Options, *, scale: bool) -> ResponseFit:
    """Identify one rope by a whole response."""
    if not isinstance(how.orders, str) or how.orders != "auto":
        raise SceneError(
            'orders must be "auto" of a whole response, got '
            f"{check.shown(how.orders)}: give its peaks to say which modes they are"
        )
    unknowns = Unknowns.of(scene, how.paths)
    if scale:
        unknowns = unknowns.with_calibration(1.0)
    response = Response(unknowns, above_zero(measured), how.elements, how.element)
    return fit_response(response, PriorMisfit.of(unknowns, how.prior))


def _warn(notes: Sequence[str]) -> None:
    for note in notes:
        warnings.warn(note, IdentifyWarning, stacklevel=3)


# --- what was given ---------------------------------------------------------------------------


def _peaks(measured: Any, name: str) -> Peaks:
    """Return peaks from what they may be given as."""
    if isinstance(measured, Peaks):
        return measured
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


def _weighable(frequency: Real, weight: Real) -> Flags:
    """Say which peaks have squares that are numbers, and weights."""
    least, most = SIZES
    inside = (frequency >= least) & (frequency <= most)
    with np.errstate(over="ignore"):
        return inside & (weight >= least * frequency) & (weight <= most * frequency)


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
    paths = unknowns.paths
    if not isinstance(prior, Prior):
        check.instance(prior, "prior", Mapping, 'a mapping such as {"tension": (300.0, 15.0)}')
        for path in prior:
            check.one_of(path, "key of prior", paths)
        prior = Prior(prior)
    for path, size in zip(paths, np.abs(unknowns.start) + unknowns.scale):
        value, std = prior.get(path, (size, size))
        if abs(value) > SIZES[1] * size or std < SIZES[0] * size:
            raise SceneError(
                f"prior[{path!r}] must be of at most {SIZES[1] * size:g} and have a std of at "
                f"least {SIZES[0] * size:g}, got {(value, std)}: the scene's guess is {size:g}"
            )
    return {path: prior[path] for path in prior if path in paths}


def _tensed(scene: Scene, tension: float) -> Scene:
    """Return a scene with this tension in place of none."""
    return with_values(scene, {"tension": tension}) if scene.mean_tension == 0 else scene
