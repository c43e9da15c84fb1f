"""What is asked of steady states, checked once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...base import check
from ...base.answer import Cost
from ...base.array import Complex, Flags, Real
from ...base.errors import SceneError
from ...base.progress import reporter
from ...base.unit import QUANTITIES, push_unit
from ...chain.compiled import Compiled
from ...chain.place import observed, points
from ...chain.port import Point
from ...response.frf import FRF, MeshOfResponse, RoundingOfResponse
from ...response.harmonic import mesh_of_frf
from ...scene.damping import having
from ..request import STRAIGHT, refuse_held, why_not_linear

LEAST = 1e-100  # Of amplitudes and frequencies: squares of motion are numbers.


@dataclass(frozen=True, eq=False)
class SteppedSine:
    """Steady states at frequencies, as solvers are asked for them; see `Model.stepped_sine`."""

    model: Compiled  # that is driven
    frequency: Real  # (f,) in the order they are stepped through [Hz]
    drive: Point  # what moves by, or is pushed with, amplitude cos(omega t)
    amplitude: float  # [N, N m; m, rad of an end]
    responses: tuple[Point, ...]  # what is watched
    quantity: str  # of the answer
    tolerance: float | None  # of the steady state, relative
    progress: Callable[[float], Any]  # takes the fraction that is done

    @classmethod
    def of(
        cls,
        model: Compiled,
        frequency: Any,
        *,
        drive: Any,
        amplitude: float,
        response: Any,
        quantity: str,
        tolerance: float | None,
        progress: Any,
    ) -> SteppedSine:
        """Check what is asked."""
        check.one_of(quantity, "quantity", QUANTITIES)
        given = check.optional(tolerance, "tolerance", sign="positive")
        drives, several = points(model, drive, "drive", forces=False, ends=True)
        if several:
            raise SceneError(f"drive must be one point, got {len(drives)}")
        f = check.frequencies(frequency)
        if f.min() < LEAST:
            least = float(f.min())
            raise SceneError(
                f"frequency must be at least {LEAST:g} Hz, got {least!r}: at 0 that is `static`"
            )
        refuse_held(model, STRAIGHT, drives, "drive")
        for one in having(model.scene.dampings, "loss"):
            raise SceneError(
                "damping must be in proportion to velocity, such as StiffnessDamping(gamma) with "
                f"gamma = eta/(2 pi frequency), got {one}: a loss factor has no meaning in time"
            )
        unit = push_unit(drives[0])
        pushes = check.number(amplitude, "amplitude", unit, sign="positive")
        if not LEAST <= pushes <= 1 / LEAST:
            raise SceneError(
                f"amplitude must lie in {LEAST:g} ... {1 / LEAST:g} {unit}, got {pushes!r}"
            )
        return cls(
            model,
            f,
            drives[0],
            pushes,
            observed(model, response, drives),
            quantity,
            given,
            progress=reporter(progress),
        )

    def answer(
        self,
        frequency: Real,
        value: Complex,
        error: Real,
        cost: Cost,
        stable: Flags | Callable[[], Flags],
    ) -> FRF:
        """Return steady states per amplitude, (responses, f), with their relative errors."""
        scene, ends = self.model.scene, ((self.drive,), self.responses)
        value = value * (2j * np.pi * frequency) ** QUANTITIES[self.quantity]
        mesh: MeshOfResponse | Callable[[], MeshOfResponse]
        mesh = partial(mesh_of_frf, scene, frequency, *ends, quantity=self.quantity, value=value)
        if self.model.element == "continuous":
            mesh = MeshOfResponse(np.zeros(value.shape))
        elif why_not_linear(self.model):
            mesh = MeshOfResponse(np.full(value.shape, np.inf))
        return FRF(
            *ends,
            quantity=self.quantity,
            frequency=frequency,
            value=value,
            rounding=RoundingOfResponse.of_relative(value, error),
            rounding_bound=error,
            cost=cost,
            mesh=mesh,
            stable=stable,
        )
