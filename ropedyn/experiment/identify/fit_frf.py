"""Find numbers of a scene from a whole measured frequency response."""

from __future__ import annotations

from functools import partial

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Real
from ...base.errors import SceneError
from ...base.named import Named
from ...curves.measured import Measured
from ...signal.hits import alike
from ..fitting.minimum import Point
from ..fitting.misfit import LineMisfit, LogMisfit, OneByOne, PriorMisfit, Response, unseen_of
from ..fitting.solution import Solution, Task
from ..fitting.unknown import Unknowns
from .known import Solved, kept_bounds
from .notes import RESPONSE, notes_of
from .response_fit import ResponseFit
from .response_start import ROW, near, start_of_response

ROUGH = {"ftol": 1e-4, "xtol": 1e-6, "gtol": 1e-8}  # Tolerances of a fit that only leads on.
ROUNDS = 4  # Noise and fit take turns so often at most.
SETTLED = 0.1  # Noise and fit are settled when the fit moves by less, in standard deviations.
EXACT = 1e-8  # Differences below this share of the root mean square show in no measurement.
ALIKE = 0.5  # Residuals of neighbouring lines that are correlated by more are no noise.
LEAST = 1e-12  # Noise below this share of a line is rounding.
LIKELIER = 2.0  # Two kinds of noise are likelier than one by at least this logarithm (Akaike: 1).
FAINT = 1e-12  # A kind of noise that has less than this part is none.


def fit_response(response: Response, known: PriorMisfit | None) -> ResponseFit:
    """Fit logarithms, in which peaks at wrong places are decades off, then lines over noise."""
    measured = response.measured
    lines, together = int((measured.value != 0).sum()), alike(_long(measured))
    _refuse_few(response.unknowns, lines, known)
    response, u = start_of_response(response)
    unknowns, logarithm = response.unknowns, LogMisfit(response)
    _refuse_unseen(logarithm, u, known)
    first = near(response, u, ROUGH)
    u, evaluations = first.u[0], int(first.evaluations[0])
    for _ in range(ROUNDS):
        value, _ = response(u)
        std = line_std(measured, value - measured.value)
        misfit = OneByOne(LineMisfit(response, std * np.sqrt(together)))
        task = Task(unknowns, misfit, 2 * measured.value.size, known, np.full(1, np.nan), together)
        start = Point(u[None], *(one[None] for one in misfit.function(u)))
        solution, failed = task.solve(ROW, start)
        if failed:
            raise failed[0]
        evaluations += int(solution.record["evaluations"][0])
        u, before = solution.u[0], u
        if (np.abs(u - before) <= SETTLED * solution.uncertainty.std[0]).all():
            break
    return _answer(response, solution, std, evaluations)


def _refuse_few(unknowns: Unknowns, lines: int, known: PriorMisfit | None) -> None:
    others = 0 if known is None else len(known.at)
    if 2 * lines + others <= len(unknowns):
        raise SceneError(
            f"measured must have more lines that are not 0 for {len(unknowns)} unknown and "
            f"{others} prior values, got {lines}"
        )


def _refuse_unseen(misfit: LogMisfit, u: Real, known: PriorMisfit | None) -> None:
    """Refuse numbers that the response does not depend on, unless they are known beforehand."""
    for i in np.flatnonzero(unseen_of(misfit(u)[1][None], known)[0]):
        raise SceneError(
            f"unknown[{i}] must change the response that was measured, got "
            f"{misfit.response.unknowns.paths[i]!r}, which does not"
        )


def _answer(response: Response, solution: Solution, std: Real, evaluations: int) -> ResponseFit:
    measured = response.measured
    value, _ = response(solution.u[0])
    sought, freedom = len(solution.unknowns), float(solution.record["freedom"][0])
    known = Solved(solution)
    return ResponseFit(
        unknown=solution.unknowns.paths,
        value=Named(solution.value[0], solution.unknowns.paths),
        std=Named(solution.std[0], solution.unknowns.paths),
        correlation=solution.uncertainty.correlation[0],
        freedom=None if np.isnan(freedom) else freedom,
        chi_square=float(solution.off[0] / solution.noise[0] ** 2),
        cost=Cost("least squares", response.elements or 0, sought, factorisations=evaluations),
        bounds=partial(kept_bounds, known.interval),
        scene=partial(getattr, known, "scene"),
        known=known,
        drive=measured.drive,
        response=measured.response,
        quantity=measured.quantity,
        frequency=measured.frequency,
        measured=measured.value,
        calculated=value,
        measured_std=solution.noise[0] * std,
        notes=(*notes_of(solution, RESPONSE), *_systematic(measured, value, std)),
    )


