"""The stored notebooks with what they show, small enough for a repository.

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
WIDEST, COLOURS = 640, 48  # Of a stored figure [px].
PNG = "image/png"


def small(png: str) -> str:
    """Return a figure with fewer points and colours, as notebooks have it."""
    figure = Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB")
    figure.thumbnail((WIDEST, 4 * WIDEST))
    content = io.BytesIO()
    figure.quantize(COLOURS, dither=Image.Dither.NONE).save(content, "png", optimize=True)
    return base64.b64encode(content.getvalue()).decode()


def stored(output: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Return an output without what its figure or table repeats, and without counters."""
    if "data" in output:
        if PNG in output.data:
            output.data = {PNG: small(output.data[PNG])}
        elif "text/plain" in output.data:
            output.data = {"text/plain": output.data["text/plain"]}
        output.metadata = {}
        if "execution_count" in output:
            output.execution_count = None
    return output


def store(path: Path, executed: Path) -> None:
    """Write the outputs of an executed notebook into the stored one."""
    notebook, ran = (nbformat.read(each, as_version=4) for each in (path, executed))
    for cell, done in zip(notebook.cells, ran.cells, strict=True):
        if cell.cell_type == "code":
            cell.outputs = [stored(one) for one in done.outputs if one.get("name") != "stderr"]
            cell.execution_count = None
    nbformat.write(notebook, path)


if __name__ == "__main__":
    for path in NOTEBOOKS:
        store(path, ROOT / "build" / "notebooks" / path.name)
        print(path.relative_to(ROOT), path.stat().st_size // 1000, "kB")
