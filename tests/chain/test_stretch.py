"""Ropes that change over stretches: added mass and local factors, against exact references."""

import math
import re

import exact_roots
import mpmath
import numpy as np
import pytest
from conftest import EPS, LAID
from exact_chain import DIGITS, error_over_condition
from exact_roots import continuum
from exact_shapes import Mode
from mpmath import mpf
from random_scene import stretched_scene
from spans import BOUND, RELATIVE, errors, is_counted, solved, worst_error

import ropedyn as rd

L, MU, T, B = 1.2, 0.09, 60.0, 2.0
STRING = rd.Rope(L, MU)
BEAM = rd.Rope(L, MU, bending_stiffness=B)
EVERY = {"bending": 0.4, "torsion": 0.6, "density": 1.7}
ALONG = {"axial": 0.8, "lay": 0.5}
OVERLAPPING = (
    rd.LocalChange(0.2, 0.6, bending=0.3, density=0.8),
    rd.AddedMass(0.5, 0.9, 0.05),
    rd.LocalChange(0.5, 0.7, bending=2.5, density=1.5),
)
KINDS = ("rigid", "tensed", "continuous")


def model_of(scene, element):
    return scene.compile(elements=24, element=element)


# strings and shafts: closed forms ----------------------------------------------------------------


def two_part_root(near, parts, a, b):
    """Frequency [Hz] next to a good one of a string or shaft of two parts, held at both ends.

    Z1 cot(k1 a) + Z2 cot(k2 b) = 0, cleared of poles; `parts` are pairs of k/omega and Z, the
    impedance to a common factor.
    """
    (k1, z1), (k2, z2) = parts

    def equation(f):
        w = 2 * mpmath.pi * f
        left, right = w * k1 * a, w * k2 * b
        return z1 * mpmath.cos(left) * mpmath.sin(right) + z2 * mpmath.cos(right) * mpmath.sin(left)

    with mpmath.workdps(DIGITS):
        root = mpmath.findroot(equation, (mpf(near), mpf(near) * (1 + mpf(10) ** -9)))
        assert abs(root / near - 1) < 1e-6
        # a change of sign is there, not a touch
        assert equation(root * (1 - mpf(10) ** -30)) * equation(root * (1 + mpf(10) ** -30)) < 0
        return root


@pytest.mark.parametrize("density", [1e-4, 0.25, 3.0, 1e4])
@pytest.mark.parametrize("start", [0.3, 0.9])
@pytest.mark.claim(
    "f1..f12 of a string of two parts, densities 1:1e-4 to 1:1e4, continuous spans: relative error",
    reference="closed form k1 cot(k1 a) + k2 cot(k2 b) = 0, mpmath",
    accepted=4e-14,
)
def test_string_of_two_parts_has_the_frequencies_of_its_equation(density, start, claim):
    scene = rd.Scene(STRING, tension=T, parts=[rd.LocalChange(start, L, density=density)])
    modes = solved(scene, 12)
    with mpmath.workdps(DIGITS):
        # k over omega, which is also the impedance over T
        k1 = mpmath.sqrt(mpf(MU) / mpf(T))
        k2 = k1 * mpmath.sqrt(mpf(density))
        a, b = mpf(start), mpf(L) - mpf(start)
    for f, bound in zip(modes.frequency.tolist(), modes.rounding_error.tolist()):
        root = two_part_root(f, ((k1, k1), (k2, k2)), a, b)
        claim(float(abs(f / root - 1)))
        # mu, T, density are rounded in their products: half an eps each
        assert abs(f - root) <= bound + 2 * EPS * f
    # sines between nodes: so many half waves that none is missing
    assert modes.certified


def test_string_of_two_parts_of_one_travel_time_has_equal_steps():
    """Four times the density over a third: k1 a = k2 b = phi, (k1 + k2) sin(2 phi) = 0."""
    parts = [rd.LocalChange(0.8, L, density=4.0)]
    modes = rd.Scene(STRING, tension=T, parts=parts).compile().modes(8)
    step = math.sqrt(T / MU) / (4 * 0.8)
    np.testing.assert_allclose(modes.frequency, step * np.arange(1, 9), rtol=RELATIVE)


