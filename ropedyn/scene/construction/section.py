"""The section of a rope: its stiffnesses and inertias, computed from its wires."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...base import check
from ...base.answer import TRANSIENT, Answer
from ...base.errors import SceneError
from ...base.table import Table
from . import stiffness
from .strand import Strand

if TYPE_CHECKING:
    from .construction import Construction


ROWS = {
    "diameter": "m",
    "area": "m^2",
    "mass": "kg/m",
    "axial_stiffness": "N",
    "lay_coupling": "N m",
    "torsional_stiffness": "N m^2",
    "bending_slip": "N m^2",
    "bending_stick": "N m^2",
    "polar_inertia": "kg m",
    "rotary_inertia": "kg m",
}
"""Numbers of a section, with their units."""


@dataclass(frozen=True)
class Section(Answer):
    """The section of a rope, computed from its wires.

    Attributes
    ----------
    torsion : {"slip", "stick", "straight"}
        What wires do in their strands under tension and torque.
    radial_stiffness : float or None
        Of the core [N]; None: radii are kept.
    diameter : float
        Of the circle around it [m].
    area : float
        Of metal, each wire across its own axis, as catalogues count it [m^2].
    mass : float
        Per length, over the lengths of helices, strands taken as straight [kg/m].
    double_helix_mass : float
        With the exact lengths of wires in strands [kg/m].
    axial_stiffness, lay_coupling, torsional_stiffness : float
        EA [N], D [N m], C [N m^2]: (axial force, torque) = [[EA, D], [D, C]] (strain, twist rate).
    bending_slip, bending_stick : float
        B where every wire slides, and where none does [N m^2].
    polar_inertia, rotary_inertia : float
        Per length, about the axis, and about a diameter as the mean over the lay [kg m].

    Examples
    --------
    >>> import ropedyn as rd
    >>> section = rd.Construction.standard("1x19", diameter=4e-3, lay="Z").section()
    >>> round(section.axial_stiffness), round(section.lay_coupling, 3)
    (1735891, 377.586)
    """

    torsion: str
    radial_stiffness: float | None
    diameter: float
    area: float
    mass: float
    double_helix_mass: float
    axial_stiffness: float
    lay_coupling: float
    torsional_stiffness: float
    bending_slip: float
    bending_stick: float
    polar_inertia: float
    rotary_inertia: float
    construction: Construction | None = field(default=None, repr=False, metadata=TRANSIENT)

    @classmethod
    def of(cls, construction: Construction, torsion: str, radial: float | None) -> Section:
        """Compute it; see `Construction.section`."""
        check.one_of(torsion, "torsion", stiffness.TORSIONS)
        radial = check.optional(radial, "radial_stiffness", "N", sign="positive")
        strand = construction.strand
        with np.errstate(all="ignore"):
            (EA, D), (_, C) = stiffness.held_by_core(stiffness.torsion(strand, torsion), radial)
            slip = stiffness.bending_slip(strand)
            numbers = {
                "axial_stiffness": EA,
                "lay_coupling": D,
                "torsional_stiffness": C,
                "bending_slip": slip,
                "bending_stick": slip + sum(stiffness.bending_tension(strand)),
                "double_helix_mass": stiffness.double_helix_mass(strand),
                "diameter": strand.diameter,
                **_inertias(strand),
            }
        if not np.isfinite(list(numbers.values())).all():
            raise SceneError(
                "diameters, radii and lays must leave the stiffnesses numbers: check the units"
            )
        found = {name: float(value) for name, value in numbers.items()}
        return cls(torsion, radial, construction=construction, **found)

    def properties(self, bending: str) -> dict[str, float]:
        """Return what a `Rope` has of it, with wires that "stick" or "slip" when it bends.

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction(core=rd.Wire(2e-3)).section()
        >>> round(section.properties("slip")["bending_stiffness"], 6)
        0.15708
        """
        check.one_of(bending, "bending", ("stick", "slip"))
        names = ("axial_stiffness", "lay_coupling", "torsional_stiffness")
        inertias = ("polar_inertia", "rotary_inertia")
        return {
            "linear_density": self.mass,
            "bending_stiffness": self.bending_slip if bending == "slip" else self.bending_stick,
            **{name: getattr(self, name) for name in (*names, *inertias)},
        }

    def table(self) -> Table:
        """Return one row for each number.

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction(core=rd.Wire(2e-3)).section()
        >>> section.table().rows[0]
        ('diameter [m]', 0.002)
        """
        names = [f"{name.replace('_', ' ')} [{unit}]" for name, unit in ROWS.items()]
        columns = {"quantity": tuple(names), "value": tuple(getattr(self, name) for name in ROWS)}
        return Table.of(f"section, {WORDS[self.torsion]}", columns)


def _inertias(strand: Strand) -> dict[str, float]:
    mass, polar, rotary, area = stiffness.inertia(strand)
    return {"mass": mass, "polar_inertia": polar, "rotary_inertia": rotary, "area": area}


WORDS = {
    stiffness.SLIP: "wires slide in strands",
    stiffness.STICK: "wires stick in strands",
    stiffness.STRAIGHT: "strands taken as straight",
}
"""What wires do, in words."""
