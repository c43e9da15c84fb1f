"""The axis of a rope: positions, frames, kinks, and what the study's integral along it says."""

import math

import numpy as np
import pytest

import ropedyn as rd

ROUNDING = 1e-14
"""Relative to the length: a few hundred roundings of positions of that size."""

BENT = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 2, 2]]

AXES = {
    "line": rd.Axis.line(2.0),
    "arc": rd.Axis.arc(1.5, 4.0),
    "right helix": rd.Axis.helix(0.05, 0.3, 0.8),
    "left helix": rd.Axis.helix(0.05, 0.3, 10.0, hand="left"),
    "catenary": rd.Axis.catenary(100.0, 30.0, parameter=200.0),
    "kinks": rd.Axis.points(BENT),
    "fillets": rd.Axis.points(BENT, fillet=0.2),
}


@pytest.fixture(params=AXES.values(), ids=AXES.keys())
def axis(request):
    return request.param


def places(axis, number=23):
    """Arc lengths off the joints."""
    s = np.linspace(0, axis.length, number) + 1e-4 * axis.length
    return s[:-1]


def test_frames_are_right_handed_and_orthonormal(axis):
    F = axis.frame(places(axis))
    assert np.abs(F.swapaxes(1, 2) @ F - np.eye(3)).max() < ROUNDING
    assert np.abs(np.linalg.det(F) - 1).max() < ROUNDING
    assert np.abs(np.cross(F[:, :, 2], F[:, :, 0]) - F[:, :, 1]).max() < ROUNDING


def test_x_is_the_tangent_and_frames_turn_by_the_rates(axis):
    # central differences: h^2 of the third derivative and rounding/h, both below 1e-7
    s, h = places(axis), 1e-6 * axis.length
    F, (tau, kz, ky) = axis.frame(s), axis.rates(s).T
    tangent = (axis.position(s + h) - axis.position(s - h)) / (2 * h)
    turned = (axis.frame(s + h) - axis.frame(s - h)) / (2 * h)
    assert np.abs(tangent - F[:, :, 0]).max() < 1e-7
    x, y, z = (F[:, :, k] for k in range(3))
    wanted = [kz[:, None] * z, tau[:, None] * z, -kz[:, None] * x - tau[:, None] * y]
    assert np.abs(turned - np.stack(wanted, axis=2)).max() < 1e-7 * (1 + np.abs(kz).max())
    assert (ky == 0).all() and (kz >= 0).all()


def test_the_other_end_sees_the_same_line(axis):
    back, s = axis.reversed(), places(axis)
    assert back.length == pytest.approx(axis.length, rel=ROUNDING)
    assert np.abs(back.position(axis.length - s) - axis.position(s)).max() < (
        ROUNDING * (1 + 2 * np.abs(axis.position(s)).max())
    )
    turned = axis.frame(s) * [-1.0, -1.0, 1.0]
    assert np.abs(back.frame(axis.length - s) - turned).max() < 10 * ROUNDING
    assert back.rates(axis.length - s) == pytest.approx(axis.rates(s), rel=1e-13)


def test_an_arc_is_a_circle():
    s = np.linspace(0, 6, 13)
    arc = rd.Axis.arc(1.5, 4.0)
    circle = np.stack([1.5 * np.sin(s / 1.5), 0 * s, 1.5 * (1 - np.cos(s / 1.5))], axis=1)
    assert np.abs(arc.position(s) - circle).max() < ROUNDING
    assert np.abs(arc.position(s) + 1.5 * arc.frame(s)[:, :, 2] - [0, 0, 1.5]).max() < ROUNDING


