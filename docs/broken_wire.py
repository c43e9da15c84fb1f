"""How strongly the resonances of the 2015 study's rope excite a broken wire: docs/broken-wire.png.

Marks above: resonances of the rope, torsional ones red. Dashed: the wire's own first frequency.

python docs/broken_wire.py
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import ropedyn as rd
from ropedyn.plot.figure import BLACK, RED

LENGTH, X = 1.35, 0.50625  # the third mass of eight elements [m]
ROPE = rd.Rope(
    LENGTH,
    0.13725 / LENGTH,
    bending_stiffness=1.54,
    torsional_stiffness=0.1485,
    polar_inertia=2.352e-8 / 0.16875,
)
"""The tensed beam of the measured peaks, with the study's torsion."""

RADIUS, DIAMETER = 1.85e-3, 0.3e-3  # an outer wire of a 4 mm rope [m]
LENGTHS = np.linspace(0.01, 0.06, 201)  # of wires [m]
FREQUENCY = np.linspace(20.0, 800.0, 1561)
DRIVES = {("z", X): (1.0, "a force of 1 N"), ("alpha", X): (1e-3, "a torque of 1 mN m")}


def scene(length: float) -> rd.Scene:
    """Return the rope with a wire as long as this."""
    wire = rd.BrokenWire(0.28 * LENGTH, length, DIAMETER, radius=RADIUS, damping_ratio=2e-3)
    return rd.Scene(ROPE, tension=2830.0, damping=rd.RayleighDamping(5.0, 1e-6), parts=[wire])


def amplitude(length: float) -> np.ndarray:
    """Return that of the tip for each drive [m], shape (drives, f)."""
    model = scene(length).compile()
    frf = model.frf(FREQUENCY, drive=list(DRIVES), response=("wire", 0))
    return np.abs(frf.value[:, 0])


def main(path: Path) -> None:
    """Draw the amplitude over frequency and length of the wire."""
    tips = np.array([amplitude(length) for length in LENGTHS])
    modes = scene(LENGTHS[0]).compile().modes(below=FREQUENCY[-1])
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.5), sharey=True, layout="constrained")
    for k, (ax, what) in enumerate(zip(axes, DRIVES.values())):
        size, name = what
        decibel = 20 * np.log10(size * tips[:, k])
        top = decibel.max()
        image = ax.pcolormesh(
            FREQUENCY, 1e3 * LENGTHS, decibel, vmin=top - 100, vmax=top, rasterized=True
        )
        own = [rd.BrokenWire(X, at, DIAMETER, radius=RADIUS).frequency for at in LENGTHS]
        ax.plot(own, 1e3 * LENGTHS, "w--", linewidth=0.8)
        for frequency, family in zip(modes.frequency, modes.family):
            color = RED if family == "torsional" else BLACK
            ax.plot(
                [frequency] * 2,
                [1.0, 1.03],
                color=color,
                transform=ax.get_xaxis_transform(),
                clip_on=False,
            )
        ax.set_xlim(FREQUENCY[[0, -1]])
        ax.set_xlabel("frequency [Hz]")
        ax.set_title(f"tip of the wire by {name} on the rope", pad=18)
        figure.colorbar(image, ax=ax, label="amplitude [dB re 1 m]")
    axes[0].set_ylabel("length of the wire [mm]")
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("broken-wire.png"))