@pytest.mark.parametrize("axial", [0.01, 0.5, 30.0])
def test_rod_of_two_stiffnesses_has_the_frequencies_of_its_equation(axial):
    rod = rd.Rope(L, MU, axial_stiffness=3e5)
    modes = solved(rd.Scene(rod, parts=[rd.LocalChange(0.0, 0.5, axial=axial)]), 6)
    with mpmath.workdps(DIGITS):
        mu, EA = mpf(MU), mpf(3e5)
        # impedance EA k/omega = sqrt(EA mu)
        parts = [(mpmath.sqrt(mu / c), mpmath.sqrt(mu * c)) for c in (mpf(axial) * EA, EA)]
        a, b = mpf(0.5), mpf(L) - mpf(0.5)
    for f in modes.frequency.tolist():
        assert abs(f / two_part_root(f, parts, a, b) - 1) < RELATIVE


def test_a_laid_rope_of_two_parts_turns_by_the_flexibility_of_each():
    # a force at the end that is free: twist -D F/(EA C - D^2) per length, of each part
    rope = rd.Rope(2.0, 0.5, axial_stiffness=1e6, torsional_stiffness=20.0, lay_coupling=2000.0)
    part = rd.LocalChange(0.5, 1.25, axial=0.9, lay=0.7, torsion=0.8)
    free = rd.End(x="free", alpha="free", z="free", beta="free")
    static = rd.Scene(rope, ends=("clamped", free), parts=[part]).compile()
    found = static.static({("x", 2.0): 1000.0}).displacement[-1]
    expected = np.zeros(2)
    for length, EA, C, D in (1.25, 1e6, 20.0, 2e3), (0.75, 0.9e6, 16.0, 1.4e3):
        expected += length * np.linalg.solve([[EA, D], [D, C]], [1000.0, 0.0])
    assert np.abs(found / expected - 1).max() < 32 * EPS


@pytest.mark.claim(
    "f1..f6 of a shaft of two torsional stiffnesses, continuous spans: relative error",
    reference="closed form Z1 cot(k1 a) + Z2 cot(k2 b) = 0, mpmath",
    accepted=1e-14,
)
@pytest.mark.parametrize("torsion", [0.01, 0.5, 30.0])
def test_shaft_of_two_stiffnesses_has_the_frequencies_of_its_equation(torsion, claim):
    shaft = rd.Rope(L, MU, torsional_stiffness=3.0, polar_inertia=2e-5)
    modes = solved(rd.Scene(shaft, parts=[rd.LocalChange(0.0, 0.5, torsion=torsion)]), 6)
    with mpmath.workdps(DIGITS):
        p, C = mpf(2e-5), mpf(3.0)
        soft = mpf(torsion) * C
        # impedance C k/omega = sqrt(C p)
        parts = [(mpmath.sqrt(p / c), mpmath.sqrt(p * c)) for c in (soft, C)]
        a, b = mpf(0.5), mpf(L) - mpf(0.5)
    for f in modes.frequency.tolist():
        claim(float(abs(f / two_part_root(f, parts, a, b) - 1)))


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_strings_of_two_parts_converge_quadratically(element):
    scene = rd.Scene(STRING, tension=T, parts=[rd.LocalChange(0.45, L, density=5.0)])
    exact = scene.compile().modes(3).frequency
    error = [
        scene.compile(elements=n, element=element).modes(3).frequency / exact - 1 for n in (40, 80)
    ]
    # 0.45 : 1.2 is 15 : 40 elements; the next term is (k h)^2/10 = 0.02 of the first at 40
    np.testing.assert_allclose(np.log2(error[0] / error[1]), 2, atol=0.03)


# stepped beams -----------------------------------------------------------------------------------


