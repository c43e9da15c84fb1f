#!/usr/bin/env python3
"""Whether the core's includes keep to the order of its folders, and run in no circle."""

import re
import sys
from pathlib import Path

FLOORS = [
    "base",
    "closed",
    "element",
    "chain",
    "span",
    "graded",
    "sweep/kernel",
    "sweep",
    "damped",
    "modes/walk",
    "modes/count",
    "modes/refine",
    "modes/certify",
    "energy",
    "assembled",
    "mixed",
    "balance",
    "law",
    "collocation",
    "volterra",
    "space",
    "glue",
    "glue/closed",
    "glue/laws",
]
"""Folders of csrc from the ground up: a file may include what lies in its own or one before it."""

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def includes(core):
    """What each C file of the folder includes, by paths from there: {path: [path, ...]}."""
    files = sorted(path for path in core.rglob("*") if path.suffix in (".c", ".h"))
    return {f.relative_to(core).as_posix(): INCLUDE.findall(f.read_text()) for f in files}


def complaints(core):
    """What is wrong with the includes of the folder, a line each."""
    graph = includes(core)
    return [*_against_the_order(graph), *_circles(graph)]


def _against_the_order(graph):
    for file, included in graph.items():
        for other in included:
            if other not in graph:
                yield f'{file}: "{other}" is no file of csrc; includes name their folder'
        mine = _floor(file)
        if mine is None:
            yield f"{file}: its folder is missing in FLOORS of tests/c/walls.py"
            continue
        for other in included:
            floor = _floor(other)
            if other in graph and floor is not None and floor > mine:
                yield f'{file}: "{other}" lies above it, in {FLOORS[floor]}'


def _floor(file):
    folder = file.rpartition("/")[0]
    return FLOORS.index(folder) if folder in FLOORS else None


def _circles(graph):
    """A header and its source are one unit, so that no two of them call each other."""
    units = {}
    for file, included in graph.items():
        unit = file.rpartition(".")[0]
        others = {name.rpartition(".")[0] for name in included if name in graph}
        units.setdefault(unit, set()).update(others - {unit})
    done = set()
    for unit in units:
        yield from _circles_from(unit, units, [], done)


def _circles_from(unit, units, path, done):
    if unit in path:
        yield "a circle of includes: " + " -> ".join([*path[path.index(unit) :], unit])
        return
    if unit in done:
        return
    for other in sorted(units[unit]):
        yield from _circles_from(other, units, [*path, unit], done)
    done.add(unit)


if __name__ == "__main__":
    found = complaints(Path(__file__).parent.parent.parent / "csrc")
    print("\n".join(found), end="\n" if found else "", file=sys.stderr)
    sys.exit(bool(found))
