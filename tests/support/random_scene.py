"""Random scenes and lines of a frequency response: log-uniform in all that has a scale."""

import dataclasses
import math

import numpy as np
from exact_scene import places

import ropedyn as rd

WIDTHS = {
    1: ("z",),
    2: ("z", "beta"),
    3: ("z", "alpha", "beta"),
    4: ("x", "z", "alpha", "beta"),
}
"""Coordinates that move together, by how many they are."""

MOST_ELEMENTS = 200
LENGTH, DENSITY = 1.0, 0.1
STRETCHES = (0.0, 0.125, 0.3, 0.5, 0.517, 0.75, 0.9, LENGTH)
"""Where stretches begin and end [m]."""


@dataclasses.dataclass(frozen=True)
class Line:
    """A model and one number of its response."""

    model: rd.Model
    frequency: float
    drive: tuple[str, int]
    """Coordinate, node."""
    response: tuple[str, int]


def random_line(seed):
    """A line of a random scene; the same for the same seed."""
    random = np.random.default_rng(seed)
    width = int(random.choice(list(WIDTHS), p=[0.15, 0.5, 0.2, 0.15]))
    scene = random_scene(random, width)
    n = int(math.exp(random.uniform(0, math.log(MOST_ELEMENTS + 1))))
    kinds = ["rigid", "tensed"] + ["difference"] * (scene.tension == 0)
    model = scene.compile(
        elements=max(n, len(set(places(scene))) + 1), element=str(random.choice(kinds))
    )
    nodes = random.integers(0, len(model.x), 2).tolist()
    drive = (str(random.choice(WIDTHS[width])), nodes[0])
    # half of the responses at the drive point: the others are small where much lies between
    response = drive if random.random() < 0.5 else (str(random.choice(WIDTHS[width])), nodes[1])
    return Line(model, frequency(random, scene), drive, response)


def random_spans(seed):
    """A random scene, a frequency and two points between which it responds.

    Returns
    -------
    Scene, float, (str, float), (str, float)
    """
    random = np.random.default_rng(seed)
    width = int(random.choice(list(WIDTHS), p=[0.15, 0.5, 0.2, 0.15]))
    scene = random_scene(random, width)
    # 0 Hz is for statics: half of these scenes cannot stand still
    f = frequency(random, scene) or 1e-3
    where = [*random.uniform(0.0, LENGTH, 4).tolist(), 0.0, LENGTH, *places(scene)]
    drive, other = (
        (str(random.choice(WIDTHS[width])), float(random.choice(where))) for _ in range(2)
    )
    return scene, f, drive, drive if random.random() < 0.5 else other


def random_scene(random, width):
    """A scene whose largest component has so many coordinates."""
    rope = random_rope(random, width)
    tension = random_tension(random, rope)
    parts = [part(random, WIDTHS[width]) for _ in range(int(random.integers(0, 4)))]
    return rd.Scene(
        rope,
        tension=tension,
        ends=(end(random, WIDTHS[width]), end(random, WIDTHS[width])),
        damping=damping(random),
        parts=parts,
    )


def stretched_scene(random, width):
    """A random scene whose rope changes over one to three stretches, which may overlap."""
    scene = random_scene(random, width)
    added = [stretch(random, WIDTHS[width]) for _ in range(int(random.integers(1, 4)))]
    return scene.replace(parts=(*scene.parts, *added))


def taut_scene(random, width, most=1e6):
    """A random scene that is not pushed, with T L^2/B up to `most` and now and then none."""
    scene = random_scene(random, width)
    bending = scene.rope.bending_stiffness
    if bending is None:
        return scene
    unit = bending / LENGTH**2
    pull = 0.0 if random.random() < 0.2 else unit * log_uniform(random, 1e-2, most)
    return scene.replace(tension=pull)


def random_rope(random, width):
    """A rope of this many coupled coordinates."""
    if width == 1:
        return rd.Rope(LENGTH, DENSITY)
    bending = log_uniform(random, 1e-2, 1e2)
    inertia = float(random.choice([0.0, 1e-6, 1e-4]))
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=bending, rotary_inertia=inertia)
    if width == 2:
        return rope
    rope = rope.replace(
        torsional_stiffness=bending * log_uniform(random, 1e-2, 1e1),
        polar_inertia=log_uniform(random, 1e-7, 1e-4),
        lay_slope=float(random.choice([-1, 1])) * log_uniform(random, 1e-3, 1),
    )
    if width == 3:
        return rope
    axial = log_uniform(random, 1e2, 1e6)
    most = math.sqrt(axial * rope.torsional_stiffness)
    return rope.replace(axial_stiffness=axial, lay_coupling=most * random.uniform(-0.9, 0.9))


