"""What must agree in a scene: places, coordinates, tension, weight."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..axis.axis import Axis
from ..axis.catenary import jumps
from ..base import check
from ..base.errors import SceneError
from ..base.parameter import positions
from . import damping
from . import end as _end
from .parts import part as _part
from .parts.broken_wire import BrokenWire
from .parts.stretch import Stretch, changeable, refuse_uneven, ropes
from .rope import ACROSS, own_number
from .stations import stations_at
from .tension import Tension
from .weight import hanging, place_of, refuse_slack, rubbing

if TYPE_CHECKING:
    from .described import Described


def agree(scene: Described) -> None:
    """Refuse what has no meaning together."""
    _check_on_axis(scene)
    _check_coordinates(scene)
    _check_planes(scene)
    _check_places(scene)
    _check_tension(scene)
    # a rope that is changed must be one
    if changing := _part.stretches(scene.parts):
        ends = stations_at(scene.rope.length, _part.places(changing))
        ropes(scene.rope, changing, ends)
    _check_gravity(scene)
    _check_stretching(scene)
    _check_friction(scene)


def refuse_axis(scene: Described, what: str) -> None:
    """Refuse what is known of straight ropes alone."""
    if scene.rope.axis is not None:
        raise SceneError(f"rope must be straight for {what}, got one on an axis")
    refuse_inclined(scene, what)
    if scene.is_spatial:
        raise SceneError(f"torque, principal_angle and wound wires must be left out for {what}")


def refuse_inclined(scene: Described, what: str) -> None:
    """Refuse a rope that has no parabola, but its catenary alone."""
    if scene.sags and scene.is_graded:
        raise SceneError(
            f"sag or own_weight must be False for {what}, got gravity that both curves a rope and "
            "changes its tension along it"
        )


def in_space(scene: Described) -> str:
    """Say of what all six coordinates are solved at once."""
    if scene.rope.axis is not None:
        return "a rope on an axis"
    if scene.sags:
        return "a rope on its catenary"
    return "a rope with torque, turned principal axes or a wound wire"


def _check_on_axis(scene: Described) -> None:
    """Refuse what is not carried where six coordinates are solved at once."""
    if scene.rope.axis is None:
        _refuse_of_axis(scene)
    if not scene.is_spatial:
        return
    axis, hangs = scene.rope.axis, hanging(scene.rope, scene.gravity)
    what = in_space(scene)
    if scene.planes != "both" and hangs is None:
        raise SceneError(f'planes must be "both" for {what}, got "z"')
    heavy = scene.gravity is not None and hangs is None
    absent = {
        "gravity": check.shown(scene.gravity) if heavy else "",
        "damping": "a ModalDamping" if damping.having(scene.dampings, "ratio") else "",
    }
    for name, got in absent.items():
        if got:
            raise SceneError(f"{name} must be left out for {what}, got {got}")
    _check_parts_in_space(scene, what)
    if axis is not None and axis.closed:
        _check_closed(scene)
    if hangs is not None:
        _check_hanging(scene, hangs)
        _check_loads(scene, hangs)
    elif isinstance(scene.tension, Tension) and not (scene.tension.is_constant and axis):
        got = check.shown(scene.tension)
        raise SceneError(f"tension must be one number for {what} [N], got {got}")
    if rubs := rubbing(scene.rope, scene.tension):
        _check_rubbing(scene, rubs)
    if scene.axial_force:
        _check_axial_force(scene)
    is_string = axis is not None and scene.rope.bending_stiffness is None
    if is_string and not scene.mean_tension > 0:
        raise SceneError(
            "bending_stiffness must be given of a rope on an axis without tension, got None"
        )
    if scene.torque and scene.rope.bending_stiffness is None:
        raise SceneError(
            f"torque must be 0 without bending_stiffness of the rope, got {scene.torque:g} N m"
        )
    _check_corners(scene)


def _refuse_of_axis(scene: Described) -> None:
    """Refuse what only a rope on an axis has."""
    if isinstance(scene.tension, Tension) and scene.tension.friction:
        raise SceneError(
            f"friction of the tension must be 0 of a straight rope, got {scene.tension.friction!r}"
        )
    if scene.axial_force:
        raise SceneError(
            f"axial_force must be 0 of a straight rope, got {scene.axial_force:g} N: say tension"
        )


IN_SPACE = ("point mass", "spring", "dashpot", "support", "broken wire")
"""Kinds of parts that a rope carries whose six coordinates are solved at once."""


def _check_parts_in_space(scene: Described, what: str) -> None:
    """Refuse parts that are not carried where six coordinates are solved at once."""
    for i, part in enumerate(scene.parts):
        if part.kind not in IN_SPACE:
            raise SceneError(
                f"parts[{i}] must be one of {', '.join(IN_SPACE)} for {what}, got {part.kind}"
            )
        if isinstance(part, BrokenWire) and not part.is_wound:
            raise SceneError(f"parts[{i}].lay_length must be given for {what}, got None")
        if isinstance(part, _part.Dashpot) and part.exponent != 1:
            raise SceneError(f"parts[{i}].exponent must be 1 for {what}, got {part.exponent!r}")


def _check_closed(scene: Described) -> None:
    """Refuse what a rope without ends does not have."""
    turned, rubs = scene.rope.principal_angle, rubbing(scene.rope, scene.tension)
    absent = {
        "ends": check.shown(scene.ends) if scene.ends != ("clamped", "clamped") else "",
        "friction of the tension": rubs.friction if rubs else "",
        "principal_angle along the rope": check.shown(turned) if isinstance(turned, tuple) else "",
    }
    for name, got in absent.items():
        if got:
            raise SceneError(f"{name} must be left out on an axis that is closed, got {got}")


def _check_rubbing(scene: Described, rubs: Tension) -> None:
    """Refuse what does not rest on sheaves by T' = friction kz T."""
    axis = scene.rope.axis
    assert axis is not None
    if not axis.is_uniform:
        raise SceneError(
            "friction of the tension must be 0 on an axis that is not of lines, arcs and helices, "
            f"got {rubs.friction!r}"
        )
    if not rubs.mean > 0:
        raise SceneError(
            "tension must be > 0 for friction, which a rope that presses on nothing has not, got "
            f"{rubs.mean:g} N"
        )
    bends, twists = (
        (own_number(scene.rope, name) or 0.0) * (scene.rope.natural == "straight")
        for name in ("bending_stiffness", "torsional_stiffness")
    )
    tension = scene.tension_at(axis.joints)
    for piece, one, other in zip(axis.pieces, tension, tension[1:]):
        tau, kz, _ = piece.rates(np.zeros(1))[0]
        # Vy = kz (tau (B - C) - M) presses by tau Vy beside kz T
        left = abs(tau * (tau * (bends - twists) - scene.torque)) / min(one, other)
        if kz and left > UNBALANCED:
            raise SceneError(
                "friction of the tension must be 0 where twist presses on the sheave too: it "
                f"leaves {left:.2g} of what the tension presses by, got {rubs.friction!r}"
            )


