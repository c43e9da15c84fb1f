"""Responses at the frequency of an undamped mode that no force excites or no response sees.

There the dynamic stiffness is singular and the response is not: no term of its sum over modes has
that pole. It is analytic around the line, and so the mean of its values on a circle,

    h(omega) = 1/N sum_j h(omega + r exp(i theta_j)),

and of h(omega + r exp(i theta)) = sum_m c_m exp(i m theta) all c_m of m < 0 vanish. Where they do
not, beyond what rounding leaves on the circle, the mode answers and the line is refused.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Flags, Real
from ..scene import damping
from .question import Bound, OnResonance, Question, Solver, damped_lines

COUNT = 32  # Points of a circle.
RADII = 2.0 ** -np.arange(2.0, 22.0)  # of circles, over the frequency
THETA = 2 * np.pi * (np.arange(COUNT) + 0.5) / COUNT
ORDERS = np.arange(-COUNT // 4, COUNT // 2)  # of c_m
LAST = 4  # The highest orders tell what a circle does not resolve.


class AtNode(NamedTuple):
    """A response at one frequency, (drives, responses)."""

    value: Complex
    error: Real  # absolute


def answers_at_nodes(solver: Solver) -> Solver:
    """Return a solver that goes on where it refuses a resonance that takes no part."""

    def solve(question: Question) -> tuple[Complex, Bound]:
        missing = np.zeros(len(question.frequency), dtype=np.bool_)
        lines: list[tuple[Flags, AtNode]] = []
        rest = question
        while not missing.all():
            try:
                found, bound = solver(rest)
                break
            except OnResonance as refusal:
                same = question.frequency == refusal.frequency
                line = _mean(solver, question, refusal.frequency, question.factor[:, same])
                if line is None:
                    raise
                lines.append((same, line))
                missing |= same
                rest = replace(
                    question,
                    frequency=question.frequency[~missing],
                    factor=np.ascontiguousarray(question.factor[:, ~missing]),
                )
        if not lines:
            return found, bound
        shape = len(question.drives), len(question.responses), len(missing)
        value = np.zeros(shape, dtype=np.complex128)
        if not missing.all():
            value[..., ~missing] = found
        for same, line in lines:
            value[..., same] = line.value[..., None]

        def bounded() -> Real:
            error = np.zeros(value.shape)
            if not missing.all():
                error[..., ~missing] = bound()
            for same, line in lines:
                error[..., same] = line.error[..., None]
            return error

        return value, bounded

    return solve


def _mean(solver: Solver, question: Question, frequency: float, factor: Complex) -> AtNode | None:
    """Return the mean on the largest circle that has no pole in it, if there is one."""
    if question.decay:
        return None
    chain = question.model.chain.only(question.component)
    damped = damped_lines(chain, factor).any()
    turned = np.exp(1j * np.multiply.outer(ORDERS, THETA))
    for radius in RADII:
        # growing or decaying, all are alike without damping
        omega = 2 * np.pi * frequency * (1 + radius * np.exp(-1j * THETA))
        asked = replace(
            question,
            frequency=omega.real / (2 * np.pi),
            factor=np.ascontiguousarray(damping.factors(question.model.scene.dampings, omega).T),
        )
        value, bound = solver(asked)
        order = np.abs((value[:, :, None] * turned).mean(axis=-1))
        noise = bound().max(axis=-1)
        beside = order[..., ORDERS < 0].sum(axis=-1) + order[..., -LAST:].sum(axis=-1)
        if (beside <= noise).all():
            mean = value.mean(axis=-1)
            return AtNode(mean if damped else mean.real + 0j, noise + beside)
    return None