def random_tension(random, rope):
    """None, pulled up to T L^2/B = 1e8, or pushed up to ten times Euler's pinned load."""
    if rope.bending_stiffness is None:
        return log_uniform(random, 1e-2, 1e5)
    unit, kind = rope.bending_stiffness / LENGTH**2, random.random()
    if kind < 0.25:
        return 0.0
    if kind < 0.85:
        return unit * log_uniform(random, 1e-2, 1e8)
    return -unit * math.pi**2 * log_uniform(random, 1e-2, 10)


def end(random, coordinates):
    """Clamped, pinned, free, or springs on what is free."""
    kind = str(random.choice(["clamped", "pinned", "free", "springs"]))
    if kind != "springs":
        return kind
    free = [c for c in coordinates if random.random() < 0.7]
    spring = {c: log_uniform(random, 1e-6, 1e6) for c in free if random.random() < 0.7}
    return rd.End(**dict.fromkeys(free, "free"), spring=spring)


def part(random, coordinates):
    """A mass, a spring of either sign or a support, anywhere, ends included."""
    x = float(random.choice([0.0, LENGTH, 0.25, *random.uniform(0.01, 0.99, 3)])) * LENGTH
    kind = random.random()
    if kind < 0.5:
        mass = log_uniform(random, 1e-6, 1e6)
        turning = log_uniform(random, 1e-6, 1e6) if random.random() < 0.3 else 0.0
        return rd.PointMass(x, mass, rotary_inertia=turning, polar_inertia=turning)
    coordinate = str(random.choice(coordinates))
    if kind < 0.85:
        sign = float(random.choice([-1, 1], p=[0.2, 0.8]))
        return rd.Spring(x, sign * log_uniform(random, 1e-6, 1e9), coordinate=coordinate)
    return rd.Support(x, coordinate=coordinate)


def stretch(random, coordinates):
    """An added mass, or a change of all that the rope has by up to a factor of 100."""
    start, stop = sorted(random.choice(STRETCHES, 2, replace=False).tolist())
    if random.random() < 0.4:
        polar = log_uniform(random, 1e-7, 1e-3)
        return rd.AddedMass(start, stop, log_uniform(random, 1e-3, 1e2), polar_inertia=polar)
    acts_on = {"beta": "bending", "alpha": "torsion", "z": "density"}
    # softer than half the lay coupling might not leave a section
    least = 0.9 if "x" in coordinates else 1e-2
    return rd.LocalChange(
        start,
        stop,
        **{
            name: log_uniform(random, least if name == "torsion" else 1e-2, 1e2)
            for c, name in acts_on.items()
            if c in coordinates
        },
    )


def damping(random):
    """None in half of the scenes."""
    gamma = log_uniform(random, 1e-9, 1e-3)
    every = [None] * 3 + [
        rd.StiffnessDamping(gamma),
        rd.RayleighDamping(log_uniform(random, 1e-3, 1e2), gamma),
        (rd.RayleighDamping(1.0, 0.0), rd.StiffnessDamping(gamma)),
    ]
    return every[int(random.integers(len(every)))]


def frequency(random, scene):
    """0, anywhere from 1e-4 to 1e5 Hz, or within a decade of the rope's first ones [Hz]."""
    kind = random.random()
    if kind < 0.05:
        return 0.0
    if kind < 0.5:
        return log_uniform(random, 1e-4, 1e5)
    bending = scene.rope.bending_stiffness or 0.0
    stiffness = abs(scene.tension) + 10 * bending / LENGTH**2
    first = math.sqrt(stiffness / DENSITY) / (2 * LENGTH)
    return first * log_uniform(random, 0.3, 30)


def log_uniform(random, low, high):
    return math.exp(random.uniform(math.log(low), math.log(high)))


def damped(random, scene):
    """The same scene with dashpots, also at its ends, masses there, and any linear damping."""
    c = scene.coordinates
    places = [0.0, LENGTH, 0.25 * LENGTH, *random.uniform(0.01, 0.99, 2).tolist()]
    dashpots = [
        rd.Dashpot(
            float(random.choice(places)),
            log_uniform(random, 1e-6, 1e6),
            coordinate=str(random.choice(c)),
        )
        for _ in range(int(random.integers(0, 3)))
    ]
    every = [
        rd.ViscousDamping(log_uniform(random, 1e-4, 1e4)),
        rd.LossFactor(log_uniform(random, 1e-6, 1.0)),
        *scene.dampings,
    ]
    return scene.replace(
        ends=tuple(_weighted(random, end, c) for end in scene.ends),
        damping=[one for one in every if random.random() < 0.6],
        parts=[*scene.parts, *dashpots],
    )


def _weighted(random, end, coordinates):
    """An end with dashpots and masses where it has springs."""
    if isinstance(end, str):
        return end
    free = [c for c in coordinates if not end.holds(c)]
    dashpot, mass = (
        {c: log_uniform(random, 1e-6, 1e6) for c in free if random.random() < 0.5} for _ in range(2)
    )
    return dataclasses.replace(end, dashpot=dashpot, mass=mass)
