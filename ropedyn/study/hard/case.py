"""A hard case: a scene, a question, and its value in 40 digits, from the file of the package."""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import IdentifyWarning, SolveError
from ...curves.peaks import Peaks
from ...eigen.spectrum import in_hertz
from ...experiment.identify.identify import identify
from ...model import Model
from ...scene import toml
from ...scene.scene import Scene

FILE = Path(__file__).with_name("cases.json")
MOST_DIGITS = 53 * np.log10(2.0)  # A double next to the true value keeps so many.

Known = str | Sequence[str]  # A number of many digits, or the real and imaginary part of one.
Ask = Mapping[str, Any]


class Numbers(NamedTuple):
    """What was answered, with absolute bounds: NaN where none is stated."""

    value: Real | Complex
    bound: Real


class Digits(NamedTuple):
    """What an answer kept; see `HardCases`."""

    kept: float
    stated: float
    passed: bool
    refusal: str
    seconds: float


@dataclass(frozen=True)
class HardCase:
    """A case that is hard to keep stable, as `cases.json` has it."""

    name: str
    hard: str  # what makes it hard
    decades: float  # how far apart the scales are that meet, in powers of ten
    digits: float | None  # promised; None: a refusal is
    test: str  # that covers it
    scene: Scene
    compile: Ask  # arguments of `Scene.compile`
    ask: Ask  # the kind of question and its arguments
    value: Sequence[Known]
    refusal: str  # what it says where no number is right
    peer: bool  # whether SciPy has an answer within a second
    how: str  # where the value comes from

    def run(self) -> Digits:
        """Ask, and hold the answer against the value."""
        start = time.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", IdentifyWarning)
                found = QUESTIONS[self.ask["kind"]](self.scene.compile(**self.compile), self.ask)
        except (SolveError, IdentifyWarning) as refusal:
            words, seconds = str(refusal), time.perf_counter() - start
            return Digits(0.0, np.nan, self.refusal in words and not self.value, words, seconds)
        seconds, kept = time.perf_counter() - start, self.kept(found.value)
        exceeded = (self.errors(found.value) > found.bound).any()
        passed = self.digits is not None and kept >= self.digits and not exceeded
        size = np.abs(found.value)
        stated = np.max(found.bound / np.where(size > 0, size, np.inf))
        return Digits(kept, digits_of(float(stated)), passed, "", seconds)

    def errors(self, value: Real | Complex) -> Real:
        """Return how far numbers are from the known ones, exactly subtracted."""
        return np.array([_apart(v, known) for v, known in zip(value.tolist(), self.value)])

    def kept(self, value: Real | Complex) -> float:
        """Return how many digits of the worst of some numbers are right."""
        if not len(value) == len(self.value) > 0:
            return 0.0
        size = np.array([_apart(0.0, known) for known in self.value])
        # motion of 0 Hz is held against the first that is not
        relative = self.errors(value) / np.where(size == 0, size[size > 0].min(), size)
        return digits_of(float(np.nan_to_num(relative, nan=np.inf).max()))


def hard_list() -> list[HardCase]:
    """Read the cases."""
    found = json.loads(FILE.read_text(encoding="utf-8"))
    return [HardCase(**one | {"scene": toml.built(Scene, one["scene"])}) for one in found]


def digits_of(error: float) -> float:
    """Return how many digits a relative error leaves."""
    return float(np.clip(-np.log10(max(error, 1e-99)), 0.0, MOST_DIGITS))


def _apart(value: complex, known: Known) -> float:
    parts = [known] if isinstance(known, str) else known
    given = (value.real, value.imag)
    if not np.isfinite(given).all():
        return float("inf")
    square = sum((Decimal(a) - Decimal(b)) ** 2 for a, b in zip(given, [*parts, "0"]))
    return float(Decimal(square).sqrt())


# --- questions ------------------------------------------------------------------------------------


def _modes(model: Model, ask: Ask) -> Numbers:
    modes = model.modes(ask["number"])
    return Numbers(in_hertz(modes.eigenvalue), modes.rounding_error)


def _rates(model: Model, ask: Ask) -> Numbers:
    modes = model.modes(ask["number"], damped=True)
    return Numbers(modes.eigenvalue, 2 * np.pi * modes.rounding_error)


def _frf(model: Model, ask: Ask) -> Numbers:
    drive, response = tuple(ask["drive"]), tuple(ask["response"])
    frf = model.frf(ask["frequency"], drive=drive, response=response)
    return Numbers(frf.value[0], frf.rounding_limit[0])


def _static(model: Model, ask: Ask) -> Numbers:
    coordinate, x = ask["load"]
    static = model.static({(coordinate, x): 1.0}, unstable=ask.get("unstable", False))
    at = np.abs(static.x - x).argmin(), static.coordinates.index(coordinate)
    if len(model.x) <= 1000:
        bound = static.rounding_bound[at][None]
    else:  # the bound at every node takes longer than the answer
        still = model.frf(0.0, drive=(coordinate, x))
        bound = still.rounding_bound[0] * np.abs(still.value[0])
    return Numbers(static.displacement[at][None], bound)


def _motion(model: Model, ask: Ask) -> Numbers:
    coordinate, x, load = ask["start"]
    history = model.transient(
        [0.0, *ask["time"]],
        start={(coordinate, x): load},
        response=(ask["response"][0], ask["response"][1]),
        tolerance=ask["tolerance"],
    )
    return Numbers(history.value[0, 1:], history.error[0, 1:])


def _tongues(model: Model, ask: Ask) -> Numbers:
    chart = model.stability_map(ask["frequency"], [0.0], modes=ask["modes"])
    edges = chart.boundary(ask["amplitude"]).frequency
    return Numbers(edges, np.full(len(edges), np.nan))


def _count(model: Model, ask: Ask) -> Numbers:
    return Numbers(np.array([float(model.count(below=ask["below"]))]), np.zeros(1))


def _identify(model: Model, ask: Ask) -> Numbers:
    fit = identify(model.scene, Peaks(ask["peaks"], order=[1, 2, 3]), ask["unknown"])
    return Numbers(fit.value[:], fit.std[:])


QUESTIONS: dict[str, Callable[[Model, Ask], Numbers]] = {
    "modes": _modes,
    "rates": _rates,
    "frf": _frf,
    "static": _static,
    "motion": _motion,
    "tongues": _tongues,
    "count": _count,
    "identify": _identify,
}
