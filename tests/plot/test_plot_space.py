"""Figures of ropes in space."""

import math

import numpy as np
import pytest

import ropedyn as rd

MODEL = rd.Scene(
    rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0),
    planes="both",
).compile()
MODES = MODEL.modes(2)


def test_an_arc_is_drawn_where_it_lies():
    ax = MODEL.plot(view="front")
    (line,) = ax.lines
    x, z = line.get_data()
    # a circle of 1 m about (0, 1)
    assert np.hypot(x, z - 1.0) == pytest.approx(np.ones(len(x)), rel=1e-12)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("X [m]", "Z [m]")


def test_a_mode_across_the_plane_is_seen_from_above_and_not_from_the_front():
    assert MODES.plane[0] == "y"
    front, top = (MODEL.plot(MODES, 0, view=view, scale=0.5) for view in ("front", "top"))
    rest, moved = (line.get_data()[1] for line in front.lines)
    assert moved == pytest.approx(rest, abs=1e-12)
    moved = top.lines[1].get_data()[1]
    assert np.abs(moved).max() == pytest.approx(0.5, rel=1e-6)
    assert "0.5 times" in top.get_title()


def test_an_isometric_view_shows_all_three():
    ax = MODEL.plot(MODES, 1)
    assert (ax.get_xlabel(), ax.get_zlabel()) == ("X [m]", "Z [m]")
    rest, moved = (np.array(line.get_data_3d()) for line in ax.lines)
    far = np.linalg.norm(moved - rest, axis=0).max()
    extent = np.linalg.norm(np.ptp(rest, axis=1))
    assert far == pytest.approx(0.1 * extent, rel=1e-9)


def test_a_straight_rope_under_torque_is_drawn_too():
    rope = rd.Rope(2.0, 0.5, bending_stiffness=50.0)
    model = rd.Scene(rope, planes="both", torque=5.0).compile()
    ax = model.plot(model.modes(1), view="side")
    assert len(ax.lines) == 2 and ax.get_ylabel() == "Z [m]"


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"view": "back"}, "view must be one of"),
        ({"modes": MODES, "k": 2}, "k must be"),
        ({"modes": MODES, "scale": math.inf}, "scale must be a finite number"),
    ],
)
def test_what_cannot_be_drawn_is_refused(how, message):
    with pytest.raises(rd.SceneError, match=message):
        MODEL.plot(**how)
    plane = MODEL.plot(view="top")
    with pytest.raises(rd.SceneError, match='ax must have the projection "3d"'):
        MODEL.plot(ax=plane)
    other = MODEL.scene.replace(
        rope=MODEL.scene.rope.replace(length=rd.Axis.arc(2.0, 2.0), axis=None)
    )
    with pytest.raises(rd.SceneError, match="rope of another length"):
        MODEL.plot(other.compile().modes(1))
