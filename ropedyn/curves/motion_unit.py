"""Units that measured motion per force comes in."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..base.errors import SceneError
from ..base.unit import END, FORCE_UNIT, OF_FORCE, QUANTITIES, UNIT

STANDARD_GRAVITY = 9.80665  # [m/s^2]
SIZE = {
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048},
    "rad": {"rad": 1.0, "mrad": 1e-3, "urad": 1e-6, "deg": math.pi / 180},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "kgf": STANDARD_GRAVITY, "lbf": 4.4482216152605},
    "N m": {"N.m": 1.0, "Nm": 1.0, "mN.m": 1e-3, "kN.m": 1e3},
}
"""Units of each dimension in SI; the pound is 0.45359237 kg (1959)."""
RATES = ("", "/s", "/s2")  # How often something is differentiated.
EXAMPLES = '"m/N", "mm/s/N", "m/s^2/N", "g/N", "rad/(N m)"'


class Unit(NamedTuple):
    """Of one side of a ratio, in SI."""

    dimension: str  # a key of `SIZE`
    order: int  # how often it is differentiated
    size: float


def _table() -> dict[str, Unit]:
    rated = {
        name + rate: Unit(dimension, order, size)
        for dimension, units in SIZE.items()
        for name, size in units.items()
        for order, rate in enumerate(RATES)
    }
    aliases = {name + "/s/s": rated[name + "/s2"] for units in SIZE.values() for name in units}
    gravity = Unit("m", 2, STANDARD_GRAVITY)
    return rated | aliases | {"g": gravity, "gn": gravity}


KNOWN = _table()  # Units that `side` knows, with their rates.


def side(text: str) -> Unit | None:
    """Return what one side of a ratio is, such as ``mm/s^2``, or None if that is not known."""
    return KNOWN.get(_plain(text))


def ratio(text: str) -> tuple[Unit, Unit] | None:
    """Return both sides of a unit such as ``(m/s^2)/N``, or None if that is not known."""
    above, slash, below = _plain(text).rpartition("/")
    over, under = KNOWN.get(above), KNOWN.get(below)
    return (over, under) if slash and over and under else None


def _plain(text: str) -> str:
    """Write a unit in one way: ``m/s2``, ``N.m``, no brackets."""
    for old, new in (("²", "2"), ("µ", "u"), ("μ", "u"), ("**", "^"), ("·", "."), ("*", ".")):
        text = text.replace(old, new)
    text = "".join(c for c in " ".join(text.split()) if c not in "^()[]")
    return text.strip().replace(" / ", "/").replace(" ", ".")


def stated(text: str, name: str = "unit") -> tuple[Unit, Unit]:
    """Return both sides of a unit that the user gave."""
    if not isinstance(text, str):
        raise TypeError(f"{name} must be a unit such as {EXAMPLES}, got {text!r}")
    found = ratio(text)
    if found is None:
        raise SceneError(f"{name} must be motion per force such as {EXAMPLES}, got {text!r}")
    return found


def scale(
    sides: tuple[Unit, Unit], response: tuple[str, float], drive: tuple[object, ...], name: str
) -> tuple[str, float]:
    """Return which quantity numbers in a unit are, and what they are to be multiplied by."""
    over, under = sides
    expected = dimensions(response, drive)
    if (over.dimension, under.dimension) != expected or under.order:
        raise SceneError(
            f"{name} must be {expected[0]} (per s, s^2) per {expected[1]} for the response "
            f"{response!r} to {drive!r}, got {over.dimension} per "
            f"{under.dimension}{RATES[under.order]}"
        )
    quantity = next(word for word, order in QUANTITIES.items() if order == over.order)
    return quantity, over.size / under.size


def dimensions(response: tuple[str, float], drive: tuple[object, ...]) -> tuple[str, str]:
    """Return the SI units of a response and of what drives it."""
    name, cause = response[0], str(drive[0])
    above = FORCE_UNIT[OF_FORCE[name]] if name in OF_FORCE else UNIT.get(name, UNIT["z"])
    return above, UNIT[str(drive[2])] if cause == END else FORCE_UNIT[cause]