@pytest.mark.parametrize("hand", ["right", "left"])
def test_a_helix_lies_on_a_cylinder_and_climbs(hand):
    radius, pitch, turns = 0.7, 0.3, 3.0
    helix = rd.Axis.helix(radius, pitch, turns, hand=hand)
    s = np.linspace(0, helix.length, 50)
    F = helix.frame(s)
    # the axis of the cylinder: along it the tangent and y have components that do not change
    sign = 1 if hand == "right" else -1
    up = math.sin(pitch) * F[:, :, 0] - sign * math.cos(pitch) * F[:, :, 1]
    assert np.abs(up - up[0]).max() < ROUNDING
    centre = helix.position(s) + radius * F[:, :, 2]
    climb = math.sin(pitch) * s[:, None] * up[0]
    assert np.abs(centre - climb - centre[0]).max() < 10 * ROUNDING
    assert math.sin(pitch) * helix.length == pytest.approx(
        2 * math.pi * radius * turns * math.tan(pitch), rel=1e-14
    )


def test_a_steep_helix_is_straight():
    helix = rd.Axis.helix(1.0, math.pi / 2 - 1e-9, 1e-9)
    s = np.linspace(0, helix.length, 5)
    assert np.abs(helix.position(s) - s[:, None] * [1, 0, 0]).max() < 1e-8 * helix.length


def test_a_helix_of_ninety_degrees_is_the_line():
    helix = rd.Axis.helix(1.0, math.pi / 2, length=3.0)
    assert helix.pieces == rd.Axis.line(3.0).pieces and helix.is_straight
    # what is nearly so, too, to what curvature and torsion of 1e-8 turn it by
    near = rd.Axis.helix(1.0, math.pi / 2 - 1e-8, length=3.0)
    s = np.linspace(0, 3, 7)
    assert np.abs(near.position(s) - helix.position(s)).max() < 1e-15
    assert np.abs(near.frame(s) - helix.frame(s)).max() < 4e-8
    assert rd.Axis.from_words(helix.words) == helix


def test_a_helix_is_as_long_as_its_turns():
    one, other = rd.Axis.helix(0.7, 0.3, 2.5), rd.Axis.helix(0.7, 0.3, length=2.0)
    assert rd.Axis.helix(0.7, 0.3, length=one.length).pieces == one.pieces
    assert other.length == 2.0


def test_a_catenary_hangs_by_its_weight():
    c = 200.0
    axis = AXES["catenary"]
    s = np.linspace(0, axis.length, 9)
    x, _, z = axis.position(s).T
    assert (x[-1], z[-1]) == (pytest.approx(100, rel=1e-13), pytest.approx(30, rel=1e-12))
    # c cosh(x/c) about its lowest point, and the vertical force is that of the rope below
    slope = axis.frame(s)[:, 2, 0] / axis.frame(s)[:, 0, 0]
    lowest = x[0] - c * math.asinh(slope[0])
    hung = c * (np.cosh((x - lowest) / c) - np.cosh(lowest / c))
    assert z == pytest.approx(hung, abs=1e-11)
    assert slope == pytest.approx(slope[0] + s / c, rel=1e-12)
    T = np.sqrt(1 + slope**2)
    assert axis.rates(s)[:, 1] == pytest.approx(1 / (c * T**2), rel=1e-12)


def test_a_level_catenary_is_symmetric():
    axis = rd.Axis.catenary(10.0, parameter=3.0)
    assert axis.length == pytest.approx(2 * 3 * math.sinh(10 / 6), rel=1e-14)
    assert np.abs(axis.position(axis.length / 2) - [5, 0, 3 - 3 * math.cosh(10 / 6)]).max() < 1e-13


def test_kinks_take_components_from_left_to_right():
    axis = AXES["kinks"]
    assert [kink.s for kink in axis.kinks] == [1.0, 2.0, 3.0]
    for kink in axis.kinks:
        left, right = axis.frame(kink.s - 1e-9), axis.frame(kink.s)
        v = np.array([0.3, -0.5, 0.8])
        assert right @ (kink.turn @ v) == pytest.approx(left @ v, abs=1e-14)


