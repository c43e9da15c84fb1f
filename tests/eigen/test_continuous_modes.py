"""Natural frequencies of continuous spans, without mesh, against roots in many digits."""

import itertools
import math

import exact_roots
import mpmath
import numpy as np
import pytest
from conftest import BENDING, EPS, LENGTH, MASS, reference
from exact_roots import continuum
from mpmath import mpf
from spans import RELATIVE, SCENES, UNIT, is_counted, solved, worst_error

import ropedyn as rd

EXACT = "zeros of the determinant in 60 digits: tests/support/exact_roots.py"
DENSITY = MASS / LENGTH
BEAM = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)


# beams -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "case", reference("beam_spectra")["cases"], ids=lambda c: f"{c['ends']} {c['xi2']}"
)
@pytest.mark.claim(
    "f1..f20 of clamped and pinned beams of continuous spans, T L^2/B from 0 to 9e4: relative "
    "error",
    reference="stored, mpmath 90 digits: beam_tension_frequencies.json",
    accepted=5e-14,
)
def test_beam_has_its_stored_frequencies(case, claim):
    ends = (case["ends"],) * 2
    modes = solved(rd.Scene(BEAM, tension=float(case["xi2"]) * UNIT, ends=ends), 20)
    exact = np.array([float(f) for f in case["f"]])
    # d ln f by T, B, mu and twice L is 2 at most: their rounding moves f by 3 eps
    claim(np.abs(modes.frequency / exact - 1).max())
    assert (np.abs(modes.frequency - exact) <= modes.rounding_error + 3 * EPS * exact).all()


SPRUNG = rd.End(z="free", beta="free", spring={"z": 3e3, "beta": 20.0})
ENDS = {"clamped": "clamped", "pinned": "pinned", "free": "free", "sprung": SPRUNG}
PAIRS = list(itertools.combinations_with_replacement(ENDS, 2))


def rigid_motions(ends, tension):
    """How many motions of the whole cost nothing."""
    if ends == ("free", "free"):
        return 1 if tension else 2
    return int(ends == ("pinned", "free") and not tension)


@pytest.mark.parametrize("xi2", [0.0, 1.0, 1e4, 1e8])
@pytest.mark.parametrize("ends", PAIRS, ids="-".join)
@pytest.mark.claim(
    "Eigenvalues of beams of continuous spans, every pair of clamped, pinned, free, sprung ends, "
    "T L^2/B from 0 to 1e8: error / sensitivity",
    reference=EXACT,
    accepted=2e-14,
)
def test_beam_between_any_ends_has_the_frequencies_of_the_continuum(ends, xi2, claim):
    scene = rd.Scene(BEAM, tension=xi2 * UNIT, ends=tuple(ENDS[end] for end in ends))
    modes = solved(scene, 6)
    rigid = rigid_motions(ends, scene.tension)
    # no rounding makes a rigid motion vibrate
    assert (modes.frequency[:rigid] == 0).all() and (modes.eigenvalue[:rigid] == 0).all()
    assert (modes.frequency[rigid:] > 0).all()
    # the stiffest ropes cost the reference most
    if xi2 < 1e8 or ends[0] == "clamped":
        claim(worst_error(scene, modes, [rigid] if xi2 == 1e8 else [rigid, 5]))
    if xi2 == 1.0 and "free" in ends:
        assert is_counted(scene, modes)


# compression -------------------------------------------------------------------------------------


def critical_load(ends):
    """Euler's [N]."""
    return (1 if ends == "pinned" else 4) * math.pi**2 * UNIT


def pushed(ends, load, **more):
    return rd.Scene(BEAM.replace(**more), tension=-load, ends=(ends, ends))


