"""What a measurement and the model say of each other: docs/measured.png and docs/measured.md.

The page has every rope of known tension, what is identified of it, and which intervals miss. Of the
figure, left: first frequencies of 35 tubes of known tension, nothing fitted (source in
tests/support/measured_ropes.py). Right: a made measurement with noise, the scene as it was drawn
and as identified.

python docs/measured.py
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FixedLocator, NullLocator

import ropedyn as rd
from ropedyn.plot.figure import PALETTE

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests" / "support"))
from measured_cases import ENDS, answers, table_of  # noqa: E402 - beside the tests
from measured_ropes import (  # noqa: E402 - beside the tests
    STRAW_FREQUENCY,
    STRAW_LENGTH,
    STRAW_TENSION,
    straw,
)

DRAWN = rd.Scene(
    rd.Rope(1.35, 0.1017, bending_stiffness=1.54),
    tension=2830.0,
    damping=rd.RayleighDamping(4.0, 1e-5),
)
LINES = np.linspace(20.0, 400.0, 761)
NOISE = 0.03
"""Of each line, relative."""
PAGE = """# Ropes of known tension

What others measured and published with the tension, by a weight that hung on it: a cord (M. Ali,
D. Broggi, G. Cantarini; five peaks, its stiffness unknown) and 35 tubes that are glued at both ends
(J. Bono, Fermilab; the first peak of each). Facts, sources and what is taken as known beforehand
stand in tests/support/measured_ropes.py and tests/support/measured_cases.py, and
`python docs/measured.py` writes this page. Nothing is left out: "inside" says whether the 95 %
interval holds the tension, the last column whether it reaches what the weight, to 10 g, may be.
"""
SECTION = """## Ends {ends}

{inside} of {count} intervals hold the tension, {reached} reach what the weight may be.

```
{table}
```
"""


def measured() -> rd.Measured:
    """Return the response of a rope that is tensed 8 % more than drawn, with noise."""
    true = DRAWN.replace(tension=1.08 * DRAWN.tension).compile()
    frf = true.frf(LINES, drive=("z", 0.4), response=("z", 0.9))
    real, imaginary = np.random.default_rng(1).normal(0, NOISE / np.sqrt(2), (2, len(LINES)))
    value = frf.value * (1 + real + 1j * imaginary)
    return rd.Measured(LINES, value, drive=frf.drive, response=frf.response)


def draw_tubes(ax: plt.Axes) -> None:
    """Draw predicted over measured frequencies."""
    for length, row in zip(STRAW_LENGTH, STRAW_FREQUENCY):
        found = [straw(length, T).compile().modes(1).frequency[0] for T in STRAW_TENSION]
        ax.loglog(row, found, "o", label=f"{length} m")
    ax.axline((30.0, 30.0), (100.0, 100.0), color="0.5", linewidth=1, zorder=0)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(FixedLocator([25, 50, 100, 200]))
        axis.set_major_formatter("{x:.0f}")
        axis.set_minor_locator(NullLocator())
    ax.set(xlabel="measured [Hz]", ylabel="predicted [Hz]")
    ax.set_title("tubes of known tension, nothing fitted")
    ax.legend(fontsize="small")


def draw_rope(ax: plt.Axes) -> None:
    """Draw the made response, that of the scene as drawn, and that as identified."""
    found = measured()
    fit = rd.identify(DRAWN, found, ["tension", "bending_stiffness", "damping.mass"])
    ax.semilogy(
        LINES, np.abs(found.value[0]), ".", color="0.6", markersize=3, label="made, with noise"
    )
    for name, scene in (("as drawn", DRAWN), ("identified", fit.scene)):
        frf = scene.compile().frf(LINES, drive=("z", 0.4), response=("z", 0.9))
        ax.semilogy(LINES, np.abs(frf.value[0]), linewidth=1.2, label=name)
    low, high = fit.interval(0.95)["tension"]
    ax.set(xlabel="frequency [Hz]", ylabel="receptance [m/N]")
    ax.set_title(f"tension {low:.0f} to {high:.0f} N with 95 %, true {1.08 * DRAWN.tension:.0f} N")
    ax.legend(fontsize="small")


def page() -> str:
    """Return the page of ropes of known tension, a table for each that is said of their ends."""
    parts = [PAGE]
    for ends in ENDS:
        found = answers(ends)
        held = {of: sum(getattr(one, of) for one in found) for of in ("inside", "reached")}
        parts.append(SECTION.format(ends=ends, count=len(found), table=table_of(found), **held))
    return "\n".join(parts)


def main(path: Path) -> None:
    """Draw both sides of the figure."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for ax in (left, right):
        ax.set_prop_cycle(color=PALETTE)
    draw_tubes(left)
    draw_rope(right)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    (HERE / "measured.md").write_text(page(), encoding="utf-8")
    main(HERE / "measured.png")
