"""Ropes that hang, upright and across: ours, CableDyn, MoorPy and elements in SciPy.

pip install cabledyn==0.3.0 moorpy==1.3.0; python benchmarks/hanging.py
"""

# isort: off
import timing  # before numpy

# isort: on
import math
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cabledyn
import moorpy
import mpmath
import numpy as np
import report
import scipy.linalg
import scipy.sparse

import ropedyn as rd

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))
from catenary_elements import of_catenary

G = 9.81
NUMBER = 4
REPEAT = 7
STIFF = 1e12  # Axial stiffness of a rope that must not stretch [N].


class Hanging(NamedTuple):
    """A string between two ends at rest."""

    scene: rd.Scene
    exact: np.ndarray  # [Hz]
    ends: tuple[tuple[float, float, float], tuple[float, float, float]]
    slack: float  # length without tension [m]
    density: float  # per slack length [kg/m]
    axial: float  # [N]


def upright(length: float = 1000.0, density: float = 8.4, bottom: float = 196e3) -> Hanging:
    """A hoist rope; its frequencies are zeros of Bessel functions."""
    weight = density * G
    scene = rd.Scene(
        rd.Rope(length, density),
        tension=rd.Tension(bottom, at="start"),
        gravity=rd.Gravity(G, inclination=math.pi / 2),
    )

    def characteristic(f: mpmath.mpf) -> mpmath.mpf:
        # T z'' + w z' + mu omega^2 z = 0 has J0 and Y0 of (2 omega/g) sqrt(T/mu)
        a, b = (
            4 * mpmath.pi * f / G * mpmath.sqrt(tension / density)
            for tension in (mpmath.mpf(bottom), bottom + weight * mpmath.mpf(length))
        )
        pairs = mpmath.besselj(0, a) * mpmath.bessely(0, b)
        return pairs - mpmath.besselj(0, b) * mpmath.bessely(0, a)

    near = scene.compile().modes(NUMBER).frequency
    exact = np.array([float(mpmath.findroot(characteristic, f)) for f in near])
    stretched = (bottom + weight * length / 2) / STIFF
    slack = length / (1 + stretched)
    ends = ((0.0, 0.0, -1.0), (0.0, 0.0, -1.0 - length))
    return Hanging(scene, exact, ends, slack, density * length / slack, STIFF)


def across(sag: float, parameter: float, length: float = 100.0, density: float = 2.0) -> Hanging:
    """A level cable of some sag [spans] and lambda^2, against elements on its catenary."""
    slope = 8 * sag
    tension = density * G * length / slope
    axial = parameter * tension / slope**2 * (1 + slope**2 / 8)
    scene = rd.Scene(
        rd.Rope(length, density, axial_stiffness=axial), tension=tension, gravity=rd.Gravity(G)
    )
    c = tension / (density * G)
    arc = 2 * c * math.sinh(length / (2 * c))
    # EA is what a change of length at rest meets: of a slack length it is less by the tension
    own = axial - tension
    x, weight = np.polynomial.legendre.leggauss(20)
    steep = np.cosh(x * length / (2 * c))
    slack = float(np.sum(weight * length / 2 * steep / (1 + tension / own * steep)))
    ends = ((0.0, 0.0, -100.0), (length, 0.0, -100.0))
    exact = of_catenary(scene, number=NUMBER)
    return Hanging(scene, exact, ends, slack, density * arc / slack, own)


def ours(one: Hanging) -> Callable[[], np.ndarray]:
    """Compile and solve; what is solved as a parabola knows its frequencies on the catenary."""

    def ask() -> np.ndarray:
        modes = one.scene.compile().modes(NUMBER)
        near = one.scene.sags and "catenary" not in modes.cost.method
        return modes.catenary if near else modes.frequency

    return ask


def by_cabledyn(one: Hanging, count: int, *, cubic: bool) -> Callable[[], np.ndarray]:
    """Run its driver on a deck, and read the frequencies that it writes."""
    # its cubic elements bend, and need a step of time
    bending, more = (1e-5, ((1e-3, "dtM"), (1e-3, "TMax"))) if cubic else (0.0, ())
    folder = Path(tempfile.mkdtemp())
    deck = cabledyn.DeckWriter(title="hanging")
    deck.add_line_type("rope", diam=1e-4, mass=one.density, ea=one.axial, ba=0.0, ei=bending,
                       cdn=0.0, cdt=0.0, can=0.0, cat=0.0)  # fmt: skip
    for number, (kind, end) in enumerate(zip(("Coupled", "Fixed"), one.ends), start=1):
        deck.add_point(number, kind, *end)
    deck.add_line(1, node_a=1, node_b=2)
    deck.add_section(line_id=1, line_type="rope", length=one.slack, num_segs=count)
    for value, name in ((G, "g"), (4 * NUMBER, "nModes"), (1e-6, "rhoW"), *more):
        deck.set_option(value, name, name)
    deck.write(folder / "deck.dat")
    driver = Path(cabledyn.__file__).parent / "bin" / "cabledyn"

    def ask() -> np.ndarray:
        command = [str(driver), str(folder / "deck.dat"), str(folder / "out")]
        subprocess.run(command, check=True, capture_output=True)
        lines = (folder / "out.modes.out").read_text(encoding="utf-8").splitlines()
        rows = [line.split("\t") for line in lines]
        return np.array([float(row[2]) for row in rows if len(row) == 5 and row[0] == "1"])

    return ask


