"""Random ropes on an axis: of all kinds, with ends, tension, torque and sections of all sizes."""

import numpy as np

import ropedyn as rd


def axis(rng, kind):
    """An arc, a helix, arms in space or arms in a plane."""
    if kind == 0:
        return rd.Axis.arc(10 ** rng.uniform(-1, 1), rng.uniform(0.2, 6))
    if kind == 1:
        return rd.Axis.helix(
            10 ** rng.uniform(-1, 0), rng.uniform(0.1, 1.4), rng.uniform(0.3, 4), hand="left"
        )
    points = np.cumsum(rng.normal(size=(rng.integers(3, 5), 3)), axis=0)
    if kind == 3:
        points[:, 1] = 0.0
    try:
        return rd.Axis.points(points, fillet=0.05 if rng.random() < 0.5 else None)
    except rd.SceneError:  # corners too close for the fillet
        return axis(rng, kind)


def scene(rng, *, damped=False):
    """A scene; without damping but where asked for."""
    kind, B = rng.integers(4), 10 ** rng.uniform(0, 2)
    own, how = axis(rng, kind), {"bending_stiffness": B}
    if rng.random() < 0.5:
        how["axial_stiffness"] = 10 ** rng.uniform(4, 7)
    if rng.random() < 0.3:
        how["shear_stiffness"] = 10 ** rng.uniform(4, 6)
    if rng.random() < 0.5:
        how["rotary_inertia"], how["polar_inertia"] = 10 ** rng.uniform(-5, -3, 2)
    if rng.random() < 0.3:
        how["bending_stiffness"] = (B, B * 10 ** rng.uniform(-1, 1))
    torsion = B * 10 ** rng.uniform(-1, 1)
    rope = rd.Rope(own, 10 ** rng.uniform(-1, 1), torsional_stiffness=torsion, **how)
    load = {}
    if kind < 2:
        size = B / rope.length**2
        if rng.random() < 0.6:
            load["tension"] = size * rng.choice([-30.0, 1.0, 1.0]) * 10 ** rng.uniform(-1, 3)
        if rng.random() < 0.2:
            load["torque"] = B / rope.length * rng.uniform(-2, 2)
    if damped and rng.random() < 0.3:
        load["damping"] = rd.RayleighDamping(1.0, 1e-6)
    ends = tuple(rng.choice(["clamped", "pinned", "free"], 2).tolist())
    return rd.Scene(rope, planes="both", ends=ends, **load)


def twisted(rng):
    """A straight rope under tension and a torque up to that which two pinned ends bear."""
    length, both = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-1, 2) * 10 ** rng.uniform(0, 1, 2)
    tension = both.min() / length**2 * 10 ** rng.uniform(-1, 4)
    most = np.sqrt(4 * both.min() * tension + (2 * np.pi * both.min() / length) ** 2)
    rope = rd.Rope(length, 10 ** rng.uniform(-1, 1), bending_stiffness=tuple(both.tolist()))
    ends = tuple(rng.choice(["clamped", "pinned"], 2).tolist())
    torque = most * rng.uniform(-1, 1)
    return rd.Scene(rope, planes="both", ends=ends, tension=tension, torque=torque)
