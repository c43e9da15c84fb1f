"""Chains of uniform spans in closed form, against the general path and roots in many digits."""

import math

import exact_roots
import numpy as np
import pytest
from conftest import EPS
from exact_roots import continuum
from general_path import general_path
from uniform_chain import chain_of, random_chain, row_of

import ropedyn as rd
from ropedyn import _core

ROPE = rd.Rope(1.3, 0.2, bending_stiffness=4.0)
SOFT = rd.End(z="free", beta="free", spring={"z": 4e3, "beta": 9.0})
SCENES = {
    "masses": rd.Scene(
        ROPE,
        tension=800.0,
        parts=[rd.PointMass(0.3, 0.05, rotary_inertia=1e-5), rd.Spring(0.8, 3e3)],
    ),
    "support": rd.Scene(ROPE, tension=30.0, ends=("pinned", SOFT), parts=[rd.Support(0.6)]),
    "hinge": rd.Scene(
        ROPE,
        tension=100.0,
        ends=("clamped", "pinned"),
        parts=[rd.Hinge(0.5), rd.PointMass(0.5, 0.1)],
    ),
    "pressed": rd.Scene(
        ROPE, tension=-40.0, parts=[rd.Spring(0.4, 900.0), rd.LocalChange(0.7, 1.0, bending=8.0)]
    ),
    "string-like": rd.Scene(
        ROPE.replace(bending_stiffness=1e-5), tension=900.0, parts=[rd.PointMass(0.21, 0.02)]
    ),
    "stretches": rd.Scene(
        ROPE,
        tension=0.0,
        ends=("clamped", SOFT),
        parts=[rd.AddedMass(0.2, 0.7, linear_density=0.9), rd.LocalChange(0.7, 1.1, bending=1e-3)],
    ),
}


def solve(row, hinge, number=10, jacobian=None):
    return _core.closed_chain_modes("bent", np.atleast_2d(row), hinge, jacobian, number)


# frequencies -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.claim(
    "Ten frequencies of chains of uniform spans in closed form, with masses, springs, supports, "
    "hinges, in compression, near strings: relative error",
    reference="zeros of the determinant in 60 digits: tests/support/exact_roots.py",
    accepted=4e-14,
)
def test_closed_frequencies_are_roots_in_many_digits(name, claim):
    scene = SCENES[name]
    omega, error, _, certified = solve(*row_of(scene.compile()))
    assert certified.all()
    exact = continuum(scene)
    wrong = [
        abs(float(w / (2 * math.pi) / exact_roots.frequency(exact, w / (2 * math.pi), 1e-6) - 1))
        for w in omega[0]
    ]
    # numbers of the scene are rounded once more on their way
    assert (np.array(wrong) <= error[0] + 4 * EPS).all()
    claim(max(wrong))


@pytest.mark.parametrize("name", SCENES)
def test_closed_frequencies_are_those_of_the_general_path(name):
    model = SCENES[name].compile()
    omega, error, _, certified = solve(*row_of(model))
    with general_path():
        modes = model.modes(10)
    assert certified.all()
    apart = np.abs(omega[0] / (2 * math.pi) - modes.frequency)
    assert (apart <= (error[0] + 4 * EPS) * modes.frequency + modes.rounding_error).all()


def test_slopes_follow_the_jacobian():
    """By tension and by the place of a mass, against differences of fourth order."""
    row, hinge = row_of(SCENES["masses"].compile())
    jacobian = np.zeros((len(row), 2))
    jacobian[2:12:4, 0] = 1.0
    jacobian[[0, 4], 1] = 1.0, -1.0
    slope = solve(row, hinge, 6, jacobian)[2]
    for k, step in enumerate((0.08, 3e-5)):
        row_at = [row + jacobian[:, k] * step * j for j in (-2, -1, 1, 2)]
        far, near, right, beyond = np.log(solve(np.array(row_at), hinge, 6)[0])
        difference = (8 * (right - near) - (beyond - far)) / (12 * step)
        # rounding of 1e-15 over the step
        np.testing.assert_allclose(slope[0, :, k], difference, atol=1e-14 / step)


def test_strings_carry_masses():
    """A string with a mass in its middle: m omega^2 = 2 T k cot(kl) for what moves it."""
    row = np.array([1.0, 3, 12, 1, 3, 12, 0, np.inf, 5, 0, 0, np.inf])
    omega, _, _, certified = _core.closed_chain_modes(
        "plain", row[None], np.zeros(3, np.uint8), None, 6
    )
    assert certified.all()
    kl = omega[0] / 2
    np.testing.assert_allclose(kl[1::2], np.pi * np.arange(1, 4), rtol=16 * EPS)
    np.testing.assert_allclose(20 * kl[::2] * np.tan(kl[::2]), 24, rtol=1e-12)


def test_equal_halves_have_pairs():
    scene = rd.Scene(
        ROPE, tension=50.0, parts=[rd.Support(0.65, coordinate=c) for c in ("z", "beta")]
    )
    omega, _, _, certified = solve(*row_of(scene.compile()))
    assert certified.all()
    np.testing.assert_allclose(omega[0, ::2], omega[0, 1::2], rtol=64 * EPS)


