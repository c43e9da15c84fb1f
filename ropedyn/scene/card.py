"""A scene on a few lines: what a slip of units shows in."""

from __future__ import annotations

import html
import math
import textwrap
from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ..base.check import COORDINATES
from .doubt import doubts
from .end import End
from .rope import own_number
from .tension import Tension

if TYPE_CHECKING:
    from .scene import Scene

WIDTH = 80  # Characters of a line.
Card = dict[str, str]
"""Names and what is said of them."""


def card(scene: Scene) -> Card:
    """Say what a scene is, with the string frequency of its mean tension, f = sqrt(T/mu)/(2 L)."""
    rope, tension = scene.rope, scene.mean_tension
    density, length = rope.linear_density, rope.length
    bending = own_number(rope, "bending_stiffness")
    told = {
        "length": f"{length:g} m",
        "mass": f"{density * length:.4g} kg ({density:g} kg/m)",
        "tension": str(scene.tension) if isinstance(scene.tension, Tension) else f"{tension:g} N",
    }
    if scene.is_graded:
        low, high = scene.tension_at([0.0, length])
        told["tension"] = f"{low:g} N at the start, {high:g} N at the end"
    if tension > 0:
        speed = math.sqrt(tension / density)
        told["string"] = f"waves of {speed:.4g} m/s, first frequency {speed / length / 2:.4g} Hz"
    if bending:
        told["T L^2/B"] = f"{tension * length**2 / bending:.4g}"
    told["ends"] = " and ".join(map(_end, scene.ends))
    if scene.parts:
        told["parts"] = _counted(type(part).__name__ for part in scene.parts)
    if scene.dampings:
        told["damping"] = _counted(type(damping).__name__ for damping in scene.dampings)
    told["effects"] = ", ".join(scene.effects)
    if found := doubts(scene):
        told["doubt"] = "; ".join(found)
    return told


def _end(end: str | End) -> str:
    if isinstance(end, str):
        return end
    free = [c for c in COORDINATES if getattr(end, c) == "free"]
    more = [name for name in ("spring", "dashpot", "mass") if getattr(end, name)]
    words = "held" if not free else f"held but for {', '.join(free)}"
    return words if not more else f"{words} with {', '.join(more)}"


def _counted(names: Iterable[str]) -> str:
    return ", ".join(f"{n} {name}" if n > 1 else name for name, n in Counter(names).items())


def card_text(title: str, told: Card) -> str:
    """Return a card as text."""
    wide = max(map(len, told))
    rest = WIDTH - wide - 4
    short = {
        name: textwrap.shorten(value, rest, placeholder=" ...") for name, value in told.items()
    }
    return "\n".join([title, *(f"  {name:{wide}}  {value}" for name, value in short.items())])


def card_html(title: str, told: Card) -> str:
    """Return a card as HTML."""
    rows = "".join(
        f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>"
        for name, value in told.items()
    )
    return f"<table><caption>{html.escape(title)}</caption><tbody>{rows}</tbody></table>"
