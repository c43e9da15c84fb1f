"""Modes of a hanging rope on its true curve, and how far those of the parabola are from them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.compile import compile_scene
from ..chain.compiled import Compiled
from ..scene.described import Described
from ..scene.end import end_of
from ..scene.parts.part import places, standing, stretches
from ..scene.parts.stretch import ropes
from ..scene.scene import Scene
from ..scene.stations import nearest, stations_at
from .fewest import solve_components
from .modes import OnCatenary
from .spectrum import in_hertz, merged, spectrum
from .vectors import later_within, within

ALONE = {"z": {"x", "z", "beta"}, "y": {"y", "gamma"}}
"""What moves together in each plane where the error of the parabola is known."""
MORE = 12
"""Modes of the straight rope beyond those asked, of which the curved one's are made."""
HALF_WAVE = 10
"""Points on the shortest half wave, where shapes are looked at."""
ABOVE = 1e-9  # Of the highest eigenvalue asked for: modes below are all.
RESTS = 1e-10
"""Of the span: so far from its end a rope that rests may end."""
STRAIGHT = ("sag", "stretch", "lay", "twist", "polar inertia")
"""Effects that the straight rope does not have."""


def on_catenary(model: Compiled, which: Index, frequency: Real) -> OnCatenary:
    """Compare modes of a parabola with as many of the rope on its true curve."""
    error, true = np.zeros(len(frequency)), frequency.copy()
    for k, component in enumerate(model.components if model.scene.sags else ()):
        mine = which == k
        error[mine], true[mine] = _compared(model.scene, component, frequency[mine])
    return OnCatenary(error, true)


def _compared(
    scene: Scene, component: tuple[str, ...], frequency: Real
) -> tuple[Real | float, Real | float]:
    """Return the errors of a component's modes and their frequencies on the curve [Hz]."""
    own = next((c for c in ALONE if c in component), None)
    known = own is None or ({*component} <= ALONE[own] and (own == "y" or _is_held_along(scene)))
    if not known:
        return math.inf, math.nan
    try:
        rest = _Loaded.of(scene).rest()
        if own is None:
            return rest.turned * frequency, frequency
        straight = _Straight.of(scene, len(frequency) + MORE, own)
        both = (_in_plane if own == "z" else _aside)(scene, straight, rest)
        found = both.solved(len(frequency), rest.turned * straight.bent)
    except (SceneError, SolveError, MemoryError):
        return math.inf, math.nan
    parabola, curve, left = found
    error = np.abs(curve - parabola) + left + np.abs(parabola - frequency)
    return error, frequency + curve - parabola


def _is_held_along(scene: Described) -> bool:
    """Whether both ends, and nothing between them, hold the rope along x."""
    held = all("x" in end_of(end).term().held for end in scene.ends)
    between = [part.term() for part in standing(scene.parts)]
    return held and not any("x" in {*term.held, *term.stiffness} for term in between)


