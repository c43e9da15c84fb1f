"""Where to start the fit of a frequency response, from where its peaks stand."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SceneError, SolveError
from ...chain.port import moving
from ...chain.rate import Places, rates_of
from ...curves.measured import Measured, lines_of
from ...curves.peaks import Peaks
from ...model import Model
from ..fitting.minimum import Minimum, Point, minimise
from ..fitting.misfit import LogMisfit, OneByOne, PeakMisfit, Response
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.peak_start import start_of_peaks
from ..fitting.unknown import CALIBRATION

SEEN = 1e-3  # Modes with less than this part of the largest residue are not looked for.
HIDDEN = 3  # So many of the lowest modes may be missing below the first line.
LINES = 200  # Starts are compared on so many lines.
CLOSE = 0.2  # No other start has to better this root mean square of logarithms.
ROW = np.zeros(1, dtype=np.intp)  # The one row that a response is.
ROUGH = {"ftol": 1e-2, "xtol": 1e-3, "gtol": 1e-6}  # Tolerances of the fit of a start.


class Start(NamedTuple):
    """Where to start."""

    cost: float  # sum of squares of logarithms, on a few hundred lines
    response: Response  # that was compared
    u: Real  # (p,) the variables


def start_of_response(response: Response) -> tuple[Response, Real]:
    """Return variables from which the fit finds its way: what fits logarithms of few lines best."""
    starts, failure = _starts(response)
    best: tuple[Minimum, Response] | None = None
    for start in sorted(starts, key=lambda one: one.cost):
        try:
            found = near(start.response, start.u, ROUGH)
        except (SceneError, SolveError) as error:
            failure = failure or error
            continue
        if best is None or found.cost[0] < best[0].cost[0]:
            best = found, start.response
        if best[0].cost[0] <= CLOSE**2 * found.residual.shape[1]:
            break
    if best is None:
        assert failure is not None
        raise failure
    minimum, chosen = best
    return replace(response, unknowns=chosen.unknowns), minimum.u[0]


def near(response: Response, u: Real, digits: Mapping[str, float]) -> Minimum:
    """Fit logarithms roughly, as one row."""
    misfit = OneByOne(LogMisfit(response))
    start = Point(u[None], *(one[None] for one in misfit.function(u)))
    found = minimise(misfit, ROW, start, digits=digits)
    if not found.reached[0]:
        raise found.refusal(0)
    return found


def _starts(response: Response) -> tuple[list[Start], SceneError | SolveError | None]:
    """Return what can be started from, and why something else cannot."""
    found: list[Start] = []
    failure: SceneError | SolveError | None = None
    peaks = functools.cache(functools.partial(peaks_of, response.measured))
    signed = _signed(_thinned(response, peaks))
    for u in _candidates(response, peaks):
        for one in signed:
            try:
                start = _calibrated(one, u)
                off = LogMisfit(one)(start)[0]
                found.append(Start(float(off @ off), one, start))
            except (SceneError, SolveError) as error:
                failure = failure or error
            else:
                if found[-1].cost <= CLOSE**2 * len(off):
                    return found, failure
    return found, failure


def _signed(response: Response) -> list[Response]:
    """Return the response with either sign of the calibration, if that is sought."""
    unknowns = response.unknowns
    if CALIBRATION not in unknowns.paths:
        return [response]
    both = (unknowns.with_calibration(sign) for sign in (1.0, -1.0))
    return [replace(response, unknowns=one) for one in both]


def peaks_of(measured: Measured) -> Real:
    """Return the frequencies of the resonances that all responses together show [Hz]."""
    try:
        return np.asarray(Peaks.of(measured).frequency)
    except SceneError:  # there are none
        return np.zeros(0)


def _thinned(response: Response, peaks: Callable[[], Real]) -> Response:
    """Return the same on a few lines: those of peaks, and others evenly."""
    measured = response.measured
    count = len(measured.frequency)
    if count <= LINES:
        return response
    kept = np.unique(np.linspace(0, count - 1, LINES).astype(np.intp))
    near = np.searchsorted(measured.frequency, peaks())
    around = (near[:, None] + np.arange(-2, 3)).ravel()
    kept = np.union1d(kept, around[(around >= 0) & (around < count)])
    return replace(response, measured=lines_of(measured, kept))


def _candidates(response: Response, peaks_seen: Callable[[], Real]) -> Iterator[Real]:
    """Yield the guess of the scene, and what fits the peaks under each reading of them."""
    unknowns = response.unknowns
    guess = np.zeros(len(unknowns))
    yield guess
    model = response.model(guess)
    rates = rates_of(Places(model))
    shifts = np.array([all(path in rates for path in some) for some in unknowns.places])
    peaks = peaks_seen()
    if not shifts.any() or len(peaks) < shifts.sum():
        return
    sought = unknowns.only(shifts)
    calculated = NaturalFrequencies.of(sought, response.elements, response.element)
    try:
        seen = _visible_orders(response.measured, model, len(peaks) + HIDDEN)
    except (SceneError, SolveError):
        return
    # the lowest peaks alone: among higher ones some may be missing or no mode
    few = max(int(shifts.sum()), len(peaks) // 2)
    readings = [(0, few), *((hidden, len(peaks)) for hidden in range(HIDDEN + 1))]
    for hidden, count in readings:
        orders = seen[None, hidden : hidden + count]
        measured = peaks[None, : orders.shape[1]]
        misfit = PeakMisfit(calculated, measured, measured, orders)
        first, _ = start_of_peaks(misfit, ROW, np.zeros((1, len(sought))))
        if np.isnan(first.residual).any():
            continue
        found = minimise(misfit, ROW, first, digits=ROUGH)
        if found.reached[0]:
            u = guess.copy()
            u[shifts] = found.u[0]
            yield u


def _visible_orders(measured: Measured, model: Model, count: int) -> Index:
    """Return the lowest modes that the drive and some response see, from 1."""
    modes = model.modes(2 * count)
    vibrating = np.flatnonzero(modes.frequency > 0)

    def motion(point: tuple[str, float]) -> Real:
        at = model.coordinates.index(moving(point))
        return np.array([np.interp(point[1], modes.x, shape[:, at]) for shape in modes.shape])

    drive = motion(measured.drive[0])
    residue = np.max([np.abs(drive * motion(point)) for point in measured.response], axis=0)
    residue = (residue / modes.modal_mass)[vibrating]
    return np.flatnonzero(residue > SEEN * residue.max(initial=0.0))[:count] + 1


def _calibrated(response: Response, u: Real) -> Real:
    """Return variables with the factor of the calibration that makes amplitudes equal."""
    paths = response.unknowns.paths
    if CALIBRATION not in paths:
        return u
    value, _ = response(u)
    kept = (response.measured.value != 0) & (value != 0)
    ratio = np.abs(response.measured.value[kept] / value[kept])
    u = u.copy()
    u[paths.index(CALIBRATION)] += np.median(np.log(ratio)) if ratio.size else 0.0
    return u
