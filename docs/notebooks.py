"""The stored notebooks with what they show, small enough for a repository, and their thumbnails.

python docs/notebooks.py

Takes outputs from build/notebooks, where `pytest -m long tests/project/test_notebooks.py` and the
site leave what they executed; figures get fewer points and colours.
"""

import base64
import io
from pathlib import Path

import nbformat
from PIL import Image

ROOT = Path(__file__).parent.parent
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
THUMBS = ROOT / "docs" / "gallery"
WIDEST, THUMB, COLOURS = 640, 280, 48  # Of a stored figure [px].
PNG = "image/png"


def small(png: str, widest: int, highest: int) -> bytes:
    """Return a figure of a notebook with fewer points and colours."""
    figure = Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB")
    figure.thumbnail((widest, highest))
    content = io.BytesIO()
    figure.quantize(COLOURS, dither=Image.Dither.NONE).save(content, "png", optimize=True)
    return content.getvalue()


def stored(output: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Return an output without what its figure or table repeats, and without counters."""
    if "data" in output:
        if PNG in output.data:
            content = small(output.data[PNG], WIDEST, 4 * WIDEST)
            output.data = {PNG: base64.b64encode(content).decode()}
        elif "text/plain" in output.data:
            output.data = {"text/plain": output.data["text/plain"]}
        output.metadata = {}
        if "execution_count" in output:
            output.execution_count = None
    return output


def store(path: Path, executed: Path) -> None:
    """Write the outputs of an executed notebook into the stored one."""
    notebook, ran = (nbformat.read(each, as_version=4) for each in (path, executed))
    outputs = [one for cell in ran.cells for one in cell.get("outputs", [])]
    first = next(one.data[PNG] for one in outputs if PNG in one.get("data", {}))
    (THUMBS / f"{path.stem}.png").write_bytes(small(first, THUMB, THUMB * 2 // 3))
    for cell, done in zip(notebook.cells, ran.cells, strict=True):
        if cell.cell_type == "code":
            cell.outputs = [stored(one) for one in done.outputs if one.get("name") != "stderr"]
            cell.execution_count = None
    nbformat.write(notebook, path)


if __name__ == "__main__":
    for path in NOTEBOOKS:
        store(path, ROOT / "build" / "notebooks" / path.name)
        print(path.relative_to(ROOT), path.stat().st_size // 1000, "kB")
