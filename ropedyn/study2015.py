"""The rope of the 2015 study: its scene in both readings of the mass, and its readings in a table.

E. Šutinys, V. Bučinskas, N. Šešok, I. Iljin, A. Klevinskis, "Analytical research of steel rope
dynamic properties", Journal of Vibroengineering (2015): a fragment of rope as 8 equal massless
elements with 7 equal masses between them, both ends held, a transverse force on the third mass.
"""

from __future__ import annotations

import html
import textwrap
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from .axis.axis import Axis
from .axis.flexibility import end_flexibility
from .base import check
from .base.array import Real
from .base.errors import IdentifyWarning, SceneError
from .base.table import WIDTH, Table
from .curves.peaks import Peaks
from .experiment.identify.identify import identify
from .model import Model
from .scene.construction.construction import Construction
from .scene.construction.section import torsional_speed
from .scene.construction.wire import Wire
from .scene.damping import StiffnessDamping
from .scene.parts.part import PointMass, Spring
from .scene.rope import Rope
from .scene.scene import Scene
from .study import printed
from .study.implied import CATALOGUE_DENSITY, Implied, fitted_by_ends
from .study.printed import (
    BENDING_INERTIA,
    BENDING_STIFFNESS,
    COLUMNS,
    DIAMETER,
    DRIVE,
    DRIVEN,
    ELEMENT_LENGTH,
    ELEMENTS,
    EXCITER_MASS,
    EXCITER_STIFFNESS,
    FITTED,
    GAMMA,
    LAY_SLOPE,
    LENGTH,
    LITERAL,
    MASS,
    REFINED,
    ROPES,
    SOLID,
    STATED,
    TORSION,
    TORSIONAL_STIFFNESS,
    TWIST_INERTIA,
    WHOLE,
)
from .study.verdict2015 import short, verdict

MASSES = printed.MASSES  # where the seven masses stand [m]
DRAWS = 1000  # Of what the catalogue line leaves open of each rope.
DENSITIES = {  # what the rope may weigh [kg/m]
    "0.13725 kg the whole rope": MASS / LENGTH,
    "a 4 mm rope of a catalogue": CATALOGUE_DENSITY,
    "0.13725 kg at each mass": MASS / ELEMENT_LENGTH,
}

published = Peaks([70.0, 130.0, 192.0], order=[1, 2, 3])
"""Peaks of the published model [Hz], section 5 of the study."""
measured = Peaks([64.0, 130.0, 193.0], order=[1, 2, 3])
"""Peaks measured on a 4 mm rope [Hz], section 5 of the study."""


def scene(mass: str = "rope") -> Scene:
    """Return the published rope.

    Parameters
    ----------
    mass : {"rope", "each"}
        What the printed 0.13725 kg is: the mass of the whole rope, a seventh of it at each node,
        or the mass at each of the seven nodes, as the study literally says.

    Returns
    -------
    Scene
        Compile it with ``elements=8, element="difference"`` for the study's own model. All
        inertia is per length, so it is kept when the number of elements changes.

    Raises
    ------
    TypeError
        If `mass` is not a string.
    SceneError
        If it is another word.

    Notes
    -----
    The study's rotation [[1, H], [-H, 1]] is not divided by sqrt(1 + H^2). Its literal section is
    that of a `Rope` with B/(1 + H^2) and C/(1 + H^2), which is what stands here.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.study2015.scene().compile(elements=8, element="difference")
    >>> print(model.modes(3).frequency.round(1))
    [ 69.4 136.1 197.6]
    """
    check.one_of(mass, "mass", ("rope", "each"))
    node_mass = MASS / (ELEMENTS - 1) if mass == "rope" else MASS
    stretch = 1 + LAY_SLOPE**2
    rope = Rope(
        LENGTH,
        node_mass / ELEMENT_LENGTH,
        bending_stiffness=BENDING_STIFFNESS / stretch,
        torsional_stiffness=TORSIONAL_STIFFNESS / stretch,
        lay_slope=LAY_SLOPE,
        rotary_inertia=BENDING_INERTIA / ELEMENT_LENGTH,
        polar_inertia=TWIST_INERTIA / ELEMENT_LENGTH,
    )
    return Scene(rope, damping=StiffnessDamping(GAMMA))


