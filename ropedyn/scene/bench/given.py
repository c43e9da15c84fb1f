"""Tests that are given of a rope."""

from __future__ import annotations

from ...base import check
from ...base.errors import SceneError
from .bending_test import BendingTest
from .static_test import StaticTest
from .torsion_test import TorsionTest


def given_tests(bending: BendingTest | None, torsion: TorsionTest | None) -> tuple[StaticTest, ...]:
    """Return the tests that there are, at least one."""
    tests: list[StaticTest] = []
    for test, name, kind in (
        (bending, "bending", BendingTest),
        (torsion, "torsion", TorsionTest),
    ):
        if test is not None:
            tests.append(check.instance(test, name, kind, f"a {kind.__name__}"))
    if not tests:
        raise SceneError("bending or torsion must be a test, got None")
    return tuple(tests)
