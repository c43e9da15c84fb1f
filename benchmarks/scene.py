"""The scene of the benchmarks: a rope of 2830 N, damped, uniform or different at every node."""

import dataclasses
from collections.abc import Sequence

import numpy as np

import ropedyn as rd

LENGTH, DENSITY, BENDING, TENSION, GAMMA = 1.35, 0.1017, 1.54, 2830.0, 1e-4
"""[m], [kg/m], [N m^2], [N], [s]."""

TWIST = {"torsional_stiffness": 0.1485, "polar_inertia": 1.4e-7, "lay_slope": 0.01}

KINDS = {
    "uniform": "nothing on the rope",
    "masses": "another point mass at every node, elements equal but for rounding",
    "different": "another point mass at every node, every element of another length",
}


def scene(
    parts: Sequence[rd.PointMass | rd.Spring] = (),
    *,
    ends: str = "clamped",
    **properties: float | None,
) -> rd.Scene:
    """Return the rope, with these parts and more properties."""
    return rd.Scene(
        rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING, **properties),
        tension=TENSION,
        ends=(ends, ends),
        damping=rd.StiffnessDamping(GAMMA),
        parts=parts,
    )


def model(
    kind: str,
    elements: int,
    *,
    twist: bool,
    ends: str = "clamped",
    rotary: bool = False,
    element: str = "rigid",
) -> rd.Model:
    """Compile the scene; with `rotary` the elements are rigid bodies, mu (L/n)^2/12."""
    whole = scene(
        [] if kind == "uniform" else _masses(kind, elements),
        ends=ends,
        rotary_inertia=DENSITY * (LENGTH / elements) ** 2 / 12 if rotary else None,
        **(TWIST if twist else {}),
    )
    return whole.compile(elements=elements, element=element)


def _masses(kind: str, elements: int) -> list[rd.PointMass]:
    """Return masses up to that of an element, a quarter of an element off where lengths differ."""
    random = np.random.default_rng(1)
    off = random.uniform(-0.25, 0.25, elements - 1) if kind == "different" else 0.0
    x = LENGTH * (np.arange(1, elements) + off) / elements
    mass = DENSITY * LENGTH / elements * random.uniform(0, 1, elements - 1)
    return [rd.PointMass(*pair) for pair in zip(x.tolist(), mass.tolist())]


def chain_of_different(elements: int, *, rotary: bool = False) -> rd.Model:
    """Put random lengths and masses into a uniform model: no million parts to hold in memory."""
    uniform = model("uniform", elements, twist=False, rotary=rotary)
    random = np.random.default_rng(1)
    chain = uniform.chain
    length = random.uniform(0.5, 1.5, elements)
    length *= LENGTH / length.sum()
    mass = chain.mass[chain.term_of]
    mass *= random.uniform(1, 2, (elements + 1, 1, 1))
    different = chain._replace(
        length=length,
        tension=np.full(elements, TENSION),
        flexibility=np.repeat(chain.flexibility, elements, axis=0),
        first=np.arange(elements + 1, dtype=np.int32),
        element=np.arange(elements, dtype=np.int32),
        mass=mass,
        stiffness=np.zeros(mass.shape),
        held=chain.held[chain.term_of],
        term=np.arange(elements + 1, dtype=np.int32),
    )
    x = np.concatenate([[0.0], np.cumsum(length)])
    return dataclasses.replace(uniform, x=x, chain=different)