STEPPED = {
    "thin tip": (("clamped", "free"), [rd.LocalChange(0.7, L, bending=0.05, density=0.3)]),
    "damaged": (("clamped", "clamped"), [rd.LocalChange(0.4, 0.5, bending=1e-3)]),
    "iced": (("pinned", "clamped"), [rd.AddedMass(0.3, 0.8, 0.4)]),
    "overlapping": (("clamped", "clamped"), OVERLAPPING),
}


def stepped(name, tension):
    ends, parts = STEPPED[name]
    return rd.Scene(BEAM, tension=tension, ends=ends, parts=parts)


@pytest.mark.parametrize(("name", "tension"), [("damaged", T), ("overlapping", -3.0)])
@pytest.mark.claim(
    "Eigenvalues of stepped beams, pulled and pushed, continuous spans: error / sensitivity",
    reference="zeros of the determinant in 60 digits: tests/support/exact_roots.py",
    accepted=9e-15,
)
def test_stepped_beams_have_the_frequencies_of_the_continuum(name, tension, claim):
    scene = stepped(name, tension)
    claim(worst_error(scene, solved(scene, 4), [3]))


@pytest.mark.slow
@pytest.mark.parametrize("tension", [0.0, T, 1e6 * B / L**2])
@pytest.mark.parametrize("name", STEPPED)
@pytest.mark.claim(
    "First five eigenvalues of stepped beams, T L^2/B from 0 to 1e6, continuous spans: error / "
    "sensitivity",
    reference="zeros of the determinant in 60 digits, counted: tests/support/exact_roots.py",
    accepted=RELATIVE,
)
def test_stepped_beams_have_all_frequencies_of_the_continuum(name, tension, claim):
    scene = stepped(name, tension)
    modes = solved(scene, 5)
    claim(worst_error(scene, modes, range(5)))
    assert is_counted(scene, modes)


def test_reference_of_stepped_beams_is_a_product_of_exponentials():
    """det of the moments and forces left of a free end over clamped motions, span by span."""
    scene = stepped("thin tip", 0.0)
    near = float(scene.compile().modes(2).eigenvalue[1])

    def clamped_free(square):
        whole = mpmath.eye(4)
        for bending, density, a, b in ((1, 1, 0, 0.7), (0.05, 0.3, 0.7, L)):
            E = mpmath.zeros(4)
            # z' = beta, beta' = M/B, M' = -F, F' = -lambda mu z
            E[0, 1] = 1
            E[1, 3] = 1 / (mpf(bending) * mpf(B))
            E[2, 0] = -square * mpf(density) * mpf(MU)
            E[3, 2] = -1
            whole = mpmath.expm(E * (mpf(b) - mpf(a))) * whole
        return mpmath.det(whole[2:4, 2:4])

    with mpmath.workdps(DIGITS):
        root = mpmath.findroot(clamped_free, (mpf(near), mpf(near) * (1 + mpf(10) ** -9)))
        assert abs(exact_roots.eigenvalue(continuum(scene), near) / root - 1) < 1e-30


@pytest.mark.parametrize(
    ("element", "rotary", "order"),
    [("rigid", None, 2), ("tensed", None, 4), ("tensed", 1e-3, 2)],
)
def test_stepped_tensed_beams_converge_with_their_order(element, rotary, order):
    rope = BEAM.replace(rotary_inertia=rotary)
    scene = rd.Scene(rope, tension=T, parts=OVERLAPPING)
    exact = scene.compile().modes(3).frequency
    # spans are whole numbers of elements: the chains are halves of each other
    error = [
        scene.compile(elements=n, element=element).modes(3).frequency / exact - 1 for n in (60, 120)
    ]
    # k h is 0.16 at f3 of the coarse chain in its softest stretch; the next term is (k h)^2 of the
    # first times a number of 10 at most
    np.testing.assert_allclose(np.log2(error[0] / error[1]), order, atol=0.25)


