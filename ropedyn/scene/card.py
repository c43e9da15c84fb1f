"""A scene on a few lines: what a slip of units shows in."""

from __future__ import annotations

import html
import math
import textwrap
from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ..base.check import COORDINATES
from ..base.errors import UnitWarning, warn
from .end import End
from .rope import Rope, own_number
from .tension import Tension

if TYPE_CHECKING:
    from .described import Described

WIDTH = 80  # Characters of a line.
MODULUS, DENSITY = 2.0e11, 7850.0  # Of steel [N/m^2, kg/m^3].
FILLED = 0.6  # So much of a rope's circle is steel.
WIRES = 1e4  # Ropes have no more wires, loose and of one size.
SHORTEST = 10.0  # Of its diameters.
FAR = 3.0  # Beyond what steel allows by so many decades a unit has slipped.
STRENGTH = 2e9  # Of a wire [N/m^2].
MOST_STRESS = 5 * STRENGTH
Card = dict[str, str]
"""Names and what is said of them."""


def card(scene: Described) -> Card:
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
    closed = scene.rope.axis is not None and scene.rope.axis.closed
    told["ends"] = "none" if closed else " and ".join(map(_end, scene.ends))
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


# --- what no steel rope could be ------------------------------------------------------------------


def doubts(scene: Described) -> tuple[str, ...]:
    """Say which numbers steel does not allow, each with the units in which they would be likely."""
    return (*_of_size(scene.rope), *_of_bending(scene.rope), *_of_tension(scene))


def warn_of(scene: Described) -> None:
    """Warn of them."""
    for doubt in doubts(scene):
        warn(doubt, UnitWarning)


def _of_size(rope: Rope) -> tuple[str, ...]:
    if rope.length > SHORTEST * _diameter(rope):
        return ()
    return (f"{_sized(rope)} and {rope.length:g} m long; is it so, in kg/m and m?",)


def _diameter(rope: Rope) -> float:
    """Return that of a rope of steel [m]: pi d^2/4 of which FILLED is steel."""
    return math.sqrt(4 * rope.linear_density / (DENSITY * math.pi * FILLED))


def _sized(rope: Rope) -> str:
    return f"{rope.linear_density:g} kg/m of steel is some {1e3 * _diameter(rope):.3g} mm thick"


def _of_bending(rope: Rope) -> tuple[str, ...]:
    """Hold bending against a solid rod of the rope's diameter and against loose wires."""
    bending = own_number(rope, "bending_stiffness")
    if bending is None:
        return ()
    # decades, which no magnitude overflows: E pi d^4/64 of a rod, E A^2/(4 pi n) of n loose wires
    size = math.log10(MODULUS / (4 * math.pi)) + 2 * (
        math.log10(rope.linear_density) - math.log10(DENSITY)
    )
    above = math.log10(bending) - size + 2 * math.log10(FILLED)
    below = size - math.log10(WIRES) - math.log10(bending)
    if max(above, below) <= FAR:
        return ()
    said = f"10^{above:.1f} times that of a solid rod"
    if below > above:
        said = f"10^{below:.1f} times below that of loose wires"
    check = "is it in N m^2, linear_density in kg/m?"
    return (f"{_sized(rope)}: bending_stiffness is {said}; {check}",)


def _of_tension(scene: Described) -> tuple[str, ...]:
    stress = scene.mean_tension / scene.rope.linear_density * DENSITY
    if abs(stress) <= MOST_STRESS:
        return ()
    return (
        f"tension would stress steel by {stress / 1e9:.3g} GPa, and wires hold some "
        f"{STRENGTH / 1e9:g}; is tension in N, linear_density in kg/m?",
    )