def test_fillets_touch_the_arms_and_leave_no_kinks():
    axis = AXES["fillets"]
    curved = [piece for piece in axis.pieces if piece.curvature > 0]
    assert [piece.curvature for piece in curved] == [5.0, 5.0, 5.0]
    jumps = [kink for kink in axis.kinks if abs(kink.turn[0, 0] - 1) > ROUNDING]
    assert jumps == []  # the tangent goes on; only the side of the centre changes
    assert np.abs(axis.position([0.0, axis.length]) - [BENT[0], BENT[-1]]).max() < 1e-14
    plane = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]], fillet=0.2)
    assert plane.kinks == ()


def test_points_on_a_line_are_a_line():
    axis = rd.Axis.points([[0, 0, 0], [1, 1, 1], [3, 3, 3]])
    assert axis.is_straight and axis.length == pytest.approx(3 * math.sqrt(3), rel=1e-15)


def test_words_make_the_same_axis(axis):
    assert rd.Axis.from_words(axis.words) == axis
    assert rd.Axis.from_words(axis.reversed().words) == axis.reversed()
    assert rd.Axis.from_words(axis.reversed().reversed().words).pieces == axis.pieces


def test_equal_axes_are_equal():
    assert rd.Axis.arc(1.0, 2.0) == rd.Axis.arc(1.0, 2.0) != rd.Axis.arc(1.0, 2.5)
    assert len({rd.Axis.arc(1.0, 2.0), rd.Axis.arc(1.0, 2.0)}) == 1


REFUSED = [
    (lambda: rd.Axis.line(0), "length must be a finite number > 0 [m], got 0"),
    (lambda: rd.Axis.arc(1, -1), "angle must be a finite number > 0 [rad], got -1"),
    (lambda: rd.Axis.helix(1, 1.6, 1), "pitch_angle must be at most pi/2 [rad], got 1.6"),
    (lambda: rd.Axis.helix(1, math.pi / 2, 1), "length must be given where pitch_angle is pi/2"),
    (lambda: rd.Axis.helix(1, 1), "give either turns or length, got None and None"),
    (lambda: rd.Axis.helix(1, 1, 2, length=3), "give either turns or length, got 2 and 3"),
    (lambda: rd.Axis.helix(1, 1, 1, "up"), 'hand must be one of "right", "left", got \'up\''),
    (lambda: rd.Axis.catenary(1e4, parameter=1), "parameter must be at least span/1000"),
    (lambda: rd.Axis.points([[0, 0, 0]]), "xyz must be two or more points"),
    (lambda: rd.Axis.points([[0, 0, 0], [0, 0, math.nan]]), "xyz must be two or more points"),
    (lambda: rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 0]]), "xyz[2] must lie apart"),
    (lambda: rd.Axis.points([[0, 0, 0], [1, 0, 0], [0, 0, 0]]), "xyz[1] must not turn"),
    (lambda: rd.Axis.points(BENT, fillet=0.6), "fillet must fit between xyz[1] and xyz[2]"),
    (lambda: AXES["arc"].position(7.0), "s must lie on the rope, between 0 and 6 m, got 7.0"),
]


@pytest.mark.parametrize(("what", "message"), REFUSED, ids=[m for _, m in REFUSED])
def test_what_has_no_meaning_is_refused_by_name(what, message):
    with pytest.raises(rd.SceneError) as error:
        what()
    assert message in str(error.value)


def test_words_are_no_points():
    with pytest.raises(TypeError, match="xyz must be two or more points"):
        rd.Axis.points("here")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"kind": "arc", "radius": 1.0}, "axis.angle must be given of kind 'arc', got nothing"),
        ({"kind": "ring", "radius": 1.0, "angle": 2.0}, "a key of axis of kind 'ring' must be"),
        ({"kind": "catenary", "span": 9.0}, "axis.parameter must be given of kind 'catenary'"),
    ],
)
def test_words_that_are_missing_or_unknown_are_named(words, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.Axis.from_words(words)
