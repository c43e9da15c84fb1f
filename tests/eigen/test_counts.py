"""Counts of eigenvalues against counts in many digits and against closed forms."""

import math

import mpmath
import numpy as np
import pytest
from conftest import BENDING, LENGTH, MASS, beam
from exact_counts import ExactChain
from exact_scene import places
from exact_waves import pinned_tensed_chain
from mpmath import mpf
from random_scene import log_uniform, random_scene

import ropedyn as rd
from ropedyn import _core

FEW, MANY = 150, 10_000
ELEMENTS = (1, 2, 3, 4, 5, 8, 12, 20, 33)
EULER = (math.pi / LENGTH) ** 2 * BENDING
"""Critical load of the pinned beam [N]."""


def counts(model, eigenvalues):
    """Return ours and the exact ones, over all components, shape (2, eigenvalues)."""
    both = np.zeros((2, len(eigenvalues)), dtype=int)
    for coordinates in model.components:
        chain = model.chain.only(coordinates)
        exact = ExactChain(chain)
        both[0] += _core.count(chain, np.asarray(eigenvalues, dtype=float)).astype(int)
        both[1] += [exact.count(x) for x in np.asarray(eigenvalues).tolist()]
    return both


# random scenes ----------------------------------------------------------------------------------


def random_model(seed):
    """Any ends, masses to 1e6, springs of both signs, supports, compression; few elements."""
    random = np.random.default_rng(seed)
    scene = random_scene(random, int(random.choice([1, 2, 3, 4], p=[0.2, 0.5, 0.2, 0.1])))
    stations = len(set(places(scene))) + 1
    return random, scene.compile(
        elements=max(int(random.choice(ELEMENTS)), stations),
        element=str(random.choice(["rigid", "tensed"])),
    )


def miscounted(seeds):
    """Return the seeds of scenes that are counted wrongly somewhere."""
    wrong = []
    for seed in seeds:
        random, model = random_model(seed)
        frequency = [log_uniform(random, 1e-2, 1e6) for _ in range(4)]
        eigenvalues = [(2 * math.pi * f) ** 2 for f in frequency]
        eigenvalues += [-log_uniform(random, 1e-6, 1e8) for _ in range(2)]
        ours, exact = counts(model, eigenvalues)
        public = [model.count(below=f) for f in frequency]
        if (ours != exact).any() or public != exact[:4].tolist():
            wrong.append(seed)
    return wrong


def test_random_scenes_are_counted_exactly():
    assert miscounted(range(FEW)) == []


@pytest.mark.slow
@pytest.mark.claim(
    f"counts of modes below a limit: {MANY} random scenes, how many are wrong",
    reference="counts in many digits: tests/support/exact_counts.py",
    accepted=0.0,
)
def test_very_many_random_scenes_are_counted_exactly(claim):
    claim(len(miscounted(range(MANY))))


@pytest.mark.parametrize("stiffness", [0.0, 1e-3, 1.0, 1e3])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("tension", [-2.5 * EULER, 0.0, 300.0])
def test_hinged_chains_are_counted_exactly(tension, element, stiffness):
    hinges = [rd.Hinge(LENGTH / 4, stiffness=stiffness), rd.Hinge(LENGTH / 2)]
    scene = beam(8, tension=tension, ends=("pinned", "free"), rotary=False, parts=hinges)
    eigenvalues = [-1e7, -1e3, -1e-3, 1e-3, 1e2, 1e4, 1e6, 1e8]
    ours, exact = counts(scene.compile(elements=8, element=element), eigenvalues)
    assert ours.tolist() == exact.tolist()


# compression ------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("ends", ["clamped", "pinned", "free"])
@pytest.mark.parametrize("rotary", [False, True])
@pytest.mark.parametrize("n", [2, 3, 4])
def test_short_compressed_chains_are_counted_exactly(n, rotary, ends, element):
    # from a tenth of the pinned beam's critical load to where single elements have buckled; none is
    # an element's own, where a massless rotation has no stiffness and any count is of rounding
    eigenvalues = [-1e7, -1e4, -1.0, -1e-3, 1e-3, 1.0, 1e3, 1e5, 1e7, 1e9]
    wrong = []
    for load in (0.1, 0.9, 1.1, 3.9, 4.1, 7.0, 20.0, 45.0, 90.0):
        scene = beam(n, tension=-load * EULER, ends=(ends, ends), rotary=rotary)
        ours, exact = counts(scene.compile(elements=n, element=element), eigenvalues)
        if (ours != exact).any():
            wrong.append((load, ours.tolist(), exact.tolist()))
    assert wrong == []


@pytest.mark.parametrize("n", [2, 3, 4, 8])
@pytest.mark.parametrize("away", [1e-3, 1e-6, 1e-9, 1e-12])
def test_one_half_wave_of_a_rigid_chain_grows_just_beyond_its_critical_load(n, away):
    # pinned, one half wave: 24 (1 - c)(1 + tau/12) (8 + 4 c) = 144 (1 - c^2) with c = cos(pi/n)
    # gives tau = -6 (1 - c)/(2 + c)
    c = math.cos(math.pi / n)
    load = 6 * (1 - c) / (2 + c) * BENDING / (LENGTH / n) ** 2
    before, beyond = (
        beam(n, tension=-load * (1 + side * away), ends=("pinned", "pinned")).compile(
            elements=n, element="rigid"
        )
        for side in (-1, 1)
    )
    # eigenvalue -away (20 Hz 2 pi)^2 and more at n = 2; the limits are nearer to zero than that
    near = 1e3 * away
    for model, growing in ((before, 0), (beyond, 1)):
        chain = model.chain
        assert _core.count(chain, np.array([-near, near])).tolist() == [growing, growing]


