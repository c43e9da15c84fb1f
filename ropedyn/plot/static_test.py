"""Figure of a bending or torsion test."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..scene.bench.static_test import StaticTest


def plot_static_test(test: StaticTest, ax: Axes | None) -> Axes:
    """Plot readings over loads, with the line of least squares."""
    ax = new_axes(ax)
    ends = np.array([min(0.0, test.load.min()), max(0.0, test.load.max())])
    ax.plot(test.load, test.reading, "o", label="readings")
    ax.plot(ends, test.offset + test.line.slope * ends, label="least squares")
    ax.set(xlabel=test.load_label, ylabel=test.reading_label, title=test.title)
    ax.grid(True, color="0.92")
    ax.legend(fontsize="small")
    return ax
