"""What a catalogue line leaves open: random sections, their intervals and the prior they give."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base import answer, check
from ...base.answer import Answer, axes
from ...base.array import Real
from ...base.errors import SceneError
from ...base.table import Table
from ..bench.laid import PATHS as LAID_PATHS
from ..bench.laid import Laid, moments_of_laid
from .draws import Scatter, sections
from .strand import Bar, Strand

MODULUS = (0.95, 1.025)  # Of wires drawn hard, per 200 GPa: 190 to 205 GPa.
LAY = 0.15  # Lay lengths of one name differ by so much either way.
DIAMETER = (1.0, 1.05)  # Ropes are made up to 5 % thicker than their name.
FIBRE, STRAND, WIRES = (0.01, 0.1), (0.03, 1.0), (1.0, 100.0)
"""Stiffness of a core of fibre, of one of strands and of layers of wires, see `Section.spread`."""

LEAST_DRAWS = 100
MOST_DRAWS = 1_000_000

UNITS = {
    "axial_stiffness": "N",
    "lay_coupling": "N m",
    "torsional_stiffness": "N m^2",
    "bending_stiffness": "N m^2",
    "twist_per_stretch": "m",
    "free_torsional_stiffness": "N m^2",
}
"""Numbers that intervals are told of, with their units."""


@dataclass(frozen=True, eq=False)
class SectionSpread(Answer):
    """Sections that a construction may have, drawn at random.

    Attributes
    ----------
    axial_stiffness, lay_coupling, torsional_stiffness : ndarray, shape (n,)
        EA [N], D [N m] and C [N m^2] of each draw.
    bending_stiffness : ndarray, shape (n,)
        B [N m^2], between wires that slide and wires that stick.

    Examples
    --------
    >>> import ropedyn as rd
    >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
    >>> [round(bound, 3) for bound in spread.interval(0.9)["torsional_stiffness"]]
    [0.128, 0.236]
    """

    axial_stiffness: Real = field(metadata=axes("draw", unit="N"))
    lay_coupling: Real = field(metadata=axes("draw", unit="N m"))
    torsional_stiffness: Real = field(metadata=axes("draw", unit="N m^2"))
    bending_stiffness: Real = field(metadata=axes("draw", unit="N m^2"))

    @property
    def twist_per_stretch(self) -> Real:
        """D/EA of each draw [m]: it hardly feels how stiff the core is.

        Examples
        --------
        >>> import ropedyn as rd
        >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
        >>> print(spread.twist_per_stretch.mean().round(6))
        0.000287
        """
        return np.asarray(self.lay_coupling / self.axial_stiffness)

    @property
    def free_torsional_stiffness(self) -> Real:
        """C - D^2/EA of each draw, where an end is free to move along [N m^2].

        Examples
        --------
        >>> import ropedyn as rd
        >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
        >>> print(spread.free_torsional_stiffness.mean().round(4))
        0.0783
        """
        return np.asarray(self.torsional_stiffness - self.lay_coupling * self.twist_per_stretch)

    def interval(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Return the middle of the draws of each number that holds this share of them.

        Parameters
        ----------
        level : float, optional
            Above 0 and below 1.

        Returns
        -------
        dict of str to (float, float)
            In SI units.

        Raises
        ------
        TypeError
            If the level is not a number.
        SceneError
            If it is not between 0 and 1.

        Examples
        --------
        >>> import ropedyn as rd
        >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
        >>> sorted(spread.interval(0.9))[0]
        'axial_stiffness'
        """
        level = check.number(level, "level", sign="positive")
        if level >= 1:
            raise SceneError(f"level must be below 1, got {level!r}")
        share = [(1 - level) / 2, (1 + level) / 2]
        bounds = {name: np.quantile(getattr(self, name), share).tolist() for name in UNITS}
        return {name: (low, high) for name, (low, high) in bounds.items()}

    def prior(self) -> Any:
        """Return what the draws say of the properties of a rope, with their covariance.

        Of ln EA, D/EA, ln(C - D^2/EA) and ln B the means and covariances are those of the draws.

        Returns
        -------
        Prior
            Of axial_stiffness, lay_coupling, torsional_stiffness and bending_stiffness, the first
            three "laid": no rope of it has EA C <= D^2.

        Examples
        --------
        >>> import ropedyn as rd
        >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
        >>> prior = spread.prior()
        >>> list(prior)
        ['axial_stiffness', 'lay_coupling', 'torsional_stiffness', 'bending_stiffness']
        >>> print(prior.correlation[1, 2].round(2))
        0.78
        """
        plain = {
            "axial_stiffness": np.log(self.axial_stiffness),
            "lay_coupling": self.twist_per_stretch,
            "torsional_stiffness": np.log(self.free_torsional_stiffness),
            "bending_stiffness": np.log(self.bending_stiffness),
        }
        g = np.stack(list(plain.values()))
        by_log = np.array([path != "lay_coupling" for path in plain])
        mean, covariance = moments_of_laid(g.mean(axis=1), np.cov(g), by_log, Laid(0, 1, 2))
        std = np.sqrt(np.diag(covariance))
        # a prior knows the scene, which knows its rope and this
        Prior: Any = answer.named("Prior")
        return Prior(
            {path: (float(m), float(s)) for path, m, s in zip(plain, mean, std)},
            covariance=covariance,
            distribution=dict.fromkeys(LAID_PATHS, "laid"),
        )

    def table(self) -> Table:
        """Return median and 95 % interval of each number.

        Examples
        --------
        >>> import ropedyn as rd
        >>> spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=1000)
        >>> spread.table().columns
        ('quantity', 'median', 'from', 'to')
        """
        bounds = self.interval()
        columns: dict[str, Any] = {
            "quantity": tuple(f"{name.replace('_', ' ')} [{unit}]" for name, unit in UNITS.items()),
            "median": tuple(float(np.median(getattr(self, name))) for name in UNITS),
            "from": tuple(bounds[name][0] for name in UNITS),
            "to": tuple(bounds[name][1] for name in UNITS),
        }
        title = f"sections of {len(self.axial_stiffness)} draws, 95 % intervals"
        return Table.of(title, columns)


