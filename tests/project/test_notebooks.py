"""Every notebook runs from a fresh kernel; what it leaves is a page of the site (docs/conf.py)."""

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parent.parent.parent
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
EXECUTED = ROOT / "build" / "notebooks"


def test_there_are_notebooks():
    assert NOTEBOOKS


def code_of(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code" and cell.source.strip()]


def kinds_of(notebook):
    """Return the kinds of what each cell shows."""
    shown = ([one for one in c.outputs if one.get("name") != "stderr"] for c in code_of(notebook))
    return [{one.output_type for one in cell} for cell in shown]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_stored_notebook_can_be_read_where_it_lies(path):
    """`python docs/notebooks.py` stores what the cells printed and drew."""
    outputs = [one for cell in code_of(nbformat.read(path, as_version=4)) for one in cell.outputs]
    assert any("image/png" in one.get("data", {}) for one in outputs)
    assert not any(one.output_type == "error" for one in outputs)
    assert path.stat().st_size < 350_000


@pytest.mark.long
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of the kernel's own libraries
def test_notebook_runs(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        # how often something is timed for a median decides no number but that
        cell.source = re.sub(r"repeat=\d+", "repeat=1", cell.source)
    client = NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    outputs = [o for cell in notebook.cells if cell.cell_type == "code" for o in cell.outputs]
    assert any("image/png" in o.get("data", {}) for o in outputs)
    stored = nbformat.read(path, as_version=4)
    assert kinds_of(stored) == kinds_of(notebook)
    EXECUTED.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, EXECUTED / path.name)
