"""Internal forces and moved ends of ropes on an axis, in responses and over time."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space.model import compile_space

LINE = rd.Scene(
    rd.Rope(
        1.3,
        0.1,
        bending_stiffness=0.5,
        torsional_stiffness=0.3,
        axial_stiffness=1e4,
        polar_inertia=1e-5,
        rotary_inertia=1e-6,
    ),
    tension=100.0,
    damping=rd.StiffnessDamping(1e-4),
    parts=[rd.PointMass(0.5, 0.02), rd.Dashpot(0.9, 0.3)],
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    planes="both",
)
DRIVES = [
    *(("z", 0.4), ("y", 0.3), ("x", 0.7), ("end", 0, "z"), ("end", 1, "z"), ("end", 0, "beta")),
    *(("end", 1, "x"), ("end", 0, "alpha"), ("end", 1, "y")),
]
SEEN = [
    *(("F_z", 0.0), ("F_z", 0.5), ("F_z", 1.3), ("M_beta", 0.0), ("M_beta", 0.7), ("F_y", 0.6)),
    *(("F_x", 0.0), ("F_x", 0.4), ("M_alpha", 0.0), ("M_gamma", 0.3), ("z", 0.5), ("x", 0.3)),
    ("z", 0.0),
]
STIFF = {"bending_stiffness": 50.0, "torsional_stiffness": 30.0}
QUARTER = rd.Axis.arc(1.0, np.pi / 2)


@pytest.mark.claim(
    "Internal forces and motion on an axis under forces and moved ends, relative to the largest",
    reference="those of the straight rope by its sweep",
    accepted=1e-12,
)
def test_forces_and_moved_ends_on_a_line_are_those_of_a_straight_rope(claim):
    """Measured: 3e-14, none of them beyond the bounds of rounding."""
    asked = {"drive": DRIVES, "response": SEEN, "quantity": "accelerance"}
    f = np.linspace(0.5, 300.0, 40)
    one, two = (model.frf(f, **asked) for model in (LINE.compile(), compile_space(LINE)))
    off, most = np.abs(one.value - two.value), np.abs(one.value).max(axis=-1, keepdims=True)
    assert (off <= one.rounding_limit + two.rounding_limit).all()
    assert (off[np.broadcast_to(most == 0, off.shape)] == 0).all()
    claim((off / np.where(most > 0, most, 1.0)).max())


@pytest.mark.parametrize("coordinate", ["x", "y", "z"])
def test_a_force_on_the_end_of_an_arc_is_everywhere_in_it(coordinate):
    """At rest it is the same in fixed axes, in the frame of each section."""
    rope = rd.Rope(QUARTER, 0.5, **STIFF)
    model = rd.Scene(rope, ends=("clamped", "free"), planes="both").compile()
    for at in (0.0, 0.6, QUARTER.length):
        seen = [(f"F_{c}", at) for c in "xyz"]
        frf = model.frf([0.0], drive=(coordinate, QUARTER.length), response=seen)
        acting = QUARTER.frame(QUARTER.length)[:, "xyz".index(coordinate)]
        assert frf.value[:, 0].real == pytest.approx(QUARTER.frame(at).T @ acting, abs=1e-13)
    # the moment at the root is the arm times the force
    seen = [(f"M_{c}", 0.0) for c in ("alpha", "beta", "gamma")]
    frf = model.frf([0.0], drive=(coordinate, QUARTER.length), response=seen)
    moment = QUARTER.frame(0.0).T @ np.cross(QUARTER.position(QUARTER.length), acting)
    assert frf.value[:, 0].real == pytest.approx(moment * [1, -1, 1], abs=1e-13)


def test_moved_end_of_an_arc_is_one_that_a_force_moves():
    """Transmissibility: the response over the motion of the end, of any force on that alone."""
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, **STIFF)
    damping = rd.ViscousDamping(3.0)
    held = rd.Scene(rope, planes="both", damping=damping, tension=20.0)
    free = held.replace(ends=(rd.End(z="free"), "clamped")).compile()
    f, seen = [1.0, 9.0, 40.0], [("z", 0.5), ("x", 1.4), ("M_beta", 2.0), ("F_x", 0.0)]
    moved = held.compile().frf(f, drive=("end", 0, "z"), response=seen).value
    driven = free.frf(f, drive=("z", 0.0), response=[*seen, ("z", 0.0)]).value
    assert moved == pytest.approx(driven[:-1] / driven[-1], rel=1e-11)


def test_ends_move_and_forces_follow_over_time():
    time = np.linspace(0.0, 0.2, 201)
    asked = {"drive": ("end", 0, "z"), "force": rd.Impulse(1e-5, duration=0.05)}
    asked |= {"response": [("z", 0.6), ("F_z", 0.6), ("M_beta", 0.6)], "tolerance": 1e-2}
    one, two = (model.transient(time, **asked) for model in (LINE.compile(), compile_space(LINE)))
    apart = np.abs(one.value - two.value)
    assert (apart <= one.error + two.error).all()
    assert (two.error.max(axis=1) <= 1e-2 * np.abs(two.value).max(axis=1)).all()


def test_what_no_end_holds_is_not_moved():
    model = rd.Scene(
        rd.Rope(QUARTER, 0.5, **STIFF), ends=("clamped", "free"), planes="both"
    ).compile()
    with pytest.raises(rd.SceneError, match="drive must be a coordinate that the end holds"):
        model.frf([1.0], drive=("end", 1, "z"), response=("z", 0.5))
    with pytest.raises(rd.SceneError, match="response must be given where an end is moved"):
        model.frf([1.0], drive=("end", 0, "z"))
