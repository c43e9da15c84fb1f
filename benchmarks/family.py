"""Many ropes: families in closed form, beside what is written by hand in NumPy and SciPy.

python benchmarks/family.py
"""

# isort: off
import timing  # before numpy

# isort: on
import time
import tracemalloc
from collections.abc import Callable
from functools import partial

import mpmath
import numpy as np
import report
from closed_form import Span
from scipy.sparse.linalg import eigsh

import ropedyn as rd

NUMBER = 10
LENGTH, DENSITY = 1.35, 0.1017
ROPES = (1, 10, 100, 1000, 10_000, 100_000, 1_000_000)
ALONE, CHECKED = 50, 12
"""Ropes that are solved one by one, and those whose frequencies are checked."""
ELEMENTS = 64

CLAMPED = ["tension", "bending_stiffness"]
SPRUNG = ["length", "linear_density", *CLAMPED, "ends[0].spring.beta", "ends[1].spring.beta"]
PUSHED = [*SPRUNG, "ends[0].spring.z", "ends[1].spring.z"]


def scene_of(tension: float, bending: float) -> rd.Scene:
    """Return one clamped rope."""
    return rd.Scene(rd.Rope(LENGTH, DENSITY, bending_stiffness=bending), tension=tension)


def clamped(count: int) -> np.ndarray:
    """Return tensions and bending stiffnesses [N, N m^2], T L^2/B from 1 to 1e6."""
    rng = np.random.default_rng(17)
    bending = 10 ** rng.uniform(0, 2, count)
    return np.stack([10 ** rng.uniform(0, 6, count) * bending / LENGTH**2, bending], axis=1)


def sprung(count: int) -> np.ndarray:
    """Return ropes of other lengths and densities, on springs against turning and moving."""
    rng = np.random.default_rng(18)
    tension, bending = clamped(count).T
    columns = [rng.uniform(1, 2, count), rng.uniform(0.05, 0.2, count), tension, bending]
    columns += [10 ** rng.uniform(-1, 4, count) * bending for _ in range(2)]
    return np.stack(columns + [10 ** rng.uniform(1, 6, count) * bending for _ in range(2)], axis=1)


def by_hand(values: np.ndarray) -> np.ndarray:
    """Return frequencies of clamped ropes by the Newton steps of `closed_form`, all at once."""
    ratio, half = (values[:, :1] / values[:, 1:]), LENGTH / 2
    j = np.arange(1, NUMBER + 1)
    way = np.where(j % 2, -1.0, 1.0)
    k = j * (np.pi / LENGTH) + 0 * ratio
    for _ in range(5):
        a = np.sqrt(k * k + ratio)
        y = k / a * np.tanh(a * half) ** way
        slope = half - ratio / (a * a * a * (1 + y * y))
        k = k - (k * half - j * (np.pi / 2) - np.arctan(y)) / slope
    return k * np.sqrt((values[:, :1] + values[:, 1:] * k * k) / DENSITY) / (2 * np.pi)


def exact(tension: float, bending: float) -> list[mpmath.mpf]:
    """Return the same by 40 digits."""
    with mpmath.workdps(40):
        T, B, L = mpmath.mpf(tension), mpmath.mpf(bending), mpmath.mpf(LENGTH)

        def zero(k, n):
            a = mpmath.sqrt(k * k + T / B)
            t = mpmath.tanh(a * L / 2)
            return k * L / 2 - n * mpmath.pi / 2 - mpmath.atan(k / a * (1 / t if n % 2 else t))

        found = []
        for n in range(1, NUMBER + 1):
            ends = n * mpmath.pi / L, (n + 1) * mpmath.pi / L
            k = mpmath.findroot(partial(zero, n=n), ends, solver="anderson", tol=1e-36)
            f = k * mpmath.sqrt((T + B * k * k) / mpmath.mpf(DENSITY)) / (2 * mpmath.pi)
            found.append(f)
        return found


def worst(frequency: np.ndarray, true: list[list[mpmath.mpf]]) -> float:
    """Return the largest relative error."""
    pairs = zip(frequency.ravel().tolist(), (f for row in true for f in row))
    return float(max(abs(mpmath.mpf(f) - g) / g for f, g in pairs))


def banded(values: np.ndarray) -> Callable[[], np.ndarray]:
    """Return a call of SciPy's sparse eigensolver on chains, assembling left out."""
    matrices = []
    for T, B in values:
        model = scene_of(T, B).compile(elements=ELEMENTS)
        matrices.append((model.stiffness().tocsc(), model.mass().tocsc()))

    def solve() -> np.ndarray:
        each = [eigsh(K, NUMBER, M, sigma=0, return_eigenvectors=False) for K, M in matrices]
        return np.sqrt(np.sort(each, axis=1)) / (2 * np.pi)

    return solve


