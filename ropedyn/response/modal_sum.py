"""Harmonic response as a sum over the modes of the undamped model, each with its damping ratio.

With z = omega^2 = -s^2, H(z) the undamped response and r_k its residues at the eigenvalues,

    h = H(-s) + sum r_k g_k,   g_k = 1/(lambda_k - z + 2 i zeta_k omega sqrt(lambda_k))
                                      - 1/(lambda_k + s)

H(-s) is the exact static response, s = 0, of all modes together; where the rope can move as a rigid
body it is the one at the imaginary frequency sqrt(-s) instead. The modes that are left out have
g_k = 0 then. No shape is needed: a residue is the mean of (lambda_k - z) H(z) over a circle about
lambda_k, which a few points give to all digits.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.compiled import Compiled
from ..chain.port import Point, is_force
from ..chain.tip import is_tip
from ..eigen.spectrum import HIGHEST, apart, count_component, numbers_below, spectrum
from ..scene import damping
from .moved_end import refuse_moved_ends
from .question import Bound, Question, Solver

REACH, LEAST, MOST = 8.0, 64, 5_000
"""Modes below so many times the highest frequency are summed up, at least and at most so many."""
ROUND, NEAR = 16, 1 / 16
"""A circle has so many points, and this part of the distance to the next mode as its radius: 16^-16
of that mode is seen."""
ALIKE = 2.0**-26  # Eigenvalues that differ by the root of eps are one: apart they would lose more.
TOGETHER = 8  # The own responses of so many points are computed at once.


class UndampedPoles(NamedTuple):
    """Modes of one component that are summed up; equal ones are one."""

    eigenvalue: Real  # (k,) [rad^2/s^2]
    error: Real  # (k,) of the eigenvalue
    radius: Real  # (k,) of a circle with no other mode in it
    ratio: Real  # (k,) of damping
    unlike: Real  # (k,) how far the ratios of equal modes are from that
    beyond: float  # The first eigenvalue that is left out; infinite where none is
    shift: float  # s
    probe: float  # -z at which the sum is compared with the undamped response, more than s
    largest: float  # Largest damping ratio


def refuse_other_damping(
    model: Compiled, drives: Iterable[Point], responses: Iterable[Point]
) -> None:
    """Refuse modal damping beside any other, which would couple the modes, of ends and tips."""
    if others := beside_ratios(model):
        raise SceneError(
            "damping must be modal alone in a frequency response and where other damping couples "
            f"the modes, got {', '.join(others)}"
        )
    refuse_moved_ends(drives)
    if any(map(is_tip, responses)):
        raise SceneError(
            "damping must not be modal where the tip of a wire is asked for, whose modes are those "
            "of rope and wire together"
        )


def beside_ratios(model: Compiled) -> list[str]:
    """Name what damps beside ratios of modes."""
    scene, chain = model.scene, model.chain
    others = [one.kind for one in damping.having(scene.dampings, "rate", "loss", "drag")]
    if "dashpot" in scene.effects and chain.damping is not None:  # not powers alone
        others.append("dashpot")
    return [*others, *(chain.carried if chain.resists else [])]


class Summed(NamedTuple):
    """Response of one component."""

    value: Complex  # (drives, responses, f)
    rounding: Bound  # What bounds the error of rounding
    truncation: Real  # Bound of the error that the modes cause which are left out, as value
    lines: int  # Lines of the solver that it took
    parts: ModalParts | None = None  # Of a sum over modes


class ModalParts(NamedTuple):
    """What a sum over modes is made of."""

    question: Question  # that it answers
    lines: Question  # to the undamped model, about what it is made of
    poles: UndampedPoles
    residue: Estimated  # (drives, responses, k)

    def nudged(self, random: np.random.Generator) -> ModalParts:
        """Return those with residues and eigenvalues as far off as they may be, circles kept."""
        poles, (residue, error) = self.poles, self.residue
        own = poles.eigenvalue + poles.error * random.uniform(-1, 1, len(poles.eigenvalue))
        residue = residue + error * random.uniform(-1, 1, residue.shape)
        return self._replace(
            poles=poles._replace(eigenvalue=own), residue=Estimated(residue, error)
        )


def modal_sum(question: Question, solver: Solver) -> Summed:
    """Sum up the modes of one component."""
    if any(map(is_force, question.responses)):
        raise SceneError(
            "response must be a motion where damping is modal: the sum over modes knows no "
            f"internal force, got {next(filter(is_force, question.responses))}"
        )
    poles = _poles(question)
    static, residue, probed = _taken_apart(question, solver, poles)
    own = _left_out(question, solver, poles)
    d, r = ([own[point] for point in some] for some in (question.drives, question.responses))
    size = np.sqrt(np.multiply.outer(d, r))  # the sum over modes is bounded as an inner product
    omega = question.omega
    shape = (len(question.drives), len(question.responses), len(omega))
    value, error = np.empty(shape, dtype=np.complex128), np.empty(shape)
    most = max(1, (1 << 20) // max(len(poles.eigenvalue), 1))
    for first in range(0, len(omega), most):
        part = slice(first, first + most)
        g, slope = _weights(question, poles, omega, part)
        value[..., part] = static.value[..., None] + residue.value @ g
        error[..., part] = static.error[..., None] + residue.error @ np.abs(g)
        error[..., part] += np.abs(residue.value) @ slope
    missing = _missing(poles, static, residue, probed)[..., None]
    share = (np.abs(omega) ** 2 + poles.shift) / (poles.probe - poles.shift)
    neglected = np.maximum(size[..., None] * _most(poles, omega), missing * share)
    lines = (2 + ROUND // 2 * len(poles.eigenvalue)) * (1 + -(-len(own) // TOGETHER))
    parts = ModalParts(question, undamped_lines(question, poles), poles, residue)
    return Summed(value, lambda: error, neglected, lines, parts)


def sum_slope(parts: ModalParts, by_p: Complex, ratio: float) -> Complex:
    """Return how the sum changes, from the change of H at its lines and that of all ratios.

    H = r/(lambda - z) + .. changes by r'/(lambda - z) - r lambda'/(lambda - z)^2 + ..: the residue
    and the eigenvalue are told apart by the circles, and no shape changes.
    """
    poles, question = parts.poles, parts.question
    step = _steps(poles)
    around = by_p[..., : step.size].reshape(*by_p.shape[:2], *step.shape)
    residue = (-step * around).real.mean(axis=-1)
    moved = -(step**2 * around).real.mean(axis=-1)
    value = np.empty((*by_p.shape[:2], len(question.frequency)), dtype=np.complex128)
    omega = question.omega
    most = max(1, (1 << 20) // max(len(poles.eigenvalue), 1))
    for first in range(0, len(omega), most):
        part = slice(first, first + most)
        g, by_pole, by_ratio = _weight_slopes(poles, omega[part])
        value[..., part] = by_p[..., -2].real[..., None] + residue @ g + moved @ by_pole
        if ratio:
            value[..., part] += ratio * (parts.residue.value @ by_ratio)
    return value


def _weight_slopes(poles: UndampedPoles, omega: Real | Complex) -> tuple[Complex, Complex, Complex]:
    """Return g of `_weights`, dg/dlambda and dg/dzeta, each (k, f)."""
    own, ratio = poles.eigenvalue[:, None], poles.ratio[:, None]
    root, soft = np.sqrt(np.maximum(own, 0.0)), 1 / (own + poles.shift)
    lost = 2j * ratio * root * omega
    near: Complex = 1 / np.asarray(own - omega**2 + lost, dtype=np.complex128)
    turned = np.divide(ratio, root, out=np.zeros_like(root), where=root > 0)
    g = (omega**2 + poles.shift - lost) * (soft * near)
    by_pole = soft**2 - (1 + 1j * turned * omega) * near**2
    by_ratio = -2j * root * omega * near**2
    return np.asarray(g, dtype=np.complex128), by_pole, by_ratio


class Estimated(NamedTuple):
    """Numbers and their absolute errors."""

    value: Real
    error: Real


def _poles(question: Question) -> UndampedPoles:
    """Find the modes, each with its damping ratio."""
    model, component = question.model, question.component
    fastest = float(question.frequency.max())
    highest = (2 * np.pi * fastest) ** 2
    try:
        below = count_component(model, component, min(REACH**2 * highest, HIGHEST))
    except SolveError as refusal:
        raise _too_high(question, str(refusal)) from refusal
    wanted = max(below, LEAST)
    if wanted > MOST:
        raise _too_high(question, f"{wanted} below {REACH:g} times it, more than {MOST}")
    eigenvalue, error = spectrum(model, component, wanted + 1)
    ratio = known_ratios(model, component, eigenvalue)
    poles = _grouped(eigenvalue, error, ratio[:wanted], highest)
    if not poles.beyond > highest:
        raise SceneError(
            "damping ratio must be one number or one for each mode up to the highest frequency, "
            f"got {len(ratio)} for those of ({', '.join(component)}) up to {fastest!r} Hz"
        )
    return poles


def _too_high(question: Question, why: str) -> SolveError:
    return SolveError(
        f"frequency {float(question.frequency.max())!r} Hz is too high for a sum over the modes of "
        f"({', '.join(question.component)}): {why}"
    )


def numbered_ratios(
    model: Compiled, component: tuple[str, ...], eigenvalue: Real
) -> tuple[Index, Real]:
    """Return the numbers of a component's modes among those of all, from 0, and their ratios."""
    number = np.arange(len(eigenvalue))
    own = model.components.index(component)
    for k, other in enumerate(model.components):
        if other != component:
            below = numbers_below(model.chain.only(other), apart(eigenvalue, own - k))
            number = number + below.astype(np.intp)
    every = damping.ratios(model.scene.dampings, int(number.max(initial=-1)) + 1)
    return number, every[number]


