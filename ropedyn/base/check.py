"""Checks of what users give: each names the argument, what was expected and what was given."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Collection, Sequence
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import SceneError
from .unit import END, OF_FORCE, ROLE, UNIT, WIRE, is_quantity, magnitude

COORDINATES = tuple(UNIT)
"""Coordinates of a node in their fixed order: axial, transverse, twist, bending rotation."""

NEAR = 1e-9  # Positions closer than this part of the length are one node.

MOST_WIRES = 1_000_000  # A scene that is not known yet may have so many broken wires.

HIGHEST = 1e150  # Frequencies [Hz] are at most this, so that their squares do not overflow.

SIGNS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "any": ("", lambda value: True),
    "nonzero": (" other than 0", lambda value: value != 0),
    "positive": (" > 0", lambda value: value > 0),
    "nonnegative": (" >= 0", lambda value: value >= 0),
}
"""What a message says of each sign, and whether a number, or each of an array, has it."""


def shown(value: object) -> str:
    """Show a value in a message, on one line and not too long."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # Python does not print the longest whole numbers
        text = f"{type(value).__name__} of too many digits"
    return text if len(text) <= 60 else text[:57] + "..."


def _expected(name: str, what: str, unit: str, value: object) -> str:
    return f"{name} must be {what}{f' [{unit}]' if unit else ''}, got {shown(value)}"


def _plain(quantity: Any, name: str, what: str, unit: str) -> Any:
    """Return the number, or the array, of a quantity of pint in our unit."""
    try:
        return magnitude(quantity, unit)
    except ValueError as error:
        raise SceneError(_expected(name, what, unit, quantity)) from error


def number(value: Any, name: str, unit: str = "", *, sign: str = "any") -> float:
    """Return a finite real number."""
    words, has_sign = SIGNS[sign]
    # floats are nearly all, and the ABC of numbers is slow
    if type(value) is float and math.isfinite(value) and has_sign(value):
        return value
    what = "a finite number" + words
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        if is_quantity(value):
            return number(_plain(value, name, what, unit), name, unit, sign=sign)
        raise TypeError(_expected(name, what, unit, value))
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result) or not has_sign(result):
        raise SceneError(_expected(name, what, unit, value))
    return result


def optional(value: Any, name: str, unit: str = "", *, sign: str = "any") -> float | None:
    """Return a finite real number, or None where there is none."""
    return None if value is None else number(value, name, unit, sign=sign)


def count(value: Any, name: str, *, least: int = 1, most: int) -> int:
    """Return a whole number between two bounds."""
    # as with numbers
    if type(value) is int and least <= value <= most:
        return value
    what = f"a whole number from {least} to {most}"
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Integral):
        raise TypeError(_expected(name, what, "", value))
    result = int(value)
    if not least <= result <= most:
        raise SceneError(_expected(name, what, "", value))
    return result


def one_of(value: Any, name: str, words: Collection[str]) -> str:
    """Return one of the words."""
    if isinstance(value, str) and value in words:
        return value
    what = "one of " + ", ".join(f'"{word}"' for word in words)
    error = SceneError if isinstance(value, str) else TypeError
    raise error(_expected(name, what, "", value))


def instance(value: Any, name: str, types: type | tuple[type, ...], what: str) -> Any:
    """Return an object of the wanted type."""
    if not isinstance(value, types):
        raise TypeError(_expected(name, what, "", value))
    return value


def numbers(value: Any, name: str, unit: str = "", *, sign: str = "any") -> NDArray[np.float64]:
    """Return a new one-dimensional array of at least one finite real number; a number is one.

    Quantities of pint, an array or a list of them, are converted to the unit.
    """
    words, has_sign = SIGNS[sign]
    what = f"a one-dimensional array of finite numbers{words}"
    if is_quantity(value):
        value = _plain(value, name, what, unit)
    elif isinstance(value, (list, tuple)) and any(map(is_quantity, value)):
        if not is_quantity(value[0]):
            raise SceneError(_expected(name, what, unit, value))
        value = [number(one, f"{name}[{k}]", unit) for k, one in enumerate(value)]
    if value is None or isinstance(value, (str, bytes)):
        raise TypeError(_expected(name, what, unit, value))
    if np.ma.is_masked(value):  # what is masked is no number
        value = value.astype(np.float64).filled(np.nan)
    try:
        array = np.atleast_1d(np.asarray(value))
    except (TypeError, ValueError) as error:
        raise SceneError(_expected(name, what, unit, value)) from error
    if array.dtype.kind not in "iuf":
        if array.size == 0:
            raise SceneError(_expected(name, what, unit, value))
        raise TypeError(_expected(name, what, unit, value))
    if array.ndim != 1 or array.size == 0:
        raise SceneError(_expected(name, what, unit, value) + f" of shape {array.shape}")
    array = array.astype(np.float64)
    good = np.isfinite(array) & has_sign(array)
    if not good.all():
        where = int(good.argmin())
        raise SceneError(
            _expected(f"{name}[{where}]", f"a finite number{words}", unit, float(array[where]))
        )
    return array


