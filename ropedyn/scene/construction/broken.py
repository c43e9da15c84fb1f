"""Constructions with broken wires, and how far a break reaches."""

from __future__ import annotations

import dataclasses
from typing import Any

from ...base import check
from ...base.errors import SceneError
from .strand import SENSES, Helix, helix

WHAT = "the number of a layer of wires, or of a layer and of one in its strands, such as (0, 1)"


def path_of(construction: Any, value: Any) -> tuple[int, ...]:
    """Return numbers of layers that lead to wires; None means the outermost."""
    if value is None:
        last = len(construction.layers) - 1
        inner = _inside(construction.layers[last]) if construction.layers else ()
        value = (last, len(inner) - 1) if inner else last
    given = value if isinstance(value, (tuple, list)) else (value,)
    layers, path = construction.layers, list[int]()
    for one in given:
        if not layers:
            raise SceneError(f"layer must be {WHAT}, got {check.shown(value)}: there is none")
        path.append(check.count(one, f"layer[{len(path)}]", least=0, most=len(layers) - 1))
        layers = _inside(layers[path[-1]])
    if layers or not path:
        raise SceneError(f"layer must be {WHAT}, got {check.shown(value)}")
    return tuple(path)


def _inside(layer: Any) -> tuple[Any, ...]:
    """Return the layers of the strands of a layer, none of wires."""
    return getattr(layer.element, "layers", ())


def without(construction: Any, n: Any, path: tuple[int, ...]) -> Any:
    """Return a construction without wires of a layer, in one strand where they are in strands."""
    at, *inner = path
    pairs = zip(construction.layers, construction.radii)
    # radii do not change when wires break
    layers = [dataclasses.replace(layer, radius=radius) for layer, radius in pairs]
    gone = check.count(n, "n", most=layers[at].count) if not inner else 1
    left = [layers[at]]
    if inner:
        strand = without(layers[at].element, n, tuple(inner))
        left.append(dataclasses.replace(layers[at], count=1, element=strand))
    if gone == layers[at].count:
        left.pop(0)
    else:
        left[0] = dataclasses.replace(layers[at], count=layers[at].count - gone)
    return dataclasses.replace(construction, layers=[*layers[:at], *left, *layers[at + 1 :]])


def helix_of(construction: Any, path: tuple[int, ...]) -> Helix:
    """Return the helix of the wires of a layer, around their strand where they are in strands."""
    *strands, last = path
    for at in strands:
        construction = construction.layers[at].element
    layer = construction.layers[last]
    return helix(construction.radii[last], layer.lay, SENSES[layer.sense])