def known_ratios(model: Compiled, component: tuple[str, ...], eigenvalue: Real) -> Real:
    """Return the damping ratios of modes up to the first that has none."""
    _, ratio = numbered_ratios(model, component, eigenvalue)
    return ratio[: int(np.append(np.flatnonzero(np.isnan(ratio)), len(ratio))[0])]


def shift_of(eigenvalue: Real) -> float:
    """Return -lambda where the static response is taken: 0, where nothing is rigid."""
    if not (eigenvalue == 0).any():
        return 0.0
    elastic = eigenvalue[eigenvalue > 0]
    shift = float(elastic[0]) if len(elastic) else 1.0
    while (np.abs(eigenvalue + shift) < 0.1 * shift).any():
        shift *= 1.5
    return shift


def undamped_factors(z: Complex) -> Complex:
    """Return the factors of the parts of the dynamic stiffness without damping, (5, n)."""
    factor = np.ones((len(damping.PARTS), len(z)), dtype=np.complex128)
    factor[damping.INERTIA], factor[damping.DASHPOT] = -z, 0.0
    return factor


def _grouped(eigenvalue: Real, error: Real, ratio: Real, highest: float) -> UndampedPoles:
    """Make one of the modes that cannot be told apart, and draw the circles."""
    # where not all of those that are one have a ratio, none is kept
    apart = np.diff(eigenvalue) > ALIKE * np.abs(eigenvalue[1:]) + 4 * (error[1:] + error[:-1])
    group = np.append(0, np.cumsum(apart))[: len(eigenvalue)]
    beyond = np.inf
    if len(eigenvalue) > len(ratio):
        ratio = ratio[: np.searchsorted(group, group[len(ratio)])]
        beyond = float(eigenvalue[len(ratio)])
    kept = len(ratio)
    group, eigenvalue, error = group[:kept], eigenvalue[:kept], error[:kept]
    members = np.bincount(group)
    middle, mean = np.bincount(group, eigenvalue) / members, np.bincount(group, ratio) / members
    spread, unlike = np.zeros(len(middle)), np.zeros(len(middle))
    np.maximum.at(spread, group, np.abs(eigenvalue - middle[group]) + error)
    np.maximum.at(unlike, group, np.abs(ratio - mean[group]))
    gap = np.diff(np.concatenate([[-np.inf], middle, [beyond]]))
    gap = np.minimum(gap[:-1], gap[1:])
    elastic = middle[middle > 0]
    first = float(elastic[0]) if len(elastic) else 1.0
    shift = shift_of(middle)
    radius = NEAR * np.minimum(gap, np.where(middle == 0, first, np.abs(middle)))
    probe, largest = max(highest, 2 * shift, first), float(ratio.max(initial=0.0))
    return UndampedPoles(middle, spread, radius, mean, unlike, beyond, shift, probe, largest)