def axis_flexibility(axis: Axis, *, A: float, B: float, C: float) -> Real:
    """Return the flexibility of the right end of an element on any axis, held at its left end.

    The second derivatives of the potential energy of Eq. 6 by the six end forces, the moments
    along the axis by Eq. 3 to 5: the integral of Eq. 6 along r(s), piece by piece.

    Parameters
    ----------
    axis : Axis
        Of the element.
    A, B : float
        Bending stiffnesses about the principal normal z and about y [N m^2]: of gamma and of beta.
    C : float
        Torsional stiffness [N m^2].

    Returns
    -------
    ndarray, shape (6, 6)
        (x, y, z, alpha, beta, gamma) of the right end per force and moment on them, in the frame
        of its section [m/N, rad/N, rad/(N m)].

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If a stiffness is not positive.

    Examples
    --------
    A straight element under a force across it and a moment: l^3/3 B, l^2/2 B, l/B.

    >>> import ropedyn as rd
    >>> G = rd.study2015.axis_flexibility(rd.Axis.line(0.3), A=3.0, B=2.0, C=1.5)
    >>> print(G[2, 2].round(6), G[2, 4].round(6), G[4, 4].round(6), G[3, 3].round(6))
    0.0045 0.0225 0.15 0.2
    """
    check.instance(axis, "axis", Axis, "an Axis")
    stiff = {"A": A, "B": B, "C": C}
    found = {k: check.number(v, k, "N m^2", sign="positive") for k, v in stiff.items()}
    return end_flexibility(axis, (found["C"], found["B"], found["A"]))


def tensed_beam(tension: float, bending_stiffness: float) -> Scene:
    """Return the rope as a clamped tensed beam of 0.13725 kg.

    Parameters
    ----------
    tension : float
        [N].
    bending_stiffness : float
        [N m^2].

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.study2015.tensed_beam(2830.0, 1.54).compile().modes(3).frequency.round(1)
    array([ 64.1, 128.8, 194.6])
    """
    return Scene(Rope(LENGTH, MASS / LENGTH, bending_stiffness=bending_stiffness), tension=tension)


def fitted_beam(*, exciter: bool = False) -> Scene:
    """Fit tension and bending stiffness of a clamped tensed beam to the measured peaks.

    Two unknowns, three peaks: least squares of the relative differences.

    Parameters
    ----------
    exciter : bool
        With the moving element of the exciter, type 4810, clamped to the third mass: 18 g on a
        flexure of 2 N/mm that the frame holds, as its data sheet has them.

    Returns
    -------
    Scene

    Examples
    --------
    >>> import ropedyn as rd
    >>> fitted = rd.study2015.fitted_beam()
    >>> round(fitted.tension), round(fitted.rope.bending_stiffness, 2)
    (2960, 0.42)
    """
    beam = tensed_beam(1000.0, 1.0)
    if exciter:
        at = DRIVE[1]
        beam = beam.replace(parts=[PointMass(at, EXCITER_MASS), Spring(at, EXCITER_STIFFNESS)])
    with warnings.catch_warnings():
        # that a stiffness does not show is what the verdict says
        warnings.simplefilter("ignore", IdentifyWarning)
        return identify(beam, measured, ["tension", "bending_stiffness"], ends="given").scene