def matrix(
    value: Any,
    name: str,
    shape: tuple[int, int],
    rows: str,
    kind: type[Any],
    *,
    unit: str = "",
) -> Any:
    """Return a new matrix of finite real or complex numbers; one row may be given alone."""
    what = f"finite numbers of shape {shape}, as {rows}"
    if is_quantity(value):
        value = _plain(value, name, what, unit)
    try:
        array = np.array(value, ndmin=2)
    except ValueError as error:
        raise SceneError(_expected(name, what, "", value)) from error
    if array.size and array.dtype.kind not in ("iufc" if kind is np.complex128 else "iuf"):
        raise TypeError(_expected(name, what, "", value))
    if array.shape != shape or not np.isfinite(array).all():
        raise SceneError(_expected(name, what, "", value) + f" of {array.shape}")
    return array.astype(kind)


def frequencies(value: Any, *, sign: str = "nonnegative") -> NDArray[np.float64]:
    """Return frequencies [Hz] whose squares do not overflow."""
    f = numbers(value, "frequency", "Hz", sign=sign)
    if f.max() > HIGHEST:
        where = int(f.argmax())
        raise SceneError(
            f"frequency[{where}] must be at most {HIGHEST:g} Hz, got {float(f[where])!r}"
        )
    return f


def point(
    value: Any,
    name: str,
    present: Sequence[str],
    length: float | None,
    *,
    forces: bool = False,
    wires: int | None = None,
) -> tuple[str, float]:
    """Return a coordinate and a position, such as ("z", 0.5), on the rope where that is known.

    Internal forces and, out of so many, the tips of wires are allowed where that is said.
    """
    what = 'a coordinate and a position [m] such as ("z", 0.5)'
    if not isinstance(value, (tuple, list)):
        raise TypeError(_expected(name, what, "", value))
    if len(value) != 2:
        raise SceneError(_expected(name, what, "", value))
    names = (*COORDINATES, *OF_FORCE) if forces else COORDINATES
    coordinate = one_of(value[0], f"{name}[0]", names if wires is None else (*names, WIRE))
    if coordinate == WIRE and wires is not None:
        if wires == 0:
            raise SceneError(f"{name} must not ask for a wire: the scene has no BrokenWire")
        return coordinate, count(value[1], f"{name}[1]", least=0, most=wires - 1)
    if OF_FORCE.get(coordinate, coordinate) not in present:
        raise absent(f"{name}[0] must be a coordinate", present, coordinate)
    if length is None:
        return coordinate, number(value[1], f"{name}[1]", "m")
    return coordinate, position(value[1], f"{name}[1]", length)


def absent(must: str, present: Sequence[str], got: str) -> SceneError:
    """Return the error of a coordinate that the scene does not have."""
    across = OF_FORCE.get(got, got) in ROLE and not ROLE.keys() & set(present)
    return SceneError(
        f"{must} the scene has ({', '.join(present)}), got {got!r}"
        + (': y and gamma need planes="both"' if across else "")
    )


def end(value: Any, name: str, present: Sequence[str]) -> tuple[str, int, str]:
    """Return the coordinate of an end that is moved, such as ("end", 0, "z")."""
    if len(value) != 3:
        what = 'an end and a coordinate such as ("end", 0, "z")'
        raise SceneError(_expected(name, what, "", value))
    number = count(value[1], f"{name}[1]", least=0, most=1)
    if value[2] in tuple(ROLE) and value[2] not in present:
        raise absent(f"{name}[2] must be a coordinate", present, value[2])
    return (END, number, one_of(value[2], f"{name}[2]", present))


def is_end(value: Any) -> bool:
    """Whether somebody means an end that is moved."""
    return isinstance(value, (tuple, list)) and len(value) > 0 and value[0] == END


def points(value: Any, name: str, *, forces: bool) -> Any:
    """Return a point, or a tuple of several, of a rope that is not known yet.

    With `forces` internal forces and tips of wires are allowed, without it motion of an end.
    """
    if isinstance(value, (tuple, list)) and len(value) > 0 and not isinstance(value[0], str):
        return tuple(_anywhere(one, f"{name}[{k}]", forces) for k, one in enumerate(value))
    return _anywhere(value, name, forces)


def _anywhere(value: Any, name: str, forces: bool) -> Any:
    """Return a response, or a drive, which may be an end."""
    if not forces and is_end(value):
        return end(value, name, COORDINATES)
    wires = MOST_WIRES if forces else None
    return point(value, name, COORDINATES, None, forces=forces, wires=wires)


def path(value: Any) -> Path:
    """Return the path of a file."""
    instance(value, "path", (str, os.PathLike), "the path of a file")
    return Path(value)


def position(value: Any, name: str, length: float) -> float:
    """Return a position on the rope; within 1e-9 of the length of an end it is that end."""
    x = number(value, name, "m")
    margin = NEAR * length
    if not -margin <= x <= length + margin:
        raise SceneError(
            f"{name} must lie on the rope, between 0 and {length:g} m, got {shown(value)}"
        )
    return min(max(x, 0.0), length)