def compared() -> str:
    """Return the table of ways to ten frequencies of clamped ropes, a rope each."""
    some, many = clamped(ALONE), clamped(10_000)
    family = scene_of(1.0, 1.0).family(CLAMPED)
    spans = [Span(LENGTH, DENSITY, B, T) for T, B in some]
    calls = {
        "family": (lambda: family.modes(many, NUMBER, threads=1).frequency, len(many)),
        "family, with derivatives": (
            lambda: family.modes(many, NUMBER, derivative=True, threads=1).frequency,
            len(many),
        ),
        "NumPy by hand, all ropes at once": (lambda: by_hand(many), len(many)),
        "family, rope by rope": (
            lambda: np.vstack([family.modes(v[None], NUMBER, threads=1).frequency for v in some]),
            ALONE,
        ),
        "NumPy by hand, rope by rope": (
            lambda: np.array([span.newton(NUMBER) for span in spans]),
            ALONE,
        ),
        "brentq, rope by rope": (lambda: np.array([s.brentq(NUMBER) for s in spans]), ALONE),
        "scene, compiled, modes": (
            lambda: np.array([scene_of(*v).compile().modes(NUMBER).frequency for v in some]),
            ALONE,
        ),
        f"eigsh, {ELEMENTS} elements": (banded(some[:CHECKED]), CHECKED),
    }
    times = timing.medians({name: call for name, (call, _) in calls.items()}, budget=6.0)
    base = times["family"] / len(many)
    true = {len(many): many[:CHECKED], ALONE: some[:CHECKED], CHECKED: some[:CHECKED]}
    known = {count: [exact(T, B) for T, B in values] for count, values in true.items()}
    rows = []
    for name, (call, count) in calls.items():
        each = times[name] / count
        error = worst(call()[:CHECKED], known[count])
        cells = report.digits(each * 1e6), report.digits(each / base), f"{error:.1e}"
        rows.append([name, *cells])
    return report.table(["way", "us a rope", "times the family", "largest error"], rows)


def growth() -> str:
    """Return the table of times and memory against the number of ropes."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=1.0)
    rows = []
    for count in ROPES:
        cells = [f"{count}"]
        for paths in (SPRUNG, PUSHED):
            family = rd.Scene(rope, tension=1.0).family(paths)
            values = np.ascontiguousarray(sprung(count)[:, : len(paths)])
            ask = partial(family.modes, values, NUMBER, derivative=True, threads=1)
            seconds = timing.medians({"": ask}, least=0.05)[""]
            cells.append(report.digits(seconds / count * 1e6))
        tracemalloc.start()
        found = ask()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        kept = found.derivative.nbytes + 4 * found.frequency.nbytes + values.nbytes
        cells.append(f"{found.certified.mean():.4f}")
        cells.append(report.digits(peak / kept))
        rows.append(cells)
    head = ["ropes", "held, us a rope", "on springs, us a rope", "certified", "peak memory"]
    return report.table(head, rows)


def threads() -> str:
    """Return wall times of one and two threads, the least of five."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=1.0)
    family, values = rd.Scene(rope, tension=1.0).family(PUSHED), sprung(100_000)
    least = {}
    for _ in range(5):
        for count in (1, 2):
            start = time.perf_counter()
            family.modes(values, NUMBER, derivative=True, threads=count)
            least[count] = min(least.get(count, np.inf), time.perf_counter() - start)
    return f"100 000 ropes on springs: {least[1]:.2f} s on one thread, {least[2]:.2f} s on two."


def main() -> None:
    """Measure, print and keep."""
    text = f"""# Many ropes

{report.machine()}. Ten lowest frequencies; medians of processor times of calls in turn.

## Ways

Clamped ropes, T L^2/B from 1 to 1e6. The family certifies that no mode is missed, as the compiled
scene does; the others do not. By hand there are five Newton steps. Errors against 40 digits; of
`eigsh` that of its {ELEMENTS} tensed elements.

{compared()}

## Number of ropes

With derivatives by length, density, tension, bending stiffness and two springs against turning;
ends held, or on springs across the rope with derivatives by these too. Peak memory in parts of the
values and the answer.

{growth()}

{threads()}
"""
    report.write("family.md", text.rstrip())


if __name__ == "__main__":
    main()
