"""Many ropes at once: `sweep` on threads, processes and Dask, with one worker and with two.

python benchmarks/sweep.py [ROPES]
"""

# isort: off
import timing  # noqa: F401 - before numpy

# isort: on
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Any

import numpy as np
import report
import scene

import ropedyn as rd

ROPES = 10_000
WORKERS = (1, 2)
LINES = np.linspace(10.0, 400.0, 200)


def nothing(rope: rd.Scene) -> None:
    """What the sweep itself costs."""


def modes(rope: rd.Scene) -> Any:
    return rope.compile().modes(10).frequency


def response(rope: rd.Scene) -> Any:
    return rope.compile(elements=100).frf(LINES, drive=("z", 0.5), threads=1).value


TASKS: dict[str, Callable[[rd.Scene], Any]] = {
    "Nothing at all: what sending costs": nothing,
    "Ten modes of continuous spans, from the scene": modes,
    f"A response of a chain of 100 elements at {len(LINES)} frequencies": response,
}


def ropes(count: int) -> list[rd.Scene]:
    """Return scenes whose tension and bending stiffness are spread over a decade each."""
    random = np.random.default_rng(1)
    factors = 10 ** random.uniform(-0.5, 0.5, (count, 2))
    return [
        scene.scene().replace(
            rope=rd.Rope(scene.LENGTH, scene.DENSITY, bending_stiffness=scene.BENDING * bending),
            tension=scene.TENSION * tension,
        )
        for tension, bending in factors.tolist()
    ]


@contextmanager
def dask(workers: int) -> Iterator[Executor]:
    from distributed import Client, LocalCluster

    options = {"threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(n_workers=workers, **options) as cluster, Client(cluster) as client:
        yield client.get_executor()


def processes(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(workers, mp_context=get_context("spawn"))


WAYS = {"threads": ThreadPoolExecutor, "processes": processes, "Dask processes": dask}


def swept(task: Callable[[Any], Any], given: Sequence[Any], **how: Any) -> rd.Sweep[Any]:
    """Sweep after one that starts workers; nothing fails."""
    rd.sweep(task, given[:100], **how)
    found = rd.sweep(task, given, **how)
    assert not found.failed, next(iter(found.failed.values()))
    return found


def times(
    task: Callable[[Any], Any], given: Sequence[Any], here: float, ways: Collection[str] = WAYS
) -> str:
    """Lay out the times of some ways; `here` is that of calls one after the other [s]."""
    lines = [["one after the other, here", *cells(here, here, here, len(given))]]
    for name in ways:
        executor = WAYS[name]
        one = None
        for workers in WORKERS:
            with executor(workers) as pool:
                found = swept(task, given, executor=pool).cost.seconds
            one = one or found
            lines.append([f"{name}, {workers}", *cells(found, one, here, len(given))])
    head = ["", "time [s]", "of a rope [us]", "one worker / this", "here / this"]
    return report.table(head, lines)


def cells(found: float, one: float, here: float, count: int) -> list[str]:
    each = [f"{found:.3g}", f"{1e6 * found / count:.3g}"]
    return [*each, f"{one / found:.2f}", f"{here / found:.2f}"]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else ROPES
    scenes = ropes(count)
    parts = [
        "# Many ropes at once\n\n"
        f"{report.machine()} for each worker.\n\n`sweep` over {count} ropes of different tension "
        "and bending stiffness: wall time with workers that have started."
    ]
    for title, task in TASKS.items():
        here = swept(task, scenes).cost.seconds
        parts.append(f"## {title}\n\n{times(task, scenes, here)}")
    report.write("sweep.md", "\n\n".join(parts))


if __name__ == "__main__":
    main()
