"""Which mode feels a loss of stiffness or mass where along the rope."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.answer import Answer, axes
from ..base.array import Real
from ..base.drawing import draw
from ..base.errors import SceneError, SolveError
from ..base.table import Table
from ..chain.compile import lumped
from ..chain.rate import DENSITIES, ENTRIES, Places, inertia_rate
from ..scene.rope import ACROSS, own_number
from .sensitivity import BY_ACROSS, SAG, ModePairs, Shapes, Slopes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..chain.compiled import Compiled


STIFFNESSES = ("bending_stiffness", "torsional_stiffness", "axial_stiffness")
COUPLED = 1e-9  # Less between two modes than this part of their own changes is rounding.


@dataclass(frozen=True, eq=False)
class Damage(Answer):
    """What a loss somewhere along the rope changes of each natural frequency, to first order.

    Attributes
    ----------
    edge : ndarray, shape (parts + 1,)
        Between the parts of the rope [m].
    frequency : ndarray, shape (k,)
        [Hz].
    change : dict of ndarray, shape (k, parts)
        For "bending_stiffness", "torsional_stiffness", "axial_stiffness", "linear_density",
        "polar_inertia" and "rotary_inertia" as far as the rope has them: relative change of the
        frequency per relative loss of that property and per length of rope that loses it [1/m], the
        exact mean over each part. The property is what it is there, with all that changes the rope
        over a stretch; the tension stays, and under gravity the length of the whole rope's curve. 0
        where the frequency is 0.

    Examples
    --------
    Half of a rope that loses a tenth of its density moves a frequency by half of 5 %:

    >>> import ropedyn as rd
    >>> damage = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(1).damage(points=8)
    >>> damage.frequency_change(0.0, 1.0, linear_density=0.1).round(9)
    array([0.025])
    """

    edge: Real = field(metadata=axes("edge", unit="m"))
    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    change: dict[str, Real] = field(metadata=axes("mode", "part", unit="1/m", keyed=True))

    def frequency_change(self, start: float, stop: float, **loss: float) -> Real:
        """Return the relative change of each frequency by losses between two positions.

        Parameters
        ----------
        start, stop : float
            [m].
        **loss : float
            Relative loss of properties, such as ``bending_stiffness=0.1``; negative is a gain.

        Returns
        -------
        ndarray, shape (k,)
            To first order in the losses.

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If a position is off the rope, the positions are not in order or the rope has no such
            property.

        Examples
        --------
        >>> import ropedyn as rd
        >>> damage = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2).damage(points=8)
        >>> damage.frequency_change(0.5, 1.0, linear_density=0.1).round(4)
        array([0.0205, 0.0125])
        """
        length = float(self.edge[-1])
        begin = check.position(start, "start", length)
        end = check.position(stop, "stop", length)
        if begin > end:
            raise SceneError(f"stop must not lie left of start, got {start!r} m and {stop!r} m")
        within = np.diff(np.clip(self.edge, begin, end))
        total = np.zeros(len(self.frequency))
        for name, value in loss.items():
            check.one_of(name, "loss", self.change)
            total += self.change[name] @ within * check.number(value, name)
        return total

    def table(self) -> Table:
        """Return one row for each mode: where it feels each loss most, and how much."""
        middle = (self.edge[1:] + self.edge[:-1]) / 2
        columns: dict[str, Any] = {
            "mode": np.arange(1, len(self.frequency) + 1),
            "frequency [Hz]": self.frequency,
        }
        rows = np.arange(len(self.frequency))
        for name, value in self.change.items():
            at = np.abs(value).argmax(axis=1)
            columns[f"{name} at [m]"] = middle[at]
            columns[f"{name} [1/m]"] = value[rows, at]
        return Table.of("relative change of frequency per relative loss and length", columns)

    def plot(self, ax: Axes | None = None, *, of: str | None = None) -> Axes:
        """Plot the change by a loss of one property, the first one by default, as a map."""
        return draw(self, "plot", ax, of=of)


def damage_of(frequency: Real, shapes: Shapes) -> Damage:
    """Return the damage map of modes; see `Modes.damage`."""
    pairs = ModePairs.of(shapes)
    forms = _forms(shapes.model, pairs)
    edge = shapes.model.x[shapes.edges]
    number = len(frequency)
    mass = _mass(pairs)
    # relative change of sqrt(lambda) per relative loss
    factor = np.divide(
        -0.5,
        shapes.eigenvalue * mass,
        out=np.zeros_like(mass),
        where=shapes.eigenvalue > 0,
    )
    change = {}
    for name, form in forms.items():
        own, cross = pairs.bilinear(form)
        _refuse_coupled(pairs, name, own, cross)
        whole = np.add.reduceat(own * factor[:, None], shapes.edges[:-1], axis=1)
        change[name] = whole[:number] / np.diff(edge)
    return Damage(edge=edge, frequency=frequency, change=change)


def _mass(pairs: ModePairs) -> Real:
    """Return u^T M u of the modes, shape (k,)."""
    chain = pairs.shapes.model.chain
    return pairs.bilinear(pairs.slopes(chain).mass(chain))[0]


def _forms(model: Compiled, pairs: ModePairs) -> dict[str, Real]:
    """Return p dPi/dp of each element, by property, shape (k + 2 p, elements)."""
    chain = model.chain
    each = chain._replace(
        first=np.arange(chain.nodes, dtype=np.int32), element=chain.element_of, term=chain.term_of
    )
    slopes = pairs.slopes(each)
    places = Places(model)
    span = np.repeat(np.arange(len(places.counts)), places.counts)
    forms = {}
    for name in STIFFNESSES:
        if getattr(model.scene.rope, name) is not None:
            value = np.array([own_number(rope, name) for rope in places.ropes])
            rate = value[:, None] * places.sections(name)[:, ENTRIES[0], ENTRIES[1]]
            section = slopes.element[..., : rate.shape[1]]
            forms[name] = np.einsum("mei,ei->me", section, rate[span])
    if chain.is_spatial and STIFFNESSES[0] in forms:
        soft = chain.flexibility[chain.element_of, -1, -1]
        forms[STIFFNESSES[0]] -= slopes.element[..., BY_ACROSS] * soft
    for name in (name for name in DENSITIES if name not in ACROSS.values()):
        rate = inertia_rate(model.scene, name)
        if name in ACROSS:
            rate = rate + inertia_rate(model.scene, ACROSS[name])
        own = places.inertia[span] * rate
        if own.any():
            forms[name] = -slopes.eigenvalue[:, None] * _moving(model, slopes, own)
    if model.scene.sags:
        # what is lighter sags less
        sag = places.linear_density * places.pull
        forms["linear_density"] += slopes.element[..., SAG] * sag[span]
    return forms


def _moving(model: Compiled, slopes: Slopes, inertia: Real) -> Real:
    """Return what inertia per length gives of each element to u^T M u, shape (m, elements)."""
    given = lumped(model.chain.kind, model.coordinates, inertia, np.diff(model.x))
    moving = np.einsum("mei,ei->me", slopes.inertia, inertia)
    for side, nodes in enumerate((slopes.node[:, :-1], slopes.node[:, 1:])):
        moving = moving + np.einsum("meab,eab->me", nodes, given[:, side])
    return np.asarray(moving)


def _refuse_coupled(pairs: ModePairs, name: str, own: Real, cross: Real) -> None:
    """Refuse modes that damage mixes: their own shapes say nothing of it."""
    largest = np.abs(own).max(initial=0.0)
    for (i, j), form in zip(pairs.pair, cross):
        if pairs.shapes.eigenvalue[i] > 0 and np.abs(form).max() > COUPLED * largest:
            raise SolveError(
                f"modes {i + 1} and {j + 1} have the same frequency and a local loss of {name} "
                "mixes them: which of them feels it depends on where it is"
            )