def _steps(poles: UndampedPoles) -> Complex:
    """Return the points of the circles less their middles, (k, points)."""
    angle = np.pi * (np.arange(ROUND // 2) + 0.5) / (ROUND // 2)
    return np.multiply.outer(poles.radius, np.exp(1j * angle))  # H of the other half is conjugate


def undamped_lines(question: Question, poles: UndampedPoles) -> Question:
    """Ask the undamped model on the circles, at -s and at the probe."""
    circles = poles.eigenvalue[:, None] + _steps(poles)
    z = np.concatenate([circles.ravel(), [-poles.shift, -poles.probe]])
    hertz = np.sqrt(np.abs(z)) / (2 * np.pi)
    return dataclasses.replace(question, factor=undamped_factors(z), frequency=hertz, decay=0.0)


def _taken_apart(
    question: Question, solver: Solver, poles: UndampedPoles
) -> tuple[Estimated, Estimated, Estimated]:
    """Return H(-s), the residues, (drives, responses, k), and H at the probe."""
    step = _steps(poles)
    value, bound = solver(undamped_lines(question, poles))
    error = bound()
    around = (*value.shape[:2], *step.shape)
    residue = (-step * value[..., :-2].reshape(around)).real.mean(axis=-1)
    spread = (poles.radius[:, None] * error[..., :-2].reshape(around)).mean(axis=-1)
    static, probed = (Estimated(value[..., k].real, error[..., k]) for k in (-2, -1))
    return static, Estimated(residue, spread), probed


def _left_out(question: Question, solver: Solver, poles: UndampedPoles) -> dict[Point, float]:
    """Bound H(-s) of the modes that are left out at each of all points, driven there."""
    points = list(dict.fromkeys([*question.drives, *question.responses]))
    own: list[float] = []
    for k in range(0, len(points), TOGETHER):
        some = points[k : k + TOGETHER]
        asked = dataclasses.replace(question, drives=some, responses=some)
        static, residue, _ = _taken_apart(asked, solver, poles)
        softness = 1 / (poles.eigenvalue + poles.shift)
        rest = static.value - residue.value @ softness
        rest = np.maximum(rest, 0.0) + static.error + residue.error @ np.abs(softness)
        own.extend(rest.diagonal().tolist())
    return dict(zip(points, own))


def _missing(
    poles: UndampedPoles, static: Estimated, residue: Estimated, probed: Estimated
) -> Real:
    """Return what the sum lacks at the probe beyond rounding, shape (drives, responses)."""
    # masses of tensed elements are indefinite: their negative eigenvalues are no modes
    s, p = poles.shift, poles.probe
    g = (s - p) / ((poles.eigenvalue + s) * (poles.eigenvalue + p))
    rest = np.abs(probed.value - static.value - residue.value @ g)
    return np.maximum(rest - probed.error - static.error - residue.error @ np.abs(g), 0.0)


def _weights(
    question: Question, poles: UndampedPoles, omega: Real | Complex, part: slice
) -> tuple[Complex, Real]:
    """Return g and what rounding of the eigenvalue makes of it, each (k, f)."""
    # g = (z + s - 2 i zeta omega sqrt(lambda))/((lambda + s) (lambda - z + the same)), without the
    # difference of two like numbers.
    omega = omega[part]
    z, own = omega**2, poles.eigenvalue[:, None]
    twice = 2 * omega * np.sqrt(np.maximum(own, 0.0))
    lost = 1j * poles.ratio[:, None] * twice
    pole = own - z + lost
    on_it = (np.abs(pole) <= poles.error[:, None]).any(axis=0)
    if on_it.any():
        raise question.resonance(part.start + int(on_it.argmax()))
    soft = 1 / (own + poles.shift)
    g = (z + poles.shift - lost) * soft / pole
    # lambda in the pole, in what it loses and in the static part; ratios of equal modes
    change = 1 + np.abs(lost) / np.maximum(2 * np.abs(own), np.finfo(float).tiny)
    moved = poles.error[:, None] * change + poles.unlike[:, None] * np.abs(twice)
    slope = moved / np.abs(pole) ** 2 + poles.error[:, None] * soft**2
    slope += 4 * np.finfo(float).eps * np.abs(g)
    return np.asarray(g, dtype=np.complex128), slope


def _most(poles: UndampedPoles, omega: Real | Complex) -> Real:
    """Return the largest (lambda + s) |g| of the modes that are left out, shape (f,)."""
    # |z + s - 2 i zeta omega sqrt(lambda)|/|lambda - z + the same| falls where lambda > Re z. The
    # sizes of both parts of omega = w - i d: what d adds below only makes it larger
    if not np.isfinite(poles.beyond):
        return np.zeros(len(omega))
    w, d = omega.real, -omega.imag
    lost = 2 * poles.largest * np.sqrt(poles.beyond)
    above = np.hypot(np.abs(w**2 - d**2 + poles.shift) + lost * d, (lost + 2 * d) * w)
    return np.asarray(above / (poles.beyond - w**2))