@pytest.mark.parametrize(
    "name", ["damaged", *(pytest.param(n, marks=pytest.mark.slow) for n in ("iced", "overlapping"))]
)
def test_shapes_and_energies_of_stepped_beams_are_those_of_the_continuum(name):
    scene = stepped(name, T)
    modes = scene.compile().modes(2, points=8)
    exact = continuum(scene)
    mode = Mode(exact, exact_roots.eigenvalue(exact, float(modes.eigenvalue[1])))
    sign = np.sign((modes.shape[1] * mode.shape(8)).sum())
    difference = np.abs(sign * modes.shape[1] - mode.shape(8)).max(axis=0)
    # a mode mixes with the next by RELATIVE lambda/gap, a gap of some per cent
    assert (difference <= 1e-11 * np.abs(modes.shape[1]).max(axis=0)).all()
    np.testing.assert_allclose(modes.modal_mass[1], mode.modal_mass(8), rtol=4e-11)
    fractions = mode.energy()
    for name_of, value in modes.energy.items():
        assert abs(value[1] - fractions[name_of]) <= 4e-11


# responses ---------------------------------------------------------------------------------------


LAID_PARTS = (rd.LocalChange(0.1, 0.55, **EVERY), rd.AddedMass(0.3, 0.8, 0.2, polar_inertia=2e-6))


@pytest.mark.claim(
    "FRF and internal forces of a laid rope that changes over stretches, continuous spans: error / "
    "condition",
    reference="mpmath, 60 digits: tests/support/exact_span.py",
    accepted=5e-14,
)
def test_laid_rope_with_stretches_responds_as_the_continuum(claim):
    damping = rd.RayleighDamping(2.0, 1e-5)
    scene = rd.Scene(LAID, tension=50.0, parts=LAID_PARTS, damping=damping)
    responses = [("z", 0.4), ("alpha", 0.9), ("M_beta", 0.1), ("x", 0.55), ("F_z", 0.0)]
    claim(max(errors(scene, 31.0, ("z", 0.4), responses)))


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.claim(
    "FRF of chains of a laid rope that changes over stretches: error / condition",
    reference="mpmath, 60 digits: tests/support/exact_chain.py",
    # the bound of uniform chains: tests/response/test_sweep_frf.py
    accepted=1e-14,
)
def test_chain_with_stretches_responds_as_the_exact_discrete_one(element, claim):
    scene = rd.Scene(LAID, tension=50.0, parts=LAID_PARTS)
    model = scene.compile(elements=6, element=element)
    claim(error_over_condition(model, 31.0, ("z", 2), ("alpha", 4))[0])


@pytest.mark.parametrize("element", KINDS)
def test_static_deflection_of_a_stepped_cantilever_is_the_integral_of_its_flexibility(element):
    """z(L) = integral of (L - s)^2/B ds under a unit force at the tip."""
    parts = [rd.LocalChange(0.2, 0.6, bending=0.3), rd.LocalChange(0.5, 0.9, bending=0.5)]
    scene = rd.Scene(BEAM, ends=("clamped", "free"), parts=parts)
    steps = [(0.0, 0.2, 1.0), (0.2, 0.5, 0.3), (0.5, 0.6, 0.15), (0.6, 0.9, 0.5), (0.9, L, 1.0)]
    exact = sum(((L - a) ** 3 - (L - b) ** 3) / (3 * B * c) for a, b, c in steps)
    static = scene.compile(elements=12, element=element).static({("z", L): 1.0})
    # sums of rounded numbers of one sign, node by node
    bound = EPS * (50 + len(static.x))
    assert static.displacement[-1, 0] == pytest.approx(exact, rel=bound)
    np.testing.assert_allclose(static.force[0], [-1.0, -L], rtol=bound)


def test_solvers_agree_on_a_rope_that_changes():
    scene = rd.Scene(LAID, tension=50.0, parts=LAID_PARTS, damping=rd.StiffnessDamping(1e-5))
    model = model_of(scene, "rigid")
    frequency, drive = [5.0, 40.0], ("z", 0.55)
    value = [
        model.frf(frequency, drive=drive, response=("alpha", 0.8), solver=s).value
        for s in ("sweep", "band", "lapack")
    ]
    # away from resonances: the mixed form loses n eps times tens, the assembled one n^4 eps
    np.testing.assert_allclose(value[1], value[0], rtol=1e-12)
    np.testing.assert_allclose(value[2], value[0], rtol=1e-9)
    modes = [model.modes(6, solver=s).frequency for s in ("sweep", "lapack")]
    np.testing.assert_allclose(modes[1], modes[0], rtol=1e-9)


