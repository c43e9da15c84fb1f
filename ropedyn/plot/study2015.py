"""Figures of the 2015 study."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import study2015
from ..base.atomic import replacing
from ..base.unit import NAME, UNIT
from ..model import Model
from ..study.printed import DRIVE, ELEMENTS, MASSES
from .element import element
from .figure import new_figure

FREQUENCY = np.linspace(1.0, 450.0, 1797)  # Lines of the amplitude-frequency characteristics [Hz].


def draw(folder: Path) -> list[Path]:
    """Draw every figure into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    model = study2015.scene().compile(elements=ELEMENTS, element="difference")
    figures = {
        "figures-02-to-04-element.png": element(),
        "figure-09-twist.png": characteristics(model, "alpha"),
        "figure-10-transverse.png": characteristics(model, "z"),
        "mode-shapes.png": shapes(model),
        "figure-12-peaks.png": peaks(model),
    }
    for name, figure in figures.items():
        with replacing(folder / name) as draft:
            figure.savefig(draft, dpi=120, format="png")
    return [folder / name for name in figures]


def characteristics(model: Model, coordinate: str) -> Figure:
    """Draw the amplitude of one coordinate at all seven masses (the study's figures 9 and 10)."""
    response = [(coordinate, x) for x in MASSES]
    frf = model.frf(FREQUENCY, drive=DRIVE, response=response)
    figure, (ax,) = new_figure(1, height=5.0)
    for k, curve in enumerate(np.abs(frf.value)):
        ax.semilogy(frf.frequency, curve, label=f"mass {k + 1}, x = {MASSES[k]:.3f} m")
    _mark(ax)
    ax.set(xlabel="frequency [Hz]", xlim=(FREQUENCY[0], FREQUENCY[-1]))
    ax.set_ylabel(f"{NAME[coordinate]} per force [{UNIT[coordinate]}/N]")
    ax.set_title(
        f"{NAME[coordinate].capitalize()} at the seven masses for a transverse force on the third\n"
        "2015 study: 8 elements, study's kinematics, 0.13725 kg as the whole rope"
    )
    ax.legend(fontsize="small", ncols=2, loc="upper right")
    ax.grid(True, which="major", color="0.9")
    return figure


def shapes(model: Model) -> Figure:
    """Draw the first three shapes in z, alpha and beta."""
    modes = model.modes(3)
    coordinates = ("z", "alpha", "beta")
    figure, axes = new_figure(3, height=2.8)
    for ax, coordinate in zip(axes, coordinates):
        at = modes.coordinates.index(coordinate)
        for k, f in enumerate(modes.frequency):
            ax.plot(modes.x, modes.shape[k, :, at], "o-", label=f"mode {k + 1}, {f:.1f} Hz")
        ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
        ax.set_ylabel(f"{NAME[coordinate]}\n{coordinate} [{UNIT[coordinate]}]")
    axes[0].legend(fontsize="small", loc="upper right")
    axes[0].set_title("First mode shapes of the 2015 study's chain, largest z = 1 m")
    axes[-1].set_xlabel("position along the rope [m]")
    return figure


def peaks(model: Model) -> Figure:
    """Draw calculated against published and measured peaks (the study's figure 12)."""
    fitted = study2015.fitted_beam()
    beam = fitted.compile(elements=128)
    damped = fitted.replace(damping=model.scene.damping).compile(elements=128)
    figure, (ax,) = new_figure(1, height=5.0)
    for name, one, modes in (
        ("study's kinematics, 8 elements", model, model.modes(3)),
        (
            f"tensed beam, T = {fitted.tension:.0f} N, "
            f"B = {fitted.rope.bending_stiffness:.2f} N m$^2$",
            damped,
            beam.modes(3),
        ),
    ):
        curve = np.abs(one.frf(FREQUENCY, drive=DRIVE).value[0])
        listed = ", ".join(f"{f:.1f}" for f in modes.frequency)
        ax.semilogy(FREQUENCY, curve, label=f"{name}: {listed} Hz")
    _mark(ax)
    ax.set(xlabel="frequency [Hz]", xlim=(FREQUENCY[0], 260.0))
    ax.set_ylabel("transverse displacement at the driven mass per force [m/N]")
    ax.set_ylim(top=1.0)
    ax.set_title("Calculated responses against the measured and the published peaks")
    ax.legend(fontsize="small", loc="upper right")
    ax.grid(True, which="major", color="0.9")
    return figure


def _mark(ax: Axes) -> None:
    """Mark the measured and the published peaks."""
    for peaks, style, name in (
        (study2015.measured, "-", "measured, 4 mm rope"),
        (study2015.published, ":", "published model"),
    ):
        frequency = np.asarray(peaks.frequency)
        listed = ", ".join(f"{f:.0f}" for f in frequency)
        for k, f in enumerate(frequency):
            ax.axvline(
                f,
                color="0.35",
                linestyle=style,
                linewidth=1.2,
                zorder=0,
                label=f"{name}: {listed} Hz" if k == 0 else None,
            )
