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


def test_a_mode_of_an_arch_moves_in_space(tmp_path):
    film = MODES.animate(1, frames=4, path=tmp_path / "mode.gif")
    assert film.coordinates == ("X", "Y", "Z") and film.view == "isometric"
    assert (tmp_path / "mode.gif").read_bytes()[:6] == b"GIF89a"
    axis = MODEL.scene.rope.axis
    assert film.rest == pytest.approx(axis.position(MODES.x), abs=1e-15)
    # the first frame is what is plotted, the third the other way round
    lines = MODEL.plot(MODES, 1).lines
    moved = np.array(lines[1].get_data_3d()).T
    assert film.rest + film.motion[0] == pytest.approx(moved, abs=1e-12)
    assert film.motion[2] == pytest.approx(-film.motion[0], abs=1e-12)
    assert film.envelope == pytest.approx(np.abs(film.motion[0]), abs=1e-12)


@pytest.mark.parametrize("view", ["isometric", "front", "top", "side"])
def test_a_straight_rope_in_both_planes_moves_in_space_if_asked(view, tmp_path):
    rope = rd.Rope(1.0, 0.5, bending_stiffness=(5.0, 4.0))
    scene = rd.Scene(rope, tension=100.0, planes="both", damping=rd.ViscousDamping(0.3))
    for damped in (False, True):
        modes = scene.compile().modes(3, damped=damped)
        film = modes.animate(0, frames=3, view=view, path=tmp_path / "mode.html")
        assert film.rest[:, 0] == pytest.approx(modes.x) and (film.rest[:, 1:] == 0).all()
        # the softer plane is that of y
        still = np.abs(film.motion).max(axis=(0, 1))
        assert still[1] == pytest.approx(0.1, rel=1e-9) and still[[0, 2]].max() < 1e-12
        assert (tmp_path / "mode.html").read_text().count("data:image/png;base64") == 3
        assert modes.animate(0, frames=3).rest is None


def test_modes_from_a_file_have_no_axis(tmp_path):
    MODES.save(tmp_path / "modes.nc")
    again = rd.load(tmp_path / "modes.nc")
    with pytest.raises(rd.SceneError, match="view must be left out for modes from a file"):
        again.animate(0, view="top")
    with pytest.raises(rd.SceneError, match="view must be one of"):
        MODES.animate(0, view="below")
