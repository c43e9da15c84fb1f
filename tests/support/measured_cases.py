"""Ropes whose tension was measured independently: what was heard of each, and what is identified.

Facts and sources stand in measured_ropes.py. What is known beforehand, by those sources:

cord: six weighings and five lengths of a longer piece (standard deviations of their means), a
    distance between the ends that may be wrong by 1 cm (uniform: 1 cm/sqrt(3)); neither stiffness
    nor friction of the pulley. The instrument shows 0.01 Hz, but resonances were found by hand: no
    ends explain the peaks to that (chi-square 43 of five), so that their noise is estimated.
tubes: 3 mm of length, 0.5 Hz and 10 g, as the author's later experiment has them; two weighings
    of the tube that differ by 3.9e-6 kg/m; a stiffness of 3.766e-3 N m^2 measured and 4.16e-3
    calculated, so that 4e-4 is its standard deviation.
"""

import dataclasses
from collections.abc import Mapping

import numpy as np
from measured_ropes import (
    CORD_FREQUENCY,
    CORD_TENSION,
    STRAW_FREQUENCY,
    STRAW_LENGTH,
    STRAW_TENSION,
    cord,
    straw,
)

import ropedyn as rd

CORD_MASS = 1e-3 * np.array([3.82, 3.83, 3.83, 3.82, 3.84, 3.83])
"""[kg]."""
CORD_PIECE = np.array([1.745, 1.740, 1.743, 1.745, 1.740])
"""[m]."""
STRAW_FREQUENCY_STD = 0.5
"""[Hz]."""
STRAW_TENSION_STD = 9.8 * 0.010
"""[N]."""


@dataclasses.dataclass(frozen=True)
class MeasuredCase:
    """A rope of known tension."""

    name: str
    scene: rd.Scene  # its ends as the source has them, its tension a guess
    peaks: rd.Peaks
    unknown: tuple[str, ...]
    prior: rd.Prior
    tension: float  # [N]
    tension_std: float  # [N]


def mean_std(values):
    """Relative standard deviation of a mean."""
    return values.std(ddof=1) / np.sqrt(len(values)) / values.mean()


def cord_case():
    """The cord, whose tension and stiffness five peaks tell."""
    scene = cord("pinned")
    mass = scene.rope.linear_density
    known = {
        "length": (scene.rope.length, 0.01 / np.sqrt(3)),
        "linear_density": (mass, mass * np.hypot(mean_std(CORD_MASS), mean_std(CORD_PIECE))),
    }
    peaks = rd.Peaks(CORD_FREQUENCY, order=[1, 2, 3, 4, 5])
    unknown = ("tension", "bending_stiffness")
    return MeasuredCase("cord", scene, peaks, unknown, rd.Prior(known), CORD_TENSION, 0.0)


def straw_cases():
    """The tubes, of which one peak tells the tension."""
    found = []
    for length, row in zip(STRAW_LENGTH, STRAW_FREQUENCY):
        for tension, f in zip(STRAW_TENSION.tolist(), row):
            scene = straw(length, 1.0)
            known = {
                "length": (length, 3e-3),
                "linear_density": (scene.rope.linear_density, 3.9e-6),
                "bending_stiffness": (scene.rope.bending_stiffness, 4e-4),
            }
            peaks = rd.Peaks([f], std=STRAW_FREQUENCY_STD, order=[1])
            name = f"tube of {length:g} m, {tension:.2f} N"
            case = (name, scene, peaks, ("tension",), rd.Prior(known), tension, STRAW_TENSION_STD)
            found.append(MeasuredCase(*case))
    return found


ENDS: Mapping[str, dict] = {
    "unknown": {},
    "pinned": {"ends": "given"},
    "clamped": {"ends": "given"},
}
"""What is said of the ends, and what `identify` is told of it beside the scene."""


def identified(case, ends):
    """Identify a case with ends of a name."""
    scene = case.scene.replace(ends=(ends, ends)) if ends in {"pinned", "clamped"} else case.scene
    return rd.identify(scene, case.peaks, case.unknown, prior=case.prior, **ENDS[ends])


@dataclasses.dataclass(frozen=True)
class CaseAnswer:
    """What was identified of a case."""

    case: MeasuredCase
    ends: str
    tension: float  # [N]
    low: float
    high: float

    @property
    def inside(self):
        """Whether the 95 % interval holds the tension."""
        return self.low <= self.case.tension <= self.high

    @property
    def reached(self):
        """Whether it reaches what the tension may be, 1.96 of its standard deviations to a side."""
        reach = 1.96 * self.case.tension_std
        return self.low - reach <= self.case.tension <= self.high + reach


def answer(case, ends):
    """Return the tension of a case with its 95 % interval."""
    fit = identified(case, ends)
    low, high = fit.interval(0.95)["tension"]
    return CaseAnswer(case, ends, float(fit.value["tension"]), float(low), float(high))


def answers(ends):
    """Return what is identified of every case."""
    return [answer(case, ends) for case in (cord_case(), *straw_cases())]


def table_of(found):
    """Return one row for each answer."""
    columns = {
        "rope": tuple(one.case.name for one in found),
        "peaks": tuple(np.size(one.case.peaks.frequency) for one in found),
        "ends": tuple(one.ends for one in found),
        "tension [N]": tuple(one.case.tension for one in found),
        "identified [N]": tuple(one.tension for one in found),
        "95 % from [N]": tuple(one.low for one in found),
        "to [N]": tuple(one.high for one in found),
        "inside": tuple("yes" if one.inside else "no" for one in found),
        "within the weight's": tuple("yes" if one.reached else "no" for one in found),
    }
    return rd.Table.of("tensions that were measured independently", columns)
