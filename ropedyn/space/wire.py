"""A wire of a rope that is broken, and still wound."""

from __future__ import annotations

import math
from typing import Any

from ..axis.axis import Axis
from ..base import check
from ..base.errors import SceneError
from ..scene.damping import LossFactor
from ..scene.parts.broken_wire import BrokenWire
from ..scene.rope import Rope
from ..scene.scene import Scene


def wound_wire(
    wire: BrokenWire, *, lay_length: float, sense: str = "right", poisson: float = 0.3
) -> Scene:
    """Return a broken wire as it lies in the rope: a helix about its axis, held at its root.

    A `BrokenWire` of a scene is a straight cantilever; this is the same wire with the shape that
    the lay gave it, alone, for its own modes and responses. Along it x is its tangent, z points to
    the axis of the rope.

    Parameters
    ----------
    wire : BrokenWire
        Its `radius` is that of the helix.
    lay_length : float
        Along the rope in one turn [m].
    sense : {"right", "left"}
        As a screw.
    poisson : float
        Poisson's ratio, from -1 to 1/2, of the torsional stiffness E I/(1 + nu).

    Returns
    -------
    Scene

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If a number is out of range, or the wire has no radius.

    Examples
    --------
    A wire of 50 mm beside a straight one:

    >>> import ropedyn as rd
    >>> wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)
    >>> modes = rd.wound_wire(wire, lay_length=0.03).compile().modes(2)
    >>> print(round(wire.frequency, 2), modes.frequency.round(2))
    86.0 [91.55 91.94]
    """
    check.instance(wire, "wire", BrokenWire, "a BrokenWire")
    lay = check.number(lay_length, "lay_length", "m", sign="positive")
    nu = check.number(poisson, "poisson")
    if not -1 < nu <= 0.5:
        raise SceneError(f"poisson must be from -1 to 1/2, got {poisson!r}")
    check.one_of(sense, "sense", ("right", "left"))
    radius = abs(wire.radius)
    if radius == 0:
        raise SceneError("wire must lie beside the axis of the rope, got the radius 0 m")
    pitch = math.atan2(lay, 2 * math.pi * radius)
    turns = wire.length / math.hypot(lay, 2 * math.pi * radius)
    area = math.pi * wire.diameter**2 / 4
    inertia = area * wire.diameter**2 / 16
    E, rho = wire.youngs_modulus, wire.density
    axis: Any = Axis.helix(radius, pitch, turns, hand=sense)
    rope = Rope(
        axis,
        rho * area,
        bending_stiffness=E * inertia,
        torsional_stiffness=E * inertia / (1 + nu),
        axial_stiffness=E * area,
        rotary_inertia=rho * inertia,
        polar_inertia=2 * rho * inertia,
    )
    damped: Any = LossFactor(2 * wire.damping_ratio) if wire.damping_ratio else None
    return Scene(rope, ends=("clamped", "free"), planes="both", damping=damped)
