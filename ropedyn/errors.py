"""The errors of ropedyn: one tree."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .history import History


class RopedynError(Exception):
    """Whatever ropedyn refuses."""


class SceneError(RopedynError, ValueError):
    """What the user gave has no meaning; the message names the argument and its value."""


class SolveError(RopedynError, ArithmeticError):
    """What the numbers refused; the message names the frequency, the mode or the step.

    Attributes
    ----------
    history : History or None
        What `Model.transient` had computed before a step that does not converge.
    """

    history: History | None = None


class IdentifyWarning(UserWarning):
    """What was measured does not tell all that was asked; the message says what it does tell."""
