"""Modes in motion: what moves is the shape, and files and notebooks show it."""

import numpy as np
import pytest
from PIL import Image

import ropedyn as rd

ROPE = rd.Rope(
    1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.2, polar_inertia=1e-6, lay_slope=0.3
)
SCENE = rd.Scene(ROPE, tension=100.0, parts=[rd.PointMass(0.3, 0.01)])
STRING = rd.Rope(2.0, 0.1)


@pytest.fixture(scope="module")
def modes():
    return SCENE.compile(elements=12).modes(3)


def test_a_standing_mode_is_its_shape_times_a_cosine(modes):
    animation = modes.animate(1, frames=8)
    assert animation.coordinates == ("z", "alpha")
    at = [modes.coordinates.index(c) for c in animation.coordinates]
    cosine = np.cos(2 * np.pi * np.arange(8) / 8)
    motion = cosine[:, None, None] * modes.shape[1][:, at]
    assert np.abs(animation.motion - motion).max() < 1e-15 * np.abs(motion).max()
    assert animation.envelope.tolist() == np.abs(modes.shape[1][:, at]).tolist()


@pytest.mark.parametrize("end", [0, 1])
def test_a_damped_wave_travels_to_the_dashpot(end):
    # below the string's impedance sqrt(T mu) = 10 N s/m the end moves and takes energy
    ends = ["pinned", "pinned"]
    ends[end] = rd.End(beta="free", z="free", dashpot={"z": 4.0})
    damped = rd.Scene(STRING, tension=1000.0, ends=ends).compile(elements=40).modes(3, damped=True)
    motion = damped.animate(1, frames=64).motion[:, :, 0]
    slope = np.gradient(motion, damped.x, axis=1)
    speed = (np.roll(motion, -1, axis=0) - np.roll(motion, 1, axis=0)) / 2
    # power to the right, -T z' z., in the mean over a period
    power = -(slope * speed).mean(axis=0)[1:-1]
    assert (power < 0).all() if end == 0 else (power > 0).all()


def test_a_mode_is_shown_in_the_coordinates_that_move():
    plain = ROPE.replace(lay_slope=None, rotary_inertia=1e-3)
    modes = rd.Scene(plain, tension=100.0).compile(elements=4).modes(9)
    shown = {family: modes.animate(k).coordinates for k, family in enumerate(modes.family)}
    assert shown == {
        "transverse": ("z",),
        "torsional": ("alpha",),
        "bending rotation": ("beta", "z"),
    }


def test_a_gif_has_the_frames_and_takes_the_time(modes, tmp_path):
    file = tmp_path / "mode.gif"
    modes.animate(0, path=file, frames=4, seconds=1.0)
    with Image.open(file) as image:
        assert image.n_frames == 4
        assert image.info["duration"] == 250
        assert image.info["loop"] == 0


def test_a_notebook_shows_the_frames(modes, tmp_path):
    animation = modes.animate(0, frames=3)
    html = animation._repr_html_()
    assert html.count("data:image/png;base64") == 3
    assert 'value="loop"' in html
    animation.write(tmp_path / "mode.html")
    assert (tmp_path / "mode.html").read_text().count("data:image/png;base64") == 3
    assert repr(animation).startswith("<Animation of mode 1: ")


def test_a_file_that_cannot_be_written_leaves_what_was_there(modes, tmp_path, monkeypatch):
    file = tmp_path / "mode.gif"
    file.write_text("old")
    animation = modes.animate(0, frames=3)
    monkeypatch.setattr(
        "matplotlib.animation.PillowWriter.finish", lambda writer: (_ for _ in ()).throw(OSError)
    )
    with pytest.raises(OSError):
        animation.write(file)
    assert [one.name for one in tmp_path.iterdir()] == ["mode.gif"]
    assert file.read_text() == "old"


def test_a_film_needs_ffmpeg(modes, tmp_path, monkeypatch):
    monkeypatch.setattr("matplotlib.animation.FFMpegWriter.isAvailable", lambda: False)
    with pytest.raises(rd.SceneError, match=r"path must end in .gif or .html where ffmpeg is not"):
        modes.animate(0, path=tmp_path / "mode.mp4")
    assert list(tmp_path.iterdir()) == []


def test_modes_from_a_file_move(modes, tmp_path):
    modes.save(tmp_path / "modes.nc")
    loaded = rd.load(tmp_path / "modes.nc")
    assert loaded.animate(1).motion.tolist() == modes.animate(1).motion.tolist()


@pytest.mark.parametrize(
    ("arguments", "more", "error", "words"),
    [
        ((-1,), {}, rd.SceneError, "k must be a whole number from 0 to 2, got -1"),
        ((3,), {}, rd.SceneError, "k must be a whole number from 0 to 2, got 3"),
        ((1.0,), {}, TypeError, "k must be a whole number"),
        ((1,), {"frames": 1}, rd.SceneError, "frames must be a whole number from 2 to 1000, got 1"),
        ((1,), {"seconds": 0.0}, rd.SceneError, "seconds must be a finite number > 0"),
        ((1,), {"path": "mode.png"}, rd.SceneError, "path must end in .gif, .html, .mp4"),
        ((1,), {"path": 3}, TypeError, "path must be the path of a file"),
        ((1,), {"path": "/nowhere/mode.gif"}, OSError, "nowhere"),
    ],
)
def test_what_cannot_be_shown_is_refused(modes, arguments, more, error, words):
    with pytest.raises(error, match=words):
        modes.animate(*arguments, **more)


@pytest.mark.parametrize("k", [0, 1])
def test_what_does_not_oscillate_has_no_period(k):
    modes = rd.Scene(ROPE, ends=("free", "free")).compile(elements=8).modes(3)
    with pytest.raises(rd.SceneError, match=f"a mode that oscillates, got {k}, whose frequency"):
        modes.animate(k)
