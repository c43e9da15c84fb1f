"""Random hard scenes, and what must hold in each: counts, cuts, reciprocity, energy."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SolveError
from ...chain.port import Point
from ...eigen.modes import Modes
from ...eigen.spectrum import in_hertz
from ...model import Model
from ...response.harmonic import solve_harmonic
from ...scene.damping import StiffnessDamping
from ...scene.described import Described
from ...scene.end import End
from ...scene.parts.part import Dashpot, Hinge, PointMass, Spring, Support
from ...scene.parts.resonator import Resonator
from ...scene.rope import Rope, own_number
from ...scene.scene import Scene

MODES, LINES, CUTS = 6, 4, 2
DENSITY = 0.1  # Of a rope of 1 m [kg/m].
Random = np.random.Generator


def attack(seed: int, number: int) -> list[str] | None:
    """Return what fails of a random scene, None where an answer is not certain and says so."""
    random = np.random.default_rng([seed, number])
    scene = drawn_scene(random)
    try:
        drawn = Drawn.of(scene, random)
    except SolveError:
        return None
    if not all(modes.certified for modes in drawn.modes):
        return None
    wrong, refused = [], False
    for check in CHECKS:
        try:
            wrong += check(drawn)
        except SolveError:
            refused = True
    told = Described.__repr__(scene)  # every number of it
    texts = [f"scene {number} of seed {seed}: {text}: {told}" for text in wrong]
    return texts if texts or not refused else None


@dataclass(frozen=True, eq=False)
class Drawn:
    """A random scene, compiled whole and cut, and what is asked of both."""

    scene: Scene
    models: tuple[Model, Model]
    modes: tuple[Modes, Modes]
    points: tuple[Point, Point]
    lines: Real  # (f,) next to modes [Hz]

    @classmethod
    def of(cls, scene: Scene, random: Random) -> Drawn:
        """Compile and solve."""
        whole = scene.compile()
        cut = scene.compile(elements=len(whole.x) - 1 + CUTS, element="continuous")
        modes = whole.modes(MODES), cut.modes(MODES)
        near = np.abs(in_hertz(modes[0].eigenvalue))
        lines = random.choice(near[near > 0], LINES) * (1 + 10.0 ** random.uniform(-12, 0, LINES))
        x = random.uniform(0.01, 0.99, 2).tolist()
        moving = ["z"] + ["beta"] * (scene.rope.bending_stiffness is not None)
        return cls(
            scene, (whole, cut), modes, (("z", x[0]), (str(random.choice(moving)), x[1])), lines
        )

    def answers(self, model: Model, drive: Point, response: Point) -> tuple[Complex, Real]:
        """Return values and bounds of the lines, NaN where there is none."""
        found = []
        for f in self.lines.tolist():
            try:
                frf = solve_harmonic(model, f, drive=drive, response=response, tight=False)
                found.append((frf.value[0, 0], frf.rounding_limit[0, 0]))
            except SolveError:
                found.append((np.nan, np.nan))
        value, bound = map(np.array, zip(*found))
        return value, bound


# --- what must hold -----------------------------------------------------------------------------


def counts(drawn: Drawn) -> list[str]:
    """Hold the count between two modes against their number."""
    value, error = in_hertz(drawn.modes[0].eigenvalue), drawn.modes[0].rounding_bound
    wrong = []
    for k, (low, high) in enumerate(zip((value + error)[:-1], (value - error)[1:]), 1):
        middle = float(low + high) / 2
        # nothing is counted below 0 Hz, and between the closest there is no number
        if middle > 0 and low < middle < high:
            found = drawn.models[0].count(below=middle)
            wrong += [f"{found} modes counted below {middle!r} Hz, {k} found"] * (found != k)
    return wrong


def cuts(drawn: Drawn) -> list[str]:
    """Hold modes and lines of a rope against those of the same rope cut elsewhere."""
    whole, cut = ((in_hertz(one.eigenvalue), one.rounding_bound) for one in drawn.modes)
    lines = [drawn.answers(model, *drawn.points) for model in drawn.models]
    return _apart("mode", range(1, MODES + 1), whole, cut) + _apart("cut line", drawn.lines, *lines)


def reciprocity(drawn: Drawn) -> list[str]:
    """Hold a response against that of drive and response exchanged."""
    model, (one, other) = drawn.models[0], drawn.points
    there, back = drawn.answers(model, one, other), drawn.answers(model, other, one)
    return _apart("exchanged line", drawn.lines, there, back)


def passivity(drawn: Drawn) -> list[str]:
    """Hold a force against what it puts into a rope: nothing, or what damping takes."""
    # a spring that pushes gives energy where damping is in proportion to stiffness
    if any(isinstance(part, Spring) and part.stiffness < 0 for part in drawn.scene.parts):
        return []
    value, bound = drawn.answers(drawn.models[0], drawn.points[0], drawn.points[0])
    given = drawn.lines[value.imag > bound].tolist()
    return [f"the rope gives energy to a force at {f!r} Hz" for f in given]


def energy(drawn: Drawn) -> list[str]:
    """Hold each eigenvalue against the energies of the parts: it grows as all stiffness does."""
    modes = drawn.modes[0]
    hertz, error = in_hertz(modes.eigenvalue), modes.rounding_bound
    total = np.zeros(MODES)
    bound = 4 * math.pi**2 * error * (2 * np.abs(hertz) + error)
    for path, share in _stiffnesses(drawn.scene):
        total = total + share * modes.derivative(path, of="eigenvalue")
        bound = bound + abs(share) * modes.derivative_error(path, of="eigenvalue")
    # what rounding cannot tell from 0 is 0, and has no energy to be held against
    bound = np.where(modes.eigenvalue == 0, np.inf, bound)
    return _apart("energies of mode", range(1, MODES + 1), (total, bound), (modes.eigenvalue, 0.0))


CHECKS = (counts, cuts, reciprocity, passivity, energy)


def _apart(name: str, of: Sequence[float] | Real, one: Any, other: Any) -> list[str]:
    """Say where two answers are further apart than their bounds."""
    apart = np.abs(one[0] - other[0])
    far = np.flatnonzero(apart > one[1] + other[1])
    return [f"{name} {float(of[k])!r} is {apart[k]:.3g} off" for k in far.tolist()]


def _stiffnesses(scene: Scene) -> list[tuple[str, float]]:
    """Return paths of all numbers that stiffness grows with, and them over their power."""
    names = ("bending_stiffness", "torsional_stiffness", "axial_stiffness", "lay_coupling")
    found = [(name, getattr(scene.rope, name) or 0.0) for name in names]
    found.append(("tension", scene.mean_tension))
    for k, end in enumerate(scene.ends):
        if isinstance(end, End):
            found += [(f"ends[{k}].spring.{c}", value) for c, value in end.spring.items()]
    for k, part in enumerate(scene.parts):
        if isinstance(part, (Spring, Hinge)):
            found.append((f"parts[{k}].stiffness", part.stiffness))
        elif isinstance(part, Resonator):
            found.append((f"parts[{k}].frequency", part.frequency / 2))
    return [(path, share) for path, share in found if share]


# --- scenes -------------------------------------------------------------------------------------


def drawn_scene(random: Random) -> Scene:
    """Draw a scene: log-uniform in all that has a scale."""
    rope = _rope(random)
    places = np.sort(random.uniform(0.02, 0.98, int(random.integers(0, 4)))).tolist()
    if places and random.random() < 0.3:
        places.append(places[-1] + _log(random, 2e-9, 1e-3))
    parts = [_part(random, rope, x) for x in places]
    damping = StiffnessDamping(_log(random, 1e-12, 1e-3)) if random.random() < 0.4 else None
    if damping is None and random.random() < 0.3:
        parts.append(Dashpot(float(random.uniform(0.02, 0.98)), _log(random, 1e-9, 1e9)))
    ends = _end(random, rope), _end(random, rope)
    tension = _tension(random, rope)
    return Scene(rope, tension=tension, ends=ends, damping=damping, parts=tuple(parts))


def _log(random: Random, low: float, high: float) -> float:
    return math.exp(random.uniform(math.log(low), math.log(high)))


def _rope(random: Random) -> Rope:
    """Draw a string, a beam, or one that bending or pulling twists."""
    kind, bending = random.random(), _log(random, 1e-2, 1e2)
    if kind < 0.2:
        return Rope(1.0, DENSITY)
    turning = float(random.choice([0.0, 1e-6, 1e-4])) or None
    rope = Rope(1.0, DENSITY, bending_stiffness=bending, rotary_inertia=turning)
    if kind < 0.7:
        return rope
    torsional, axial = bending * _log(random, 1e-4, 10.0), _log(random, 1e3, 1e8)
    slope, polar = _log(random, 1e-4, 1.0), _log(random, 1e-8, 1e-3)
    rope = rope.replace(torsional_stiffness=torsional, polar_inertia=polar, lay_slope=slope)
    if kind < 0.85:
        return rope
    coupling = math.sqrt(axial * torsional) * (1 - _log(random, 1e-4, 1.0))
    return rope.replace(axial_stiffness=axial, lay_coupling=coupling)


def _tension(random: Random, rope: Rope) -> float:
    """Draw none, T L^2/B up to 1e10, or compression up to 30 times Euler's load."""
    bending = own_number(rope, "bending_stiffness")
    if bending is None:
        return _log(random, 1e-6, 1e6)
    kind = random.random()
    if kind < 0.15:
        return 0.0
    if kind < 0.8:
        # no rope is pulled to more than twice its length
        most = bending * 1e10 if rope.axial_stiffness is None else rope.axial_stiffness
        return _log(random, 1e-3 * bending, max(most, bending))
    return -bending * math.pi**2 * _log(random, 1e-3, 30.0)


def _end(random: Random, rope: Rope) -> str | End:
    kind = str(random.choice(["clamped", "free", "pinned", "springs"]))
    if rope.bending_stiffness is None:
        return "free" if kind == "free" else "clamped"
    if kind != "springs":
        return kind
    spring = {"z": _log(random, 1e-12, 1e12), "beta": _log(random, 1e-12, 1e12)}
    return End(z="free", beta="free", spring=spring)


def _part(random: Random, rope: Rope, x: float) -> Any:
    """Draw a part of 1e-12 to 1e12 of the rope."""
    kind, size = random.random(), _log(random, 1e-12, 1e12)
    if kind < 0.45:
        turning = _log(random, 1e-12, 1e6) if random.random() < 0.3 else 0.0
        return PointMass(x, DENSITY * size, rotary_inertia=turning)
    if kind < 0.75:
        return Spring(x, -size if random.random() < 0.15 else size)
    if kind < 0.85:
        return Support(x)
    if kind < 0.92 and rope.bending_stiffness is not None:
        return Hinge(x, stiffness=size)
    return Resonator(x, DENSITY * _log(random, 1e-6, 1e3), _log(random, 1e-2, 1e4))
