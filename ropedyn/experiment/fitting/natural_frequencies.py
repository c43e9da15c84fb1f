"""Natural frequencies as functions of what is sought, with their exact derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Real
from ...base.errors import RopedynError, SceneError, SolveError
from ...family.family import Family
from .unknown import Unknowns


def vibrating(family: Family, value: Real, count: int) -> tuple[Real, Real]:
    """Find the lowest frequencies of rows that vibrate, (n, count), and their slopes by values.

    Rigid motion and growth are left out; NaN as of `NaturalFrequencies`.
    """
    asked = count
    while True:
        found = family.modes(value, asked, derivative=True, threads=1)
        grows = found.eigenvalue <= 0
        still = int(grows.sum(axis=1).max()) if grows.any() else 0
        if asked >= count + still:
            break
        asked = count + still
    assert found.derivative is not None
    frequency, slope = found.frequency, found.derivative
    if still:
        last = ~(found.eigenvalue > 0)
        order = np.argsort(last, axis=1, kind="stable")[:, :count]
        frequency = np.take_along_axis(np.where(last, np.nan, frequency), order, axis=1)
        slope = np.take_along_axis(slope, order[:, :, None], axis=1)
    return frequency, slope


@dataclass(frozen=True, eq=False)
class NaturalFrequencies:
    """Natural frequencies of scenes with unknown numbers, for rows of variables."""

    unknowns: Unknowns  # what is sought
    family: Family  # of the scenes that differ in it

    @classmethod
    def of(
        cls, unknowns: Unknowns, elements: int | None = None, element: str | None = None
    ) -> NaturalFrequencies:
        """Compile the family; `elements` and `element` as `Scene.compile` takes them."""
        family = unknowns.scene.family(list(unknowns.at_place), elements=elements, element=element)
        return cls(unknowns, family)

    def __call__(self, u: Real, count: int) -> tuple[Real, Real]:
        """Find the lowest, rigid motion and growth left out, shapes (n, count) and (n, count, p).

        NaN beyond the last mode of a chain, and in rows that have no answer.
        """
        value = self.unknowns.value(u)
        if len(u) > 1 and (value == value[0]).all():
            # as at the start of many ropes
            frequency, slope = self(u[:1], count)
            return np.repeat(frequency, len(u), axis=0), np.repeat(slope, len(u), axis=0)
        frequency, slope = vibrating(self.family, self.unknowns.at_places(value), count)
        slope = self.unknowns.of_numbers(slope)
        return frequency, slope * self.unknowns.slope(u)[:, None, :]

    def lowest(self, u: Real, count: int) -> tuple[Real, Real]:
        """Find those of one scene, u of shape (p,), or all there are.

        Raises
        ------
        RopedynError
            If there is no such scene, or its frequencies do not depend on what is sought.
        """
        frequency, slope = self(u[None], count)
        there = ~np.isnan(frequency[0])
        if not there.any():
            raise self._refusal(u, count)
        return frequency[0, there], slope[0, there]

    def refusal(self, u: Real, count: int) -> RopedynError:
        """Say why a scene has not so many."""
        try:
            existing = len(self.lowest(u, count)[0])
        except RopedynError as error:
            return error
        return SolveError(f"the scene must have {count} modes for these orders, got {existing}")

    def _refusal(self, u: Real, count: int) -> RopedynError:
        value = self.unknowns.at_places(self.unknowns.value(u))
        failed = self.family.modes(value[None], count, derivative=True).failed
        error = failed.get(0, SolveError("the scene must have modes that vibrate, got none"))
        for path, i in self.unknowns.at_place.items():
            if isinstance(error, SceneError) and str(error).endswith(f"got {path!r}"):
                return SceneError(
                    f"unknown[{i}] must change natural frequencies, as damping does not, which a "
                    f"whole response tells: {error}"
                )
        return error