def test_dense_modes_are_as_good_whichever_end_is_soft():
    """The shift of the dense solver is of the order of an eigenvalue of the whole rope."""
    bound = []
    for start in (0.0, L - 0.05):
        parts = [rd.LocalChange(start, start + 0.05, bending=1e-4)]
        scene = rd.Scene(BEAM, ends=("free", "free"), parts=parts)
        model = scene.compile(elements=24, element="rigid")
        sweep, lapack = (model.modes(6, solver=s) for s in ("sweep", "lapack"))
        bound.append(lapack.rounding_bound[2:])
        difference = np.abs(sweep.frequency - lapack.frequency)
        assert (difference <= sweep.rounding_bound + lapack.rounding_bound).all()
    # the same matrix from the other end, summed in another order; one stretch alone tells an
    # order that is wrong by 1e4, and loses two digits
    np.testing.assert_allclose(bound[0], bound[1], rtol=0.5)


# what is the same --------------------------------------------------------------------------------


def same(one, other):
    """Whether two scenes have the same numbers everywhere, bit for bit."""
    for element in KINDS:
        pair = [model_of(scene, element) for scene in (one, other)]
        modes = [model.modes(5) for model in pair]
        np.testing.assert_array_equal(*(m.frequency for m in modes))
        np.testing.assert_array_equal(*(m.shape for m in modes))
        point = (one.coordinates[-1], 0.5)
        frf = [model.frf([0.0, 20.0, 300.0], drive=point) for model in pair]
        np.testing.assert_array_equal(*(f.value for f in frf))
        np.testing.assert_array_equal(*(m.static({point: 1.0}).displacement for m in pair))


CHANGED = LAID.replace(
    linear_density=LAID.linear_density * 1.7,
    bending_stiffness=LAID.bending_stiffness * 0.4,
    torsional_stiffness=LAID.torsional_stiffness * 0.6,
    axial_stiffness=LAID.axial_stiffness * 0.8,
    lay_coupling=LAID.lay_coupling * 0.5,
    rotary_inertia=LAID.rotary_inertia * 1.7,
    polar_inertia=LAID.polar_inertia * 1.7,
)


def test_a_change_of_the_whole_rope_is_another_rope():
    change = rd.LocalChange(0.0, 1.0, **EVERY, **ALONG)
    same(rd.Scene(LAID, tension=50.0, parts=[change]), rd.Scene(CHANGED, tension=50.0))


def test_what_needs_one_axial_stiffness_refuses_another_by_name():
    uneven = [rd.LocalChange(0.1, 0.5, lay=0.5)]
    stretching = rd.Tension(50.0, stretching=True)
    held = rd.Scene(LAID, tension=50.0, parts=uneven)
    with pytest.raises(rd.SceneError, match=re.escape("parts[0].lay must be 1 where the tension")):
        held.replace(tension=stretching)
    with pytest.raises(rd.SceneError, match=re.escape("parts[0].lay must be 1 where harmonic")):
        held.compile().frf([20.0], drive=("z", 0.4), harmonic=2)


def test_mass_added_to_the_whole_rope_is_another_rope():
    heavy = LAID.replace(linear_density=0.1 + 0.3, polar_inertia=1e-6 + 2e-6)
    added = rd.AddedMass(0.0, 1.0, 0.3, polar_inertia=2e-6)
    same(rd.Scene(LAID, tension=50.0, parts=[added]), rd.Scene(heavy, tension=50.0))


