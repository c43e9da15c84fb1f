"""Ropes that rub on sheaves and springs under load, against Bessel functions and fixed axes."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import j1, y1

import ropedyn as rd


def test_the_tension_of_a_rope_around_a_sheave_is_euler_s():
    axis = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]], fillet=0.2)
    tension = rd.Tension(100.0, at="start", friction=0.3)
    scene = rd.Scene(rd.Rope(axis, 0.5), tension=tension, planes="both")
    rise = math.exp(0.3 * math.pi / 2)
    s = np.array([0.0, 0.8, 0.8 + 0.1 * math.pi / 2, 0.8 + 0.2 * math.pi / 2, axis.length])
    wanted = 100.0 * np.array([1.0, 1.0, math.sqrt(rise), rise, rise])
    assert scene.tension_at(s) == pytest.approx(wanted, rel=1e-14)
    fine = np.linspace(0.0, axis.length, 200001)
    assert scene.mean_tension == pytest.approx(scene.tension_at(fine).mean(), rel=1e-6)
    # known elsewhere, and from the other end, it is the same
    for at, mean in (("end", wanted[-1]), (float(s[2]), wanted[2])):
        other = rd.Scene(
            rd.Rope(axis, 0.5), tension=rd.Tension(mean, at=at, friction=0.3), planes="both"
        )
        assert other.tension_at(s) == pytest.approx(wanted, rel=1e-14)
        found, same = (one.compile().modes(6).frequency for one in (other, scene))
        assert found == pytest.approx(same, rel=1e-12)
    back = rd.Scene(
        rd.Rope(axis.reversed(), 0.5),
        tension=rd.Tension(100.0, at="end", friction=-0.3),
        planes="both",
    )
    assert back.tension_at(axis.length - s) == pytest.approx(wanted, rel=1e-14)
    assert back.compile().modes(6).frequency == pytest.approx(
        scene.compile().modes(6).frequency, rel=1e-12
    )


@pytest.mark.claim(
    "A string on a sheave, T = T0 exp(friction angle), across its plane: four frequencies",
    reference="xi J1(xi), xi Y1(xi), xi = (2/c) sqrt(lambda m/T0) exp(-c s/2)",
    accepted=1e-13,
)
def test_a_string_that_rubs_is_that_of_bessel_functions(claim):
    radius, angle, friction, T, m = 2.0, 2.5, 0.4, 300.0, 0.5
    c, length = friction / radius, radius * angle

    def determinant(f):
        size = 2 / c * 2 * math.pi * f * math.sqrt(m / T)
        a, b = size, size * math.exp(-c * length / 2)
        return j1(a) * y1(b) - j1(b) * y1(a)

    tension = rd.Tension(T, at="start", friction=friction)
    scene = rd.Scene(
        rd.Rope(rd.Axis.arc(radius, angle), m, axial_stiffness=1e7), tension=tension, planes="both"
    )
    modes = scene.compile().modes(below=20.0, points=3)
    across = modes.frequency[modes.plane == "y"][:4]
    wanted = [brentq(determinant, f * 0.99, f * 1.01, xtol=1e-15, rtol=1e-15) for f in across]
    claim(np.abs(across / wanted - 1).max())  # 1e-15


SIGN = np.array([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])


def cross(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def determinant_in_fixed_axes(rope, force, moment, f):
    """Of what force and moment on the left do to the motion of the right end, left end held.

    Kirchhoff's rod about a state at rest, all vectors along X, Y, Z:

        u' = theta x t + R diag(1/EA, 0, 0) R^T (dn - theta x n)
        theta' = R diag(1/C, 1/B, 1/B) R^T (dm - theta x m)
        dn' = -lambda mu u,  dm' = -t x dn - u' x n - lambda R j R^T theta

    with fixed moments m, none of the semitangential ones that the library has.
    """
    axis, value = rope.axis, (2 * math.pi * f) ** 2
    soft = np.diag([1 / rope.torsional_stiffness, *[1 / rope.bending_stiffness] * 2])
    stretch = np.diag([1 / rope.axial_stiffness, 0.0, 0.0])
    inertia = np.diag([rope.polar_inertia, rope.rotary_inertia, rope.rotary_inertia])

    def slope(s, y):
        R = axis.frame(min(s, axis.length))
        t, n, m = R[:, 0], R @ force(s), R @ moment(s)
        u, theta, dn, dm = y.reshape(4, 3, 6)
        du = -cross(t) @ theta + R @ stretch @ R.T @ (dn + cross(n) @ theta)
        dtheta = R @ soft @ R.T @ (dm + cross(m) @ theta)
        ddm = -cross(t) @ dn + cross(n) @ du - value * R @ inertia @ R.T @ theta
        return np.concatenate([du, dtheta, -value * rope.linear_density * u, ddm]).ravel()

    start = np.zeros((12, 6))
    start[6:] = np.diag([1e3, 1e3, 1e3, 1.0, 1.0, 1.0])
    how = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-15}
    end = solve_ivp(slope, (0.0, axis.length), start.ravel(), **how).y[:, -1].reshape(12, 6)
    return np.linalg.det(end[:6] * np.array([1e3] * 3 + [1.0] * 3)[:, None])


SPRING = rd.Rope(
    rd.Axis.helix(0.05, 0.3, 1.5),
    0.06,
    bending_stiffness=2.0,
    torsional_stiffness=1.5,
    axial_stiffness=4e5,
    rotary_inertia=2e-7,
    polar_inertia=4e-7,
)


def loaded(P, hand):
    axis = rd.Axis.helix(0.05, 0.3, 1.5, hand=hand)
    rope = SPRING.replace(axis=axis)
    sign = 1 if hand == "right" else -1
    c = np.array([math.sin(0.3), -sign * math.cos(0.3), 0.0])
    # P c at the distance R from the cylinder's axis: the twist is P R cos p of a right-handed one
    m = 0.05 * P * np.array([sign * math.cos(0.3), math.sin(0.3), 0.0])
    return rope, (lambda s: P * c), (lambda s: m)


@pytest.mark.parametrize(("P", "hand"), [(60.0, "right"), (-40.0, "right"), (60.0, "left")])
def test_a_spring_under_load_in_fixed_axes(P, hand):
    rope, force, moment = loaded(P, hand)
    modes = rd.Scene(rope, axial_force=P, planes="both").compile().modes(3)
    bare = rd.Scene(rope, planes="both").compile().modes(3).frequency
    # what the load does
    assert np.abs(modes.frequency / bare - 1).min() > 1e-3
    for f in modes.frequency:
        one, other = (
            determinant_in_fixed_axes(rope, force, moment, f * (1 + side * 1e-8))
            for side in (-1, 1)
        )
        assert one * other < 0


def test_the_load_of_a_spring_is_in_balance():
    rope, force, moment = loaded(60.0, "right")
    axis = rope.axis
    s = np.linspace(0.0, axis.length, 9)
    n, m = (np.stack([axis.frame(one) @ load(one) for one in s]) for load in (force, moment))
    assert np.abs(n - n[0]).max() < 1e-13 * 60.0
    # m + r x n does not change either
    total = m + np.cross(axis.position(s), n)
    assert np.abs(total - total[0]).max() < 1e-12
    scene = rd.Scene(rope, axial_force=60.0, planes="both")
    assert scene.mean_tension == pytest.approx(60.0 * math.sin(0.3), rel=1e-14)
    assert scene.tension_at([0.0, 0.1]) == pytest.approx(60.0 * math.sin(0.3), rel=1e-14)
    assert {"tension", "initial moment"} <= set(scene.effects)
    assert scene.without("initial moment").axial_force == 0


def test_a_rope_that_rubs_with_bending_in_fixed_axes():
    rope = rd.Rope(
        rd.Axis.arc(0.5, 2.0),
        0.5,
        bending_stiffness=5.0,
        torsional_stiffness=3.0,
        axial_stiffness=1e5,
        rotary_inertia=1e-6,
        polar_inertia=1e-5,
        natural="straight",
    )
    tension = rd.Tension(200.0, at="start", friction=0.5)
    modes = rd.Scene(rope, tension=tension, planes="both").compile().modes(3)

    def force(s):
        return np.array([200.0 * math.exp(0.5 * s / 0.5), 0.0, 0.0])

    def moment(s):
        return np.array([0.0, -5.0 / 0.5, 0.0])

    for f in modes.frequency:
        one, other = (
            determinant_in_fixed_axes(rope, force, moment, f * (1 + side * 1e-8))
            for side in (-1, 1)
        )
        assert one * other < 0


def test_a_long_spring_buckles_as_haringx_says():
    # a column that gives way to shear: between clamped ends P (1 + P/S) = 4 pi^2 B_e/h^2
    radius, pitch, turns, B, C = 0.01, 0.15, 60.0, 1.0, 0.8
    axis = rd.Axis.helix(radius, pitch, turns)
    rope = rd.Rope(axis, 0.1, bending_stiffness=B, torsional_stiffness=C)
    high = axis.length * math.sin(pitch)
    bends = high / axis.length * 2 * B * C / (B + C)
    shears = high / axis.length * B / radius**2
    wanted = brentq(
        lambda P: P * (1 + P / shears) - 4 * math.pi**2 * bends / high**2, 0.0, 10 * shears
    )

    def falls(P):
        return rd.Scene(rope, axial_force=-P, planes="both").compile().modes(1).growth[0] > 0

    # 0.75 % above: a column has no pitch and no single turns
    assert not falls(wanted) and falls(1.02 * wanted)


def test_loads_are_kept_in_files(tmp_path):
    arc = rd.Rope(rd.Axis.arc(0.5, 2.0), 0.5, axial_stiffness=1e5)
    tension = rd.Tension(200.0, at="start", friction=0.5)
    scenes = [
        rd.Scene(SPRING, axial_force=5.0, planes="both"),
        rd.Scene(arc, tension=tension, planes="both"),
    ]
    for scene in scenes:
        scene.save(tmp_path / "scene.toml")
        assert rd.Scene.load(tmp_path / "scene.toml") == scene


RUBS = rd.Tension(100.0, friction=0.2)
CORNER = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]])
STIFF = {"bending_stiffness": 40.0, "torsional_stiffness": 5.0}
REFUSED = {
    "friction of the tension must be 0 of a straight rope": lambda: rd.Scene(
        rd.Rope(1.0, 0.1), tension=RUBS
    ),
    "friction of the tension must be 0 on an axis that is not of lines": lambda: rd.Scene(
        rd.Rope(rd.Axis.catenary(1.0, parameter=1.0), 0.1), tension=RUBS, planes="both"
    ),
    "tension must be > 0 for friction": lambda: rd.Scene(
        rd.Rope(rd.Axis.arc(1.0, 1.0), 0.1, **STIFF),
        tension=rd.Tension(-1.0, friction=0.2),
        planes="both",
    ),
    "it leaves 0.35 of what the tension presses by": lambda: rd.Scene(
        rd.Rope(rd.Axis.helix(0.5, 0.5, 1.0), 0.1, natural="straight", **STIFF),
        tension=rd.Tension(70.0, at="start", friction=0.2),
        planes="both",
    ),
    "tension must be 0 on an axis with corners": lambda: rd.Scene(
        rd.Rope(CORNER, 0.1, **STIFF), tension=RUBS, planes="both"
    ),
    "axial_force must be 0 of a straight rope": lambda: rd.Scene(
        rd.Rope(1.0, 0.1, **STIFF), axial_force=1.0
    ),
    "axial_force must be 0 on an axis that is no helix": lambda: rd.Scene(
        rd.Rope(CORNER, 0.1, **STIFF), axial_force=1.0, planes="both"
    ),
    "axial_force must be 0 on a circle": lambda: rd.Scene(
        rd.Rope(rd.Axis.arc(1.0, 1.0), 0.1, **STIFF), axial_force=1.0, planes="both"
    ),
    "tension must be 0 beside axial_force": lambda: rd.Scene(
        SPRING, axial_force=1.0, tension=1.0, planes="both"
    ),
    "axial_force must be 0 without bending_stiffness": lambda: rd.Scene(
        rd.Rope(rd.Axis.helix(0.5, 0.5, 1.0), 0.1), axial_force=1.0, planes="both"
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_not_at_rest_is_refused_by_name(message):
    with pytest.raises(rd.SceneError) as error:
        REFUSED[message]()
    assert message in str(error.value)
