"""What a scene is made of, read from its numbers alone: shared by the exact references."""

import dataclasses
import types

import mpmath
from mpmath import mpf

import ropedyn as rd

CHANNEL = {"x": 0, "z": 2, "alpha": 1, "beta": 2}
"""Section channel of a coordinate: axial, torsion, bending."""


def is_stretch(part):
    """Whether a part changes the rope over a stretch instead of standing at one place."""
    return isinstance(part, rd.AddedMass | rd.LocalChange)


def places(scene):
    """Where the parts of a scene stand, begin and end [m], as they come."""
    return [x for p in scene.parts for x in ((p.start, p.stop) if is_stretch(p) else (p.x,))]


def parts_at(scene, x):
    """The parts that stand at a place."""
    return [p for p in scene.parts if not is_stretch(p) and mpf(p.x) == mpf(x)]


def rope_at(scene, x):
    """Properties of the rope at a place inside a span: its own with what the parts do to them."""
    own = {name: mpf(value or 0) for name, value in vars(scene.rope).items() if name != "_"}
    here = types.SimpleNamespace(**own)
    over = [p for p in scene.parts if is_stretch(p) and p.start < x < p.stop]
    for change in (p for p in over if isinstance(p, rd.LocalChange)):
        here.bending_stiffness *= mpf(change.bending)
        here.torsional_stiffness *= mpf(change.torsion)
        for inertia_of in ("linear_density", "rotary_inertia", "polar_inertia"):
            setattr(here, inertia_of, getattr(here, inertia_of) * mpf(change.density))
    for added in (p for p in over if isinstance(p, rd.AddedMass)):
        here.linear_density += mpf(added.linear_density)
        here.polar_inertia += mpf(added.polar_inertia)
    return here


def section(rope):
    """Flexibility of the section over (axial, torsion, bending), from the rope's numbers."""
    EA, C, B, D, H = (
        mpf(value or 0)
        for value in (
            rope.axial_stiffness,
            rope.torsional_stiffness,
            rope.bending_stiffness,
            rope.lay_coupling,
            rope.lay_slope,
        )
    )
    S = [[mpf(0)] * 3 for _ in range(3)]
    left = 1 - D * D / (EA * C) if D else mpf(1)
    S[0][0] = 1 / (EA * left) if EA else mpf(0)
    tt, bb = 1 / (C * left) if C else mpf(0), 1 / B if B else mpf(0)
    at = -D / (EA * C * left) if D else mpf(0)
    norm = mpmath.sqrt(1 + H * H)
    c, s = 1 / norm, H / norm
    S[0][1] = S[1][0] = c * at
    S[0][2] = S[2][0] = s * at
    S[1][1], S[2][2] = c * c * tt + s * s * bb, s * s * tt + c * c * bb
    S[1][2] = S[2][1] = c * s * (tt - bb)
    return S


def inertia(rope):
    """Inertia per length of each coordinate [kg/m, kg m]."""
    mu = mpf(rope.linear_density)
    polar, rotary = mpf(rope.polar_inertia or 0), mpf(rope.rotary_inertia or 0)
    return {"x": mu, "z": mu, "alpha": polar, "beta": rotary}


def drag(scene):
    """Damping per length of each coordinate [N s/m^2]."""
    along = sum(mpf(d.coefficient) for d in scene.dampings if isinstance(d, rd.ViscousDamping))
    return {"x": along, "z": along, "alpha": mpf(0), "beta": mpf(0)}


def dragged(scene):
    """Whether anything is in proportion to velocity at nodes or along the rope."""
    ends = [end for end in scene.ends if isinstance(end, rd.End)]
    parts = [part for part in scene.parts if isinstance(part, rd.Dashpot)]
    return bool(parts or any(end.dashpot for end in ends) or drag(scene)["z"])


