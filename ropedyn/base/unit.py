"""Units of coordinates and their forces, and of quantities of pint, which nothing imports."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

UNIT = {"x": "m", "y": "m", "z": "m", "alpha": "rad", "beta": "rad", "gamma": "rad"}
FORCE = {c: f"{'F' if unit == 'm' else 'M'}_{c}" for c, unit in UNIT.items()}
OF_FORCE = {force: coordinate for coordinate, force in FORCE.items()}
"""The coordinate of each internal force."""
FORCE_UNIT = {c: "N" if unit == "m" else "N m" for c, unit in UNIT.items()}
NAME = {
    "x": "axial displacement",
    "y": "transverse displacement in the plane of y",
    "z": "transverse displacement",
    "alpha": "twist",
    "beta": "bending rotation",
    "gamma": "bending rotation in the plane of y",
}
ROLE = {"y": "z", "gamma": "beta"}
"""What the coordinates of the plane of y are in their own plane: both planes look the same."""
FAMILY = {"x": "axial", "z": "transverse", "alpha": "torsional", "beta": "bending rotation"}
FAMILY |= {c: FAMILY[role] for c, role in ROLE.items()}


def own_coordinate(family: str, plane: str) -> str:
    """Return the coordinate that a family of modes in a plane has the most kinetic energy of."""
    return next(c for c, name in FAMILY.items() if name == family and (c in ROLE) == (plane == "y"))


QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}
"""How often each kind of response differentiates the displacement."""
MOTIONS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""How often each kind of motion differentiates the displacement."""
WIRE = "wire"  # A response of this name is the tip of a broken wire, by its number among them.
END = "end"  # A drive of this name is the motion of an end, by its number.


def place(point: tuple[Any, ...]) -> str:
    """Say where a point is, such as ``z at 0.500 m``."""
    name, x = point[:2]
    if name == END:
        return f"{point[2]} of end {x}"
    return f"tip of {name} {x:.0f}" if name == WIRE else f"{name} at {x:.3f} m"


def push_unit(drive: tuple[Any, ...]) -> str:
    """Return the unit of a force at a point, or of the motion of an end."""
    return UNIT[drive[2]] if drive[0] == END else FORCE_UNIT[drive[0]]


def label(
    response: tuple[str, float],
    drive: tuple[Any, ...] | None = None,
    quantity: str = "receptance",
    *,
    power: int = 1,
) -> str:
    """Say what a response is, such as ``z at 0.500 m [m/N]``; per motion of an end ``[m/m]``."""
    return f"{place(response)} [{curve_unit(response, drive, quantity, power=power)}]"


def named(
    responses: Sequence[Any], drives: Sequence[Any], quantity: str, *, power: int = 1
) -> Iterator[tuple[str, int, int]]:
    """Yield the name of each response to each drive with the numbers of both."""
    for d, drive in enumerate(drives):
        for r, response in enumerate(responses):
            more = f" driven in {place(drive)}" if len(drives) > 1 else ""
            yield label(response, drive, quantity, power=power) + more, r, d


def curve_unit(
    response: tuple[str, float], drive: tuple[Any, ...] | None, quantity: str, *, power: int = 1
) -> str:
    """Return the unit of a response such as ``m/N``, of motion over time where nothing drives.

    Per a power of the force.
    """
    name = response[0]
    unit = FORCE_UNIT[OF_FORCE[name]] if name in OF_FORCE else UNIT.get(name, UNIT["z"])
    unit += ("", "/s", "/s^2")[(QUANTITIES | MOTIONS)[quantity]]
    if drive is None:
        return unit
    cause = push_unit(drive)
    per = cause if " " not in cause else f"({cause})"
    return f"{unit}/{per}" if power == 1 else f"{unit}/{per}^{power}"


def power(value: float) -> str:
    """Write a power of ten shortly, such as ``1e-3``."""
    return f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e+")


def duration(seconds: float) -> str:
    """Write a time with two digits, such as ``0.42 ms``."""
    size, unit = (1.0, "s") if seconds >= 1 else (1e-3, "ms") if seconds >= 1e-4 else (1e-6, "us")
    return f"{float(f'{seconds / size:.2g}'):g} {unit}"


def is_quantity(value: object) -> bool:
    """Whether a value is a number, or an array, with a unit of a registry."""
    return hasattr(value, "_REGISTRY") and hasattr(value, "magnitude")


def magnitude(quantity: Any, unit: str) -> Any:
    """Return the number of a quantity in a unit.

    Registries take the radian for 1, so that 1 rad/s, and 1 Hz, is 1/s to them. A frequency in Hz
    is cycles per second: what holds an angle, as rad/s or revolutions per minute, is divided by the
    2 pi of a cycle. A number without unit holds no angle.
    """
    for one in unit.split(" or "):
        try:
            return _IN.get(one, _in)(quantity, one)
        # pint derives its errors from these: other dimension, offset, name that it does not know
        except (TypeError, ValueError, AttributeError):
            continue
    raise ValueError(f"{quantity} is not in {unit}")


def _in(quantity: Any, unit: str) -> Any:
    # to some registries a space before a bracket binds more than a power after it
    return quantity.to(unit.replace(" ", "*")).magnitude


def _in_hertz(quantity: Any, unit: str) -> Any:
    root = quantity.to_root_units()
    if root.units == quantity._REGISTRY.Unit("radian/second"):
        return root.magnitude / (2 * math.pi)
    if root.units == quantity._REGISTRY.Unit("1/second"):
        return root.magnitude
    raise ValueError(f"{quantity} is no frequency")


def _alone(quantity: Any, unit: str) -> Any:
    root = quantity.to_root_units()
    if root.units == quantity._REGISTRY.Unit("dimensionless"):
        return root.magnitude
    raise ValueError(f"{quantity} has a unit")


_IN = {"Hz": _in_hertz, "": _alone}
"""How a quantity becomes a number in a unit that is no plain conversion."""