@pytest.mark.parametrize("away", [10.0**-k for k in (2, 6, 10, 12)])
@pytest.mark.parametrize("side", [-1, 1], ids=["before", "beyond"])
@pytest.mark.parametrize("ends", ["clamped", "pinned"])
@pytest.mark.claim(
    "First eigenvalue of a continuous beam within 1e-2 to 1e-12 of its critical load, before and "
    "beyond it: error / sensitivity",
    reference=EXACT,
    accepted=1e-14,
)
def test_first_frequency_keeps_what_the_critical_load_leaves(ends, side, away, claim):
    # d ln f/d ln T = T/(2 (T + Tc)) = 1/(2 away): f has RELATIVE/away of digits left, and that is
    # what the sensitivity of the eigenvalue says: T d lambda/dT = lambda T/(T + Tc)
    scene = pushed(ends, critical_load(ends) * (1 + side * away))
    modes = solved(scene, 3)
    first = float(modes.eigenvalue[0])
    assert math.copysign(1, first) == -side
    assert modes.frequency[0] == (math.sqrt(first) / (2 * math.pi) if first > 0 else 0)
    assert modes.growth[0] == (math.sqrt(-first) if first < 0 else 0)
    exact = continuum(scene)
    with mpmath.workdps(40):
        # near the critical load the eigenvalue itself may be wrong by all its digits
        root = exact_roots.eigenvalue(exact, first, 0.5)
        error = abs(root - mpf(first))
        claim(float(error / exact_roots.sensitivity(exact, root)))
        # rate = sqrt |lambda|/2 pi
        rates = [mpmath.sqrt(abs(v)) / (2 * mpmath.pi) for v in (root, mpf(first))]
        assert abs(rates[0] - rates[1]) <= float(modes.rounding_error[0])


@pytest.mark.parametrize(("load", "rotary"), [(1.5, None), (3.7, 1e-4), (30.0, None), (30.0, 1e-4)])
@pytest.mark.parametrize("ends", ["clamped", "pinned"])
@pytest.mark.claim(
    "Eigenvalues of continuous beams at 1.5 to 30 times their critical load, growing and not: "
    "error / sensitivity",
    reference=EXACT,
    accepted=2e-14,
)
def test_growth_rates_far_beyond_the_critical_load(ends, rotary, load, claim):
    scene = pushed(ends, load * critical_load(ends), rotary_inertia=rotary)
    modes = solved(scene, 8)
    grows = modes.eigenvalue < 0
    # between pins the waves below sqrt(load) grow: lambda = q^2 (B q^2 - P)/(mu + j q^2)
    if ends == "pinned":
        assert grows.sum() == math.isqrt(int(load))
    assert grows.any()
    np.testing.assert_array_equal(modes.growth[grows], np.sqrt(-modes.eigenvalue[grows]))
    assert (modes.frequency[grows] == 0).all() and (modes.growth[~grows] == 0).all()
    claim(worst_error(scene, modes, [0, int(grows.sum()) - 1, 7]))
    if load == 30.0:
        assert is_counted(scene, modes)


# rods, strings, laid ropes -----------------------------------------------------------------------

ROD_ENDS = {("clamped", "clamped"): 1.0, ("clamped", "free"): 0.5, ("free", "free"): 0.0}
"""First half waves between these ends."""


@pytest.mark.parametrize("ends", ROD_ENDS, ids="-".join)
@pytest.mark.parametrize("kind", ["string", "twist", "axial"])
def test_strings_and_rods_have_the_frequencies_of_their_waves(kind, ends):
    # f = c/2L times k, k + 1/2 or 0: no term is a difference, so a few eps
    rope = {
        "string": rd.Rope(1.7, 0.03),
        "twist": rd.Rope(1.7, 0.03, torsional_stiffness=0.7, polar_inertia=2e-6),
        "axial": rd.Rope(1.7, 0.03, axial_stiffness=4e5),
    }[kind]
    scene = rd.Scene(rope, tension=80.0 * (kind == "string"), ends=ends)
    modes = solved(scene, 12)
    speed = {"string": 80.0 / 0.03, "twist": 0.7 / 2e-6, "axial": 4e5 / 0.03}[kind]
    exact = math.sqrt(speed) / (2 * 1.7) * (ROD_ENDS[ends] + np.arange(12))
    np.testing.assert_allclose(modes.frequency, exact, rtol=RELATIVE, atol=0)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.claim(
    "Eigenvalues of continuous ropes with lay coupling, lay slope, masses, springs, supports, "
    "hinges: error / sensitivity",
    reference=EXACT,
    accepted=1e-14,
)
def test_rope_with_what_stands_on_it_has_the_frequencies_of_the_continuum(name, claim):
    scene = SCENES[name]
    modes = solved(scene, 6)
    claim(worst_error(scene, modes, [0, 5], scene.coordinates[-1]))
    # the widest ropes cost the reference most
    if "x" not in scene.coordinates or "z" not in scene.coordinates:
        assert is_counted(scene, modes, scene.coordinates[-1])


@pytest.mark.parametrize("name", SCENES)
def test_count_is_that_of_the_modes_below(name):
    model = SCENES[name].compile()
    f = model.modes(6).frequency.tolist()
    for k, (low, high) in enumerate(itertools.pairwise(f)):
        if high > low * (1 + 1e-9):
            assert model.count(below=(low + high) / 2) == k + 1
            # a count needs one sign: it is right next to the frequency
            assert model.count(below=high * (1 - 1e-9)) == k + 1
            assert model.count(below=high * (1 + 1e-9)) >= k + 2


