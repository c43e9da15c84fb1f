"""Chains of one wave, with the closed forms of Lagrange: strings, twist, stretch, laid ropes."""

import math

import numpy as np
import pytest
from conftest import EPS, reference

import ropedyn as rd

REFERENCE = reference("lumped_chains")
A = REFERENCE["a"]
SUPPORTS = {
    # ends, elements beyond n, ends that carry half a mass more
    "held-held": (("clamped", "clamped"), 1, ()),
    "held-free, full end": (("clamped", "free"), 0, (1,)),
    "held-free, half end": (("clamped", "free"), 0, ()),
    "free-free, full ends": (("free", "free"), -1, (0, 1)),
}
CASES = [(support, n) for support in SUPPORTS for n in (1, 2, 8) if n + SUPPORTS[support][1] >= 1]


def string(support, n):
    ends, more, heavy = SUPPORTS[support]
    length = (n + more) * A
    parts = [rd.PointMass(end * length, REFERENCE["m"] / 2) for end in heavy]
    rope = rd.Rope(length, REFERENCE["m"] / A)
    scene = rd.Scene(rope, tension=REFERENCE["T"], ends=ends, parts=parts)
    return scene.compile(elements=n + more)


def shaft(support, n):
    ends, more, heavy = SUPPORTS[support]
    length = (n + more) * A
    J = REFERENCE["J"]
    parts = [rd.PointMass(end * length, 0, polar_inertia=J / 2) for end in heavy]
    rope = rd.Rope(
        length, 0.1, torsional_stiffness=REFERENCE["C"], polar_inertia=REFERENCE["J"] / A
    )
    return rd.Scene(rope, ends=ends, parts=parts).compile(elements=n + more)


CHAINS = {"string": (string, "transverse"), "torsion": (shaft, "torsional")}


def rounding(f):
    """Relative error of elastic frequencies: a few eps in K, whose norm is the highest eigenvalue,
    and a few eps of the largest 1/lambda, which is what the solver computes."""
    return 4 * EPS * ((f.max() / f) ** 2 + (f / f.min()) ** 2)


@pytest.mark.parametrize("kind", CHAINS)
@pytest.mark.parametrize(("support", "n"), CASES)
@pytest.mark.claim(
    "Frequencies of lumped strings and shafts: error / rounding of an assembled eigenproblem",
    reference="Lagrange's closed form, 60 digits: lumped_chains_closed_form.json",
    accepted=1.0,
)
def test_chain_has_the_frequencies_of_lagrange(kind, support, n, claim):
    build, family = CHAINS[kind]
    exact = np.array(REFERENCE[kind][support][str(n)])
    modes = build(support, n).modes(n)
    elastic = exact > 0
    relative = np.abs(modes.frequency[elastic] / exact[elastic] - 1)
    claim((relative / rounding(exact[elastic])).max())
    # rigid motion is 0, not a small number
    assert (modes.frequency[~elastic] == 0).all()
    assert (modes.family == family).all()


@pytest.mark.parametrize("kind", CHAINS)
@pytest.mark.parametrize("k", range(1, 9))
def test_held_chain_swings_in_sines(kind, k):
    build, _ = CHAINS[kind]
    modes = build("held-held", 8).modes(8)
    j = np.arange(10)
    sine = np.sin(j * k * math.pi / 9)
    sine[-1] = 0
    shape = modes.shape[k - 1, :, 0]
    # vectors err by eps ||K||/gap: 4/(smallest distance of eigenvalues, 0.24 here), a few times
    np.testing.assert_allclose(shape * (sine @ sine / (sine @ shape)), sine, atol=200 * EPS)
    assert np.abs(shape).max() == 1.0


@pytest.mark.parametrize("k", range(1, 9))
def test_half_mass_at_a_free_end_makes_quarter_waves(k):
    shape = string("held-free, half end", 8).modes(8).shape[k - 1, :, 0]
    sine = np.sin(np.arange(9) * (2 * k - 1) * math.pi / 16)
    np.testing.assert_allclose(shape * (sine @ sine / (sine @ shape)), sine, atol=200 * EPS)


@pytest.mark.parametrize("k", range(1, 9))
def test_modal_mass_of_a_held_string_is_the_sum_of_its_sines(k):
    # sum of sin^2 over n masses is (n + 1)/2; the largest of the sines becomes 1
    sine = np.sin(np.arange(1, 9) * k * math.pi / 9)
    expected = REFERENCE["m"] * 4.5 / np.abs(sine).max() ** 2
    modal_mass = string("held-held", 8).modes(8).modal_mass[k - 1]
    assert modal_mass == pytest.approx(expected, rel=400 * EPS)


@pytest.mark.parametrize("k", range(1, 8))
def test_stretch_obeys_the_chain_of_lagrange(k):
    n, EA, density, length = 8, 2e5, 0.1, 1.0
    modes = rd.Scene(rd.Rope(length, density, axial_stiffness=EA)).compile(elements=n).modes(7)
    a = length / n
    exact = math.sqrt(EA / density) / (math.pi * a) * math.sin(k * math.pi / (2 * n))
    top = math.sqrt(EA / density) / (math.pi * a)
    assert modes.frequency[k - 1] == pytest.approx(exact, rel=8 * EPS * (top / exact) ** 2)
    assert modes.family[k - 1] == "axial"


@pytest.mark.parametrize("coupling", [-50.0, 3.0, 60.0])
def test_laid_rope_carries_two_waves_of_stretch_and_twist(coupling):
    # [[EA, D], [D, C]] v = c^2 diag(mu, p) v: two speeds c, each a chain of Lagrange
    n, length, EA, C, mu, p = 8, 1.0, 2e5, 0.02, 0.1, 2e-9
    rope = rd.Rope(
        length,
        mu,
        axial_stiffness=EA,
        torsional_stiffness=C,
        lay_coupling=coupling,
        polar_inertia=p,
    )
    inertia = np.sqrt([mu, p])
    section = np.array([[EA, coupling], [coupling, C]]) / np.outer(inertia, inertia)
    speed = np.sqrt(np.linalg.eigvalsh(section))
    k = np.arange(1, n)
    exact = np.sort(np.outer(speed, n / (math.pi * length) * np.sin(k * math.pi / (2 * n))).ravel())
    modes = rd.Scene(rope).compile(elements=n).modes(2 * (n - 1))
    # the section flexibility is inverted and loses its condition, as do the chains
    unit = np.sqrt([EA, C])
    condition = np.linalg.cond([[1, coupling / unit.prod()], [coupling / unit.prod(), 1]])
    np.testing.assert_allclose(
        modes.frequency, exact, rtol=20 * EPS * condition * (exact[-1] / exact[0]) ** 2
    )
    # both waves share the strain energy with what the coupled section stores
    strain = sum(modes.energy[name] for name in ("stretch", "twist", "lay"))
    np.testing.assert_allclose(strain, 1, rtol=1e-14)


def test_bead_alone_swings_between_two_strings():
    # (M + mu a) u" = -2 T/a u
    tension, a, bead, density = 30.0, 0.5, 0.7, 0.2
    scene = rd.Scene(rd.Rope(2 * a, density), tension=tension, parts=[rd.PointMass(a, bead)])
    exact = math.sqrt(2 * tension / a / (bead + density * a)) / (2 * math.pi)
    assert scene.compile(elements=2).modes(1).frequency[0] == pytest.approx(exact, rel=4 * EPS)
