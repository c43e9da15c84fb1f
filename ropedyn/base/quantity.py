"""Numbers with units, as pint has them, in the units of an argument. Nothing imports pint."""

from __future__ import annotations

import math
from typing import Any


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
    return quantity.to(unit).magnitude


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
"""Units that are no plain conversions."""
