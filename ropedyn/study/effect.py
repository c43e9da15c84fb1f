"""What effects cost: time and change of the answer with each effect of a scene and without."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ask.forced import FRFQuestion, StaticQuestion, SteppedSineQuestion
from ..ask.free import CountQuestion, ModesQuestion
from ..ask.many import FamilyQuestion
from ..ask.question import AnyQuestion
from ..base import check
from ..base.answer import Answer, Cost, axes
from ..base.array import Flags, Integer, Real
from ..base.errors import SceneError
from ..base.progress import Progress, reporter
from ..base.table import Table, numbers
from ..experiment.compare.difference import AnswerChange
from ..scene.scene import Scene
from ..scene.tension import Tension
from . import effect_words as words
from .way import Way, answered, check_question, priced

LINEAR = (ModesQuestion, CountQuestion, FamilyQuestion, FRFQuestion, StaticQuestion)
"""Questions about small motion around a mean tension."""


@dataclass(frozen=True, eq=False)
class EffectCost(Answer):
    """What each effect of a scene costs, and what it changes; made by `effect_cost`.

    Attributes
    ----------
    question : str
        What was asked.
    way : str
        By which elements and solver.
    elements : int
        Of the chain, or continuous spans.
    effect : ndarray of str, shape (rows,)
        One row for each effect of the scene, in the order of `Scene.effects`.
    change : dict of ndarray, shape (rows,)
        What leaving the effect out changes. Of modes ``"largest [Hz]"``, ``"rms [Hz]"``, ``"largest
        [%]"`` and ``"rms [%]"``, of frequencies; where motion grows -growth/2 pi is the frequency.
        Each mode is compared with that of the same order among those of the same motion:
        transverse, torsional, axial, of a resonator or of a broken wire. And ``"damping ratio
        [1]"``, of any. Of a frequency response ``"largest [dB]"`` and ``"median [dB]"``, of the
        level |20 log10(without/with)| of all lines, and ``"peak shift [Hz]"``, from the largest
        peak to the nearest one without the effect, where that has the same number; and ``"phase
        [deg]"``, by which a line turns at the most. Of motion over time ``"largest [%]"``, ``"rms
        [%]"`` of all times and ``"peak [%]"``, of the largest value, in percent of that. Else
        ``"largest [%]"`` and ``"rms [%]"`` of all values. NaN where there is nothing to compare.
    error : ndarray, shape (rows,)
        Error bars of both answers, of mesh and rounding, where the change is largest [Hz, dB, %];
        infinite where none are known, as those of a chain that is not linear.
    changed : ndarray of str, shape (rows,)
        What it changes by more than the error bars that are known, such as ``"frequency, damping
        ratio"``, ``"level, phase"``, ``"motion"`` or ``"answer"``; empty where nothing.
    beyond_error : ndarray of bool, shape (rows,)
        Whether that is more than all error bars, or modes or responses are only there with it.
    seen : ndarray of bool, shape (rows,)
        False: no answer to such a question can tell, as modes of a tension that pulsates.
    goes_along : ndarray of str, shape (rows,)
        Which other effects leave with it, as lay, rotary inertia and hinges with bending.
    only_with : ndarray of int, shape (rows,)
        How many of the modes are only there with the effect; how many responses are 0 without.
    unsure : ndarray of int, shape (rows,)
        How many damped modes or multipliers could have another partner without the effect; error
        bars have both.
    seconds_with, lower_quartile_with, upper_quartile_with : float
        Processor time from the scene to the answer, `Scene.compile` and the question, one thread:
        the median and, of the question, the quartiles [s]; of modes that of frequencies.
    seconds_without, lower_quartile_without, upper_quartile_without : ndarray, shape (rows,)
        The same without the effect [s].
    unknowns_with : int
        Of what was solved; of continuous spans those at stations.
    unknowns_without : ndarray of int, shape (rows,)
        The same without the effect; 0 where there is no answer.
    refusal : ndarray of str, shape (rows,)
        Why there is no answer without the effect, or empty; numbers of such rows are NaN or 0.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=0.5)
    >>> cost = rd.effect_cost(rd.Scene(rope, tension=100.0), rd.ask.modes(1), repeat=1)
    >>> cost.effect.tolist(), cost.largest.round(3), cost.cost.method
    (['tension', 'bending'], array([10.893,  3.044]), 'trials')
    >>> print(cost.verdict.partition(". ")[0])
    For 1 modes what matters is tension (10.9 Hz) and bending (3.04 Hz)
    >>> cost.matters.tolist(), bool((cost.per_second > 0).all())
    (['yes: frequency', 'yes: frequency'], True)
    >>> cost.share.shape, len(cost.share_quartiles), len(cost.costs)
    ((2,), 2, 2)
    """

    said = ("verdict",)

    question: str
    way: str
    elements: int
    effect: NDArray[np.str_] = field(metadata=axes("row"))
    change: dict[str, Real] = field(metadata=axes("row", keyed=True))
    error: Real = field(metadata=axes("row"))
    changed: NDArray[np.str_] = field(metadata=axes("row"))
    beyond_error: Flags = field(metadata=axes("row"))
    seen: Flags = field(metadata=axes("row"))
    goes_along: NDArray[np.str_] = field(metadata=axes("row"))
    only_with: Integer = field(metadata=axes("row"))
    unsure: Integer = field(metadata=axes("row"))
    seconds_with: float
    lower_quartile_with: float
    upper_quartile_with: float
    seconds_without: Real = field(metadata=axes("row", unit="s"))
    lower_quartile_without: Real = field(metadata=axes("row", unit="s"))
    upper_quartile_without: Real = field(metadata=axes("row", unit="s"))
    unknowns_with: int
    unknowns_without: Integer = field(metadata=axes("row"))
    refusal: NDArray[np.str_] = field(metadata=axes("row"))

    @property
    def largest(self) -> Real:
        """The largest change, of frequency [Hz], level [dB] or motion [%], shape (rows,)."""
        return next(iter(self.change.values()))

    @property
    def share(self) -> Real:
        """Which share of the time the effect takes, negative where it saves time, shape (rows,)."""
        return 1 - self.seconds_without / self.seconds_with

    @property
    def share_quartiles(self) -> tuple[Real, Real]:
        """Least and largest share of the time by the quartiles of both, each shape (rows,)."""
        return (
            1 - self.upper_quartile_without / self.lower_quartile_with,
            1 - self.lower_quartile_without / self.upper_quartile_with,
        )

    @property
    def costs(self) -> NDArray[np.str_]:
        """What the scene costs with the effect: "more", "less", "the same" (quartiles overlap).

        Shape (rows,); empty where there is no answer without it.
        """
        least, most = self.share_quartiles
        told = np.where(least > 0, "more", np.where(most < 0, "less", "the same"))
        return np.where(self.refusal == "", told, "")

    @property
    def cost(self) -> Cost:
        """What all the trials took together: a pass over each, without the repetitions."""
        return Cost(
            seconds=float(self.seconds_with + np.nansum(self.seconds_without)),
            method="trials",
            elements=self.elements,
            unknowns=self.unknowns_with,
        )

    @property
    def per_second(self) -> Real:
        """The largest change over the time that the effect takes, shape (rows,).

        Of times that the quartiles do not tell apart at least what they leave open.
        """
        spread = self.upper_quartile_without - self.lower_quartile_without
        least = (self.upper_quartile_with - self.lower_quartile_with + spread) / 2
        taken = np.maximum(self.seconds_with - self.seconds_without, least)
        return self.largest / np.maximum(taken, np.finfo(float).eps)

    @property
    def matters(self) -> NDArray[np.str_]:
        """Whether each effect changes the answer, in words such as ``none beyond rounding``."""
        return np.array(
            [words.matters(self, row) for row in range(len(self.effect))], dtype=np.str_
        )

    @property
    def verdict(self) -> str:
        """Two sentences: which effects matter for this question, and which are paid for nothing."""
        return words.verdict(self)

    def report(self) -> str:
        """Return the verdict, and the table under it.

        Examples
        --------
        >>> import ropedyn as rd
        >>> cost = rd.effect_cost(rd.Scene(rd.Rope(1.0, 0.1), tension=9.0), rd.ask.modes(1))
        >>> cost.report().startswith(cost.verdict)
        True
        """
        return f"{self.verdict}\n\n{self.table()}"

    def table(self) -> Table:
        """Return a row for each effect that is left out, after one for the whole scene."""
        unit = next(iter(self.change)).partition(" ")[2]
        asked = self.refusal == ""
        columns: dict[str, Any] = {
            "left out": ("nothing", *self.effect.tolist()),
            "changes the answer": (None, *self.matters.tolist()),
            "goes along": (None, *(text or None for text in self.goes_along.tolist())),
            **{name: (None, *numbers(change)) for name, change in self.change.items()},
            f"error bars {unit}": (None, *numbers(self.error)),
            "only with it": (None, *_where(asked, self.only_with)),
            "partner open": (None, *_where(asked, self.unsure)),
            "effect costs": (None, *(text or None for text in self.costs.tolist())),
            "share of time [%]": (None, *numbers((100 * self.share).round(1))),
            "time [s]": (self.seconds_with, *numbers(self.seconds_without)),
            "lower quartile [s]": (self.lower_quartile_with, *numbers(self.lower_quartile_without)),
            "upper quartile [s]": (self.upper_quartile_with, *numbers(self.upper_quartile_without)),
            "unknowns": (self.unknowns_with, *_where(asked, self.unknowns_without)),
        }
        if not asked.all():
            columns["refused"] = (None, *(text or None for text in self.refusal.tolist()))
        return Table.of(f"{self.question}, {self.way}: what each effect changes and costs", columns)


def effect_cost(
    scene: Scene,
    question: AnyQuestion,
    *,
    elements: int | None = None,
    element: str | None = None,
    solver: str | None = None,
    repeat: int = 7,
    progress: Progress = None,
) -> EffectCost:
    """Measure what each effect of a scene costs, and how it changes the answer of a question.

    The question is put to the scene and to ``scene.without(effect)``, for each of its effects.

    Parameters
    ----------
    scene : Scene
        What is asked about.
    question
        Any of ``rd.ask``, such as ``rd.ask.modes(10)``, ``rd.ask.modes(10, damped=True)`` or
        ``rd.ask.static({("z", 0.5): 10.0})``. Parts that are not linear are priced by ``motion``
        and ``stepped_sine``, a tension that pulsates by ``motion`` and ``floquet``.
    elements, element
        As in `Scene.compile`: continuous spans where left out.
    solver : str, optional
        ``"sweep"`` where left out, ``"lapack"``, for a frequency response also ``"band"``; of
        motion over time one of the methods of `Model.transient`, ``"auto"`` where left out.
    repeat : int
        How often each is timed, in turns, as in `accuracy_cost`.
    progress : None, True or callable
        True prints, a callable takes, the fraction that is done.

    Returns
    -------
    EffectCost
        Where nothing is left to ask without an effect, as its coordinate, a row has the reason.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning, or the question has no answer.
    SolveError
        If the scene with all its effects has no answer.

    Examples
    --------
    A mass m in the middle of a string halves its first frequency: cot(x) = x m/(mu L) at pi/4.

    >>> import math
    >>> import ropedyn as rd
    >>> mass = rd.PointMass(0.5, 0.1 * 4 / math.pi)
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[mass])
    >>> cost = rd.effect_cost(scene, rd.ask.modes(1), repeat=1)
    >>> cost.effect.tolist()
    ['tension', 'point mass']
    >>> cost.change["largest [%]"].round(9).tolist()
    [nan, 100.0]
    >>> print(cost.refusal[0][:53])
    rope must have a stiffness or the scene a tension: te
    """
    check_question(scene, question)
    solver = question.solvers[0] if solver is None else solver
    check.one_of(solver, "solver", question.solvers)
    check.count(repeat, "repeat", most=10_000)
    report = reporter(progress)
    how = {"elements": elements, "element": element}
    whole = answered(question, question.placed(scene), how, solver)
    attempts = [partial(_without, whole, scene, effect) for effect in scene.effects]
    nothing = _numbers(AnswerChange.unknown(question.measures), 0)
    columns, times = priced(attempts, nothing, repeat, report, whole)
    middle, lower, upper = (
        times.compile_seconds + part
        for part in (times.seconds, times.lower_quartile, times.upper_quartile)
    )
    return EffectCost(
        question=str(question),
        way=str(whole),
        elements=len(whole.model.x) - 1,
        effect=np.array(scene.effects),
        seen=np.array([sees(question, effect) for effect in scene.effects]),
        goes_along=np.array([_along(scene, one) for one in scene.effects], dtype=np.str_),
        change={name: columns.pop(name) for name in question.measures},
        seconds_with=float(middle[0]),
        lower_quartile_with=float(lower[0]),
        upper_quartile_with=float(upper[0]),
        seconds_without=middle[1:],
        lower_quartile_without=lower[1:],
        upper_quartile_without=upper[1:],
        unknowns_with=whole.unknowns,
        **columns,
    )


def sees(question: AnyQuestion, effect: str) -> bool:
    """Whether any answer to a question can tell an effect: small motion knows a mean tension."""
    blind = isinstance(question, LINEAR) and not isinstance(question, SteppedSineQuestion)
    return not (blind and effect in (Tension.pulsating, Tension.growing))


def _along(scene: Scene, effect: str) -> str:
    """Name the other effects that a scene does not have without one."""
    try:
        left = scene.without(effect).effects
    except SceneError:
        return ""
    return ", ".join(one for one in scene.effects if one != effect and one not in left)


def _without(whole: Way, scene: Scene, effect: str) -> tuple[Way, dict[str, Any]]:
    """Ask what is left of a scene without an effect."""
    question = whole.question
    left = Way.of(question, question.placed(scene.without(effect)), whole.how, whole.solver)
    change = question.change(whole.answer, left.model, solver=whole.solver)
    return left, _numbers(change, left.unknowns)


def _numbers(change: AnswerChange, unknowns: int) -> dict[str, Any]:
    """Return the cells of a row."""
    return change.size | {
        "error": change.error,
        "changed": ", ".join(change.changed),
        "beyond_error": change.beyond_error,
        "only_with": change.lost,
        "unsure": change.unsure,
        "unknowns_without": unknowns,
    }


def _where(asked: Flags, values: Integer) -> tuple[int | None, ...]:
    """Return whole numbers for a column, None where there is no answer."""
    return tuple(value if there else None for there, value in zip(asked, values.tolist()))
