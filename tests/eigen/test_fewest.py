"""Components that have none of the lowest modes are counted, and the modes are the same."""

import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.chain.compiled import least_of
from ropedyn.eigen import fewest
from ropedyn.eigen.fewest import solve_components
from ropedyn.eigen.spectrum import SOLVERS, merged, spectrum

ENDS = ("clamped", "pinned", rd.End(x="free", alpha="free", spring={"x": 4e4, "alpha": 3.0}))


def drawn(seed):
    """A rope whose twist or stretch may have none of its lowest modes, some or all."""
    random = np.random.default_rng(seed)
    rope = rd.Rope(
        random.uniform(1, 20),
        0.1,
        bending_stiffness=random.choice([None, 0.5]),
        torsional_stiffness=10 ** random.uniform(-3, 2),
        polar_inertia=1e-6,
        axial_stiffness=10 ** random.uniform(1, 6),
    )
    masses = [
        rd.PointMass(x, 0.05, polar_inertia=1e-6)
        for x in np.sort(random.uniform(0.1, 0.9, int(random.integers(0, 6)))) * rope.length
    ]
    ends = [ENDS[k] for k in random.integers(0, 3, 2)]
    if rope.bending_stiffness is None:
        ends = ["pinned" if isinstance(end, str) else end for end in ends]
    return rd.Scene(rope, tension=random.uniform(10, 500), ends=ends, parts=masses)


@pytest.mark.parametrize("elements", [None, 12])
@pytest.mark.parametrize("seed", range(10))
def test_the_lowest_modes_are_those_of_all_components_solved(seed, elements):
    model, number = drawn(seed).compile(elements=elements), 5
    every = [SOLVERS["sweep"](model, c, number, math.inf, shaped=False) for c in model.components]
    eigenvalue, error, _ = merged(every, number)
    modes = model.modes(number)
    # in closed form to the bit; chains refine from other brackets
    bars = 0.0 if elements is None else 4 * error
    assert (np.abs(modes.eigenvalue - eigenvalue) <= bars).all()
    assert modes.certified
    assert modes.shape.shape == (number, len(modes.x), len(model.coordinates))
    assert len(modes.family) == number


def test_some_of_the_drawn_ropes_count_and_some_solve():
    solved = [
        [len(part.eigenvalue) for part in solve_components(m, "sweep", 5, math.inf, shaped=False)]
        for m in (drawn(seed).compile() for seed in range(10))
    ]
    other = [n for counts in solved for n in (counts[0], counts[-1])]
    assert other.count(0) > 3
    assert sum(0 < n < 5 for n in other) > 3


@pytest.mark.parametrize("number", range(1, 7))
def test_modes_that_coincide_in_two_components_are_both_there(number):
    # a string whose stretch has the speed of its tension
    rope = rd.Rope(1.0, 0.1, axial_stiffness=100.0)
    frequency = rd.Scene(rope, tension=100.0).compile().modes(number).frequency
    right = math.sqrt(1000.0) / 2 * (1 + np.arange(number) // 2)
    np.testing.assert_allclose(frequency, right, rtol=8 * np.finfo(float).eps)


@pytest.mark.parametrize("seed", range(10))
def test_no_mode_of_a_rod_is_below_its_bound(seed):
    model = drawn(seed).compile()
    for component in (("x",), ("alpha",)):
        bound = least_of(model, component)
        assert 0 < bound < spectrum(model, component, 1)[0][0]


def test_a_rod_that_nothing_holds_has_no_bound():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, axial_stiffness=100.0)
    model = rd.Scene(rope, ends=("free", "free")).compile()
    assert least_of(model, ("x",)) == 0.0
    assert model.modes(3).frequency.tolist() == [0.0, 0.0, 0.0]


def test_a_component_that_cannot_be_counted_is_solved(monkeypatch):
    def refused(*_):
        raise rd.SolveError("too short waves")

    model = drawn(0).compile()
    right = model.modes(5).eigenvalue
    monkeypatch.setattr(fewest, "count_component", refused)
    np.testing.assert_array_equal(model.modes(5).eigenvalue, right)


def test_damped_modes_are_those_of_all_components():
    scene = drawn(3).replace(damping=rd.ViscousDamping(0.2))
    model = scene.compile()
    found = model.modes(6, damped=True)
    alone = [
        scene.without(*others).compile().modes(6, damped=True).eigenvalue
        for others in (("twist", "stretch"),)
    ]
    own = found.eigenvalue[found.family == "transverse"]
    np.testing.assert_allclose(own, alone[0][: len(own)], rtol=1e-12)
