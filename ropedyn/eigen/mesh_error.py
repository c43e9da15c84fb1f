"""The mesh error of a chain: its distance to the continuous spans of the same scene."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from ..base.array import Complex, Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.compile import compile_scene
from ..chain.port import Point
from ..response import frf
from . import modes

if TYPE_CHECKING:
    from ..chain.compiled import Compiled
    from ..scene.scene import Scene


def mesh_of_modes(
    scene: Scene, components: tuple[tuple[str, ...], ...], which: Index, eigenvalue: Real
) -> modes.UndampedMesh:
    """Compare the modes of a chain with those of continuous spans."""
    error, limit = np.full(len(eigenvalue), np.inf), np.full(len(eigenvalue), np.nan)
    try:
        continuous = compile_scene(scene)
    except SceneError:
        return modes.UndampedMesh(mesh_error=error, limit=limit)
    for k, component in enumerate(components):
        mine = np.flatnonzero(which == k)
        true, uncertain = _lowest(continuous, component, len(mine))
        mine = mine[: len(true)]
        error[mine] = distance(eigenvalue[mine], true, uncertain)
        limit[mine] = np.maximum(in_hertz(true), 0.0)
    return modes.UndampedMesh(mesh_error=error, limit=limit)


def _lowest(model: Compiled, component: tuple[str, ...], number: int) -> tuple[Real, Real]:
    """Return the lowest eigenvalues and their errors [rad^2/s^2].

    None where they are refused or too much for the memory: the chain's own answer stands.
    """
    from .eigen import spectrum

    if number > 0:
        with suppress(SolveError, MemoryError):
            return spectrum(model, component, number)
    return np.zeros(0), np.zeros(0)


def distance(eigenvalue: Real, true: Real, uncertain: Real) -> Real:
    """Return how far frequencies are from true ones, and how uncertain those are [Hz]."""
    from .eigen import error_in_hertz

    return np.abs(in_hertz(eigenvalue) - in_hertz(true)) + error_in_hertz(true, uncertain)


def in_hertz(eigenvalue: Real) -> Real:
    """Return frequencies, and -growth/2 pi where motion grows [Hz]."""
    return np.copysign(np.sqrt(np.abs(eigenvalue)), eigenvalue) / (2 * np.pi)


def mesh_of_frf(
    scene: Scene,
    frequency: Real,
    drives: tuple[Point, ...],
    responses: tuple[Point, ...],
    *,
    quantity: str,
    value: Complex,
) -> frf.Mesh:
    """Compare the response of a chain with that of continuous spans."""
    try:
        true, uncertain = _response(compile_scene(scene), frequency, drives, responses, quantity)
    except SceneError:
        return frf.Mesh(np.full(value.shape, np.inf))
    true, uncertain = true.reshape(value.shape), uncertain.reshape(value.shape)
    size, known = np.abs(value), np.isfinite(true)
    rounding = np.zeros(value.shape)
    np.multiply(uncertain, np.abs(true), out=rounding, where=known & (true != 0))
    relative = np.full(value.shape, np.inf)
    with np.errstate(over="ignore"):  # a value of denormal size
        np.divide(np.abs(value - true) + rounding, size, out=relative, where=known & (size > 0))
    return frf.Mesh(np.where(known & (size == 0) & (true == 0), 0.0, relative))


def _response(
    model: Compiled,
    frequency: Real,
    drives: tuple[Point, ...],
    responses: tuple[Point, ...],
    quantity: str,
) -> tuple[Complex, Real]:
    """Return value and relative error, (drives, responses, f); NaN where there is no answer.

    One frequency without an answer refuses all: halves are asked until it is alone.
    """
    from ..response.harmonic import solve_frf

    try:
        answer = solve_frf(model, frequency, drive=drives, response=responses, quantity=quantity)
        # a sum over modes has an error beside rounding, continuous spans or not
        return answer.value, answer.rounding_error + answer.mesh_error
    except SolveError:
        shape = (len(drives), len(responses), len(frequency))
        if len(frequency) == 1:
            return np.full(shape, np.nan, dtype=np.complex128), np.full(shape, np.nan)
    half = len(frequency) // 2
    parts = [
        _response(model, part, drives, responses, quantity)
        for part in (frequency[:half], frequency[half:])
    ]
    value, error = zip(*parts)
    return np.concatenate(value, axis=2), np.concatenate(error, axis=2)
