"""The errors of ropedyn: one tree."""


class RopedynError(Exception):
    """Whatever ropedyn refuses."""


class SceneError(RopedynError, ValueError):
    """What the user gave has no meaning; the message names the argument and its value."""


class SolveError(RopedynError, ArithmeticError):
    """What the numbers refused; the message names the frequency, the mode or the step."""