# random chains -----------------------------------------------------------------------------------


def miscounted(seeds):
    """Seeds of chains counted wrongly, and how many counts were made and were not certain."""
    wrong, made, uncertain = [], 0, 0
    for seed in seeds:
        random = np.random.default_rng(seed)
        row, hinge, omega = random_chain(random, int(random.choice([1, 2, 3, 4, 8])))
        at = omega * 10 ** random.uniform(-1.5, 1.5)
        try:
            expected = int(_core.count(chain_of(row, hinge), np.array([at * at]))[0])
        except rd.SolveError:
            continue
        found = int(_core.closed_chain_count("bent", row[None], hinge, at)[0])
        made += 1
        uncertain += found < 0
        if found >= 0 and found != expected:
            wrong.append(seed)
    return wrong, made, uncertain


def test_random_chains_are_counted_as_by_the_general_path():
    wrong, made, uncertain = miscounted(range(1500))
    assert wrong == []
    assert made > 1400
    # 0 of 6000
    assert uncertain <= 2


@pytest.mark.slow
@pytest.mark.claim(
    "counts of 100000 random chains of uniform spans in closed form, contrasts to 1e4, springs of "
    "both signs, beyond buckling: how many are wrong",
    reference="counts of continuous spans by the general path",
    accepted=0.0,
)
def test_very_many_random_chains_are_counted_as_by_the_general_path(claim):
    wrong, made, uncertain = miscounted(range(100_000))
    claim(len(wrong))
    assert made > 95_000
    assert uncertain <= 100


def test_certified_modes_of_random_chains_have_their_index():
    """Counts by the general path step at each of them, but for what it rounds itself."""
    seen, lost = 0, 0
    for seed in range(300):
        random = np.random.default_rng(seed)
        row, hinge, scale = random_chain(random, int(random.choice([1, 2, 3, 4, 8])))
        omega, error, _, certified = solve(row, hinge, 6)
        chain = chain_of(row, hinge)
        try:
            negative = int(_core.count(chain, np.array([(1e-4 * scale) ** 2]))[0])
            if not certified[0]:
                lost += negative == 0
                continue
            off = 1e-9 + error[0]
            below = _core.count(chain, (omega[0] * (1 - off)) ** 2)
            above = _core.count(chain, (omega[0] * (1 + off)) ** 2)
        except rd.SolveError:
            continue
        index = np.arange(6)
        assert (below <= index).all(), seed
        assert (above > index).all(), seed
        seen += 1
    assert seen > 100
    assert lost <= 0.03 * seen


def test_rows_keep_their_bits_in_any_company():
    random = np.random.default_rng(5)
    rows, hinge = [], np.zeros(4, np.uint8)
    while len(rows) < 21:
        row, _, _ = random_chain(random, 3)
        rows.append(row)
    together = solve(np.array(rows), hinge, 7, np.eye(len(rows[0])))
    for k in range(0, 21, 4):
        alone = solve(rows[k], hinge, 7, np.eye(len(rows[0])))
        assert alone[3][0] == together[3][k]
        if alone[3][0]:
            for one, all_ in zip(alone[:3], together[:3]):
                np.testing.assert_array_equal(one[0], all_[k])


# refusals ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("square", np.zeros((1, 12)), np.zeros(2, np.uint8), None, 2), "kind must be"),
        (("bent", np.zeros((1, 12)), np.zeros(1, np.uint8), None, 2), "hinge must have at least 2"),
        (("bent", np.zeros((1, 11)), np.zeros(2, np.uint8), None, 2), "numbers"),
        (("bent", np.zeros((1, 12)), np.zeros(2, np.uint8), np.zeros((11, 1)), 2), "jacobian"),
        (("bent", np.zeros((1, 12)), np.zeros(2, np.uint8), None, 0), "number must be at least 1"),
        (("plain", np.zeros((1, 7)), np.ones(2, np.uint8), None, 2), "hinge must be 0"),
    ],
)
def test_what_has_no_meaning_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        _core.closed_chain_modes(*arguments)


def test_no_rows_are_an_empty_answer():
    omega, error, slope, certified = solve(np.zeros((0, 12)), np.zeros(2, np.uint8), 3, np.eye(12))
    assert omega.shape == error.shape == (0, 3)
    assert slope.shape == (0, 3, 12)
    assert certified.shape == (0,)


def test_rows_without_meaning_are_not_certified():
    rows = np.array([[1.0, 1, 1, 1, 0, 0, np.inf, 0, 0, 0, np.inf, 0]] * 4)
    rows[1, 0], rows[2, 3], rows[3, 2] = -1.0, np.nan, np.nan
    assert solve(rows, np.zeros(2, np.uint8), 2)[3].tolist() == [True, False, False, False]
    count = _core.closed_chain_count("bent", rows, np.zeros(2, np.uint8), 30.0)
    assert count.tolist() == [1, -1, -1, -1]