def _check_axial_force(scene: Described) -> None:
    """Refuse a load along the axis of what is no spring."""
    axis, got = scene.rope.axis, f"got {scene.axial_force:g} N"
    if axis is None or len(axis.pieces) > 1 or not axis.is_uniform or axis.is_straight:
        raise SceneError(f"axial_force must be 0 on an axis that is no helix, {got}")
    if not axis.rates(0.0)[0]:
        raise SceneError(f"axial_force must be 0 on a circle, along whose axis none climbs, {got}")
    if scene.tension != 0:
        raise SceneError(
            "tension must be 0 beside axial_force, which tenses the spring, got "
            f"{check.shown(scene.tension)}"
        )
    if scene.rope.bending_stiffness is None:
        raise SceneError(f"axial_force must be 0 without bending_stiffness of the rope, {got}")


def _check_corners(scene: Described) -> None:
    """Refuse what nothing balances at a corner."""
    hangs = hanging(scene.rope, scene.gravity) is not None
    kinks = scene.rope.axis.kinks if scene.rope.axis and not hangs else ()
    corners = [kink.s for kink in kinks if abs(kink.turn[0, 0] - 1) > check.NEAR]
    loads = ("tension", scene.mean_tension, "N"), ("torque", scene.torque, "N m")
    for name, value, unit in loads:
        if value != 0 and corners:
            raise SceneError(
                f"{name} must be 0 on an axis with corners, where nothing balances it: give them a "
                f"fillet, got {value:g} {unit} at the corner at {corners[0]:g} m"
            )