@pytest.mark.parametrize("supports", [0, 1, 2, 5])
def test_a_disc_on_a_shaft_without_inertia(supports):
    # two stretches in parallel, C/a + C/b; beyond the first support the shaft is still
    held = [0.3 + 0.17 * k for k in range(supports)]
    parts = [rd.Support(x, coordinate="alpha") for x in held]
    parts.append(rd.PointMass(0.1, 0.02, polar_inertia=2e-6))
    modes = rd.Scene(rd.Rope(1.2, 0.09, torsional_stiffness=0.6), parts=parts).compile().modes(1)
    a, b = 0.1, min([1.2, *held]) - 0.1
    exact = math.sqrt(0.6 * (1 / a + 1 / b) / 2e-6) / (2 * math.pi)
    np.testing.assert_allclose(modes.frequency, [exact], rtol=RELATIVE, atol=0)
    assert modes.certified


def test_modes_below_a_limit_are_the_lowest():
    model = SCENES["mass and springs"].compile()
    f = model.modes(6).frequency
    some = model.modes(below=float(f[3] + f[4]) / 2)
    np.testing.assert_allclose(some.frequency, f[:4], rtol=RELATIVE)
    assert some.certified


# clusters ----------------------------------------------------------------------------------------

HEAVY = [1e3, 1e9]
SPANS = rd.Rope(2.0, 0.1, bending_stiffness=2.5)
PINNED_APART = rd.Scene(SPANS, ends=("pinned", "pinned"), parts=[rd.Hinge(1.0), rd.Support(1.0)])
"""Each span is pinned: the eigenvalues of one, twice."""


@pytest.mark.parametrize("heavy", HEAVY)
@pytest.mark.claim(
    "Pairs of eigenvalues of two equal continuous spans about a mass of 1e3 and 1e9 kg: relative "
    "error",
    reference="both zeros within a circle, in 60 digits: tests/support/exact_roots.py",
    accepted=RELATIVE,
)
def test_two_spans_about_a_heavy_mass_have_pairs_of_frequencies(heavy, claim):
    body = rd.PointMass(1.0, heavy, rotary_inertia=heavy)
    scene = rd.Scene(SPANS, tension=30.0, parts=[body])
    modes = solved(scene, 8)
    # two slow motions of the body, then pairs
    exact, worst = continuum(scene), 0.0
    for k in (2, 4, 6):
        pair = modes.eigenvalue[k : k + 2]
        roots = exact_roots.cluster(exact, float(pair.mean()))
        worst = max(worst, *(abs(float(v / mpf(p)) - 1) for v, p in zip(roots, pair.tolist())))
        # a pair has exactly two
        assert len(roots) == 2
    claim(worst)


@pytest.mark.claim(
    "Double eigenvalue of a clamped continuous beam, T = -10 pi^2 B/L^2: error / sensitivity",
    reference="both zeros within a circle, in 60 digits: tests/support/exact_roots.py",
    accepted=1e-14,
)
def test_double_growth_rate_of_a_compressed_beam(claim):
    # an even and an odd shape: the rounding of T parts them by 1e-16, each is well conditioned
    scene = rd.Scene(BEAM, tension=-10 * math.pi**2 * UNIT)
    modes = solved(scene, 3)
    exact = continuum(scene)
    roots = exact_roots.cluster(exact, float(modes.eigenvalue[0]))
    assert len(roots) == 2
    for root, value in zip(roots, modes.eigenvalue.tolist()):
        claim(float(abs(root - mpf(value)) / exact_roots.sensitivity(exact, root)))


def test_repeated_frequencies_come_as_often_as_they_are():
    modes = solved(PINNED_APART, 6)
    waves = np.repeat(np.arange(1, 4), 2)
    # f = k^2 pi/2 sqrt(B/mu)/l^2: eps for each factor
    exact = waves**2 * math.pi / 2 * math.sqrt(2.5 / 0.1)
    np.testing.assert_allclose(modes.frequency, exact, rtol=RELATIVE)
    assert [PINNED_APART.compile().count(below=float(f)) for f in exact[::2] * 1.001] == [2, 4, 6]


def test_model_without_mesh_has_its_stations_only():
    model = SCENES["supports"].compile()
    np.testing.assert_array_equal(model.x, [0.0, 0.5, 0.8, 1.2])
    assert model.coordinates == ("z", "beta")
