"""The general path of modes and counts, also where a closed form would answer."""

from contextlib import contextmanager
from unittest.mock import patch

from ropedyn.eigen import spectrum


@contextmanager
def general_path():
    """Within it nothing is solved in closed form."""
    with (
        patch.object(spectrum, "closed_eigenvalues", lambda *_: None),
        patch.object(spectrum, "closed_count", lambda *_: None),
    ):
        yield
