"""What broken wires change of natural frequencies, over where they are, and what of it is seen."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.answer import Answer, axes
from ...base.array import Integer, Real
from ...base.errors import SceneError, SolveError
from ...base.table import Table
from ...eigen.modes import Modes
from ...scene.agree import refuse_axis
from ...scene.parts.stretch import LocalChange
from ...scene.scene import Scene
from .plan import Plan

TOLD = 1.96 * math.sqrt(2)  # Standard deviations that two measurements differ by, one time in 20.
POINTS = 41  # Places where none are given.
MOST = 10_000  # Wires, modes.
SPARE = 4  # Modes beyond those that are wanted: families change places.


@dataclass(frozen=True, eq=False)
class WireShifts(Answer):
    """What broken wires change of natural frequencies.

    Attributes
    ----------
    frequency : ndarray, shape (k,)
        Without a break [Hz].
    family : ndarray of str, shape (k,)
        Of each mode, as `Modes.family`.
    n : ndarray of int, shape (counts,)
        How many wires are broken at one place.
    x : ndarray, shape (places,)
        Where [m].
    shift : ndarray, shape (counts, k, places)
        [Hz].
    std : ndarray, shape (k,)
        Standard deviation of a measured frequency [Hz]; NaN where nobody said it.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope.from_construction(1.35, rd.Construction.standard("7x7", diameter=4e-3))
    >>> scene = rd.Scene(rope, tension=2000.0)
    >>> found = rd.broken_wire_shifts(scene, 4, friction=0.2, places=[0.0], modes=2, std=0.01)
    >>> found.shift[0, :, 0].round(3), found.least.round(3)
    (array([-0.06, -0.12]), array([0.028, 0.028]))
    """

    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    family: np.ndarray[Any, Any] = field(metadata=axes("mode"))
    n: Integer = field(metadata=axes("count"))
    x: Real = field(metadata=axes("place", unit="m"))
    shift: Real = field(metadata=axes("count", "mode", "place", unit="Hz"))
    std: Real = field(metadata=axes("mode", unit="Hz"))

    @property
    def least(self) -> Real:
        """Shifts that two measurements tell with 95 %, 1.96 sqrt(2) std [Hz], shape (k,)."""
        return np.asarray(TOLD * self.std)

    def table(self) -> Table:
        """Return one row for each mode: its largest shifts, and at how many places it is told."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency, "family": self.family}
        for n, shift in zip(self.n, self.shift):
            columns[f"{n} broken [Hz]"] = np.abs(shift).max(axis=1)
            told = (np.abs(shift) >= self.least[:, None]).mean(axis=1)
            columns[f"{n}, told at [%]"] = np.round(100 * told)
        columns["least told [Hz]"] = self.least
        return Table.of("largest shifts by broken wires, and at how many places they tell", columns)


def broken_wire_shifts(
    scene: Scene,
    n: int | Sequence[int] = (1, 2, 4),
    *,
    friction: float,
    modes: int = 5,
    places: ArrayLike | None = None,
    std: ArrayLike | Plan | None = None,
    **wires: Any,
) -> WireShifts:
    """Return what broken wires change of natural frequencies, for each place of the break.

    Parameters
    ----------
    scene : Scene
        Whose rope is from a construction.
    n : int or sequence of int, optional
        How many wires are broken at one place.
    friction : float
        Coefficient of friction between wires, > 0.
    modes : int, optional
        The lowest so many.
    places : array_like, optional
        Where wires break [m]; 41 places from end to end where left out.
    std : float, array_like or Plan, optional
        Standard deviation of a measured frequency [Hz]: one, or one of each mode such as
        `Peaks.std`; that of a plan is its line spacing by sqrt(12).
    **wires
        `layer`, `bending` and `fallen`, as `LocalChange.of_broken_wires` takes them.

    Returns
    -------
    WireShifts
        Exact, with the tension as it was: a tension that nobody knows hides more than it shows.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If there are not so many wires, or as `LocalChange.of_broken_wires` does.
    SolveError
        If the rope has not so many modes.

    Examples
    --------
    Half of a strand is felt at a clamp, where wires bend most:

    >>> import ropedyn as rd
    >>> rope = rd.Rope.from_construction(1.35, rd.Construction.standard("1x7", diameter=4e-3))
    >>> scene = rd.Scene(rope, tension=2000.0)
    >>> found = rd.broken_wire_shifts(scene, 3, friction=0.2, places=[0.0, 0.4], modes=1)
    >>> (100 * found.shift[0, 0] / found.frequency).round(3)
    array([-0.617, -0.03 ])
    """
    check.instance(scene, "scene", Scene, "a Scene")
    refuse_axis(scene, "broken wires")
    each = [n] if isinstance(n, int) else list(check.instance(n, "n", Sequence, "whole numbers"))
    counts = [check.count(one, f"n[{k}]", most=MOST) for k, one in enumerate(each)]
    number = check.count(modes, "modes", most=MOST)
    length = scene.rope.length
    x = np.linspace(0.0, length, POINTS) if places is None else check.numbers(places, "places", "m")
    at = [check.position(one, f"places[{k}]", length) for k, one in enumerate(x.tolist())]
    whole, deviation = scene.compile().modes(number), _std(std, number)
    shift = np.empty((len(counts), number, len(at)))
    for c, p in np.ndindex(len(counts), len(at)):
        given = (scene.rope, at[p], counts[c])
        broken = LocalChange.of_broken_wires(*given, friction=friction, **wires)
        after = scene.replace(parts=(*scene.parts, broken)).compile().modes(number + SPARE)
        shift[c, :, p] = _paired(whole, after) - whole.frequency
    return WireShifts(whole.frequency, whole.family, np.array(counts), x, shift, deviation)


def _paired(whole: Modes, after: Modes) -> Real:
    """Return frequencies of the same ranks in the same families."""
    found = np.empty(len(whole.frequency))
    for family in set(whole.family.tolist()):
        mine, same = whole.family == family, after.frequency[after.family == family]
        if len(same) < np.count_nonzero(mine):
            raise SolveError(f"{family} modes must be as many with broken wires: ask for fewer")
        found[mine] = same[: np.count_nonzero(mine)]
    return found


def _std(value: Any, modes: int) -> Real:
    """Return that of each mode, NaN where it is left out."""
    if value is None:
        return np.full(modes, np.nan)
    value = value.line_spacing / math.sqrt(12) if isinstance(value, Plan) else value
    given = check.numbers(value, "std", "Hz", sign="positive")
    if len(given) not in (1, modes):
        raise SceneError(f"std must be one number or {modes}, got {check.shown(value)}")
    return np.broadcast_to(given, modes).copy()