def sag(scene, rope):
    """Weight per length over tension [1/m] and L_e/L = 1 + (w L/T)^2/8; 0 and 1 without gravity."""
    gravity, chord = scene.gravity, mpf(scene.rope.length)
    if gravity is None:
        return mpf(0), mpf(1)
    over_tension = mpf(gravity.g) * mpmath.cos(mpf(gravity.inclination)) / mpf(scene.tension)
    slope = over_tension * mpf(scene.rope.linear_density) * chord
    return over_tension * mpf(rope.linear_density), 1 + slope**2 / 8


def section_of(scene, rope):
    """Flexibility of the section; where the rope hangs it is longer than its chord along x."""
    S = section(rope)
    S[0][0] *= sag(scene, rope)[1]
    return S


def inertia_of(scene, rope):
    """Inertia per length; none along x where the rope hangs."""
    own = inertia(rope)
    return own if scene.gravity is None else own | {"x": mpf(0)}


def factors(scene, omega):
    """On sections, tension, springs, inertia, dashpots at omega [rad/s].

    All but the last are real where nothing is damped.
    """
    section = tension = spring = mpf(1)
    inertia = -(omega**2)
    for damping in scene.dampings:
        if isinstance(damping, rd.StiffnessDamping):
            section = section + 1j * omega * mpf(damping.gamma)
            spring = spring + 1j * omega * mpf(damping.gamma)
        elif isinstance(damping, rd.LossFactor):
            section = section + 1j * mpf(damping.eta)
            spring = spring + 1j * mpf(damping.eta)
        elif hasattr(damping, "stiffness"):
            section = section + 1j * omega * mpf(damping.stiffness)
            tension = tension + 1j * omega * mpf(damping.stiffness)
            spring = spring + 1j * omega * mpf(damping.stiffness)
            inertia = inertia + 1j * omega * mpf(damping.mass)
    return section, tension, spring, inertia, 1j * omega


@dataclasses.dataclass
class Standing:
    """What stands at one place, per coordinate."""

    mass: dict[str, mpf]
    stiffness: dict[str, mpf]
    damping: dict[str, mpf]
    held: set[str]
    hinge: mpf | None
    """Compliance of the hinge on the right [rad/(N m)], infinite where free, or None."""

    def resistance(self, name, spring, inertia, dashpot):
        """Force against motion of a coordinate, with the factors on what it has."""
        force = inertia * self.mass[name] + spring * self.stiffness[name]
        return force + dashpot * self.damping[name] if self.damping[name] else force


def standing(coordinates, parts, end=None):
    """Sum up the parts at one place, and the end of the rope if it is there."""
    none = dict.fromkeys(coordinates, mpf(0))
    found = Standing(dict(none), dict(none), dict(none), set(), None)
    for part in parts:
        if isinstance(part, rd.PointMass):
            added = {"x": part.mass, "z": part.mass, "alpha": part.polar_inertia}
            added["beta"] = part.rotary_inertia
            for k in coordinates:
                found.mass[k] += mpf(added[k])
        elif isinstance(part, rd.Hinge):
            if "beta" in coordinates:
                soft = 1 / mpf(part.stiffness) if part.stiffness else mpf("inf")
                found.hinge = soft + (found.hinge or 0)
        elif part.coordinate in coordinates and isinstance(part, rd.Spring):
            found.stiffness[part.coordinate] += mpf(part.stiffness)
        elif part.coordinate in coordinates and isinstance(part, rd.Dashpot):
            found.damping[part.coordinate] += mpf(part.damping)
        elif part.coordinate in coordinates:
            found.held.add(part.coordinate)
    if isinstance(end, rd.End):
        found.held |= {k for k in coordinates if end.holds(k)}
        for sum_, given in (
            (found.stiffness, end.spring),
            (found.damping, end.dashpot),
            (found.mass, end.mass),
        ):
            for k in set(given) & set(coordinates):
                sum_[k] += mpf(given[k])
    elif end is not None:
        holds = {"clamped": set(coordinates), "pinned": set(coordinates) - {"beta"}, "free": set()}
        found.held |= holds[end]
    return found