UNBALANCED = 1e-3
"""Of the weight: more that the forces of bending leave of it is no equilibrium."""


def _check_hanging(scene: Described, axis: Axis) -> None:
    """Refuse what is not at rest in a catenary."""
    gravity = scene.gravity
    assert gravity is not None
    if not (gravity.g > 0 and gravity.inclination == 0):
        raise SceneError(
            "gravity must have g > 0 and inclination = 0 of a rope that hangs in a catenary, whose "
            f"ends say how it is inclined, got {check.shown(gravity)}"
        )
    mean, wanted, changes = scene.tension, scene.mean_tension, False
    if isinstance(mean, Tension):
        changes = mean.pulsates or mean.stretching or mean.friction != 0
        wanted = float(scene.tension_at(place_of(mean, scene.rope.length)))
        mean = mean.mean
    if changes or (mean != 0 and abs(mean - wanted) > 1e-9 * wanted):
        raise SceneError(
            f"tension must be left out, or {wanted!r} N as the catenary and its weight have, got "
            f"{check.shown(scene.tension)}"
        )
    left = max(_unbalanced(scene, piece) for piece in axis.pieces)
    if left > UNBALANCED:
        raise SceneError(
            'natural must be "axis": a rope that is straight when nothing loads it does not hang '
            f"in a catenary, its bending leaves {left:.2g} of its weight"
        )


def _check_loads(scene: Described, axis: Axis) -> None:
    """Refuse weights on a catenary that hangs as if there were others."""
    density, long = scene.rope.linear_density, axis.length
    carried = dict(zip(axis.joints[1:-1].tolist(), map(float, jumps(axis.pieces))))
    weighs = dict.fromkeys(carried, 0.0)
    stands: list[Any] = [part for part in scene.parts if getattr(part, "mass", 0.0)]
    for part in stands:
        at = min(carried, key=lambda s: abs(s - part.x), default=math.inf)
        if abs(at - part.x) <= check.NEAR * long:
            weighs[at] += part.mass
        elif 0 < part.x < long:
            raise SceneError(
                f"parts[{scene.parts.index(part)}] must hang where the axis has its load of "
                f"{part.mass / density:g} m, which `Axis.catenary(.., loads=)` gives, got none at "
                f"{part.x!r} m"
            )
    for at, load in carried.items():
        if abs(weighs[at] - load * density) > 1e-9 * density * (load + long):
            raise SceneError(
                f"parts must weigh {load * density!r} kg at {at!r} m, as the axis hangs, got "
                f"{weighs[at]!r} kg"
            )
    _check_kinks(scene, axis)


ROUND = 1e-3
"""Of a rope's length: more that bending rounds off at weights is another curve."""


def _check_kinks(scene: Described, axis: Axis) -> None:
    """Refuse bending that rounds off the kinks at weights, over sqrt(B/T) by angle squared."""
    bending = own_number(scene.rope, "bending_stiffness")
    if bending is None or not axis.kinks:
        return
    if scene.rope.natural == "straight":
        raise SceneError(
            'natural must be "axis" of a rope with bending_stiffness that has kinks at weights, '
            'got "straight"'
        )
    turned = [math.acos(min(1.0, kink.turn[0, 0])) ** 2 for kink in axis.kinks]
    pull = scene.tension_at([kink.s for kink in axis.kinks])
    rounded = float(np.sum(turned * np.sqrt(bending / pull)) / axis.length)
    if rounded > ROUND:
        raise SceneError(
            f"bending_stiffness must be less for a rope to hang in kinks from weights, got "
            f"{bending:g} N m^2, which rounds off {rounded:.2g} of its length"
        )


