"""The notebooks as pages of the gallery, executed: by the tests where they just were, else here."""

from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient
from sphinx.util import logging
from sphinx.util.display import status_iterator

ROOT = Path(__file__).parent.parent.parent
NOTEBOOKS = ROOT / "notebooks"
EXECUTED = ROOT / "build" / "notebooks"  # where tests/project/test_notebooks.py leaves them too
GALLERY = ROOT / "docs" / "gallery"


def setup(app):
    """Write the pages before Sphinx looks for them."""
    app.connect("builder-inited", _write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write_pages(app):
    shown = app.builder.name != "linkcheck"  # which asks for links alone, of notebooks as stored
    sources = sorted(NOTEBOOKS.glob("*.ipynb"))
    for stale in set(GALLERY.glob("*.ipynb")) - {GALLERY / path.name for path in sources}:
        stale.unlink()
    package = [*(ROOT / "ropedyn").rglob("*.py"), *(ROOT / "csrc").rglob("*.[ch]")]
    changed = max(path.stat().st_mtime for path in package)
    stale = [
        path for path in sources if shown and not _is_newer(EXECUTED / path.name, path, changed)
    ]
    how = ("executing notebooks... ", "brown", len(stale), app.verbosity)
    for path in status_iterator(stale, *how, stringify_func=lambda path: path.stem):
        _execute(path)
    for path in sources:
        _copy(EXECUTED / path.name if shown else path, GALLERY / path.name)
    logging.getLogger(__name__).info("executed notebooks: %d of %d", len(stale), len(sources))


def _is_newer(executed, source, changed):
    """Whether it was executed since its source, and what it imports, last changed."""
    if not executed.exists():
        return False
    return executed.stat().st_mtime > max(source.stat().st_mtime, changed)


def _execute(path):
    notebook = nbformat.read(path, as_version=4)
    with TemporaryDirectory() as folder:
        resources = {"metadata": {"path": folder}}
        NotebookClient(notebook, timeout=600, resources=resources).execute()
    EXECUTED.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, EXECUTED / path.name)


def _copy(source, page):
    """Leave a page that is the same already, which Sphinx then need not read again."""
    text = source.read_bytes()
    if not page.exists() or page.read_bytes() != text:
        page.write_bytes(text)
