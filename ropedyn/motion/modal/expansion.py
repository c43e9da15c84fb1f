"""A transfer function as a sum over modes.

Residues are means over circles around the eigenvalues (see contour.py): motion, internal forces,
tips of wires and motion of ends alike, no shape is needed. What is left is the response at one
place, s = 0 where the rope is held, less that of the modes.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SceneError, SolveError
from ...chain import tip
from ...chain.chain import Chain
from ...chain.compiled import Compiled, once
from ...chain.port import Point, is_force, moving
from ...eigen.damped.proportional import Proportional, proportional
from ...eigen.damped.rates import Rates
from ...eigen.spectrum import HIGHEST, count_component, parted, slowest_lump, spectrum
from ...response.modal_sum import (
    LEAST,
    REACH,
    known_ratios,
    refuse_other_damping,
)
from ...response.moved_end import is_end
from ...scene import damping
from ...signal import contour
from ..undamped import ROUND, UndampedResponses, losses_of, mixed

LARGEST, MANY = 1000, 400
"""All modes of a chain with so many unknowns are summed at most, and so many modes of others."""


class Expansion(NamedTuple):
    """What responses are to drives, in the rate s of a motion e^(s t).

        H(s) = rest + late/(1 + lag s) + sum_k (a_k + b_k s)/(s^2 + 2 sigma_k s + square_k)

    Pairs are conjugate rates -sigma +- i sqrt(square - sigma^2), rigid motion (sigma = square = 0),
    modes that decay without oscillation by two rates, or grow (square < 0).
    """

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    a: Real  # (drives, responses, k)
    b: Real  # (drives, responses, k); 0 where damping is proportional
    rest: Real  # (drives, responses) of what is left out: it follows at once,
    late: Real  # (drives, responses) or relaxes
    lag: float = 0.0  # [s]; 0: nothing does
    # (drives, responses) |H_out(0)| of the modes that are left out, at most; 0 where none is
    bound: Real = np.zeros((0, 0))
    # Angular frequency of the lowest that is left out [rad/s], infinite where none is
    beyond: float = math.inf
    wrong: Real | float = 0.0  # (k,) error of each square, relative
    # (k,) how far each sigma is off, as few digits tell which of close modes is which [1/s]
    mixed: Real | float = 0.0

    @property
    def modes(self) -> int:
        """How many modes are summed."""
        return len(self.sigma) + bool(self.lag)


class Share(NamedTuple):
    """What one component has of all drives and responses; others are not coupled."""

    drive: Index  # Which of the drives are on it
    response: Index  # Which of the responses
    expansion: Expansion


def refuse_losses(model: Compiled) -> None:
    """Refuse complex moduli, which have a meaning at each frequency, not in time."""
    losses = losses_of(model)
    if losses:
        raise SceneError(
            "damping must be in proportion to velocity, or modal, to have a meaning in time, got "
            f"{', '.join(losses)}: in modes a loss factor eta acts as ModalDamping(eta/2)"
        )


def expand(
    model: Compiled,
    drives: Sequence[Any],
    responses: Sequence[Point],
    *,
    modes: int | None = None,
    resolved: float = 0.0,
    bound: bool = True,
) -> tuple[Share, ...]:
    """Expand the transfer functions of each component."""
    refuse_losses(model)
    if damping.having(model.scene.dampings, "ratio"):
        refuse_other_damping(model, drives, responses)
    shares = []
    for component in model.components:
        d = [k for k, drive in enumerate(drives) if moving(drive) in component]
        r = [k for k, point in enumerate(responses) if tip.carrier(model, point) in component]
        if d and r:
            pushed, watched = [drives[k] for k in d], [responses[k] for k in r]
            asked = _Asked(model, component, pushed, watched, modes, resolved, bound)
            key = ("expansion", component, tuple(pushed), tuple(watched), modes, resolved, bound)
            expansion = once(model, key, partial(_expansion, asked))
            shares.append(Share(np.array(d), np.array(r), expansion))
    return tuple(shares)


# --- one component ------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class _Asked(UndampedResponses):
    """What else is asked of them; see `expand`."""

    modes: int | None
    resolved: float
    bound: bool

    @property
    def chain(self) -> Chain:
        return self.model.chain.only(self.component)


def _expansion(asked: _Asked) -> Expansion:
    model, component = asked.model, asked.component
    is_modal = bool(damping.having(model.scene.dampings, "ratio"))
    rates = Rates.of(model.scene.dampings)
    closed = proportional(model.chain.only(component), rates)
    eigenvalue, error, beyond = _eigenvalues(asked)
    if is_modal:
        ratio = known_ratios(model, component, eigenvalue)
        if len(ratio) < len(eigenvalue):
            eigenvalue, error, beyond = parted(eigenvalue, error, len(ratio))
        sigma = ratio[: len(eigenvalue)] * np.sqrt(np.maximum(eigenvalue, 0.0))
        return _closed(asked, (eigenvalue, error), beyond, Proportional(1, 0, 0), sigma)
    if closed is not None:
        sigma = (closed.drag.real + closed.soften.real * eigenvalue) / 2
        return _closed(asked, (eigenvalue, error), beyond, closed, sigma)
    raise SceneError("damping must not couple modes, which are summed one by one")


def _eigenvalues(asked: _Asked) -> tuple[Real, Real, float]:
    """Return those of the undamped modes that are summed, their errors, and the next one."""
    chain, finite = asked.chain, asked.chain.finite
    if asked.modes is not None:
        wanted = asked.modes
    elif finite is not None and chain.free <= LARGEST:
        wanted = finite
    else:
        try:
            limit = min(REACH * asked.resolved, math.sqrt(HIGHEST)) ** 2
            below = count_component(asked.model, asked.component, limit)
        except SolveError:  # more than can be walked
            below = MANY
        wanted = min(max(below, LEAST), MANY)
    return parted(*spectrum(asked.model, asked.component, wanted + 1), wanted)


# --- damping in proportion ----------------------------------------------------------------------


def _closed(
    asked: _Asked, known: tuple[Real, Real], beyond: float, closed: Proportional, sigma: Real
) -> Expansion:
    """Sum undamped modes. With stiffness g K, g = stiff + soften s, each is r/(g lambda + ..)."""
    # internal forces are g times those of K, and so are forces that motion of an end takes
    eigenvalue, error = known
    circles = contour.on_a_line(eigenvalue, error, beyond)
    stiff, soften = closed.stiff.real, closed.soften.real
    force = np.array([is_force(point) for point in asked.responses])
    power = np.array([is_end(drive) for drive in asked.drives])[:, None] + force.astype(int)
    if soften != 0 and (power > 1).any():
        raise SceneError(
            "response must not be an internal force where an end is moved and stiffness is damped: "
            "a jump of the end would take an infinite force"
        )
    parted = asked.parted(eigenvalue, circles)
    a, rest = parted.residue, parted.rest if np.isfinite(beyond) else parted.left
    b = np.where(power[:, :, None] == 1, soften, 0.0) * a
    a *= np.where(power[:, :, None] == 0, 1.0, stiff)
    # what is left out of motion by forces is held by g too
    lags = (power == 0) & (soften != 0)
    late, rest = np.where(lags, rest / stiff, 0.0), np.where(lags, 0.0, rest)
    bound = np.zeros(rest.shape)
    if not np.isfinite(beyond):  # but lumps of negative inertia
        beyond = slowest_lump(asked.model, asked.component) ** 2
    if np.isfinite(beyond):
        bound = np.full(rest.shape, np.inf)
        if asked.bound:
            bound = asked.bounded(lambda own: _left(own, eigenvalue, circles))
    lowest = float(np.sqrt(max(beyond, 0.0)))
    wrong = np.divide(error, np.abs(eigenvalue), out=np.ones_like(error), where=eigenvalue != 0)
    off, _ = mixed(eigenvalue, circles, sigma)
    return Expansion(
        sigma, stiff * eigenvalue, a, b, rest, late, soften / stiff, bound, lowest, wrong, off
    )


def _left(asked: _Asked, eigenvalue: Real, circles: contour.Circles) -> Real:
    """Bound what is left of the response at one place, rounding included."""
    parted = asked.parted(eigenvalue, circles)
    return np.asarray(np.abs(parted.rest) + ROUND * parted.size)