def _unbalanced(scene: Described, piece: Any) -> float:
    """Return what bending leaves of the weight: B kz kz' along, B kz'' across."""
    if scene.rope.natural != "straight" or scene.gravity is None:
        return 0.0
    s = np.linspace(0.0, piece.length, 257)
    along, c = piece.begin + s, piece.parameter
    r, kz = c**2 + along**2, piece.rates(s)[:, 1]
    force = np.maximum(np.abs(kz * piece.bending(s)), np.abs(c * (6 * along**2 - 2 * c**2) / r**3))
    bending = own_number(scene.rope, "bending_stiffness") or 0.0
    return float(bending * force.max() / (scene.rope.linear_density * scene.gravity.g))


def _check_coordinates(scene: Described) -> None:
    bends = scene.rope.bending_stiffness is not None
    least = scene.mean_tension
    if isinstance(scene.tension, Tension):
        least -= scene.tension.amplitude
    if least < 0 and not bends:
        raise SceneError(
            f"tension must be >= 0 for a rope without bending_stiffness [N], got {least:g}"
        )
    if not scene.coordinates:
        raise SceneError(
            "rope must have a stiffness or the scene a tension: tension is 0 and "
            "bending_stiffness, torsional_stiffness and axial_stiffness are None"
        )


def _check_planes(scene: Described) -> None:
    for name in ACROSS if scene.planes == "z" else ():
        _refuse_pair(scene, f"rope.{name}", getattr(scene.rope, name))
    for i, part in enumerate(scene.parts if scene.planes == "both" else ()):
        twists = scene.rope.torsional_stiffness is not None
        if isinstance(part, BrokenWire) and twists and not part.is_wound:
            _refuse_turned(part, f"parts[{i}].angle")


def _refuse_turned(wire: BrokenWire, name: str) -> None:
    if wire.term().attached[1].displacement["alpha"]:
        raise SceneError(
            f"{name} must be 0 [rad] in both planes of a rope that twists, got {wire.angle!r}: "
            "twist would tie the planes there"
        )


def _refuse_pair(scene: Described, name: str, value: Any) -> None:
    if scene.planes == "z" and isinstance(value, tuple):
        raise SceneError(f'{name} must be one number where planes is "z", got {value!r}')


def _check_places(scene: Described) -> None:
    for i, part in enumerate(scene.parts):
        for name in positions(part):
            check.position(getattr(part, name), f"parts[{i}].{name}", scene.rope.length)
        if isinstance(part, Stretch):
            _check_stretch(scene, i, part)
            continue
        for coordinate in part.stands_on:
            if coordinate not in scene.coordinates:
                chosen = hasattr(part, "coordinate")
                name = f"parts[{i}].coordinate" if chosen else f"coordinate of a {part.kind}"
                raise check.absent(f"{name} must be one", scene.coordinates, coordinate)
        if isinstance(part, _part.Hinge):
            _check_hinge(scene, i, part.x)
    for i, end in enumerate(scene.ends):
        for name, values in _end.end_of(end).standing.items():
            for coordinate in values:
                if coordinate not in scene.coordinates:
                    must = f"ends[{i}].{name} must stand on coordinates"
                    raise check.absent(must, scene.coordinates, coordinate)


def _check_stretch(scene: Described, i: int, part: Stretch) -> None:
    least = check.NEAR * scene.rope.length
    if not part.stop - part.start > least:
        raise SceneError(
            f"parts[{i}].stop must lie more than {least:g} m beyond start, {part.start!r} m, "
            f"got {part.stop!r}"
        )
    for name, what in part.acts_on.items():
        factor = getattr(part, name)
        _refuse_pair(scene, f"parts[{i}].{name}", factor)
        if factor != 1 and what not in changeable(scene.rope, scene.coordinates):
            raise SceneError(
                f"parts[{i}].{name} must be 1 where the scene has no {what} "
                f"({', '.join(scene.coordinates)}), got {factor!r}"
            )


def _check_hinge(scene: Described, i: int, x: float) -> None:
    margin = check.NEAR * scene.rope.length
    if not margin < x < scene.rope.length - margin:
        raise SceneError(
            f"parts[{i}].x must lie between the ends of the rope for a hinge, got {x!r} m: "
            'there say End(beta="free", spring={"beta": stiffness})'
        )


