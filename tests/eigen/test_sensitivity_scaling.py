"""Derivatives with respect to all numbers of a scene, held together by its units."""

import numpy as np
import pytest
from conftest import EPS
from random_scene import LENGTH, damped, log_uniform, random_scene, stretched_scene
from test_sensitivity import PATH, value_of

import ropedyn as rd
from ropedyn.chain.rate import rates_of
from ropedyn.eigen.sensitivity import sizes

LENGTHS = {"x": 0, "z": 0, "alpha": 2, "beta": 2}
"""Powers of length in what stands at a node, mass [kg, kg m^2] or stiffness [N/m, N m]."""
ROPE = {
    "tension": (1, 0, 1),
    "axial_stiffness": (1, 0, 1),
    "torsional_stiffness": (1, 0, 3),
    "bending_stiffness": (1, 0, 3),
    "lay_coupling": (1, 0, 2),
    "lay_slope": (0, 0, 0),
    "linear_density": (0, 1, -1),
    "rotary_inertia": (0, 1, 1),
    "polar_inertia": (0, 1, 1),
    "length": (0, 0, 1),
}
PART = {
    "x": (0, 0, 1),
    "start": (0, 0, 1),
    "stop": (0, 0, 1),
    "mass": (0, 1, 0),
    "rotary_inertia": (0, 1, 2),
    "polar_inertia": (0, 1, 2),
    "linear_density": (0, 1, -1),
    "bending": (0, 0, 0),
    "torsion": (0, 0, 0),
    "density": (0, 0, 0),
    "axial": (0, 0, 0),
    "lay": (0, 0, 0),
    "damping": (0, 0, 0),
    "frequency": (0.5, -0.5, 0),
    "damping_ratio": (0, 0, 0),
    "length": (0, 0, 1),
    "diameter": (0, 0, 1),
    "radius": (0, 0, 1),
    "angle": (0, 0, 0),
    "youngs_modulus": (1, 0, -1),
    "density of a wire": (0, 1, -3),
}
KINDS = {
    "continuous": {},
    "tensed": {"elements": 12},
    "rigid": {"elements": 40, "element": "rigid"},
}
ACCEPTED = 1e-12
"""Of the sum of the sizes, as single derivatives of closed forms have."""
RIGID = 1e-6
"""Of the first eigenvalue of the rope alone, 1 m long: below it a mode is nearly rigid, and beyond
its inverse local."""
PLACES = 1e-9
"""Of lengths, in units of all of them: what moves a place adds on one side of it what it takes on
the other, and only the rest is seen."""
ROUNDING = 64 * EPS
"""Of lengths, in units of what the same elements would have if their nodes moved to and fro as much
as the mode does: shear forces are differences of the motion of neighbours."""


def powers(scene, path):
    """Of stiffness, inertia and length in a number, with newtons as kg m/s^2 and seconds kept."""
    if path in ROPE:
        return ROPE[path]
    kind, i, of, name = PATH.fullmatch(path).groups()
    if kind == "ends":
        stiffness, inertia = float(of == "spring"), float(of == "mass")
        return stiffness, inertia, LENGTHS[name] * (of != "dashpot")
    part = scene.parts[int(i)]
    if name == "stiffness":
        return 1, 0, LENGTHS[part.coordinate]
    if isinstance(part, rd.BrokenWire) and name == "density":
        return PART["density of a wire"]
    along = isinstance(part, rd.AddedMass) and name == "polar_inertia"
    return ROPE[name] if along else PART[name]


def imbalance(scene, kind):
    """Sums of powers times p dlambda/dp, in units of the sum of their sizes.

    Lambda has the powers (1, -1, 0): where all stiffness, all inertia or the unit of length is
    scaled it changes as that, or not at all.

    Returns
    -------
    tuple of three float
        The last is in units of what is allowed, NaN where parts stand together, whose places have
        no derivatives.
    """
    model = scene.compile(**KINDS[kind])
    modes = model.modes(4)
    # nearly rigid motion deforms by rounding, growth under a negative spring is a point of the
    # rope, and clusters have no mode of their own
    rope = scene.rope
    own = (abs(scene.tension) + 10 * (rope.bending_stiffness or 0.0)) / rope.linear_density
    single = [c[0] for c in modes.sensitivity.shapes.clusters if len(c) == 1]
    kept = [k for k in single if RIGID * own < abs(modes.eigenvalue[k]) < own / RIGID]
    sensitivity = modes.sensitivity
    mass = sensitivity.mass.diagonal()
    total, size = np.zeros((3, len(mass))), np.zeros((3, len(mass)))
    rounding = np.zeros(len(mass))
    for path, rate in rates_of(sensitivity.places).items():
        power = np.array(powers(scene, path))
        value = value_of(scene, path)
        try:
            weights = sizes(rate().weights(sensitivity.places))
            change = value * sensitivity.eigenvalue(path)
        except rd.SceneError:
            total[2] = np.nan
            continue
        total += power[:, None] * change
        size += np.abs(power[:, None] * change)
        largest = sensitivity.largest.weigh_stiffness(weights) / mass
        rounding += abs(power[2] * value) * largest
    eigenvalue = sensitivity.shapes.eigenvalue
    total[0] -= eigenvalue
    total[1] += eigenvalue
    size = np.maximum(size, np.abs(eigenvalue))
    size[2] = np.maximum(size[2] * PLACES, rounding * ROUNDING)
    return (np.abs(total[:, kept]) / size[:, kept]).max(axis=1, initial=0.0)