class _Both(NamedTuple):
    """Stiffness and mass of the parabola and of the curve, for the same shapes."""

    parabola: tuple[Real, Real]
    curve: tuple[Real, Real]

    def solved(self, number: int, bent: Real) -> tuple[Real, Real, Real]:
        """Return frequencies of both, and what those of the curve leave [Hz]."""
        # that is what they change with half of the shapes that are more than asked, and a share
        # by bending, which is that of the straight rope
        from scipy.linalg import eigh

        parabola = in_hertz(eigh(*self.parabola, eigvals_only=True)[:number])
        curve = in_hertz(eigh(*self.curve, eigvals_only=True)[:number])
        many = len(self.parabola[0])
        few = np.flatnonzero(np.arange(len(self.curve[0])) % many < (number + many) // 2)
        some = (matrix[np.ix_(few, few)] for matrix in self.curve)
        rough = in_hertz(eigh(*some, eigvals_only=True)[:number])
        return parabola, curve, np.abs(rough - curve) + bent[:number] * curve


def _in_plane(scene: Scene, straight: _Straight, rest: _Rest) -> _Both:
    """In the plane of the curve: the straight rope's tension and mass give way to its own."""
    gravity, rope, tension = scene.gravity, scene.rope, scene.mean_tension
    assert gravity is not None
    shapes = straight.on(rest)
    many = len(straight.eigenvalue)
    slope, across = shapes.slope[:many], shapes.across[:many]
    pulled = gravity.curvature(rope, tension) * shapes.integral(across)
    give = gravity.lengthening(rope, tension) * shapes.integral(1 / rest.stiffness[:, None])
    stiffness, mass = straight.matrices
    stiff, heavy = shapes.energies(rest)
    stiff[:many, :many] += stiffness - tension * shapes.product(slope, slope)
    heavy[:many, :many] += mass - shapes.product(across, across, rest.density[:, None])
    return _Both((stiffness + np.outer(pulled, pulled) / give, mass), (stiff, heavy))


def _aside(scene: Scene, straight: _Straight, rest: _Rest) -> _Both:
    """Across that plane: the tension and the length of the curve in place of the chord's."""
    shapes = straight.on(rest)
    many = len(straight.eigenvalue)
    slope, across = shapes.slope[:many], shapes.across[:many]
    more = rest.at(shapes.x)[0] / rest.longer - scene.mean_tension
    stiffness, mass = straight.matrices
    longer = rest.density[:, None] * (rest.longer - 1)
    stiff = stiffness + shapes.product(slope, slope, more)
    return _Both(straight.matrices, (stiff, mass + shapes.product(across, across, longer)))


class _Loaded(NamedTuple):
    """A rope and what hangs on it between stations."""

    station: Real  # (spans + 1,) [m]
    density: Real  # (spans,)
    stiffness: Real  # (spans,) axial
    mass: Real  # (spans + 1,)
    chord: tuple[float, float]  # level and rise [m]
    level: float  # tension [N]
    g: float

    @classmethod
    def of(cls, scene: Scene) -> _Loaded:
        gravity, rope = scene.gravity, scene.rope
        assert gravity is not None
        station = stations_at(rope.length, places(scene.parts))
        local, which = ropes(rope, stretches(scene.parts), station)
        stands, mass = standing(scene.parts), np.zeros(len(station))
        on = nearest(station, places(stands))
        np.add.at(mass, on, [getattr(part, "mass", 0.0) for part in stands])
        own = [(one.linear_density, one.axial_stiffness) for one in local]
        density, stiffness = np.array(own, dtype=np.float64)[which].T
        cos, sin = math.cos(gravity.inclination), math.sin(gravity.inclination)
        chord = (rope.length * cos, rope.length * sin)
        level = scene.mean_tension * cos
        return cls(station, density, stiffness, mass, chord, level, gravity.g)

    def weights(self, x: Real, longer: float) -> Real:
        """Return the weight left of places in each span, shape (spans, places) [N]."""
        own = np.cumsum(np.append(0.0, self.density * np.diff(self.station)))[:-1]
        left = own[:, None] + self.density[:, None] * (x - self.station[:-1, None])
        return self.g * (longer * left + np.cumsum(self.mass[:-1])[:, None])

    def rest(self) -> _Rest:
        """Find where it rests, as long as its ends ask."""
        from scipy.optimize import root

        node, weight = np.polynomial.legendre.leggauss(16)
        span = np.diff(self.station)[:, None]
        x, dx = self.station[:-1, None] + span * (1 + node) / 2, span * weight / 2
        level, rise = self.chord

        def missed(unknown: Real) -> list[float]:
            up = unknown[0] * self.level + self.weights(x, unknown[1])
            along = unknown[1] * dx / np.hypot(self.level, up)
            return [
                np.sum(along * self.level) / level - 1,
                np.sum(along * up) / level - rise / level,
            ]

        half = self.weights(x, 1.0).mean() / self.level
        found = root(missed, [rise / level - half, 1.0], tol=1e-13)
        if not np.abs(found.fun).max() < RESTS:
            raise SolveError(f"the rope must rest on a curve, found none: {found.message}")
        return _Rest(self, float(found.x[0]), float(found.x[1]))


class _Rest(NamedTuple):
    """Where a loaded rope rests."""

    loaded: _Loaded
    start: float  # slope against the level at x = 0
    longer: float  # than its chord, times

    @property
    def density(self) -> Real:
        return self.loaded.density

    @property
    def stiffness(self) -> Real:
        return self.loaded.stiffness

    @property
    def turned(self) -> float:
        """The square of the largest slope against the chord: bending is off by a share of it."""
        ends = np.stack([self.loaded.station[:-1], self.loaded.station[1:]], axis=1)
        return float(np.square(self.at(ends)[1]).max())

    def at(self, x: Real) -> tuple[Real, Real]:
        """Return tension [N] and slope against the chord [rad] at places of each span."""
        level, (along, rise) = self.loaded.level, self.loaded.chord
        up = self.start * level + self.loaded.weights(x, self.longer)
        return np.hypot(level, up), np.arctan2(up, level) - math.atan2(rise, along)


class _Straight(NamedTuple):
    """Modes of the straight rope, as splines on each span."""

    eigenvalue: Real
    mass: Real
    bent: Real  # share of bending in the strain energy
    x: Real  # (spans, points)
    spline: list[Any]

    @classmethod
    def of(cls, scene: Scene, number: int, own: str) -> _Straight:
        from scipy.interpolate import CubicSpline

        left = {*STRAIGHT} | {damping.kind for damping in scene.dampings}
        model = compile_scene(scene.without(*(left & {*scene.effects})))
        k = next(k for k, component in enumerate(model.components) if own in component)
        eigenvalue, _ = spectrum(model, model.components[k], number)
        # shapes come of all modes below a limit: those of the other plane lie between
        limit = float(eigenvalue[-1]) * (1 + ABOVE)
        found = solve_components(model, "sweep", None, limit, shaped=False)
        every, _, order = merged(found, None)
        which = np.repeat(np.arange(len(found)), [len(one.eigenvalue) for one in found])[order]
        mine = np.flatnonzero(which == k)
        longest = np.diff(model.x).max() / model.x[-1]
        points = max(8, math.ceil(HALF_WAVE * number * longest))
        vectors = later_within(model, which, limit, every, points)
        shape = vectors.shape[mine][:, :, model.coordinates.index(own)]
        x = within(model.x, points)
        first = range(0, len(x) - 1, points)
        cut = [slice(k, k + points + 1) for k in first]
        spline = [CubicSpline(x[one], shape[:, one], axis=1) for one in cut]
        bent = vectors.energy.get("bending", np.zeros(len(which)))[mine]
        across = np.stack([x[one] for one in cut])
        return cls(every[mine], vectors.modal_mass[mine], bent, across, spline)

    @property
    def matrices(self) -> tuple[Real, Real]:
        """Stiffness and mass for these shapes."""
        return np.diag(self.eigenvalue * self.mass), np.diag(self.mass)

    def on(self, rest: _Rest) -> _Shapes:
        """Return these shapes on a curve, and as many motions along it."""
        # what moves across moves along as well, such that the rope stretches alike everywhere
        from scipy.interpolate import CubicSpline

        x, dx = _gauss(self.x)
        cos, tan = _cos_tan(rest, x)
        across = np.stack([one(at) for one, at in zip(self.spline, x)], axis=1)
        slope = np.stack([one(at, 1) for one, at in zip(self.spline, x)], axis=1)
        give = rest.longer / rest.stiffness[:, None]
        force = np.sum(slope * tan * dx, axis=(1, 2)) / np.sum(give * dx / cos)
        pulled = force[:, None, None] * give
        along_x = pulled / cos - slope * tan
        edge_cos, edge_tan = _cos_tan(rest, self.x)
        edge = np.stack([one(at, 1) for one, at in zip(self.spline, self.x)], axis=1)
        rates = pulled / edge_cos - edge * edge_tan
        start, along, station = np.zeros(len(force)), [], [np.zeros(len(force))]
        for k, at in enumerate(self.x):
            whole = CubicSpline(at, rates[:, k], axis=1).antiderivative()
            along.append(start[:, None] + whole(x[k]))
            start = start + whole(at[-1])
            station.append(start)
        wave = np.pi / self.x[-1, -1] * np.arange(1, len(force) + 1)[:, None, None]
        still = np.zeros_like(across)
        return _Shapes(
            x,
            dx,
            across=np.concatenate([across, still]),
            slope=np.concatenate([slope, still]),
            along=np.concatenate([np.stack(along, axis=1), np.sin(wave * x)]),
            along_x=np.concatenate([along_x, wave * np.cos(wave * x)]),
            station=np.concatenate(
                [np.stack(station, axis=1), np.sin(wave[:, 0] * np.append(0.0, self.x[:, -1]))]
            ),
        )


class _Shapes(NamedTuple):
    """Motions along and across the chord, shape (k, spans, places), and their rates along it."""

    x: Real  # (spans, places) [m]
    dx: Real  # weights of the places [m]
    across: Real
    slope: Real
    along: Real
    along_x: Real
    station: Real  # (k, spans + 1), along at stations

    def integral(self, values: Real) -> Any:
        """Return integrals over the rope."""
        return np.sum(values * self.dx, axis=(-2, -1))

    def product(self, one: Real, other: Real, weight: Real | float = 1.0) -> Real:
        """Return integrals of products, each with each."""
        weighed = (one * (weight * self.dx)).reshape(len(one), -1)
        return np.asarray(weighed @ other.reshape(len(other), -1).T)

    def energies(self, rest: _Rest) -> tuple[Real, Real]:
        """Return twice the energies of stretch and turning, and of motion, on a curve."""
        tension, angle = rest.at(self.x)
        longer, density = rest.longer, rest.density[:, None]
        strain = (np.cos(angle) * self.along_x + np.sin(angle) * self.slope) / longer
        turn = (np.cos(angle) * self.slope - np.sin(angle) * self.along_x) / longer
        stiff = self.product(strain, strain, longer * rest.stiffness[:, None])
        stiff += self.product(turn, turn, longer * tension)
        heavy = self.product(self.along, self.along, longer * density)
        heavy += self.product(self.across, self.across, longer * density)
        return stiff, heavy + (self.station * rest.loaded.mass) @ self.station.T


def _gauss(x: Real) -> tuple[Real, Real]:
    """Return places and weights between points, shape (spans, places)."""
    node, weight = np.polynomial.legendre.leggauss(4)
    cell = np.diff(x, axis=1)[:, :, None]
    places = x[:, :-1, None] + cell * (1 + node) / 2
    return places.reshape(len(x), -1), (cell * weight / 2).reshape(len(x), -1)


def _cos_tan(rest: _Rest, x: Real) -> tuple[Real, Real]:
    """Return both of the slope at places."""
    angle = rest.at(x)[1]
    return np.cos(angle), np.tan(angle)
