"""The pages of the site leave nothing out; what they name wrongly Sphinx finds."""

import re
import runpy
from pathlib import Path

import ropedyn as rd

ROOT = Path(__file__).parent.parent.parent


PAGES = {
    path.stem: re.findall(r"^   (\w+)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    for path in (ROOT / "docs/api").glob("*.rst")
}
ABOVE_THE_FOLDERS = {"ask": "study", "study2015": "study"}
"""Names on the page of another folder than the one they are in."""


def test_every_public_name_stands_once_in_the_reference():
    names = [name for page, listed in PAGES.items() if page != "index" for name in listed]
    assert sorted(names) == sorted(rd.__all__)


def test_every_page_of_the_reference_is_that_of_a_folder():
    assert sorted(PAGES["index"]) == sorted(PAGES.keys() - {"index"})
    for page in PAGES.keys() - {"index"}:
        for name in PAGES[page]:
            # errors say that they are of the package: users find them there
            module = getattr(getattr(rd, name), "__module__", "").split(".")
            folder = "base" if module == ["ropedyn"] else module[1] if module[1:] else ""
            assert ABOVE_THE_FOLDERS.get(name, folder) == page, name


def test_every_notebook_stands_in_the_gallery():
    pages = (ROOT / "docs/gallery/index.md").read_text()
    notebooks = [path.stem for path in (ROOT / "notebooks").glob("*.ipynb")]
    assert [name for name in notebooks if f"[![]({name}.png)]({name}.ipynb)" not in pages] == []
    assert [name for name in notebooks if not (ROOT / f"docs/gallery/{name}.png").exists()] == []


def test_page_of_scene_files_is_that_of_the_declarations():
    maker = ROOT / "docs/scene_file.py"
    assert maker.with_suffix(".md").read_text(encoding="utf-8") == runpy.run_path(maker)["page"]()


def test_every_page_of_the_site_stands_in_its_index():
    index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")} - {"index"}
    assert pages - set(re.findall(r"^(\w+)$", index, re.MULTILINE)) == set()


def test_every_file_that_a_page_names_is_there():
    """Paths from the top of the repository, in pages of the site and beside it."""
    pages = [*(ROOT / "docs").rglob("*.md"), *(ROOT / n for n in ("README.md", "CONTRIBUTING.md"))]
    path = re.compile(r"\b(?:csrc|ropedyn|tests|notebooks)/[\w/]+\.(?:py|c|h|ipynb|txt|csv)\b")
    named = {one for page in pages for one in path.findall(page.read_text(encoding="utf-8"))}
    assert len(named) > 50
    assert [one for one in sorted(named) if not (ROOT / one).is_file()] == []
