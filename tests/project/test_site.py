"""The pages of the site leave nothing out; what they name wrongly Sphinx finds."""

import re
from pathlib import Path

import ropedyn as rd

ROOT = Path(__file__).parent.parent.parent


def test_every_public_name_stands_once_in_the_reference():
    names = re.findall(r"^   (\w+)$", (ROOT / "docs/api/index.rst").read_text(), re.MULTILINE)
    assert sorted(names) == sorted(rd.__all__)


def test_every_notebook_stands_in_the_gallery():
    pages = (ROOT / "docs/gallery/index.md").read_text()
    notebooks = [path.stem for path in (ROOT / "notebooks").glob("*.ipynb")]
    assert [name for name in notebooks if f"({name}.ipynb)" not in pages] == []
