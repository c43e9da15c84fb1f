"""Vibration of axially tensed steel ropes.

Describe a rope and what acts on it as a `Scene`, compile it to a `Model`, ask for `modes`, `frf` or
`static`, and compare the answer with a measurement.

Numbers are in SI units, frequencies in Hz. Where pint is installed a quantity of it is taken in any
unit of the dimension.
"""

from functools import partial as _partial
from importlib import import_module as _import_module

import lazy_loader as _lazy_loader

from .base import answer as _answer
from .base import drawing as _drawing
from .base import threads as _threads  # noqa: F401 - by being there

# public names stand in __init__.pyi alone, and each is imported when it is first used
__getattr__, __dir__, __all__ = _lazy_loader.attach_stub(__name__, __file__)
__version__ = "0.2.0"

# what those on lower floors ask for by name, and do not know
_answer.named = __getattr__
_drawing.load = _partial(_import_module, "ropedyn.plot")
