"""What tension and stiffness the peaks of the 2015 study imply, under each reading of its mass."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import study2015
from ..base import check
from ..base.errors import IdentifyWarning
from ..base.named import Named
from ..base.table import Table
from ..curves.peaks import Peaks
from ..experiment.identify.fit import Fit
from ..experiment.identify.identify import identify
from ..scene.rope import Rope
from ..scene.scene import Scene

CATALOGUE_DENSITY = 0.061
"""Of a 4 mm steel rope, as catalogues have it [kg/m]."""
DENSITIES = {
    "0.13725 kg the whole rope": study2015.MASS / study2015.LENGTH,
    "a 4 mm rope of a catalogue": CATALOGUE_DENSITY,
    "0.13725 kg at each mass": study2015.MASS / study2015.ELEMENT_LENGTH,
}
"""What the study's rope may weigh [kg/m]."""
FITTED = next(iter(DENSITIES.values()))
"""Of the rope that is fitted [kg/m]."""
ENDS = ("clamped", "pinned")
"""How its ends may be held."""
STATED_TENSION = 300.0
"""Stated in one place of the study [N]; in another it is 90 % of the nominal strength."""
UNKNOWN = ("tension", "bending_stiffness")


@dataclass(frozen=True)
class Implied:
    """A tensed beam fitted to three peaks, for each reading of the mass and of the ends.

    Frequencies tell tension and bending stiffness per linear density alone: one fit for each kind
    of ends holds for every density, multiplied by it.
    """

    peaks: Peaks  # of the study
    fits: dict[str, Fit]  # by ends, of the rope that weighs what the first of `DENSITIES` says

    @cached_property
    def intervals(self) -> dict[str, Named]:
        """Intervals of 95 %, as the fits."""
        return {ends: fit.interval(0.95) for ends, fit in self.fits.items()}

    def table(self) -> Table:
        """Return one row for each reading, with intervals of 95 %."""
        readings = [(rope, ends) for rope in DENSITIES for ends in self.fits]
        columns: dict[str, list[object]] = {
            "rope": [rope for rope, _ in readings],
            "ends": [ends for _, ends in readings],
        }
        for path, unit in zip(UNKNOWN, ("N", "N m^2")):
            told = {e: [f.value[path], *self.intervals[e][path]] for e, f in self.fits.items()}
            rows = [DENSITIES[rope] / FITTED * np.array(told[ends]) for rope, ends in readings]
            names = (f"{path} [{unit}]", f"95 % from [{unit}]", f"to [{unit}]")
            columns |= dict(zip(names, np.transpose(rows).tolist()))
        return Table.of("what the peaks imply", columns)

    @property
    def verdict(self) -> str:
        """What they show, with the numbers of the first reading."""
        fit, interval = self.fits[ENDS[0]], self.intervals[ENDS[0]]
        return "\n".join(
            [
                _width(fit, interval),
                _density(fit),
                _rod(*interval["bending_stiffness"]),
                _torsion(fit, float(np.asarray(self.peaks.frequency)[2])),
            ]
        )

    def __str__(self) -> str:
        return f"{self.table()}\n\n{self.verdict}"

    def _repr_html_(self) -> str:
        paragraphs = "".join(f"<p>{line}</p>" for line in self.verdict.split("\n"))
        return self.table()._repr_html_() + paragraphs


def implied(peaks: Peaks) -> Implied:
    """Fit a tensed beam to peaks of the study; see `study2015.implied`."""
    check.instance(peaks, "peaks", Peaks, "Peaks")
    with warnings.catch_warnings():
        # that a stiffness does not show is what the table says
        warnings.simplefilter("ignore", IdentifyWarning)
        fits = {ends: identify(_scene(ends), peaks, UNKNOWN) for ends in ENDS}
    return Implied(peaks, fits)


def _scene(ends: str) -> Scene:
    rope = Rope(study2015.LENGTH, FITTED, bending_stiffness=1.0)
    return Scene(rope, tension=1000.0, ends=(ends, ends))


def _width(fit: Fit, interval: Named) -> str:
    off = 100 * abs(fit.residual / fit.measured).max()
    tension, bending = (interval[path] for path in UNKNOWN)
    return (
        f"A tensed beam meets the peaks within {off:.1f} %. Three peaks for two numbers leave wide "
        f"intervals: {tension[0]:.0f} to {tension[1]:.0f} N and {bending[0]:.2g} to "
        f"{bending[1]:.2g} N m^2 for the first reading."
    )


def _density(fit: Fit) -> str:
    speed = fit.value["tension"] / fit.scene.rope.linear_density
    density = STATED_TENSION / speed
    return (
        f"What they tell is tension over density, {speed:.0f} N m/kg: the {STATED_TENSION:.0f} N "
        f"that the study states would take a rope of {density:.3f} kg/m, "
        f"{100 * density / CATALOGUE_DENSITY:.0f} % of a catalogue's."
    )


def _rod(low: float, high: float) -> str:
    def place(bending: float) -> str:
        return "inside" if low <= bending <= high else "outside"

    rod, stated = study2015.solid_rod_stiffness(), study2015.BENDING_STIFFNESS
    return (
        f"A solid steel rod has {rod:.2f} N m^2, {place(rod)} the interval; the study's "
        f"{stated:.1f} N m^2, {stated / rod:.0f} times as much, is {place(stated)}."
    )


def _torsion(fit: Fit, third: float) -> str:
    modes = study2015.scene().compile().modes(12)
    twist = float(modes.frequency[modes.family == "torsional"][0])
    more = fit.scene.replace(tension=1.1 * fit.scene.mean_tension)
    rise = 100 * (_third(more) / _third(fit.scene) - 1)
    return (
        f"The study's own constants twist at {twist:.0f} Hz, twice {twist / 2:.0f} Hz, which is "
        f"{100 * abs(twist / 2 / third - 1):.1f} % from the third peak. One frequency cannot "
        f"decide, tension can: 10 % more of it raises the transverse mode by {rise:.1f} %, and "
        "torsion not at all."
    )


def _third(scene: Scene) -> float:
    return float(scene.compile().modes(3).frequency[2])
