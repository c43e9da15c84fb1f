"""Constructions by their catalogue line: names, cores and lays made into layers of wires."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

from ...base import check
from ...base.errors import SceneError
from . import catalogue
from .construction import Construction, Layer
from .wire import Fibre, Wire

STRAND_LAYS, ROPE_LAYS = ("Z", "S"), ("sZ", "zS", "zZ", "sS")
OTHER = {"Z": "S", "S": "Z"}
ROPE_LAY = 6.5  # Lay length of strands per diameter of the rope.
PARALLEL = 8.0  # Of wires per diameter of their strand, where strands lie around a core.
SPIRAL = 9.0  # Of wires per diameter of a strand by itself, or around an equal one.
MOST_GAP = 0.5


class CatalogueLine(NamedTuple):
    """A catalogue line; see `Construction.standard`."""

    name: str
    diameter: float
    core: str | None
    lay: str | None
    lay_length: float | None
    strand_lay: float | None
    scaled: bool
    gap: float
    crossed: bool
    material: dict[str, float]

    def checked(self) -> CatalogueLine:
        """Return it with numbers that have a meaning."""
        check.one_of(self.name, "name", catalogue.NAMES)
        for name in ("scaled", "crossed"):
            check.instance(getattr(self, name), name, bool, "True or False")
        gap = check.number(self.gap, "gap", sign="nonnegative")
        if gap > MOST_GAP:
            raise SceneError(f"gap must be at most {MOST_GAP} of a strand, got {gap!r}")
        return self._replace(
            gap=gap,
            diameter=check.number(self.diameter, "diameter", "m", sign="positive"),
            lay_length=check.optional(self.lay_length, "lay_length", "m", sign="positive"),
            strand_lay=check.optional(self.strand_lay, "strand_lay", "m", sign="positive"),
        )

    def made(self) -> Construction:
        """Return the construction."""
        strands, pattern = self.name.split("x")
        if strands == "1":
            return self._spiral(pattern)
        word = check.one_of("sZ" if self.lay is None else self.lay, "lay", ROPE_LAYS)
        wires, sense = word[0].upper(), word[1]
        lay = ROPE_LAY * self.diameter if self.lay_length is None else self.lay_length
        if strands == "7":
            check.one_of("WSC" if self.core is None else self.core, "core", ("WSC",))
            return self._equal(pattern, lay, wires, sense)
        return self._stranded(int(strands), pattern, lay, wires, sense)

    def _wire(self, diameter: float) -> Wire:
        return Wire(diameter, **self.material)

    def _strand(self, pattern: str, diameter: float, lay: float, sense: str) -> Construction:
        """Return a strand whose layers have one lay."""
        (_, d0, _), *around = catalogue.rows(pattern)
        half = diameter / 2
        layers = [
            Layer(n, self._wire(half * d), lay=lay, sense=sense, radius=half * r)
            for n, d, r in around
        ]
        return Construction(self._wire(half * d0), layers)

    def _spiral(self, pattern: str) -> Construction:
        """Return a strand by itself: each layer has the lay of its own diameter."""
        for name in ("core", "strand_lay"):
            if getattr(self, name) is not None:
                value = check.shown(getattr(self, name))
                raise SceneError(f"{name} must not be given of a {self.name} strand, got {value}")
        sense = check.one_of("Z" if self.lay is None else self.lay, "lay", STRAND_LAYS)
        lay = SPIRAL * self.diameter if self.lay_length is None else self.lay_length
        made = self._strand(pattern, self.diameter, lay, sense)
        layers = []
        for k, (layer, radius) in enumerate(zip(made.layers[::-1], made.radii[::-1])):
            assert isinstance(layer.element, Wire)
            over = 2 * radius + layer.element.bar.diameter
            layers.append(
                dataclasses.replace(
                    layer,
                    lay=lay * over / self.diameter,
                    sense=OTHER[sense] if self.crossed and k % 2 else sense,
                )
            )
        return Construction(made.core, layers[::-1])

    def _equal(self, pattern: str, lay: float, wires: str, sense: str) -> Construction:
        """Return six strands around one like them, all wires equal."""
        size = self.diameter / 3
        strand_lay = SPIRAL * size if self.strand_lay is None else self.strand_lay
        strand = self._strand(pattern, size, strand_lay, wires)
        return Construction(strand, [Layer(6, strand, lay=lay, sense=sense, radius=size)])

    def _stranded(
        self, count: int, pattern: str, lay: float, wires: str, sense: str
    ) -> Construction:
        """Return strands around a core that fills the room they leave."""
        kind = check.one_of("FC" if self.core is None else self.core, "core", catalogue.CORES)
        radius, size = catalogue.placed(count, self.diameter, lay, self.gap)
        strand_lay = PARALLEL * size if self.strand_lay is None else self.strand_lay
        strand = self._strand(pattern, size, strand_lay, wires)
        room = 2 * radius - size
        core: Fibre | Construction = Fibre(room)
        if kind == "WSC":
            core = self._strand(pattern, room, strand_lay * room / size, wires)
        elif kind == "IWRC":
            inner = self._replace(diameter=room, strand_lay=None)
            core = inner._equal("7", ROPE_LAY * room, OTHER[sense], sense)
        layer = Layer(count, strand, lay=lay, sense=sense, radius=radius)
        made = Construction(core, [layer])
        table = catalogue.TABLES.get((self.name, kind))
        return _as_table(made, self.diameter, *table) if self.scaled and table else made


def _as_table(made: Construction, diameter: float, area: float, mass: float) -> Construction:
    """Return wires and radii together in the area of a table, the mass filled up to its own."""
    size = math.sqrt(area * diameter**2 / made.section().area)
    smaller = _sized(made, size)
    missing = 1e4 * mass * diameter**2 - smaller.section().mass
    if missing < 0:
        raise SceneError(
            f"lay_length and density must leave the mass of tables, {1e4 * mass * diameter**2:g} "
            f"kg/m, got {-missing:g} kg/m more: say scaled=False"
        )
    return dataclasses.replace(smaller, filling=missing)


def _sized(thing: Any, size: float) -> Any:
    """Return a thing with its diameters and radii multiplied, its lays kept."""
    if isinstance(thing, (Wire, Fibre)):
        assert thing.diameter is not None
        return dataclasses.replace(thing, diameter=thing.diameter * size)
    if isinstance(thing, Layer):
        assert thing.radius is not None
        return dataclasses.replace(
            thing, element=_sized(thing.element, size), radius=thing.radius * size
        )
    return Construction(_sized(thing.core, size), [_sized(one, size) for one in thing.layers])