def test_density_is_a_factor_on_the_rope_and_not_on_what_is_added():
    parts = [rd.LocalChange(0.0, 1.0, density=2.0), rd.AddedMass(0.0, 1.0, 0.3)]
    heavy = LAID.replace(linear_density=0.1 * 2 + 0.3, rotary_inertia=2e-5, polar_inertia=2e-6)
    for order in parts, parts[::-1]:
        same(rd.Scene(LAID, tension=50.0, parts=order), rd.Scene(heavy, tension=50.0))


@pytest.mark.parametrize(
    ("one", "others"),
    [
        (
            [rd.LocalChange(0.25, 0.75, **EVERY)],
            [rd.LocalChange(0.25, 0.5, **EVERY), rd.LocalChange(0.5, 0.75, **EVERY)],
        ),
        (
            [rd.AddedMass(0.25, 0.75, 0.3)],
            [rd.AddedMass(0.25, 0.5, 0.3), rd.AddedMass(0.5, 0.75, 0.3)],
        ),
        (
            [rd.LocalChange(0.25, 0.75, bending=0.5), rd.LocalChange(0.5, 1.0, bending=0.25)],
            [
                rd.LocalChange(0.25, 0.5, bending=0.5),
                rd.LocalChange(0.5, 0.75, bending=0.125),
                rd.LocalChange(0.75, 1.0, bending=0.25),
            ],
        ),
        (
            [rd.AddedMass(0.0, 1.0, 0.25), rd.AddedMass(0.5, 0.75, 0.5)],
            [
                rd.AddedMass(0.0, 0.5, 0.25),
                rd.AddedMass(0.5, 0.75, 0.75),
                rd.AddedMass(0.75, 1.0, 0.25),
            ],
        ),
    ],
    ids=["abutting changes", "abutting masses", "factors multiply", "masses add"],
)
def test_stretches_that_say_the_same_are_the_same(one, others):
    scene = rd.Scene(LAID, tension=50.0)
    # a station where only one of them has any
    stations = [rd.PointMass(x, 0.0) for x in (0.25, 0.5, 0.75)]
    same(scene.replace(parts=one + stations), scene.replace(parts=others + stations))


def test_a_change_by_nothing_changes_no_digit_of_a_rope_cut_at_the_same_places():
    nothing = [rd.LocalChange(0.25, 0.75), rd.AddedMass(0.25, 0.75, 0.0)]
    cut = [rd.PointMass(0.25, 0.0), rd.PointMass(0.75, 0.0)]
    scene = rd.Scene(LAID, tension=50.0)
    same(scene.replace(parts=nothing), scene.replace(parts=cut))
    assert len(scene.replace(parts=nothing).compile(elements=24).triples.F) == 1


def test_elements_of_one_length_and_one_rope_are_one():
    parts = [rd.LocalChange(0.25, 0.5, bending=0.5), rd.LocalChange(0.75, 1.0, bending=0.5)]
    model = rd.Scene(BEAM.replace(length=1.0), parts=parts).compile(elements=16)
    assert len(model.triples.F) == 2
    np.testing.assert_array_equal(model.triples.element, [0] * 4 + [1] * 4 + [0] * 4 + [1] * 4)
    uneven = rd.Scene(BEAM.replace(length=1.0), parts=parts).compile(elements=5)
    # the first of four equal spans has two elements
    assert len(uneven.triples.F) == 3


@pytest.mark.parametrize("seed", range(12))
def test_random_ropes_with_stretches_answer_alike_in_other_cuts(seed):
    """Continuous spans whole, and cut into three and five parts each."""
    random = np.random.default_rng(seed)
    scene = stretched_scene(random, 1 + seed % 4).replace(damping=rd.RayleighDamping(3.0, 1e-6))
    model = scene.compile()
    f, drive = [3.0, 70.0], (scene.coordinates[-1], 0.41)
    cuts = [model, *(scene.compile(elements=k * 20, element="continuous") for k in (3, 5))]
    whole, *others = (cut.frf(f, drive=drive) for cut in cuts)
    for other in others:
        # each bounds its own error
        bound = np.abs(whole.value) * (whole.rounding_error + other.rounding_error)
        assert (np.abs(other.value - whole.value) <= bound).all()
        assert (other.rounding_error < 1e-3).all()
    assert cuts[1].count(below=200.0) == model.count(below=200.0)