# closed forms -----------------------------------------------------------------------------------


def string_eigenvalue(n, k, tension, density, length):
    """4 T/(mu a^2) sin^2(k pi/2n), in mpmath."""
    a = mpf(length) / n
    return 4 * mpf(tension) / (mpf(density) * a**2) * mpmath.sin(k * mpmath.pi / (2 * n)) ** 2


@pytest.mark.parametrize(
    "waves",
    [range(1, 51), range(49_975, 50_025), range(99_900, 99_950), range(99_950, 100_000)],
    ids=["lowest", "middle", "near the band top", "at the band top"],
)
def test_long_string_is_counted_between_any_two_of_its_frequencies(waves):
    n, tension, density, length = 100_000, 300.0, 0.1, 1.0
    chain = rd.Scene(rd.Rope(length, density), tension=tension).compile(elements=n).chain
    with mpmath.workdps(30):
        exact = [string_eigenvalue(n, k, tension, density, length) for k in waves]
        # the band ends at k = n; gaps near it are 5e-10 of the eigenvalue
        upper = [*exact[1:], string_eigenvalue(n, waves[-1] + 1, tension, density, length)]
        middle = [float((low + high) / 2) for low, high in zip(exact, upper)]
    assert _core.count(chain, np.array(middle)).tolist() == list(waves)


@pytest.mark.parametrize("away", [-1e-11, 1e-11])
def test_long_string_is_counted_next_to_its_frequencies(away):
    # nodes stand at multiples of a = L/n: the string is uniform to eps, its frequencies to n eps
    # at most, 2e-11
    n, tension, density, length = 100_000, 300.0, 0.1, 1.0
    chain = rd.Scene(rd.Rope(length, density), tension=tension).compile(elements=n).chain
    waves = [1, 2, 3, 10, 100, 1000, 10_000]
    exact = [float(string_eigenvalue(n, k, tension, density, length)) for k in waves]
    below = _core.count(chain, np.array(exact) * (1 + away)).tolist()
    assert below == [k - (away < 0) for k in waves]


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_no_frequency_is_above_the_band_of_the_string(element):
    n = 1000
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=300.0).compile(elements=n, element=element)
    top = float(string_eigenvalue(n, n, 300.0, 0.1, 1.0))
    above = top * np.array([1 + 1e-12, 1 + 1e-6, 1.5, 1e3, 1e30])
    assert _core.count(model.chain, above).tolist() == [n - 1] * 5


@pytest.mark.parametrize("n", [4, 64, 1000, 1_000_000])
@pytest.mark.parametrize("tension", [0.0, 2830.0])
def test_pinned_tensed_chain_is_counted_next_to_its_frequencies(n, tension):
    rope = rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING)
    scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"))
    chain = scene.compile(elements=n, element="tensed").chain
    waves = range(1, min(n, 12))
    exact = np.array([float(pinned_tensed_chain(rope, tension, n, k)) for k in waves])
    assert _core.count(chain, exact * (1 - 1e-11)).tolist() == [k - 1 for k in waves]
    assert _core.count(chain, exact * (1 + 1e-11)).tolist() == list(waves)


def test_count_below_counts_motion_that_grows():
    model = beam(8, tension=-12 * EULER, ends=("pinned", "pinned")).compile(
        elements=8, element="rigid"
    )
    # three half waves of the chain have buckled (j = 1, 2, 3)
    assert model.count(below=1e-6) == 3


@pytest.mark.parametrize("below", [0.0, -1.0, math.inf, math.nan])
def test_count_below_refuses_what_is_no_frequency(below):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0).compile(elements=4)
    with pytest.raises(rd.SceneError, match="below"):
        model.count(below=below)


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_no_more_modes_are_counted_than_exist(element):
    # far above the spectrum node terms leave no digit of the elements
    model = beam(9, tension=300.0, rotary=False).compile(elements=9, element=element)
    assert {model.count(below=10.0**k) for k in (9, 12, 13, 14, 20, 60, 100, 300)} == {8}


@pytest.mark.parametrize("below", [1e60, 1e149, 1e300])
def test_more_half_waves_than_can_be_walked_are_refused_at_once(below):
    """As many pieces as no whole number of the machine counts; the limit goes as their square."""
    model = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=2.0), tension=10.0).compile()
    with pytest.raises(rd.SolveError, match="below is too high"):
        model.count(below=below)


@pytest.mark.parametrize("coupling", [90.0, 99.0, 101.0])
@pytest.mark.parametrize("tension", [3e5, 1e6])
def test_laid_rope_under_tension_is_counted_between_its_modes(tension, coupling):
    """Stretch and twist are nearly one motion, which turns far within a piece."""
    rope = rd.Rope(
        1.0,
        0.1,
        bending_stiffness=60.0,
        torsional_stiffness=7e-3,
        axial_stiffness=1.5e6,
        lay_coupling=coupling,
        lay_slope=0.0155,
        polar_inertia=1e-8,
    )
    model = rd.Scene(rope, tension=tension).compile()
    found = model.modes(9)
    assert found.certified
    # where counts were two off for a few per cent of the frequencies
    for f in np.linspace(100.0, found.frequency[7] + 1.0, 200).tolist():
        if np.abs(found.frequency - f).min() > 1e-3:
            assert model.count(below=f) == (found.frequency < f).sum()