def implied(peaks: Peaks = measured) -> Implied:
    """Fit tension and bending stiffness to peaks of the study under each reading of its mass.

    Parameters
    ----------
    peaks : Peaks
        `measured` or `published`.

    Returns
    -------
    Implied
        `print` shows the table, with intervals of 95 %, and the verdict.

    Raises
    ------
    TypeError
        If `peaks` are no peaks.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.study2015.implied().fits["clamped"].value["tension"].round())
    2960.0
    """
    fits = fitted_by_ends(peaks, tensed_beam(1000.0, 1.0))
    return Implied(
        peaks, DENSITIES, fits, scene(), BENDING_STIFFNESS, _bar().section().bending_slip
    )


def flexibility(*, printed: bool = False) -> Real:
    """Return the flexibility matrix of one element over (z, alpha, beta).

    Parameters
    ----------
    printed : bool
        As the study prints it, with its misprint: the last entry is H^2 l/C - l/B where the
        integral gives H^2 l/C + l/B.

    Returns
    -------
    ndarray, shape (3, 3)
        Equation (11) of the study [m/N, rad/N, rad/(N m)].

    Examples
    --------
    >>> import ropedyn as rd
    >>> right, printed = (rd.study2015.flexibility(printed=p) for p in (False, True))
    >>> (right - printed).round(6)
    array([[0.      , 0.      , 0.      ],
           [0.      , 0.      , 0.      ],
           [0.      , 0.      , 0.006178]])
    """
    H, B, C, length = LAY_SLOPE, BENDING_STIFFNESS, TORSIONAL_STIFFNESS, ELEMENT_LENGTH
    own, cross = H**2 / C + 1 / B, H * (1 / C - 1 / B)
    last = length * (H**2 / C - 1 / B) if printed else length * own
    return np.array(
        [
            [own * length**3 / 3, cross * length**2 / 2, own * length**2 / 2],
            [cross * length**2 / 2, length * (1 / C + H**2 / B), cross * length],
            [own * length**2 / 2, cross * length, last],
        ]
    )


def stiffness(matrix: Any) -> Real:
    """Return the stiffness matrix of an element, the inverse of its flexibility matrix.

    Parameters
    ----------
    matrix : array_like, shape (n, n)
        Symmetric flexibility.

    Returns
    -------
    ndarray, shape (n, n)

    Raises
    ------
    TypeError
        If it does not hold real numbers.
    SceneError
        If it is not square, symmetric, finite and positive definite: an element with such a
        flexibility would create energy, and frequencies would be imaginary.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.study2015.stiffness(rd.study2015.flexibility(printed=True))
    Traceback (most recent call last):
    ...
    ropedyn.SceneError: flexibility must be positive definite, got a matrix with the \
eigenvalue -0.0031; its inverse has the eigenvalue -321.55
    """
    given = np.asarray(matrix)
    if given.dtype.kind not in "iuf":
        raise TypeError(f"flexibility must be a real matrix, got {check.shown(matrix)}")
    given = given.astype(np.float64)
    square = given.ndim == 2 and given.shape[0] == given.shape[1] and given.size > 0
    if not square or not np.isfinite(given).all() or not np.allclose(given, given.T, atol=0):
        raise SceneError(
            "flexibility must be a square, finite, symmetric matrix, got "
            f"{check.shown(matrix)} of shape {given.shape}"
        )
    lowest = float(np.linalg.eigvalsh(given)[0])
    if lowest <= 0:
        inverse = f"; its inverse has the eigenvalue {1 / lowest:.2f}" if lowest < 0 else ""
        raise SceneError(
            "flexibility must be positive definite, got a matrix with the eigenvalue "
            f"{lowest:.2g}{inverse}"
        )
    return _core.invert(given)


@dataclass(frozen=True)
class Reading:
    """One way to read the study, and the first three frequencies it gives.

    Attributes
    ----------
    name : str
        What is assumed.
    model : Model
        The chain.
    frequency : tuple of float
        Of its first three modes [Hz].

    Examples
    --------
    >>> import ropedyn as rd
    >>> reading = next(rd.study2015.readings())
    >>> reading.name, [round(f, 2) for f in reading.frequency]
    ('study, 0.13725 kg each mass', [29.73, 58.31, 84.65])
    """

    name: str
    model: Model
    frequency: tuple[float, ...]