def _long(measured: Measured) -> float:
    """Return decay times the duration of records, by the distance of lines."""
    if measured.decay == 0 or len(measured.frequency) < 2:
        return 0.0
    return measured.decay / float(np.median(np.diff(measured.frequency)))


def _systematic(measured: Measured, calculated: Complex, std: Real) -> list[str]:
    """Say where neighbouring lines are off alike: that is the model, not noise."""
    found = []
    long = _long(measured)
    by_window = long**2 / (long**2 + np.pi**2)
    for r, (true, off, each) in enumerate(zip(measured.value, calculated - measured.value, std)):
        if np.linalg.norm(off) <= EXACT * np.linalg.norm(true):
            continue
        one = off / each
        size = float(np.vdot(one, one).real)
        near = float(np.vdot(one[:-1], one[1:]).real) / size if size > 0 else 0.0
        if near > by_window + ALIKE * (1 - by_window):
            found.append(
                f"response {r} differs from the model by more than noise: its residuals of "
                f"neighbouring lines are correlated by {near:.2f}, and the std are too small"
            )
    return found


def line_std(measured: Measured, off: Complex) -> Real:
    """Estimate the standard deviation of either part of each line, a^2 + b^2 |H|^2.

    The measured std tell the first kind, or coherence C, (1 - C)/C |H|^2/2n of n averages (Bendat,
    Piersol, Random Data, 2010, section 9.2).
    """
    std = np.empty(off.shape)
    for r, value in enumerate(measured.value):
        power = np.abs(value) ** 2
        first = np.full(power.shape, power.mean())
        if measured.std is not None:
            first = measured.std[r] ** 2
        elif measured.coherence is not None:
            share = measured.coherence[r]
            with np.errstate(divide="ignore"):
                first = power * np.where(share > 0, (1 - share) / share, np.inf)
        told = np.isfinite(first) & (power > 0)
        std[r] = np.inf
        size = _most_likely(np.stack([first[told], power[told]]), np.abs(off[r][told]) ** 2 / 2)
        std[r, told] = np.sqrt(size @ np.stack([first[told], power[told]]))
    return std


def _most_likely(kinds: Real, square: Real) -> Real:
    """Return the likeliest sizes of kinds of variance, (2,); one alone unless both tell more."""
    each = np.array([_alone(kind, square) for kind in kinds])
    alone = [np.array([each[0], 0.0]), np.array([0.0, each[1]])]
    likeliest = min(alone, key=lambda size: _unlikely(size, kinds, square)[0])
    both = _together(kinds, square, each)
    gain = _unlikely(likeliest, kinds, square)[0] - _unlikely(both, kinds, square)[0]
    return both if gain > LIKELIER else likeliest


def _alone(kind: Real, square: Real) -> float:
    """Return the likeliest size of one kind."""
    there = kind > 0
    return max(float(np.mean(square[there] / kind[there])), LEAST**2) if there.any() else 0.0


def _together(kinds: Real, square: Real, start: Real) -> Real:
    """Return the likeliest sizes of both, sought by their logarithms from less than either."""
    from scipy.optimize import minimize

    if not start.all():
        return start

    def of(u: Real) -> tuple[float, Real]:
        size = start * np.exp(u)
        value, slope = _unlikely(size, kinds, square)
        return value, slope * size

    bounds = [(np.log(FAINT), 0.0)] * 2
    found = minimize(of, np.full(2, -1.0), jac=True, method="L-BFGS-B", bounds=bounds)
    return np.asarray(start * np.exp(found.x))


def _unlikely(size: Real, kinds: Real, square: Real) -> tuple[float, Real]:
    """Return -ln of the likelihood, sum of ln v + square/v, and its slopes by the sizes."""
    variance = size @ kinds
    if not (variance > 0).all():
        return np.inf, np.zeros(2)
    slope = kinds @ (1 / variance - square / variance**2)
    return float(np.sum(np.log(variance) + square / variance)), slope
