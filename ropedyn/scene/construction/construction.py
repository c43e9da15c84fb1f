"""The construction of a rope: layers of wires or strands around a core."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY
from functools import partial
from typing import TYPE_CHECKING, Any

from ...base import check
from ...base.drawing import draw
from ...base.errors import SceneError
from ...base.parameter import Description, depending, given, number, one_of
from .section import Section
from .strand import SENSES, Ring, Strand, helix
from .wire import Fibre, Wire, mere_mass

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_WIRES = 10_000  # In one layer.
ROOM = 0.9  # Neighbours whose centres are nearer than this part of their diameter overlap.


def _element(value: Any) -> Wire | Construction:
    check.instance(value, "element", (Wire, Construction), "a Wire or a Construction")
    if isinstance(value, Construction):
        deep = [layer for layer in value._all_layers if isinstance(layer.element, Construction)]
        if deep:
            raise SceneError(
                "element must be a Wire or a strand whose layers are of wires: no formula knows "
                f"helices in helices in helices, got layers of strands, {check.shown(deep[0])}"
            )
    element: Wire | Construction = value
    return element


class Layer(Description):
    """Wires or strands side by side in helices of one radius.

    Parameters
    ----------
    count : int
        How many.
    element : Wire or Construction
        Each of them; the layers of a strand are of wires.
    lay : float
        Lay length, along the axis that holds the layer [m].
    sense : {"Z", "S"}, optional
        Right-hand or left-hand.
    radius : float, optional
        Of the centre lines [m]; where left out they touch what lies below.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If something is not finite or not positive, or a strand is one of strands.

    Examples
    --------
    >>> import ropedyn as rd
    >>> layer = rd.Layer(6, rd.Wire(3.73e-3), lay=0.115)
    >>> rd.Construction(core=rd.Wire(3.94e-3), layers=[layer]).radii
    (0.003835,)
    """

    count: int = given(partial(check.count, name="count", most=MOST_WIRES))
    element: Wire | Construction = given(_element)
    _: KW_ONLY
    lay: float = number("m", sign="positive")
    sense: str = one_of(SENSES, default="Z")
    radius: float | None = number("m", sign="positive", default=None)


def _core(value: Any) -> Any:
    what = "a Wire, a Fibre, a Construction or None"
    return check.instance(value, "core", (Wire, Fibre, Construction, type(None)), what)


def _layers(value: Any, name: str, construction: Construction) -> tuple[Layer, ...]:
    check.instance(value, name, Sequence, "a sequence of Layer")
    for k, one in enumerate(value):
        check.instance(one, f"{name}[{k}]", Layer, "a Layer")
    layers = tuple(value)
    if not layers and (construction.core is None or isinstance(construction.core, Fibre)):
        raise SceneError("layers must hold wires where the core has none, got none")
    return layers


class Construction(Description):
    """How a rope or a strand is made: a core, and layers around it from inside to outside.

    Strands are constructions, and so may a core be.

    Parameters
    ----------
    core : Wire, Fibre or Construction, optional
        What lies on the axis; nothing where left out.
    layers : sequence of Layer
        From inside to outside.
    filling : float, optional
        Grease and fibre beside those of the core: mass without stiffness [kg/m]. It counts in the
        polar inertia as if it were spread over the circle inside the innermost layer.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If a number is not finite or negative, if there is no wire, or if neighbours in a layer
        overlap by more than a tenth of their diameter.

    Notes
    -----
    Neighbours are taken as circles: 2 r sin(pi/n) of a layer of n on the radius r is at least
    0.9 of their diameter. Contact with what lies below is not checked, for outer layers may lie in
    the valleys of inner ones.

    Examples
    --------
    A strand of seven wires:

    >>> import ropedyn as rd
    >>> strand = rd.Construction(
    ...     core=rd.Wire(3.94e-3), layers=[rd.Layer(6, rd.Wire(3.73e-3), lay=0.115)]
    ... )
    >>> print(strand.section())
    section, wires slide in strands
    quantity                           value
    ---------------------------  -----------
    diameter [m]                      0.0114
    area [m^2]                   7.77552e-05
    mass [kg/m]                     0.621555
    axial stiffness [N]          1.47339e+07
    lay coupling [N m]               9848.97
    torsional stiffness [N m^2]      19.1036
    bending slip [N m^2]             13.4557
    bending stick [N m^2]            103.862
    polar inertia [kg m]         8.83396e-06
    rotary inertia [kg m]        4.42659e-06
    """

    core: Wire | Fibre | Construction | None = given(_core, default=None)
    layers: Sequence[Layer] = depending(_layers, default=())
    _: KW_ONLY
    filling: float = number("kg/m", sign="nonnegative", default=0.0)

    def _agree(self) -> None:
        for k, (layer, radius) in enumerate(zip(self.layers, self.radii)):
            d, between = _diameter(layer.element), 2 * radius * math.sin(math.pi / layer.count)
            if layer.count > 1 and between < ROOM * d:
                raise SceneError(
                    f"layers[{k}].count must leave room for neighbours of {d:g} m, got "
                    f"{layer.count} on the radius {radius:g} m, whose centres are {between:g} m "
                    "apart"
                )

    @property
    def radii(self) -> tuple[float, ...]:
        """Of the centre lines of each layer [m].

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Construction.standard("1x19", diameter=4e-3, lay="Z").radii
        (0.0008, 0.0016)
        """
        below = 0.0 if self.core is None else _diameter(self.core) / 2
        radii = []
        for layer in self.layers:
            half = _diameter(layer.element) / 2
            radius = below + half if layer.radius is None else layer.radius
            radii.append(radius)
            below = max(below, radius + half)
        return tuple(radii)

    @property
    def diameter(self) -> float:
        """Of the circle around it [m].

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Construction(core=rd.Wire(2e-3)).diameter
        0.002
        """
        return float(self.strand.diameter)

    @property
    def _all_layers(self) -> tuple[Layer, ...]:
        """Layers around its axis, those of its core first."""
        inner = self.core._all_layers if isinstance(self.core, Construction) else ()
        return (*inner, *self.layers)

    @property
    def strand(self) -> Strand:
        """The construction as plain numbers, what lies on its axis in one list.

        Examples
        --------
        >>> import ropedyn as rd
        >>> strand = rd.Construction.standard("1x7", diameter=3e-3, lay="Z").strand
        >>> strand.rings[0].n, strand.rings[0].on.radius
        (6, 0.001)
        """
        core = Strand((), ())
        if isinstance(self.core, Construction):
            core = self.core.strand
        elif self.core is not None:
            core = Strand((self.core.bar,), ())
        bars = core.bars
        if self.filling:
            bars = (*bars, mere_mass(self.filling, self._bore))
        rings = [
            Ring(
                layer.count,
                layer.element.bar if isinstance(layer.element, Wire) else layer.element.strand,
                helix(radius, layer.lay, SENSES[layer.sense]),
            )
            for layer, radius in zip(self.layers, self.radii)
        ]
        return Strand(bars, (*core.rings, *rings), len(core.rings))

    @property
    def _bore(self) -> float:
        """Diameter of the circle inside the innermost layer, of the core where there is none."""
        if not self.layers:
            assert self.core is not None
            return _diameter(self.core)
        return max(2 * self.radii[0] - _diameter(self.layers[0].element), 0.0)

    @staticmethod
    def standard(
        name: str,
        *,
        diameter: float,
        core: str | None = None,
        lay: str | None = None,
        lay_length: float | None = None,
        strand_lay: float | None = None,
        scaled: bool = True,
        gap: float = 0.03,
        crossed: bool = True,
        youngs_modulus: float = 200e9,
        poissons_ratio: float = 0.3,
        density: float = 7850.0,
    ) -> Construction:
        """Return a construction by its catalogue line.

        Parameters
        ----------
        name : str
            A strand, "1x7", "1x19" or "1x37"; six strands around an equal one, "7x7" or "7x19";
            or strands around a core, "6x7", "6x19", "6x19S", "6x19W", "6x25F", "6x36WS", "8x19S" or
            "8x25F": S Seale, W Warrington, F filler, WS Warrington-Seale, a number alone equal
            wires.
        diameter : float
            Nominal, of the rope or the strand [m].
        core : {"FC", "IWRC", "WSC"}, optional
            Of a rope: fibre (where left out), a 7x7 or a strand like the others. A 7x7 and a 7x19
            have the strand.
        lay : {"sZ", "zS", "zZ", "sS"} or {"Z", "S"}, optional
            Sense of wires in strands and of strands in the rope; "sZ" where left out. Of a strand
            that of its outer layer; "Z" where left out.
        lay_length : float, optional
            Of strands in the rope, or of the outer wires of a strand [m]; 6.5 diameters of a rope
            and 9 of a strand where left out. Inner layers of a strand by itself have it in
            proportion to the diameter over them.
        strand_lay : float, optional
            Of all wires in strands [m]; 8 diameters of a strand where left out, 9 in a 7x7 and a
            7x19.
        scaled : bool, optional
            Whether area of metal and mass are those of tables (Notes), where there is one.
        gap : float, optional
            Between strands around a core, per diameter of a strand.
        crossed : bool, optional
            Whether layers of a strand by itself are laid in turn Z and S.
        youngs_modulus, poissons_ratio, density : float, optional
            Of all wires, as of `Wire`.

        Returns
        -------
        Construction

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If there is no such name, core or lay, or a number has no meaning.

        Notes
        -----
        Wires are circles that touch; R = (1 + gap) d_s sqrt(1 + tan^2(pi/2 - pi/m)/S^2)/2 of m
        strands with the diameter d_s. The core has the diameter that strands leave: fibre of
        900 kg/m^3; a 7x7 in regular lay whose strands turn as those of the rope, with lays by
        its own diameters; or a strand that turns as the others, its lay in proportion.

        Tables (Feyrer, Wire Ropes) are sure of 6x7, 6x19S, 6x36WS and 8x19S with a fibre core and
        of 6x19S and 6x36WS with IWRC. Scaled, wires and all radii are multiplied by one factor
        (0.98 to 1 of the diameter) while lays stay, and what mass lacks is `filling`: it counts in
        the polar inertia as if it were spread over the circle inside the strands. Others are left
        as they are.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Construction.standard("6x19S", diameter=16e-3, core="FC", lay="sZ")
        >>> section = rope.section()
        >>> round(1e6 * section.area, 3), round(section.mass, 5)
        (98.304, 0.91904)
        """
        from .standard import CatalogueLine

        line = CatalogueLine(
            name,
            diameter,
            core,
            lay,
            lay_length,
            strand_lay,
            scaled,
            gap,
            crossed,
            {
                "youngs_modulus": youngs_modulus,
                "poissons_ratio": poissons_ratio,
                "density": density,
            },
        )
        return line.checked().made()

    def section(self, torsion: str = "slip", *, radial_stiffness: float | None = None) -> Section:
        """Return the section: stiffnesses, mass and inertias.

        Parameters
        ----------
        torsion : {"slip", "stick", "straight"}, optional
            What wires do in their strands when the rope is stretched and twisted: they slide, are
            held to their place, or slide in strands that are taken as straight. It is one thing
            where there are no strands.
        radial_stiffness : float, optional
            k_r of the core [N]: the energy k_r eta^2/2 per length resists a relative growth eta of
            the radii. Radii are kept where left out.

        Returns
        -------
        Section

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If there is no such state, the stiffness is not positive, or numbers overflow.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Construction.standard("7x7", diameter=4e-3, lay="sZ")
        >>> slip, stick = rope.section(), rope.section("stick")
        >>> round(slip.torsional_stiffness, 4), round(stick.torsional_stiffness, 4)
        (0.1489, 0.1805)
        """
        return Section.of(self, torsion, radial_stiffness)

    def plot(self, ax: Axes | None = None, *, lay: bool = False) -> Axes:
        """Draw the section, a colour for each layer, or how the wires lie along the rope.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        lay : bool, optional
            Whether it is seen from the side.

        Returns
        -------
        matplotlib.axes.Axes

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Construction.standard("6x7", diameter=8e-3).plot().get_xlabel()
        'y [mm]'
        """
        return draw(self, "plot", ax, lay=lay)


def _diameter(element: Any) -> float:
    size = element.diameter if isinstance(element, (Fibre, Construction)) else element.bar.diameter
    return float(size)
