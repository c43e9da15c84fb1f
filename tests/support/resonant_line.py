"""Random undamped lines at, and next to, frequencies where a response passes 0 or infinity.

`python tests/support/resonant_line.py` writes those of a few seeds to
tests/reference/resonant_lines.json.
"""

import json
import typing
from pathlib import Path

import mpmath
import numpy as np
from exact_chain import Exact, omega_of
from exact_span import Continuum, Law, coupled
from random_scene import random_line, random_spans

import ropedyn as rd

FILE = Path(__file__).parent.parent / "reference" / "resonant_lines.json"
SEEDS = range(150, 300)
GRID, MOST_ELEMENTS, MOST_RADIANS = 60, 60, 2000.0
DIGITS = 60


class Resonant(typing.NamedTuple):
    """A model, and two points between which it responds, also as the exact one names them."""

    model: rd.Model
    points: list[tuple[str, float]]
    exact: Exact | Continuum
    places: list[tuple[str, float]]
    frequency: float


def resonant(seed, kind):
    """A random undamped chain or continuous spans; None where elements are many."""
    if kind == "span":
        scene, f, *points = random_spans(seed)
        scene = scene.replace(damping=None)
        exact = Continuum(scene, coupled(scene, points[0][0]))
        still = waves_of(scene, exact, 0.0)
        # waves of a taut rope that stands still are no shorter at any lower frequency
        while waves_of(scene, exact, f) > max(MOST_RADIANS, still):
            f /= 10
        return Resonant(scene.compile(), points, exact, points, f / 3)
    line = random_line(seed)
    count = len(line.model.x) - 1
    if count > MOST_ELEMENTS:
        return None
    scene = line.model.scene.replace(damping=None)
    model = scene.compile(elements=count, element=line.model.element)
    x, places = model.x.tolist(), [line.drive, line.response]
    points = [(c, x[k]) for c, k in places]
    with mpmath.workdps(DIGITS):  # lengths are quotients
        exact = Exact(model, model.component_of(points[0][0]))
    return Resonant(model, points, exact, places, line.frequency or 1.0)


def waves_of(scene, exact, f):
    """The largest wavenumber of a scene."""
    return Law(scene, exact.coordinates, 1, 1, -(omega_of(f) ** 2)).wavenumber


def crossing(line, random):
    """A frequency where the response changes its sign, and one next to it; None without any."""

    def responses(f):
        return (
            line.model.frf(f, drive=line.points[0], response=line.points[1], threads=1)
            .value[0]
            .real
        )

    grid = np.geomspace(line.frequency / 3, 3 * line.frequency, GRID)
    signs = np.sign(responses(grid))
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    if not len(changes):
        return None
    k = random.choice(changes)
    a, b = grid[k], grid[k + 1]
    while a < (a + b) / 2 < b:
        middle = (a + b) / 2
        if np.sign(responses([middle])[0]) == signs[k]:
            a = middle
        else:
            b = middle
    return float(a * (1 + random.choice([-1, 1]) * 10 ** -random.uniform(2, 17)))


def exact_line(seed, kind):
    """The model, points, frequency and exact response of a seed, None where there is none."""
    line = resonant(seed, kind)
    if line is None:
        return None
    try:
        f = crossing(line, np.random.default_rng([seed, 20]))
        if f is None:
            return None
        with mpmath.workdps(DIGITS):
            return line, f, line.exact.receptance(omega_of(f), line.places[0], line.places[1:])[0]
    except (rd.SolveError, ZeroDivisionError):
        return None


def error_and_limit(line, f, exact):
    """Absolute error, `rounding_limit` and size of the value; a refusal has no limit."""
    try:
        frf = line.model.frf(f, drive=line.points[0], response=line.points[1], threads=1)
    except rd.SolveError:
        return 0.0, np.inf, 0.0
    value = frf.value[0, 0]
    with mpmath.workdps(DIGITS):
        error = float(abs(mpmath.mpmathify(complex(value)) - exact))
    return error, frf.rounding_limit[0, 0], abs(value)


def kept_lines(kind):
    """The lines of the file."""
    with mpmath.workdps(DIGITS):
        for seed, f, exact in json.loads(FILE.read_text(encoding="utf-8"))[kind]:
            yield resonant(seed, kind), f, mpmath.mpf(exact)


def main():
    """Write the file."""
    found = {}
    for kind in ("chain", "span"):
        lines = ((seed, exact_line(seed, kind)) for seed in SEEDS)
        found[kind] = [[seed, one[1], mpmath.nstr(one[2], 50)] for seed, one in lines if one]
    text = ",\n".join(
        f' "{kind}": [\n' + ",\n".join(f"  {json.dumps(one)}" for one in lines) + "\n ]"
        for kind, lines in found.items()
    )
    FILE.write_text("{\n" + text + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    from stored import SESSION

    SESSION.large = True
    main()