def readings() -> Iterator[Reading]:
    """Compute every reading of the study.

    Yields
    ------
    Reading

    Examples
    --------
    >>> import ropedyn as rd
    >>> next(rd.study2015.readings()).model.size
    21
    """
    fitted, driven = fitted_beam(), fitted_beam(exciter=True)
    best = f"{FITTED}: {fitted.tension:.0f} N, {fitted.rope.bending_stiffness:.2f} N m^2"
    cases = {
        LITERAL: (scene("each"), ELEMENTS, "difference"),
        WHOLE: (scene("rope"), ELEMENTS, "difference"),
        "  16 elements": (scene("rope"), 16, "difference"),
        "  64 elements": (scene("rope"), 64, "difference"),
        REFINED: (scene("rope"), 128, "difference"),
        "rigid frames, no tension": (scene("rope"), ELEMENTS, "rigid"),
        "beam: 2830 N, 1.54 N m^2": (tensed_beam(2830.0, 1.54), 512, "rigid"),
        best: (fitted, 512, "rigid"),
        f"{DRIVEN}: {driven.tension:.0f} N": (driven, 512, "rigid"),
        TORSION: (scene("rope").without("lay", "bending"), ELEMENTS, "rigid"),
    }
    for name, (case, elements, element) in cases.items():
        model = case.compile(elements=elements, element=element)
        frequency = tuple(model.modes(3).frequency.tolist())
        yield Reading(name, model, frequency)


@dataclass(frozen=True)
class Report:
    """The study's readings beside its published and measured peaks, and what they show.

    Attributes
    ----------
    readings : tuple of Reading
        In the order of the table.
    ropes : Table
        What `torsion` returns.
    verdict : str
        What is proved, what fits and what is open, a line for each sentence.
    """

    readings: tuple[Reading, ...]
    ropes: Table
    verdict: str

    def table(self) -> Table:
        """Return one row for each reading.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.study2015.report().table().column("f1 [Hz]")[:4]
        ('70', '64', '29.73', '69.40')
        """
        against = (np.asarray(published.frequency), np.asarray(measured.frequency))
        names = ("published model", "measured, 4 mm rope")
        rows = [(n, *(f"{f:.0f}" for f in peaks), "", "") for n, peaks in zip(names, against)]
        for reading in self.readings:
            f = np.array(reading.frequency)
            off = [" ".join(f"{d:+.0f}" for d in 100 * (f - peaks) / peaks) for peaks in against]
            # what twists is no reading of three transverse peaks
            off = ["", ""] if reading.name == TORSION else off
            rows.append((reading.name, *(f"{value:.2f}" for value in f), *off))
        columns = ("reading", "f1 [Hz]", "f2", "f3", "% published", "% measured")
        return Table("the 2015 study: first three natural frequencies", columns, tuple(rows))

    def __str__(self) -> str:
        lines = [
            textwrap.fill(line, WIDTH - 1, subsequent_indent="  ")
            if line[0] == "-"
            else f"\n{line}"
            for line in self.verdict.split("\n")
        ]
        return "\n".join([str(self.table()), "", str(short(self.ropes)), *lines])

    def _repr_html_(self) -> str:
        paragraphs = "".join(f"<p>{html.escape(line)}</p>" for line in self.verdict.split("\n"))
        return self.table()._repr_html_() + self.ropes._repr_html_() + paragraphs


def report() -> Report:
    """Compute every reading of the study and compare it with its peaks and with 4 mm ropes.

    Returns
    -------
    Report
        `print` shows both tables and the verdict.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(str(rd.study2015.report()).splitlines()[0])
    the 2015 study: first three natural frequencies
    """
    found, ropes = tuple(readings()), torsion()
    models = {reading.name.partition(":")[0]: reading.model for reading in found}
    ranges = {name: _drawn_torsion(made) for name, made in constructions().items()}
    return Report(found, ropes, verdict(models, published, measured, ropes, ranges))


