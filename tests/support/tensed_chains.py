"""Random chains of default elements, many with lumps of negative inertia, and their motion."""

import numpy as np

import ropedyn as rd

FINER = 16  # The reference has so many times as many times: its rates reach as much farther.
AT = (0.25, 0.4, 0.5, 0.63)


def random_chain(rng):
    """Return a chain of uneven elements between any ends."""
    length, mass = rng.uniform(0.5, 3.0), 10 ** rng.uniform(-1.3, 0.3)
    rope = rd.Rope(
        length,
        mass,
        bending_stiffness=10 ** rng.uniform(-4.0, 1.5),
        rotary_inertia=rng.choice([0.0, 10 ** rng.uniform(-7.0, -3.0)]),
    )
    spring = {"z": 10 ** rng.uniform(0.0, 4.0)}
    free = rd.End(z="free", beta="free", spring=spring)
    parts = [
        rd.Dashpot(rng.choice(AT) * length, 10 ** rng.uniform(-2.0, 1.5)),
        rd.PointMass(rng.choice([0.3, 0.45]) * length, 10 ** rng.uniform(-2.0, 0.0)),
    ][: rng.integers(1, 3)]
    damping = (
        None,
        rd.ViscousDamping(1.0),
        rd.RayleighDamping(1.0, 1e-5),
        rd.StiffnessDamping(1e-5),
    )
    scene = rd.Scene(
        rope,
        tension=10 ** rng.uniform(1.0, 3.5),
        ends=tuple(("pinned", "clamped", free)[k] for k in rng.integers(0, 3, 2)),
        parts=parts,
        damping=damping[rng.integers(0, 4)],
    )
    return scene.compile(elements=int(rng.integers(4, 24)))


def beyond(seed):
    """Return whether motion is beyond its error and the reference's; None: refused."""
    rng = np.random.default_rng(seed)
    model = random_chain(rng)
    rope, x = model.scene.rope, model.x[1:-1]
    wave = np.sqrt(model.scene.mean_tension / rope.linear_density)
    span, count = rng.uniform(1.0, 8.0) * rope.length / wave, int(rng.integers(60, 260))
    forces = (
        rd.Impulse(0.1),
        rd.Step(1.0, time=rng.uniform(0.0, 0.5) * span),
        rd.Impulse(0.1, duration=rng.uniform(1.0, 10.0) * span / count),
        rd.Sine(1.0, rng.uniform(1.5, 30.0) / span),
    )
    asked = {
        "drive": (str(rng.choice(["z", "z", "z", "beta"])), rng.choice(x)),
        "force": forces[rng.integers(0, 4)],
        "response": [
            (str(rng.choice(["z", "beta", "F_z", "M_beta"])), rng.choice(x)) for _ in range(3)
        ],
        "quantity": str(rng.choice(["displacement", "velocity"])),
    }
    times = (np.linspace(0.0, span, (count - 1) * k + 1) for k in (1, FINER))
    try:
        some, more = (
            model.transient(time, **asked, tolerance=to) for time, to in zip(times, (1e-3, 1e-2))
        )
    except rd.SolveError:
        return None
    off = np.abs(some.value - more.value[:, ::FINER])
    return bool((off > some.error + more.error[:, ::FINER]).any())
