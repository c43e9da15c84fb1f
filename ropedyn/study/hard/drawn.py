"""Random hard scenes, and what must hold in each: counts, cuts, reciprocity, energy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SolveError
from ...eigen.modes import Modes
from ...eigen.spectrum import in_hertz
from ...model import Model
from ...response.frf import FRF
from ...scene.damping import StiffnessDamping
from ...scene.end import End
from ...scene.parts.part import Dashpot, Hinge, PointMass, Spring, Support
from ...scene.parts.resonator import Resonator
from ...scene.rope import Rope
from ...scene.scene import Scene

MODES, LINES, CUTS = 6, 4, 2
DENSITY = 0.1  # Of a rope of 1 m [kg/m].
Random = np.random.Generator


def attack(seed: int, number: int) -> list[str] | None:
    """Return what fails of a random scene, None where it has no modes and says so."""
    random = np.random.default_rng([seed, number])
    scene = drawn_scene(random)
    try:
        drawn = Drawn.of(scene, random)
    except SolveError:
        return None
    wrong = [text for check in CHECKS for text in check(drawn)]
    return [f"scene {number} of seed {seed}: {text}: {scene!r}" for text in wrong]


@dataclass(frozen=True, eq=False)
class Drawn:
    """A random scene, compiled in two ways, and what both answer."""

    scene: Scene
    models: tuple[Model, Model]
    modes: tuple[Modes, Modes]
    points: tuple[tuple[str, float], tuple[str, float]]
    lines: Real  # (f,) [Hz]

    @classmethod
    def of(cls, scene: Scene, random: Random) -> Drawn:
        """Compile and solve."""
        whole = scene.compile()
        parts = len(whole.x) - 1 + CUTS
        models = whole, scene.compile(elements=parts, element="continuous")
        modes = models[0].modes(MODES), models[1].modes(MODES)
        near = np.abs(in_hertz(modes[0].eigenvalue))
        near = near[near > 0]
        beside = random.choice(near, LINES) * (1 + 10.0 ** random.uniform(-12, 0, LINES))
        x = random.uniform(0.01, 0.99, 2).tolist()
        points = ("z", x[0]), (str(random.choice(moving(scene))), x[1])
        return cls(scene, models, modes, points, beside)


def moving(scene: Scene) -> list[str]:
    """Return the coordinates that move with z."""
    return ["z"] + ["beta"] * (scene.rope.bending_stiffness is not None)


# --- what must hold -----------------------------------------------------------------------------


def counts(drawn: Drawn) -> list[str]:
    """Hold the count between two modes against their number."""
    modes, model = drawn.modes[0], drawn.models[0]
    value, error = in_hertz(modes.eigenvalue), modes.rounding_error
    wrong = []
    for k, (low, high) in enumerate(zip((value + error)[:-1], (value - error)[1:])):
        middle = float(low + high) / 2
        # below 0 Hz there is nothing to count, and too near no number between
        if middle <= 0 or not low < middle < high:
            continue
        found = model.count(below=middle)
        if found != k + 1:
            wrong.append(f"{found} modes counted below {middle!r} Hz, {k + 1} found")
    return wrong


def cuts(drawn: Drawn) -> list[str]:
    """Hold modes and lines of a rope against those of the same rope in three parts."""
    one, other = drawn.modes
    apart = np.abs(in_hertz(one.eigenvalue) - in_hertz(other.eigenvalue))
    wrong = [
        f"mode {k + 1} is {apart[k]:.3g} Hz off that of the rope cut {CUTS} times"
        for k in np.flatnonzero(apart > one.rounding_error + other.rounding_error).tolist()
    ]
    return wrong + _unlike(drawn, "cuts", *(_lines(drawn, model) for model in drawn.models))


def reciprocity(drawn: Drawn) -> list[str]:
    """Hold a response against that of drive and response exchanged."""
    here = drawn.models[0]
    return _unlike(drawn, "reciprocity", _lines(drawn, here), _lines(drawn, here, swap=True))


def passivity(drawn: Drawn) -> list[str]:
    """Hold a force against what it puts into a rope: nothing, or what damping takes."""
    # a spring that pushes gives energy where damping is in proportion to stiffness
    if any(isinstance(part, Spring) and part.stiffness < 0 for part in drawn.scene.parts):
        return []
    answers = _asked(drawn, drawn.models[0], drawn.points[0], drawn.points[0])
    return [
        f"the rope gives energy to a force at {f!r} Hz"
        for f, frf in zip(drawn.lines.tolist(), answers)
        if frf is not None and frf.value[0, 0].imag > frf.rounding_limit[0, 0]
    ]


def energy(drawn: Drawn) -> list[str]:
    """Hold each eigenvalue against the energies of the parts: it grows as all stiffness does."""
    modes = drawn.modes[0]
    hertz, error = in_hertz(modes.eigenvalue), modes.rounding_error
    total = -modes.eigenvalue
    bound = 4 * math.pi**2 * error * (2 * np.abs(hertz) + error)
    for path, value, power in stiffnesses(drawn.scene):
        total = total + value / power * modes.derivative(path, of="eigenvalue")
        bound = bound + abs(value / power) * modes.derivative_error(path, of="eigenvalue")
    return [
        f"the energies of mode {k + 1} are {total[k]:.3g} rad^2/s^2 off"
        for k in np.flatnonzero(np.abs(total) > bound).tolist()
    ]


CHECKS: tuple[Callable[[Drawn], list[str]], ...] = (counts, cuts, reciprocity, passivity, energy)


def stiffnesses(scene: Scene) -> list[tuple[str, float, int]]:
    """Return path, value and power of all numbers that stiffness grows with."""
    names = ("bending_stiffness", "torsional_stiffness", "axial_stiffness", "lay_coupling")
    found = [(name, getattr(scene.rope, name), 1) for name in names if getattr(scene.rope, name)]
    found += [("tension", scene.mean_tension, 1)] if scene.mean_tension else []
    for k, end in enumerate(scene.ends):
        if isinstance(end, End):
            found += [(f"ends[{k}].spring.{c}", value, 1) for c, value in end.spring.items()]
    for k, part in enumerate(scene.parts):
        if isinstance(part, Spring) or (isinstance(part, Hinge) and part.stiffness):
            found.append((f"parts[{k}].stiffness", part.stiffness, 1))
        elif isinstance(part, Resonator):
            found.append((f"parts[{k}].frequency", part.frequency, 2))
    return found


def _asked(
    drawn: Drawn, model: Model, drive: tuple[str, float], response: tuple[str, float]
) -> list[FRF | None]:
    """Ask line by line, None where there is no answer."""
    answers: list[FRF | None] = []
    for f in drawn.lines.tolist():
        try:
            answers.append(model.frf(f, drive=drive, response=response))
        except SolveError:
            answers.append(None)
    return answers


def _lines(drawn: Drawn, model: Model, *, swap: bool = False) -> tuple[Complex, Real]:
    """Return values and bounds, NaN where there is no answer."""
    drive, response = reversed(drawn.points) if swap else drawn.points
    found = [
        (np.nan, np.nan) if frf is None else (frf.value[0, 0], frf.rounding_limit[0, 0])
        for frf in _asked(drawn, model, drive, response)
    ]
    value, bound = zip(*found)
    return np.array(value, dtype=np.complex128), np.array(bound)


def _unlike(
    drawn: Drawn, name: str, one: tuple[Complex, Real], other: tuple[Complex, Real]
) -> list[str]:
    """Say where two answers are further apart than their bounds."""
    apart = np.abs(one[0] - other[0])
    return [
        f"{name}: {apart[k]:.3g} apart at {float(drawn.lines[k])!r} Hz, {drawn.points}"
        for k in np.flatnonzero(apart > one[1] + other[1]).tolist()
    ]


# --- scenes -------------------------------------------------------------------------------------


def drawn_scene(random: Random) -> Scene:
    """Draw a scene: log-uniform in all that has a scale."""
    rope = _rope(random)
    places = np.sort(random.uniform(0.02, 0.98, int(random.integers(0, 4)))).tolist()
    if places and random.random() < 0.3:
        places.append(places[-1] + _log(random, 2e-9, 1e-3))
    parts: list[Any] = [_part(random, rope, x) for x in places]
    damping = None
    if random.random() < 0.4:
        damping = StiffnessDamping(_log(random, 1e-12, 1e-3))
    elif random.random() < 0.3:
        parts.append(Dashpot(float(random.uniform(0.02, 0.98)), _log(random, 1e-9, 1e9)))
    ends = _end(random, rope), _end(random, rope)
    return Scene(
        rope, tension=_tension(random, rope), ends=ends, damping=damping, parts=tuple(parts)
    )


def _log(random: Random, low: float, high: float) -> float:
    return math.exp(random.uniform(math.log(low), math.log(high)))


def _rope(random: Random) -> Rope:
    """Draw a string, a beam, or one that bending or pulling twists."""
    kind, bending = random.random(), _log(random, 1e-2, 1e2)
    if kind < 0.2:
        return Rope(1.0, DENSITY)
    turning = float(random.choice([0.0, 1e-6, 1e-4])) or None
    beam = Rope(1.0, DENSITY, bending_stiffness=bending, rotary_inertia=turning)
    if kind < 0.7:
        return beam
    laid = beam.replace(
        torsional_stiffness=bending * _log(random, 1e-4, 10.0),
        polar_inertia=_log(random, 1e-8, 1e-3),
        lay_slope=_log(random, 1e-4, 1.0),
    )
    if kind < 0.85:
        return laid
    axial = _log(random, 1e3, 1e8)
    most = math.sqrt(axial * (laid.torsional_stiffness or 0.0))
    return laid.replace(axial_stiffness=axial, lay_coupling=most * (1 - _log(random, 1e-4, 1.0)))


def _tension(random: Random, rope: Rope) -> float:
    """Draw none, T L^2/B up to 1e10, or compression up to 30 times Euler's load."""
    bending = rope.bending_stiffness
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
    kind = str(random.choice(["clamped", "pinned", "free", "springs"]))
    if kind != "springs" or rope.bending_stiffness is None:
        return kind if rope.bending_stiffness else ("clamped", "free")[kind == "free"]
    spring = {"z": _log(random, 1e-12, 1e12), "beta": _log(random, 1e-12, 1e12)}
    return End(z="free", beta="free", spring=spring)


def _part(random: Random, rope: Rope, x: float) -> Any:
    """Draw a part of 1e-12 to 1e12 of the rope."""
    kind, size = random.random(), _log(random, 1e-12, 1e12)
    if kind < 0.45:
        turning = _log(random, 1e-12, 1e6) if random.random() < 0.3 else 0.0
        return PointMass(x, DENSITY * size, rotary_inertia=turning)
    if kind < 0.75:
        sign = -1.0 if random.random() < 0.15 else 1.0
        return Spring(x, sign * size)
    if kind < 0.85:
        return Support(x)
    if kind < 0.92 and rope.bending_stiffness is not None:
        return Hinge(x, stiffness=size)
    return Resonator(x, DENSITY * _log(random, 1e-6, 1e3), _log(random, 1e-2, 1e4))
