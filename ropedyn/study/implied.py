"""What tension and stiffness the peaks of the 2015 study imply, under each reading of its mass."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from ..base import check
from ..base.computed import computed
from ..base.errors import IdentifyWarning
from ..base.named import Named
from ..base.table import Table
from ..curves.peaks import Peaks
from ..experiment.identify.fit import Fit
from ..experiment.identify.identify import identify
from ..scene.scene import Scene

CATALOGUE_DENSITY = 0.061  # of a 4 mm steel rope, as catalogues have it [kg/m]
ENDS = ("clamped", "pinned")  # how the ends of the rope may be held
STATED_TENSION = 300.0  # in one place of the study [N]; in another 90 % of the nominal strength
UNKNOWN = ("tension", "bending_stiffness")


@dataclass(frozen=True)
class Implied:
    """A tensed beam fitted to three peaks, for each reading of the ends; densities scale it."""

    peaks: Peaks  # of the study
    densities: dict[str, float]  # what its rope may weigh [kg/m]
    fits: dict[str, Fit]  # by ends
    own: Scene  # the study's rope
    bending_stiffness: float  # of the study's rope, as printed [N m^2]
    rod_stiffness: float  # of a solid rod as thick [N m^2]

    @computed
    def intervals(self) -> dict[str, Named]:
        """Intervals of 95 %, as the fits."""
        return {ends: fit.interval(0.95) for ends, fit in self.fits.items()}

    def table(self) -> Table:
        """Return one row for each reading, with intervals of 95 %."""
        fitted = self.fits[ENDS[0]].scene.rope.linear_density
        readings = [(rope, ends) for rope in self.densities for ends in self.fits]
        columns: dict[str, list[object]] = {
            "rope": [rope for rope, _ in readings],
            "ends": [ends for _, ends in readings],
        }
        for path, unit in zip(UNKNOWN, ("N", "N m^2")):
            told = {e: [f.value[path], *self.intervals[e][path]] for e, f in self.fits.items()}
            rows = [self.densities[rope] / fitted * np.array(told[ends]) for rope, ends in readings]
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
                self._rod(),
                self._torsion(fit, float(np.asarray(self.peaks.frequency)[2])),
            ]
        )

    def _rod(self) -> str:
        rod, stated, rows = self.rod_stiffness, self.bending_stiffness, self.table().rows
        inside = dict.fromkeys(rope for rope, *_, low, high in rows if low <= stated <= high)
        return (
            f"A solid steel rod has {rod:.2f} N m^2, and no rope has more; the study's "
            f"{stated:.1f} N m^2, {stated / rod:.0f} times as much, is inside the intervals of "
            f"{', '.join(inside) or 'no reading'}{' alone' if inside else ''}."
        )

    def _torsion(self, fit: Fit, third: float) -> str:
        modes = self.own.compile().modes(12)
        twist = float(modes.frequency[modes.family == "torsional"][0])
        more = fit.scene.replace(tension=1.1 * fit.scene.mean_tension)
        third_modes = [scene.compile().modes(3).frequency[2] for scene in (more, fit.scene)]
        rise = 100 * (float(third_modes[0]) / float(third_modes[1]) - 1)
        return (
            f"The study's own constants twist at {twist:.0f} Hz, twice {twist / 2:.0f} Hz, which "
            f"is {100 * abs(twist / 2 / third - 1):.1f} % from the third peak. One frequency "
            "cannot decide, tension can: 10 % more of it raises the transverse mode by "
            f"{rise:.1f} %, and torsion not at all."
        )

    def __str__(self) -> str:
        return f"{self.table()}\n\n{self.verdict}"

    def _repr_html_(self) -> str:
        paragraphs = "".join(f"<p>{line}</p>" for line in self.verdict.split("\n"))
        return self.table()._repr_html_() + paragraphs


def fitted_by_ends(peaks: Peaks, beam: Scene) -> dict[str, Fit]:
    """Fit a tensed beam to peaks, for each kind of its ends."""
    check.instance(peaks, "peaks", Peaks, "Peaks")
    with warnings.catch_warnings():
        # that a stiffness does not show is what the table says
        warnings.simplefilter("ignore", IdentifyWarning)
        return {
            end: identify(beam.replace(ends=(end, end)), peaks, UNKNOWN, ends="given")
            for end in ENDS
        }


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
