"""Many ropes: families in closed form, beside what is written by hand in NumPy and SciPy.

python benchmarks/family.py
"""

# isort: off
import timing  # before numpy

# isort: on
import ctypes
import subprocess
import tempfile
import time
import tracemalloc
from collections.abc import Callable
from functools import partial
from pathlib import Path

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
SPANS = (1, 2, 4, 8)
SETS = {"AVX-512": "x86-64-v4", "AVX2": "x86-64-v3", "SSE": "x86-64"}

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
        matrices.append((model.stiffness_matrix().tocsc(), model.mass_matrix().tocsc()))

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


def chains() -> str:
    """Return the table of chains of equal spans with a mass and springs at every station."""
    rows = []
    for spans in SPANS:
        rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=1.5)
        places = [k * LENGTH / spans for k in range(1, spans)]
        parts = [rd.PointMass(x, 0.01 * (k + 1)) for k, x in enumerate(places)]
        parts += [rd.Spring(x, 100.0) for x in places]
        paths = [*CLAMPED, "linear_density", "ends[0].spring.beta", "ends[1].spring.beta"]
        family = rd.Scene(rope, tension=1000.0, parts=parts).family(paths)
        values = sprung(1000)[:, [2, 3, 1, 4, 5]]
        ask = partial(family.modes, values, NUMBER, derivative=True, threads=1)
        seconds = timing.medians({"": ask}, least=0.05)[""]
        found = ask()
        cells = [report.digits(seconds / len(values) * 1e6), found.cost.method]
        rows.append([f"{spans}", *cells, f"{found.certified.mean():.4f}"])
    return report.table(["spans", "us a rope", "", "certified"], rows)


def responses() -> str:
    """Return the table of 1000 lines of one span."""
    scene = rd.Scene(
        rd.Rope(LENGTH, DENSITY, bending_stiffness=1.5),
        tension=2000.0,
        damping=rd.ViscousDamping(0.5),
    )
    family, model = scene.family(["tension"]), scene.compile()
    lines, values = np.linspace(1.0, 400.0, 1000), np.linspace(1000.0, 3000.0, 100)[:, None]
    asked = {"drive": ("z", 0.4), "response": ("z", 0.6), "threads": 1}
    calls = {
        "family, 100 rows": lambda: family.frf(values, lines, **asked),
        "`model.frf`": lambda: model.frf(lines, **asked),
        "scene, compiled, `frf`": lambda: (
            scene.replace(tension=2001.0).compile().frf(lines, **asked)
        ),
    }
    times = timing.medians(calls, least=0.05)
    times["family, 100 rows"] /= len(values)
    return report.table(
        ["way", "ms a rope"], [[name, report.digits(t * 1e3)] for name, t in times.items()]
    )


class Modes(ctypes.Structure):
    """`struct rd_closed_modes` of csrc/closed/closed.h."""

    _fields_ = (
        ("number", ctypes.c_size_t),
        *((name, ctypes.c_void_p) for name in ("omega", "error", "slope", "certified")),
    )


class Ropes(ctypes.Structure):
    """`struct rd_ropes` of csrc/closed/closed.h."""

    _fields_ = (
        ("number", ctypes.c_void_p),
        ("values", ctypes.c_size_t),
        ("jacobian", ctypes.c_void_p),
    )


def sets() -> str:
    """Return the table of instruction sets, each compiled for itself."""
    values = sprung(10_000)
    # the core's order: springs across the rope before those against turning
    number = np.ascontiguousarray(values[:, [0, 1, 2, 3, 6, 4, 7, 5]])
    own, calls, answers = np.eye(8), {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for name, arch in SETS.items():
            library = Path(folder, f"{arch}.so")
            command = ["gcc", "-std=c17", "-O2", "-fno-gcse", "-ffp-contract=off", "-shared"]
            command += ["-fno-math-errno", "-Wno-psabi", "-fPIC", "-DRD_ONE_SET", f"-march={arch}"]
            core = Path(__file__).parent.parent / "csrc"
            command += [f"-I{core}", str(core / "closed/bent_span.c"), "-o", str(library), "-lm"]
            subprocess.run(command, check=True)
            shape = (len(number), NUMBER)
            answer = [np.empty(shape), np.empty(shape), np.empty((*shape, 8))]
            answer.append(np.empty(len(number), dtype=np.uint8))
            ropes = Ropes(number.ctypes.data, 8, own.ctypes.data)
            modes = Modes(NUMBER, *(one.ctypes.data for one in answer))
            solve = ctypes.CDLL(str(library)).rd_bent_modes
            solve.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_void_p]
            calls[name] = partial(
                solve, ctypes.addressof(ropes), 0, len(number), ctypes.addressof(modes)
            )
            answers[name] = answer, ropes, modes
        times = timing.medians(calls, budget=6.0)
    first = answers["AVX-512"][0]
    rows = []
    for name, (answer, *_) in answers.items():
        same = all(np.array_equal(one, two) for one, two in zip(answer, first))
        each = report.digits(times[name] / len(number) * 1e6)
        rows.append([name, each, "the same" if same else "others"])
    return report.table(["instructions", "us a rope", "bits"], rows)


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

## Instruction sets

The core's part alone, on springs with eight derivatives; each compiled for itself.

{sets()}

## Chains

Ten modes with five derivatives of 1000 ropes with a mass and a spring at every station between
equal spans.

{chains()}

## Responses

1000 lines of one damped span.

{responses()}
"""
    report.write("family.md", text.rstrip())


if __name__ == "__main__":
    main()
