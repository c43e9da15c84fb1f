"""Where the energy of a sum over modes is."""

from __future__ import annotations

from .errors import SceneError
from .history import Balance
from .transient import Run


def balance(run: Run) -> Balance:
    """Return the energies over time."""
    raise SceneError('method must be "direct" for the energy')
