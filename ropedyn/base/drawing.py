"""Drawings of answers: who can draw registers by type and verb, an answer asks by what it is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Drawing = TypeVar("Drawing", bound=Callable[..., Any])

_drawings: dict[tuple[type[Any], str], Callable[..., Any]] = {}


def load() -> object:
    """Import what draws; the package puts its own in this place."""
    raise NotImplementedError


def draws(kind: type[Any], verb: str = "plot") -> Callable[[Drawing], Drawing]:
    """Register what draws things of a kind, of those derived from it too."""

    def register(drawing: Drawing) -> Drawing:
        _drawings[kind, verb] = drawing
        return drawing

    return register


def draw(thing: Any, verb: str, *arguments: Any, **options: Any) -> Any:
    """Draw a thing as what it is, else as what it is derived from."""
    load()
    for kind in type(thing).__mro__:
        if (kind, verb) in _drawings:
            return _drawings[kind, verb](thing, *arguments, **options)
    raise NotImplementedError(f"nothing draws a {type(thing).__name__}")
