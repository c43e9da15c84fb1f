"""What acts on a chain beside its own elements, dashpots and springs."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...chain.chain import KINDS, Chain, roles
from ...chain.compiled import Compiled
from ...scene.damping import DASHPOT, INERTIA, SECTION, SPRING, TENSION, factors
from ...scene.tension import Tension

RIGID = KINDS.index("rigid")


class Beside(NamedTuple):
    """What acts beside the chain; see csrc/march/form/march.h."""

    rate: Real  # (distinct,) damping of each element's own stiffness [s]
    spring_rate: float  # Damping of node springs [s]
    string: Real  # (distinct,) tension of a string in parallel to each element [N]
    string_drag: Real  # (distinct,) that times its damping [N s]
    stretching: float  # EA/L where motion adds to the tension [N/m]
    mass_rate: float  # Damping of the masses of resonators, of the mass [1/s]


def plain_lumps(model: Compiled, component: tuple[str, ...], chain: Chain) -> tuple[Chain, Beside]:
    """Return the chain with plain lumps and dashpots, and what stands beside it."""
    share = factors(model.scene.dampings, np.array(1.0)).imag
    mass = np.eye(len(component)) * chain.mass
    damping = share[INERTIA] * mass
    if chain.damping is not None:
        damping += share[DASHPOT] * chain.damping
    names = roles(component)
    is_string = "beta" not in names and "z" in names
    rate = share[TENSION if is_string else SECTION]
    apart = (
        chain.kind == RIGID
        and "beta" in names
        and (share[TENSION] != rate or (chain.tension < 0).any())
    )
    scene, stiffness = model.scene, 0.0
    if "z" in names and isinstance(scene.tension, Tension) and scene.tension.stretching:
        stiffness = scene.rope.axial_stiffness or 0.0
    string = chain.tension if apart else np.zeros_like(chain.tension)
    return chain._replace(
        mass=mass,
        damping=damping if damping.any() else None,
        tension=np.zeros_like(chain.tension) if apart else chain.tension,
    ), Beside(
        rate=np.full(len(chain.length), rate),
        spring_rate=float(share[SPRING]),
        string=string.copy(),
        string_drag=share[TENSION] * string,
        stretching=stiffness / scene.rope.length,
        mass_rate=float(share[INERTIA]),
    )


def pulsation_of(model: Compiled, component: tuple[str, ...]) -> Callable[[Real], Real] | None:
    """Return what is added to the tension of these coordinates [N] at times [s]."""
    tension = model.scene.tension
    acts = "z" in roles(component) and isinstance(tension, Tension) and tension.pulsates
    return tension.pulsation if acts and isinstance(tension, Tension) else None
