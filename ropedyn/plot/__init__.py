"""Every figure: importing it registers what draws each kind of answer."""

from . import construction, curves, experiment, film, record, shapes, space, study

__all__ = ["construction", "curves", "experiment", "film", "record", "shapes", "space", "study"]
