"""Parameters of a description: what each is, its unit and sign, declared once, at its field.

A field that is declared here is checked and kept as what it must be when its description is made;
paths to numbers, files and the command line read the same declaration.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, ItemsView, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass
from typing import Any, ClassVar, NamedTuple, dataclass_transform

from . import check

Pair = float | tuple[float, float]  # A number, or one for the plane of z and one for that of y.


class Parameter(NamedTuple):
    """What is declared of a field."""

    check: Callable[[Any, str, Any], Any]  # of value, name and thing: return what is kept, or raise
    unit: str = ""
    turning: str = ""  # the unit on a coordinate that is an angle, where that is another
    is_position: bool = False
    is_late: bool = False  # whether its check asks for other parameters, checked before it
    sign: str = "any"  # of a number, one of `check.SIGNS`

    def units(self) -> tuple[str, ...]:
        """Return the units it can have."""
        return (self.unit, self.turning) if self.turning else (self.unit,)

    def unit_on(self, coordinate: object) -> str:
        """Return the unit on a coordinate."""
        turns = self.turning and coordinate in ("alpha", "beta", "gamma")
        return self.turning if turns else self.unit


def _declared(parameter: Parameter, default: Any, **metadata: Any) -> Any:
    metadata["parameter"] = parameter
    if isinstance(default, dict):
        return dataclasses.field(default_factory=default.copy, metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


def number(
    unit: str = "",
    *,
    turning: str = "",
    sign: str = "any",
    default: Any = MISSING,
    is_position: bool = False,
) -> Any:
    """Declare a number; where its default is None it may be left out."""

    def checked(value: Any, name: str, thing: Any) -> float | None:
        if value is None and default is None:
            return None
        own = parameter.unit_on(thing.coordinate) if turning else unit
        return check.number(value, name, own, sign=sign)

    parameter = Parameter(checked, unit, turning, is_position, bool(turning), sign)
    return _declared(parameter, default)


def pair(unit: str = "", *, sign: str = "any", default: Any = MISSING) -> Any:
    """Declare a number, or one for the plane of z and one for that of y."""

    def checked(value: Any, name: str, thing: Any) -> Pair | None:
        if value is None and default is None:
            return None
        if not isinstance(value, (tuple, list)):
            return check.number(value, name, unit, sign=sign)
        if len(value) != 2:
            what = "a number or a pair of them, for the planes of z and of y"
            raise TypeError(f"{name} must be {what}, got {check.shown(value)}")
        one, other = (check.number(v, f"{name}[{k}]", unit, sign=sign) for k, v in enumerate(value))
        return one, other

    return _declared(Parameter(checked, unit, sign=sign), default)


def position() -> Any:
    """Declare a position along the rope."""
    return number("m", is_position=True)


def numbers(metadata: Mapping[str, Any]) -> Any:
    """Declare a one-dimensional array of numbers that cannot change, by its `answer.axes`."""
    unit = metadata["unit"]

    def checked(value: Any, name: str, thing: Any) -> Any:
        array = check.numbers(value, name, unit)
        array.flags.writeable = False
        return array

    return _declared(Parameter(checked, unit), MISSING, **metadata)


def per_coordinate(unit: str, *, turning: str, sign: str, default: Mapping[str, float]) -> Any:
    """Declare a mapping from coordinates to numbers."""

    def checked(values: Any, name: str, thing: Any) -> PerCoordinate:
        check.instance(values, name, Mapping, "a mapping from coordinates to numbers")
        for key in values:
            check.one_of(key, f"key of {name}", check.COORDINATES)
        return PerCoordinate(
            {
                c: check.number(values[c], f"{name}[{c!r}]", parameter.unit_on(c), sign=sign)
                for c in check.COORDINATES
                if c in values
            }
        )

    parameter = Parameter(checked, unit, turning, sign=sign)
    return _declared(parameter, default)


def one_of(words: Collection[str], *, default: Any = MISSING) -> Any:
    """Declare one of some words."""
    return _declared(Parameter(lambda value, name, _: check.one_of(value, name, words)), default)


def instance(kind: type, what: str, *, default: Any = MISSING) -> Any:
    """Declare an object of a type; where its default is None it may be left out."""

    def checked(value: Any, name: str, thing: Any) -> Any:
        if value is None and default is None:
            return None
        return check.instance(value, name, kind, what)

    return _declared(Parameter(checked), default)


def flag(*, default: bool) -> Any:
    """Declare a truth."""
    return instance(bool, "True or False", default=default)


def given(checked: Callable[[Any], Any], *, default: Any = MISSING) -> Any:
    """Declare what a function of its own checks, and returns as it is kept."""
    return _declared(Parameter(lambda value, *_: checked(value)), default)


def depending(
    checked: Callable[[Any, str, Any], Any],
    unit: str = "",
    *,
    turning: str = "",
    default: Any = MISSING,
) -> Any:
    """Declare what depends on other parameters: a function of value, name and thing checks it."""
    return _declared(Parameter(checked, unit, turning, is_late=True), default)


@dataclass_transform(
    frozen_default=True,
    field_specifiers=(
        number,
        pair,
        position,
        numbers,
        per_coordinate,
        one_of,
        instance,
        flag,
        given,
        depending,
    ),
)
class Description:
    """Base of what users describe: a frozen dataclass of declared parameters, checked when made."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    _parameters: ClassVar[dict[str, Parameter]]
    _positions: ClassVar[tuple[str, ...]]

    def __init_subclass__(cls, **options: bool) -> None:
        super().__init_subclass__()
        dataclass(frozen=True, **options)(cls)
        declared = {
            field.name: field.metadata["parameter"]
            for field in dataclasses.fields(cls)
            if "parameter" in field.metadata
        }
        cls._parameters = dict(sorted(declared.items(), key=lambda item: item[1].is_late))
        cls._positions = tuple(name for name, one in declared.items() if one.is_position)

    def __post_init__(self) -> None:
        own = vars(self)
        for name, parameter in self._parameters.items():
            own[name] = parameter.check(own[name], name, self)
        self._agree()

    def _agree(self) -> None:
        """Refuse parameters that do not go together."""


def parameters(kind: type[Description] | Description) -> dict[str, Parameter]:
    """Return what is declared of each field."""
    return kind._parameters


def positions(kind: type[Description] | Description) -> tuple[str, ...]:
    """Return the names of the fields that are positions along the rope."""
    return kind._positions


def required(kind: type[Description]) -> list[str]:
    """Return the names of the fields without a default."""
    fields = dataclasses.fields(kind)
    return [f.name for f in fields if f.default is MISSING and f.default_factory is MISSING]


class PerCoordinate(Mapping[str, float]):
    """Numbers per coordinate, such as spring stiffnesses; a mapping that cannot change."""

    def __init__(self, values: dict[str, float]) -> None:
        self._values = values

    def __getitem__(self, coordinate: str) -> float:
        return self._values[coordinate]

    def __contains__(self, coordinate: object) -> bool:
        return coordinate in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def items(self) -> ItemsView[str, float]:
        """Return the coordinates with their numbers."""
        return self._values.items()

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return repr(self._values)
