"""The command that shows what is kept of hard cases, and lets anyone attack."""

from __future__ import annotations

import argparse

from ..study.hard.hard_cases import hard_cases
from .options import REFUSED, SOLVED, Command, option, progress, show


def _hard(options: argparse.Namespace) -> int:
    table = hard_cases(options.random, options.seed, progress=progress(options))
    show(options, table, "\n".join([str(table), *table.failures]))
    return SOLVED if table.ok else REFUSED


HARD = Command(
    "hard",
    _hard,
    "digits kept in cases that are hard to keep stable",
    (
        option("--random", "how many random scenes to attack", type=int, default=0),
        option("--seed", "of the random scenes, given with --random", type=int),
    ),
    "Digits kept in cases that are hard to keep stable, against values of 40 digits and beside "
    f"SciPy; and random hard scenes. Exit status {REFUSED} where digits, a bound or a check are "
    "lost.",
    elements=(),
    subject=(),
)