def balance(seed, kind, whole):
    """`imbalance` of a random scene that has modes."""
    random = np.random.default_rng(seed)
    scene = whole(random, int(random.choice([1, 2, 3, 4]))).replace(damping=None)
    try:
        return imbalance(scene, kind)
    except rd.SolveError as refusal:
        # a mass is all there is, or a part of the rope is pushed too hard
        pytest.skip(str(refusal))


def check_seed(seed, kind, claim, whole=random_scene):
    """Check the balance of a random scene."""
    stiffness, inertia, length = balance(seed, kind, whole)
    claim(max(stiffness, inertia))
    assert not length > 1


def balance_of(scenes):
    """The claim about such scenes."""
    return pytest.mark.claim(
        "sum of p dlambda/dp over all stiffnesses is lambda, over all inertias -lambda; " + scenes,
        reference="scaling of units (Euler's theorem of homogeneous functions)",
        accepted=1e-13,
    )


BALANCE = balance_of("random scenes")
CHANGING = balance_of("random scenes with stretches, dashpots and masses at the ends")


@BALANCE
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_derivatives_balance_as_units_do(seed, kind, claim):
    check_seed(seed, kind, claim)


@BALANCE
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(100, 400))
def test_derivatives_of_many_scenes_balance_as_units_do(seed, kind, claim):
    check_seed(seed, kind, claim)


CARRYING = pytest.mark.claim(
    "sum of p dlambda/dp over all stiffnesses is lambda; random scenes with resonators and broken "
    "wires",
    reference="scaling of units (Euler's theorem of homogeneous functions)",
    accepted=8e-14,
)


def check_carrying(seed, kind, claim):
    """Check the balance of a random scene with structures.

    A larger structure is felt by the motion of its foot, so that an error of the shape is of first
    order in the sum over inertias, where it is of second order in energies. Nearly rigid shapes err
    by a rounding of the rope's own eigenvalue over theirs.
    """
    stiffness, inertia, length = balance(seed, kind, carrying_scene)
    claim(stiffness)
    assert inertia <= EPS / RIGID
    assert not length > 1


def carrying_scene(random, width):
    """A random scene with resonators and broken wires."""
    scene = random_scene(random, width)
    resonators = [
        rd.Resonator(
            float(random.uniform(0.01, 0.99)) * LENGTH,
            log_uniform(random, 1e-4, 1e1),
            log_uniform(random, 1e-1, 1e3),
        )
        for _ in range(int(random.integers(1, 3)))
    ]
    length = log_uniform(random, 0.02, 1.0)
    wire = rd.BrokenWire(
        float(random.uniform(0.01, 0.99)) * LENGTH,
        length,
        length * log_uniform(random, 1e-3, 1e-1),
        radius=float(random.uniform(-1e-2, 1e-2)),
    )
    return scene.replace(parts=(*scene.parts, *resonators, wire))


def changing_scene(random, width):
    """A random scene with stretches, dashpots, and masses at its ends."""
    return damped(random, stretched_scene(random, width))


@CHANGING
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_derivatives_of_changed_ropes_balance_as_units_do(seed, kind, claim):
    check_seed(seed, kind, claim, changing_scene)


@CHANGING
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(100, 400))
def test_derivatives_of_many_changed_ropes_balance_as_units_do(seed, kind, claim):
    check_seed(seed, kind, claim, changing_scene)


@CARRYING
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_derivatives_of_what_carries_balance_as_units_do(seed, kind, claim):
    check_carrying(seed, kind, claim)


@CARRYING
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(100, 400))
def test_derivatives_of_many_that_carry_balance_as_units_do(seed, kind, claim):
    check_carrying(seed, kind, claim)
