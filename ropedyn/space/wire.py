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


def wound_wire(wire: BrokenWire) -> Scene:
    """Return a broken wire that is wound, alone: a helix about the rope's axis, its root held.

    A scene with it as a part has it on a rope; this is for its own modes and responses. Along it x
    is its tangent, z points to the axis of the rope.

    Parameters
    ----------
    wire : BrokenWire
        One with a `lay_length`; its `radius` is that of the helix.

    Returns
    -------
    Scene

    Raises
    ------
    TypeError
        If it is no `BrokenWire`.
    SceneError
        If it is not wound.

    Examples
    --------
    A wire of 50 mm beside a straight one:

    >>> import ropedyn as rd
    >>> straight = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)
    >>> wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3, lay_length=0.03)
    >>> modes = rd.wound_wire(wire).compile().modes(2)
    >>> print(round(straight.frequency, 2), modes.frequency.round(2))
    86.0 [91.55 91.94]
    """
    check.instance(wire, "wire", BrokenWire, "a BrokenWire")
    if wire.lay_length is None:
        raise SceneError("lay_length must be given of a wire that is wound, got None")
    lay, radius = wire.lay_length, abs(wire.radius)
    pitch = math.atan2(lay, 2 * math.pi * radius)
    area = math.pi * wire.diameter**2 / 4
    inertia = area * wire.diameter**2 / 16
    E, rho = wire.youngs_modulus, wire.density
    hand = "right" if wire.sense == "Z" else "left"
    axis: Any = Axis.helix(radius, pitch, hand=hand, length=wire.length)
    rope = Rope(
        axis,
        rho * area,
        bending_stiffness=E * inertia,
        torsional_stiffness=E * inertia / (1 + wire.poissons_ratio),
        axial_stiffness=E * area,
        rotary_inertia=rho * inertia,
        polar_inertia=2 * rho * inertia,
    )
    damped: Any = LossFactor(2 * wire.damping_ratio) if wire.damping_ratio else None
    return Scene(rope, ends=("clamped", "free"), planes="both", damping=damped)
