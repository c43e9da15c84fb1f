"""Rows of a family that are compiled and solved one by one."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.array import Complex, Real
from ..eigen.eigen import solve_modes
from ..eigen.modes import Modes
from ..eigen.spectrum import count_modes
from ..response.harmonic import solve_harmonic
from .template import SPRING, Template


def modes_of_row(template: Template, number: int, derivative: bool, row: Real) -> tuple[Any, ...]:
    """Find the modes of a row."""
    modes = _modes(template, number, row)
    each = [modes.frequency, modes.eigenvalue, modes.rounding_bound]
    if derivative:
        each.append(_derivatives(template, modes, row))
    frequency, eigenvalue, error, *slope = (_filled(one, number) for one in each)
    return frequency, eigenvalue, error, modes.certified, *slope


def _modes(template: Template, number: int, row: Real) -> Modes:
    if template.scene.is_spatial:
        return template.spatial(row).modes(number, points=1)
    return solve_modes(template.compiled(row), number, below=None, solver="sweep", strict=False)


def _filled(each: Real, number: int) -> Real:
    """Return so many rows, NaN beyond the last mode of a chain."""
    lacking = [(0, number - len(each)), *[(0, 0)] * (each.ndim - 1)]
    return np.pad(each, lacking, constant_values=np.nan)


def _derivatives(template: Template, modes: Modes, row: Real) -> Real:
    """Return those of the frequencies, shape (k, p)."""
    slopes = [_eigenvalue_slope(path, modes, x) for path, x in zip(template.paths, row)]
    slope = np.stack(slopes, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = slope / (8 * np.pi**2 * modes.frequency[:, None])
    slope[modes.eigenvalue < 0] = 0.0
    slope[modes.eigenvalue == 0] = np.nan
    return slope


def _eigenvalue_slope(path: str, modes: Modes, value: float) -> Real:
    found = SPRING.fullmatch(path)
    if found is None or 0 < value < np.inf:
        return modes.derivative(path, of="eigenvalue")
    if np.isinf(value) or found[2] not in modes.coordinates:
        return np.zeros(len(modes.frequency))
    # d lambda/dk = u^2/m at the end, whether a spring is there or not
    moved = modes.shape[:, -int(found[1]), modes.coordinates.index(found[2])]
    return moved * moved / modes.modal_mass


def count_of_row(template: Template, below: float, row: Real) -> tuple[int]:
    """Count the modes of a row."""
    if template.scene.is_spatial:
        return (template.spatial(row).count(below=below),)
    return (count_modes(template.compiled(row), below),)


def frf_of_row(
    template: Template, frequency: Real, asked: dict[str, Any], row: Real
) -> tuple[Complex, Real]:
    """Compute the response of a row."""
    if template.scene.is_spatial:
        found = template.spatial(row).frf(frequency, **asked)
    else:
        found = solve_harmonic(template.compiled(row), frequency, threads=1, tight=False, **asked)
    return found.value, found.rounding_error
