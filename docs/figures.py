"""Every stored figure that can be drawn again to the pixel, and what draws it.

python docs/figures.py [FOLDER]

Without a folder those in the repository are drawn again. `tests/project/test_figures.py` compares
them with those that are stored. Figures that show times of a machine are not here, but where their
numbers are stored: `benchmarks/results/accuracy.png`.
"""

import json
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "benchmarks"), str(ROOT / "tests" / "support")]

import accuracy  # noqa: E402 - in benchmarks
import broken_wire  # noqa: E402 - beside this file, as the others
import measured  # noqa: E402
import stability  # noqa: E402

import ropedyn as rd  # noqa: E402
from ropedyn.plot import study2015  # noqa: E402


def of_the_study(name: str, path: Path) -> None:
    """Draw what `ropedyn` writes under a name."""
    with tempfile.TemporaryDirectory() as folder:
        study2015.draw(Path(folder))
        path.write_bytes((Path(folder) / name).read_bytes())


def hard(path: Path) -> None:
    """Draw what `ropedyn hard --plot` draws."""
    rd.hard_cases().plot().figure.savefig(path, dpi=120)


def price_of_accuracy(path: Path) -> None:
    """Draw the times that were measured once."""
    accuracy.draw(json.loads(accuracy.STORED.read_text(encoding="utf-8")), path)


FIGURES: dict[str, Callable[[Path], None]] = {
    "docs/measured.png": measured.main,
    "docs/broken-wire.png": broken_wire.main,
    "docs/stability.png": stability.main,
    "docs/figure-12-peaks.png": partial(of_the_study, "figure-12-peaks.png"),
    "docs/study-element.png": partial(of_the_study, "figures-02-to-04-element.png"),
    "docs/hard.png": hard,
    "benchmarks/results/accuracy.png": price_of_accuracy,
}
TIMED = {
    "docs/effects.png": "benchmarks/effects.py",
    "benchmarks/results/continuous.png": "benchmarks/continuous.py",
    "benchmarks/results/frf.png": "benchmarks/frf.py",
    "benchmarks/results/modes.png": "benchmarks/modes.py",
}
"""Figures of times, which no other run gives again, and what measures and draws them."""


if __name__ == "__main__":
    for name, draw in FIGURES.items():
        file = Path(sys.argv[1]) / Path(name).name if len(sys.argv) > 1 else ROOT / name
        draw(file)
        print(file)
