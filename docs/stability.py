"""Where the motion of a rope grows while its tension pulsates: docs/stability.png.

An Ince-Strutt chart. Colour: growth of the damped rope. Black: where it begins; blue: where it
would without damping. Names: which modes grow, alone (2 f) or together (f + f).

python docs/stability.py
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import ropedyn as rd
from ropedyn.plot.figure import BLACK, BLUE

TENSION = 1000.0  # mean [N]
SCENE = rd.Scene(
    rd.Rope(1.0, 0.1, bending_stiffness=2.0),
    tension=TENSION,
    ends=("pinned", "clamped"),
    parts=[rd.PointMass(0.3, 0.02)],
    damping=rd.RayleighDamping(1.0, 0.0),
)
"""A stiff rope with a mass, whose modes are all coupled by its tension."""

FREQUENCY = np.linspace(80.0, 360.0, 561)  # of the tension [Hz]
AMPLITUDE = np.linspace(0.0, 500.0, 101)  # of the tension [N]
LEVELS = np.linspace(20.0, 500.0, 25)  # where boundaries are computed [N]


def mark_boundaries(ax: plt.Axes, scene: rd.Scene, color: str) -> None:
    """Draw a dot wherever stability changes."""
    stability = scene.compile().stability_map(FREQUENCY[[0, -1]], [0.0])
    for amplitude in LEVELS:
        edge = stability.boundary(float(amplitude)).frequency
        ax.plot(edge, np.full_like(edge, amplitude), ".", color=color, markersize=1.5)


def main(path: Path) -> None:
    """Draw growth over frequency and amplitude, with its boundaries."""
    figure, ax = plt.subplots(figsize=(9, 4.5), layout="constrained")
    stability = SCENE.compile().stability_map(FREQUENCY, AMPLITUDE)
    stability.plot(ax)
    for line in list(ax.lines):
        line.remove()
    mark_boundaries(ax, SCENE.replace(damping=None), BLUE)
    mark_boundaries(ax, SCENE, BLACK)
    ax.set_title("growth under a pulsating tension; blue: where it begins without damping", pad=32)
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("stability.png"))
