"""The errors of ropedyn: one tree."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from typing import Any


class RopedynError(Exception):
    """Whatever ropedyn refuses.

    Examples
    --------
    >>> import ropedyn as rd
    >>> try:
    ...     rd.Rope(-1.0, 0.1)
    ... except rd.RopedynError as error:
    ...     print(error)
    length must be a finite number > 0 [m], got -1.0
    """


class SceneError(RopedynError, ValueError):
    """What the user gave has no meaning; the message names the argument and its value.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Rope(1.0, 0.1, bending_stiffness=float("nan"))
    Traceback (most recent call last):
    ...
    ropedyn.SceneError: bending_stiffness must be a finite number > 0 [N m^2], got nan
    """


def at_once(*parts: Callable[[], Any]) -> list[Any]:
    """Return what each part answers; what several refuse is one error, a line for each."""
    answers, refused = [], []
    for part in parts:
        try:
            answers.append(part())
        except SceneError as error:
            refused.append(error)
    if len(refused) == 1:
        raise refused[0]
    if refused:
        raise SceneError("\n".join(map(str, refused)))
    return answers


class SolveError(RopedynError, ArithmeticError):
    """What the numbers refused; the message names the frequency, the mode or the step.

    Attributes
    ----------
    history : History or None
        What `Model.transient` had computed before a step that does not converge.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile(elements=2)
    >>> model.modes(5)
    Traceback (most recent call last):
    ...
    ropedyn.SolveError: number must be at most 1, the modes this model has, got 5
    """

    history: Any = None


class IdentifyWarning(UserWarning):
    """What was measured does not tell all that was asked; the message says what it does tell.

    Examples
    --------
    >>> import warnings
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.2), tension=500.0)
    >>> peaks = rd.Peaks([25.0, 50.0], std=0.1, order=[1, 2])
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     fit = rd.identify(scene, peaks, ["tension", "linear_density"])
    >>> told[0].category is rd.IdentifyWarning, len(fit.notes)
    (True, 1)
    """


class ModelWarning(UserWarning):
    """An answer stays with a model that is further off than a thousandth; it is what it was.

    Examples
    --------
    >>> import warnings
    >>> import ropedyn as rd
    >>> rope = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
    >>> model = rd.Scene(rope, tension=1000.0, gravity=rd.Gravity()).compile(elements=8)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     modes = model.modes(1)
    >>> told[0].category is rd.ModelWarning, str(told[0].message).partition(",")[0]
    (True, 'free motion is that of a parabola')
    """


class UnitWarning(UserWarning):
    """A number that no rope could have, as where a unit has slipped; nothing is changed.

    Examples
    --------
    >>> import warnings
    >>> import ropedyn as rd
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     test = rd.BendingTest(0.7, [0.0, 2.0, 4.0], [0.0, 5.0, 10.0])
    >>> print(told[0].message)
    deflection is up to 10 m on a span of 0.7 m: is it in m?
    """


for _error in (RopedynError, SceneError, SolveError, IdentifyWarning, ModelWarning, UnitWarning):
    _error.__module__ = "ropedyn"  # where users find them, and what a traceback says


def warn(message: str, category: type[Warning]) -> None:
    """Warn at the line of whoever called the package, through however many of its functions."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and f"{frame.f_globals.get('__name__')}.".startswith("ropedyn."):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