def spread_of(
    strand: Strand, *, n: int, seed: int, modulus: Any, lay: Any, diameter: Any, core: Any
) -> SectionSpread:
    """Draw sections; see `Section.spread`."""
    n = check.count(n, "n", least=LEAST_DRAWS, most=MOST_DRAWS)
    rng = np.random.default_rng(check.count(seed, "seed", least=0, most=2**32 - 1))
    lay = check.number(lay, "lay", sign="nonnegative")
    if lay >= 1:
        raise SceneError(f"lay must be below 1, got {lay!r}")
    lays = (1 - lay, 1 + lay)
    low, high = np.log(_range(_usual(strand) if core is None else core, "core"))
    scatter = Scatter(
        rng.uniform(*_range(modulus, "modulus"), n),
        rng.uniform(*_range(diameter, "diameter"), n),
        (rng.uniform(*lays, n), rng.uniform(*lays, n)),
        np.exp(rng.uniform(low, high, n)),
        rng.random(n),
        rng.random(n),
    )
    with np.errstate(all="ignore"):
        found = sections(strand, scatter)
    if not np.isfinite(found).all():
        raise SceneError("modulus, lay and diameter must leave the stiffnesses numbers")
    return SectionSpread(*found.T)


def _range(value: Any, name: str) -> tuple[float, float]:
    """Return two positive factors, the smaller first."""
    what = "two factors such as (0.95, 1.05)"
    check.instance(value, name, (tuple, list), what)
    if len(value) != 2:
        raise SceneError(f"{name} must be {what}, got {check.shown(value)}")
    low, high = (check.number(v, f"{name}[{k}]", sign="positive") for k, v in enumerate(value))
    if low > high:
        raise SceneError(f"{name} must be {what}, the smaller first, got {check.shown(value)}")
    return low, high


def _usual(strand: Strand) -> tuple[float, float]:
    """Return how stiff cores of this kind are against growth of radii, per EA."""
    if all(isinstance(ring.element, Bar) for ring in strand.rings):
        return WIRES
    carries = strand.core > 0 or any(bar.EA > 0 for bar in strand.bars)
    return STRAND if carries else FIBRE
