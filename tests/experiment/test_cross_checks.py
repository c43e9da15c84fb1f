"""Closed formulas of the field against the exact clamped rope, in the ranges that they name."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.experiment.identify.cross_checks import cross_checks

ROPE = rd.Rope(50.0, 20.0, bending_stiffness=2e4)
XI = np.geomspace(2.0, 3000.0, 400)
TENSION = XI**2 * ROPE.bending_stiffness / ROPE.length**2


def exact(ends):
    family = rd.Scene(ROPE, tension=1.0, ends=(ends, ends)).family(["tension"])
    return family.modes(TENSION[:, None], 5).frequency


CLAMPED, PINNED = exact("clamped"), exact("pinned")


def errors(name, order, frequency=CLAMPED):
    """Relative errors of a formula where it says it applies, and the least xi of these."""
    found = {}
    for i, f in enumerate(frequency):
        one = {each.name: each for each in cross_checks(ROPE, f[[order - 1]], [order])}[name]
        if one.applies:
            found[XI[i]] = one.tension / TENSION[i] - 1
    return np.array(list(found.values())), min(found)


# largest errors on 400 ropes, xi from 2 to 3000, rounded up in their second digit
@pytest.mark.parametrize(
    ("name", "order", "error", "least"),
    [
        ("taut string", 1, 0.020, 210),
        ("Zui", 1, 0.027, 3),
        ("Zui", 2, 0.049, 6),
        ("Zui", 3, 0.00044, 200),
        ("Zui", 5, 0.0044, 200),
        ("Ren", 1, 0.022, 10),
        ("Mehrabi-Tabatabai", 1, 0.00033, 50),
        ("Mehrabi-Tabatabai", 3, 0.0017, 50),
        ("Mehrabi-Tabatabai", 5, 0.0026, 50),
        ("Fang-Wang", 1, 0.025, 10),
        ("Fang-Wang", 2, 0.024, 10),
        ("Fang-Wang", 5, 0.013, 10),
    ],
)
def test_a_formula_is_as_good_as_its_range_says(name, order, error, least):
    off, smallest = errors(name, order)
    assert np.abs(off).max() <= error
    assert np.abs(off).max() >= error / 1.2
    # by the tension it gives, which is off itself, as are grid steps of 1.8 %
    assert smallest == pytest.approx(least, rel=error + 0.04)


def test_a_line_through_two_modes_is_exact_of_pinned_ends():
    for i in range(0, len(XI), 40):
        line = cross_checks(ROPE, PINNED[i], range(1, 6))[1]
        assert line.applies
        # bending outweighs tension 1 + n^2 pi^2/xi^2 times
        assert line.tension == pytest.approx(
            TENSION[i], rel=1e-11 * (1 + 25 * np.pi**2 / XI[i] ** 2)
        )


def test_outside_its_range_a_formula_says_so():
    f = CLAMPED[np.searchsorted(XI, 5.0)]
    found = {one.name: one for one in cross_checks(ROPE, f, range(1, 6))}
    assert [name for name, one in found.items() if one.applies] == ["line of (f/n)^2", "Zui"]
    assert found["Ren"].range_text == "clamped ends, xi above 10; mode 1"
    assert all(one.tension is None or one.tension > 0 for one in found.values())


def test_what_a_formula_needs_is_said():
    rope = rd.Rope(2.0, 0.5)
    found = {one.name: one for one in cross_checks(rope, [25.0], [2])}
    # T = mu (2 L f/n)^2
    assert found["taut string"].tension == pytest.approx(0.5 * 50.0**2, rel=1e-14)
    assert found["taut string"].range_text == "no bending stiffness; mode 2"
    assert found["Zui"].range_text == "needs a bending stiffness"
    assert found["line of (f/n)^2"].range_text == "needs two modes"
    assert not any(one.applies for name, one in found.items() if name != "taut string")
    second = cross_checks(ROPE, [25.0, 3.0], [2, 0])
    assert [one.range_text for one in second if one.name == "Ren"] == ["needs mode 1"]
    assert all(one.source for one in found.values())


@pytest.mark.parametrize(
    ("frequency", "orders", "kind", "message"),
    [
        ([1.0, 2.0], [1], rd.SceneError, "orders must be one for each of 2 frequencies, got 1"),
        ([1.0, 2.0], [1, 1], rd.SceneError, "orders must be different ones from 1"),
        ([1.0], [0], rd.SceneError, "orders must be different ones from 1, at least one, got [0]"),
        ([0.0], [1], rd.SceneError, "frequency[0] must be a finite number > 0 [Hz]"),
        ([1.0], [1.5], TypeError, "orders[0] must be a whole number"),
        ([1.0], [-1], rd.SceneError, "orders[0] must be a whole number"),
    ],
)
def test_modes_that_are_none_are_refused(frequency, orders, kind, message):
    with pytest.raises(kind) as caught:
        cross_checks(ROPE, frequency, orders)
    assert message in str(caught.value)
    with pytest.raises(TypeError, match="rope must be a Rope"):
        cross_checks(None, [1.0], [1])