@pytest.mark.parametrize("seed", [0, 6])
@pytest.mark.claim(
    "FRF of random ropes that change over stretches, continuous spans: error / condition",
    reference="mpmath, 60 digits: tests/support/exact_span.py",
    accepted=1e-14,
)
def test_random_ropes_with_stretches_respond_as_the_continuum(seed, claim):
    scene = stretched_scene(np.random.default_rng(seed), 1 + seed % 4)
    claim(max(errors(scene, 11.0, (scene.coordinates[-1], 0.41))))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 40))
@pytest.mark.claim(
    "FRF of 30 random ropes that change over stretches, continuous spans: error / condition",
    reference="mpmath, 60 digits: tests/support/exact_span.py",
    accepted=BOUND,
)
def test_many_random_ropes_with_stretches_respond_as_the_continuum(seed, claim):
    scene = stretched_scene(np.random.default_rng(seed), 1 + seed % 4)
    for f in (0.1, 400.0):
        claim(max(errors(scene, f, (scene.coordinates[-1], 0.41))))


def test_half_a_turn_reverses_stretches():
    mirrored = [
        type(part)(**{**{k: v for k, v in vars(part).items() if k != "_"}, "start": a, "stop": b})
        for part in OVERLAPPING
        for a, b in [(L - part.stop, L - part.start)]
    ]
    one = rd.Scene(BEAM, tension=T, ends=("clamped", "free"), parts=OVERLAPPING)
    other = one.replace(ends=("free", "clamped"), parts=mirrored)
    pair = [scene.compile() for scene in (one, other)]
    frequency = [model.modes(6).frequency for model in pair]
    # positions are rounded
    np.testing.assert_allclose(*frequency, rtol=RELATIVE)
    assert pair[0].count(below=500.0) == pair[1].count(below=500.0)


def test_mesh_error_and_tolerance_see_the_stretches():
    scene = rd.Scene(BEAM, tension=T, parts=OVERLAPPING)
    model = scene.compile(tolerance=1e-6, below=150.0)
    exact = scene.compile().modes(below=150.0).frequency
    error = np.abs(model.modes(len(exact)).frequency / exact - 1)
    assert error.max() <= 1e-6
    assert model.choice.mesh_error == pytest.approx(error.max(), rel=1e-3)


def test_shapes_show_the_short_waves_of_a_soft_stretch():
    """A short stretch of slow waves is divided as finely as they ask, not as the longest span."""
    scene = rd.Scene(STRING, tension=T, parts=[rd.LocalChange(0.5, 0.6, density=1e4)])
    modes = scene.compile().modes(40)
    z = modes.shape[-1, :, 0]
    zeros = np.flatnonzero(z[1:] * z[:-1] < 0)
    assert len(zeros) == 39
    # a half wave between two zeros of z
    assert np.diff(zeros).min() >= 8


# scenes ------------------------------------------------------------------------------------------


def test_scene_without_stretches_is_the_one_that_never_had_them():
    scene = rd.Scene(LAID, tension=50.0, parts=[rd.PointMass(0.5, 0.1)])
    full = scene.replace(parts=[*LAID_PARTS, *scene.parts])
    assert set(full.effects) - set(scene.effects) == {"added mass", "local change"}
    assert full.without("added mass", "local change") == scene
    assert full.without("local change").parts == (LAID_PARTS[1], scene.parts[0])


