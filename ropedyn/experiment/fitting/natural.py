"""Natural frequencies of damped modes, beside those of the undamped ones they come from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SolveError
from ...base.unit import own_coordinate
from ...chain.compiled import Compiled
from ...eigen.damped.damped import solve_damped
from ...eigen.damped.damped_modes import DampedModes
from ...eigen.eigen import solve_modes
from ...eigen.modes import Modes
from ...scene.damping import ModalDamping
from ...scene.scene import Scene

ROUNDING = 1e-9  # Rates whose imaginary part is a smaller share do not oscillate.


class Natural(NamedTuple):
    """Of each undamped mode (k,)."""

    frequency: Real  # |s|/2 pi [Hz]
    damping_ratio: Real
    rounding_error: Real  # bound of it [Hz]


def natural_of(model: Compiled, modes: Modes) -> Natural:
    """Return what damping makes of undamped modes; of those that oscillate no more, nothing."""
    # of each component the k-th that oscillates is the k-th undamped one
    found = Natural(modes.frequency.copy(), modes.damping_ratio.copy(), modes.rounding_bound.copy())
    if not modes.damping_ratio.any():
        return found
    damped = solve_damped(model, len(modes.frequency), below=None, solver="sweep", points=None)
    oscillates = np.flatnonzero(damped.eigenvalue.imag > ROUNDING * np.abs(damped.eigenvalue))
    own = np.where(modes.frequency > 0, _components(model, modes), -1)
    theirs = _components(model, damped)[oscillates]
    for one in range(len(model.components)):
        mine, of = np.flatnonzero(own == one), oscillates[theirs == one]
        both = min(len(mine), len(of))
        mine, of = mine[:both], of[:both]
        found.frequency[mine] = damped.natural_frequency[of]
        found.damping_ratio[mine] = damped.damping_ratio[of]
        found.rounding_error[mine] += damped.rounding_bound[of]
    return found


def is_moved(scene: Scene) -> bool:
    """Whether damping may move natural frequencies: what is said of modes does not."""
    ends = any(not isinstance(end, str) and end.dashpot for end in scene.ends)
    parts = any(getattr(part, "damping", None) for part in scene.parts)
    return ends or parts or any(not isinstance(one, ModalDamping) for one in scene.dampings)


def shift_by_damping(scene: Scene, number: int) -> Real:
    """Return log(natural over undamped frequency) of the lowest modes, 0 where damping is refused.

    0 to rounding where damping is proportional; peaks less this are what undamped modes explain.
    """
    model = scene.compile()
    modes = solve_modes(model, number, below=None, solver="sweep", strict=False)
    try:
        natural = natural_of(model, modes).frequency
    except SolveError:
        return np.zeros(len(modes.frequency))
    moves = modes.frequency > 0
    shift = np.zeros(len(modes.frequency))
    shift[moves] = np.log(natural[moves] / modes.frequency[moves])
    return shift


def _components(model: Compiled, modes: Modes | DampedModes) -> Index:
    """Return which component each mode moves."""
    number = {c: k for k, component in enumerate(model.components) for c in component}
    own = map(own_coordinate, modes.family.tolist(), modes.plane.tolist())
    return np.array([number[c] for c in own], dtype=np.intp)
