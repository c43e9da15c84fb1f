"""Some modes of a scene while it changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Index, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...base.unit import own_coordinate
from ...chain.compile import remeshed
from ...chain.compiled import Compiled
from ...eigen.modes import Modes
from ...eigen.spectrum import spectrum
from ...scene.path import value_at, with_values
from ...scene.scene import Scene


@dataclass(frozen=True, eq=False)
class Tracked:
    """Some modes while a number of the scene changes, known by their numbers in their component."""

    modes: Modes  # of a model
    number: Index  # (k,) which of them, from 0

    @computed
    def model(self) -> Compiled:
        """That the modes are of, of continuous spans a finer one."""
        return self.modes.sensitivity.shapes.model

    @computed
    def parts(self) -> list[tuple[tuple[str, ...], Index, Index]]:
        """Components, which of the tracked modes are theirs, and their numbers in them."""
        names = map(own_coordinate, self.modes.family.tolist(), self.modes.plane.tolist())
        own = [self.model.component_of(name) for name in names]
        found = []
        for component in self.model.components:
            mine = np.array([one == component for one in own])
            at = np.flatnonzero(mine[self.number])
            if len(at):
                found.append((component, at, np.cumsum(mine)[self.number[at]] - 1))
        return found

    def slope(self, path: str) -> Real | None:
        """Return d log f/d log p, shape (k,), or None where there is no such derivative."""
        try:
            value = value_at(self.model.scene, path)
            change = self.modes.derivative(path, of="eigenvalue")[self.number]
            return value * change / (2 * self.modes.eigenvalue[self.number])
        except (SceneError, SolveError):
            return None

    def shift(self, path: str, factor: float) -> Real | None:
        """Return log f of the number times a factor less log f, or None where there is none."""
        scene = self.model.scene
        try:
            return self.moved(with_values(scene, {path: factor * value_at(scene, path)}))
        except (SceneError, SolveError):
            return None

    def moved(self, scene: Scene) -> Real | None:
        """Return log f of another scene less log f, or None where there is none."""
        try:
            changed = remeshed(self.model, scene)
            frequency = np.zeros(len(self.number))
            for component, at, number in self.parts:
                eigenvalue, _ = spectrum(changed, component, int(number.max()) + 1)
                frequency[at] = np.sqrt(np.maximum(eigenvalue[number], 0.0)) / (2 * np.pi)
        except (SceneError, SolveError, IndexError):
            return None
        if not (frequency > 0).all():
            return None
        return np.asarray(np.log(frequency / self.modes.frequency[self.number]))
