"""A number of a scene is one line: all that is asked of it follows from its declaration."""

import dataclasses

import pint
import pytest

import ropedyn as rd
from ropedyn.base.parameter import number, parameters
from ropedyn.scene.parts import part
from ropedyn.scene.path import unit_of, value_at, with_values

Q = pint.UnitRegistry().Quantity


class Bell(rd.PointMass):
    """A mass with one more number."""

    kind = "bell"

    pitch: float = number("Hz", sign="positive", default=440.0)


@pytest.fixture
def scene(monkeypatch):
    monkeypatch.setattr(part, "KINDS", (*part.KINDS, Bell))
    return rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[Bell(0.5, 0.02, pitch=262)])


def test_it_is_kept_as_a_float_and_has_its_default(scene):
    assert type(scene.parts[0].pitch) is float
    assert scene.parts[0].pitch == 262.0
    assert Bell(0.5, 0.02).pitch == 440.0
    assert list(parameters(Bell))[-1] == "pitch"


@pytest.mark.parametrize(
    ("value", "error"),
    [("a", TypeError), (True, TypeError), (None, TypeError), (0.0, rd.SceneError)],
)
def test_it_is_checked_and_its_error_says_its_name_and_unit(value, error):
    with pytest.raises(error, match=r"^pitch must be a finite number > 0 \[Hz\], got"):
        Bell(0.5, 0.02, pitch=value)


def test_it_takes_a_quantity_in_any_unit_of_its_dimension():
    assert Bell(0.5, 0.02, pitch=Q(0.262, "kHz")).pitch == pytest.approx(262.0, rel=1e-14)
    with pytest.raises(rd.SceneError, match=r"^pitch must be .* \[Hz\]"):
        Bell(0.5, 0.02, pitch=Q(262, "m"))


def test_its_path_leads_to_it_and_to_its_unit(scene):
    assert unit_of("parts[0].pitch") == "Hz"
    assert value_at(scene, "parts[0].pitch") == 262.0
    changed = with_values(scene, {"parts[0].pitch": Q(300, "Hz")})
    assert changed.parts == (dataclasses.replace(scene.parts[0], pitch=300.0),)


def test_its_prior_has_its_unit(scene):
    prior = rd.Prior({"parts[0].pitch": (Q(0.3, "kHz"), 5.0)})
    assert prior["parts[0].pitch"] == pytest.approx((300.0, 5.0), rel=1e-14)
    with pytest.raises(rd.SceneError, match=r"\[Hz\]"):
        rd.Prior({"parts[0].pitch": (Q(0.3, "m"), 5.0)})


def test_it_survives_its_file(scene, tmp_path):
    path = tmp_path / "rope.toml"
    scene.save(path)
    assert "pitch = 262.0" in path.read_text()
    assert rd.Scene.load(path) == scene


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("pitch = -1.0", "parts[0].pitch must be a finite number > 0 [Hz], got -1.0"),
        ("pith = 262.0", "unknown key 'pith' in parts[0]: expected one of mass, pitch"),
    ],
)
def test_a_file_with_another_is_refused_by_its_key(scene, tmp_path, written, message):
    path = tmp_path / "rope.toml"
    scene.save(path)
    path.write_text(path.read_text().replace("pitch = 262.0", written))
    with pytest.raises(rd.SceneError) as caught:
        rd.Scene.load(path)
    assert message in str(caught.value)