def cabledyn_of(one: Hanging) -> dict[str, Callable[[], np.ndarray]]:
    """Its lumped and its cubic elements."""
    cubic = {f"CableDyn, {n} cubic": by_cabledyn(one, n, cubic=True) for n in (16, 64)}
    return {"CableDyn, 128 lumped": by_cabledyn(one, 128, cubic=False)} | cubic


def by_moorpy(one: Hanging, count: int) -> Callable[[], np.ndarray]:
    """Find the line at rest and the frequencies of its matrices, by SciPy."""

    def ask() -> np.ndarray:
        system = moorpy.System(depth=2000.0, rho=1e-9, g=G)
        system.setLineType(10.0, material="chain", name="rope")
        system.lineTypes["rope"].update(
            d_vol=1e-6, m=one.density, w=one.density * G, EA=one.axial, Ca=0.0, CaAx=0.0
        )
        for end in one.ends[::-1]:
            system.addPoint(1, list(end))
        system.addLine(one.slack, "rope", pointA=1, pointB=2, nSegs=count)
        system.initialize()
        line = system.lineList[0]
        mass, added, _, stiffness, *_ = line.getDynamicMatrices(
            np.ones(1), np.ones(1), 0.0, 2000.0, 3e6, 3e5
        )
        free = slice(3, -3)
        pair = stiffness[free, free], (mass + added)[free, free]
        value = scipy.linalg.eigvals(*pair).real
        return np.sqrt(np.sort(value[value > 0])) / (2 * math.pi)

    return ask


def by_elements(one: Hanging, count: int) -> Callable[[], np.ndarray]:
    """Straight elements with consistent mass, each under the tension at its middle; upright."""

    def ask() -> np.ndarray:
        length = one.scene.rope.length / count
        at = (np.arange(count) + 0.5) * length
        tension = 196e3 + one.scene.rope.linear_density * G * at
        both = tension[:-1] + tension[1:]
        inner = -tension[1:-1]
        stiff = scipy.sparse.diags_array([inner, both, inner], offsets=[-1, 0, 1]) / length
        ones = np.ones(count - 1)
        each = one.scene.rope.linear_density * length / 6
        heavy = scipy.sparse.diags_array([ones[1:], 4 * ones, ones[1:]], offsets=[-1, 0, 1]) * each
        value = scipy.sparse.linalg.eigsh(
            stiff.tocsc(), NUMBER, heavy.tocsc(), sigma=0.0, return_eigenvectors=False
        )
        return np.sqrt(np.sort(value)) / (2 * math.pi)

    return ask


def spent() -> float:
    """The time of the processor, of what has run as a program of its own too [s]."""
    return sum(
        getattr(resource.getrusage(who), name)
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        for name in ("ru_utime", "ru_stime")
    )


def off(found: np.ndarray, exact: np.ndarray) -> float:
    """The largest relative error; of what moves across as well, of the nearest frequencies."""
    nearest = np.abs(found[:, None] - exact).argmin(axis=0)
    return float(np.abs(found[nearest] / exact - 1).max())


def rows(name: str, one: Hanging, calls: dict[str, Callable[[], np.ndarray]]) -> list[list[str]]:
    """Return name, error and time of each, taking turns."""
    times: dict[str, list[float]] = {who: [] for who in calls}
    error = {who: off(call(), one.exact) for who, call in calls.items()}
    for _ in range(REPEAT):
        for who, call in calls.items():
            start = spent()
            call()
            times[who].append(spent() - start)
    middle = {who: 1e3 * statistics.median(each) for who, each in times.items()}
    return [
        [name, who, report.digits(middle[who]), f"{error[who]:.1e}", report.digits(
            middle[who] / middle["ropedyn"]
        )]
        for who in calls
    ]  # fmt: skip


def main() -> None:
    assert timing
    hoist = upright()
    calls = {"ropedyn": ours(hoist)}
    calls |= cabledyn_of(hoist)
    calls |= {f"MoorPy, {n} lumped": by_moorpy(hoist, n) for n in (160,)}
    calls |= {f"eigsh, {n} elements": by_elements(hoist, n) for n in (256, 4096)}
    found = rows("upright, 1000 m", hoist, calls)
    for sag, parameter in ((0.005, 5.0), (0.02, 50.0), (0.06, 500.0), (0.12, 1e4)):
        one = across(sag, parameter)
        calls = {"ropedyn": ours(one)}
        calls |= cabledyn_of(one)
        calls |= {f"MoorPy, {n} lumped": by_moorpy(one, n) for n in (160,)}
        found += rows(f"sag {sag} L, lambda^2 = {parameter:g}", one, calls)
    head = ["rope", "solver", "time [ms]", "error", "/ ropedyn"]
    text = f"""# Ropes that hang

{report.machine()}. CableDyn 0.3.0, MoorPy 1.3.0.
The four lowest frequencies of strings, statics included. Upright: 196 kN at the bottom of 1000 m of
8.4 kg/m; exact are zeros of Bessel functions. Across: 100 m of 2 kg/m at a sag; exact are Legendre
elements on the catenary. ropedyn's answer across is `modes.catenary` of the parabola at the least
sag and the modes of the catenary at all others. Errors are the largest relative ones, medians of
processor time in turn; of CableDyn a run of its driver, whose deck is written before and whose
frequencies have nine digits, of MoorPy its matrices, solved by SciPy.

{report.table(head, found)}
"""
    report.write("hanging.md", text)


if __name__ == "__main__":
    main()