def test_a_change_keeps_what_it_does_to_coordinates_that_are_left():
    every = EVERY | ALONG
    part = rd.LocalChange(0.1, 0.5, **every)
    only_bending = rd.LocalChange(0.1, 0.5, bending=0.4)
    scene = rd.Scene(LAID, tension=50.0, parts=[part, only_bending])
    assert scene.without("twist").parts == (
        rd.LocalChange(0.1, 0.5, bending=0.4, axial=0.8, density=1.7),
        only_bending,
    )
    without_bending = {name: factor for name, factor in every.items() if name != "bending"}
    assert scene.without("bending").parts == (rd.LocalChange(0.1, 0.5, **without_bending),)
    without_lay = {name: factor for name, factor in every.items() if name != "lay"}
    assert scene.without("lay").parts[0] == rd.LocalChange(0.1, 0.5, **without_lay)


def test_stretches_closer_than_stations_can_be_are_merged():
    near = 0.5 * (1 + 1e-12)
    one, other = (
        rd.Scene(BEAM, tension=T, parts=[rd.AddedMass(0.1, 0.5, 0.1), rd.AddedMass(x, 0.9, 0.2)])
        for x in (0.5, near)
    )
    assert len(other.compile().x) == 5
    np.testing.assert_array_equal(*(s.compile().modes(4).frequency for s in (one, other)))


@pytest.mark.parametrize(
    ("rope", "parts", "message"),
    [
        (
            STRING,
            [rd.LocalChange(0.0, 0.5, bending=0.5)],
            "parts[0].bending must be 1 where the scene has no beta (z), got 0.5",
        ),
        (
            BEAM,
            [rd.AddedMass(0.0, 0.5, 1.0), rd.LocalChange(0.0, 0.5, torsion=2.0)],
            "parts[1].torsion must be 1 where the scene has no alpha (z, beta), got 2.0",
        ),
        (
            BEAM,
            [rd.LocalChange(0.0, 0.5, axial=0.5)],
            "parts[0].axial must be 1 where the scene has no x (z, beta), got 0.5",
        ),
        (
            LAID.replace(lay_coupling=None),
            [rd.LocalChange(0.0, 0.5, lay=0.5)],
            "parts[0].lay must be 1 where the scene has no lay coupling (x, z, alpha, beta), got ",
        ),
        (
            BEAM,
            [rd.AddedMass(0.5, 0.5 + 1e-10, 1.0)],
            "parts[0].stop must lie more than 1.2e-09 m beyond start, 0.5 m, got 0.5000000001",
        ),
        (
            BEAM,
            [rd.AddedMass(-0.1, 0.5, 1.0)],
            "parts[0].start must lie on the rope, between 0 and 1.2 m, got -0.1",
        ),
        (
            BEAM,
            [rd.LocalChange(0.5, 1.3)],
            "parts[0].stop must lie on the rope, between 0 and 1.2 m, got 1.3",
        ),
        (
            BEAM,
            [rd.LocalChange(0.2, 0.9, bending=1e-200), rd.LocalChange(0.3, 0.5, bending=1e-200)],
            "parts must leave a rope between 0.3 m and 0.5 m: bending_stiffness must be a finite "
            "number > 0 [N m^2], got 0.0",
        ),
        (
            BEAM,
            [rd.LocalChange(0.3, 0.5, density=1e300), rd.LocalChange(0.2, 0.9, density=1e300)],
            "parts must leave a rope between 0.3 m and 0.5 m: linear_density must be a finite "
            "number > 0 [kg/m], got inf",
        ),
        (
            LAID,
            [rd.LocalChange(0.25, 0.5, torsion=0.1)],
            "parts must leave a rope between 0.25 m and 0.5 m: the section stiffness "
            "[[axial_stiffness, lay_coupling], [lay_coupling, torsional_stiffness]] must be "
            "positive definite",
        ),
    ],
)
def test_stretches_without_meaning_are_refused(rope, parts, message):
    with pytest.raises(rd.SceneError) as caught:
        rd.Scene(rope, tension=T, parts=parts)
    assert message in str(caught.value)


def test_layers_too_thin_in_a_stretch_are_refused():
    soft = rd.LocalChange(0.2, 0.3, bending=1e-25)
    with pytest.raises(rd.SceneError, match=r"bending_stiffness must leave L sqrt\(T/B\)"):
        rd.Scene(BEAM, tension=T, parts=[soft]).compile()
