"""Every figure: importing it registers what draws each kind of answer."""

from . import curves, experiment, film, record, shapes, study

__all__ = ["curves", "experiment", "film", "record", "shapes", "study"]
