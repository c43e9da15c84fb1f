"""The section of a rope: its stiffnesses and inertias, computed from its wires."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.answer import TRANSIENT, Answer
from ...base.array import Real
from ...base.errors import SceneError
from ...base.table import Table
from ..damping import WireFriction
from . import stiffness
from .broken import helix_of, path_of, without
from .friction import Grip, grip
from .spread import DIAMETER, LAY, MODULUS, SectionSpread, spread_of
from .strand import Strand

if TYPE_CHECKING:
    from .construction import Construction


MOST_FREQUENCIES = 1_000_000

LATERAL = 1.5  # Of the pressure of outer layers, how much counts.

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
        """Compute it; see `Construction.section`.

        Examples
        --------
        >>> import ropedyn as rd
        >>> strand = rd.Construction.standard("1x7", diameter=4e-3)
        >>> rd.Section.of(strand, "slip", None) == strand.section()
        True
        """
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

    def moment(
        self, curvature: ArrayLike, *, tension: float, friction: float, lateral: float = LATERAL
    ) -> Real:
        """Return the bending moment while the rope is first bent, wires slipping layer by layer.

        Parameters
        ----------
        curvature : array_like
            Of the rope [1/m].
        tension : float
            Of the rope, >= 0 [N]; its ends do not turn.
        friction : float
            Coefficient of friction between wires, >= 0.
        lateral : float, optional
            How much of the pressure of outer layers presses a layer on what lies below; 1.5 counts
            that crossing wires press at points and on both sides.

        Returns
        -------
        ndarray, shape of `curvature`
            [N m].

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If a number is not finite or negative, or the section has no construction.

        Notes
        -----
        After Papailiou and Foti and Martinelli: wires around the rope slip from the neutral axis
        outwards as soon as the bonded change of their tension exceeds what friction carries. In
        ropes of strands these count as wires, and the layers inside them slip under their tension;
        of this second level no measurement is known here.

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("1x19", diameter=20e-3, lay="Z").section()
        >>> section.moment([0.001, 0.1, 1.0], tension=30e3, friction=0.3).round(2)
        array([ 1.02, 17.39, 58.63])
        """
        kappa = _curvatures(curvature, "curvature", sign="any")
        layers = self._grip(tension, friction, lateral)
        return np.asarray(self.bending_slip * kappa + np.sign(kappa) * layers.moment(np.abs(kappa)))

    def bending(
        self, amplitude: ArrayLike, *, tension: float, friction: float, lateral: float = LATERAL
    ) -> Real:
        """Return the bending stiffness of motion between curvatures of both signs: M/amplitude.

        Parameters
        ----------
        amplitude : array_like
            Of the curvature, > 0 [1/m].
        tension, friction, lateral : float
            As of `moment`.

        Returns
        -------
        ndarray, shape of `amplitude`
            From `bending_stick` of the smallest to `bending_slip` of the largest [N m^2].

        Raises
        ------
        TypeError, SceneError
            As `moment` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("1x19", diameter=20e-3, lay="Z").section()
        >>> section.bending([0.001, 0.1, 10.0], tension=30e3, friction=0.3).round(1)
        array([1019.6,  173.9,   47.1])
        """
        kappa = _curvatures(amplitude, "amplitude", sign="positive")
        layers = self._grip(tension, friction, lateral)
        return np.asarray(self.bending_slip + layers.moment(kappa) / kappa)

    def loss(
        self, amplitude: ArrayLike, *, tension: float, friction: float, lateral: float = LATERAL
    ) -> Real:
        """Return the loss factor of bending with friction, as `LossFactor` takes it.

        Parameters
        ----------
        amplitude : array_like
            Of the curvature, > 0 [1/m].
        tension, friction, lateral : float
            As of `moment`.

        Returns
        -------
        ndarray, shape of `amplitude`
            Work that a cycle loses, by pi M amplitude. 0 where nothing slips.

        Raises
        ------
        TypeError, SceneError
            As `moment` does.

        Notes
        -----
        Loops are those of the first curve doubled in both directions (Masing): a cycle loses
        8 (int_0^a M dkappa - M(a) a/2).

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("1x19", diameter=20e-3, lay="Z").section()
        >>> section.loss([0.001, 0.1, 10.0], tension=30e3, friction=0.3).round(3)
        array([0.   , 0.71 , 0.035])
        """
        kappa = _curvatures(amplitude, "amplitude", sign="positive")
        layers = self._grip(tension, friction, lateral)
        moment = self.bending_slip * kappa + layers.moment(kappa)
        return np.asarray(layers.loss(kappa) / (np.pi * moment * kappa))

    def wire_friction(self, friction: float, *, lateral: float = LATERAL) -> WireFriction:
        """Return friction between wires as a scene takes it, for motion of any amplitude.

        Parameters
        ----------
        friction, lateral : float
            As of `moment`.

        Returns
        -------
        WireFriction
            Of a rope with `bending_stick`, at whatever tension the scene has.

        Raises
        ------
        TypeError, SceneError
            As `moment` does; also if there is no layer that could slip.

        Examples
        --------
        >>> import ropedyn as rd
        >>> made = rd.Construction.standard("1x19", diameter=20e-3, lay="Z")
        >>> damping = made.section().wire_friction(0.3)
        >>> scene = rd.Scene(rd.Rope.from_construction(9.0, made), tension=3e4, damping=damping)
        >>> scene.effects[-1]
        'wire friction'
        """
        layers = self._grip(1.0, friction, lateral)
        if not len(layers.stiffness):
            raise SceneError("construction must have a layer whose wires could slip, got none")
        return WireFriction(tuple(layers.stiffness.tolist()), tuple(layers.first.tolist()))

    def without(self, n: int = 1, *, layer: int | tuple[int, int] | None = None) -> Section:
        """Return the section where wires are broken and carry nothing.

        Parameters
        ----------
        n : int, optional
            How many wires.
        layer : int or (int, int), optional
            Of which layer, from inside, 0 the first: a layer of wires, or a layer of strands and
            the layer in one of its strands; the outermost wires where left out.

        Returns
        -------
        Section
            In the same state; what is lost is taken as spread around the axis.

        Raises
        ------
        TypeError
            If a number is not whole.
        SceneError
            If there are not so many wires, no such layer, or the section has no construction.

        Examples
        --------
        One of the 36 outer wires of a 7x7:

        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("7x7", diameter=4e-3).section()
        >>> broken = section.without(1, layer=(0, 0))
        >>> round(1 - broken.axial_stiffness / section.axial_stiffness, 4)
        0.0197
        """
        left = without(self._made, n, path_of(self._made, layer))
        return Section.of(left, self.torsion, self.radial_stiffness)

    def recovery(self, *, friction: float, layer: int | tuple[int, int] | None = None) -> float:
        """Return how far from a break a wire carries its share again: r/(friction c^2) [m].

        Parameters
        ----------
        friction : float
            Coefficient of friction between wires, > 0.
        layer : int or (int, int), optional
            Of the wire, as `without` takes it.

        Returns
        -------
        float
            On each side of the break, r and c of the wire around its own strand.

        Raises
        ------
        TypeError, SceneError
            As `without` does, or if the friction is not positive.

        Examples
        --------
        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("7x7", diameter=4e-3).section()
        >>> round(section.recovery(friction=0.2), 4)
        0.0433
        """
        friction = check.number(friction, "friction", sign="positive")
        return float(1 / (friction * helix_of(self._made, path_of(self._made, layer)).curvature))

    def spread(
        self,
        n: int = 10_000,
        *,
        seed: int = 0,
        modulus: tuple[float, float] = MODULUS,
        lay: float = LAY,
        diameter: tuple[float, float] = DIAMETER,
        core: tuple[float, float] | None = None,
    ) -> SectionSpread:
        """Draw sections that the construction may have, as far as nobody knows it better.

        Parameters
        ----------
        n : int, optional
            How many, from 100 to 10^6.
        seed : int, optional
            Of the same seed the same sections.
        modulus, diameter : (float, float), optional
            Factors on the modulus of all wires and on all diameters and radii, uniform between
            them; where left out 190 to 205 GPa of 200, and up to 5 % thicker.
        lay : float, optional
            Lay lengths differ by factors from 1 - lay to 1 + lay, uniform, those of layers of the
            rope by one and those of layers in strands by another.
        core : (float, float), optional
            `radial_stiffness` of the core per EA at fixed radii, its logarithm uniform: where left
            out 0.01 to 0.1 of fibre (moduli of 60 to 150 GPa), 0.03 to 1 of strands or wires under
            strands, 1 to 100 in strands of wires.

        Returns
        -------
        SectionSpread
            Wires between slipping and sticking: EA, D and C uniform between both, ln B uniform by
            itself.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If a range has no meaning, or the section has no construction.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> section = rd.Construction.standard("6x19S", diameter=16e-3, core="FC").section()
        >>> E = section.spread().axial_stiffness / section.area
        >>> (np.quantile(E, [0.025, 0.5, 0.975]) / 1e9).round()
        array([ 59., 112., 150.])
        """
        return spread_of(
            self._made.strand,
            n=n,
            seed=seed,
            modulus=modulus,
            lay=lay,
            diameter=diameter,
            core=core,
        )

    def priors(self, **spread: Any) -> Any:
        """Return what the construction says of a rope before anything is measured.

        Parameters
        ----------
        **spread
            As `spread` takes them.

        Returns
        -------
        Prior
            `SectionSpread.prior` of the draws; ``.marginal(paths)`` is that of some of its paths,
            as `identify` takes it.

        Raises
        ------
        TypeError, SceneError
            As `spread` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> prior = rd.Construction.standard("7x7", diameter=4e-3).section().priors(n=1000)
        >>> print(prior.marginal(["bending_stiffness"]).distribution["bending_stiffness"])
        log-normal
        """
        return self.spread(**spread).prior()

    def torsional_frequency(self, length: float, n: int = 1, *, lay: bool = True) -> Real:
        """Return natural frequencies of twist of a rope held at both ends, without tension.

        Those of the slower family of the coupled waves of twist and stretch.

        Parameters
        ----------
        length : float
            Of the rope [m].
        n : int, optional
            How many.
        lay : bool, optional
            Whether the lay couples twist and stretch.

        Returns
        -------
        ndarray, shape (n,)
            k c/(2 L), 2 c^2 = x + y - sqrt((x - y)^2 + 4 D^2/(mu p)), x = EA/mu, y = C/p [Hz].

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If the length is not positive, or `n` not.

        Examples
        --------
        >>> import ropedyn as rd
        >>> made = rd.Construction.standard("7x7", diameter=4e-3)
        >>> [made.section(state).torsional_frequency(1.35).round(2) for state in ("slip", "stick")]
        [array([246.59]), array([321.45])]
        """
        length = check.number(length, "length", "m", sign="positive")
        n = check.count(n, "n", most=MOST_FREQUENCIES)
        check.instance(lay, "lay", bool, "True or False")
        EA, D, C = self.axial_stiffness, self.lay_coupling, self.torsional_stiffness
        alone = np.sqrt(C / self.polar_inertia)
        speed = torsional_speed(EA, D, C, self.mass, self.polar_inertia) if lay else alone
        return np.asarray(np.arange(1, n + 1) * speed / (2 * length))

    def _grip(self, tension: float, friction: float, lateral: float) -> Grip:
        return grip(
            self._made.strand,
            check.number(tension, "tension", "N", sign="nonnegative"),
            check.number(friction, "friction", sign="nonnegative"),
            check.number(lateral, "lateral", sign="nonnegative"),
        )

    @property
    def _made(self) -> Construction:
        """The construction, which no file keeps."""
        if self.construction is None:
            raise SceneError(
                "the section must have its construction, got one from a file: compute it again"
            )
        return self.construction

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


def torsional_speed(EA: Any, D: Any, C: Any, mass: float, polar: float) -> Any:
    """Return the speed of the slower family of coupled waves of twist and stretch [m/s]."""
    x, y, coupling = EA / mass, C / polar, D * D / (mass * polar)
    # the product of both squares over the larger: nothing cancels
    fast = (x + y + np.hypot(x - y, 2 * np.sqrt(coupling))) / 2
    return np.sqrt((x * y - coupling) / fast)


def _curvatures(value: ArrayLike, name: str, *, sign: str) -> Real:
    """Return curvatures in their shape."""
    shape = np.shape(value)
    return check.numbers(np.ravel(value), name, "1/m", sign=sign).reshape(shape)


def _inertias(strand: Strand) -> dict[str, float]:
    mass, polar, rotary, area = stiffness.inertia(strand)
    return {"mass": mass, "polar_inertia": polar, "rotary_inertia": rotary, "area": area}


WORDS = {
    stiffness.SLIP: "wires slide in strands",
    stiffness.STICK: "wires stick in strands",
    stiffness.STRAIGHT: "strands taken as straight",
}
"""What wires do, in words."""
