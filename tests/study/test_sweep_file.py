"""A sweep comes back whole from its file: answers, scenes, numbers and what failed."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.study.sweep import Sweep

STRING = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
BEAM = rd.Scene(
    rd.Rope(1.2, 0.1, bending_stiffness=1.5),
    tension=200.0,
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    damping=rd.ViscousDamping(0.3),
    parts=[rd.PointMass(0.4, 0.02)],
)


def back(sweep, tmp_path):
    sweep.save(tmp_path / "sweep.zip")
    return rd.load(tmp_path / "sweep.zip")


def test_answers_come_back_with_the_same_bits(tmp_path):
    found = rd.sweep(lambda scene: scene.compile().modes(3), [STRING, BEAM])
    again = back(found, tmp_path)
    assert isinstance(again, Sweep)
    for one, other in zip(found, again, strict=True):
        assert one.frequency.tobytes() == other.frequency.tobytes()
        assert str(one) == str(other)
    assert again.seconds.tobytes() == found.seconds.tobytes()
    assert again.cost == found.cost
    assert str(again.table()) == str(found.table())


def test_fits_come_back_with_their_scenes(tmp_path):
    peaks = [rd.Peaks([f, 2 * f, 3 * f], std=0.1) for f in (25.0, 25.1)]
    found = rd.sweep(lambda one: rd.identify(STRING, one, "tension"), peaks)
    for one, other in zip(found, back(found, tmp_path), strict=True):
        assert other.report() == one.report()
        assert other.to_json() == one.to_json()
        assert other.scene == one.scene


VALUES = [
    BEAM,
    3,
    2.5,
    1 - 2j,
    "text",
    None,
    True,
    [1.0, (2, "three")],
    {"mass": 0.1, 3: [BEAM]},
    float("inf"),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_plain_results_come_back_as_they_were(value, tmp_path):
    [again] = back(rd.sweep(lambda one: one, [value]), tmp_path)
    assert again == value
    assert type(again) is type(value)


@pytest.mark.parametrize("value", [np.arange(6.0).reshape(2, 3), np.float64(0.1), np.array(["a"])])
def test_arrays_come_back_with_the_same_bits(value, tmp_path):
    [again] = back(rd.sweep(lambda one: one, [value]), tmp_path)
    assert (type(again), again.dtype, again.tobytes()) == (
        type(value),
        value.dtype,
        value.tobytes(),
    )


def raised(error):
    raise error


class OwnError(Exception):
    """One that nobody else knows."""


ERRORS = [rd.SolveError("no"), rd.SceneError("bad"), KeyError("mass"), ZeroDivisionError("x")]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_what_failed_comes_back_with_its_notes(error, tmp_path):
    error.add_note("there")
    again = back(rd.sweep(raised, [error]), tmp_path).failed[0]
    assert (type(again), again.args, again.__notes__) == (type(error), error.args, ["there"])


def test_an_error_that_nobody_knows_keeps_its_name_and_words(tmp_path):
    again = back(rd.sweep(raised, [OwnError("so it is")]), tmp_path).failed[0]
    assert (type(again), str(again)) == (rd.RopedynError, "OwnError: so it is")


def test_what_cannot_be_kept_is_named(tmp_path):
    found = rd.sweep(lambda one: {"a": [1.0, {1, 2}]}, [STRING])
    with pytest.raises(rd.SceneError, match=r"results\[0\]\['a'\]\[1\] must be of answers, .*got"):
        found.save(tmp_path / "sweep.zip")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "damage", [lambda b: b[:-30], lambda b: b.replace(b"sweep.json", b"swoop.json")]
)
def test_a_file_that_is_damaged_is_refused(damage, tmp_path):
    file = tmp_path / "sweep.zip"
    rd.sweep(abs, [-1.0]).save(file)
    file.write_bytes(damage(file.read_bytes()))
    with pytest.raises(rd.SceneError, match="path must be a file that"):
        rd.load(file)