def _check_tension(scene: Described) -> None:
    at = scene.tension.at if isinstance(scene.tension, Tension) else "middle"
    if not isinstance(at, str):
        check.position(at, "at of the tension", scene.rope.length)
    if not scene.is_graded:
        return
    if scene.rope.lay_slope:
        raise SceneError(
            "lay_slope must be 0 or None where the tension grows along the rope, got "
            f"{scene.rope.lay_slope!r}"
        )
    if scene.rope.bending_stiffness is None and not scene.sags:
        pulsating = scene.tension.amplitude if isinstance(scene.tension, Tension) else 0.0
        refuse_slack(scene.grade, pulsating, (_is_bare(scene, 0), _is_bare(scene, 1)))


def _is_bare(scene: Described, end: int) -> bool:
    """Whether an end is free along z and nothing stands on it."""
    term, at = _end.end_of(scene.ends[end]).term(), end * scene.rope.length
    margin = check.NEAR * scene.rope.length
    beside = any(abs(x - at) <= margin for x in _part.places(_part.standing(scene.parts)))
    stands = {*term.held, *term.mass, *term.stiffness, *term.damping}
    return not beside and stands.isdisjoint(("y", "z"))


def _check_gravity(scene: Described) -> None:
    if scene.gravity is None or scene.is_spatial:
        return
    if scene.gravity.sag and scene.rope.axial_stiffness is None and not scene.is_graded:
        raise SceneError("gravity needs axial_stiffness of the rope [N], got None")
    if not scene.sags:
        return
    tension = scene.mean_tension
    if not tension > 0:
        raise SceneError(f"tension must be > 0 where there is gravity, got {tension:g}")
    lengthening = scene.gravity.lengthening(scene.rope, tension)
    if not math.isfinite(lengthening):
        raise SceneError(
            "gravity must be small enough for 1 + (w L/H)^2/8 to be a number, got "
            f"g = {scene.gravity.g!r} m/s^2 with the tension {tension!r} N"
        )
    terms = [_end.end_of(end).term() for end in scene.ends]
    terms += [part.term() for part in _part.standing(scene.parts)]
    if not any("x" in (*term.held, *term.stiffness) for term in terms):
        raise SceneError(
            "ends must hold x where there is gravity, or a Support or Spring: the rope has no "
            f"inertia along x, got ends {check.shown(scene.ends)}"
        )


def _check_stretching(scene: Described) -> None:
    if not isinstance(scene.tension, Tension) or not scene.tension.stretching:
        return
    refuse_uneven(scene.parts, "where the tension is stretching")
    if scene.rope.axial_stiffness is None:
        raise SceneError(
            "tension must not be stretching without axial_stiffness of the rope [N], got None"
        )
    if scene.gravity is not None:
        raise SceneError(
            "tension must not be stretching where there is gravity: along a sag it is not the "
            "integral of the slope alone"
        )
    if not all("x" in _end.end_of(end).term().held for end in scene.ends):
        raise SceneError(
            f"ends must hold x where the tension is stretching, got ends {check.shown(scene.ends)}"
        )


def _check_friction(scene: Described) -> None:
    """Refuse friction between wires beside what it is not known with."""
    found = [one for one in scene.dampings if isinstance(one, damping.WireFriction)]
    if not found:
        return
    where = "where there is friction between wires"
    refuse_axis(scene, "friction between wires")
    if len(found) > 1 or damping.having(scene.dampings, "ratio"):
        what = "a ModalDamping" if len(found) == 1 else f"{len(found)} of it"
        raise SceneError(f"damping must hold one WireFriction and no ModalDamping, got {what}")
    if scene.planes != "z":
        raise SceneError(f'planes must be "z" {where}, which ties both, got "both"')
    if scene.rope.lay_slope:
        raise SceneError(f"lay_slope must be 0 or None {where}, got {scene.rope.lay_slope!r}")
    B, layers = scene.rope.bending_stiffness, sum(found[0].stiffness)
    if not isinstance(B, float) or layers >= B:
        raise SceneError(
            f"bending_stiffness must be that of wires that stick {where}, more than the "
            f"{layers:g} N m^2 of its layers, got {B!r}"
        )