def constructions() -> dict[str, Construction]:
    """Return ropes and strands of the study's diameter: wires that touch, lays of nine diameters.

    Returns
    -------
    dict of str to Construction
        Ropes in regular lay; strands around fibre without a gap, all strands with the lay of nine
        of their diameters.

    Examples
    --------
    >>> from ropedyn import study2015
    >>> print(list(study2015.constructions())[:2])
    ['1x19, layers crossed', '1x19, layers alike']
    """
    made = {
        f"1x19, layers {how}": Construction.standard(
            "1x19", diameter=DIAMETER, crossed=how == "crossed"
        )
        for how in ("crossed", "alike")
    }
    for name in ("7x7", "7x19"):
        made[name] = Construction.standard(name, diameter=DIAMETER)
    for name in ("6x7", "6x19"):
        line: dict[str, Any] = {"diameter": DIAMETER, "core": "FC", "gap": 0.0, "scaled": False}
        thick = Construction.standard(name, **line)
        strand = thick.diameter - 2 * thick.radii[0]
        made[f"{name} FC"] = Construction.standard(name, strand_lay=9 * strand, **line)
    return made


def torsion() -> Table:
    """Return what the construction says of mass, stiffnesses and the first torsional frequency.

    Of the bare rope, held at both ends, without tension: as if stretch and twist were not coupled,
    and with the lay coupling where wires slip in their strands and where they stick. Beside the
    ropes stand a solid bar of steel and what the study prints.

    Returns
    -------
    Table

    Examples
    --------
    >>> from ropedyn import study2015
    >>> table = study2015.torsion()
    >>> for row in table.rows[:6]:
    ...     print(row[0], [round(f) for f in row[-2:]])
    1x19, layers crossed [443, 443]
    1x19, layers alike [299, 299]
    7x7 [247, 321]
    7x19 [223, 315]
    6x7 FC [132, 243]
    6x19 FC [94, 238]
    """
    made = constructions() | {SOLID: _bar()}
    rows = [(name, *_measures(one)) for name, one in made.items()]
    own = np.sqrt(TORSIONAL_STIFFNESS * ELEMENT_LENGTH / TWIST_INERTIA) / (2 * LENGTH)
    C, B = TORSIONAL_STIFFNESS, BENDING_STIFFNESS
    rows.append((STATED, MASS / LENGTH, C, C, B, B, own.item(), None, None))
    return Table(ROPES, COLUMNS, tuple(rows))


def _bar() -> Construction:
    """Return a bar of steel as thick as the rope: no rope of such wires is stiffer."""
    return Construction(core=Wire(DIAMETER))


def _measures(made: Construction) -> tuple[float, ...]:
    """Return mass, C, B and torsional frequencies of a rope of the study's length."""
    slip, stick = made.section("slip"), made.section("stick")
    alone = slip.torsional_frequency(LENGTH, lay=False).item()
    coupled = (one.torsional_frequency(LENGTH).item() for one in (slip, stick))
    C = slip.torsional_stiffness, stick.torsional_stiffness
    return (slip.mass, *C, slip.bending_slip, slip.bending_stick, alone, *coupled)


def _drawn_torsion(made: Construction) -> tuple[float, float]:
    """Return the 95 % interval of the torsional frequency, by all that a catalogue leaves open.

    The diameter does not matter; mass and inertia are those of the lays that are drawn about.
    """
    section = made.section()
    drawn = section.spread(DRAWS, diameter=(1.0, 1.0))
    speed = torsional_speed(
        *(drawn.axial_stiffness, drawn.lay_coupling, drawn.torsional_stiffness),
        *(section.mass, section.polar_inertia),
    )
    low, high = np.quantile(speed / (2 * LENGTH), [0.025, 0.975]).tolist()
    return low, high
