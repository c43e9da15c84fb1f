"""Parts that change the rope over a stretch: what each does to the section between two places."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterable, Sequence
from dataclasses import KW_ONLY
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Index, Real
from ...base.errors import SceneError
from ...base.parameter import Description, Pair, number, pair, position
from ..rope import ACROSS, Rope, in_plane, own_number
from ..stations import nearest


class RopeChange(NamedTuple):
    """What a part does to the rope: it is multiplied by factors, then something is added."""

    bending: float = 1.0
    torsion: float = 1.0
    axial: float = 1.0
    lay: float = 1.0
    density: float = 1.0
    across: float = 1.0  # on bending in the plane of y
    linear_density: float = 0.0  # [kg/m]
    polar_inertia: float = 0.0  # [kg m]


FACTORS = slice(0, 6)  # A change begins with its factors; the rest of it is added.

LAY = "lay coupling"  # What a factor on the lay has no meaning without.

FACTOR = {
    "bending_stiffness": "bending",
    "torsional_stiffness": "torsion",
    "axial_stiffness": "axial",
    "lay_coupling": "lay",
    "linear_density": "density",
    "rotary_inertia": "density",
    "polar_inertia": "density",
    ACROSS["bending_stiffness"]: "across",
    ACROSS["rotary_inertia"]: "density",
}
"""The factor on each property of a rope that changes; what is added to one has its name."""


BROKEN = (
    "bending_stiffness",
    "torsional_stiffness",
    "axial_stiffness",
    "lay_coupling",
    "linear_density",
)
"""What broken wires take from a rope, mass only where they fall out."""


class _Between(Description):
    """Base of what changes the rope between two places."""

    acts_on: ClassVar[dict[str, str]] = {}
    """Arguments that have no meaning without a coordinate, or a lay coupling, unless they are 1."""

    start: float = position()
    stop: float = position()

    def _agree(self) -> None:
        if not self.start < self.stop:
            raise SceneError(f"stop must lie beyond start, {self.start!r} m, got {self.stop!r}")


class AddedMass(_Between):
    """Mass that moves with the rope over a stretch: grease, ice, marks.

    Masses that overlap add up. The density of a `LocalChange` at the same place is a factor on the
    rope alone, not on what was added.

    Parameters
    ----------
    start, stop : float
        Where it begins and ends [m].
    linear_density : float
        Mass per length [kg/m]; 0 is allowed.
    polar_inertia : float
        About the rope's axis, per length [kg m].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, the stretch does not end beyond its start, or a mass or inertia
        is negative; in a scene, if the stretch is off the rope or shorter than 1e-9 of it.

    Examples
    --------
    Ice of the rope's own mass all along lowers its frequencies by the square root of 2:

    >>> import ropedyn as rd
    >>> rope = rd.Rope(1.0, 0.1)
    >>> ice = rd.AddedMass(0.0, 1.0, 0.1)
    >>> for parts in [], [ice]:
    ...     print(rd.Scene(rope, tension=80.0, parts=parts).compile().modes(1).frequency.round(3))
    [14.142]
    [10.]
    """

    kind: ClassVar[str] = "added mass"

    linear_density: float = number("kg/m", sign="nonnegative")
    _: KW_ONLY
    polar_inertia: float = number("kg m", sign="nonnegative", default=0.0)

    def change(self) -> RopeChange:
        """Return what is added.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.AddedMass(0.0, 0.5, 0.02).change().linear_density
        0.02
        """
        return RopeChange(linear_density=self.linear_density, polar_inertia=self.polar_inertia)

    def on(self, coordinates: Collection[str]) -> AddedMass:
        """Return itself, on whatever coordinates.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.AddedMass(0.0, 0.5, 0.02).on(["z"])
        AddedMass(start=0.0, stop=0.5, linear_density=0.02, polar_inertia=0.0)
        """
        return self


class LocalChange(_Between):
    """Factors on the rope over a stretch: damage, wear, a splice.

    Factors that overlap multiply. Where a stretch with other stiffness or density begins,
    tensed elements keep their order (`Model.mesh_order`); continuous spans are exact.

    Parameters
    ----------
    start, stop : float
        Where it begins and ends [m].
    bending, torsion, axial, lay : float
        On the rope's bending, torsional and axial stiffness and on its lay coupling; 1 leaves it as
        it is. Of bending a pair, for the planes of z and of y, where the scene has both.
    density : float
        On its linear density, and on its rotary and polar inertia: there is so much more or less
        of the same material. What an `AddedMass` adds stays as it is.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, the stretch does not end beyond its start, or a factor is not
        positive; in a scene, if the stretch is off the rope or shorter than 1e-9 of it, if a
        factor other than 1 stands on a stiffness that the rope does not have, or if the changed
        section is not positive definite; if axial stiffness or lay changes where the tension is
        that of the whole rope's stretch.

    Examples
    --------
    A worn half of a cantilever bends twice as much:

    >>> import ropedyn as rd
    >>> rope = rd.Rope(2.0, 0.1, bending_stiffness=1.0)
    >>> worn = rd.LocalChange(1.0, 2.0, bending=0.5)
    >>> scene = rd.Scene(rope, ends=("clamped", "free"), parts=[worn])
    >>> tip = scene.compile(elements=2).static({("beta", 2.0): 1.0}).displacement[-1, 1]
    >>> print(tip.round(12))
    3.0
    """

    kind: ClassVar[str] = "local change"
    acts_on: ClassVar[dict[str, str]] = {
        "bending": "beta",
        "torsion": "alpha",
        "axial": "x",
        "lay": LAY,
    }

    _: KW_ONLY
    bending: Pair = pair(sign="positive", default=1.0)
    torsion: float = number(sign="positive", default=1.0)
    axial: float = number(sign="positive", default=1.0)
    lay: float = number(sign="positive", default=1.0)
    density: float = number(sign="positive", default=1.0)

    @staticmethod
    def of_broken_wires(
        rope: Rope,
        x: float,
        n: int = 1,
        *,
        friction: float,
        layer: int | tuple[int, int] | None = None,
        bending: str = "stick",
        fallen: bool = False,
    ) -> LocalChange:
        """Return what broken wires take from a rope as far as they do not carry.

        Parameters
        ----------
        rope : Rope
            From `Rope.from_construction`; what it has is changed.
        x : float
            Where the wires are broken [m].
        n : int, optional
            How many wires.
        friction : float
            Coefficient of friction between wires, > 0: it gives back their tension.
        layer : int or (int, int), optional
            Of the wires, as `Section.without` takes it; the outermost where left out.
        bending : {"stick", "slip"}, optional
            Whether wires stick when the rope bends.
        fallen : bool, optional
            Whether the wires are gone and their mass too.

        Returns
        -------
        LocalChange
            From one `Section.recovery` before x to one after it, as far as the rope goes.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If the rope has no section, or as `Section.without` and `Section.recovery` do.

        Examples
        --------
        >>> import ropedyn as rd
        >>> made = rd.Construction.standard("7x7", diameter=4e-3)
        >>> rope = rd.Rope.from_construction(1.35, made)
        >>> change = rd.LocalChange.of_broken_wires(rope, 0.5, friction=0.2)
        >>> round(change.start, 4), round(change.axial, 4), round(change.torsion, 4)
        (0.4567, 0.9803, 0.9789)
        """
        section = check.instance(rope, "rope", Rope, "a Rope").section
        if section is None:
            raise SceneError("rope must be from a construction, got one without a section")
        x = check.position(x, "x", rope.length)
        check.instance(fallen, "fallen", bool, "True or False")
        length = section.recovery(friction=friction, layer=layer)
        left = section.without(n, layer=layer).properties(bending)
        whole, factors = section.properties(bending), {}
        for name in BROKEN if fallen else BROKEN[:-1]:
            if getattr(rope, name) and whole[name]:
                factors[FACTOR[name]] = left[name] / whole[name]
        return LocalChange(max(x - length, 0.0), min(x + length, rope.length), **factors)

    def change(self) -> RopeChange:
        """Return the factors.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.LocalChange(0.0, 0.5, bending=0.9).change().bending
        0.9
        """
        bending, across = in_plane(self.bending, 0), in_plane(self.bending, 1)
        return RopeChange(bending, self.torsion, self.axial, self.lay, self.density, across)

    def on(self, coordinates: Collection[str]) -> LocalChange | None:
        """Return what is left of it on these coordinates, None where that changes nothing.

        What changes the lay is left where "lay coupling" is among them.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.LocalChange(0.0, 0.5, bending=0.9, torsion=0.8).on(["z", "alpha"])
        LocalChange(start=0.0, stop=0.5, bending=1.0, torsion=0.8, axial=1.0, lay=1.0, density=1.0)
        >>> rd.LocalChange(0.0, 0.5, bending=0.9).on(["z"]) is None
        True
        """
        gone = [name for name, what in self.acts_on.items() if what not in coordinates]
        kept: dict[str, Any] = dict.fromkeys(gone, 1.0)
        if "gamma" not in coordinates:
            kept = {"bending": in_plane(self.bending, 0)} | kept
        left = dataclasses.replace(self, **kept)
        return None if left != self and left.change() == RopeChange() else left


Stretch = AddedMass | LocalChange
KINDS = (AddedMass, LocalChange)  # Every kind of part that changes the rope over a stretch.


def changes(stretches: Sequence[Stretch], stations: Real) -> Real:
    """Return what all stretches do together, a `RopeChange` for each span between stations."""
    change = np.empty((len(stations) - 1, len(RopeChange._fields)))
    change[:] = RopeChange()
    starts = nearest(stations, [stretch.start for stretch in stretches])
    stops = nearest(stations, [stretch.stop for stretch in stretches])
    with np.errstate(over="ignore", under="ignore"):
        for stretch, start, stop in zip(stretches, starts, stops):
            amount = np.array(stretch.change())
            change[start:stop, FACTORS] *= amount[FACTORS]
            change[start:stop, FACTORS.stop :] += amount[FACTORS.stop :]
    return change


def ropes(rope: Rope, stretches: Sequence[Stretch], stations: Real) -> tuple[list[Rope], Index]:
    """Return the different ropes between stations, and which of them each span has."""
    if not stretches:
        return [rope], np.zeros(len(stations) - 1, dtype=np.intp)
    change = list(map(tuple, changes(stretches, stations).tolist()))
    distinct = sorted(set(change))
    found = []
    for row in distinct:
        try:
            found.append(_changed(rope, RopeChange(*row)))
        except SceneError as error:
            span = change.index(row)
            raise SceneError(
                f"parts must leave a rope between {stations[span]:g} m and "
                f"{stations[span + 1]:g} m: {error}"
            ) from error
    number = {row: k for k, row in enumerate(distinct)}
    return found, np.array([number[row] for row in change])


def changeable(rope: Rope, coordinates: Sequence[str]) -> tuple[str, ...]:
    """Return the coordinates that a stretch can change, and the lay coupling where there is one."""
    return (*coordinates, LAY) if rope.lay_coupling else tuple(coordinates)


def refuse_uneven(parts: Sequence[object], why: str) -> None:
    """Refuse axial stiffness and lay that are not the same all along."""
    for i, part in enumerate(parts):
        for name in ("axial", "lay"):
            if isinstance(part, LocalChange) and getattr(part, name) != 1:
                got = getattr(part, name)
                raise SceneError(f"parts[{i}].{name} must be 1 {why}, got {got!r}")


def _changed(rope: Rope, change: RopeChange) -> Rope:
    """Return the rope with the change."""
    values: dict[str, Any] = {}
    for name, factor in FACTOR.items():
        own, more = own_number(rope, name), getattr(change, name, 0.0)
        if own is not None or more:
            values[name] = (own or 0.0) * getattr(change, factor) + more
    for name, across in ACROSS.items():
        other = values.pop(across, None)
        if other is not None and other != values[name]:
            values[name] = (values[name], other)
    return rope.replace(**values)


def changed_by(name: str) -> set[str]:
    """Return the properties of a rope that a number of a `RopeChange` acts on."""
    return {of for of, factor in FACTOR.items() if name in (of, factor)}


def rope_rate(change: Real, name: str) -> Real:
    """Return how fast a property of changed ropes grows with that of the rope: by its factor."""
    if name not in FACTOR:
        return np.ones(len(change))
    return change[:, RopeChange._fields.index(FACTOR[name])]


def numbers_of(part: Stretch) -> dict[str, tuple[str, ...]]:
    """Return the numbers of a part, and what each is in its `RopeChange`."""
    names: dict[str, tuple[str, ...]] = {}
    names |= {name: (name,) for name in RopeChange._fields if hasattr(part, name)}
    if not isinstance(part, LocalChange):
        return names
    if not isinstance(part.bending, tuple):
        return names | {"bending": ("bending", "across")}
    del names["bending"]
    return names | {"bending[0]": ("bending",), "bending[1]": ("across",)}


def stretch_rate(rope: Rope, change: Real, part: Stretch, names: Iterable[str]) -> dict[str, Real]:
    """Return how fast properties of changed ropes grow with a number of one of the stretches."""
    rates: dict[str, Real] = {}
    for at in map(RopeChange._fields.index, names):
        if at >= FACTORS.stop:
            return {RopeChange._fields[at]: np.ones(len(change))}
        others, own = change[:, at] / part.change()[at], changed_by(RopeChange._fields[at])
        rates |= {of: others * (own_number(rope, of) or 0.0) for of in own}
    return rates
