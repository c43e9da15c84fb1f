"""Where motion grows in the plane of frequency and amplitude of the tension."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base import check
from ..base.answer import Answer, Cost, axes
from ..base.array import Flags, Real
from ..base.computed import computed
from ..base.errors import SceneError
from ..base.progress import Progress, reporter
from ..base.table import Table
from ..chain.compiled import Compiled
from ..motion.modal_system import ModalSystem, modal_system
from .floquet import checked_modes
from .monodromy import exponent
from .tongues import Boundary, Tongue, boundary, threshold, tongues_of


@dataclass(frozen=True, eq=False)
class StabilityMap(Answer):
    """Growth of motion over frequency and amplitude of a tension that pulsates.

    Attributes
    ----------
    frequency : ndarray, shape (f,)
        Of the tension [Hz].
    amplitude : ndarray, shape (a,)
        Of the tension [N].
    growth : ndarray, shape (a, f)
        Of the motion that grows most [1/s]; negative where all motion decays.
    stable : ndarray of bool, shape (a, f)
        Whether nothing grows, or by less than 1e-6 in a period where some undamped motion keeps
        its size and rounding would be taken for growth.
    mode_frequency : ndarray, shape (k,)
        Of the modes that are summed, at the mean tension [Hz].
    eigenvalue, geometric, damping : ndarray, shape (k,), (k, k) and (k, k)
        Lambda, Gamma and C of their amplitudes, q'' + C q' + (Lambda + a(t) Gamma) q = 0.
    highest_amplitude : float
        The mean tension [N] of a rope without bending stiffness, which must not push; else
        infinite.
    tongues : tuple of Tongue
        Where regions of instability begin at no amplitude: `modes`, `order`, `frequency` [Hz],
        `spread` to either side [Hz/N], `kind` ("principal", "sum", "secondary") and `label`, such
        as "f1 + f2". Damping takes them off the axis.
    cost : Cost
        What it cost.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
    >>> stability = model.stability_map([90.0, 100.0], [0.0, 100.0], modes=1)
    >>> stability.stable, stability.mode_frequency.round(9)
    (array([[ True,  True],
           [ True, False]]), array([50.]))
    >>> stability.tongues[0].label, round(stability.tongues[0].frequency, 6)
    ('2 f1', 100.0)
    """

    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    amplitude: Real = field(metadata=axes("amplitude", unit="N"))
    growth: Real = field(metadata=axes("amplitude", "frequency", unit="1/s"))
    eigenvalue: Real = field(metadata=axes("mode", unit="rad^2/s^2"))
    geometric: Real = field(metadata=axes("mode", "other_mode", unit="rad^2/(N s^2)"))
    damping: Real = field(metadata=axes("mode", "other_mode", unit="1/s"))
    highest_amplitude: float
    cost: Cost

    @computed
    def system(self) -> ModalSystem:
        """The equations of the modes.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
        >>> stability = model.stability_map([90.0, 100.0], [0.0, 100.0], modes=1)
        >>> (stability.system.omega / 6.283185307).round(6)
        array([50.])
        """
        return ModalSystem(self.eigenvalue, self.geometric, self.damping)

    @property
    def mode_frequency(self) -> Real:
        """Frequencies of the modes [Hz], shape (k,)."""
        return self.system.omega / (2 * np.pi)

    @property
    def stable(self) -> Flags:
        """Whether no motion grows, shape (a, f)."""
        return np.asarray(self.growth <= threshold(self.system, self.frequency) * self.frequency)

    @property
    def tongues(self) -> tuple[Tongue, ...]:
        """Where instability begins, lowest frequency first."""
        return tongues_of(self.system, float(self.frequency[0]), float(self.frequency[-1]))

    def boundary(self, amplitude: float) -> Boundary:
        """Find the frequencies where stability changes, between the frequencies of the map.

        Parameters
        ----------
        amplitude : float
            Of the tension [N]; need not be one of the map.

        Returns
        -------
        Boundary
            `frequency` [Hz], `order` of the tongue, and whether it is `proved` that no tongue is
            missed.

        Raises
        ------
        TypeError
            If it is not a number.
        SceneError
            If it is negative or not finite, or larger than the mean tension of a rope without
            bending stiffness, or the map has one frequency.
        SolveError
            If a period takes too many steps or motion grows out of all numbers in it.

        Examples
        --------
        A string under T (1 + 0.1 cos) is unstable from about 2 f (1 - 0.1/4) to 2 f (1 + 0.1/4):

        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
        >>> stability = model.stability_map([90.0, 110.0], [0.0, 100.0], modes=1)
        >>> stability.boundary(100.0).frequency.round(3)
        array([ 97.485, 102.484])
        """
        value = check.number(amplitude, "amplitude", "N", sign="nonnegative")
        _refuse_push(value, self.highest_amplitude)
        if len(self.frequency) < 2:
            raise SceneError(
                "frequency of the map must hold two at least, between which edges are found, got "
                f"{self.frequency.tolist()}"
            )
        return boundary(self.system, float(self.frequency[0]), float(self.frequency[-1]), value)

    def table(self) -> Table:
        """Return one row for each amplitude: where it is unstable, and what grows most."""
        unstable, largest = ~self.stable, self.growth.argmax(axis=1)
        rows = np.arange(len(self.amplitude))
        columns: dict[str, Any] = {
            "amplitude [N]": self.amplitude,
            "unstable [%]": 100 * unstable.mean(axis=1),
            "largest growth [1/s]": self.growth[rows, largest],
            "at [Hz]": self.frequency[largest],
        }
        return Table.of("stability under a tension that pulsates", columns)


def solve_stability(
    model: Compiled, frequency: Any, amplitude: Any, *, modes: int | None, progress: Progress
) -> StabilityMap:
    """Look at every frequency and amplitude; see `Model.stability_map`."""
    f = _increasing(check.frequencies(frequency, sign="positive"), "frequency")
    a = _increasing(check.numbers(amplitude, "amplitude", "N", sign="nonnegative"), "amplitude")
    scene = model.scene
    highest = scene.mean_tension if scene.rope.bending_stiffness is None else math.inf
    _refuse_push(float(a[-1]), highest)
    report = reporter(progress)
    system = modal_system(model, checked_modes(model, modes))
    each = exponent(system, f, np.broadcast_to(a, (len(f), len(a))), report=report)
    return StabilityMap(
        frequency=f,
        amplitude=a,
        growth=np.ascontiguousarray((each * f[:, None]).T),
        eigenvalue=system.eigenvalue,
        geometric=system.geometric,
        damping=system.damping,
        highest_amplitude=highest,
        cost=Cost(
            "composition of order 10",
            len(model.x) - 1,
            2 * len(system.eigenvalue),
        ),
    )


def _refuse_push(amplitude: float, highest: float) -> None:
    if amplitude > highest:
        raise SceneError(
            "amplitude must be at most the mean tension for a rope without bending_stiffness, "
            f"{highest!r} N, got {amplitude!r}"
        )


def _increasing(value: Real, name: str) -> Real:
    if len(value) == 0 or (np.diff(value) <= 0).any():
        raise SceneError(f"{name} must hold a number at least, and increase, got {value.tolist()}")
    return value
