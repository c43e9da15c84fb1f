"""Warnings point at the line of whoever called the package, from however deep inside it."""

import warnings
from pathlib import Path

import pytest

import ropedyn as rd

STRING = rd.Scene(rd.Rope(2.0, 0.2), tension=500.0)
PEAKS = rd.Peaks([25.0, 50.0], std=0.1, order=[1, 2])
BOTH = ["tension", "linear_density"]
SLIPPED = rd.Scene(rd.Rope(1.35, 0.1, bending_stiffness=1e6), tension=2830.0)
BENT = {"span": 0.7, "force": [0.0, 2.0, 4.0], "deflection": [0.0, 5.0, 10.0]}

CALLS = {
    "scene file": (rd.Scene.load, rd.UnitWarning),
    "load": (rd.load, rd.UnitWarning),
    "bending test": (lambda _: rd.BendingTest(**BENT), rd.UnitWarning),
    "fit": (lambda _: rd.identify(STRING, PEAKS, BOTH), rd.IdentifyWarning),
    "fits": (lambda _: rd.identify(STRING, [PEAKS, PEAKS], BOTH), rd.IdentifyWarning),
    "sweep": (lambda file: rd.sweep(rd.Scene.load, [file]), rd.UnitWarning),
}


@pytest.mark.parametrize("call", CALLS)
def test_a_warning_points_at_the_line_that_called(call, tmp_path):
    asked, category = CALLS[call]
    file = tmp_path / "rope.toml"
    SLIPPED.save(file)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        asked(file)
    assert told
    assert {(one.filename, one.category) for one in told} == {(__file__, category)}


def test_there_is_one_way_to_warn():
    modules = Path(rd.__file__).parent.rglob("*.py")
    found = [path.name for path in modules if "warnings.warn(" in path.read_text(encoding="utf-8")]
    assert found == ["errors.py"]
