"""A model of a rope that sags: asked on the catenary where a parabola is no answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.computed import computed
from ..base.errors import ModelWarning, SceneError, warn
from ..chain.compiled import Compiled
from ..scene.hung import PARABOLA, highest, parabola_error
from .model import SpaceModel, compile_space

if TYPE_CHECKING:
    from ..eigen.modes import Modes
    from ..response.deflection import Deflection
    from ..response.frf import FRF


class Hanging(Compiled):
    """What a rope that sags answers on its catenary in place of a parabola, which `super` has.

    That is where the parabola may be a thousandth of a frequency off, and above the frequencies
    that it has along the rope. What is not carried there stays the parabola's, with a warning.
    """

    @computed
    def off(self) -> float:
        """How far a parabola is off, of a frequency."""
        return parabola_error(self.scene)

    @computed
    def highest(self) -> float:
        """Up to what frequency a parabola is an answer [Hz]."""
        return highest(self.scene) if self.off <= PARABOLA else 0.0

    @computed
    def on_catenary(self) -> tuple[SpaceModel | None, str]:
        """The same rope on its catenary, or why there is none."""
        if self.element != "continuous":
            return None, "it is of elements, which have no other"
        try:
            return compile_space(self.scene), ""
        except SceneError as error:
            return None, str(error)

    def _hung(self, top: Any, what: str, carried: bool = True) -> SpaceModel | None:
        """Return what answers up to a frequency in place of the parabola; where nothing, warn."""
        if self.highest and np.max(top, initial=0.0) <= self.highest:
            return None
        hung, why = self.on_catenary
        if hung is not None and carried:
            return hung
        off = f"off by up to {self.off:.2g} of a frequency"
        if self.highest:
            off = f"without modes along it, the first near {self.highest:.3g} Hz"
        why = why or f"{what} is not carried on the catenary"
        warn(f"{what} is that of a parabola, {off}: {why}", ModelWarning)
        return None

    def modes(self, number: int | None = None, **how: Any) -> Modes:
        """Find modes, damped ones those of the parabola."""
        parabola = super().modes  # type: ignore[misc]
        asked = {name: how[name] for name in ("below", "points", "solver") if name in how}
        if how.get("damped"):
            self._hung(0.0, "damped motion", False)
            return parabola(number, **how)
        if not self.highest and (hung := self._hung(0.0, "free motion")):
            return hung.modes(number, **asked)
        found: Modes = parabola(number, **how)
        top = found.frequency[-1:] if how.get("below") is None else how["below"]
        if self.highest and (hung := self._hung(top, "free motion")):
            return hung.modes(number, **asked)
        return found

    def count(self, *, below: float) -> int:
        """Count modes."""
        if hung := self._hung(check.number(below, "below", "Hz", sign="positive"), "free motion"):
            return hung.count(below=below)
        return super().count(below=below)  # type: ignore[misc]

    def frf(self, frequency: Any, **how: Any) -> FRF:
        """Compute a response; that at 2 f is the parabola's."""
        top, plain = check.frequencies(frequency), how.get("harmonic", 1) == 1
        if hung := self._hung(top, "motion at 2 f", plain):
            names = ("drive", "response", "quantity", "solver", "threads", "decay")
            return hung.frf(frequency, **{name: how[name] for name in names if name in how})
        return super().frf(frequency, **how)  # type: ignore[misc]

    def static(self, load: Any, **how: Any) -> Deflection:
        """Find a deflection; that of the mean tension alone is the parabola's."""
        if hung := self._hung(0.0, "the mean tension alone" if not load else "it", bool(load)):
            return hung.static(load, **how)
        return super().static(load, **how)  # type: ignore[misc]

    def transient(self, time: Any, **how: Any) -> Any:
        """Integrate motion; that by modes or events is the parabola's."""
        by_line = how.get("method", "auto") in ("auto", "line")
        if hung := self._hung(0.0, "motion over time by modes or events", by_line):
            return hung.transient(time, **how)
        return super().transient(time, **how)  # type: ignore[misc]

    def stepped_sine(self, frequency: Any, **how: Any) -> Any:
        """Find the steady motion of the parabola, and say so."""
        self._hung(0.0, "steady motion", False)
        return super().stepped_sine(frequency, **how)  # type: ignore[misc]
