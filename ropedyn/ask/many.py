"""Questions that ask a scene many times: what peaks say of it, and families."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import IdentifyWarning, SceneError
from ..curves.peaks import Peaks
from ..experiment.identify.fit import Fit
from ..experiment.identify.identify import identify as identified
from ..family.family import MOST_MODES
from ..family.modes import FamilyModes
from ..model import Model
from .question import AnyQuestion


@dataclass(frozen=True, eq=False)
class IdentifyQuestion(AnyQuestion):
    """Ask which numbers of a scene peaks tell, as ``rd.identify`` does from that of a model.

    Parameters
    ----------
    peaks : Peaks, or array_like of shape (k,)
        [Hz].
    unknown : str or sequence of str
        Paths, such as ``"tension"``.
    ends : {"unknown", "given"}, optional
        As in `identify` of the package.

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> question = rd.ask.identify([25.0, 50.0, 75.0], "tension")
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
    >>> print(question, question.values(question.of(scene.compile())).round(6))
    tension by 3 peaks [1000.]
    """

    peaks: Any
    unknown: Any
    ends: str | None = field(default=None, kw_only=True)
    bounded: ClassVar[bool] = False
    each: ClassVar[float] = 1e-3

    def __post_init__(self) -> None:
        peaks = self.peaks if isinstance(self.peaks, Peaks) else Peaks(self.peaks)
        check.instance(self.unknown, "unknown", (str, list, tuple), "a path or a list of paths")
        unknown = (self.unknown,) if isinstance(self.unknown, str) else tuple(self.unknown)
        if self.ends is not None:
            check.one_of(self.ends, "ends", ("unknown", "given"))
        object.__setattr__(self, "peaks", peaks)
        object.__setattr__(self, "unknown", unknown)

    def __str__(self) -> str:
        return f"{' and '.join(map(str, self.unknown))} by {np.size(self.peaks.frequency)} peaks"

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> Fit:
        """Ask a model, whose numbers are the guess; what the fit warns of stands in its notes."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", IdentifyWarning)
            return identified(
                model.scene, self.peaks, self.unknown, ends=self.ends, **cut_as(model)
            )

    def values(self, answer: Fit) -> Real:
        """Return the numbers."""
        return np.array(answer.value)


@dataclass(frozen=True, eq=False)
class FamilyQuestion(AnyQuestion):
    """Ask for natural frequencies of many ropes, as `Family.modes` does of the family of a model.

    Parameters
    ----------
    paths : sequence of str
        The numbers that differ, as in `Scene.family`.
    rows : array_like, shape (m, p)
        A row of values for each rope, in the order of `paths`.
    number : int
        How many frequencies of each.

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> question = rd.ask.family(["tension"], [[1000.0], [4000.0]], 2)
    >>> model = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0).compile()
    >>> print(question, question.values(question.of(model)).round(9).tolist(), question.parts)
    2 modes of 2 ropes [[25.0, 50.0], [50.0, 100.0]] (2, 'rope')
    """

    paths: Any
    rows: Any
    number: int

    def __post_init__(self) -> None:
        check.instance(self.paths, "paths", (list, tuple), "a list of paths")
        paths, rows = tuple(self.paths), np.array(self.rows)
        if rows.dtype.kind not in "iuf":
            raise TypeError(f"rows must be numbers, got {check.shown(self.rows)}")
        if rows.ndim != 2 or rows.shape[1] != len(paths) or len(rows) == 0:
            expected = f"shape (m, {len(paths)}), a column for each path"
            raise SceneError(f"rows must have {expected}, got shape {rows.shape}")
        object.__setattr__(self, "paths", paths)
        object.__setattr__(self, "rows", rows.astype(np.float64))
        check.count(self.number, "number", most=MOST_MODES)
        super().__post_init__()

    def __str__(self) -> str:
        return f"{self.number} modes of {len(self.rows)} ropes"

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> FamilyModes:
        """Ask the family of a model; see `Family.modes`."""
        family = model.scene.family(self.paths, **cut_as(model))
        return family.modes(self.rows, self.number, threads=threads)

    def values(self, answer: FamilyModes) -> Real:
        """Return the frequencies of each rope [Hz]."""
        return answer.frequency

    @property
    def parts(self) -> tuple[int, str]:
        """How many ropes there are."""
        return len(self.rows), "rope"

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that ropes take one by one: n each."""
        return 1e-5 * model.size * len(self.rows)


def cut_as(model: Model) -> dict[str, Any]:
    """Return the arguments that cut other ropes as a model is: none where its spans are whole."""
    if model.element == "continuous" and len(model.x) == len(model.scene.compile().x):
        return {}
    return {"elements": len(model.x) - 1, "element": model.element}
