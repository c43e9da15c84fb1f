"""Find numbers of a scene from a whole measured frequency response."""

from __future__ import annotations

import time

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Real
from ...base.errors import SceneError
from ..fitting.minimum import minimise
from ..fitting.misfit import PriorMisfit
from ..fitting.response_misfit import LineMisfit, LogMisfit, Response
from ..fitting.unknown import Unknowns
from .notes import RESPONSE, notes_of
from .residual_noise import line_std
from .response_fit import ResponseFit
from .response_start import start_of_response
from .solution import Solution, solve

ROUGH = {"ftol": 1e-4, "xtol": 1e-6, "gtol": 1e-8}  # Tolerances of a fit that only leads on.
ROUNDS = 4  # Noise and fit take turns so often at most.
SETTLED = 0.1  # Noise and fit are settled when the fit moves by less, in standard deviations.
EXACT = 1e-8  # Differences below this share of the root mean square show in no measurement.
ALIKE = 0.5  # Residuals of neighbouring lines that are correlated by more are no noise.


def fit_response(response: Response, known: PriorMisfit | None) -> ResponseFit:
    """Fit logarithms, in which peaks at wrong places are decades off, then lines over noise."""
    started = time.perf_counter()
    measured = response.measured
    lines = int((measured.value != 0).sum())
    _refuse_few(response.unknowns, lines, known)
    response, u = start_of_response(response)
    unknowns, logarithm = response.unknowns, LogMisfit(response)
    _refuse_unseen(logarithm, u, known)
    near = minimise(logarithm, u, digits=ROUGH)
    u, evaluations = near.u, near.evaluations
    for _ in range(ROUNDS):
        value, _ = response(u)
        std = line_std(measured, value - measured.value)
        solution = solve(
            unknowns,
            LineMisfit(response, std),
            u,
            rows=2 * measured.value.size,
            known=known,
            noise=None,
            guess=u,
        )
        evaluations += solution.minimum.evaluations
        u, before = solution.minimum.u, u
        if (np.abs(u - before) <= SETTLED * solution.uncertainty.std).all():
            break
    return _answer(response, solution, std, evaluations, time.perf_counter() - started)


def _refuse_few(unknowns: Unknowns, lines: int, known: PriorMisfit | None) -> None:
    others = 0 if known is None else len(known.at)
    if 2 * lines + others <= len(unknowns):
        raise SceneError(
            f"measured must have more lines that are not 0 for {len(unknowns)} unknown and "
            f"{others} prior values, got {lines}"
        )


def _refuse_unseen(misfit: LogMisfit, u: Real, known: PriorMisfit | None) -> None:
    """Refuse numbers that the response does not depend on, unless they are known beforehand."""
    unseen = np.asarray(~misfit(u)[1].any(axis=0))
    if known is not None:
        unseen[known.at] = False
    for i in np.flatnonzero(unseen):
        raise SceneError(
            f"unknown[{i}] must change the response that was measured, got "
            f"{misfit.response.unknowns.paths[i]!r}, which does not"
        )


def _answer(
    response: Response, solution: Solution, std: Real, evaluations: int, seconds: float
) -> ResponseFit:
    measured = response.measured
    value, _ = response(solution.minimum.u)
    off = solution.minimum.residual[: solution.rows]
    return ResponseFit(
        unknown=solution.unknowns.paths,
        value=solution.value,  # type: ignore[arg-type]
        std=solution.std,  # type: ignore[arg-type]
        correlation=solution.uncertainty.correlation,
        drive=measured.drive,
        response=measured.response,
        quantity=measured.quantity,
        frequency=measured.frequency,
        measured=measured.value,
        calculated=value,
        measured_std=solution.noise * std,
        freedom=solution.freedom,
        chi_square=float(np.sum((off / solution.noise) ** 2)),
        notes=(*notes_of(solution, RESPONSE), *_systematic(measured.value, value, std)),
        cost=Cost(
            seconds=seconds,
            method="least squares",
            elements=response.elements or 0,
            unknowns=len(solution.unknowns),
            factorisations=evaluations,
        ),
        solution=solution,
    )


def _systematic(measured: Complex, calculated: Complex, std: Real) -> list[str]:
    """Say where neighbouring lines are off alike: that is the model, not noise."""
    found = []
    for r, (true, off, each) in enumerate(zip(measured, calculated - measured, std)):
        if np.linalg.norm(off) <= EXACT * np.linalg.norm(true):
            continue
        one = off / each
        size = float(np.vdot(one, one).real)
        alike = float(np.vdot(one[:-1], one[1:]).real) / size if size > 0 else 0.0
        if alike > ALIKE:
            found.append(
                f"response {r} differs from the model by more than noise: its residuals of "
                f"neighbouring lines are correlated by {alike:.2f}, and the std are too small"
            )
    return found
