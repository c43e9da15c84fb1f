"""Laws that are what linear parts are: their motion is that of the parts, by other methods."""

import numpy as np
import pytest

import ropedyn as rd

TIME = np.linspace(0.0, 0.05, 151)
DAMPINGS = (None, None, rd.RayleighDamping(1.0, 1e-5), rd.ViscousDamping(0.4))


def random_scene(rng):
    """A scene with masses, resonators, wires and springs, and a place on it."""
    bending, length = float(rng.choice([0.0, 0.5, 5.0])), float(rng.uniform(0.5, 3.0))
    laid = bending > 0 and rng.random() < 0.25
    rope = rd.Rope(length, 0.3)
    if bending:
        rope = rope.replace(bending_stiffness=bending)
    if laid:
        rope = rope.replace(torsional_stiffness=bending / 2, polar_inertia=1e-5, lay_slope=0.3)
    count = int(rng.integers(4, 12))

    def place():
        return length / count * float(rng.integers(1, count))

    kinds = (
        lambda: rd.PointMass(place(), 0.2, polar_inertia=1e-4 * laid),
        lambda: rd.Resonator(place(), 0.01, float(rng.uniform(20.0, 200.0)), damping_ratio=0.02),
        lambda: rd.BrokenWire(place(), 0.05, 3e-4, radius=2e-3),
        lambda: rd.Spring(place(), 1e4),
    )
    parts = tuple(kinds[rng.integers(len(kinds))]() for _ in range(rng.integers(0, 3)))
    elements = ["rigid", "tensed"][: 1 + (bending > 0)]
    how = {} if rng.random() < 0.3 else {"elements": count, "element": str(rng.choice(elements))}
    damping = DAMPINGS[rng.integers(len(DAMPINGS))]
    tension = float(rng.choice([300.0, 3000.0]))
    return rd.Scene(rope, tension=tension, parts=parts, damping=damping), how, place


def random_question(rng, scene, place):
    """What drives it, and what is asked for."""
    noise = 0.3 * rng.normal(size=len(TIME)).cumsum()
    forces = (
        rd.Sine(5.0, 40.0),
        rd.Impulse(0.02, time=0.01, duration=2e-3),
        rd.Step(3.0, time=0.0201),
        noise,
        rd.Chirp(3.0, 10.0, 300.0, 0.05),
    )
    response = [("z", place()), ("F_z", place())]
    wires = sum(isinstance(part, rd.BrokenWire) for part in scene.parts)
    response += [("wire", k) for k in range(wires)]
    return {"drive": ("z", place()), "force": forces[rng.integers(5)], "response": response}


def laws(rng, x, damped):
    """Linear parts, and laws that are the same; beside damped stiffness without a spring."""
    c, k = float(rng.choice([0.5, 8.0])), 0.0 if damped else float(rng.choice([1e2, 1e4]))
    dashpot, spring = rd.Dashpot(x, c), [rd.Spring(x, k)] if k else []
    stops = [rd.Stop(x, k or 1.0, gap=0.0 if k else 9.0, side=side) for side in (-1, 1)]
    same = (
        [rd.NodeForce(x, lambda t, u, v: -c * v - k * u)],
        [dashpot, *stops],
        [dashpot, *spring, rd.Dashpot(x, 1e-12, exponent=0.0)],
        [dashpot, *spring, rd.Dashpot(x, 1e-12, exponent=2.0)],
    )
    return [dashpot, *spring], same[rng.integers(len(same))]


def followed(seed):
    """Whether both were answered; the motion under laws is within both errors of the other."""
    rng = np.random.default_rng(seed)
    scene, how, place = random_scene(rng)
    asked = random_question(rng, scene, place)
    damped = any(isinstance(one, rd.RayleighDamping) for one in scene.dampings)
    try:
        exact, found = (
            scene.replace(parts=[*scene.parts, *parts]).compile(**how).transient(TIME, **asked)
            for parts in laws(rng, place(), damped)
        )
    except rd.SolveError:
        return False
    # what is nothing is known to the rounding of what is not
    least = 1e-13 * np.abs(exact.value).max()
    off = np.abs(found.value - exact.value)
    assert (off <= found.error + exact.error + least).all(), seed
    return True


@pytest.mark.parametrize("seeds", [range(8), range(8, 16), range(16, 24)], ids=str)
def test_laws_that_are_linear_parts_move_as_these(seeds):
    """Tips of wires stood still, and a velocity lacked the jump of a force at the last time."""
    assert sum(map(followed, seeds)) >= 6
