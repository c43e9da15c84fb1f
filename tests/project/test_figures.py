"""Figures that the README and the pages show are those that the repository draws."""

import re
import runpy
from pathlib import Path

import pytest
from matplotlib.testing.compare import compare_images

ROOT = Path(__file__).parent.parent.parent
PAGES = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
SAME = 0.1
"""Root mean square of 0 to 255: drawn twice it is 0, other colours of six short ticks make 0.8."""
ROUNDED = {"hard": 5.0}
"""Of what shows digits that rounding leaves, which is another one on another processor."""


@pytest.fixture(scope="module")
def drawn():
    return runpy.run_path(str(ROOT / "docs" / "figures.py"))


def test_every_figure_that_is_shown_has_its_script(drawn):
    shown = {
        (page.parent / path).resolve().relative_to(ROOT).as_posix()
        for page in PAGES
        for path in re.findall(r"!\[[^]]+\]\(([^)]+\.png)\)", page.read_text(encoding="utf-8"))
    }
    assert shown == drawn["FIGURES"].keys() | drawn["TIMED"].keys()
    assert all((ROOT / script).is_file() for script in drawn["TIMED"].values())


def test_captions_say_whether_data_are_measured_or_made():
    for page in PAGES:
        for caption in re.findall(r"!\[([^]]+)\]\([^)]+\.png\)", page.read_text(encoding="utf-8")):
            assert re.search(r"\b(measured|made|calculated|computed)\b", caption, re.I), caption


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    [
        *("measured", "broken-wire", "stability", "figure-12-peaks", "study-element", "hard"),
        "accuracy",
    ],
)
def test_figure_is_the_one_that_is_stored(name, drawn, tmp_path):
    [stored] = [one for one in drawn["FIGURES"] if Path(one).stem == name]
    drawn["FIGURES"][stored](tmp_path / "figure.png")
    (tmp_path / "stored.png").write_bytes((ROOT / stored).read_bytes())
    accepted = ROUNDED.get(name, SAME)
    assert compare_images(tmp_path / "stored.png", tmp_path / "figure.png", accepted) is None
