"""Figures of constructions: the section, and how wires lie along the rope."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.array import Real
from ..scene.construction.construction import Construction
from ..scene.construction.section import Section
from ..scene.construction.spread import UNITS, SectionSpread
from ..scene.construction.strand import Bar, Ring, Strand
from .figure import BLUE, colour, legend, light_grid, plots

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MM = 1e3
FIBRE = "0.85"
POINTS = 400  # Along the piece of rope that is seen from the side.


@plots(Construction, height=lambda _: 7.0)
def plot_construction(construction: Construction, ax: Axes, *, lay: bool = False) -> None:
    """Draw the section, a colour for each layer of the rope, or its layers from the side."""
    strand = construction.strand
    (_from_the_side if lay else _across)(strand, ax)
    ax.set_aspect("equal")
    size = MM * construction.diameter
    ax.set(title=f"{size:.4g} mm, {'seen from the side' if lay else 'section'}")


@plots(Section, height=lambda _: 7.0)
def plot_section(section: Section, ax: Axes) -> None:
    """Draw the wires of the section."""
    plot_construction(section._made, ax)


@plots(SectionSpread)
def plot_spread(spread: SectionSpread, ax: Axes) -> None:
    """Draw where the draws of each number lie, as shares of its median."""
    half, most = spread.interval(0.5), spread.interval(0.95)
    for y, name in enumerate(UNITS):
        median = float(np.median(getattr(spread, name)))
        if median == 0:
            continue  # there is no share of none
        for bounds, width, said in ((most, 2.0, "95 % of the draws"), (half, 8.0, "half of them")):
            shares = 100.0 * np.array(bounds[name]) / median
            ax.plot(shares, (y, y), color=BLUE, linewidth=width, label=None if y else said)
        ax.plot([100.0], [y], "o", color="white", markeredgecolor=BLUE, zorder=3)
    if min(np.min(line.get_xdata()) for line in ax.lines) > 0:
        ax.set_xscale("log")
    names = [
        f"{name.replace('_', ' ')}\n{np.median(getattr(spread, name)):.4g} {unit}"
        for name, unit in UNITS.items()
    ]
    ax.set_yticks(range(len(names)), names, fontsize="small")
    ax.invert_yaxis()
    ax.set(xlabel="share of the median [%]")
    ax.xaxis.set_major_formatter("{x:g}")
    ax.set_title(f"sections of {len(spread.axial_stiffness)} draws")
    legend(ax)
    light_grid(ax)


def _across(strand: Strand, ax: Axes) -> None:
    from matplotlib.patches import Circle

    for bar, y, z, shade in _wires(strand):
        face = FIBRE if bar.EA == 0 else shade
        circle = Circle((MM * y, MM * z), MM * bar.diameter / 2, facecolor=face, edgecolor="white")
        circle.set_linewidth(0.4)
        ax.add_patch(circle)
    half = 0.53 * MM * strand.diameter
    ax.set(xlim=(-half, half), ylim=(-half, half), xlabel="y [mm]", ylabel="z [mm]")


def _wires(strand: Strand) -> Iterator[tuple[Bar, float, float, str]]:
    """Yield wires with their places in the section and the colours of their layers."""
    for bar in sorted(strand.bars, key=lambda one: -one.diameter):
        yield bar, 0.0, 0.0, BLUE
    for k, ring in enumerate(strand.rings):
        for angle in _angles(ring, k):
            y, z = ring.on.radius * np.cos(angle), ring.on.radius * np.sin(angle)
            if isinstance(ring.element, Bar):
                yield ring.element, y, z, colour(k + 1)
                continue
            for bar, dy, dz, _ in _wires(ring.element):
                # each strand is turned as it lies on its helix
                turned = complex(dy, dz) * np.exp(1j * angle)
                yield bar, y + turned.real, z + turned.imag, colour(k + 1)


def _angles(ring: Ring, k: int) -> Real:
    """Return the angles of elements of a ring, the layers in turn on gaps and on tops."""
    return np.asarray(2 * np.pi * (np.arange(ring.n) + 0.5 * (k % 2)) / ring.n)


def _from_the_side(strand: Strand, ax: Axes) -> None:
    """Draw the front half of the centre lines, as wide as what lies on them."""
    longest = max((2 * np.pi / abs(ring.on.turn) for ring in strand.rings), default=0.1)
    x = np.linspace(0.0, longest, POINTS)
    for k, ring in enumerate(strand.rings):
        for angle in _angles(ring, k):
            phase = angle + ring.on.turn * x
            y = np.where(np.sin(phase) >= 0, ring.on.radius * np.cos(phase), np.nan)
            shades: Any = {"color": colour(k + 1), "linewidth": 1.2, "zorder": k + 2}
            ax.plot(MM * x, MM * y, **shades)
    ax.set(xlabel="position along the rope [mm]", ylabel="y [mm]")
