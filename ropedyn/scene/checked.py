"""What a scene is given, checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..base import check
from ..base.errors import SceneError
from . import damping as _damping
from . import end as _end
from .damping import Damping
from .end import End
from .parts import part as _part
from .parts.node import Part
from .parts.stretch import Stretch
from .tension import Tension

_PART_NAMES = ", ".join(kind.__name__ for kind in _part.KINDS)


def checked_tension(tension: Any) -> float | Tension:
    """Return a tension as a scene keeps it: a number if it is one."""
    if not isinstance(tension, Tension):
        return check.number(tension, "tension", "N")
    alike = tension.is_constant and tension.at == "middle" and tension.friction == 0
    return tension.mean if alike else tension


def checked_ends(ends: Any) -> tuple[str | End, str | End]:
    """Return both ends."""
    what = 'a pair of "clamped", "pinned", "free" or End'
    check.instance(ends, "ends", (tuple, list), what)
    if len(ends) != 2:
        raise SceneError(f"ends must be {what}, got {check.shown(ends)}")
    for i, end in enumerate(ends):
        check.instance(end, f"ends[{i}]", (str, End), "a word or an End")
        if isinstance(end, str):
            check.one_of(end, f"ends[{i}]", _end.NAMED)
    return (ends[0], ends[1])


def checked_damping(damping: Any) -> Damping | tuple[Damping, ...] | None:
    """Return dampings as a scene keeps them."""
    if damping is None or isinstance(damping, _damping.KINDS):
        return damping
    names = " or ".join(kind.__name__ for kind in _damping.KINDS)
    if isinstance(damping, (tuple, list)):
        for i, one in enumerate(damping):
            check.instance(one, f"damping[{i}]", _damping.KINDS, names)
        # one term is itself, none is None
        return tuple(damping) if len(damping) > 1 else (*damping, None)[0]
    raise TypeError(f"damping must be {names}, a tuple of them or None, got {check.shown(damping)}")


def checked_parts(parts: Any) -> tuple[Part | Stretch, ...]:
    """Return the parts as a tuple."""
    if isinstance(parts, (str, bytes, Mapping)) or not isinstance(parts, Iterable):
        raise TypeError(f"parts must be a sequence of {_PART_NAMES}, got {check.shown(parts)}")
    parts = tuple(parts)
    for i, part in enumerate(parts):
        check.instance(part, f"parts[{i}]", _part.KINDS, f"one of {_PART_NAMES}")
    return parts
