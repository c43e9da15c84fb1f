"""Random damped ropes."""

import numpy as np

import ropedyn as rd


def damped_rope(random):
    """Return a random rope with springs at its ends and one of the dampings."""
    length, density = random.uniform(2, 60), random.uniform(0.5, 20)
    tension, xi = np.exp(random.uniform(7, 15)), np.exp(random.uniform(2.1, 6.7))
    first = np.sqrt(tension / density) / (2 * length)
    ratio, omega = np.exp(random.uniform(-8, -3)), 2 * np.pi * first
    wave = np.sqrt(tension * density)
    damping, part = {
        0: (rd.RayleighDamping(2 * ratio * omega, 0.4 * ratio / omega), None),
        1: (rd.ModalDamping(ratio), None),
        2: (rd.ViscousDamping(2 * ratio * omega * density), rd.PointMass(0.3 * length, density)),
        3: ((rd.LossFactor(2 * ratio), rd.ViscousDamping(ratio * omega * density)), None),
        4: (rd.RayleighDamping(ratio * omega, 0.0), rd.Dashpot(0.1 * length, 0.2 * wave)),
    }[int(random.integers(5))]
    spring = tension * length / xi * np.exp(random.uniform(-2, 3))
    return rd.Scene(
        rd.Rope(length, density, bending_stiffness=tension * length**2 / xi**2),
        tension=tension,
        ends=(
            rd.End(beta="free", spring={"beta": spring}),
            ("clamped", "pinned")[int(random.integers(2))],
        ),
        damping=damping,
        parts=() if part is None else (part,),
    )
